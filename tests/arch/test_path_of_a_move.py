"""The page of docs/architecture.md on a LOAD and a MOVE names functions that a run calls, in the order of the calls.

The program on the page is run by the command line under a profile function, which notes every function of the project
when it is called for the first time.
"""

import inspect
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from types import CodeType, FrameType

import pytest

from tests.robolang.cli.commands import robolang

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "architecture.md"
NAME = re.compile(r"`((?:robolang|runtime)(?:\.\w+)+)`")
ROW = re.compile(r"^\| (\d+) \| `([\w.]+)` \|", re.MULTILINE)
BOX = re.compile(r"\| (\d+) \w")

MARK = "functions called:"

pytestmark = pytest.mark.physics


def section(title: str) -> str:
    return PAGE.read_text("utf-8").partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def named(code: CodeType) -> str | None:
    """Return the dotted name of a function of the project; None for other code, class bodies among it."""
    path = Path(code.co_filename)
    if not code.co_flags & inspect.CO_OPTIMIZED or not path.is_relative_to(ROOT):
        return None
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join((*parts, code.co_qualname)) if parts[0] in ("robolang", "runtime") else None


@pytest.fixture(scope="module")
def called(tmp_path_factory) -> tuple[str, ...]:
    """Functions in the order of their first calls, in a run of the program on the page."""
    folder = tmp_path_factory.mktemp("path")
    program = folder / "path.rbl"
    (text,) = re.findall(r"^```rbl\n(.*?)^```$", section("A LOAD and a MOVE, from text to torque"), re.M | re.S)
    program.write_text(text, "utf-8")
    # a process of its own: what another test has read and kept would not be called again here
    command = [sys.executable, "-m", "tests.arch.test_path_of_a_move", str(program), str(folder / "log.npz")]
    found = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return tuple(found.stderr.partition(MARK)[2].split())


def traced(program: str, log: str) -> tuple[str, ...]:
    """Run a program by the command line; return the functions of the project in the order of their first calls."""
    seen: dict[CodeType, None] = {}

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            seen.setdefault(frame.f_code)

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        robolang("run", "--log", log, program)
    finally:
        sys.setprofile(before)
    return tuple(name for name in map(named, seen) if name is not None)


def untrue(text: str, called: tuple[str, ...]) -> list[str]:
    """Return what a page claims and the run did not do."""
    place = {name: at for at, name in reversed([*enumerate(called)])}
    wrong = [f"{name} is not called" for name in NAME.findall(text) if name not in place]
    rows = [name for _, name in ROW.findall(text) if name in place]
    wrong += [f"{b} is called before {a}" for a, b in pairwise(rows) if not place[a] < place[b]]
    return wrong


def test_the_page_is_the_path_of_the_run(called):
    text = section("A LOAD and a MOVE, from text to torque")
    rows = ROW.findall(text)
    assert len(rows) > 40
    assert [int(number) for number, _ in rows] == [*range(1, len(rows) + 1)]
    assert untrue(text, called) == []


def test_a_name_that_is_not_on_the_path_is_noticed(called):
    elsewhere = "runtime.motion.joint_planner.JointPlanner.plan"
    assert untrue(f"| 1 | `{elsewhere}` | plans |", called) == [f"{elsewhere} is not called"]


def test_two_rows_that_are_swapped_are_noticed(called):
    rows = [row for row in section("A LOAD and a MOVE, from text to torque").splitlines() if ROW.match(row)]
    for at in range(len(rows) - 1):
        swapped = "\n".join([*rows[:at], rows[at + 1], rows[at], *rows[at + 2 :]])
        assert untrue(swapped, called), rows[at]


def test_the_picture_has_at_most_16_boxes():
    boxes = [int(number) for number in BOX.findall(section("Picture"))]
    assert sorted(boxes) == [*range(1, len(boxes) + 1)]
    assert 10 <= len(boxes) <= 16


if __name__ == "__main__":
    sys.stderr.write(f"{MARK} {' '.join(traced(*sys.argv[1:]))}\n")
