"""The sessions of docs/pendant.md are played, from the first to the last, in one empty folder.

``python -m tests.robolang.pendant.test_page`` writes the page anew with what the prompt shows now.
"""

import io
import os
import re
import shlex
import tempfile
from pathlib import Path

from robolang.pendant.assembly import COMMANDS
from robolang.pendant.choice import Choice
from robolang.pendant.output import PlainOutput
from robolang.pendant.pendant import Pendant
from robolang.pendant.script import play
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from tests.robolang.pendant.prompting import Requests

PAGE = Path(__file__).parents[3] / "docs" / "pendant.md"
_BLOCK = re.compile(r"(?<=```text\n)(\$ robolang repl[^\n]*\n)(.*?)(?=```\n)", re.DOTALL)


def shown(command: str, block: str) -> str:
    """Return what the prompt shows for the lines of a block that begin with ``> ``."""
    words = shlex.split(command)[3:]
    files = [Path(word) for word in words if not word.startswith("--")]
    stream = io.StringIO()
    pendant = Pendant(
        Desk(load_documents(files[0] if files else None, None)),
        Choice(physics="--no-physics" not in words),
        PlainOutput(stream, stream),
        commands=COMMANDS,
        interrupts=Requests(),
        scripted=True,
    )
    lines = [line.removeprefix("> ") for line in block.splitlines() if line.startswith("> ")]
    play(lines, pendant, keep_going=True)
    return stream.getvalue()


def played_page(page: str) -> str:
    """Return the page with every session played."""
    return _BLOCK.sub(lambda found: found[1] + shown(found[1], found[2]), page)


def test_the_sessions_of_the_page_show_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = PAGE.read_text("utf-8")
    assert len(_BLOCK.findall(page)) >= 4
    assert played_page(page) == page, "run: python -m tests.robolang.pendant.test_page"


def main() -> None:
    page = PAGE.read_text("utf-8")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        played = played_page(page)
    PAGE.write_text(played, "utf-8")


if __name__ == "__main__":
    main()
