"""Jogging at a prompt: frames, steps, what is typed, and the plan of a jog for the live controller.

A typed amount is free; the step lists are for keys. A jog counts in the frame of its settings: joints, or X to RZ
of the world, of the base, of the tool or of the FRAME in force. What is typed names its axis itself: ``J3`` is a joint
in every frame, and ``X`` is along the world while the frame is that of the joints.

Used by prompt, page and editor. mm and deg outside, m and rad inside.
"""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias, get_args

import numpy as np

from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM, PERCENT
from runtime.motion.jog import Jog, JogPlan, JogPlanner, JointJog, ToolJog
from runtime.robot.model.spec import RobotSpec

JogFrame: TypeAlias = Literal["joint", "world", "base", "tool", "user"]
"""In what a jog counts; ``user`` is the FRAME in force."""

FRAMES: tuple[JogFrame, ...] = get_args(JogFrame)
"""All of them, in the order in which a key goes through them."""

DIRECTIONS = ("X", "Y", "Z", "RX", "RY", "RZ")
"""Directions of a jog of the tool."""

LINEAR_STEPS = (0.1, 1.0, 10.0, 50.0, 100.0)
"""Steps of keys along X Y Z, mm."""

ANGULAR_STEPS = (0.1, 1.0, 5.0, 10.0, 45.0)
"""Steps of keys about X Y Z and of joints, deg."""

SLOWEST, FASTEST = 1.0, 100.0
"""Jog speeds, %."""

FARTHEST, FARTHEST_TURN = 10_000.0, 720.0
"""Largest amounts, mm and deg: more is a slip of the keyboard."""

