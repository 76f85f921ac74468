"""Statements: values out of range, options that contradict, names of the cell that are none, and wrong arguments.

Kinds, ranges and names of the cell are checked as ``robolang.syntax.statements`` declares the operands; a method stands
here where a rule concerns more than one operand. The interpreter judges by the same ranges (``limits``). What the arm
may carry is judged by ``runtime.robot.model.load_rules``, as in a run.
"""

import itertools
import math
from collections.abc import Callable, Collection, Iterator
from typing import Any

from robolang.analysis import kind_hints
from robolang.analysis.cell_symbols import CellSymbols
from robolang.analysis.expression_check import ExpressionCheck
from robolang.analysis.symbols import Defined, hint_for, names_hint, of_cell
from robolang.core.diagnostics import Diagnostic, Related, Severity
from robolang.core.source import Span
from robolang.evaluation.constant_folding import fixed
from robolang.syntax import other_languages
from robolang.syntax.ast import (
    Approach,
    Assign,
    Block,
    Call,
    CallSub,
    Case,
    Component,
    Const,
    Depart,
    Expression,
    For,
    Head,
    If,
    Load,
    LoadNamed,
    Move,
    MoveC,
    MoveJ,
    Moving,
    Name,
    Node,
    Option,
    Speed,
    Spline,
    Statement,
    Time,
    Unparsed,
    Vector,
    Wrist,
    Zone,
)
from robolang.syntax.declaration import Declaration, Operand, Role
from robolang.syntax.statements import declaration
from robolang.syntax.unparse import describe, print_expression
from robolang.values.kinds import Kind
from runtime.core import limits
from runtime.core.faults import Fault
from runtime.core.limits import Limit
from runtime.core.units import MM
from runtime.robot.model.load_rules import centre_fault, inertia_fault, load_fault, mass_fault

MAX_HELD = 2


