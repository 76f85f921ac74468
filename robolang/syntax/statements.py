"""The statements of the language, each declared once: form, operands with unit and range, options, effect, meaning.

Keywords, nodes of the tree, printer, checker ranges, hints of the parser, completion and the reference in
docs/language.md come from ``STATEMENTS`` and ``OPTIONS``. A range that the runtime checks too is that of
``runtime.core.limits``, referred to and not repeated.
"""

from robolang.syntax.declaration import Declaration, Fails, Operand, Role, form
from robolang.values.kinds import Kind
from runtime.core import limits
from runtime.core.limits import Limit

# --- operands --------------------------------------------------------------------------------------------------------


def _number(name: str, shown: str, limit: Limit | None = None, *, optional: bool = False, unit: str = "") -> Operand:
    """Return an operand that must be a number, in the range and unit of ``limit`` where it has one."""
    unit = limit.unit if limit is not None else unit
    return Operand(name, shown, kind=Kind.NUMBER, limit=limit, optional=optional, unit=unit)


def _any(name: str, shown: str = "value") -> Operand:
    """Return an operand whose kind depends on the program."""
    return Operand(name, shown)


def _values(name: str, separator: str) -> Operand:
    """Return a list of values of any kind."""
    return Operand(name, f"value [{separator}value]", separator=separator)


def _name(name: str, shown: str, *, optional: bool = False, defines: bool = False) -> Operand:
    return Operand(name, shown, Role.NAME, optional=optional, defines=defines)


def _place(name: str) -> Operand:
    return Operand(name, "point", Role.PLACE, kind=Kind.POSE)


def _places(name: str) -> Operand:
    return Operand(name, "point, point [, point]", Role.PLACE, kind=Kind.POSE, separator=", ")


def _option(node: str, form: str, help: str, limit: Limit) -> Declaration:
    return Declaration(node, (form,), help, (_number("value", limit.unit, limit),))


_TARGET = Operand("target", "line or *LABEL", Role.TARGET)
_PARENTHESES = Operand("parentheses", "", Role.WRITTEN)


# --- options ---------------------------------------------------------------------------------------------------------

COMPONENTS = ("TILT", "ADVANCE", "ROTATION")
"""Components of the posture that the wrist can hold."""
_WRIST = Declaration(
    "Wrist",
    # HOLD first: the first form whose operands have values is printed, and ``mode`` always has one
    ("WRIST HOLD {held}", "WRIST {mode}"),
    "what the wrist may do: keep the sign of J5, change it, or that with one or two components held",
    (
        Operand("mode", "KEEP|AUTO", Role.WORD, words=("KEEP", "AUTO", "HOLD"), type="WristMode"),
        Operand(
            "held",
            "component [, component]",
            Role.WORD,
            separator=", ",
            words=COMPONENTS,
            type="Component",
        ),
    ),
    effect="SetWrist",
)
_ACCEL_FORMS = ("ACCEL {value}", "ACCEL MAX")
_ACCEL = _number("value", limits.ACCEL.unit, limits.ACCEL, optional=True)
_JOINTS_ALONE = "MAX: as the joints allow"
_SPEED = _option("Speed", "SPEED {value}", "speed of the tool point, mm/s", limits.SPEED)
_SPEED_OF_JOINTS = _option("Speed", "SPEED {value}", "speed, % of the joint limits", limits.SPEED_PCT)
_MORE = (
    Declaration("Accel", _ACCEL_FORMS, f"acceleration and jerk, % of the robot's; {_JOINTS_ALONE}", (_ACCEL,)),
    _option("Time", "TIME {value}", "duration of the move, s", limits.TIME),
    Declaration(
        "Zone",
        ("ZONE {value}", "FINE"),
        "radius in which the move blends into the next one, mm; FINE: the move stops",
        (_number("value", "mm", limits.ZONE, optional=True),),
    ),
    _WRIST,
)
_OF_LINES = (_SPEED, *_MORE)
_OF_JOINTS = (_SPEED_OF_JOINTS, *_MORE)
# the nodes of both are the same, so one of them stands for the classes of the tree
OPTIONS = _OF_LINES
"""The options of a move; those of MOVEJ differ in the unit of SPEED."""


