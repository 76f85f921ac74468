"""The parts of a line have the colour of what the scanner takes them for, and any text has parts."""

import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from prompt_toolkit.document import Document
from pygments.token import Comment, Error, Keyword

from robolang.analysis.symbol_table import SymbolKind
from robolang.pendant.lexer import PromptLexer, coloured
from robolang.pendant.marks import Mark, parts
from robolang.pendant.pygments_lexer import RobolangLexer
from robolang.syntax.keywords import KEYWORDS
from tests.together import together

ROOT = Path(__file__).parents[3]
PROGRAMS = sorted((ROOT / "programs").rglob("*.rbl"))
COMMANDS = frozenset({"TEACH", "LIST"})
NAMES = {"P1": SymbolKind.POINT, "GRIP": SymbolKind.TOOL, "N": SymbolKind.VARIABLE}


def marked(line):
    return [(line[part.start : part.end], part.mark) for part in parts(line, NAMES, COMMANDS)]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("65 delay 1", [("65", Mark.LINE), ("delay", Mark.KEYWORD), ("1", Mark.NUMBER)]),
        ("*top move p1", [("*", Mark.LABEL), ("top", Mark.LABEL), ("move", Mark.KEYWORD), ("p1", Mark.POINT)]),
        ("GOTO *top", [("GOTO", Mark.KEYWORD), ("*", Mark.LABEL), ("top", Mark.LABEL)]),
        ("GOTO 65", [("GOTO", Mark.KEYWORD), ("65", Mark.LINE)]),
        ("n * n", [("n", Mark.NAME), ("*", Mark.SIGN), ("n", Mark.NAME)]),
        ("TOOL grip ' x", [("TOOL", Mark.KEYWORD), ("grip", Mark.OF_CELL), ("' x", Mark.COMMENT)]),
        ('PRINT "a";', [("PRINT", Mark.KEYWORD), ('"a"', Mark.TEXT), (";", Mark.SIGN)]),
        ("IN(1)", [("IN", Mark.FUNCTION), ("(", Mark.SIGN), ("1", Mark.NUMBER), (")", Mark.SIGN)]),
        ("teach P1", [("teach", Mark.COMMAND), ("P1", Mark.POINT)]),
        ("teach = 3", [("teach", Mark.NAME), ("=", Mark.SIGN), ("3", Mark.NUMBER)]),
        (
            "list(2)=3",
            [("list", Mark.NAME), *((sign, Mark.NUMBER if sign.isdigit() else Mark.SIGN) for sign in "(2)=3")],
        ),
        ("1x & \u0436", [("1x", Mark.WRONG), ("&", Mark.WRONG), ("\u0436", Mark.WRONG)]),
        ("   ", []),
    ],
)
def test_parts_of_a_line(line, expected):
    assert marked(line) == expected


@together("word", sorted(KEYWORDS))
def test_every_keyword_of_the_language_is_one(word):
    assert marked(word)[0] == (word, Mark.KEYWORD)


@given(st.text(alphabet=st.characters(exclude_characters="\n\r")))
def test_any_line_has_parts_in_order_and_nothing_is_lost(line):
    at = 0
    for part in parts(line, NAMES, COMMANDS):
        assert at <= part.start < part.end
        assert not line[at : part.start].strip(" \t")
        at = part.end
    assert not line[at:].strip(" \t")
    assert "".join(fragment[1] for fragment in coloured(line, NAMES, COMMANDS)) == line


def test_a_line_that_is_too_long_to_be_read_has_no_colours():
    line = "x" * 20_000
    assert coloured(line, {}) == [("", line)]


@given(st.text())
def test_lines_of_a_document_are_those_of_the_text(text):
    document = Document(text)
    line_of = PromptLexer(lambda: NAMES, COMMANDS).lex_document(document)
    for number, line in enumerate(document.lines):
        assert "".join(fragment[1] for fragment in line_of(number)) == line
    assert line_of(len(document.lines)) == []


@given(st.text())
def test_pygments_gets_every_character(text):
    tokens = list(RobolangLexer().get_tokens_unprocessed(text))
    assert "".join(each for _, _, each in tokens) == text
    assert [at for at, _, _ in tokens] == [sum(len(each) for _, _, each in tokens[:i]) for i in range(len(tokens))]


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_programs_have_no_wrong_part(path):
    kinds = {kind for kind, _ in RobolangLexer().get_tokens(path.read_text("utf-8"))}
    assert Error not in kinds
    assert {Keyword, Comment.Single} <= kinds


def test_pygments_finds_the_lexer_by_its_entry_point():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    entry = EntryPoint(
        name="robolang", group="pygments.lexers", value=project["entry-points"]["pygments.lexers"]["robolang"]
    )
    assert entry.load() is RobolangLexer
    assert "robolang" in RobolangLexer.aliases
