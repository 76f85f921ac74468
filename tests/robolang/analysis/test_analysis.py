"""One analysis of a text: what it holds, that an edit parses changed lines alone, and that everybody shares it."""

from dataclasses import fields, is_dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import CellSymbols
from robolang.cli.check_motion import planned
from robolang.cli.main import app
from robolang.core.diagnostics import MAX_DIAGNOSTICS, Edit
from robolang.core.source import Source, Span
from robolang.lint.engine import check_points, check_source
from robolang.project.project import load_project
from robolang.syntax import parser
from robolang.syntax.formatter import format_source
from robolang.syntax.parser import parse
from robolang.syntax.renumber import renumber
from robolang.syntax.tree import NOWHERE
from tests.campaign import examples
from tests.robolang.generator import jumping_programs, programs, texts
from tests.robolang.helpers import print_program

ENDS = st.sampled_from(["\n", "\r\n", "\r"])
INSERTED = st.sampled_from(
    ["", "\n", "\r", "\r\n", " ", "'", '"', "(", "1", "GOTO 10\n", "MOVE P1", "\nNEXT\n", "*L ", ",", "é"]
) | st.text(max_size=6)


def whole(value):
    """A value with everything in it that equality passes over, places above all."""
    if is_dataclass(value):
        return type(value).__name__, [(item.name, whole(getattr(value, item.name))) for item in fields(value)]
    return [whole(each) for each in value] if isinstance(value, tuple) else value


@st.composite
def edits(draw, text):
    start = draw(st.integers(0, len(text)))
    end = draw(st.integers(start, min(len(text), start + 40)))
    return Edit(span=Span(start, end), text=draw(INSERTED))


@st.composite
def written(draw):
    """The text of a program, or of anything."""
    text = draw(programs.map(print_program) | jumping_programs().map(print_program) | texts)
    return text.replace("\n", draw(ENDS))


@given(written(), st.data())
@examples(400)
def test_an_updated_analysis_is_that_of_the_new_text(text, data):
    analysis = Analysis(source=Source("pick.rbl", text))
    for _ in range(3):
        edit = data.draw(edits(analysis.source.text))
        analysis = analysis.updated(edit)
        fresh = Analysis(source=Source("pick.rbl", analysis.source.text))
        assert whole(analysis.parsed) == whole(fresh.parsed)
        assert analysis.diagnostics == fresh.diagnostics
        assert analysis.symbols.symbols == fresh.symbols.symbols


@pytest.fixture
def lines(monkeypatch):
    """The texts of the lines that are parsed."""
    found = []
    line = parser._parse_line
    monkeypatch.setattr(parser, "_parse_line", lambda text, *place: (found.append(text), line(text, *place))[1])
    return found


@pytest.fixture
def texts_parsed(monkeypatch):
    """The sources that are parsed as a whole, wherever it is called."""
    found = []
    whole_text = parser.parse

    def counted(source, *known):
        found.append(source.text)
        return whole_text(source, *known)

    for module in ("analysis.analysis", "syntax.reparse", "syntax.formatter", "syntax.renumber", "lint.fixes"):
        monkeypatch.setattr(f"robolang.{module}.parse", counted)
    return found


def test_only_the_changed_line_is_parsed(lines):
    text = "".join(f"{10 * row} MOVE P{row}, SPEED 200\n" for row in range(1, 200))
    analysis = Analysis(source=Source("pick.rbl", text))
    assert len(analysis.program.lines) == len(lines) == 199
    lines.clear()
    at = text.index("MOVE P100")
    updated = analysis.updated(Edit(span=Span(at, at + 4), text="MOVEJ"))
    assert lines == ["1000 MOVEJ P100, SPEED 200"]
    assert updated.program.lines[0] is analysis.program.lines[0]
    assert updated.program.lines[150].span.start == analysis.program.lines[150].span.start + 1
    assert whole(updated.parsed) == whole(parse(updated.source))


