"""Statements that act: each requests one thing of the robot or its cell, and becomes one effect.

Moves, payload, hand, wrist, seam, tool and outputs, and the settings that hold for the moves which follow: SPEED,
SPEEDJ, ACCEL, OVERRIDE, ZONE and FRAME have no effect of their own, every move carries what they have set. An option of
a move wins over what was set, for this move. Called by the interpreter when it reaches the statement; expressions are
evaluated then, in the units of the text.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, TypeGuard

from robolang.evaluation.evaluator import Evaluator
from robolang.interpreter import effects
from robolang.interpreter.effects import Effect, origin
from robolang.interpreter.scope import Scopes
from robolang.syntax.ast import (
    Accel,
    Approach,
    Depart,
    Expression,
    Hand,
    HandState,
    Line,
    Load,
    LoadNamed,
    Move,
    MoveC,
    MoveJ,
    Moving,
    Name,
    Out,
    Pulse,
    Seam,
    Setting,
    Speed,
    Spline,
    Time,
    Vector,
    Wrist,
    WristMode,
    Zone,
)
from robolang.values.functions import finite
from robolang.values.poses import Frame, Place, Shift, Six
from runtime.core import limits
from runtime.core.faults import Fault

Action: TypeAlias = Moving | Load | LoadNamed | Hand | Wrist | Seam | Setting | Out | Pulse

WORLD = "WORLD"
"""The frame that every cell has, and none may define; its tool is FLANGE (``runtime.cell.cell_file``)."""
_SET = {
    "SPEED": "speed_mm_s",
    "SPEEDJ": "speed_pct",
    "ACCEL": "accel_pct",
    "OVERRIDE": "override_pct",
    "ZONE": "zone_mm",
}
"""What each setting sets."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What SPEED, ACCEL, WRIST and the like have set for the moves that follow."""

    speed_mm_s: float | None = None
    speed_pct: float | None = None
    accel_pct: float | None = None
    override_pct: float = 100.0
    zone_mm: float = 0.0
    wrist: Wrist | None = None


_PATHS: dict[type, effects.PathKind] = {MoveJ: "joint", MoveC: "arc", Spline: "spline"}
"""The paths of moves that are not straight."""
_OPTIONS: dict[type, tuple[str, limits.Limit]] = {
    Speed: ("speed_mm_s", limits.SPEED),
    Accel: ("accel_pct", limits.ACCEL),
    Time: ("time_s", limits.TIME),
    Zone: ("zone_mm", limits.ZONE),
}
"""What each option of a move gives, and its range; of a MOVEJ, SPEED is ``_JOINT_SPEED``."""
_JOINT_SPEED = ("speed_pct", limits.SPEED_PCT)
_BY_WORD = {"zone_mm": 0.0, "accel_pct": math.inf}
"""What FINE and MAX stand for: a word in the place of a value."""


