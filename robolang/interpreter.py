"""The main program: one statement after another, each yielded as an effect.

Fig 4 of the 1992 controller tests the instruction in the order MOVE (100), LOAD (104), HAND OFF (108), HAND ON
(112) and then takes the next one. The four exclude one another, so dispatch on the type of the statement is the same
program; the order of the tests below is kept all the same, and WRIST and SEAM follow. Nothing is computed ahead: the
generator stands at the statement whose effect it yielded until the session asks for the next, which is when that
statement is done.
"""

from collections.abc import Iterator

from robolang.effects import Effect, MoveTo, SetHand, SetPayload, SetSeam, SetWrist
from robolang.nodes import (
    Accel,
    Expression,
    Hand,
    HandState,
    Line,
    Load,
    Move,
    Program,
    Seam,
    Speed,
    Time,
    Wrist,
    WristMode,
    constant,
)


def execute(program: Program) -> Iterator[Effect]:
    """Yield the effects of a checked program in order.

    What a WRIST statement says holds for the moves that follow, and each of them carries it.

    Raises ``ValueError`` at a statement with an error: such a program must not be run.
    """
    setting: Wrist | None = None
    for line in program.statements:
        if isinstance(line.statement, Wrist):
            setting = line.statement
        yield _effect(line, setting)


def _effect(line: Line, setting: Wrist | None) -> Effect:
    statement = line.statement
    if isinstance(statement, Move):
        return _move(line, statement, setting)
    if isinstance(statement, Load):
        return _load(line, statement)
    if isinstance(statement, Hand):
        return _hand(line, statement)
    if isinstance(statement, Wrist):
        return _wrist(line, statement)
    if isinstance(statement, Seam):
        return _seam(line, statement)
    raise ValueError(f"line {line.source_line} has an error and cannot be run")


def _move(line: Line, node: Move, setting: Wrist | None) -> MoveTo:
    values: dict[type, float] = {}
    wrist = setting
    for option in node.options:
        if isinstance(option, Wrist):
            wrist = option
        else:
            values[type(option)] = _value(option.value, line)
    return MoveTo(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        point=node.target.key,
        speed_mm_s=values.get(Speed),
        accel_pct=values.get(Accel),
        time_s=values.get(Time),
        wrist=None if wrist is None else _mode(wrist),
        held=() if wrist is None else _held(wrist),
    )


def _load(line: Line, node: Load) -> SetPayload:
    x, y, z = (_value(item, line) for item in (node.cog.x, node.cog.y, node.cog.z))
    return SetPayload(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        cog_mm=(x, y, z),
        mass_kg=_value(node.mass, line),
    )


def _hand(line: Line, node: Hand) -> SetHand:
    return SetHand(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        closed=node.state is HandState.ON,
        dwell_s=None if node.dwell is None else _value(node.dwell, line),
    )


def _wrist(line: Line, node: Wrist) -> SetWrist:
    return SetWrist(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        mode=_mode(node),
        held=_held(node),
    )


def _mode(wrist: Wrist) -> str:
    return "keep" if wrist.mode is WristMode.KEEP else "auto"


def _held(wrist: Wrist) -> tuple[str, ...]:
    return tuple(component.value for component in wrist.held)


def _seam(line: Line, node: Seam) -> SetSeam:
    return SetSeam(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        sensor=None if node.sensor is None else node.sensor.key,
    )


def _value(expression: Expression, line: Line) -> float:
    value = constant(expression)
    if value is None:
        raise ValueError(f"line {line.source_line} uses a name without a value and cannot be run")
    return value
