"""The shipped table of the grammar is the grammar's, and what happens without it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.syntax import grammar, parser
from robolang.syntax.grammar import TABLE, line_parser, made, serialized

ROOT = Path(__file__).parents[3]
PROGRAMS = sorted((ROOT / "programs").rglob("*.rbl"))
ODD = 'MOV P1\n10 MOVE\nMOVE P1 P2\nLOAD (0, 0 60), 1\nx = (1 + \n"a\nIF 1 THEN\n* A\nMOVE P1, SPEED 1_0\nx = 3E999\n'


@pytest.fixture
def fresh():
    line_parser.cache_clear()
    yield
    line_parser.cache_clear()


@pytest.fixture(scope="module")
def made_once():
    return made()


def test_the_shipped_table_is_that_of_the_grammar():
    assert TABLE.read_text("utf-8") == serialized(), "run: python -m robolang.syntax.grammar"


def test_it_is_the_same_in_every_process():
    script = "from robolang.syntax.grammar import serialized; print(hash_of(serialized()))"
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
    shipped = parser.parse(Source("p", text))
    monkeypatch.setattr(parser, "line_parser", lambda: made_once)
    assert parser.parse(Source("p", text)) == shipped


@pytest.mark.parametrize("content", [None, "", "{", json.dumps({"lark": "0.1"})])
def test_without_a_table_of_this_lark_it_is_made(tmp_path, monkeypatch, fresh, content):
    calls = []
    monkeypatch.setattr(grammar, "TABLE", tmp_path / "grammar.json")
    monkeypatch.setattr(grammar, "made", lambda: calls.append(1) or made())
    if content is not None:
        (tmp_path / "grammar.json").write_text(content)
    assert parser.parse(Source("p", "MOVE P1\n")).diagnostics == ()
    assert calls == [1]


def test_with_it_nothing_is_made(monkeypatch, fresh):
    monkeypatch.setattr(grammar, "made", lambda: pytest.fail("made from the grammar"))
    assert parser.parse(Source("p", "MOVE P1\n")).diagnostics == ()