class StatementCheck:
    """Checks the statements of a program one by one; ``defined`` are its names, ``symbols`` those of its cell."""

    def __init__(self, symbols: CellSymbols, defined: Defined) -> None:
        self._symbols, self._defined = symbols, defined
        self._expressions = ExpressionCheck(symbols, defined)
        self._selected: list[Kind | None] = []

    def check(self, node: Statement) -> Iterator[Diagnostic]:
        """Report what is wrong in a statement and in its branches."""
        if isinstance(node, If):
            yield from self._expressions.must_be(node.condition, Kind.NUMBER)
            yield from self._expressions.check(node.condition)
            for part in (node.then, node.otherwise):
                if part is not None:
                    yield from self.check(part)
            return
        if isinstance(node, Unparsed):
            return
        if found := _as_elsewhere(node):
            # the names in it are none of this program, and nothing else is said of them
            yield found
            return
        declared = declaration(node)
        yield from self._operands(node, declared)
        rule = _RULES.get(type(node))
        if rule is not None:
            yield from rule(self, node)
        for expression, in_place in _expressions(node, declared):
            yield from self._expressions.check(expression, in_place)

    # --- what the declarations say -----------------------------------------------------------------------------------

    def _operands(self, node: Node, declared: Declaration) -> Iterator[Diagnostic]:
        """Report operands of another kind than declared, out of their range, or that name nothing of the cell."""
        for operand in declared.operands:
            value = getattr(node, operand.name)
            if operand.role is Role.PLACE:
                yield from self._each_place(value)
            elif operand.of and isinstance(value, Name):
                yield from self._of_cell(value, operand)
            elif operand.role is Role.VECTOR and value is not None:
                yield from self._vector(value, operand)
            elif operand.role in (Role.VALUE, Role.OF_CELL) and isinstance(value, Node):
                yield from self._value(value, operand)  # type: ignore[arg-type]

    def _value(self, value: Expression, operand: Operand) -> Iterator[Diagnostic]:
        if operand.limit is not None:
            yield from self._within(value, operand.limit)
        elif operand.kind is not None:
            yield from self._expressions.must_be(value, operand.kind, self._in_place_of(value, operand))
        if operand.finite:
            yield from self._expressions.finite(value)

    def _in_place_of(self, value: Expression, operand: Operand) -> str:
        """Return what to write where a pose of the cell is needed; ``""``: as everywhere."""
        if operand.role is not Role.OF_CELL or isinstance(value, Vector):
            return ""
        return kind_hints.of_cell(operand.of, getattr(self._symbols, f"{operand.of}s") or ())

    def _vector(self, value: Vector, operand: Operand) -> Iterator[Diagnostic]:
        if len(value.items) != operand.size:
            message = f"{operand.size} values stand in these parentheses, not {len(value.items)}"
            yield Diagnostic(code="RBL220", message=message, span=value.span)
        elif operand.kind is not None:
            for item in value.items:
                yield from self._expressions.must_be(item, operand.kind)

    def _of_cell(self, name: Name, operand: Operand) -> Iterator[Diagnostic]:
        # a pose may stand for a tool or a frame, so the name may be one of the program or of a taught point
        takes_pose = operand.role is Role.OF_CELL
        if takes_pose and (self._defined.has_value(name.key) or name.key in (self._symbols.points or ())):
            return
        known: Collection[str] | None = getattr(self._symbols, f"{operand.of}s")
        yield from of_cell(name, known, operand.of, self._symbols, operand.code)

    def _each_place(self, value: Expression | tuple[Expression, ...]) -> Iterator[Diagnostic]:
        # the points of SPLINE are a list
        for place in value if isinstance(value, tuple) else (value,):
            yield from self._place(place)

    def _place(self, node: Expression) -> Iterator[Diagnostic]:
        points = self._symbols.points
        if isinstance(node, Name) and not self._defined.has_value(node.key):
            if points is not None and node.key not in points:
                hint = hint_for(node, points) or self._symbols.where_to_teach(node.text)
                yield Diagnostic(code="RBL301", message=f"point {node.text} is not taught", span=node.span, hint=hint)
            return
        kind = self._expressions.kind(node)
        if kind is not None and kind is not Kind.POSE:
            hint = kind_hints.pose(node)
            yield Diagnostic(code="RBL217", message=f"a pose is needed here, not {kind}", span=node.span, hint=hint)

    # --- motion ------------------------------------------------------------------------------------------------------

    def _moving(self, node: Moving) -> Iterator[Diagnostic]:
        seen: dict[type, Option] = {}
        for option in node.options:
            if earlier := seen.get(type(option)):
                yield _twice(_shown(option, earlier), option.span, earlier.span)
            seen.setdefault(type(option), option)
            if isinstance(option, Wrist):
                yield from self._wrist(option)
            else:
                yield from self._operands(option, _option(node, option))
        if Speed in seen and Time in seen:
            message = "TIME fixes how long the move takes, so SPEED cannot be given too"
            related = (Related(span=seen[Time].span, message="TIME is given here"),)
            yield Diagnostic(code="RBL119", message=message, span=seen[Speed].span, related=related)

    def _spline(self, node: Spline) -> Iterator[Diagnostic]:
        yield from self._moving(node)
        if len(node.points) == 1:
            message = "SPLINE takes two points or more: to one point there is no curve"
            hint = f"write MOVE {print_expression(node.points[0])}"
            yield Diagnostic(code="RBL220", message=message, span=node.points[0].span, hint=hint)
        for before, point in itertools.pairwise(node.points):
            if print_expression(point).upper() == print_expression(before).upper():
                yield Diagnostic(
                    code="RBL236",
                    severity=Severity.WARNING,
                    message=f"{print_expression(point)} stands twice in a row: the curve passes it once",
                    span=point.span,
                    hint="remove one of the two, or correct its name",
                )

    def _within(self, node: Expression, limit: Limit) -> Iterator[Diagnostic]:
        """Report a value that is no number, or out of a range."""
        yield from self._expressions.must_be(node, Kind.NUMBER)
        value = fixed(node)
        if value is not None:
            # SPEED of a MOVEJ and SPEEDJ are shares of the joint limits, so no speed of the tool bounds them
            most = self._symbols.max_speed_mm_s if limit is limits.SPEED else None
            yield from _refused(limit.fault(value, most), node)

    def _wrist(self, node: Wrist) -> Iterator[Diagnostic]:
        seen: dict[Component, Span] = {}
        for component, place in zip(node.held, node.held_spans, strict=True):
            if first := seen.get(component):
                yield _twice(component.value, place, first)
            elif len(seen) >= MAX_HELD:
                message = f"{component.value} is one too many: the wrist can hold at most two components"
                yield Diagnostic(code="RBL120", message=message, span=place)
            seen.setdefault(component, place)

    # --- payload and hand --------------------------------------------------------------------------------------------

    def _load(self, node: Load) -> Iterator[Diagnostic]:
        mass, cog = fixed(node.mass), _fixed(node.cog, 3)
        if mass is not None:
            yield from _refused(mass_fault(mass, self._symbols.rated_payload), node.mass)
        if cog is not None:
            yield from _refused(centre_fault([value * MM for value in cog]), node.cog)
        if node.inertia is not None and (inertia := _fixed(node.inertia, 6)) is not None:
            yield from _refused(inertia_fault(inertia), node.inertia)

    def _load_named(self, node: LoadNamed) -> Iterator[Diagnostic]:
        loads, rated = self._symbols.loads, self._symbols.rated_payload
        load = None if loads is None else loads.get(node.name.key)
        if load is not None and rated is not None:
            yield from _refused(load_fault(load.mass_kg, [value * MM for value in load.cog_mm], None, rated), node.name)

    # --- values and control ------------------------------------------------------------------------------------------

    def _assign(self, node: Assign) -> Iterator[Diagnostic]:
        name = node.target.name if isinstance(node.target, Call) else node.target
        if fixed_at := self._defined.constant(name.key):
            related = (Related(span=fixed_at, message="fixed here"),)
            yield Diagnostic(code="RBL216", message=f"{name.text} is a constant", span=name.span, related=related)
        yield from self._fits(name, node.value)
        is_element = isinstance(node.target, Call) and not self._defined.has_array(name.key)
        if is_element and self._defined.is_missing(name):
            message = f"there is no array {name.text}"
            hint = _assigned_elsewhere(node, name) or f"DIM {name.text}(n) makes one"
            yield Diagnostic(code="RBL215", message=message, span=name.span, hint=hint)
        elif isinstance(node.target, Call) and not is_element and len(node.target.arguments) == 1:
            yield from self._expressions.element(node.target)

    def _fits(self, name: Name, value: Expression) -> Iterator[Diagnostic]:
        """Report a value of another kind than a name holds."""
        kind = self._expressions.kind(value)
        # a text belongs under a name with $, and nothing else does
        if kind is not None and (kind is Kind.TEXT) is not name.key.endswith("$"):
            message = f"{kind} is assigned to {name.text}; names that end in $ hold texts, and only they do"
            if kind is Kind.TEXT:
                hint = f"write {name.text}$ for a text; for a number: {kind_hints.number(value)}"
            else:
                hint = kind_hints.instead(Kind.TEXT, value, kind)
            yield Diagnostic(code="RBL217", message=message, span=value.span, hint=hint)

    def _const(self, node: Const) -> Iterator[Diagnostic]:
        first = self._defined.constant(node.name.key)
        # the table has the first CONST of a name, which may be this one
        if first is not None and first != node.name.span:
            related = (Related(span=first, message="fixed here"),)
            message = f"{node.name.text} is a constant already"
            yield Diagnostic(code="RBL216", message=message, span=node.name.span, related=related)
        yield from self._fits(node.name, node.value)

    def _case(self, node: Case) -> Iterator[Diagnostic]:
        selected = self._selected[-1] if self._selected else None
        for value in node.values:
            kind = self._expressions.kind(value)
            if selected is not None and kind is not None and kind != selected:
                message = f"{kind} is compared with {selected} of the SELECT: they are never equal"
                hint = kind_hints.instead(selected, value, kind)
                yield Diagnostic(code="RBL217", message=message, span=value.span, hint=hint)

    def _head(self, node: Head) -> Iterator[Diagnostic]:
        if node.word == "SELECT":
            # a stack: a SELECT may stand in a CASE of another, and lines come in order
            self._selected.append(self._expressions.kind(node.value))
        yield from ()

    def _block(self, node: Block) -> Iterator[Diagnostic]:
        if node.word == "ENDSELECT" and self._selected:
            self._selected.pop()
        yield from ()

    def _for(self, node: For) -> Iterator[Diagnostic]:
        if self._defined.constant(node.variable.key) is not None:
            message = f"{node.variable.text} is a constant"
            yield Diagnostic(code="RBL216", message=message, span=node.variable.span)
        yield from self._fits(node.variable, node.first)
        if node.step is None:
            return
        step = fixed(node.step)
        if step == 0.0:
            yield Diagnostic(code="RBL205", message="STEP is 0: the loop would never end", span=node.step.span)
        elif step is not None and step != math.floor(step):
            yield Diagnostic(
                code="RBL206",
                severity=Severity.WARNING,
                span=node.step.span,
                message=f"the rounds of STEP {step:g} are counted at the start, and "
                f"{node.variable.text} gathers rounding errors",
            )

    def _call_sub(self, node: CallSub) -> Iterator[Diagnostic]:
        sub = self._defined.subs.get(node.name.key)
        if sub is None:
            if not self._defined.is_missing(node.name):
                return
            hint = names_hint(
                node.name,
                frozenset(self._defined.subs),
                known="subroutines",
                none=f"write SUB {node.name.text} and ENDSUB, or correct the name",
            )
            yield Diagnostic(code="RBL213", message=f"there is no SUB {node.name.text}", span=node.name.span, hint=hint)
        elif len(sub.parameters) != len(node.arguments):
            related = (Related(span=sub.span, message="defined here"),)
            count = len(sub.parameters)
            message = f"SUB {sub.name.text} takes {count} value{'s' * (count != 1)}, not {len(node.arguments)}"
            yield Diagnostic(code="RBL214", message=message, span=node.span, related=related)


