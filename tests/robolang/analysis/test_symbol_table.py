"""Where names are defined and used, and which are visible."""

import pytest

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import CellSymbols
from robolang.analysis.symbol_table import SymbolKind
from robolang.core.source import Source

CELL = CellSymbols(
    points=frozenset({"P1", "P2", "BENCH"}),
    tools=frozenset({"GRIP"}),
    frames=frozenset({"TABLE"}),
    loads={"EMPTY": None},
    sensors=frozenset({"LASER"}),
)
PROGRAM = """\
10 CONST height = 50
20 n = 1
30 DIM a(3)
40 *AGAIN MOVE P1 + (0, 0, height)
50 a(n) = HEIGHT
60 CALL lift(n)
70 TOOL grip : REM
80 IF n < 3 THEN GOTO *again ELSE GOTO 20
90 LOAD empty
100 END
110 SUB lift(n)
120 local = a(n) + n + height
130 DEPART local
140 ENDSUB
""".replace(" : REM", "")


@pytest.fixture(scope="module")
def table():
    return Analysis(source=Source("pick.rbl", PROGRAM), cell=CELL).symbols


def at(text, count=1, program=PROGRAM):
    """The offset of the ``count``-th place where a text stands."""
    offset = -1
    for _ in range(count):
        offset = program.index(text, offset + 1)
    return offset


def texts(spans, program=PROGRAM):
    return [f"{program.count(chr(10), 0, span.start) + 1}:{program[span.start : span.end]}" for span in spans]


@pytest.mark.parametrize(
    "place, kind, all_places",
    [
        (at("height"), SymbolKind.CONSTANT, ["1:height", "4:height", "5:HEIGHT", "12:height"]),
        (at("HEIGHT"), SymbolKind.CONSTANT, ["1:height", "4:height", "5:HEIGHT", "12:height"]),
        (at("n = 1"), SymbolKind.VARIABLE, ["2:n", "5:n", "6:n", "8:n"]),
        (at("(n)", 3) + 1, SymbolKind.PARAMETER, ["11:n", "12:n", "12:n"]),
        (at("a(3)"), SymbolKind.ARRAY, ["3:a", "5:a", "12:a"]),
        (at("lift"), SymbolKind.SUB, ["6:lift", "11:lift"]),
        (at("again"), SymbolKind.LABEL, ["4:AGAIN", "8:again"]),
        (at("GOTO 20") + 5, SymbolKind.LINE, ["2:20", "8:20"]),
        (at("P1"), SymbolKind.POINT, ["4:P1"]),
        (at("grip"), SymbolKind.TOOL, ["7:grip"]),
        (at("empty"), SymbolKind.LOAD, ["9:empty"]),
        (at("local"), SymbolKind.VARIABLE, ["12:local", "13:local"]),
    ],
)
def test_a_name_has_its_kind_and_all_its_places(table, place, kind, all_places):
    assert table.at(place).kind is kind
    assert texts(table.references(place)) == all_places


def test_the_definition_of_a_name(table):
    assert texts([table.definition(at("HEIGHT"))]) == ["1:height"]
    assert table.definition(at("P1")) is None
    assert table.definition(at("THEN")) is None
    assert table.at(at("END")) is None


def test_a_name_is_met_at_its_end_as_well(table):
    assert table.at(at("height") + len("height")).kind is SymbolKind.CONSTANT


def test_what_is_visible_in_a_sub_and_what_is_not(table):
    inside = {symbol.name: symbol for symbol in table.visible(at("DEPART"))}
    outside = {symbol.name: symbol for symbol in table.visible(at("LOAD"))}
    assert inside["n"].kind is SymbolKind.PARAMETER
    assert outside["n"].kind is SymbolKind.VARIABLE
    assert "local" in inside
    assert "local" not in outside
    for name in ("height", "a", "lift", "AGAIN", "20", "P1", "P2", "grip", "TABLE", "empty", "LASER"):
        assert name in inside, name
        assert name in outside, name
    assert inside["P2"].uses == ()


def test_a_value_hides_a_taught_point_and_a_tool():
    program = "P1 = P2\nTOOL bench\nGRIP = BENCH\nTOOL GRIP\nMOVE P1\n"
    table = Analysis(source=Source("pick.rbl", program), cell=CELL).symbols
    assert table.at(at("P1", 2, program)).kind is SymbolKind.VARIABLE
    assert table.at(at("bench", 1, program)).kind is SymbolKind.POINT
    assert table.at(at("GRIP", 2, program)).kind is SymbolKind.VARIABLE


def test_names_that_nothing_defines():
    program = "x = y + POSE(1, 2, 3, 4, 5, 6).X + HERE.Z + b(1)\nCALL none\nGOTO *nowhere\n"
    table = Analysis(source=Source("pick.rbl", program), cell=CELL).symbols
    assert {symbol.name: symbol.kind for symbol in table.symbols} == {
        "x": SymbolKind.VARIABLE,
        "y": SymbolKind.UNKNOWN,
        "b": SymbolKind.UNKNOWN,
        "none": SymbolKind.SUB,
        "nowhere": SymbolKind.LABEL,
    }
    unknown = Analysis(source=Source("pick.rbl", program)).symbols
    assert unknown.at(at("y", 1, program)).kind is SymbolKind.POINT


def test_an_empty_program_has_no_names():
    table = Analysis(source=Source("pick.rbl", "")).symbols
    assert table.symbols == ()
    assert table.at(0) is None
    assert table.visible(0) == ()