# --- motion, payload, hand, wrist, seam -------------------------------------------------------------------------------


def _move(
    node: str, form: str, help: str, *operands: Operand, options: tuple[Declaration, ...] = _OF_LINES
) -> Declaration:
    operands = (*operands, Operand("options", "", Role.OPTIONS))
    return Declaration(node, (f"{form}{{options}}",), help, operands, options, effect="MoveTo", fails=Fails.ALWAYS)


def _setting(word: str, help: str, limit: Limit) -> Declaration:
    return Declaration("Setting", (f"{word} {{value}}",), help, (_number("value", limit.unit, limit),))


def _of_cell(word: str, of: str, base: str, help: str, effect: str = "") -> Declaration:
    value = Operand("value", f"name, pose or {base}", Role.OF_CELL, kind=Kind.POSE, of=of, code="RBL305")
    return Declaration("Setting", (f"{word} {{value}}",), help, (value,), effect=effect)


_DISTANCE = _number("distance", "mm", limits.DISTANCE)
_MOTION = (
    _move("Move", "MOVE {target}", "moves the tool point on a straight line", _place("target")),
    _move("MoveJ", "MOVEJ {target}", "moves all joints together", _place("target"), options=_OF_JOINTS),
    _move("MoveC", "MOVEC {via}, {target}", "moves the tool point on an arc over via", _place("via"), _place("target")),
    _move("Spline", "SPLINE ({points})", "moves the tool point on a smooth curve through points", _places("points")),
    _move(
        "Approach",
        "APPROACH {target}, {distance}",
        "moves straight to a distance before the target, along the tool's approach axis",
        _place("target"),
        _DISTANCE,
    ),
    _move("Depart", "DEPART {distance}", "moves straight back along the tool's approach axis", _DISTANCE),
    Declaration(
        "Load",
        ("LOAD {cog}, {mass}[, {inertia}]",),
        "declares all that is beyond the flange: centre of gravity (mm), mass (kg), inertia about the centre (kg m2)",
        (
            Operand("cog", "(x, y, z)", Role.VECTOR, kind=Kind.NUMBER, size=3),
            _number("mass", "mass", unit="kg"),
            Operand(
                "inertia",
                "(ixx, iyy, izz, ixy, ixz, iyz)",
                Role.VECTOR,
                kind=Kind.NUMBER,
                size=6,
                optional=True,
            ),
        ),
        effect="SetPayload",
    ),
    Declaration(
        "LoadNamed",
        ("LOAD {name}",),
        "declares a load of the cell file",
        (Operand("name", "name", Role.NAME, of="load", code="RBL305"),),
        effect="SetPayload",
    ),
    Declaration(
        "Hand",
        ("HAND {state}[, {dwell}]",),
        "closes (ON) or opens (OFF) the hand, then waits",
        (
            Operand("state", "ON|OFF", Role.WORD, words=("ON", "OFF"), type="HandState"),
            _number("dwell", "s", limits.DWELL, optional=True),
        ),
        effect="SetHand",
    ),
    _WRIST,
    Declaration(
        "Seam",
        ("SEAM ON, {sensor}", "SEAM OFF"),
        "follows a seam sensor of the cell, or stops following",
        (Operand("sensor", "sensor", Role.NAME, optional=True, of="sensor", code="RBL306"),),
        effect="SetSeam",
    ),
)
_SETTINGS = (
    _setting("SPEED", "sets the speed of straight moves, arcs and splines, mm/s", limits.SPEED),
    _setting("SPEEDJ", "sets the speed of MOVEJ, % of the joint limits", limits.SPEEDJ),
    Declaration("Setting", _ACCEL_FORMS, f"sets acceleration and jerk, %; {_JOINTS_ALONE}", (_ACCEL,)),
    _setting("OVERRIDE", "scales every speed that follows, %", limits.OVERRIDE),
    _setting("ZONE", "sets the radius in which moves blend, mm", limits.ZONE),
    _of_cell("TOOL", "tool", "FLANGE", "takes a tool of the cell, or a pose in the flange", "SetTool"),
    _of_cell("FRAME", "frame", "WORLD", "takes a frame of the cell, or a pose in the world"),
)


