"""Planning a jog: one joint, or the tool along or about an axis of a frame, by an amount or as far as it goes.

The course comes from ``jog_course``, its timing from ``jog_timing``: tool point and flange keep below the jog's share
of the cap of MANUAL, the joints below their limits at every servo tick, and the motion is slow only where it has to be.
An amount that the arm cannot do is refused before anything moves, with what it can do: RBL411 at the range of a joint,
RBL410 at the reach, RBL412 at a singularity. A jog as far as it goes (amount infinite) ends a little before that.

Called by ``robolang.teaching.jogging`` with the arm at rest; docs/jogging.md explains it. m, rad, s.
"""

import math
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul, norm
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.jog_course import Course, End, Ranges, ToolCourse, ToolPath, joint_course, reach
from runtime.motion.jog_timing import JogLimits, JogTiming, Slow
from runtime.motion.speed_cap import MANUAL_SPEED, PLANNED, speeds
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

JOINT_SPEED = 60.0 * DEG
"""Speed of a joint jog at 100 %, rad/s; no more than half of the joint's limit. One that slides goes at the cap."""

TURN_SPEED = 60.0 * DEG
"""Speed of a turn of the tool at 100 %, rad/s."""

FOLLOW_SPEED = 180.0 * DEG
"""What a joint may turn at in a jog of the tool at 100 %, rad/s: beside a singularity the tool creeps instead."""

STANDOFF = 0.1 * DEG
"""How far before a joint's limit a jog as far as it goes ends, rad; ``RobotSpec.bound`` of it where it slides."""

STANDOFF_REACH = 1.0 * MM
"""And before the end of the reach, m; turns end ``STANDOFF`` before it."""

EDGE = 5e-6
"""A jog to the very limit ends this much before it, rad: between set-points fine interpolation swings by less."""

LONGEST_S = 30.0
"""A jog as far as it goes is planned for this long at most, s: a press of a key shall be answered at once."""

_BETWEEN = 0.999
"""Points are timed at every fourth tick only, and are a little faster at others."""

TOUCH = 5e-6
"""How far before a limit a joint is kept that touches it on its course, rad: more than the command swings there."""

LEAST = 1e-7
"""A jog of less, m or rad, is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JointJog:
    """Move joint ``axis`` (0-based) by ``amount`` rad or m; infinite: as far as it goes in that direction."""

    axis: int
    amount: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolJog:
    """Move the tool point along ``vector`` (3,), a unit vector of the base frame, by ``amount`` m; infinite: as far.

    With ``turns``, turn the tool about it through the tool point, by ``amount`` rad, at most one turn.
    """

    vector: Array
    turns: bool
    amount: float

    @classmethod
    def along(cls, X_base_frame: Array, direction: int, amount: float) -> "ToolJog":
        """Return a jog along X, Y, Z (``direction`` 0 to 2) or about them (3 to 5) of a frame (4, 4)."""
        return cls(vector=frozen(X_base_frame[:3, direction % 3]), turns=direction >= 3, amount=amount)


Jog: TypeAlias = JointJog | ToolJog
"""What an arm can be asked to do by hand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JogPlan:
    """A planned jog: set-points ``rows`` (K, n) rad, 8 ms apart from the cycle after the start, from rest to rest.

    It ``goes`` so far (m or rad, signed as the jog), up to ``end``; ``limited`` says which limit of a joint that is.
    ``slow`` says where and why it is slower than its speed.
    """

    rows: Array
    goes: float
    end: End
    slow: Slow | None
    period_s: float
    limited: str = ""

    @property
    def seconds(self) -> float:
        """Time that it takes, s."""
        return len(self.rows) * self.period_s