LEAST = 0.001
"""Smallest amount, mm or deg: a thousandth, the last digit that is shown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JogSettings:
    """How keys and typed jogs move the arm: ``linear_step`` mm, ``angular_step`` deg, ``speed`` % of that of MANUAL."""

    frame: JogFrame = "world"
    linear_step: float = 10.0
    angular_step: float = 5.0
    speed: float = 25.0

    def __post_init__(self) -> None:
        # a face checks what is typed by ``with_speed``; a bad value here is a mistake in our own code
        if self.linear_step not in LINEAR_STEPS or self.angular_step not in ANGULAR_STEPS or self.frame not in FRAMES:
            raise ValueError(f"{self.frame}, {self.linear_step} mm, {self.angular_step} deg are no settings of a jog")
        if not SLOWEST <= self.speed <= FASTEST:
            raise ValueError(f"a jog speed of {self.speed} % is out of range")

    def with_speed(self, percent: float) -> "JogSettings":
        """Return the settings at another speed; ``Fault`` RBL404 out of 1 to 100 %."""
        if not SLOWEST <= percent <= FASTEST:
            given, low, high = beside(percent, SLOWEST, FASTEST)
            raise Fault("RBL404", f"a jog speed of {given} % is not from {low} to {high} %", "Give 1 to 100.")
        return replace(self, speed=percent)

    def with_frame(self, name: str) -> "JogSettings":
        """Return the settings in another frame; ``Fault`` RBL720 where there is none of the name."""
        for frame in FRAMES:
            if frame == name.lower():
                return replace(self, frame=frame)
        raise Fault("RBL720", f"{name!r} is no frame of a jog", f"Give {', '.join(FRAMES[:-1])} or {FRAMES[-1]}.")

    def next_frame(self) -> "JogSettings":
        """Return the settings in the frame after this one; after the last comes the first."""
        return replace(self, frame=FRAMES[(FRAMES.index(self.frame) + 1) % len(FRAMES)])

    def stepped(self, by: int, *, angular: bool) -> "JogSettings":
        """Return the settings with the step ``by`` places on in its list, no further than its ends."""
        steps, here = (ANGULAR_STEPS, self.angular_step) if angular else (LINEAR_STEPS, self.linear_step)
        step = steps[min(max(steps.index(here) + by, 0), len(steps) - 1)]
        return replace(self, angular_step=step) if angular else replace(self, linear_step=step)

    def step(self, axis: str, sliding: Collection[str] = ()) -> float:
        """Return the step of a key for an axis, mm or deg; ``sliding``: the joints that slide."""
        return self.linear_step if is_linear(axis, sliding) else self.angular_step


@dataclass(frozen=True, slots=True, kw_only=True)
class JogRequest:
    """A jog as it is typed: ``axis`` (J1 to J7, or one of ``DIRECTIONS``) by ``amount`` mm or deg; ``slides``: a joint
    that slides, by mm.

    An infinite amount goes as far as it can in that direction: keys that are held.
    """

    axis: str
    amount: float
    slides: bool = False

    @property
    def unit(self) -> str:
        """Unit of the amount."""
        return "mm" if self.slides or is_linear(self.axis) else "deg"

    @property
    def size(self) -> float:
        """The unit in SI."""
        return MM if self.unit == "mm" else DEG


def is_linear(axis: str, sliding: Collection[str] = ()) -> bool:
    """Return whether a jog of an axis is counted in mm; ``sliding``: the joints that slide."""
    return axis in ("X", "Y", "Z") or axis in sliding


def sliding_of(robot: RobotSpec) -> frozenset[str]:
    """Return the names of the joints that slide, such as J3."""
    return frozenset(f"J{number}" for number, axis in enumerate(robot.axes, 1) if axis.kind.slides)


def axes_of(joints: int) -> tuple[str, ...]:
    """Return the axes that an arm of so many joints can be jogged by."""
    return (*(f"J{number}" for number in range(1, joints + 1)), *DIRECTIONS)


def read_jog(text: str, joints: int, sliding: Collection[str] = ()) -> JogRequest:
    """Return the jog of a text such as ``J3 +5``, ``X -10`` or ``RZ 2`` for an arm of so many joints, of which those
    named by ``sliding`` slide.

    ``Fault`` RBL720 where it names no axis of the arm or no number, RBL404 for an amount out of range.
    """
    words = text.split()
    axes = axes_of(joints)
    if not words or words[0].upper() not in axes:
        named = f"{words[0]!r} is no axis of this arm" if words else "a jog names an axis"
        raise Fault("RBL720", named, f"Give J1 to J{joints}, X, Y, Z, RX, RY or RZ, then mm or deg: X -10.")
    # a sign may stand apart from its number, as in Z - 10
    axis = words[0].upper()
    return JogRequest(axis=axis, amount=_amount(axis, "".join(words[1:]), sliding), slides=axis in sliding)


def _amount(axis: str, text: str, sliding: Collection[str]) -> float:
    unit, most = ("mm", FARTHEST) if is_linear(axis, sliding) else ("deg", FARTHEST_TURN)
    try:
        amount = float(text)
    except ValueError:
        amount = math.nan
    # float() reads more than a person means by a number: inf, nan and 1_0
    if not math.isfinite(amount) or not set(text.lower()) <= set("+-.0123456789e"):
        found = f"{text!r} is no number" if text else "the amount is missing"
        raise Fault("RBL720", f"{found} of {unit} to jog {axis} by", f"Give a number, as in {axis} -10.")
    if not LEAST <= abs(amount) <= most:
        given, low, high = beside(abs(amount), LEAST, most)
        raise Fault("RBL404", f"a jog of {axis} by {given} {unit} is not from {low} to {high} {unit}")
    return amount


def jog_of(request: JogRequest, frames: Mapping[JogFrame, Array], frame: JogFrame) -> Jog:
    """Return a request in SI; ``frames`` are the poses (4, 4) in the base of all frames but ``joint``."""
    if request.axis.startswith("J"):
        return JointJog(axis=int(request.axis[1:]) - 1, amount=request.amount * request.size)
    X_base_frame = frames["world" if frame == "joint" else frame]
    return ToolJog.along(X_base_frame, DIRECTIONS.index(request.axis), request.amount * request.size)


def plan_jog(
    controller: Controller, request: JogRequest, settings: JogSettings, X_world_user: Array | None = None
) -> JogPlan:
    """Return the plan of a jog from where the command of a controller stands, for the tool in use.

    ``X_world_user`` (4, 4): the FRAME in force, None: the world. ``Fault`` RBL404, 410, 411 or 412 where it cannot be
    carried out, RBL720 while the arm moves.
    """
    if controller.moving:
        raise Fault("RBL720", "the arm moves", "Wait until it stands, or stop it.")
    q = np.array(controller.areas.ina)
    world = np.eye(4)
    frames: dict[JogFrame, Array] = {
        "world": world,
        "base": world,  # the base stands at the origin of the world
        "tool": controller.tool_poses(q),
        "user": world if X_world_user is None else X_world_user,
    }
    planner = JogPlanner(controller.spec, controller.kinematics, controller.profile)
    jog = jog_of(request, frames, settings.frame)
    return planner.plan(q, jog, controller.X_flange_tool, settings.speed * PERCENT)
