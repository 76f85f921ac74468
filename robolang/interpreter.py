"""The main program: one statement after another, each yielded as an effect.

Fig 4 of the 1992 controller tests the instruction in the order MOVE (100), LOAD (104), HAND OFF (108), HAND ON
(112) and then takes the next one. The four exclude one another, so dispatch on the type of the statement is the same
program; the order of the tests below is kept all the same. Nothing is computed ahead: the generator stands at the
statement whose effect it yielded until the session asks for the next, which is when that statement is done.
"""

from collections.abc import Iterator

from robolang.effects import Effect, MoveTo, SetHand, SetPayload
from robolang.nodes import (
    Accel,
    Expression,
    Hand,
    HandState,
    Line,
    Load,
    Move,
    Program,
    Speed,
    Time,
    constant,
)


def execute(program: Program) -> Iterator[Effect]:
    """Yield the effects of a checked program in order.

    Raises ``ValueError`` at a statement with an error: such a program must not be run.
    """
    for line in program.statements:
        yield _effect(line)


def _effect(line: Line) -> Effect:
    statement = line.statement
    if isinstance(statement, Move):
        return _move(line, statement)
    if isinstance(statement, Load):
        return _load(line, statement)
    if isinstance(statement, Hand):
        return _hand(line, statement)
    raise ValueError(f"line {line.source_line} has an error and cannot be run")


def _move(line: Line, node: Move) -> MoveTo:
    values: dict[type, float] = {type(option): _value(option.value, line) for option in node.options}
    return MoveTo(
        line=line.source_line,
        number=line.number,
        span=node.span,
        node=node,
        point=node.target.key,
        speed_mm_s=values.get(Speed),
        accel_pct=values.get(Accel),
        time_s=values.get(Time),
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


def _value(expression: Expression, line: Line) -> float:
    value = constant(expression)
    if value is None:
        raise ValueError(f"line {line.source_line} uses a name without a value and cannot be run")
    return value
