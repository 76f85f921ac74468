"""Every program that the grammar can express, as hypothesis strategies of the tree, and ways to write one badly.

A tree from here is one that parsing can return: comparisons have two sides, a chain has signs of one level, WAIT leads
somewhere only when it times out, THEN and ELSE of one line hold no block. ``EXPRESSIONS``, ``OPTIONS`` and
``STATEMENTS`` have one strategy for each class, so that a test can see that none is forgotten.
"""

import re

from hypothesis import strategies as st

from robolang.syntax import ast
from robolang.syntax.keywords import FUNCTIONS, INSTRUCTIONS, NEW, RESERVED, VALUES


def make(kind, **parts):
    return st.builds(kind, **parts)


def brief(strategy):
    """The same strategy with a short ``repr``; hypothesis builds those of nested ones in full, and warns."""

    @st.composite
    def one(draw):
        return draw(strategy)

    return one()


def several(items, least=1, most=3):
    return st.lists(items, min_size=least, max_size=most).map(tuple)


# --- expressions -----------------------------------------------------------------------------------------------------

literals = st.one_of(
    st.integers(0, 10**6).map(str),
    st.floats(0, 1e300, allow_nan=False).map(repr),
    st.sampled_from([".5", "5.", "1E3", "1e-3", "00", "3.25E+2"]),
)
numbers = literals.map(lambda text: ast.Number(value=float(text), text=text))
names = (
    (st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}\$?", fullmatch=True) | st.sampled_from(sorted(NEW)))
    .filter(lambda text: text.upper() not in RESERVED and text.upper() != "REM$")
    .map(lambda text: ast.Name(text=text))
)
assigned = names.filter(lambda name: name.key not in INSTRUCTIONS)
parts = st.sampled_from(["X", "y", "Z", "rx", "RY", "RZ", "Q"]).map(lambda text: ast.Name(text=text))
strings = st.text(st.characters(categories=["L", "N", "P", "S"], include_characters=' "') | st.just('"'), max_size=8)
words = st.sampled_from(sorted(VALUES)).map(lambda word: ast.Call(name=ast.Name(text=word)))
functions = st.sampled_from(sorted(FUNCTIONS)).map(lambda word: ast.Name(text=word))

LEVELS = (("OR", "XOR"), ("AND",), ("+", "-"), ("*", "/", "MOD"), ("^",))
COMPARISONS = ("=", "<>", "<", ">", "<=", ">=")


def chains(inner):
    longer = st.sampled_from(LEVELS).flatmap(
        lambda signs: make(ast.Chain, first=inner, rest=several(st.tuples(st.sampled_from(signs), inner)))
    )
    compared = st.tuples(st.sampled_from(COMPARISONS), inner)
    return longer | make(ast.Chain, first=inner, rest=several(compared, most=1))


def calls(inner):
    return make(ast.Call, name=names | functions, arguments=several(inner))


def compound(inner):
    """The kinds of expression that hold others."""
    return {
        ast.Negate: make(ast.Negate, operand=inner),
        ast.Not: make(ast.Not, operand=inner),
        ast.Chain: chains(inner),
        ast.Call: calls(inner),
        ast.Component6: make(ast.Component6, base=names | words | calls(inner), name=parts),
        ast.Vector: make(ast.Vector, items=several(inner, least=2, most=6)),
    }


simple_values = {ast.Number: numbers, ast.Name: names, ast.Text: make(ast.Text, value=strings)}
expressions = brief(
    st.recursive(
        st.one_of(numbers, names, numbers, names, simple_values[ast.Text], words),
        lambda inner: brief(st.one_of(chains(inner), *compound(inner).values())),
        max_leaves=8,
    ).flatmap(lambda node: st.integers(0, 2).map(lambda count: ast.replace(node, parentheses=count)))
)
EXPRESSIONS = {**simple_values, **compound(expressions)}
vectors = EXPRESSIONS[ast.Vector]


# --- statements ------------------------------------------------------------------------------------------------------

