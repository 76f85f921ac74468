"""The task of the wrist in one move, and the curves that may do it: the values that the wrist planner works on.

``SampledPath`` is the path on the samples on which it is judged, ``WristRequest`` the end that it has to reach from
there and what the profile allows, ``Candidate`` one joint curve that may do it, with its figures or the reason for
which it was rejected. All are frozen; angles rad.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, rotation_angles
from runtime.core.linear import matmul
from runtime.motion.commands import Component
from runtime.motion.path_ik import LineSolver, WristSolver
from runtime.motion.wrist.hold import COMPONENTS, component_deviation
from runtime.motion.wrist.switch import SAME_ANGLES, PathTiming, Trigger, WristLimits, first_trigger
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.settings.profile import WristOptions

SHORTEST_TRAVEL = 1e-6
"""A shorter path has no direction in which tilt and advance could be counted, m."""

Solver = LineSolver | WristSolver
Excess = Callable[[Array], tuple[float, int, str]]
"""Of samples q (N + 1, n): factor by which they are too fast (1 and less: not), axis (0-based), ``speed`` or other."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SampledPath:
    """A path at the programmed speed on the samples on which its wrist is judged.

    ``line`` solves it in the configuration of its start, with the result ``q`` (N + 1, n) at the samples of ``timing``,
    NaN where there is no solution. ``excess`` measures how far such samples pass the limits of the joints.
    """

    line: LineSolver
    timing: PathTiming
    q: Array
    excess: Excess

    @property
    def s(self) -> Array:
        """Path parameter of the samples, (N + 1,) from 0 to 1."""
        return self.timing.s

    @property
    def last_solved(self) -> int:
        """The last sample, of all but the end itself, up to which every sample has a solution."""
        # the law needs a part of the path after its switch, so the last sample is none to switch at
        finite = np.isfinite(self.q).all(axis=1)
        solved = len(self.s) - 1 if finite.all() else int(np.argmin(finite)) - 1
        return min(len(self.s) - 2, solved)

    def sample_at(self, place: float) -> int:
        """Return the last sample at or before a place, a share of the path."""
        return int(np.searchsorted(self.s, place, side="right")) - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class WristRequest:
    """A path that has to end at the joint angles ``q_end`` (n,) rad, and what the profile lets the wrist do for it.

    ``trigger``: the first exception condition that the path meets, None where it meets none. ``held`` components of the
    posture change as little as they can; the tool may turn by ``most_deviation`` rad from its posture on the path.
    ``tracked``: a seam sensor will shift the path, so no component is held and the wrist does not return to the posture
    before the end: both would have to be planned anew in every cycle.
    """

    sampled: SampledPath
    q_end: Array
    options: WristOptions
    trigger: Trigger | None
    held: tuple[Component, ...] = ()
    most_deviation: float = math.pi
    tracked: bool = False

    @property
    def arrives(self) -> bool:
        """Whether the path with its posture ends at ``q_end``, turns included."""
        return bool(np.abs(self.sampled.q[-1] - self.q_end).max() <= SAME_ANGLES)

    @property
    def wrist_end(self) -> Array:
        """The taught angles (3,) of the wrist axes."""
        return self.q_end[-WRIST_AXES:]

    @property
    def switch(self) -> int:
        """The sample before the condition, from which S7 goes on; the last sample where no condition is met."""
        return len(self.sampled.s) - 1 if self.trigger is None else self.trigger.index - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A joint curve that a move may take: its solver, and where and why its wrist leaves the path.

    ``switch``: path parameter at which it leaves, None: it keeps its posture; ``trigger``: the condition that made it
    leave; ``remedy`` beyond the document's rule, or ""; ``held`` components. As judged: ``ratio``, the factor by which
    it is too fast at the programmed speed, ``deviation`` rad of the tool from its posture on the path, or of the held
    components; ``rejected``, the fault for which it cannot be taken at all.
    """

    solver: Solver
    switch: float | None = None
    trigger: Trigger | None = None
    remedy: str = ""
    held: tuple[Component, ...] = ()
    ratio: float = 1.0
    deviation: float = 0.0
    rejected: Fault | None = None


def trigger_of(sampled: SampledPath, q_end: Array, options: WristOptions) -> Trigger | None:
    """Return the first exception condition that a path to joint angles q_end (n,) meets, S61; None for none."""
    limits = WristLimits.of(sampled.line.arm.spec, options)
    return first_trigger(sampled.q, q_end, sampled.timing, limits, options)


def posture_deviation(line: LineSolver, s: Array, q: Array, held: tuple[Component, ...] = ()) -> float:
    """Return by how much the tool turns from its posture on the path, rad: the whole angle, or of held components.

    s (N + 1,): path parameter of the rows q (N + 1, n).
    """
    # without a direction of travel there is no weld-line frame: the whole angle bounds every component
    R = matmul(line.arm.kinematics.forward(q), line.arm.X_flange_tool)[:, :3, :3]
    planned = line.planned(s)[:, :3, :3]
    if not held or line.path.length < SHORTEST_TRAVEL:
        return float(rotation_angles(planned, R).max())
    return float(component_deviation(line.path, s, planned, R)[:, [COMPONENTS.index(each) for each in held]].max())
