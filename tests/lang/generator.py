"""Every program that the grammar can express, as hypothesis strategies of the tree, and ways to write one badly.

A tree from here is one that parsing can return: comparisons have two sides, a chain has signs of one level, WAIT leads
somewhere only when it times out, THEN and ELSE of one line hold no block. ``EXPRESSIONS``, ``OPTIONS`` and
``STATEMENTS`` have one strategy for each class, so that a test can see that none is forgotten.
"""

import re
from dataclasses import replace

from hypothesis import strategies as st

from robolang.syntax import ast as nodes
from robolang.syntax.keywords import ARGUMENTS, NEW, RESERVED, VALUES


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
numbers = literals.map(lambda text: nodes.Number(value=float(text), text=text))
names = (
    (st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}\$?", fullmatch=True) | st.sampled_from(sorted(NEW)))
    .filter(lambda text: text.upper() not in RESERVED and text.upper() != "REM$")
    .map(lambda text: nodes.Name(text=text))
)
parts = st.sampled_from(["X", "y", "Z", "rx", "RY", "RZ", "Q"]).map(lambda text: nodes.Name(text=text))
strings = st.text(st.characters(categories=["L", "N", "P", "S"], include_characters=' "') | st.just('"'), max_size=8)
words = st.sampled_from(sorted(VALUES)).map(lambda word: nodes.Call(name=nodes.Name(text=word)))
functions = st.sampled_from(sorted(ARGUMENTS)).map(lambda word: nodes.Name(text=word))

LEVELS = (("OR", "XOR"), ("AND",), ("+", "-"), ("*", "/", "MOD"), ("^",))
COMPARISONS = ("=", "<>", "<", ">", "<=", ">=")


def chains(inner):
    longer = st.sampled_from(LEVELS).flatmap(
        lambda signs: make(nodes.Chain, first=inner, rest=several(st.tuples(st.sampled_from(signs), inner)))
    )
    compared = st.tuples(st.sampled_from(COMPARISONS), inner)
    return longer | make(nodes.Chain, first=inner, rest=several(compared, most=1))


def calls(inner):
    return make(nodes.Call, name=names | functions, arguments=several(inner))


def compound(inner):
    """The kinds of expression that hold others."""
    return {
        nodes.Negate: make(nodes.Negate, operand=inner),
        nodes.Not: make(nodes.Not, operand=inner),
        nodes.Chain: chains(inner),
        nodes.Call: calls(inner),
        nodes.Component6: make(nodes.Component6, base=names | words | calls(inner), name=parts),
        nodes.Vector: make(nodes.Vector, items=several(inner, least=2, most=6)),
    }


simple_values = {nodes.Number: numbers, nodes.Name: names, nodes.Text: make(nodes.Text, value=strings)}
expressions = brief(
    st.recursive(
        st.one_of(numbers, names, numbers, names, simple_values[nodes.Text], words),
        lambda inner: brief(st.one_of(chains(inner), *compound(inner).values())),
        max_leaves=8,
    ).flatmap(lambda node: st.integers(0, 2).map(lambda count: replace(node, parentheses=count)))
)
EXPRESSIONS = {**simple_values, **compound(expressions)}
vectors = EXPRESSIONS[nodes.Vector]


# --- statements ------------------------------------------------------------------------------------------------------

wrists = st.one_of(
    make(nodes.Wrist, mode=st.sampled_from([nodes.WristMode.KEEP, nodes.WristMode.AUTO])),
    make(
        nodes.Wrist,
        mode=st.just(nodes.WristMode.HOLD),
        held=several(st.sampled_from(nodes.Component), most=4),
    ),
)
OPTIONS = {
    nodes.Speed: make(nodes.Speed, value=expressions),
    nodes.Accel: make(nodes.Accel, value=expressions),
    nodes.Time: make(nodes.Time, value=expressions),
    nodes.Zone: make(nodes.Zone, value=st.none() | expressions),
    nodes.Wrist: wrists,
}
options = several(st.one_of(*OPTIONS.values()), least=0)
line_numbers = st.integers(0, 999_999_999)
labels = make(nodes.Target, label=names)
SETTINGS = ("SPEED", "SPEEDJ", "ACCEL", "OVERRIDE", "ZONE", "TOOL", "FRAME")
BLOCKS = ("ELSE", "ENDIF", "WEND", "CASE ELSE", "ENDSELECT", "ENDSUB")
HEADS = ("IF", "ELSEIF", "WHILE", "SELECT")
WORDS = ("RETURN", "END", "STOP", "PAUSE", "RESUME", "RESUME NEXT", "ON ERROR STOP")


def waits(targets):
    return st.one_of(
        make(nodes.Wait, condition=expressions, timeout=st.none() | expressions),
        make(nodes.Wait, condition=expressions, timeout=expressions, target=targets),
    )


