"""Canonical text of the tree: keywords in capitals, one space between words, names as the user spelt them.

What is printed parses back to an equal tree. Used for live progress (``describe``) and, later, by the
formatter.
"""

from robolang.nodes import (
    Accel,
    Expression,
    Hand,
    Line,
    Load,
    Move,
    Name,
    Negate,
    Number,
    Option,
    Program,
    Seam,
    Speed,
    Statement,
    Wrist,
)


def describe(statement: Statement) -> str:
    """Return a statement as canonical text, such as ``MOVE P1, SPEED 200``."""
    if isinstance(statement, Move):
        return ", ".join([f"MOVE {statement.target.text}", *map(_option, statement.options)])
    if isinstance(statement, Load):
        cog = ", ".join(map(_expression, (statement.cog.x, statement.cog.y, statement.cog.z)))
        return f"LOAD ({cog}), {_expression(statement.mass)}"
    if isinstance(statement, Hand):
        dwell = "" if statement.dwell is None else f", {_expression(statement.dwell)}"
        return f"HAND {statement.state.value}{dwell}"
    if isinstance(statement, Wrist):
        return _wrist(statement)
    if isinstance(statement, Seam):
        return "SEAM OFF" if statement.sensor is None else f"SEAM ON, {statement.sensor.text}"
    return statement.text


def print_line(line: Line) -> str:
    """Return one line as canonical text without a line end."""
    number = [] if line.number is None else [str(line.number)]
    statement = [] if line.statement is None else [describe(line.statement)]
    comment = [] if line.comment is None else [line.comment.text]
    return " ".join([*number, *statement, *comment])


def print_program(program: Program) -> str:
    """Return the lines of a program, each with a line end; blank lines are not kept."""
    return "".join(f"{print_line(line)}\n" for line in program.lines)


def _option(option: Option) -> str:
    if isinstance(option, Wrist):
        return _wrist(option)
    word = "SPEED" if isinstance(option, Speed) else "ACCEL" if isinstance(option, Accel) else "TIME"
    return f"{word} {_expression(option.value)}"


def _wrist(wrist: Wrist) -> str:
    held = f" {', '.join(component.value for component in wrist.held)}" if wrist.held else ""
    return f"WRIST {wrist.mode.value}{held}"


def _expression(expression: Expression) -> str:
    signs = 0
    while isinstance(expression, Negate):
        signs, expression = signs + 1, expression.operand
    assert isinstance(expression, Number | Name)
    return "-" * signs + expression.text
