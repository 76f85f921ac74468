"""Mechanisms given by a few lengths: Cartesian, cylindrical, SCARA. Files in ``runtime/pulses/library``.

    cartesian    joints x, y, z, or some of them: the tool point itself
    cylindrical  theta, r and perhaps z:                x = r cos theta, y = r sin theta
    scara        theta1, theta2, perhaps z and theta4:  x = l1 cos t1 + l2 cos(t1 + t2), y with sines

A coordinate without a joint is constant: z is that of the program's first point. A tool that no joint turns keeps
its posture; theta4 turns it about z by what the two others leave of it. Inverse kinematics follows the branch it is in
(sign of theta2; theta by the smaller turn), so a line through the axis of a cylindrical arm, or past the reach of a
SCARA, is refused. Moves that the mechanism cannot make as taught are ``Fault`` RBL431, never approximated.

::

    schema = 1
    name = "cylindrical"
    kind = "cylindrical"
    [path]
    speed_mm_s = 100                 # of a MOVE without SPEED
    max_speed_mm_s = 500
    acceleration_mm_s2 = 500
    [[joints]]                       # in the order of the kind
    name = "theta"
    range_deg = [-170, 170]          # range_mm of a joint that slides
    speed_deg_s = 180                # optional, as is acceleration_deg_s2
    home_deg = 0
    pulse_deg = 0.0036               # angle or length of one pulse
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import numpy as np

import runtime.pulses.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen, principal_axes
from runtime.core.limits import ACCEL, SPEED
from runtime.core.linear import norm
from runtime.core.rounding import beside
from runtime.core.tomlfile import Source, Table, load_table, read_source
from runtime.core.units import DEG, MM, PERCENT
from runtime.motion.commands import MoveLinear
from runtime.motion.velocity_profile import SpeedLimits, bound
from runtime.pulses.machine import Joint, Stand
from runtime.robot.kinematics.kinematics import SAME_ROOM

Kind = Literal["cartesian", "cylindrical", "scara"]
ORDER: dict[str, tuple[str, ...]] = {
    "cartesian": ("x", "y", "z"),
    "cylindrical": ("theta", "r", "z"),
    "scara": ("theta1", "theta2", "z", "theta4"),
}
NEEDED: dict[str, tuple[str, ...]] = {
    "cartesian": ("x",),
    "cylindrical": ("theta", "r"),
    "scara": ("theta1", "theta2"),
}
SCHEMA = 1
SAME = 1e-6
"""A difference of less is rounding, m and rad: taught values have fewer digits."""
RANGE_TOLERANCE = 1e-9
"""How far past its range a joint may be commanded, rad or m: rounding, nothing more."""
JUMP = 0.5
"""No joint turns further from one step to the next, rad: it passes a singularity."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mechanism:
    """A mechanism: joints in the order of ``kind``, ``lengths`` l1 and l2 of a SCARA, m, limits of the tool point.

    ``pulse`` (M,) rad or m: the default of what one pulse moves each joint by. ``fixed`` are the coordinates that have
    no joint, m, as far as they are known.
    """

    name: str
    kind: Kind
    joints: tuple[Joint, ...]
    home: Stand
    pulse: tuple[float, ...]
    speed: float
    max_speed: float
    acceleration: float
    lengths: tuple[float, float] = (0.0, 0.0)
    fixed: tuple[tuple[str, float], ...] = ()

    @property
    def has(self) -> frozenset[str]:
        """Names of the joints."""
        return frozenset(joint.name for joint in self.joints)

    def placed(self, point: Array) -> "Mechanism":
        """Return the mechanism with the coordinates that have no joint as they are at ``point`` (3,) m."""
        axes = "xyz" if self.kind == "cartesian" else "z"
        free = [axis for axis in axes if axis not in self.has]
        return replace(self, fixed=tuple((axis, float(point["xyz".index(axis)])) for axis in free))

    def points(self, q: Array) -> Array:
        """Return the tool points (K, 3) m at joint values q (K, M)."""
        value = {joint.name: q[..., k] for k, joint in enumerate(self.joints)} | {
            axis: np.full(q.shape[:-1], at) for axis, at in self.fixed
        }
        zero = np.zeros(q.shape[:-1])
        if self.kind == "cartesian":
            x, y = value.get("x", zero), value.get("y", zero)
        elif self.kind == "cylindrical":
            x, y = value["r"] * np.cos(value["theta"]), value["r"] * np.sin(value["theta"])
        else:
            (l1, l2), both = self.lengths, value["theta1"] + value["theta2"]
            x = l1 * np.cos(value["theta1"]) + l2 * np.cos(both)
            y = l1 * np.sin(value["theta1"]) + l2 * np.sin(both)
        return np.stack([x, y, value.get("z", zero)], axis=-1)

    def curve(self, stand: Stand, command: MoveLinear) -> "MechanismCurve":
        """Return the curve of a move; ``Fault`` RBL404 or RBL431."""
        # from where the pulses have put the joints, not from the taught start: the line begins where the tool is
        start, end = self.points(stand.q), command.X_world_tool[:3, 3]
        for axis, at in self.fixed:
            k = "xyz".index(axis)
            if not abs(end[k] - at) <= SAME:
                raise Fault(
                    "RBL431",
                    f"the {self.name} has no joint for {axis} and stays at {at / MM:g} mm; the "
                    f"point is at {end[k] / MM:g} mm",
                )
        turns = self._turns(stand, command)
        turn = turns[0]
        speed = self.speed
        if command.duration is not None:
            speed = self.max_speed
        elif command.speed is not None:
            speed = command.speed
            SPEED.checked(speed / MM, self.max_speed / MM)
        ACCEL.checked(command.acceleration / PERCENT, ACCEL.high)
        length = norm(end - start)
        extents = [(length, speed, self.acceleration * command.acceleration, np.inf)]
        if turn:  # as fast as the joint that turns it; ``move`` slows it where the other joints need longer
            joint = self.joints[-1]
            extents.append((abs(turn), min(joint.speed, _FAST), min(joint.acceleration, _FAST), np.inf))
        moves = not (length <= SAME * MM and abs(turn) <= SAME * MM)  # a nanometre: less than any pulse
        limits = bound(extents, "trapezoid") if moves else None
        curves = [
            MechanismCurve(mechanism=self, q_start=stand.q, ends=(start, end), turn=each, limits=limits)
            for each in turns
        ]
        return curves[0] if len(curves) == 1 else _freer(curves[0], curves[1])

    def _turns(self, stand: Stand, command: MoveLinear) -> tuple[float, ...]:
        """Return by how much the tool turns about z on a move, rad; both directions of a half turn.

        ``Fault`` RBL431 when it must turn about another axis, or has no joint that turns it.
        """
        if stand.R is None:  # the first point: any posture of the tool is the one that it has there
            return (0.0,)
        rotations = principal_axes(stand.R, command.X_world_tool[:3, :3])
        axis, angle = rotations[0]
        if angle <= SAME:
            return (0.0,)
        if "theta4" not in self.has:
            raise Fault(
                "RBL431",
                f"the tool would have to turn by {angle / DEG:.2f} deg, and the {self.name} has no joint that turns it",
            )
        if not 1.0 - abs(axis[2]) <= SAME:
            raise Fault(
                "RBL431",
                f"the tool would have to turn about another axis than z, and the {self.name} has no joint for that",
            )
        return tuple(math.copysign(angle, axis[2]) for axis, angle in rotations)

    def arrived(self, stand: Stand, command: MoveLinear, q: Array) -> Stand:
        """Return the stand at q (M,), with the posture of the command."""
        return Stand(q=frozen(q), R=command.X_world_tool[:3, :3])

    def inverse(self, points: Array, q_start: Array, turn: Array) -> Array:
        """Return joint values (N, M) of points (N, 3) m, continuous from q_start (M,); NaN where out of reach.

        ``turn`` (N,) rad is by how much the tool has turned about z since the start.
        """
        x, y, z = points.T
        start = {joint.name: q_start[k] for k, joint in enumerate(self.joints)}
        found: dict[str, Array] = {"x": x, "y": y, "z": z}
        if self.kind == "cylindrical":
            found["theta"], found["r"] = _unwrapped(np.arctan2(y, x), start["theta"]), np.hypot(x, y)
        elif self.kind == "scara":
            l1, l2 = self.lengths
            cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)
            # law of cosines; beyond reach NaN, not clipped: a point out of reach is refused, never approximated
            inside = np.where(np.abs(cosine) <= 1.0, cosine, np.nan)
            t2 = np.copysign(np.arccos(inside), start["theta2"])
            t1 = np.arctan2(y, x) - np.arctan2(l2 * np.sin(t2), l1 + l2 * np.cos(t2))
            found["theta2"] = t2
            found["theta1"] = _unwrapped(t1, start["theta1"])
            if "theta4" in self.has:  # the yaw of the tool is the sum of the three angles about z
                yaw = start["theta1"] + start["theta2"] + start["theta4"] + turn
                found["theta4"] = yaw - found["theta1"] - t2
        return np.stack([found[joint.name] for joint in self.joints], axis=1)

    def described(self) -> dict[str, Any]:
        """Return the mechanism as the tables' manifest has it."""
        lengths = dict(zip(("l1_mm", "l2_mm"), (at / MM for at in self.lengths), strict=True))
        return {
            "kind": self.kind,
            "name": self.name,
            "axes": [joint.name for joint in self.joints],
            **(lengths if self.kind == "scara" else {}),
            **{f"{axis}_mm": at / MM for axis, at in self.fixed},
        }