_Check = StatementCheck
_RULES: dict[type, Callable[..., Iterator[Diagnostic]]] = {
    Move: _Check._moving,
    MoveJ: _Check._moving,
    MoveC: _Check._moving,
    Spline: _Check._spline,
    Approach: _Check._moving,
    Depart: _Check._moving,
    Load: _Check._load,
    LoadNamed: _Check._load_named,
    Wrist: _Check._wrist,
    Assign: _Check._assign,
    For: _Check._for,
    CallSub: _Check._call_sub,
    Const: _Check._const,
    Case: _Check._case,
    Head: _Check._head,
    Block: _Check._block,
}


def _as_elsewhere(node: Statement) -> Diagnostic | None:
    """Return RBL217 for a move with all operands in parentheses, as ``movej(home, tool, fast)`` of VAL3."""
    target = getattr(node, "target", None)
    if not isinstance(node, Moving) or not isinstance(target, Vector):
        return None
    from robolang.syntax import foreign_lines

    hint = foreign_lines.advice(describe(node))
    message = "a pose is needed here, not values in parentheses"
    return Diagnostic(code="RBL217", message=message, span=target.span, hint=hint) if hint else None


def _assigned_elsewhere(node: Assign, name: Name) -> str:
    """Return what to write for an element that other languages assign to, as ``M_Out(1) = 1``, or ``""``."""
    known = other_languages.assigned(name.key, element=True)
    if not known:
        return ""
    from robolang.syntax import foreign_lines

    return foreign_lines.advice(describe(node)) or known


