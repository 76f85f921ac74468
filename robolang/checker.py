"""Meaning: what is wrong with a program that parses.

Every limit is written so that NaN fails it. Limits of the robot's own (reach, joints, speed) belong to the planner
and are found before the move that breaks them; here are the limits that hold for every robot, and the facts of
the cell that need no kinematics: its names (taught points, sensors, tools, frames, loads, inputs) and what the arm may
carry. Values of numbers alone are worked out (``evaluator``), so ``SPEED 2 * 50`` is checked like ``SPEED 100``; what
depends on a variable is checked when it runs. Blocks and jumps are ``structure``'s. Time is linear in the program.
"""

import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice
from typing import NoReturn

from robolang.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Related, Severity, in_order
from robolang.evaluator import COMPONENTS6, Evaluator, Nowhere
from robolang.nodes import (
    Accel,
    Approach,
    Assign,
    Call,
    CallSub,
    Chain,
    Component,
    Component6,
    Const,
    Delay,
    Depart,
    Dim,
    Expression,
    For,
    Hand,
    Head,
    If,
    Jump,
    Line,
    Load,
    LoadNamed,
    Move,
    MoveC,
    MoveJ,
    Moving,
    Name,
    Negate,
    Node,
    Not,
    Number,
    Option,
    Out,
    Program,
    Pulse,
    Seam,
    Setting,
    Speed,
    Statement,
    Sub,
    Text,
    Time,
    Vector,
    Wait,
    Word,
    Wrist,
    Zone,
    constant,
    walk,
)
from robolang.places import Value
from robolang.source import Span
from robolang.structure import Structure, structure_of, targets, word_of
from robolang.words import ARGUMENTS, near
from runtime.faults import Fault

MAX_COG_MM = 2000.0
MAX_SPEED_MM_S = 10_000.0
MAX_ACCEL_PCT = 100.0
MAX_SECONDS = 600.0
MAX_WAIT_S = 86_400.0
MAX_HELD = 2
MAX_OUTPUT = 1024


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What is known of the cell; None: not known, not checked. Names in any case."""

    points: frozenset[str] | None = None
    rated_payload_kg: float | None = None
    sensors: frozenset[str] | None = None
    tools: frozenset[str] | None = None
    frames: frozenset[str] | None = None
    loads: frozenset[str] | None = None
    inputs: frozenset[int] | None = None


def check(program: Program, *, points: Collection[str] | None = None, rated_payload_kg: float | None = None,
          sensors: Collection[str] | None = None, tools: Collection[str] | None = None,
          frames: Collection[str] | None = None, loads: Collection[str] | None = None,
          inputs: Collection[int] | None = None) -> tuple[Diagnostic, ...]:  # fmt: skip
    """Return what is wrong with a program, by place.

    Args:
        program: the tree; ``Unparsed`` statements are passed over, the parser has reported them.
        points, sensors, tools, frames, loads: names that the cell and the points file have; None: not known.
        rated_payload_kg: what the robot may carry; None when the robot is not known.
        inputs: numbers of the cell's inputs; None when the cell is not known.
    """
    facts = Facts(
        points=_keys(points), rated_payload_kg=rated_payload_kg, sensors=_keys(sensors), tools=_keys(tools),
        frames=_keys(frames), loads=_keys(loads), inputs=None if inputs is None else frozenset(inputs),
    )  # fmt: skip
    structure = structure_of(program)
    found = chain(_line_numbers(program), _emptiness(program), structure.diagnostics, _unreachable(program, structure),
                  _Checker(program, facts, structure).run())  # fmt: skip
    return in_order(islice(found, MAX_DIAGNOSTICS + 1))


def _keys(names: Collection[str] | None) -> frozenset[str] | None:
    return None if names is None else frozenset(name.upper() for name in names)


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


_LEAVES = ("GOTO", "END", "STOP", "RETURN", "RESUME", "RESUME NEXT")


def _unreachable(program: Program, structure: Structure) -> Iterator[Diagnostic]:
    """Report the first of the lines that nothing leads to: behind a jump, and no jump's target."""
    reached = {structure.line_of(target) for line in program.lines for target in targets(line.statement)}
    left = ""
    for index, line in enumerate(program.lines):
        if index in reached:  # a label may stand on a line of its own
            left = ""
        if line.statement is None:
            continue
        if left and not word_of(line.statement):
            yield Diagnostic(code="RBL221", severity=Severity.WARNING, span=line.statement.span,
                             message=f"nothing leads here: {left} stands above, and no jump has this line as target")
        word = line.statement.word if isinstance(line.statement, Jump | Word) else ""
        left = word if word in _LEAVES else ""


