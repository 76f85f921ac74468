"""Canonical text of the tree: keywords in capitals, names and numbers as spelt, one space between words.

What is printed parses back to an equal tree. Parentheses stand where the author wrote them and where the grammar needs
them: an operand without any is put into them when its level is lower than the lowest that its place can hold. The
levels are the rules of ``grammar.lark`` from the loosest to the tightest, ``OR AND NOT = + * -x ^``; a chain is flat,
so an operand of the chain's own level needs parentheses, in front as well: ``(a - b) - c`` is another tree than
``a - b - c``. An exponent is an operand with signs before it, so ``2^-x`` stands as it is and ``2^-(x^3)`` needs them.

Expressions are printed with a stack and not by recursion: parentheses in one another, at most 100, may hold ten levels
each. Used for progress, logs and pulse tables (``describe``), and by the formatter.
"""

from typing import TypeAlias, assert_never

from robolang.syntax import ast
from robolang.syntax.ast import Expression, Option, Statement
from robolang.syntax.keywords import FUNCTIONS, VALUES

_OR, _AND, _NOT, _COMPARE, _SUM, _PRODUCT, _SIGNED, _POWER, _EXPONENT, _OPERAND = range(10)
_SIGNS = {
    "OR": _OR,
    "XOR": _OR,
    "AND": _AND,
    **dict.fromkeys(("=", "<>", "<", ">", "<=", ">="), _COMPARE),
    "+": _SUM,
    "-": _SUM,
    "*": _PRODUCT,
    "/": _PRODUCT,
    "MOD": _PRODUCT,
    "^": _POWER,
}
_OPERAND_OF = {_OR: _AND, _AND: _NOT, _COMPARE: _SUM, _SUM: _PRODUCT, _PRODUCT: _SIGNED, _POWER: _OPERAND}
"""The lowest level of an operand of a chain, by the level of the chain."""
_WORDS = FUNCTIONS | VALUES
_QUOTE = '"'

_Piece: TypeAlias = str | tuple[Expression, int]
"""Text, or an expression with the lowest level that its place can hold."""

_Payload: TypeAlias = ast.Load | ast.LoadNamed | ast.Hand | ast.Wrist | ast.Seam | ast.Setting
_Data: TypeAlias = ast.Assign | ast.Dim | ast.Const | ast.Out | ast.Pulse | ast.Delay | ast.Wait | ast.Print
_Control: TypeAlias = (
    ast.If
    | ast.Block
    | ast.Head
    | ast.Case
    | ast.For
    | ast.Next
    | ast.Jump
    | ast.Sub
    | ast.CallSub
    | ast.Word
    | ast.OnError
)


def print_program(program: ast.Program) -> str:
    """Return the lines of a program, each with a line end; without indentation, and blank lines are not kept."""
    return "".join(f"{print_line(line)}\n" for line in program.lines)


def print_line(line: ast.Line) -> str:
    """Return one line as canonical text without a line end."""
    number = [] if line.number is None else [str(line.number)]
    comment = [] if line.comment is None else [line.comment.text]
    return " ".join([*number, *filter(None, [print_code(line)]), *comment])


def print_code(line: ast.Line) -> str:
    """Return the label and the statement of a line; ``""`` when it has neither."""
    label = [] if line.label is None else [f"*{line.label.text}"]
    statement = [] if line.statement is None else [describe(line.statement)]
    return " ".join([*label, *statement])


def describe(statement: Statement) -> str:
    """Return a statement as canonical text, such as ``MOVE P1, SPEED 200``."""
    match statement:
        case ast.Move() | ast.MoveJ() | ast.MoveC() | ast.Approach() | ast.Depart():
            return ", ".join([_moving(statement), *map(_option, statement.options)])
        case ast.Load() | ast.LoadNamed() | ast.Hand() | ast.Wrist() | ast.Seam() | ast.Setting():
            return _payload(statement)
        case ast.Unparsed():
            return statement.text
        case ast.Assign() | ast.Dim() | ast.Const() | ast.Out() | ast.Pulse() | ast.Delay() | ast.Wait() | ast.Print():
            return _data(statement)
        case _:
            return _control(statement)


def _moving(node: ast.Moving) -> str:
    match node:
        case ast.Move():
            return f"MOVE {print_expression(node.target)}"
        case ast.MoveJ():
            return f"MOVEJ {print_expression(node.target)}"
        case ast.MoveC():
            return f"MOVEC {_comma(node.via, node.target)}"
        case ast.Approach():
            return f"APPROACH {_comma(node.target, node.distance)}"
        case ast.Depart():
            return f"DEPART {print_expression(node.distance)}"
        case _:
            assert_never(node)


def _option(option: Option) -> str:
    match option:
        case ast.Speed():
            return f"SPEED {print_expression(option.value)}"
        case ast.Accel():
            return f"ACCEL {print_expression(option.value)}"
        case ast.Time():
            return f"TIME {print_expression(option.value)}"
        case ast.Zone():
            return "FINE" if option.value is None else f"ZONE {print_expression(option.value)}"
        case ast.Wrist():
            return _wrist(option)
        case _:
            assert_never(option)


def _payload(node: _Payload) -> str:
    match node:
        case ast.Load():
            return f"LOAD {_comma(node.cog, node.mass, node.inertia)}"
        case ast.LoadNamed():
            return f"LOAD {node.name.text}"
        case ast.Hand():
            return f"HAND {node.state.value}{_optional(', ', node.dwell)}"
        case ast.Wrist():
            return _wrist(node)
        case ast.Seam():
            return "SEAM OFF" if node.sensor is None else f"SEAM ON, {node.sensor.text}"
        case ast.Setting():
            return f"{node.word} {print_expression(node.value)}"
        case _:
            assert_never(node)