@given(written(), st.data())
@examples(200)
def test_an_edit_parses_no_line_that_was_there(text, data):
    """A line of the new text that is not new is not parsed; a line that ends or begins at the edit may be."""
    analysis = Analysis(source=Source("pick.rbl", text))
    rows = len(analysis.program.lines)
    edit = data.draw(edits(text))
    found, line = [], parser._parse_line
    parser._parse_line = lambda text, *place: (found.append(text), line(text, *place))[1]
    try:
        updated = analysis.updated(edit)
    finally:
        parser._parse_line = line
    touched = edit.text.count("\n") + edit.text.count("\r") + 2
    assert len(found) <= touched
    assert len(updated.program.lines) <= rows + touched


def test_parts_are_computed_once_and_only_when_asked_for(lines):
    analysis = Analysis(source=Source("pick.rbl", "10 MOVE P1\n20 GOTO 10\n"))
    assert lines == []
    assert analysis.blocks is analysis.blocks
    assert analysis.symbols is analysis.symbols
    assert analysis.flow is analysis.flow
    assert analysis.diagnostics is analysis.diagnostics
    assert len(lines) == 2


def test_another_cell_shares_the_tree_and_not_the_names():
    analysis = Analysis(source=Source("pick.rbl", "10 MOVE P1\n"))
    assert analysis.diagnostics == ()
    empty = analysis.within(CellSymbols.of(None, points=()))
    assert empty.parsed is analysis.parsed
    assert [item.code for item in empty.diagnostics] == ["RBL301"]
    assert analysis.within(analysis.cell) is analysis


def test_after_too_many_errors_an_edit_reads_on():
    text = "MOV P1\n" * (MAX_DIAGNOSTICS + 50)
    analysis = Analysis(source=Source("pick.rbl", text))
    updated = analysis.updated(Edit(span=Span(0, 7 * 100), text=""))
    assert whole(updated.parsed) == whole(parse(updated.source))
    assert len(updated.program.lines) == MAX_DIAGNOSTICS - 50


def test_a_deep_line_is_parsed_again_and_not_moved(lines):
    deep = f"10 x = {'(1 + ' * 99}1{')' * 99}"
    analysis = Analysis(source=Source("pick.rbl", f"MOVE P1\n{deep}\n"))
    assert analysis.parsed.diagnostics == ()
    lines.clear()
    updated = analysis.updated(Edit(span=Span(0, 0), text="\n"))
    assert lines == [deep]
    assert whole(updated.parsed) == whole(parse(updated.source))


def test_checking_a_file_parses_it_once(tmp_path, texts_parsed):
    text = "10 MOVE P1\n20 MOVE P2\n"
    (tmp_path / "pick.rbl").write_text(text)
    (tmp_path / "pick.points.toml").write_text(
        "schema = 1\n[points.P1]\npose = [450, 0, 200, 180, 0, 0]\n[points.P2]\npose = [450, 0, 300, 180, 0, 0]\n"
        "[points.OLD]\npose = [450, 0, 300, 180, 0, 0]\n"
    )
    assert "RBL224" in CliRunner().invoke(app, ["check", str(tmp_path)]).output
    assert texts_parsed == [text]


@pytest.mark.physics
def test_planning_takes_over_the_analysis(tmp_path, texts_parsed):
    path = tmp_path / "pick.rbl"
    path.write_text("10 MOVE P1\n")
    checked = check_source(Source(str(path), "10 MOVE P1\n"))
    assert check_points(checked) is None
    assert planned(checked.analysis, None).diagnostics == checked.diagnostics == ()
    assert load_project(checked.analysis).analysis is checked.analysis
    assert texts_parsed == ["10 MOVE P1\n"]


def test_the_formatter_and_renumber_take_the_tree_of_an_analysis(texts_parsed):
    analysis = Analysis(source=Source("pick.rbl", "10 move P1\n15 goto 10\n"))
    assert format_source(analysis.source, analysis.parsed).text == "10 MOVE P1\n15 GOTO 10\n"
    assert renumber(analysis.source, parsed=analysis.parsed).text == "10 move P1\n20 goto 10\n"
    assert texts_parsed == ["10 move P1\n15 goto 10\n"]


def test_a_place_at_offset_zero_moves_and_no_place_does_not():
    analysis = Analysis(source=Source("pick.rbl", "MOVE P1\n"))
    updated = analysis.updated(Edit(span=Span(0, 0), text="\n"))
    (line,) = updated.program.lines
    assert (line.span, line.number_span) == (Span(1, 8), NOWHERE)