class _NoNames:
    """Names without values: what needs one is not constant."""

    def value(self, key: str) -> Value | None:
        if key in ("NAN", "INF"):
            return None
        raise _VariableError

    def element(self, key: str, index: int) -> Value | None:
        raise _VariableError


class _VariableError(Exception):
    """A value that depends on a name."""


class _Static(Nowhere):
    def _refuse(self, what: str) -> NoReturn:
        raise _VariableError


_EVALUATOR = Evaluator(_NoNames(), _Static())


def fixed(node: Expression) -> float | None:
    """Return the value of an expression of numbers alone; None when it needs more or has none."""
    value = constant(node)
    if value is not None or isinstance(node, Number | Name | Negate):
        return value
    try:
        found = _EVALUATOR.value(node)
    except (_VariableError, Fault):
        return None
    return found if isinstance(found, float) else None


@dataclass(slots=True)
class _Defined:
    """Names that a program gives values: variables, arrays, constants, and subroutines with their parameters."""

    values: set[str] = field(default_factory=set)
    arrays: set[str] = field(default_factory=set)
    constants: dict[str, Span] = field(default_factory=dict)
    subs: dict[str, Sub] = field(default_factory=dict)


class _Checker:
    """Checks the statements of a program one after the other."""

    def __init__(self, program: Program, facts: Facts, structure: Structure) -> None:
        self._program, self._facts, self._structure = program, facts, structure
        self._defined = _Defined()

    def run(self) -> Iterator[Diagnostic]:
        """Yield what is wrong, statement by statement."""
        for line in self._program.statements:
            assert line.statement is not None
            self._define(line.statement)
        for line in self._program.statements:
            assert line.statement is not None
            said: set[tuple[str, Span]] = set()  # two rules may look at one expression
            for found in self._statement(line.statement):
                if (found.code, found.span) not in said:
                    yield found
                said.add((found.code, found.span))

    @cached_property
    def _known(self) -> frozenset[str]:
        """Every name that has a value somewhere."""
        return frozenset((self._facts.points or frozenset()) | self._defined.values)

    def _define(self, node: Statement) -> None:
        defined = self._defined
        if isinstance(node, If):
            for part in (node.then, node.otherwise):
                if part is not None:
                    self._define(part)
        elif isinstance(node, Assign) and isinstance(node.target, Name):
            defined.values.add(node.target.key)
        elif isinstance(node, For):
            defined.values.add(node.variable.key)
        elif isinstance(node, Const):
            defined.values.add(node.name.key)
            defined.constants.setdefault(node.name.key, node.name.span)
        elif isinstance(node, Dim):
            defined.arrays.add(node.name.key)
        elif isinstance(node, Sub):
            defined.subs.setdefault(node.name.key, node)
            defined.values.update(parameter.key for parameter in node.parameters)

    def _statement(self, node: Statement) -> Iterator[Diagnostic]:
        if isinstance(node, If):
            yield from self._must_be(node.condition, "a number")
            yield from self._expression(node.condition)
            for part in (node.then, node.otherwise):
                if part is not None:
                    yield from self._statement(part)
            return
        rule = _RULES.get(type(node))
        if rule is not None:
            yield from rule(self, node)
        yield from self._names(node)

    # --- names and kinds ---------------------------------------------------------------------------------------------

    def _names(self, node: Statement) -> Iterator[Diagnostic]:
        """Check every expression of a statement that is not a place for a name of another sort."""
        if isinstance(node, Setting) and node.word in ("TOOL", "FRAME") and isinstance(node.value, Name):
            return
        for part in _expressions(node):
            yield from self._expression(part)

    def _expression(self, node: Expression) -> Iterator[Diagnostic]:
        skip: set[int] = set()
        behind: set[int] = set()
        for each in walk(node):
            if id(each) in skip:
                continue
            if isinstance(each, Name):
                yield from self._name(each)
            elif isinstance(each, Call):
                skip.add(id(each.name))
                yield from self._call(each)
            elif isinstance(each, Component6):
                skip.add(id(each.name))
                yield from _component(each)
            elif isinstance(each, Chain):
                behind.update(id(operand) for _, operand in each.rest)
                yield from self._chain(each)
            elif isinstance(each, Negate | Not):
                yield from self._must_be(each.operand, "a number")
            elif isinstance(each, Vector) and id(each) not in behind:
                message = "a way in parentheses stands behind a pose and + or *, as in P1 + (0, 0, 50)"
                yield Diagnostic(code="RBL217", message=message, span=each.span)
        yield from _no_value(node)

    def _name(self, node: Name) -> Iterator[Diagnostic]:
        if node.key in self._defined.values or node.key in ("NAN", "INF"):
            return
        points = self._facts.points
        if points is not None and node.key not in points:
            message = f"{node.text} has no value: nothing assigns it, and it is no taught point"
            yield Diagnostic(code="RBL215", message=message, span=node.span, hint=_hint(node, self._known))

    def _call(self, node: Call) -> Iterator[Diagnostic]:
        key, count = node.name.key, len(node.arguments)
        if key in ("HERE", "TIMER", "ERR"):
            return
        if key in ARGUMENTS:
            low, high = ARGUMENTS[key]
            if not low <= count <= high:
                wanted = f"{low}" if low == high else f"{low} to {high}"
                message = f"{key} takes {wanted} value{'s' * (high > 1)}, not {count}"
                yield Diagnostic(code="RBL214", message=message, span=node.span)
                return
            wanted_kind = "a text" if key in ("VAL", "LEN") else "a pose" if key == "DIST" else "a number"
            for argument in node.arguments:
                yield from self._must_be(argument, wanted_kind)
            if key == "IN":
                yield from self._input(node.arguments[0])
        elif key not in self._defined.arrays:
            guess = near(key, ARGUMENTS)
            hint = f"did you mean {guess}?" if guess else f"DIM {node.name.text}(n) makes an array"
            message = f"{node.name.text} is no array and no function"
            yield Diagnostic(code="RBL215", message=message, span=node.name.span, hint=hint)
        elif count != 1:
            yield Diagnostic(code="RBL214", message=f"an element has one number, not {count}", span=node.span)

    def _input(self, node: Expression) -> Iterator[Diagnostic]:
        number, inputs = fixed(node), self._facts.inputs
        if number is not None and inputs is not None and number not in inputs:
            known = ", ".join(map(str, sorted(inputs))) or "none"
            message = f"the cell has no input {number:g} (known: {known})"
            yield Diagnostic(code="RBL534", message=message, span=node.span)

    def _chain(self, node: Chain) -> Iterator[Diagnostic]:
        """Check the kinds of the operands, and that ways in parentheses stand behind poses."""
        left = self._kind(node.first)
        if isinstance(node.first, Vector):
            return  # said of the vector itself
        for sign, operand in node.rest:
            if isinstance(operand, Vector):
                wanted = (3,) if sign == "+" else (3, 6) if sign == "*" else ()
                if left in ("a number", "a text") or not wanted:
                    message = f"a way in parentheses stands behind {left or 'a value'} and {sign}, not behind a pose"
                    yield Diagnostic(code="RBL217", message=message, span=operand.span)
                elif len(operand.items) not in wanted:
                    counts = " or ".join(map(str, wanted))
                    yield Diagnostic(code="RBL220", message=f"{sign} takes {counts} values in parentheses, not "
                                     f"{len(operand.items)}", span=operand.span)  # fmt: skip
                left = "a pose"
                continue
            right = self._kind(operand)
            if "a pose" in (left, right):
                where = node.first if left == "a pose" else operand
                message = f"a pose stands beside {sign}; behind it stand + or * and a way, as in P1 + (0, 0, 50)"
                yield Diagnostic(code="RBL217", message=message, span=where.span)
                return
            if left is not None and right is not None and left != right:
                message = f"{left} and {right} stand on the sides of {sign}"
                yield Diagnostic(code="RBL217", message=message, span=operand.span)
                return
            if left == "a text" and sign not in ("+", "=", "<>", "<", ">", "<=", ">="):
                yield Diagnostic(code="RBL217", message=f"texts stand on the sides of {sign}", span=node.span)
                return

    def _kind(self, node: Expression) -> str | None:
        """Return what an expression is, in words; None where only a run can tell."""
        if isinstance(node, Number | Negate | Not | Component6):
            return "a number"
        if isinstance(node, Text):
            return "a text"
        if isinstance(node, Name):
            if node.key.endswith("$"):
                return "a text"
            taught = self._facts.points is not None and node.key in self._facts.points
            return "a pose" if taught and node.key not in self._defined.values else None
        if isinstance(node, Call):
            if node.name.key in ("POSE", "JOINT", "HERE"):
                return "a pose"
            return "a text" if node.name.key.endswith("$") else "a number" if node.name.key in ARGUMENTS else None
        if isinstance(node, Chain):
            if any(isinstance(operand, Vector) for _, operand in node.rest):
                return "a pose"
            if self._kind(node.first) == "a pose":
                return None  # reported as a chain
            if node.rest[0][0] not in "+":
                return "a number"
            return self._kind(node.first) or self._kind(node.rest[0][1])
        return "a way in parentheses" if isinstance(node, Vector) else None

    def _must_be(self, node: Expression, wanted: str) -> Iterator[Diagnostic]:
        kind = self._kind(node)
        if kind is not None and kind != wanted:
            yield Diagnostic(code="RBL217", message=f"{kind} stands where {wanted} is needed", span=node.span)

    # --- motion ------------------------------------------------------------------------------------------------------

    def _moving(self, node: Moving) -> Iterator[Diagnostic]:
        for target in ([node.via] if isinstance(node, MoveC) else []) + (
            [] if isinstance(node, Depart) else [node.target]
        ):
            yield from self._place(target)
        if isinstance(node, Approach | Depart):
            yield from self._in_range(node.distance, node.distance, 0.0, 1e5, "a distance", "mm", "RBL404")
        seen: dict[type, Option] = {}
        for option in node.options:
            word = type(option).__name__.upper()
            if earlier := seen.get(type(option)):
                yield _twice(word, option.span, earlier.span)
            seen.setdefault(type(option), option)
            yield from self._option(option, word, joint=isinstance(node, MoveJ))
        if Speed in seen and Time in seen:
            message = "TIME fixes how long the move takes, so SPEED cannot be given too"
            related = (Related(span=seen[Time].span, message="TIME is given here"),)
            yield Diagnostic(code="RBL119", message=message, span=seen[Speed].span, related=related)

    def _place(self, node: Expression) -> Iterator[Diagnostic]:
        points = self._facts.points
        if isinstance(node, Name) and node.key not in self._defined.values:
            if points is not None and node.key not in points:
                hint = _names_hint(node, points, known="taught", none="no point is taught")
                yield Diagnostic(code="RBL301", message=f"point {node.text} is not taught", span=node.span, hint=hint)
            return
        kind = self._kind(node)
        if kind is not None and kind != "a pose":
            yield Diagnostic(code="RBL217", message=f"{kind} stands where a point is needed", span=node.span)

    def _option(self, option: Option, word: str, *, joint: bool) -> Iterator[Diagnostic]:
        if isinstance(option, Wrist):
            yield from self._wrist(option)
        elif isinstance(option, Zone):
            if option.value is not None:
                yield from self._radius(option.value)
        else:
            high, unit = _range(option, joint=joint)
            yield from self._above(option.value, high, word, unit)

    def _above(self, node: Expression, high: float, word: str, unit: str) -> Iterator[Diagnostic]:
        yield from self._must_be(node, "a number")
        value = fixed(node)
        if value is not None and not 0.0 < value <= high:
            message = f"{word} is {value:g} {unit} and must be above 0 and at most {high:g} {unit}"
            yield Diagnostic(code="RBL404", message=message, span=node.span)

    def _radius(self, node: Expression) -> Iterator[Diagnostic]:
        yield from self._must_be(node, "a number")
        value = fixed(node)
        if value is not None and not 0.0 <= value <= 1e5:
            message = f"a blend radius of {value:g} mm is not 0 or more"
            yield Diagnostic(code="RBL415", message=message, span=node.span)

    def _in_range(self, node: Expression, place: Node, low: float, high: float, what: str, unit: str,
                  code: str) -> Iterator[Diagnostic]:  # fmt: skip
        yield from self._must_be(node, "a number")
        value = fixed(node)
        if value is not None and not low <= value <= high:
            message = f"{what} of {value:g} {unit} is not between {low:g} {unit} and {high:g} {unit}"
            yield Diagnostic(code=code, message=message, span=place.span)

    def _wrist(self, node: Wrist) -> Iterator[Diagnostic]:
        seen: dict[Component, Span] = {}
        for component, place in zip(node.held, node.held_spans, strict=True):
            if first := seen.get(component):
                yield _twice(component.value, place, first)
            elif len(seen) >= MAX_HELD:
                message = f"{component.value} is one too many: the wrist can hold at most two components"
                yield Diagnostic(code="RBL120", message=message, span=place)
            seen.setdefault(component, place)

    def _seam(self, node: Seam) -> Iterator[Diagnostic]:
        sensor = node.sensor
        if sensor is not None and self._facts.sensors is not None and sensor.key not in self._facts.sensors:
            hint = _names_hint(sensor, self._facts.sensors, known="seam sensors", none="the cell has no seam sensor")
            message = f"the cell has no seam sensor {sensor.text}"
            yield Diagnostic(code="RBL306", message=message, span=sensor.span, hint=hint)

    def _setting(self, node: Setting) -> Iterator[Diagnostic]:
        assert node.value is not None
        if node.word in ("TOOL", "FRAME"):
            names = self._facts.tools if node.word == "TOOL" else self._facts.frames
            if isinstance(node.value, Name):
                if node.value.key not in self._defined.values | (self._facts.points or frozenset()):
                    yield from _of_cell(node.value, names, node.word.lower())
            else:
                yield from self._must_be(node.value, "a pose")
        elif node.word == "ZONE":
            yield from self._radius(node.value)
        else:
            high, unit = (MAX_SPEED_MM_S, "mm/s") if node.word == "SPEED" else (100.0, "%")
            yield from self._above(node.value, high, node.word, unit)

    # --- payload and hand --------------------------------------------------------------------------------------------

    def _load(self, node: Load) -> Iterator[Diagnostic]:
        for vector, count in ((node.cog, 3), (node.inertia, 6)):
            if vector is not None and len(vector.items) != count:
                message = f"{count} values stand in these parentheses, not {len(vector.items)}"
                yield Diagnostic(code="RBL220", message=message, span=vector.span)
                return
        for part in (*node.cog.items, node.mass, *(node.inertia.items if node.inertia else ())):
            yield from self._must_be(part, "a number")
        mass = fixed(node.mass)
        if mass is not None:
            yield from _mass(mass, node.mass, self._facts)
        cog = [value for value in map(fixed, node.cog.items) if value is not None]
        if len(cog) == 3:
            yield from _centre(cog, mass, node.cog)

    def _load_named(self, node: LoadNamed) -> Iterator[Diagnostic]:
        yield from _of_cell(node.name, self._facts.loads, "load")

    def _hand(self, node: Hand) -> Iterator[Diagnostic]:
        if node.dwell is not None:
            yield from self._in_range(node.dwell, node.dwell, 0.0, MAX_SECONDS, "a wait", "s", "RBL405")

    # --- values and control ------------------------------------------------------------------------------------------

    def _assign(self, node: Assign) -> Iterator[Diagnostic]:
        name = node.target.name if isinstance(node.target, Call) else node.target
        if name.key in self._defined.constants:
            related = (Related(span=self._defined.constants[name.key], message="fixed here"),)
            yield Diagnostic(code="RBL216", message=f"{name.text} is a constant", span=name.span, related=related)
        yield from self._fits(name, node.value)
        if isinstance(node.target, Call) and name.key not in self._defined.arrays:
            message = f"there is no array {name.text}"
            yield Diagnostic(code="RBL215", message=message, span=name.span, hint=f"DIM {name.text}(n) makes one")

    def _fits(self, name: Name, value: Expression) -> Iterator[Diagnostic]:
        """Report a value of another kind than a name holds."""
        kind = self._kind(value)
        if kind is not None and (kind == "a text") is not name.key.endswith("$"):
            message = f"{kind} is assigned to {name.text}; names that end in $ hold texts, and only they do"
            yield Diagnostic(code="RBL217", message=message, span=value.span)

    def _const(self, node: Const) -> Iterator[Diagnostic]:
        yield from self._fits(node.name, node.value)

    def _dim(self, node: Dim) -> Iterator[Diagnostic]:
        yield from self._must_be(node.size, "a number")

    def _head(self, node: Head) -> Iterator[Diagnostic]:
        if node.word != "SELECT":
            yield from self._must_be(node.value, "a number")

    def _out(self, node: Out | Pulse) -> Iterator[Diagnostic]:
        yield from self._must_be(node.index, "a number")
        number = fixed(node.index)
        if number is not None and not (number == math.floor(number) and 1 <= number <= MAX_OUTPUT):
            message = f"there is no output {number:g}: they are 1 to {MAX_OUTPUT}"
            yield Diagnostic(code="RBL534", message=message, span=node.index.span)
        if isinstance(node, Pulse):
            yield from self._in_range(node.seconds, node.seconds, 0.0, MAX_WAIT_S, "a pulse", "s", "RBL405")
        else:
            yield from self._must_be(node.value, "a number")

    def _delay(self, node: Delay) -> Iterator[Diagnostic]:
        yield from self._in_range(node.seconds, node.seconds, 0.0, MAX_WAIT_S, "a delay", "s", "RBL405")

    def _wait(self, node: Wait) -> Iterator[Diagnostic]:
        yield from self._must_be(node.condition, "a number")
        if node.timeout is not None:
            yield from self._in_range(node.timeout, node.timeout, 0.0, MAX_WAIT_S, "a time-out", "s", "RBL405")

    def _for(self, node: For) -> Iterator[Diagnostic]:
        if node.variable.key in self._defined.constants:
            message = f"{node.variable.text} is a constant"
            yield Diagnostic(code="RBL216", message=message, span=node.variable.span)
        yield from self._fits(node.variable, node.first)
        for limit in (node.first, node.last, node.step):
            if limit is not None:
                yield from self._must_be(limit, "a number")
        if node.step is None:
            return
        step = fixed(node.step)
        if step == 0.0:
            yield Diagnostic(code="RBL205", message="STEP is 0: the loop would never end", span=node.step.span)
        elif step is not None and step != math.floor(step):
            yield Diagnostic(code="RBL206", severity=Severity.WARNING, span=node.step.span,
                             message=f"the rounds of STEP {step:g} are counted at the start, and "
                             f"{node.variable.text} gathers rounding errors")  # fmt: skip

    def _call_sub(self, node: CallSub) -> Iterator[Diagnostic]:
        sub = self._defined.subs.get(node.name.key)
        if sub is None:
            hint = _names_hint(node.name, frozenset(self._defined.subs), known="subroutines", none="there is no SUB")
            yield Diagnostic(code="RBL213", message=f"there is no SUB {node.name.text}", span=node.name.span, hint=hint)
        elif len(sub.parameters) != len(node.arguments):
            related = (Related(span=sub.span, message="defined here"),)
            message = f"SUB {sub.name.text} takes {len(sub.parameters)} values, not {len(node.arguments)}"
            yield Diagnostic(code="RBL214", message=message, span=node.span, related=related)