_FAST = 1e3
"""Stands for the speed and acceleration of a joint without stated limits, rad/s and rad/s2."""
_SAMPLES = np.linspace(0.0, 1.0, 101)


@dataclass(frozen=True, slots=True, kw_only=True)
class MechanismCurve:
    """A straight move of a mechanism between ``ends`` (3,) m, in which the tool turns by ``turn`` rad about z."""

    mechanism: Mechanism
    q_start: Array
    ends: tuple[Array, Array]
    turn: float
    limits: SpeedLimits | None

    @property
    def length(self) -> float:
        """Length of the path of the tool point, m."""
        return norm(self.ends[1] - self.ends[0])

    def joints(self, s: Array) -> Array:
        """Return joint values (N, M) at path parameters s (N,); ``Fault`` RBL410, 411, 412."""
        start, end = self.ends
        q = self.mechanism.inverse(start + s[:, None] * (end - start), self.q_start, s * self.turn)
        lost = ~np.isfinite(q).all(axis=1)
        if lost.any():
            first = int(np.argmax(lost))
            at = (start + s[first] * (end - start)) / MM
            place = f"({at[0]:.1f}, {at[1]:.1f}, {at[2]:.1f}) mm"
            raise Fault(
                "RBL410",
                f"the point {place} at {100 * s[first]:.1f} % of the path is out of reach of the {self.mechanism.name}",
            )
        self._check_jumps(s, q)
        q[0] = self.q_start
        for k, joint in enumerate(self.mechanism.joints):
            beyond = np.maximum(joint.lower - q[:, k], q[:, k] - joint.upper)
            worst = int(np.argmax(beyond))
            if not beyond[worst] <= RANGE_TOLERANCE:
                unit, name = (DEG, "deg") if joint.rotary else (MM, "mm")
                at, low, high = beside(q[worst, k] / unit, joint.lower / unit, joint.upper / unit, form=".2f")
                raise Fault(
                    "RBL411",
                    f"{joint.name} is at {at} {name} at {100 * s[worst]:.1f} % of the path, beyond "
                    f"{low} to {high} {name}",
                )
        return q

    def _check_jumps(self, s: Array, q: Array) -> None:
        """Refuse a line on which a rotary joint jumps; ``Fault`` RBL412. Sliding joints are continuous on a line."""
        turning = [k for k, joint in enumerate(self.mechanism.joints) if joint.rotary]
        if not turning or len(q) < 2:
            return
        jumps = np.abs(np.diff(q[:, turning], axis=0, prepend=self.q_start[None, turning]))
        step, k = np.unravel_index(int(np.argmax(jumps)), jumps.shape)
        if not jumps[step, k] <= JUMP:
            name = self.mechanism.joints[turning[int(k)]].name
            raise Fault(
                "RBL412",
                f"at {100 * s[step]:.1f} % of the straight path {name} would have to turn by "
                f"{jumps[step, k] / DEG:.0f} deg in one step: the line passes a singularity",
            )


