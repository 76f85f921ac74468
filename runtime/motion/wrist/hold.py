r"""Posture components that change as little as they can while the wrist goes to its end angles.

A seam is welded with a torch whose tilt and advance matter and whose rotation may not. In the weld-line frame, X along
the travel, Y = X x gravity, Z = X x Y, the tool's posture is (Rx, Ry, Rz) = (tilt, advance, rotation):

    (101) Xm = travel            (102) Ym = Xm x gv / |Xm x gv|, gv = (0, 0, -1)        (103) Zm = Xm x Ym
    (104) B  = [Xm Ym Zm]' R_base_tool                        B = Rz(Rz) Ry(Ry) Rx(Rx)
    (105) Rx = atan2(B32, B33)   (106) Ry = atan2(-B31, hypot(B11, B21))   (107) Rz = atan2(B21, B11)

Travel is vertical: Ym is the base's Y. On an arc or a spline the travel is the tangent, and the frame turns with it.

In every cycle each wrist axis has ``CANDIDATES`` angles between the straight line of S8 and what its speed allows,
never past the end angle:

    S82   cand_k(m) = lin_k + sgn(theta_ke - lin_k) min(|theta_ke - lin_k|, room_k) m/(M - 1),   m = 0 .. M - 1
          room_k = max(theta_kd - |V_k|, 0) dt
    S83   for each of the M^3 combinations: main axes by the position of the path, posture, components
    S84   the one with the least sum of squares of the chosen components off those of the path; ties: nearest to S8

All candidates lie between the straight line and the end angle, so the end angles are reached in time. The steps so
chosen keep the speed limit and no other: they jump from one candidate to another. ``smoothed_table`` makes of them a
curve that can be executed.

Source: CN103429397A (Kobe Steel), embodiment 4, whose text is lost past its equation numbers; the reconstruction is
that of docs/wrist.md. Angles rad.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul, norm
from runtime.motion.commands import Component
from runtime.motion.path import LinePath, Path
from runtime.motion.wrist.switch import WristLaw
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES, FrozenWrist, Side
from runtime.robot.kinematics.kinematics import Kinematics

CANDIDATES = 5
"""M of S82: 125 combinations in a cycle. The document leaves M open; 5 holds one component within 0.5 deg
(docs/wrist.md)."""

COMPONENTS: tuple[Component, ...] = ("TILT", "ADVANCE", "ROTATION")

STEPS = 120
"""Steps of the rest of the path at which suppression chooses for a move that runs; between them it is a cubic."""

_STEEP = 1e-6
"""Sine of the angle to the vertical below which the travel has no horizontal direction."""


def weld_line_frame(travel: Array) -> Array:
    """Return R_base_line (3, 3), eqs (101) to (103), of a direction of travel (3,)."""
    # on a vertical seam gravity gives no direction across it; the document leaves that open, the base's Y is ours
    X = travel / norm(travel)
    Y = np.cross(X, [0.0, 0.0, -1.0])
    Y = np.array([0.0, 1.0, 0.0]) if norm(Y) < _STEEP else Y / norm(Y)
    return np.stack([X, Y, np.cross(X, Y)], axis=1)


def frames_along(path: Path, s: Array) -> Array:
    """Return R_base_line of a path at s (N,): (3, 3) where it is one for all of it, else (N, 3, 3)."""
    if isinstance(path, LinePath):
        return weld_line_frame(path.X_end[:3, 3] - path.X_start[:3, 3])
    return np.stack([weld_line_frame(travel) for travel in path.travel(s)])


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
    # wrapped: components are angles, and one of 179 deg is 2 deg from one of -179
    off = posture_components(frames, R_base_tool) - posture_components(frames, R_planned)
    return np.abs(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)))


@dataclass(frozen=True, slots=True, kw_only=True)
class PathAhead:
    """The rest of a path after a switch, sampled for suppression; base frame.

    ``s`` (N + 1,): path parameter at the switch and at the N samples after it, ``period_s`` apart. At these samples:
    ``p_base_tool`` (N, 3) m and ``R_base_tool`` (N, 3, 3), tool point and posture of the path, and ``R_base_line``
    (N, 3, 3), the weld-line frames.
    """

    s: Array
    period_s: float
    p_base_tool: Array
    R_base_tool: Array
    R_base_line: Array

    @classmethod
    def of(cls, path: Path, s: Array, period_s: float) -> "PathAhead":
        """Return a path sampled at s[1:], with s[0] the switch."""
        X = path.poses(s[1:])
        R = X[:, :3, :3]
        frames = np.broadcast_to(frames_along(path, s[1:]), R.shape)
        return cls(s=s, period_s=period_s, p_base_tool=X[:, :3, 3], R_base_tool=R, R_base_line=frames)


class Suppression:
    """Chooses wrist angles cycle by cycle, S81 to S85, for one arm and tool; ``speed`` (3,) rad/s is theta_kd."""

    def __init__(self, kinematics: Kinematics, X_flange_tool: Array, held: tuple[Component, ...], speed: Array) -> None:
        self._kinematics, self._X_flange_tool = kinematics, X_flange_tool
        self._frozen = FrozenWrist(kinematics, X_flange_tool)
        self._chosen = [COMPONENTS.index(component) for component in held]
        self._speed = speed
        # the first of the 125 is (0, 0, 0), the straight line of S8: argmin then takes it where several are equal (S84)
        self._shares = np.array(list(itertools.product(np.linspace(0.0, 1.0, CANDIDATES), repeat=WRIST_AXES)))

    def choose(self, q_switch: Array, end: Array, ahead: PathAhead) -> Array:
        """Return the wrist angles (N, 3) rad at the samples ``ahead`` of a switch at joint angles q_switch (n,).

        ``end`` (3,) rad: taught wrist angles, reached at the last sample.
        """
        s, components = ahead.s, posture_components(ahead.R_base_line, ahead.R_base_tool)
        side = self._frozen.side_of(q_switch)
        q, chosen = q_switch, np.empty((len(ahead.p_base_tool), WRIST_AXES))
        for k, place in enumerate(ahead.p_base_tool):
            wrist = q[-WRIST_AXES:]
            straight = wrist + (end - wrist) * ((s[k + 1] - s[k]) / (1.0 - s[k]))
            room = np.maximum(self._speed * ahead.period_s - np.abs(straight - wrist), 0.0)
            left = end - straight
            # never past the end angle: otherwise the arrival in time, which S8 guarantees, would be lost
            candidates = straight + self._shares * (np.sign(left) * np.minimum(np.abs(left), room))
            rows = self._solved(place, candidates, q, side)
            q = rows[self._best(rows, ahead.R_base_line[k], components[k])]
            chosen[k] = q[-WRIST_AXES:]
        return chosen

    def _solved(self, place: Array, candidates: Array, q_before: Array, side: Side | None) -> Array:
        if side is not None:
            # one call for all 125 where the arm has a closed form; Newton steps follow one solution each
            return self._frozen.solve(np.broadcast_to(place, (len(candidates), 3)), candidates, q_before, side)
        return np.concatenate([self._frozen.solve(place[None], one[None], q_before, side) for one in candidates])

    def _best(self, rows: Array, R_base_line: Array, components: Array) -> int:
        """Return the row of q (M, n) whose held components are nearest to those of the path (3,), S84."""
        R = matmul(self._kinematics.forward(rows), self._X_flange_tool)[:, :3, :3]
        off = (posture_components(R_base_line, R) - components)[:, self._chosen]
        off -= 2.0 * np.pi * np.round(off / (2.0 * np.pi))
        cost = (off**2).sum(axis=1)
        return int(np.nanargmin(cost)) if np.isfinite(cost).any() else 0  # candidate 0 is the line of S8


@dataclass(frozen=True, slots=True, kw_only=True)
class WristTable:
    """Wrist angles as a table: ``values`` (K, 3) rad at K equal steps of the path parameter from a switch on.

    Between them it is the cubic through neighbours with central slopes, so its speed is continuous.
    """

    s_switch: float
    values: Array
    s_return: float = 1.0

    def angles(self, s: Array) -> Array:
        """Return the wrist angles (N, 3) rad at s (N,), from the switch on."""
        # a cubic with the central slopes of np.gradient: the speed is continuous, and no system has to be solved
        last = len(self.values) - 1
        at = np.clip((s - self.s_switch) / (1.0 - self.s_switch), 0.0, 1.0) * last
        k = np.minimum(at.astype(int), last - 1)
        x = (at - k)[:, None]
        slope = np.gradient(self.values, axis=0)
        a, b, da, db = self.values[k], self.values[k + 1], slope[k], slope[k + 1]
        inside = a + x * da + x**2 * (3 * (b - a) - 2 * da - db) + x**3 * (2 * (a - b) + da + db)
        return np.asarray(np.where(at[:, None] >= last, self.values[-1], inside))


def held_angles(suppression: Suppression, path: Path, q_switch: Array, law: WristLaw, rate: float) -> Array:
    """Return wrist angles (STEPS, 3) rad from joint angles q_switch (n,) on that hold components.

    ``law`` says where the switch is and at which angles the wrist ends. Suppression runs at the constant rate ds/dt =
    ``rate``, 1/s, over the rest of the path, whatever the speed profile is there.
    """
    s = np.linspace(law.s_switch, 1.0, STEPS + 1)
    period_s = (1.0 - law.s_switch) / STEPS / rate
    return suppression.choose(q_switch, law.end, PathAhead.of(path, s, period_s))


def smoothed_table(chosen: Array, law: WristLaw, window: float) -> WristTable:
    """Return chosen angles (STEPS, 3) as a curve that can be executed: averaged twice over ``window``.

    The window is a share of the rest of the path: a step of speed becomes a ramp. Before the switch the angles go on
    with the slope d theta / ds of ``law``, after the end they stand still, so both ends are met.
    """
    step = law.slope * (1.0 - law.s_switch) / STEPS
    return WristTable(s_switch=law.s_switch, values=_smoothed(chosen, law.start, law.end, window, step))


def _smoothed(chosen: Array, start: Array, end: Array, window: float, step: Array) -> Array:
    """Return chosen wrist angles (N, 3) averaged twice, from ``start`` (3,) on; ``step`` (3,): that of the path."""
    # twice: one average makes a step of speed a ramp of angle with corners, the second one rounds the corners
    width = max(1, round(window * STEPS / 2.0))
    reach = 2 * width
    before = start + np.arange(-reach, 0)[:, None] * step
    rows = np.concatenate([before, start[None], chosen, np.repeat(end[None], reach, axis=0)])
    ramp = np.convolve(np.ones(width), np.ones(width)) / width**2 if width > 1 else np.ones(1)
    smooth = np.stack([np.convolve(column, ramp, mode="same") for column in rows.T], axis=1)[reach:-reach]
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    # averaging moves the ends a little; a cubic that is flat at the other end puts each back where it belongs
    smooth += (1.0 - share) ** 3 * (start - smooth[0]) + share**3 * (end - smooth[-1])
    return frozen(smooth)
