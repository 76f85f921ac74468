"""To add a lint rule, write one file: everything that knows of rules knows of it."""

import subprocess
import sys
from pathlib import Path

from tests.steps import HANG_S

ROOT = Path(__file__).parents[3]

RULE = """
from robolang.analysis.lint_rule import Check, LintRule
from robolang.syntax.ast import Hand
from runtime.core.faults import Code

NO_DWELL = LintRule(
    Code(
        code="RBL299",
        name="hand-without-dwell",
        meaning="A HAND has no waiting time.",
        remedy="Give the time that the hand needs to close.",
    ),
    why="The hand closes while the arm moves on already, and the part is lost on the first metre.",
    bad="10 HAND ON\\n",
    good="10 HAND ON, 0.5\\n",
)


def find(facts):
    for node in facts.statements:
        if isinstance(node, Hand) and node.dwell is None:
            yield NO_DWELL.at(node.span, "this HAND does not wait")


CHECK = Check(find, NO_DWELL, beside_errors=True)
"""
USE = """
import sys
import robolang.analysis.rules

robolang.analysis.rules.__path__.append(sys.argv[1])
from typer.testing import CliRunner
from robolang.cli.main import app
from robolang.lint.pages import pages

for words in (["check", "p.rbl"], ["check", "--ignore", "hand-without-dwell", "p.rbl"], ["rules"], ["explain", "299"]):
    print(f"--- {words[0]}")
    print(CliRunner().invoke(app, words).output)
print("--- page")
print(pages()["RBL299.md"])
"""


def test_a_file_in_the_folder_of_rules_is_a_rule(tmp_path):
    folder = tmp_path / "more"
    folder.mkdir()
    (folder / "dwells.py").write_text(RULE)
    (tmp_path / "p.rbl").write_text("10 HAND ON\n20 HAND OFF ' noqa: RBL299\n30 HAND ON, 1 ' noqa: RBL299\n40 MOV P1\n")
    done = subprocess.run(
        [sys.executable, "-c", USE, str(folder)],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "COLUMNS": "200"},
        capture_output=True,
        text=True,
        timeout=HANG_S,
        check=True,
    )
    first, ignored, table, explained, page = done.stdout.split("--- ")[1:]
    found = [line for line in first.splitlines() if line.startswith("p.rbl")]
    assert [line.split(" ")[:3] for line in found] == [
        ["p.rbl:1:4:", "warning", "RBL299"],
        ["p.rbl:4:4:", "error", "RBL112"],
    ]
    assert "RBL299" not in ignored
    assert "hand-without-dwell" in table
    assert "Give the time that the hand needs to close." in explained
    assert "10 HAND ON, 0.5" in explained
    assert page.startswith("page\n# RBL299 hand-without-dwell\n\nwarning")