def _freer(first: MechanismCurve, second: MechanismCurve) -> MechanismCurve:
    """Return the direction of a half turn that is in range, or else ends farther from the ends of the range.

    The rule of ``runtime.motion.half_turn`` for arms. The joint that turns the tool is the last one.
    """
    room = [_room_at_end(first), _room_at_end(second)]
    return second if room[1] > room[0] + SAME_ROOM else first


def _room_at_end(curve: MechanismCurve) -> float:
    """Return the distance of the last joint from the ends of its range at the end of a move, rad; -inf: refused."""
    joint = curve.mechanism.joints[-1]
    try:
        end = float(curve.joints(_SAMPLES)[-1, -1])
    except Fault:
        return -np.inf
    return min(end - joint.lower, joint.upper - end)


def _unwrapped(angle: Array, start: float) -> Array:
    """Return angles (N,) rad without jumps of whole turns, the first of them nearest to ``start``."""
    found = np.unwrap(angle)
    return np.asarray(found + 2.0 * np.pi * np.round((start - found[0]) / (2.0 * np.pi)))


# --- files -----------------------------------------------------------------------------------------------------------


def library() -> tuple[str, ...]:
    """Return the names of the built-in mechanisms."""
    return tuple(sorted(item.name.removesuffix(".toml") for item in _folder().iterdir() if item.name.endswith(".toml")))