wrists = st.one_of(
    make(ast.Wrist, mode=st.sampled_from([ast.WristMode.KEEP, ast.WristMode.AUTO])),
    make(
        ast.Wrist,
        mode=st.just(ast.WristMode.HOLD),
        held=several(st.sampled_from(ast.Component), most=4),
    ),
)
OPTIONS = {
    ast.Speed: make(ast.Speed, value=expressions),
    ast.Accel: make(ast.Accel, value=st.none() | expressions),
    ast.Time: make(ast.Time, value=expressions),
    ast.Zone: make(ast.Zone, value=st.none() | expressions),
    ast.Wrist: wrists,
}
options = several(st.one_of(*OPTIONS.values()), least=0)
line_numbers = st.integers(0, 999_999_999)
labels = make(ast.Target, label=names)
SETTINGS = ("SPEED", "SPEEDJ", "ACCEL", "OVERRIDE", "ZONE", "TOOL", "FRAME")
BLOCKS = ("ELSE", "ENDIF", "WEND", "CASE ELSE", "ENDSELECT", "ENDSUB")
HEADS = ("IF", "ELSEIF", "WHILE", "SELECT")
WORDS = ("RETURN", "END", "STOP", "PAUSE", "RESUME", "RESUME NEXT", "ON ERROR STOP")


def waits(targets):
    return st.one_of(
        make(ast.Wait, condition=expressions, timeout=st.none() | expressions),
        make(ast.Wait, condition=expressions, timeout=expressions, target=targets),
    )


def simple_statements(targets):
    """What may stand behind THEN, by class; ``targets`` are where a jump may lead."""
    moved = {"options": options}
    return {
        ast.Move: make(ast.Move, target=expressions, **moved),
        ast.MoveJ: make(ast.MoveJ, target=expressions, **moved),
        ast.MoveC: make(ast.MoveC, via=expressions, target=expressions, **moved),
        ast.Spline: make(ast.Spline, points=several(expressions), **moved),
        ast.Approach: make(ast.Approach, target=expressions, distance=expressions, **moved),
        ast.Depart: make(ast.Depart, distance=expressions, **moved),
        ast.Load: make(ast.Load, cog=vectors, mass=expressions, inertia=st.none() | vectors),
        ast.LoadNamed: make(ast.LoadNamed, name=names),
        ast.Hand: make(ast.Hand, state=st.sampled_from(ast.HandState), dwell=st.none() | expressions),
        ast.Wrist: wrists,
        ast.Seam: make(ast.Seam, sensor=st.none() | names),
        ast.Setting: st.one_of(
            make(ast.Setting, word=st.sampled_from(SETTINGS), value=expressions),
            make(ast.Setting, word=st.just("ACCEL"), value=st.none()),
        ),
        ast.Assign: make(
            ast.Assign,
            target=assigned | make(ast.Call, name=assigned, arguments=several(expressions, most=1)),
            value=expressions,
        ),
        ast.Dim: make(ast.Dim, name=names, size=expressions),
        ast.Const: make(ast.Const, name=names, value=expressions),
        ast.Out: make(ast.Out, index=expressions, value=expressions),
        ast.Pulse: make(ast.Pulse, index=expressions, seconds=expressions),
        ast.Delay: make(ast.Delay, seconds=expressions),
        ast.Wait: waits(targets),
        ast.Print: make(ast.Print, items=several(expressions, least=0)),
        ast.Jump: make(ast.Jump, word=st.sampled_from(["GOTO", "GOSUB"]), target=targets),
        ast.CallSub: make(ast.CallSub, name=names, arguments=several(expressions, least=0)),
        ast.Word: make(ast.Word, word=st.sampled_from(WORDS)),
        ast.OnError: make(ast.OnError, target=targets),
    }


def all_statements(targets):
    simple = simple_statements(targets)
    inner = brief(st.one_of(*simple.values()))
    return {
        **simple,
        ast.If: make(ast.If, condition=expressions, then=inner, otherwise=st.none() | inner),
        ast.Block: make(ast.Block, word=st.sampled_from(BLOCKS)),
        ast.Head: make(ast.Head, word=st.sampled_from(HEADS), value=expressions),
        ast.Case: make(ast.Case, values=several(expressions)),
        ast.For: make(ast.For, variable=names, first=expressions, last=expressions, step=st.none() | expressions),
        ast.Next: make(ast.Next, variable=st.none() | names),
        ast.Sub: make(ast.Sub, name=names, parameters=several(names, least=0)),
    }


anywhere = make(ast.Target, number=line_numbers) | labels
STATEMENTS = all_statements(anywhere)
statements = brief(st.one_of(*STATEMENTS.values()))


# --- programs --------------------------------------------------------------------------------------------------------

_letters = st.text(st.characters(categories=["L", "N", "P", "S", "Zs"]), max_size=20)
comments = st.one_of(
    _letters.map(lambda text: ast.Comment(text=f"'{text}".rstrip())),
    _letters.map(lambda text: ast.Comment(text=f"REM {text}".rstrip())),
    st.sampled_from(["' fmt: off", "' fmt: on"]).map(lambda text: ast.Comment(text=text)),
)