class Actions:
    """Turns the statements that act into effects, and keeps what the settings have set."""

    def __init__(self, values: Evaluator, scopes: Scopes) -> None:
        self._values, self._scopes = values, scopes
        self.settings = Settings()

    def effect(self, line: Line, node: Action) -> Effect | None:
        """Return what a statement requests, None for a setting; ``Fault`` where it has no value or is out of range."""
        return _EFFECT[type(node)](self, line, node)

    # --- motion ------------------------------------------------------------------------------------------------------

    def _move(self, line: Line, node: Moving) -> Effect:
        values, wrist = self._options(node)
        *via, target = self._places(node)
        return effects.MoveTo(
            **origin(line, node),
            path=_PATHS.get(type(node), "line"),
            target=target,
            via=tuple(via),
            wrist=None if wrist is None else _mode(wrist),
            held=() if wrist is None else _held(wrist),
            override_pct=self.settings.override_pct,
            **values,
        )

    def _places(self, node: Moving) -> list[Place]:
        """Return the places over which a move leads, and the one where it ends."""
        if isinstance(node, Spline):
            return [self._values.place(point) for point in node.points]
        target = self._target(node)
        return [self._values.place(node.via), target] if isinstance(node, MoveC) else [target]

    def _target(self, node: Move | MoveJ | MoveC | Approach | Depart) -> Place:
        if isinstance(node, Depart):
            # where the motion before ends is not known yet: moves may still be in progress when this is evaluated
            return Place(last=True).shifted(_back(self._distance(node.distance)))
        place = self._values.place(node.target)
        return place.shifted(_back(self._distance(node.distance))) if isinstance(node, Approach) else place

    def _distance(self, node: Expression) -> float:
        return limits.DISTANCE.checked(self._values.number(node))

    def _options(self, node: Moving) -> tuple[dict[str, Any], Wrist | None]:
        """Return the values of a move: its options', else those that were set."""
        joint, settings, wrist = isinstance(node, MoveJ), self.settings, self.settings.wrist
        values: dict[str, Any] = {"accel_pct": settings.accel_pct, "zone_mm": settings.zone_mm}
        for option in node.options:  # in the order of the text: of two that are out of range the first is reported
            if isinstance(option, Wrist):
                wrist = option
                continue
            name, limit = _JOINT_SPEED if joint and isinstance(option, Speed) else _OPTIONS[type(option)]
            values[name] = self._number(option.value, name, limit)
        if "time_s" not in values:  # a duration replaces the speed that was set, not one in the move itself
            name = "speed_pct" if joint else "speed_mm_s"
            values.setdefault(name, getattr(settings, name))
        return values, wrist

    # --- payload, hand, wrist, seam ----------------------------------------------------------------------------------

    def _load(self, line: Line, node: Load) -> Effect:
        # the ranges are those of the payload model, which the lowering applies; here the tree gives the counts alone
        cog, inertia = self._vector(node.cog), () if node.inertia is None else self._vector(node.inertia)
        if len(cog) != 3 or len(inertia) not in (0, 6):
            raise Fault("RBL403", "LOAD takes three coordinates of the centre of gravity, and six of an inertia")
        return effects.SetPayload(
            **origin(line, node),
            cog_mm=(cog[0], cog[1], cog[2]),
            inertia_kg_m2=tuple(inertia),
            mass_kg=self._values.number(node.mass),
        )

    def _vector(self, node: Vector) -> list[float]:
        return [self._values.number(item) for item in node.items]

    def _load_named(self, line: Line, node: LoadNamed) -> Effect:
        return effects.SetPayload(**origin(line, node), name=node.name.key)

    def _hand(self, line: Line, node: Hand) -> Effect:
        return effects.SetHand(
            **origin(line, node),
            closed=node.state is HandState.ON,
            dwell_s=None if node.dwell is None else limits.DWELL.checked(self._values.number(node.dwell)),
        )

    def _wrist(self, line: Line, node: Wrist) -> Effect:
        self.settings = replace(self.settings, wrist=node)
        return effects.SetWrist(**origin(line, node), mode=_mode(node), held=_held(node))

    def _seam(self, line: Line, node: Seam) -> Effect:
        return effects.SetSeam(**origin(line, node), sensor=None if node.sensor is None else node.sensor.key)

    # --- settings ----------------------------------------------------------------------------------------------------

    def _setting(self, line: Line, node: Setting) -> Effect | None:
        if node.word == "TOOL":
            return effects.SetTool(**origin(line, node), tool=self._tool(node.value))
        if node.word == "FRAME":
            self._values.frame = self._frame(node.value)
            return None
        name = _SET[node.word]
        value: Any = self._number(node.value, name, limits.SETTINGS[node.word])
        self.settings = replace(self.settings, **{name: value})
        return None

    def _number(self, node: Expression | None, name: str, limit: limits.Limit) -> float:
        """Return the value of a setting or an option, None where a word stands for it; ``Fault`` RBL404, RBL415."""
        return _BY_WORD[name] if node is None else limit.checked(self._values.number(node))

    def _frame(self, node: Expression | None) -> Frame:
        """Return the frame that an expression names: a name of the cell, "" for ``WORLD``, else a pose in the world."""
        if self._is_of_cell(node):
            return "" if node.key == WORLD else node.key  # whether the cell has it is known to the lowering
        return self._in_the_world(node)

    def _tool(self, node: Expression | None) -> Frame:
        """Return the tool that an expression names: a name of the cell, else a pose in the flange."""
        return node.key if self._is_of_cell(node) else self._in_the_world(node, of_flange=True)

    def _is_of_cell(self, node: Expression | None) -> TypeGuard[Name]:
        """Return whether a name has no value in the program, so that it must be one of the cell."""
        return isinstance(node, Name) and self._scopes.value(node.key) is None

    def _in_the_world(self, node: Expression | None, *, of_flange: bool = False) -> Six:
        """Return the numbers of a pose, whatever frame is active; of a flange's those that it was made of."""
        assert node is not None  # ACCEL alone has a word in place of a value
        # a FRAME is given in the world, so that two of them in a row do not add up
        frame, self._values.frame = self._values.frame, ""
        try:
            place = self._values.place(node)
            if of_flange and place.pose is not None:
                place = replace(place, frame="", shifts=tuple(replace(shift, frame="") for shift in place.shifts))
            if place.pose is not None and not (place.shifts or place.frame):
                return place.pose
            return self._values.six(place)
        finally:
            self._values.frame = frame

    # --- outputs -----------------------------------------------------------------------------------------------------

    def _out(self, line: Line, node: Out) -> Effect:
        return effects.SetOutput(
            **origin(line, node), output=self._output(node.index), value=finite(self._values.number(node.value), "OUT")
        )

    def _pulse(self, line: Line, node: Pulse) -> Effect:
        return effects.SetOutput(
            **origin(line, node),
            output=self._output(node.index),
            value=1.0,
            seconds=limits.PULSE.checked(self._values.number(node.seconds)),
        )

    def _output(self, node: Expression) -> int:
        return int(limits.OUTPUT.checked(self._values.number(node)))


_EFFECT: dict[type, Callable[..., Effect | None]] = {
    Move: Actions._move,
    MoveJ: Actions._move,
    MoveC: Actions._move,
    Spline: Actions._move,
    Approach: Actions._move,
    Depart: Actions._move,
    Load: Actions._load,
    LoadNamed: Actions._load_named,
    Hand: Actions._hand,
    Wrist: Actions._wrist,
    Seam: Actions._seam,
    Setting: Actions._setting,
    Out: Actions._out,
    Pulse: Actions._pulse,
}

ACTIONS = tuple(_EFFECT)
"""The kinds of statements that ``Actions.effect`` takes."""


def _back(distance: float) -> Shift:
    """Return the offset against the tool's approach axis, mm."""
    return Shift(kind="tool", by=(0.0, 0.0, -distance, 0.0, 0.0, 0.0))


def _mode(wrist: Wrist) -> str:
    return "keep" if wrist.mode is WristMode.KEEP else "auto"


def _held(wrist: Wrist) -> tuple[str, ...]:
    return tuple(component.value for component in wrist.held)