def load_builtin(name: str) -> Mechanism:
    """Return a built-in mechanism; ``KeyError`` for another name."""
    if name not in library():
        raise KeyError(name)
    return parse(Source(f"{name}.toml", _folder().joinpath(f"{name}.toml").read_text("utf-8")))


def load_file(path: Path) -> Mechanism:
    """Return the mechanism of a file; ``FileFault`` RBL6xx at its line."""
    return parse(read_source(path))


def _folder() -> Any:
    return resources.files("runtime.pulses").joinpath("library")


def parse(source: Source) -> Mechanism:
    """Return the mechanism of a file; ``FileFault`` RBL60x, RBL610 or RBL613."""
    table = load_table(source)
    if table.integer("schema", low=0, high=10**6) != SCHEMA:
        table.fail("RBL605", f"'schema' must be {SCHEMA}", key="schema")
    name, kind = table.text("name"), table.text("kind", choices=tuple(ORDER))
    path, rows = table.table("path"), table.tables("joints")
    joints = tuple(_joint(row) for row in rows)
    _check_joints(table, rows, joints, kind)
    lengths = [table.number(f"{key}_mm", positive=True) * MM if kind == "scara" else 0.0 for key in ("l1", "l2")]
    max_speed = path.number("max_speed_mm_s", positive=True) * MM
    found = Mechanism(
        name=name,
        kind=kind,  # type: ignore[arg-type]
        joints=joints,
        home=Stand(q=frozen([_home(row, joint) for row, joint in zip(rows, joints, strict=True)])),
        pulse=tuple(_pulse(row, joint) for row, joint in zip(rows, joints, strict=True)),
        speed=path.number("speed_mm_s", positive=True, high=max_speed / MM) * MM,
        max_speed=max_speed,
        acceleration=path.number("acceleration_mm_s2", positive=True) * MM,
        lengths=(lengths[0], lengths[1]),
    )
    for each in (path, *rows, table):  # inner tables first: a misspelt key of a joint is reported at the joint
        each.done()
    return found


def _check_joints(table: Table, rows: Sequence[Table], joints: Sequence[Joint], kind: str) -> None:
    """Refuse joints that a mechanism of this kind lacks, does not have, or has in another order; RBL608, 610, 613."""
    names, order = [joint.name for joint in joints], ORDER[kind]
    for needed in NEEDED[kind]:
        if needed not in names:
            table.fail("RBL608", f"a {kind} mechanism must have the joint '{needed}'", key="joints")
    for row, joint in zip(rows, joints, strict=True):
        _check_joint(row, joint, kind)
    # in one order for all files: channels, tables and manifests name joints by their position too
    places = [order.index(each) for each in names]
    if places != sorted(set(places)):
        message = f"the joints of a {kind} mechanism must be in this order, each once: {', '.join(order)}"
        table.fail("RBL610", message, key="joints")


def _check_joint(row: Table, joint: Joint, kind: str) -> None:
    if joint.name not in ORDER[kind]:
        known = ", ".join(ORDER[kind])
        row.fail("RBL610", f"'{joint.name}' is not a joint of a {kind} mechanism: {known}", key="name")
    if joint.rotary != joint.name.startswith("theta"):
        does, unit = ("slides", "mm") if joint.rotary else ("turns", "deg")
        row.fail("RBL613", f"'{joint.name}' {does}: give its values in {unit}", key="name")


def _joint(row: Table) -> Joint:
    """Return the joint of a ``[[joints]]``; the unit of its range decides whether it turns."""
    rotary = "range_deg" in row
    unit, scale = ("deg", DEG) if rotary else ("mm", MM)
    lower, upper = row.numbers(f"range_{unit}", 2)
    if not lower < upper:
        row.fail("RBL607", f"'range_{unit}' must be [lower, upper]", key=f"range_{unit}")
    # optional: of many mechanisms only the speed of the tool is known
    speed, acceleration = (
        row.number(key, positive=True) * scale if key in row else np.inf
        for key in (f"speed_{unit}_s", f"acceleration_{unit}_s2")
    )
    return Joint(
        name=row.text("name"),
        rotary=rotary,
        lower=lower * scale,
        upper=upper * scale,
        speed=float(speed),
        acceleration=float(acceleration),
    )


def _home(row: Table, joint: Joint) -> float:
    unit, scale = ("deg", DEG) if joint.rotary else ("mm", MM)
    return row.number(f"home_{unit}", low=joint.lower / scale, high=joint.upper / scale) * scale


def _pulse(row: Table, joint: Joint) -> float:
    unit, scale = ("deg", DEG) if joint.rotary else ("mm", MM)
    return row.number(f"pulse_{unit}", positive=True) * scale
