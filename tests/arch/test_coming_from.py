"""docs/coming-from/: its tables are those of ``robolang.syntax.foreign``, and the job passes ``check --motion``.

``python -m tests.arch.test_coming_from`` writes the tables anew.
"""

import re
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.syntax.foreign.entry import INFORM, KAREL, KRL, MELFA, RAPID, TP, UR, Entry
from robolang.syntax.foreign.shapes import SHAPES
from robolang.syntax.foreign.words import every, own
from robolang.syntax.foreign_lines import proposal
from robolang.syntax.parser import parse
from tests.robolang.cli.commands import robolang

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "coming-from"
PAGES = {
    "kuka-krl.md": (KRL,),
    "abb-rapid.md": (RAPID,),
    "fanuc-tp.md": (TP, KAREL),
    "universal-robots-urscript.md": (UR,),
    "yaskawa-inform.md": (INFORM,),
    "mitsubishi-melfa.md": (MELFA,),
}
"""The pages, and the languages of each."""
BEGIN = "<!-- generated: python -m tests.arch.test_coming_from -->\n"
END = "<!-- end of what is generated -->\n"
GENERATED = re.compile(f"{re.escape(BEGIN)}.*?{re.escape(END)}", re.DOTALL)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def code(statements: str) -> str:
    """Statements, one a line, as code in a cell of a table."""
    return "<br>".join(f"`{each}`" for each in statements.splitlines())


def row(entry: Entry) -> str:
    written = code(entry.write) or ("" if entry.missing else "remove it")
    none = "there is none" if entry.missing else ""
    write = ", nearest: ".join(filter(None, (none, written)))
    words = " ".join(f"`{word}`" for word in entry.words.split())
    return f"| {words} | {entry.means} | {'; '.join(filter(None, (write, entry.note)))} |"


def tables(languages: tuple[str, ...]) -> str:
    """The lines, the words and the words of this language that mean something else, of some languages."""
    here = [shape for shape in SHAPES if set(languages) & set(shape.languages)]
    mine = {entry for entries in own().values() for entry in entries}
    of = [entry for entry in every() if set(languages) & set(entry.languages)]
    lines = [line(shape.example) for shape in here]
    parts = (
        "### Lines\n\n| there | here |\n|---|---|",
        *lines,
        "\n### Words\n\n| word | there it | here |\n|---|---|---|",
        *(row(entry) for entry in of if entry not in mine),
        "\n### The same word, with another meaning\n\n| word | there it | here |\n|---|---|---|",
        *(row(entry) for entry in of if entry in mine),
    )
    return "\n".join(parts) + "\n"


def line(example: str) -> str:
    found = proposal(example)
    assert found is not None
    write = code("\n".join(found.statements)) or "remove it"
    return f"| `{example}` | {'; '.join(filter(None, (write, found.note)))} |"


def current(name: str) -> str:
    """A page with the tables of today."""
    text = (FOLDER / name).read_text("utf-8")
    return GENERATED.sub(lambda _: f"{BEGIN}\n{tables(PAGES[name])}\n{END}", text)


def blocks(name: str, language: str) -> list[str]:
    return [text for kind, text in FENCE.findall((FOLDER / name).read_text("utf-8")) if kind == language]


@pytest.mark.parametrize("name", PAGES)
def test_the_tables_are_current(name):
    assert len(GENERATED.findall((FOLDER / name).read_text("utf-8"))) == 1
    assert (FOLDER / name).read_text("utf-8") == current(name), "run: python -m tests.arch.test_coming_from"


def test_every_page_is_listed_and_has_the_same_job():
    assert {path.name for path in FOLDER.glob("*.md")} == {"README.md", *PAGES}
    listed = re.findall(r"\]\(([\w-]+\.md)\)", (FOLDER / "README.md").read_text("utf-8"))
    assert sorted(set(listed)) == sorted(PAGES)
    (job,) = blocks("README.md", "rbl")
    for name in PAGES:
        assert blocks(name, "rbl") == [job], name
        assert len(blocks(name, "text")) == 1, name


def test_the_job_passes_check_with_motion(tmp_path):
    (job,), (inputs,) = blocks("README.md", "rbl"), blocks("README.md", "toml")
    (tmp_path / "job.rbl").write_text(job)
    demo = ROOT / "programs" / "pick_and_place"
    (tmp_path / "job.cell.toml").write_text(demo.with_suffix(".cell.toml").read_text("utf-8") + inputs)
    (tmp_path / "job.points.toml").write_text(demo.with_suffix(".points.toml").read_text("utf-8"))
    robolang("check", "--motion", "--strict", "--ignore", "point-unused", tmp_path / "job.rbl", code=0)


@pytest.mark.parametrize("name", PAGES)
def test_lines_of_the_job_that_are_typed_here_have_their_statements(name):
    """Each line alone, since errors of structure are those of a whole program."""
    (job,) = blocks(name, "text")
    found = [item for line in job.splitlines() for item in parse(Source("job.rbl", f"{line.strip()}\n")).diagnostics]
    without = [item.message for item in found if not re.search(r"\b(write|remove)\b", item.hint)]
    assert len(found) >= 15
    assert without == []


if __name__ == "__main__":
    for page in PAGES:
        (FOLDER / page).write_text(current(page), "utf-8")