def _data(node: _Data) -> str:
    match node:
        case ast.Assign():
            return f"{print_expression(node.target)} = {print_expression(node.value)}"
        case ast.Dim():
            return f"DIM {node.name.text}({print_expression(node.size)})"
        case ast.Const():
            return f"CONST {node.name.text} = {print_expression(node.value)}"
        case ast.Out():
            return f"OUT({print_expression(node.index)}) = {print_expression(node.value)}"
        case ast.Pulse():
            return f"PULSE {_comma(node.index, node.seconds)}"
        case ast.Delay():
            return f"DELAY {print_expression(node.seconds)}"
        case ast.Wait():
            goto = "" if node.target is None else f", GOTO {_target(node.target)}"
            return f"WAIT {print_expression(node.condition)}{_optional(', TIMEOUT ', node.timeout)}{goto}"
        case ast.Print():
            return f"PRINT {'; '.join(map(print_expression, node.items))}".rstrip()
        case _:
            assert_never(node)


def _control(node: _Control) -> str:
    match node:
        case ast.If():
            otherwise = "" if node.otherwise is None else f" ELSE {describe(node.otherwise)}"
            return f"IF {print_expression(node.condition)} THEN {describe(node.then)}{otherwise}"
        case ast.Block() | ast.Word():
            return node.word
        case ast.Head():
            then = " THEN" if node.word in ("IF", "ELSEIF") else ""
            return f"{node.word} {print_expression(node.value)}{then}"
        case ast.Case():
            return f"CASE {_comma(*node.values)}"
        case ast.For():
            limits = f"{print_expression(node.first)} TO {print_expression(node.last)}"
            return f"FOR {node.variable.text} = {limits}{_optional(' STEP ', node.step)}"
        case ast.Next():
            return f"NEXT{_optional(' ', node.variable)}"
        case ast.Jump():
            return f"{node.word} {_target(node.target)}"
        case ast.Sub():
            return f"SUB {node.name.text}{_bracketed(node.parameters, node.parentheses)}"
        case ast.CallSub():
            return f"CALL {node.name.text}{_bracketed(node.arguments, node.parentheses)}"
        case ast.OnError():
            return f"ON ERROR GOTO {_target(node.target)}"
        case _:
            assert_never(node)


def _wrist(wrist: ast.Wrist) -> str:
    held = f" {', '.join(component.value for component in wrist.held)}" if wrist.held else ""
    return f"WRIST {wrist.mode.value}{held}"


def _target(target: ast.Target) -> str:
    return str(target.number) if target.label is None else f"*{target.label.text}"


def _optional(before: str, value: Expression | None) -> str:
    return "" if value is None else f"{before}{print_expression(value)}"


def _comma(*values: Expression | None) -> str:
    return ", ".join(print_expression(value) for value in values if value is not None)


def _bracketed(values: tuple[Expression, ...], written: int) -> str:
    return f"({_comma(*values)})" if values or written else ""


# --- expressions -----------------------------------------------------------------------------------------------------


def print_expression(expression: Expression) -> str:
    """Return an expression as canonical text, such as ``-(a - b)^2 MOD 3``; in time linear in its size."""
    found: list[str] = []
    stack: list[_Piece] = [(expression, _OR)]
    while stack:
        piece = stack.pop()
        if isinstance(piece, str):
            found.append(piece)
            continue
        node, lowest = piece
        around = node.parentheses or int(_needs_parentheses(node, lowest))
        if around:
            stack += [")" * around, *reversed(_pieces(node, _OR)), "(" * around]
        else:
            stack.extend(reversed(_pieces(node, lowest)))
    return "".join(found)


def _needs_parentheses(node: Expression, lowest: int) -> bool:
    return _level(node) < lowest and not (lowest == _EXPONENT and isinstance(node, ast.Negate))


def _level(node: Expression) -> int:
    match node:
        case ast.Chain():
            return _SIGNS[node.rest[0][0]]
        case ast.Not():
            return _NOT
        case ast.Negate():
            return _SIGNED
        case _:
            return _OPERAND


def _pieces(node: Expression, lowest: int) -> list[_Piece]:
    """Return what an expression consists of, in the order of the text."""
    match node:
        case ast.Number() | ast.Name():
            return [node.text]
        case ast.Text():
            return [f'"{node.value.replace(_QUOTE, 2 * _QUOTE)}"']
        case ast.Not():
            return ["NOT ", (node.operand, _NOT)]
        case ast.Negate():
            return ["-", (node.operand, _EXPONENT if lowest == _EXPONENT else _SIGNED)]
        case ast.Chain():
            return _chain(node)
        case ast.Call():
            word = node.name.key if node.name.key in _WORDS else node.name.text
            return [word, *_list(node.arguments)] if node.arguments else [word]
        case ast.Component6():
            return [(node.base, _OPERAND), f".{node.name.key}"]
        case ast.Vector():
            return _list(node.items)
        case _:
            assert_never(node)


def _chain(node: ast.Chain) -> list[_Piece]:
    level = _level(node)
    operand = _OPERAND_OF[level]
    pieces: list[_Piece] = [(node.first, operand)]
    for sign, value in node.rest:
        pieces += ["^", (value, _EXPONENT)] if level == _POWER else [f" {sign} ", (value, operand)]
    return pieces


def _list(items: tuple[Expression, ...]) -> list[_Piece]:
    pieces: list[_Piece] = ["("]
    for index, item in enumerate(items):
        pieces += [", ", (item, _OR)] if index else [(item, _OR)]
    return [*pieces, ")"]