# --- values, inputs and outputs --------------------------------------------------------------------------------------

_DATA = (
    Declaration(
        "Assign",
        ("{target} = {value}",),
        "gives a name or an element of an array a value",
        (Operand("target", "name", Role.ASSIGNED), _any("value")),
        fails=Fails.OPERANDS,
    ),
    Declaration(
        "Dim",
        ("DIM {name}({size})",),
        "makes an array of the elements 0 to n",
        (_name("name", "a", defines=True), _number("size", "n", limits.SIZE)),
        fails=Fails.ALWAYS,
    ),
    Declaration(
        "Const",
        ("CONST {name} = {value}",),
        "gives a name a value that stays",
        (_name("name", "k", defines=True), _any("value")),
        fails=Fails.OPERANDS,
    ),
    Declaration(
        "Out",
        ("OUT({index}) = {value}",),
        "sets an output",
        (_number("index", "n", limits.OUTPUT), _number("value", "value")._replace(finite=True)),
        effect="SetOutput",
        fails=Fails.ALWAYS,
    ),
    Declaration(
        "Pulse",
        ("PULSE {index}, {seconds}",),
        "sets an output for some seconds, while the program goes on",
        (_number("index", "n", limits.OUTPUT), _number("seconds", "s", limits.PULSE)),
        effect="SetOutput",
        fails=Fails.ALWAYS,
    ),
    Declaration(
        "Delay",
        ("DELAY {seconds}",),
        "lets time pass",
        (_number("seconds", "s", limits.DELAY),),
        effect="Pass",
        fails=Fails.OPERANDS,
    ),
    Declaration(
        "Wait",
        ("WAIT {condition}[, TIMEOUT {timeout}[, GOTO {target}]]",),
        "waits until a condition is true; without target, the end of TIMEOUT is error RBL503",
        (
            _number("condition", "condition"),
            _number("timeout", "s", limits.TIMEOUT, optional=True),
            _TARGET._replace(optional=True),
        ),
        effect="Pass",
        fails=Fails.ALWAYS,  # by its TIMEOUT; ``failing`` knows those that cannot
    ),
    Declaration(
        "Print",
        ("PRINT[ {items}]",),
        "shows values",
        (_values("items", "; ")._replace(optional=True),),
        effect="Show",
        fails=Fails.OPERANDS,
    ),
)


# --- control ---------------------------------------------------------------------------------------------------------


def _words(form: str, help: str, fails: Fails = Fails.NEVER, effect: str = "") -> Declaration:
    """Return a statement of words alone."""
    return Declaration("Word", (form,), help, effect=effect, fails=fails)


def _head(form: str, help: str, value: Operand, divides: str = "") -> Declaration:
    return Declaration("Head", (form,), help, (value,), fails=Fails.OPERANDS, divides=divides)


def _block(form: str, help: str, *, closes: str = "", divides: str = "") -> Declaration:
    return Declaration("Block", (form,), help, closes=closes, divides=divides)


