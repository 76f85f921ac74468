"""A path timed as its moves are programmed: their SPEED, OVERRIDE, ACCEL and TIME, and a cap on the speed of the tool.

Called for chains (``joined``) and for moves that stop at both ends (``single``); m, rad, s.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.chain.chain_path import ChainPath, ToolLimits
from runtime.motion.chain.curved import curved
from runtime.motion.chain.piece import Piece
from runtime.motion.chain.timing import Begun, Limits, Path, Timed, timed
from runtime.motion.speed_cap import PLANNED, SpeedCap
from runtime.robot.model.drives import PathLimits
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

_TIMES = 8
"""Timings of a path until its moves take the TIMEs that are programmed, and keep to a cap."""
_FIRMLY = 1.0 + 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainLimits:
    """What a path of one robot keeps to: ``joints``, the ``path`` limits of the tool, a ``cap`` on its speed.

    ``rise_s`` and ``path_rise_s``: the times in which accelerations of the joints and of the tool build up, 0 without a
    limit of jerk.
    """

    joints: Limits
    path: PathLimits
    rise_s: float
    path_rise_s: float
    cap: SpeedCap | None = None

    @classmethod
    def of(cls, spec: RobotSpec, profile: Profile) -> "ChainLimits":
        """Return what paths of a robot keep to; without a limit of jerk under the speed shape ``trapezoid``."""
        acceleration, jerk, path = spec.per_axis("limits", "acceleration"), spec.per_axis("limits", "jerk"), spec.path
        limited = profile.speed_shape == "jerk"
        path_rises = path.acceleration / path.jerk, path.rotation_acceleration / path.rotation_jerk
        return cls(
            joints=Limits(
                speed=spec.per_axis("limits", "speed"),
                acceleration=acceleration,
                jerk=jerk if limited else np.full(spec.n, math.inf),
                period_s=profile.period_s,
            ),
            path=path,
            rise_s=float((acceleration / jerk).max()) if limited else 0.0,
            path_rise_s=max(path_rises) if limited else 0.0,
        )

    def mean_s(self, pieces: Sequence[Piece]) -> float:
        """Return the time, s, in which accelerations of moves build up: of the tool where it has a limit of its own."""
        bound = any(piece.path is not None and piece.acceleration < math.inf for piece in pieces)
        return max(self.rise_s, self.path_rise_s) if bound else self.rise_s


@dataclass(frozen=True, slots=True, kw_only=True)
class Beginning:
    """How a path begins: with the motion ``begun``, and rows at places ``before`` (B,) of it before that of its row 0.

    ``open``: it may be gone on with before its end, so it keeps to the whole T of the robot.
    """

    begun: Begun | None = None
    before: Array = field(default_factory=lambda: np.zeros(0))
    open: bool = False


AT_REST, OPEN = Beginning(), Beginning(open=True)
"""Paths from rest to rest."""


def paced(path: ChainPath, limits: ChainLimits, beginning: Beginning = AT_REST) -> Timed:
    """Return a path timed with the speeds, overrides and TIMEs of its moves; ``Fault`` RBL404 where it keeps no cap."""
    number = path.move_at(path.x)
    pieces = path.pieces
    overrides = np.array([piece.override for piece in pieces])
    tool = _tool_limits(pieces, limits, number)
    bounds = path.bounds((limits.joints.speed, limits.joints.acceleration), tool, overrides)
    bounds = bounds.replaced(np.minimum(bounds.fastest, curved(path, tool, limits.path.rotation_speed)))
    mean_s, begun = limits.mean_s(pieces), beginning.begun
    slower, under = np.ones(len(pieces)), 1.0
    for _ in range(_TIMES):
        fastest = np.minimum(bounds.fastest, _under_cap(path, limits.cap, under)) * slower[number] ** 2
        whole = Path(x=path.x, bounds=bounds.replaced(fastest), joints=path.joints)
        found = timed(whole, limits.joints, mean_s, begun=begun, whole=beginning.open)
        factor = _too_quick(path, np.concatenate([beginning.before, found.x]), limits.joints.period_s)
        over = 1.0 if limits.cap is None else limits.cap.ratio(limits.cap.fine.expand(found.setpoints))
        if over <= 1.0 and not (factor < 1.0).any():
            return found
        slower *= factor
        # between two points of the grid the tool may be a little faster than at both
        under /= over * _FIRMLY if over > 1.0 else 1.0
    # a TIME that is missed is found by ``plan_findings``; a cap is for the people beside the arm
    if not over <= 1.0:
        raise Fault("RBL404", "no timing of the moves keeps below the cap of MANUAL")
    return found


def _tool_limits(pieces: Sequence[Piece], limits: ChainLimits, number: NDArray[np.intp]) -> ToolLimits:
    """Return what the tool keeps to at points that belong to moves ``number`` (M + 1,): on joint moves only a cap."""
    along = np.array([piece.path is not None for piece in pieces])
    share = np.array([piece.acceleration for piece in pieces])
    most = np.where(along, limits.path.acceleration * share, math.inf)
    if limits.cap is not None:
        most = np.minimum(most, limits.cap.gained)
    turning = np.where(along, limits.path.rotation_acceleration * share, math.inf)
    return ToolLimits(acceleration=most[number], turning=turning[number])


def _too_quick(path: ChainPath, x: Array, period_s: float) -> Array:
    """Return the share (K,) of its speed at which each move takes its TIME, 1 where it takes as long already."""
    cycles = np.interp(path.ends, x, np.arange(len(x)))
    lasts = np.diff(cycles) * period_s
    wanted = np.array([piece.duration_s or 0.0 for piece in path.pieces])
    # a cycle is as near as a motion in whole cycles can come
    return np.where(lasts < wanted - period_s, lasts / np.maximum(wanted, period_s), 1.0)


def _under_cap(path: ChainPath, cap: SpeedCap | None, share: float) -> Array | float:
    """Return the largest b (M + 1,) at which tool point and flange keep to a share of a cap."""
    if cap is None:
        return math.inf
    return np.asarray((share * cap.most * PLANNED / np.maximum(path.speeds(), 1e-9)) ** 2)
