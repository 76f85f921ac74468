"""docs/rules says what the registry says; ``python -m robolang.lint.pages`` writes it anew."""

import subprocess
import sys
from pathlib import Path

from robolang.lint.pages import index, page, pages, write
from robolang.lint.registry import rules
from runtime.core.faults import lookup
from tests.steps import HANG_S
from tests.together import together

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "docs" / "rules"


def test_the_pages_are_current():
    there = {path.name: path.read_text("utf-8") for path in FOLDER.glob("*.md")}
    current = pages()
    assert sorted(there) == sorted(current), "run: python -m robolang.lint.pages"
    old = [name for name, text in current.items() if there[name] != text]
    assert old == [], "run: python -m robolang.lint.pages"


@together("code", list(rules()))
def test_a_page_has_every_part(code):
    text, known = page(code), rules()[code]
    headings = [line for line in text.splitlines() if line.startswith("#")]
    fix = ["## Fix"] if known.fix else []
    assert headings == [
        f"# {code} {lookup(code).name}",
        "## What it finds",
        "## Why it matters",
        "## Example",
        "## What to do",
        *fix,
    ]
    assert text.endswith("\n")
    assert known.why in text
    assert lookup(code).meaning in text
    assert lookup(code).remedy in text
    assert "\r" not in text
    assert text.isprintable() or all(character.isprintable() or character == "\n" for character in text)
    assert len(text) < 3000


def test_a_code_without_a_page_of_its_own_has_a_short_one():
    entry = lookup("RBL701")
    assert page("RBL701") == (
        f"# RBL701 file-missing\n\n## What it finds\n\n{entry.meaning}\n\n## What to do\n\n{entry.remedy}\n"
    )


def test_the_index_lists_every_page():
    rows = [line for line in index().splitlines() if line.startswith("| [RBL")]
    assert [row[3:9] for row in rows] == list(rules())
    assert "| [RBL103](RBL103.md) | suspicious-character | error | yes |" in rows


def test_writing_removes_the_pages_of_rules_that_are_gone(tmp_path):
    (tmp_path / "RBL199.md").write_text("old")
    (tmp_path / "notes.txt").write_text("kept")
    write(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*pages(), "notes.txt"])


def test_the_command_writes_the_folder_that_is_named(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "robolang.lint.pages", str(tmp_path / "made")],
        check=True,
        cwd=ROOT,
        timeout=HANG_S,
        capture_output=True,
    )
    assert done.stdout == b""
    assert (tmp_path / "made" / "README.md").read_text("utf-8") == index()