_RULES: dict[type, Callable[..., Iterator[Diagnostic]]] = {
    Move: _Checker._moving, MoveJ: _Checker._moving, MoveC: _Checker._moving, Approach: _Checker._moving,
    Depart: _Checker._moving, Load: _Checker._load, LoadNamed: _Checker._load_named, Hand: _Checker._hand,
    Wrist: _Checker._wrist, Seam: _Checker._seam, Setting: _Checker._setting, Assign: _Checker._assign,
    Out: _Checker._out, Pulse: _Checker._out, Delay: _Checker._delay, Wait: _Checker._wait, For: _Checker._for,
    CallSub: _Checker._call_sub, Const: _Checker._const, Dim: _Checker._dim,
    Head: _Checker._head,
}  # fmt: skip
_NAMED_FIELDS = {"name", "variable", "sensor", "parameters", "label", "then", "otherwise"}


def _expressions(node: Statement) -> Iterator[Expression]:
    """Yield the expressions of a statement, its options' among them; not the names that it defines or that name
    something of the cell, nor a bare point, which ``_place`` looks at."""
    if isinstance(node, Moving) and not isinstance(node, Depart) and not isinstance(node.target, Name):
        yield node.target
    if isinstance(node, MoveC) and not isinstance(node.via, Name):
        yield node.via
    if isinstance(node, Moving):
        yield from (option.value for option in node.options
                    if isinstance(option, Speed | Accel | Time | Zone) and option.value is not None)  # fmt: skip
    for name in type(node).__dataclass_fields__:
        if name in _NAMED_FIELDS or (isinstance(node, Moving) and name in ("target", "via", "options")):
            continue
        value = getattr(node, name)
        if isinstance(node, Assign) and name == "target":
            yield from value.arguments if isinstance(value, Call) else ()
            continue
        for each in value if isinstance(value, tuple) else (value,):
            if isinstance(each, _EXPRESSIONS):
                yield from each.items if isinstance(each, Vector) and isinstance(node, Load) else (each,)