class JogPlanner:
    """Plans jogs of one robot under one controller profile."""

    def __init__(self, spec: RobotSpec, kinematics: Kinematics, profile: Profile) -> None:
        self._spec, self._kinematics, self._period_s = spec, kinematics, profile.period_s
        fine = FineInterpolator(profile.ticks_per_cycle, profile.period_s, np.zeros(spec.n))
        self._timing = JogTiming(kinematics, fine, profile.period_s)
        self._speed, self._acceleration = spec.per_axis("limits", "speed"), spec.per_axis("limits", "acceleration")

    def plan(self, q_start: Array, jog: Jog, X_flange_tool: Array, speed: float) -> JogPlan:
        """Return the plan of a jog from rest at q_start (n,) rad at ``speed``, a share in (0, 1] of that of MANUAL.

        ``Fault`` RBL404, 410, 411 or 412 for an amount that the arm cannot do, and for a jog that leads nowhere;
        ``ValueError`` for an amount or a speed that is none.
        """
        if not (0.0 < speed <= 1.0):
            raise ValueError(f"a jog speed of {speed} is not a share in (0, 1]")
        if not abs(jog.amount) >= LEAST:
            raise ValueError(f"a jog by {jog.amount} is none")
        limits = self._limits(q_start, jog, X_flange_tool, speed)
        course = self._course(q_start, jog, X_flange_tool, limits.rate * LONGEST_S)
        self._refuse(jog, course)
        timed = [self._timing.timed(piece, limits) for piece in course.pieces]
        rows = np.concatenate([each.q[1:] for each in timed])
        # a joint that just touches its limit is kept before it: between its samples a curve swings by 1e-6 rad, and
        # between the set-points that are cut the command swings by some more, which ``given_rows`` would refuse
        lower, upper = np.minimum(self._spec.lower, q_start), np.maximum(self._spec.upper, q_start)
        rows[:-1] = np.clip(rows[:-1], lower + TOUCH, upper - TOUCH)
        rows = np.clip(rows, lower, upper)
        slow = min((each.slow for each in timed if each.slow is not None), key=lambda each: each.share, default=None)
        goes = math.copysign(course.goes, jog.amount)
        return JogPlan(
            rows=frozen(rows),
            goes=goes,
            end=course.end,
            slow=slow,
            period_s=self._period_s,
            limited=self._limited(course.end),
        )

    def _course(self, q_start: Array, jog: Jog, X_flange_tool: Array, longest: float) -> Course:
        """Return where a jog leads; one as far as it goes no further than ``longest`` m or rad."""
        endless = math.isinf(jog.amount)
        amount = math.copysign(min(abs(jog.amount), longest), jog.amount) if endless else jog.amount
        ranges = self._ranges(q_start, endless)
        if isinstance(jog, JointJog):
            return _ended(joint_course(q_start, jog.axis, amount, ranges), endless)
        X = matmul(self._kinematics.forward(q_start), X_flange_tool)
        most = 2.0 * math.pi if jog.turns else norm(X[:3, 3]) + reach(self._kinematics, X_flange_tool)
        path = ToolPath(
            X_start=X,
            X_flange_tool=X_flange_tool,
            vector=jog.vector * math.copysign(1.0, jog.amount),
            turns=jog.turns,
            extent=min(abs(amount), most),
        )
        standoff = (STANDOFF if jog.turns else STANDOFF_REACH) if endless else 0.0
        course = ToolCourse(self._kinematics, path, q_start, ranges).find(standoff)
        if course.end.kind == "amount" and path.extent < abs(jog.amount):
            return replace(course, end=End(kind="turn" if jog.turns and path.extent == most else "time"))
        return course

    def _ranges(self, q_start: Array, endless: bool) -> Ranges:
        inside = self._spec.bound(STANDOFF) if endless else EDGE
        return Ranges.of(self._spec.lower, self._spec.upper, q_start, inside)

    def _limits(self, q_start: Array, jog: Jog, X_flange_tool: Array, speed: float) -> JogLimits:
        cap = MANUAL_SPEED * PLANNED * speed * _BETWEEN
        joints = np.minimum(self._speed, FOLLOW_SPEED * speed)
        if isinstance(jog, ToolJog):
            rate = TURN_SPEED * speed if jog.turns else cap
        else:
            # the distance of tool and flange from the axis stays, so one speed keeps the cap all along
            turn = np.eye(self._spec.n)[jog.axis]
            lever = float(speeds(self._kinematics, q_start, turn, X_flange_tool).max())
            usual = cap if self._spec.axes[jog.axis].kind.slides else JOINT_SPEED
            own = np.minimum(usual, 0.5 * self._speed[jog.axis]) * speed
            rate = float(np.minimum(own, cap / np.maximum(lever, LEAST)))
            joints = self._speed
        return JogLimits(rate=rate, speed=joints, acceleration=self._acceleration, cap=cap, X_flange_tool=X_flange_tool)

    def _refuse(self, jog: Jog, course: Course) -> None:
        """Refuse a jog that leads nowhere, or less far than its amount; ``Fault`` RBL410, 411 or 412."""
        if math.isinf(jog.amount):
            if course.goes >= LEAST:
                return
        elif course.end.kind == "amount":
            return
        code, why, hint = self._obstacle(course.end)
        unit, name = self._unit(jog)
        goes = math.floor(course.goes / unit * 1e3) / 1e3
        if math.isinf(jog.amount):
            raise Fault(code, f"the jog cannot begin: {why}", hint)
        amount, most = beside(abs(jog.amount) / unit, goes, form="g")
        raise Fault(code, f"the jog of {amount} {name} can go {most} {name} only: {why}", hint)

    def _unit(self, jog: Jog) -> tuple[float, str]:
        """Return the unit of the amount of a jog in SI, and its name."""
        if isinstance(jog, JointJog):
            kind = self._spec.axes[jog.axis].kind
            return kind.size, kind.unit
        return (DEG, "deg") if jog.turns else (MM, "mm")

    def _limited(self, end: End) -> str:
        """Return the limit of a joint that ends a course, in words; empty where another thing does."""
        if end.kind != "limit" or end.axis is None:
            return ""
        return f"J{end.axis + 1} is limited to {self._spec.axes[end.axis].kind.text(end.limit)}"

    def _obstacle(self, end: End) -> tuple[str, str, str]:
        """Return code, reason and advice for what ends a course."""
        if end.kind == "limit":
            return "RBL411", self._limited(end), "Jog less far, or in the other direction."
        if end.kind == "reach":
            return "RBL410", f"the rest is out of reach of {self._spec.name}", "Jog less far, or jog a joint."
        if end.kind == "turn":
            return "RBL404", "the tool turns by 360 deg at most", "Jog less far."
        return (
            "RBL412",
            "it meets a singularity that the joints cannot turn through",
            "Jog a joint, such as J5, to leave it.",
        )


def _ended(course: Course, endless: bool) -> Course:
    """Return the course of a joint jog; one as far as it goes that ends nowhere has taken as long as it may."""
    return replace(course, end=End(kind="time")) if endless and course.end.kind == "amount" else course