def simple_statements(targets):
    """What may stand behind THEN, by class; ``targets`` are where a jump may lead."""
    moved = {"options": options}
    return {
        nodes.Move: make(nodes.Move, target=expressions, **moved),
        nodes.MoveJ: make(nodes.MoveJ, target=expressions, **moved),
        nodes.MoveC: make(nodes.MoveC, via=expressions, target=expressions, **moved),
        nodes.Approach: make(nodes.Approach, target=expressions, distance=expressions, **moved),
        nodes.Depart: make(nodes.Depart, distance=expressions, **moved),
        nodes.Load: make(nodes.Load, cog=vectors, mass=expressions, inertia=st.none() | vectors),
        nodes.LoadNamed: make(nodes.LoadNamed, name=names),
        nodes.Hand: make(nodes.Hand, state=st.sampled_from(nodes.HandState), dwell=st.none() | expressions),
        nodes.Wrist: wrists,
        nodes.Seam: make(nodes.Seam, sensor=st.none() | names),
        nodes.Setting: make(nodes.Setting, word=st.sampled_from(SETTINGS), value=expressions),
        nodes.Assign: make(
            nodes.Assign,
            target=names | make(nodes.Call, name=names, arguments=several(expressions, most=1)),
            value=expressions,
        ),
        nodes.Dim: make(nodes.Dim, name=names, size=expressions),
        nodes.Const: make(nodes.Const, name=names, value=expressions),
        nodes.Out: make(nodes.Out, index=expressions, value=expressions),
        nodes.Pulse: make(nodes.Pulse, index=expressions, seconds=expressions),
        nodes.Delay: make(nodes.Delay, seconds=expressions),
        nodes.Wait: waits(targets),
        nodes.Print: make(nodes.Print, items=several(expressions, least=0)),
        nodes.Jump: make(nodes.Jump, word=st.sampled_from(["GOTO", "GOSUB"]), target=targets),
        nodes.CallSub: make(nodes.CallSub, name=names, arguments=several(expressions, least=0)),
        nodes.Word: make(nodes.Word, word=st.sampled_from(WORDS)),
        nodes.OnError: make(nodes.OnError, target=targets),
    }


def all_statements(targets):
    simple = simple_statements(targets)
    inner = brief(st.one_of(*simple.values()))
    return {
        **simple,
        nodes.If: make(nodes.If, condition=expressions, then=inner, otherwise=st.none() | inner),
        nodes.Block: make(nodes.Block, word=st.sampled_from(BLOCKS)),
        nodes.Head: make(nodes.Head, word=st.sampled_from(HEADS), value=expressions),
        nodes.Case: make(nodes.Case, values=several(expressions)),
        nodes.For: make(nodes.For, variable=names, first=expressions, last=expressions, step=st.none() | expressions),
        nodes.Next: make(nodes.Next, variable=st.none() | names),
        nodes.Sub: make(nodes.Sub, name=names, parameters=several(names, least=0)),
    }


anywhere = make(nodes.Target, number=line_numbers) | labels
STATEMENTS = all_statements(anywhere)
statements = brief(st.one_of(*STATEMENTS.values()))


# --- programs --------------------------------------------------------------------------------------------------------

_letters = st.text(st.characters(categories=["L", "N", "P", "S", "Zs"]), max_size=20)
comments = st.one_of(
    _letters.map(lambda text: nodes.Comment(text=f"'{text}".rstrip())),
    _letters.map(lambda text: nodes.Comment(text=f"REM {text}".rstrip())),
    st.sampled_from(["' fmt: off", "' fmt: on"]).map(lambda text: nodes.Comment(text=text)),
)


def lines(found, numbered):
    made = make(
        nodes.Line, number=numbered, label=st.none() | names, statement=st.none() | found, comment=st.none() | comments
    )
    return made.filter(lambda line: (line.number, line.label, line.statement, line.comment) != (None,) * 4)


programs = several(lines(statements, st.none() | line_numbers), least=0, most=8).map(
    lambda found: nodes.Program(source_path="p", lines=found)
)


@st.composite
def jumping_programs(draw):
    """Programs in which no number is given twice and every jump leads to a line or a label."""
    chosen = draw(st.lists(line_numbers, min_size=1, max_size=6, unique=True))
    leading = st.sampled_from(chosen).map(lambda number: nodes.Target(number=number)) | labels
    found = brief(st.one_of(*all_statements(leading).values()))
    numbered = [draw(lines(found, st.just(number))) for number in chosen]
    others = draw(st.lists(lines(found, st.none()), max_size=4))
    order = draw(st.permutations([*numbered, *others]))
    return nodes.Program(source_path="p", lines=tuple(order))


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