_EXPRESSIONS = (Number, Text, Name, Negate, Not, Chain, Call, Component6, Vector)


def _component(node: Component6) -> Iterator[Diagnostic]:
    if node.name.key not in COMPONENTS6:
        message = f"a pose has no component {node.name.text}"
        yield Diagnostic(code="RBL218", message=message, span=node.name.span)


def _no_value(node: Expression) -> Iterator[Diagnostic]:
    """Report what has no value whatever the variables are: 1 / 0, SQR(-1)."""
    if isinstance(node, Number | Name | Text | Negate):
        return
    try:
        _EVALUATOR.value(node)
    except _VariableError:
        return
    except Fault as fault:
        if fault.code in ("RBL501", "RBL502"):
            yield Diagnostic(code="RBL209", message=f"this has no value: {fault.message}", span=node.span)


def _of_cell(name: Name, known: frozenset[str] | None, what: str) -> Iterator[Diagnostic]:
    if known is not None and name.key not in known:
        hint = _names_hint(name, known, known=f"{what}s", none=f"the cell has no {what}")
        yield Diagnostic(code="RBL305", message=f"the cell has no {what} {name.text}", span=name.span, hint=hint)


def _hint(name: Name, names: frozenset[str]) -> str:
    guess = near(name.key, names)
    return f"did you mean {guess}?" if guess else ""


def _names_hint(name: Name, names: frozenset[str], *, known: str, none: str) -> str:
    """Return what a name that is not among ``names`` was probably meant to be, or which there are, or ``""``."""
    if guess := _hint(name, names):
        return guess
    if not names:
        return none
    return f"{known}: {', '.join(sorted(names))}" if len(names) <= 10 else ""


def _twice(word: str, place: Span, first: Span) -> Diagnostic:
    related = (Related(span=first, message="first given here"),)
    return Diagnostic(code="RBL118", message=f"{word} is given twice", span=place, related=related)


def _range(option: Speed | Accel | Time, *, joint: bool) -> tuple[float, str]:
    if isinstance(option, Speed):
        return (100.0, "%") if joint else (MAX_SPEED_MM_S, "mm/s")
    return (MAX_ACCEL_PCT, "%") if isinstance(option, Accel) else (MAX_SECONDS, "s")


def _mass(mass: float, place: Expression, facts: Facts) -> Iterator[Diagnostic]:
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