def _expressions(node: Node, declared: Declaration) -> Iterator[tuple[Expression, frozenset[str]]]:
    """Yield the expressions of a statement, its options' among them, each with the words that may stand for it."""
    # an unknown name is reported at its first use only; in a move, the target's counts before the via point's
    for operand in sorted(declared.operands, key=_rank) if declared.options else declared.operands:
        value = getattr(node, operand.name)
        if operand.role is Role.OPTIONS:
            for option in value:
                yield from _expressions(option, _option(node, option))
        elif value is not None:
            for each in _computed(value, operand):
                # of a word that stands for the whole value: in MAXX + 1 a name is meant
                yield each, declared.in_place if isinstance(each, Name) else frozenset()


def _computed(value: Any, operand: Operand) -> tuple[Expression, ...]:
    """Return the expressions of an operand; not the names that it defines or that name something of the cell, nor a
    bare point, which ``_place`` checks."""
    match operand.role:
        case Role.VALUE:
            found = value if operand.separator else (value,)
        case Role.VECTOR:
            found = value.items
        case Role.PLACE | Role.OF_CELL:
            places = value if operand.separator else (value,)
            found = tuple(place for place in places if not isinstance(place, Name))
        case Role.ASSIGNED:
            found = value.arguments if isinstance(value, Call) else ()
        case _:
            found = ()
    return tuple(found)


_ORDER = {"target": 0, "via": 1, "options": 2}


def _rank(operand: Operand) -> int:
    return _ORDER.get(operand.name, len(_ORDER))


def _option(move: Node, option: Node) -> Declaration:
    """Return the declaration of an option of a move: SPEED of a MOVEJ has another range than of other moves."""
    name = type(option).__name__
    return next(each for each in declaration(move).options if each.node == name)


def _shown(option: Option, earlier: Option) -> str:
    """Return the word of an option that is there twice, or both words: FINE is a ZONE of 0."""
    if isinstance(option, Zone) and isinstance(earlier, Zone) and (option.value is None) != (earlier.value is None):
        return "the size of the blend, ZONE or FINE,"
    return type(option).__name__.upper()


def _twice(word: str, place: Span, first: Span) -> Diagnostic:
    related = (Related(span=first, message="first given here"),)
    return Diagnostic(code="RBL118", message=f"{word} is given twice", span=place, related=related)


def _fixed(node: Vector, size: int) -> list[float] | None:
    """Return the values of a vector of so many numbers; None when one of them is not known before a run."""
    values = [value for value in map(fixed, node.items) if value is not None]
    return values if len(values) == len(node.items) == size else None


def _refused(fault: Fault | None, place: Node) -> Iterator[Diagnostic]:
    """Report what a rule of the robot says of a payload, at its place."""
    if fault is not None:
        yield Diagnostic(code=fault.code, message=fault.message, span=place.span, hint=fault.hint)
