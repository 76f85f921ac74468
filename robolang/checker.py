"""Meaning: what is wrong with a program that parses.

Every limit is written so that NaN fails it. Limits of the robot's own (reach, joints, speed) belong to the planner
and are found before the move that breaks them; here are the limits that hold for every robot, and the facts of
the cell that need no kinematics: its names (taught points, sensors) and what the arm may carry. Time is linear in the
program.
"""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import chain, islice

from robolang.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Related, Severity, in_order
from robolang.nodes import (
    Accel,
    Component,
    Expression,
    Hand,
    Line,
    Load,
    Move,
    Name,
    Negate,
    Node,
    Option,
    Program,
    Seam,
    Speed,
    Time,
    Wrist,
    constant,
)
from robolang.source import Span
from robolang.words import near

MAX_COG_MM = 2000.0
MAX_SPEED_MM_S = 10_000.0
MAX_ACCEL_PCT = 100.0
MAX_SECONDS = 600.0
MAX_HELD = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class _Facts:
    """What is known of the cell; None: not known, not checked."""

    points: frozenset[str] | None
    rated_payload_kg: float | None
    sensors: frozenset[str] | None


def check(
    program: Program,
    *,
    points: Collection[str] | None = None,
    rated_payload_kg: float | None = None,
    sensors: Collection[str] | None = None,
) -> tuple[Diagnostic, ...]:
    """Return what is wrong with a program, by place.

    Args:
        program: the tree; ``Unparsed`` statements are passed over, the parser has reported them.
        points: names of the taught points, in any case; None when they are not known.
        rated_payload_kg: what the robot may carry; None when the robot is not known.
        sensors: names of the cell's seam sensors, in any case; None when the cell is not known.
    """
    facts = _Facts(points=_keys(points), rated_payload_kg=rated_payload_kg, sensors=_keys(sensors))
    found = chain(_line_numbers(program), _emptiness(program), _statements(program, facts))
    return in_order(islice(found, MAX_DIAGNOSTICS + 1))


def _keys(names: Collection[str] | None) -> frozenset[str] | None:
    return None if names is None else frozenset(name.upper() for name in names)


def _statements(program: Program, facts: _Facts) -> Iterator[Diagnostic]:
    for line in program.statements:
        statement = line.statement
        if isinstance(statement, Move):
            yield from _move(statement, facts)
        elif isinstance(statement, Load):
            yield from _load(statement, facts)
        elif isinstance(statement, Hand):
            yield from _hand(statement)
        elif isinstance(statement, Wrist):
            yield from _wrist(statement)
        elif isinstance(statement, Seam):
            yield from _seam(statement, facts)


def _emptiness(program: Program) -> Iterator[Diagnostic]:
    if not program.statements:
        yield Diagnostic(
            code="RBL201",
            severity=Severity.WARNING,
            message="the program has no instruction: nothing will move",
            span=Span(0, 0),
        )


def _line_numbers(program: Program) -> Iterator[Diagnostic]:
    first: dict[int, Line] = {}
    previous = -1
    for line in program.lines:
        if line.number is None:
            continue
        if other := first.get(line.number):
            related = (Related(span=other.number_span, message="first used here"),)
            message = f"line number {line.number} is used twice"
            yield Diagnostic(code="RBL113", message=message, span=line.number_span, related=related)
        elif line.number < previous:
            message = f"line number {line.number} comes after {previous}"
            yield Diagnostic(code="RBL116", severity=Severity.WARNING, message=message, span=line.number_span)
        first.setdefault(line.number, line)
        previous = line.number


def _move(move: Move, facts: _Facts) -> Iterator[Diagnostic]:
    if facts.points is not None and move.target.key not in facts.points:
        message = f"point {move.target.text} is not taught"
        hint = _names(move.target, facts.points, known="taught", none="no point is taught")
        yield Diagnostic(code="RBL301", message=message, span=move.target.span, hint=hint)
    seen: dict[type, Option] = {}
    for option in move.options:
        word = type(option).__name__.upper()
        if earlier := seen.get(type(option)):
            yield _twice(word, option.span, earlier.span)
        seen.setdefault(type(option), option)
        yield from _wrist(option) if isinstance(option, Wrist) else _value(option, word)
    if Speed in seen and Time in seen:
        message = "TIME fixes how long the move takes, so SPEED cannot be given too"
        related = (Related(span=seen[Time].span, message="TIME is given here"),)
        yield Diagnostic(code="RBL119", message=message, span=seen[Speed].span, related=related)


def _names(name: Name, names: frozenset[str], *, known: str, none: str) -> str:
    """Return what a name that is not among ``names`` was probably meant to be, or which there are, or ``""``."""
    if guess := near(name.key, names):
        return f"did you mean {guess}?"
    if not names:
        return none
    return f"{known}: {', '.join(sorted(names))}" if len(names) <= 10 else ""