def lines(found, numbered):
    made = make(
        ast.Line, number=numbered, label=st.none() | names, statement=st.none() | found, comment=st.none() | comments
    )
    return made.filter(lambda line: (line.number, line.label, line.statement, line.comment) != (None,) * 4)


programs = several(lines(statements, st.none() | line_numbers), least=0, most=8).map(
    lambda found: ast.Program(source_path="p", lines=found)
)


@st.composite
def jumping_programs(draw):
    """Programs in which no number is given twice and every jump leads to a line or a label."""
    chosen = draw(st.lists(line_numbers, min_size=1, max_size=6, unique=True))
    leading = st.sampled_from(chosen).map(lambda number: ast.Target(number=number)) | labels
    found = brief(st.one_of(*all_statements(leading).values()))
    numbered = [draw(lines(found, st.just(number))) for number in chosen]
    others = draw(st.lists(lines(found, st.none()), max_size=4))
    order = draw(st.permutations([*numbered, *others]))
    return ast.Program(source_path="p", lines=tuple(order))


# --- texts -----------------------------------------------------------------------------------------------------------

_TOKEN = re.compile(
    r"""(?P<kept>"[^"]*"|'.*|\bREM\b.*)|(?P<space>[ ]+)"""
    r"""|(?P<word>(?<!\w)[\d.]+[eE][+-]?\d+|[^\s"'(),;=+*/^<>-]+)|(?P<sign><=|>=|<>|.)"""
)


@st.composite
def written_badly(draw, text):
    """Another text of the same tree: other blanks, other capitals, blank lines, another line end."""
    blanks = st.sampled_from([" ", "  ", "\t", " \t "])
    gaps = st.sampled_from(["", "", "", " ", "\t"])
    end = draw(st.sampled_from(["\n", "\r\n", "\r"]))
    result = []
    for line in text.split("\n")[:-1]:
        result.append(draw(gaps))
        for token in _TOKEN.finditer(line):
            if token["kept"] is not None:
                result.append(re.sub("^REM", draw(st.sampled_from(["REM", "rem", "Rem"])), token["kept"]))
            elif token["space"] is not None:
                result.append(draw(blanks))
            elif token["sign"] is not None:
                result += [draw(gaps), token["sign"], draw(gaps)]
            else:
                result.append(draw(st.sampled_from([str.upper, str.lower, str.title, str]))(token["word"]))
        result += [draw(gaps), end * draw(st.integers(1, 5))]
    return "".join(result) if draw(st.booleans()) else "".join(result).rstrip("\r\n")


FRAGMENTS = (
    "MOVE",
    "move ",
    "LOAD",
    "HAND ",
    "ON",
    "OFF",
    "P1",
    "P2 ",
    "SPEED",
    "TIME",
    ",",
    "(",
    ")",
    "-",
    "+",
    "1",
    ".5",
    "1E999",
    "1_0",
    "'",
    "REM ",
    "\n",
    "\r\n",
    "\r",
    "\t",
    " ",
    "10 ",
    "МOVE",
    "\u202e",
    "\x00",
    "=",
    "*",
    "MOVEJ",
    "WRIST ",
    "KEEP",
    "HOLD ",
    "TILT",
    "ADVANCE",
    "SEAM ",
    "IF ",
    " THEN ",
    "ELSE",
    "ENDIF",
    "FOR I=1 TO 2",
    "NEXT",
    "WHILE ",
    "WEND",
    "SELECT ",
    "CASE ",
    "ENDSELECT",
    "SUB F",
    "ENDSUB",
    "CALL F",
    "GOTO ",
    "GOTO 1.5",
    "*L",
    "^",
    " MOD ",
    "NOT ",
    " AND ",
    " OR ",
    "<>",
    "<=",
    '"',
    '"a\'"',
    "x",
    "x=1",
    ".X",
    "HERE",
    "PRINT ",
    ";",
    "' fmt: off",
    "' fmt: on",
    "OUT(1)=",
    "IN(",
    "STR$(",
    "END",
    "RESUME NEXT",
    "ON ERROR GOTO *L",
    "WAIT ",
    "TIMEOUT ",
    "DIM A(2)",
    " XOR ",
    "XOR",
    '"a""b"',
    "((x))",
    "FRAME WORLD",
    "TOOL FLANGE",
    ":=",
    "EXIT FOR",
    "P1.Z=1",
    "WAIT 2",
)
texts = st.text(max_size=200) | st.lists(st.sampled_from(FRAGMENTS), max_size=60).map("".join)
