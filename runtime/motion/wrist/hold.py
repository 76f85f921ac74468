r"""Posture components that change as little as they can while the wrist goes to its end angles.

A seam is welded with a torch whose tilt and advance matter and whose rotation may not. In the weld-line frame, X along
the travel, Y = X x gravity, Z = X x Y, the tool's posture is (Rx, Ry, Rz) = (tilt, advance, rotation):

    (101) Xm = travel            (102) Ym = Xm x gv / |Xm x gv|, gv = (0, 0, -1)        (103) Zm = Xm x Ym
    (104) B  = [Xm Ym Zm]' R_base_tool                        B = Rz(Rz) Ry(Ry) Rx(Rx)
    (105) Rx = atan2(B32, B33)   (106) Ry = atan2(-B31, hypot(B11, B21))   (107) Rz = atan2(B21, B11)

Travel is vertical: Ym is the base's Y. On an arc the travel is the tangent, and the frame turns with it.

In every cycle each wrist axis has ``CANDIDATES`` angles between where the straight way (S8) would take it and what its
speed allows, never past the end angle:

    S82   cand_k(m) = lin_k + sgn(theta_ke - lin_k) min(|theta_ke - lin_k|, room_k) m/(M - 1),   m = 0 .. M - 1
          room_k = max(theta_kd - |V_k|, 0) dt
    S83   for each of the M^3 combinations: main axes by the position of the path, posture, components
    S84   the one with the least sum of squares of the chosen components off those of the path; ties: nearest to S8

All candidates lie between the straight way and the end angle, so the end angles are reached in time. The steps so
chosen are within the speed limit and nothing else: they jump from one candidate to another. ``held_ways`` therefore
smooths what ``suppress`` chose before it is executed, see there.

Source: CN103429397A (Kobe Steel), embodiment 4, whose text is lost past its equation numbers; the reconstruction is
that of docs/wrist.md. Angles rad.
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul, norm
from runtime.motion.commands import Component
from runtime.motion.path import ArcPath, Path
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES, FrozenWrist, Side
from runtime.robot.kinematics.kinematics import Kinematics

CANDIDATES = 5
COMPONENTS: tuple[Component, ...] = ("TILT", "ADVANCE", "ROTATION")

STEPS = 120
"""Steps of the rest of the path in which a way that is to be executed is chosen."""

_STEEP = 1e-6
"""Sine of the angle to the vertical below which the travel has no horizontal direction."""


def weld_line_frame(travel: Array) -> Array:
    """Return R_base_line (3, 3), eqs (101) to (103), of a direction of travel (3,)."""
    X = travel / norm(travel)
    Y = np.cross(X, [0.0, 0.0, -1.0])
    Y = np.array([0.0, 1.0, 0.0]) if norm(Y) < _STEEP else Y / norm(Y)
    return np.stack([X, Y, np.cross(X, Y)], axis=1)


def frames_along(path: Path, s: Array) -> Array:
    """Return R_base_line of a path at s (N,): (3, 3) where it is one for all of it, else (N, 3, 3)."""
    if isinstance(path, ArcPath):
        return np.stack([weld_line_frame(travel) for travel in path.travel(s)])
    return weld_line_frame(path.X_end[:3, 3] - path.X_start[:3, 3])


def posture_components(R_base_line: Array, R_base_tool: Array) -> Array:
    """Return (tilt, advance, rotation) (..., 3) rad of postures (..., 3, 3), eqs (104) to (107)."""
    B = matmul(np.swapaxes(R_base_line, -1, -2), R_base_tool)
    return np.stack(
        [
            np.arctan2(B[..., 2, 1], B[..., 2, 2]),
            np.arctan2(-B[..., 2, 0], np.hypot(B[..., 0, 0], B[..., 1, 0])),
            np.arctan2(B[..., 1, 0], B[..., 0, 0]),
        ],
        axis=-1,
    )


def component_deviation(path: Path, s: Array, R_planned: Array, R_base_tool: Array) -> Array:
    """Return the distance, rad (N, 3), in tilt, advance and rotation between the path's postures and those taken."""
    frames = frames_along(path, s)
    off = posture_components(frames, R_base_tool) - posture_components(frames, R_planned)
    return np.abs(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)))