def _twice(word: str, place: Span, first: Span) -> Diagnostic:
    related = (Related(span=first, message="first given here"),)
    return Diagnostic(code="RBL118", message=f"{word} is given twice", span=place, related=related)


def _wrist(wrist: Wrist) -> Iterator[Diagnostic]:
    seen: dict[Component, Span] = {}
    for component, place in zip(wrist.held, wrist.held_spans, strict=True):
        if first := seen.get(component):
            yield _twice(component.value, place, first)
        elif len(seen) >= MAX_HELD:
            message = f"{component.value} is one too many: the wrist can hold at most two components"
            yield Diagnostic(code="RBL120", message=message, span=place)
        seen.setdefault(component, place)


def _seam(seam: Seam, facts: _Facts) -> Iterator[Diagnostic]:
    sensor = seam.sensor
    if sensor is not None and facts.sensors is not None and sensor.key not in facts.sensors:
        hint = _names(sensor, facts.sensors, known="seam sensors", none="the cell has no seam sensor")
        message = f"the cell has no seam sensor {sensor.text}"
        yield Diagnostic(code="RBL306", message=message, span=sensor.span, hint=hint)


def _value(option: Speed | Accel | Time, word: str) -> Iterator[Diagnostic]:
    value = constant(option.value)
    if value is None:
        yield _no_value(option.value)
        return
    high, unit = _range(option)
    if not 0.0 < value <= high:
        message = f"{word} is {value:g} {unit} and must be above 0 and at most {high:g} {unit}"
        yield Diagnostic(code="RBL404", message=message, span=option.value.span)


def _range(option: Speed | Accel | Time) -> tuple[float, str]:
    if isinstance(option, Speed):
        return MAX_SPEED_MM_S, "mm/s"
    return (MAX_ACCEL_PCT, "%") if isinstance(option, Accel) else (MAX_SECONDS, "s")


def _load(load: Load, facts: _Facts) -> Iterator[Diagnostic]:
    parts = (load.cog.x, load.cog.y, load.cog.z)
    values = [constant(part) for part in (*parts, load.mass)]
    yield from (_no_value(part) for part, value in zip((*parts, load.mass), values, strict=True) if value is None)
    mass = values.pop()
    if mass is not None:
        yield from _mass(mass, load.mass, facts)
    cog = [value for value in values if value is not None]
    if len(cog) == 3:
        yield from _centre(cog, mass, load.cog)


def _mass(mass: float, place: Expression, facts: _Facts) -> Iterator[Diagnostic]:
    if not (mass >= 0.0 and math.isfinite(mass)):
        message = f"a payload of {mass:g} kg is not a mass"
        yield Diagnostic(code="RBL401", message=message, span=place.span)
    elif facts.rated_payload_kg is not None and not mass <= facts.rated_payload_kg:
        grams = mass / 1000.0 <= facts.rated_payload_kg and mass >= 50.0
        hint = f"LOAD takes kg: {mass:g} g is {mass / 1000.0:g} kg" if grams else ""
        message = f"a payload of {mass:g} kg is more than the {facts.rated_payload_kg:g} kg the robot is rated for"
        yield Diagnostic(code="RBL402", message=message, span=place.span, hint=hint)


def _centre(cog: list[float], mass: float | None, place: Node) -> Iterator[Diagnostic]:
    distance = math.hypot(*cog)
    shown = ", ".join(f"{value:g}" for value in cog)
    if not all(map(math.isfinite, cog)):
        yield Diagnostic(code="RBL403", message=f"the centre of gravity ({shown}) mm is not a place", span=place.span)
    elif mass != 0.0 and not distance <= MAX_COG_MM:
        message = f"the centre of gravity is {distance:g} mm from the flange, more than {MAX_COG_MM:g} mm"
        yield Diagnostic(code="RBL403", message=message, span=place.span)


def _hand(hand: Hand) -> Iterator[Diagnostic]:
    if hand.dwell is None:
        return
    value = constant(hand.dwell)
    if value is None:
        yield _no_value(hand.dwell)
    elif not 0.0 <= value <= MAX_SECONDS:
        message = f"a wait of {value:g} s is not between 0 s and {MAX_SECONDS:g} s"
        yield Diagnostic(code="RBL405", message=message, span=hand.dwell.span)


def _no_value(expression: Expression) -> Diagnostic:
    while isinstance(expression, Negate):
        expression = expression.operand
    assert isinstance(expression, Name)
    message = f"{expression.text} is a name where a number is needed; variables are not in this edition yet"
    return Diagnostic(code="RBL117", message=message, span=expression.span)
