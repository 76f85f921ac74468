"""The shipped tables are those of the grammar, what reads them agrees, and what happens without them."""

import json
import os
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.syntax import grammar, line_errors, line_reader, parser
from robolang.syntax.grammar import TABLE, line_parser, line_table, made, serialized
from robolang.syntax.line_errors import parsed_by_lark
from robolang.syntax.syntax_errors import explain
from robolang.syntax.tree import Node, fields
from robolang.syntax.unexpected import unexpected
from tests.campaign import size

ROOT = Path(__file__).parents[3]
PROGRAMS = sorted((ROOT / "programs").rglob("*.rbl"))
MORE = sorted((ROOT / "tests").rglob("*.rbl"))
GOOD = """\
MOVE P1 + (0, 0, 10 * i), SPEED 100, WRIST HOLD TILT, ROTATION, ZONE 5
*A
IF a = 1 OR NOT b <= 2 AND c <> 3 THEN GOTO *A ELSE HAND ON, 0.5  ' and so on
PRINT "a ""b"; -2 ^ -x; (a, b); P1.X; XOR;
XOR = 1 XOR 0 XOR 1
CALL S(1, 2 MOD 3, F(4))
ON ERROR GOTO 10
FOR i = 1 TO 10 STEP -2 REM so
"""
ODD = 'MOV P1\n10 MOVE\nMOVE P1 P2\nLOAD (0, 0 60), 1\nx = (1 + \n"a\nIF 1 THEN\n* A\nMOVE P1, SPEED 1_0\nx = 3E999\n'


@pytest.fixture
def fresh():
    line_parser.cache_clear()
    line_reader.line_reader.cache_clear()
    yield
    line_parser.cache_clear()
    line_reader.line_reader.cache_clear()


@pytest.fixture
def lark_alone(monkeypatch):
    monkeypatch.setattr(parser, "line_reader", lambda: None)


@pytest.fixture(scope="module")
def made_once():
    return made()


def test_the_shipped_table_is_that_of_the_grammar():
    assert TABLE.read_text("utf-8") == serialized(), "run: python -m robolang.syntax.grammar"
    assert line_reader.TABLE.read_text("utf-8") == line_table(), "run: python -m robolang.syntax.grammar"


def test_it_is_the_same_in_every_process():
    script = "from robolang.syntax.grammar import line_table; print(hash_of(line_table()))"
    script = f"import hashlib\nhash_of = lambda text: hashlib.sha256(text.encode()).hexdigest()\n{script}"
    said = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "PYTHONHASHSEED": seed},
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(said) == 1


@pytest.mark.parametrize("text", [*(path.read_text("utf-8") for path in PROGRAMS), ODD])
def test_it_parses_what_the_grammar_parses(text, monkeypatch, fresh, made_once):
    read = parser.parse(Source("p", text))
    monkeypatch.setattr(parser, "line_reader", lambda: None)
    assert parser.parse(Source("p", text)) == read
    monkeypatch.setattr(line_errors, "line_parser", lambda: made_once)
    assert parser.parse(Source("p", text)) == read


@pytest.mark.parametrize("content", [None, "", "{", json.dumps({"lark": "0.1"})])
def test_without_a_table_of_this_lark_it_is_made(tmp_path, monkeypatch, fresh, lark_alone, content):
    calls = []
    monkeypatch.setattr(grammar, "TABLE", tmp_path / "grammar.json")
    monkeypatch.setattr(grammar, "made", lambda: calls.append(1) or made())
    if content is not None:
        (tmp_path / "grammar.json").write_text(content)
    assert parser.parse(Source("p", "MOVE P1\n")).diagnostics == ()
    assert calls == [1]


def test_with_it_nothing_is_made(monkeypatch, fresh, lark_alone):
    monkeypatch.setattr(grammar, "made", lambda: pytest.fail("made from the grammar"))
    assert parser.parse(Source("p", "MOVE P1\n")).diagnostics == ()


# --- the reader of lines ----------------------------------------------------------------------------------------------


def everything(part):
    """A node with all its fields, the places included, which take no part in a comparison."""
    if isinstance(part, tuple):
        return tuple(map(everything, part))
    if isinstance(part, Node):
        return type(part).__name__, *(everything(getattr(part, name)) for name in fields(type(part)))
    return part


def agree(code):
    """Whether a line has no error; reader and Lark say the same of it."""
    reader = line_reader.line_reader()
    assert reader is not None
    read, expected = reader.read(code, 7), parsed_by_lark(code, 7)
    if isinstance(read, line_reader.Stopped):
        assert explain(unexpected(read.token, read.accepts, code, 7)) == expected, code
        return False
    assert everything(read) == everything(expected), code
    return True


def pieces():
    """Good lines in pieces: words, numbers, signs and blanks."""
    lines = [line for path in (*PROGRAMS, *MORE) for line in path.read_text("utf-8", "replace").splitlines()]
    codes = {re.sub(r"^[ \t]*(?:[0-9]+(?![\w.]))?[ \t]*", "", line) for line in (*lines, *GOOD.splitlines())}
    return [re.findall(r"\s+|\w+|[^\w\s]", code) for code in sorted(codes) if code]


def test_it_reads_a_line_and_explains_an_error_as_lark_does():
    """Lines with pieces left out, twice, or followed by the rest of another line."""
    draw, given = random.Random(41), pieces()
    good = [line for line in given if agree("".join(line))]
    assert len(good) > 100
    count = 0
    for _ in range(size(200_000, 2_000)):
        first, second = draw.choice(good), draw.choice(good)
        at, to = draw.randint(0, len(first)), draw.randint(0, len(second))
        changed = draw.choice((first[:at] + second[to:], first[:at] + first[at + 1 :], first[:at] + first[at - 1 :]))
        count += agree("".join(changed))
    assert count > 100


@pytest.mark.parametrize("content", [None, "", "{", "{}"])
def test_without_its_table_lark_parses_every_line(tmp_path, monkeypatch, fresh, content):
    whole = parser.parse(Source("p", GOOD))
    line_reader.line_reader.cache_clear()
    monkeypatch.setattr(line_reader, "TABLE", tmp_path / "line_table.json")
    if content is not None:
        (tmp_path / "line_table.json").write_text(content)
    assert line_reader.line_reader() is None
    assert parser.parse(Source("p", GOOD)) == whole
    assert whole.diagnostics == ()


def test_no_line_imports_lark():
    script = (
        "import sys; from robolang.core.source import Source; from robolang.syntax.parser import parse\n"
        "parse(Source('p', sys.argv[1])); print('lark' in sys.modules)"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", script, text], cwd=ROOT, capture_output=True, text=True, check=True
        ).stdout
        for text in (GOOD, "MOV P1\n")
    ]
    assert said == ["False\n", "False\n"]
