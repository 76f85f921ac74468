"""docs/statements.md and the forms in docs/language.md are those of the declarations.

``python -m tests.arch.test_statements`` writes docs/statements.md anew.
"""

import re
from collections.abc import Iterable
from pathlib import Path

from robolang.syntax.declaration import Declaration, Operand, form
from robolang.syntax.keywords import INSTRUCTIONS, KEYWORDS
from robolang.syntax.statements import STATEMENTS

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "statements.md"
PREAMBLE = """\
# Statements

Every statement and every option of a move, with the ranges that `check` and `run` compare values with.
[language.md](language.md) explains them. What stands in brackets may be left out; `|` separates
choices. A statement that reads an input, the time or a pose lets motion end, too.

This page is generated: `python -m tests.arch.test_statements`.
"""
INDENTED = re.compile(r"^    (.*)$", re.MULTILINE)
WORD = re.compile(r"\b[A-Z]{2,}\b")


def limits_of(declared: Declaration) -> str:
    """The ranges of the operands, in the order of the text."""
    return "; ".join(filter(None, map(limit_of, declared.operands)))


def limit_of(operand: Operand) -> str:
    limit = operand.limit
    if limit is None:
        return f"{operand.shown}: {operand.unit}" if operand.unit and operand.unit != operand.shown else ""
    numbers = "whole numbers " if limit.whole else ""
    low = f"above {limit.low:g}, to" if limit.above else f"{limit.low:g} to"
    return f"{limit.name}: {numbers}{low} {limit.high:g} {limit.unit}".rstrip()


def row(declared: Declaration) -> str:
    options = " {, option}" if declared.options else ""
    cells = (
        f"`{form(declared._replace(options=()))}{options}`",
        declared.help,
        limits_of(declared),
        "yes" if declared.drains else "",
    )
    return " | ".join(cell.replace("|", "\\|") for cell in cells)


def table(rows: Iterable[Declaration]) -> str:
    lines = "".join(f"| {row(each)} |\n" for each in rows)
    return f"| form | meaning | range | motion ends before it |\n|---|---|---|---|\n{lines}"


def page() -> str:
    options = dict.fromkeys(option for each in STATEMENTS for option in each.options)
    return f"{PREAMBLE}\n{table(STATEMENTS)}\n## Options of moves\n\n{table(options)}"


def test_the_page_is_that_of_the_declarations():
    assert PAGE.read_text("utf-8") == page(), "run: python -m tests.arch.test_statements"


def test_the_forms_of_the_language_are_the_declared_ones():
    """In the indented forms every statement stands, and no keyword that none declares."""
    text = (DOCS / "language.md").read_text("utf-8")
    found = {word for line in INDENTED.findall(text) for word in WORD.findall(line)}
    assert found >= INSTRUCTIONS
    assert found <= KEYWORDS


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
