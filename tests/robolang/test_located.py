"""R12: whatever is found has a registered code and a place inside the file, the same in every form.

The catalogue are the programs of the rules and the golden rows of the bad inputs; the mutants are programs, or some
lines of one, with a few characters, words or lines changed, from fixed seeds. ``NUMBER`` of them are made in all.
"""

import random
import re
from pathlib import Path

import pytest

from robolang.core.diagnostics import Diagnostic, render, to_json
from robolang.core.source import Source, Span
from robolang.lint.engine import Checked, lint
from robolang.lint.registry import rules
from robolang.lint.reporters.finding import findings
from robolang.project.points import load_points
from runtime.core.faults import lookup
from runtime.core.toml_places import lines_of
from runtime.core.tomlfile import FileFault
from tests.campaign import size
from tests.robolang.helpers import cell_with
from tests.robolang.test_bad_inputs import GOLDEN, GOOD
from tests.runtime.from_texts import load_cell
from tests.together import together

ROOT = Path(__file__).parents[2]
NUMBER = size(10_000, 2000)
PARTS = size(8, 2)
assert NUMBER % PARTS == 0
FILES = size(1000, 200)
POINTS = ("P1", "P2", "P3", "FEED", "HOME")
CATALOGUE = [rule.bad for rule in rules().values() if not rule.points and "\udcb0" not in rule.bad]
CATALOGUE += [row[1] for row in GOLDEN if len(row[1]) < 100_000]
PROGRAMS = [GOOD, *(path.read_text("utf-8") for path in sorted((ROOT / "programs").rglob("*.rbl")))]
POINTS_FILES = sorted((ROOT / "programs").rglob("*.points.toml"))
CELLS = sorted((ROOT / "programs").rglob("*cell.toml"))
INSERTED = [
    *"0123456789 .,;:()*+-/^=<>\"'_$#abcXYZ\t\r\n\0\u202e\u200bМé\ufeff",
    "MOVE",
    "IF",
    "THEN",
    "ENDIF",
    "FOR",
    "NEXT",
    "GOTO",
    "noqa",
    "1e999",
    "SUB",
    "\r\n",
    "((",
    "' noqa: RBL301",
]


# --- what is judged --------------------------------------------------------------------------------------------------


def assert_located(text: str, found: tuple[Diagnostic, ...]) -> None:
    """Every span of every finding lies in the text, and text, JSON and report forms say the same place of it."""
    source = Source("p.rbl", text)
    lines = source.line_spans
    for item, shown in zip(found, findings([Checked(source=source, diagnostics=found)]), strict=True):
        assert re.fullmatch(r"RBL[1-9]\d\d", lookup(item.code).code)
        assert item.message
        assert item.hint
        spans = [item.span, *(note.span for note in item.related)]
        spans += [edit.span for edit in (item.fix.edits if item.fix else ())]
        for span in spans:
            assert 0 <= span.start <= span.end <= len(text), (item, text)
        place = source.place(item.span.start)
        assert 1 <= place.line <= len(lines)
        assert 1 <= place.column <= lines[place.line - 1].end - lines[place.line - 1].start + 1, (item, text)
        said = to_json(item, source)
        region = {
            "line": shown.region.line,
            "column": shown.region.column,
            "end_line": shown.region.end_line,
            "end_column": shown.region.end_column,
        }
        assert {key: said[key] for key in region} == region
        assert (region["line"], region["column"]) == (place.line, place.column)
        assert render(item, source).startswith(f"p.rbl:{place.line}:{place.column}: {item.severity.value} {item.code} ")


@pytest.mark.parametrize("span", [Span(3, 99), Span(-1, 2), Span(5, 3)])
def test_a_finding_outside_its_text_is_noticed(span):
    with pytest.raises((AssertionError, IndexError, ValueError)):
        assert_located("MOVE P9\n", (Diagnostic(code="RBL301", message="no", span=span),))


# --- programs --------------------------------------------------------------------------------------------------------


@together("text", CATALOGUE)
def test_the_catalogue_is_located(text):
    assert_located(text, lint(Source("p.rbl", text), cell_with(points=POINTS)))


def some_lines(chance: random.Random) -> str:
    """A program of the catalogue, a few lines of a real one, or now and then the whole of it."""
    kind = chance.randrange(10)
    if kind < 4:
        return chance.choice([text for text in CATALOGUE if len(text) < 500])
    text = chance.choice(PROGRAMS)
    if kind == 9:
        return text
    lines = text.splitlines(keepends=True)
    first = chance.randrange(len(lines))
    return "".join(lines[first : first + chance.randrange(1, 9)])


def mutated(text: str, chance: random.Random) -> str:
    """The text after one to four changes: left out, put in, exchanged, doubled, torn off."""
    for _ in range(chance.randrange(1, 5)):
        at = chance.randrange(len(text) + 1)
        to = min(len(text), at + chance.choice((1, 1, 1, 2, 5, 30)))
        how = chance.randrange(6)
        if how == 0:
            text = text[:at] + text[to:]
        elif how == 1:
            text = text[:at] + chance.choice(INSERTED) + text[at:]
        elif how == 2:
            text = text[:at] + chance.choice(INSERTED) + text[to:]
        elif how == 3:
            text = text[:at] + text[at:to] * 2 + text[to:]
        elif how == 4:
            words = re.split(r"(\s+)", text)
            one, other = chance.randrange(len(words)), chance.randrange(len(words))
            words[one], words[other] = words[other], words[one]
            text = "".join(words)
        else:
            text = text[:at] if chance.randrange(4) == 0 else text[at:to] + text
    return text


@pytest.mark.parametrize("part", range(PARTS))
def test_mutants_of_programs_are_located(part):
    chance = random.Random(part)
    codes, damaged = set(), 0
    for _ in range(NUMBER // PARTS):
        text = mutated(some_lines(chance), chance)
        found = lint(Source("p.rbl", text), cell_with(points=POINTS))
        assert_located(text, found)
        codes |= {item.code for item in found}
        damaged += bool(found)
    assert damaged > NUMBER // PARTS * 0.8
    assert len(codes) > 30


# --- files beside them -----------------------------------------------------------------------------------------------


def assert_fault_is_located(fault: FileFault, text: str) -> None:
    lines = lines_of(text)
    assert lookup(fault.code).code.startswith(("RBL3", "RBL4", "RBL6", "RBL7"))
    assert 1 <= fault.line <= len(lines), (fault, text)
    assert 1 <= fault.column <= len(lines[fault.line - 1]) + 1, (fault, text)


@pytest.mark.parametrize(("paths", "load"), [(POINTS_FILES, load_points), (CELLS, load_cell)], ids=["points", "cells"])
def test_mutants_of_files_are_located(tmp_path, paths, load):
    chance = random.Random(1992)
    refused = 0
    path = tmp_path / "job.toml"
    for _ in range(FILES):
        text = mutated(chance.choice(paths).read_text("utf-8"), chance).replace("\r", "")
        path.write_text(text, "utf-8")
        try:
            load(path)
        except FileFault as fault:
            assert fault.path == str(path)
            assert_fault_is_located(fault, text.removeprefix("\ufeff"))
            refused += 1
    assert refused > FILES / 2