_CONDITION = _number("condition", "condition")
_CONTROL = (
    Declaration(
        "If",
        ("IF {condition} THEN {then}[ ELSE {otherwise}]",),
        "carries out one of two statements",
        (
            _CONDITION,
            Operand("then", "statement", Role.STATEMENT),
            Operand("otherwise", "statement", Role.STATEMENT, optional=True),
        ),
        fails=Fails.OPERANDS,
    ),
    _head("IF {value} THEN", "begins a block that runs where the condition is true", _number("value", "condition")),
    _head("ELSEIF {value} THEN", "divides an IF: another condition", _number("value", "condition"), divides="IF"),
    _block("ELSE", "divides an IF: all other cases", divides="IF"),
    _block("ENDIF", "ends an IF", closes="IF"),
    Declaration(
        "For",
        ("FOR {variable} = {first} TO {last}[ STEP {step}]",),
        "repeats a block, counting a variable; the rounds are counted once, at the start",
        (
            _name("variable", "v", defines=True),
            _number("first", "a"),
            _number("last", "b"),
            _number("step", "s")._replace(optional=True),
        ),
        fails=Fails.OPERANDS,
    ),
    Declaration(
        "Next",
        ("NEXT[ {variable}]",),
        "ends a FOR",
        (_name("variable", "variable", optional=True),),
        fails=Fails.ALWAYS,  # RBL533, where a jump has led into the block
        closes="FOR",
    ),
    _head("WHILE {value}", "repeats a block as long as the condition is true", _number("value", "condition")),
    _block("WEND", "ends a WHILE", closes="WHILE"),
    _head("SELECT {value}", "begins a block that runs one CASE, by a value", _any("value")),
    # its values are compared while the SELECT is carried out, and RESUME takes the SELECT again
    Declaration(
        "Case", ("CASE {values}",), "divides a SELECT: these values", (_values("values", ", "),), divides="SELECT"
    ),
    _block("CASE ELSE", "divides a SELECT: all other values", divides="SELECT"),
    _block("ENDSELECT", "ends a SELECT", closes="SELECT"),
    Declaration("Jump", ("GOTO {target}",), "goes on at a line", (_TARGET,)),
    Declaration("Jump", ("GOSUB {target}",), "goes on at a line until RETURN, then comes back", (_TARGET,)),
    _words("RETURN", "goes back after the last GOSUB, or ends the SUB", Fails.ALWAYS),
    Declaration(
        "Sub",
        ("SUB {name}[({parameters})]",),
        "begins a subroutine, whose parameters and variables are its own",
        (
            _name("name", "name"),
            _name("parameters", "a, b", optional=True, defines=True)._replace(separator=", "),
            _PARENTHESES,
        ),
    ),
    _block("ENDSUB", "ends a SUB", closes="SUB"),
    Declaration(
        "CallSub",
        ("CALL {name}[({arguments})]",),
        "runs a SUB",
        (_name("name", "name"), _values("arguments", ", ")._replace(optional=True), _PARENTHESES),
        fails=Fails.OPERANDS,
    ),
    _words("END", "ends the program"),
    _words("STOP", "ends the program at once", effect="Halt"),
    _words("PAUSE", "notes a pause and goes on", effect="Halt"),
    _words("RESUME", "ends the handler of an error and repeats the statement that failed", Fails.ALWAYS),
    _words("RESUME NEXT", "ends the handler of an error and goes on after the statement that failed", Fails.ALWAYS),
    Declaration("OnError", ("ON ERROR GOTO {target}",), "goes on at a line when an error occurs", (_TARGET,)),
    _words("ON ERROR STOP", "ends the program when an error occurs"),
)

STATEMENTS = (*_MOTION, *_SETTINGS, *_DATA, *_CONTROL)
"""Every statement, in the order of docs/language.md."""

BY_NODE: dict[str, tuple[Declaration, ...]] = {}
"""The declarations of statements and options by the class of their node."""
for _each in (*OPTIONS, *STATEMENTS):
    # WRIST is an option and a statement, and stands here once
    BY_NODE[_each.node] = (*BY_NODE.get(_each.node, ()), *(() if _each in BY_NODE.get(_each.node, ()) else (_each,)))
BY_WORDS = {(each.node, each.word): each for each in STATEMENTS}
"""The declarations of statements by the class of their node and their first words."""


def declaration(node: object) -> Declaration:
    """Return the declaration of a statement or an option of the tree."""
    kind = type(node).__name__
    # a class of several statements has a word; MOVE and others have none, nor has an option
    return BY_WORDS.get((kind, getattr(node, "word", ""))) or BY_NODE[kind][0]


def forms(keyword: str) -> str:
    """Return how the statements that begin with a word are written; ``""`` where none does."""
    return " or ".join(dict.fromkeys(form(each) for each in STATEMENTS if each.keyword == keyword))