class Suppression:
    """Chooses wrist angles cycle by cycle, S81 to S85, for one arm, tool and direction of travel (3,).

    ``way`` may be given other weld-line frames than that of the one direction.
    """

    def __init__(
        self, kinematics: Kinematics, X_flange_tool: Array, travel: Array, held: tuple[Component, ...], speed: Array
    ) -> None:
        self._kinematics, self._X_flange_tool = kinematics, X_flange_tool
        self._frozen = FrozenWrist(kinematics, X_flange_tool)
        self._R_base_line = weld_line_frame(travel)
        self._chosen = [COMPONENTS.index(component) for component in held]
        self._speed = speed
        self._shares = np.array(list(itertools.product(np.linspace(0.0, 1.0, CANDIDATES), repeat=WRIST_AXES)))

    def way(
        self,
        q_switch: Array,
        end: Array,
        s: Array,
        p_base_tool: Array,
        R_path: Array,
        period_s: float,
        R_base_line: Array | None = None,
    ) -> Array:
        """Return the wrist angles (N, 3) at the samples after a switch at joint angles q_switch (n,), rad.

        ``end`` (3,): taught wrist angles; s (N + 1,): path parameter at the switch and at the samples, ``period_s``
        apart; p_base_tool (N, 3) m and R_path (N, 3, 3): the path at the samples; R_base_line (N, 3, 3): the weld-line
        frames there (None: that of the travel).
        """
        frames = np.broadcast_to(self._R_base_line if R_base_line is None else R_base_line, R_path.shape)
        wanted = posture_components(frames, R_path)
        side = self._frozen.side_of(q_switch)
        q, chosen = q_switch, np.empty((len(p_base_tool), WRIST_AXES))
        for k, place in enumerate(p_base_tool):
            wrist = q[-WRIST_AXES:]
            straight = wrist + (end - wrist) * ((s[k + 1] - s[k]) / (1.0 - s[k]))
            room = np.maximum(self._speed * period_s - np.abs(straight - wrist), 0.0)
            left = end - straight
            candidates = straight + self._shares * (np.sign(left) * np.minimum(np.abs(left), room))
            rows = self._solved(place, candidates, q, side)
            q = rows[self._best(rows, frames[k], wanted[k])]
            chosen[k] = q[-WRIST_AXES:]
        return chosen

    def _solved(self, place: Array, candidates: Array, q_before: Array, side: Side | None) -> Array:
        if side is not None:
            return self._frozen.solve(np.broadcast_to(place, (len(candidates), 3)), candidates, q_before, side)
        return np.concatenate([self._frozen.solve(place[None], one[None], q_before, side) for one in candidates])

    def _best(self, rows: Array, R_base_line: Array, wanted: Array) -> int:
        R = matmul(self._kinematics.forward(rows), self._X_flange_tool)[:, :3, :3]
        off = (posture_components(R_base_line, R) - wanted)[:, self._chosen]
        off -= 2.0 * np.pi * np.round(off / (2.0 * np.pi))
        cost = (off**2).sum(axis=1)
        return int(np.nanargmin(cost)) if np.isfinite(cost).any() else 0  # candidate 0 is the straight way


@dataclass(frozen=True, slots=True, kw_only=True)
class WristTable:
    """A way of the wrist given by angles ``values`` (K, 3) rad at K equal steps of the path parameter from a switch on.

    Between them it is the cubic through neighbours with central slopes, so its speed is continuous.
    """

    s_switch: float
    values: Array
    s_return: float = 1.0

    def angles(self, s: Array) -> Array:
        """Return the wrist angles (N, 3) rad at s (N,), from the switch on."""
        last = len(self.values) - 1
        at = np.clip((s - self.s_switch) / (1.0 - self.s_switch), 0.0, 1.0) * last
        k = np.minimum(at.astype(int), last - 1)
        x = (at - k)[:, None]
        slope = np.gradient(self.values, axis=0)
        a, b, da, db = self.values[k], self.values[k + 1], slope[k], slope[k + 1]
        inside = a + x * da + x**2 * (3 * (b - a) - 2 * da - db) + x**3 * (2 * (a - b) + da + db)
        return np.asarray(np.where(at[:, None] >= last, self.values[-1], inside))


def held_ways(
    suppression: Suppression,
    path: Path,
    q_switch: Array,
    slope: Array,
    end: Array,
    s_switch: float,
    rate: float,
    windows: Sequence[float],
) -> Iterator[WristTable]:
    """Yield ways from joint angles q_switch (n,) to ``end`` (3,) that hold components and can be executed.

    ``suppress`` is run at the constant rate ds/dt = ``rate``, 1/s, over the rest of the path, once for all ways, and
    what it chose is averaged twice over each window (a share of that rest): a step of speed becomes a ramp. Before the
    switch the way goes on with ``slope`` (3,) d theta / ds of the path, after the end it stands, so both ends are met.
    """
    s = np.linspace(s_switch, 1.0, STEPS + 1)
    X = path.poses(s[1:])
    period_s = (1.0 - s_switch) / STEPS / rate
    frames = frames_along(path, s[1:]) if isinstance(path, ArcPath) else None
    chosen = suppression.way(q_switch, end, s, X[:, :3, 3], X[:, :3, :3], period_s, frames)
    for window in windows:
        yield WristTable(
            s_switch=s_switch,
            values=_smoothed(chosen, q_switch[-WRIST_AXES:], end, window, slope * (1.0 - s_switch) / STEPS),
        )


def _smoothed(chosen: Array, start: Array, end: Array, window: float, step: Array) -> Array:
    """Return chosen wrist angles (N, 3) averaged twice, from ``start`` (3,) on; ``step`` (3,): that of the path."""
    width = max(1, round(window * STEPS / 2.0))
    reach = 2 * width
    before = start + np.arange(-reach, 0)[:, None] * step
    rows = np.concatenate([before, start[None], chosen, np.repeat(end[None], reach, axis=0)])
    ramp = np.convolve(np.ones(width), np.ones(width)) / width**2 if width > 1 else np.ones(1)
    smooth = np.stack([np.convolve(column, ramp, mode="same") for column in rows.T], axis=1)[reach:-reach]
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    # averaging moves the ends a little
    smooth += (1.0 - share) ** 3 * (start - smooth[0]) + share**3 * (end - smooth[-1])
    return frozen(smooth)
