"""Saves that a kill or a power failure cuts off (R09): each file is the old or the new one; a save that ended stays."""

import os
import random
import re
import signal
import warnings
from dataclasses import replace

import pytest

from robolang.project.points import load_points
from robolang.teaching import saving
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.teaching.program_document import insert_line
from tests.campaign import size
from tests.robolang.cli.commands import BUILTIN
from tests.robolang.teaching.crashes import NAIVE, recorded, states
from tests.robolang.teaching.desks import POINTS, PROGRAM, teach

SAVES = size(100, 12)
KILLS = size(2000, 40)
CELL = (BUILTIN / "cell.toml").read_text()
FILES = ("P.points.toml", "P.cell.toml", "P.rbl")


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "P.rbl"
    path.write_text(PROGRAM)
    return path


# --- power failures --------------------------------------------------------------------------------------------------


def contents(program):
    return {name: (program.with_name(name)).read_bytes() for name in FILES if program.with_name(name).exists()}


def edited(one, draw):
    """Change one to three of the files."""
    kinds = draw.sample(["points", "cell", "program"], draw.randint(1, 3))
    if "points" in kinds:
        for _ in range(draw.randint(1, 3)):
            teach(one, f"P{draw.randint(1, 99)}", tuple(draw.uniform(-900, 900) for _ in range(6)))
    if "cell" in kinds:
        cell = (one.documents.cell or CELL) + f"# {draw.random()}\n"
        one.change(replace(one.documents, cell=cell), "cell")
    if "program" in kinds:
        one.change(insert_line(one.documents, 1, f"' {draw.random()}")[0], "insert")


def judged(program, one):
    """Save, and return what is wrong in some state of the disk after a power failure."""
    before = contents(program)
    with recorded() as calls:
        one.save()
    after = contents(program)
    found = list(states(before, calls, FILES))
    allowed = [{before.get(name), after.get(name)} for name in FILES]
    wrong = []
    for number, each in enumerate(found):
        if any(text not in allowed[at] for state in each for at, text in enumerate(state)):
            wrong.append(("torn", number))
    if found[-1] != {tuple(after.get(name) for name in FILES)}:
        wrong.append(("not sure", len(found)))
    return wrong


def test_every_power_failure_leaves_the_old_files_or_the_new_ones(program):
    draw = random.Random(9)
    (program.with_suffix(".points.toml")).write_text(POINTS)
    one = Desk(load_documents(program))
    for _ in range(SAVES):
        edited(one, draw)
        assert judged(program, one) == []
        assert load_points(program.with_suffix(".points.toml")).names >= {"P1", "P2"}


@pytest.mark.parametrize(
    ("naive", "found"),
    [("in_place", {"torn", "not sure"}), ("unflushed", {"torn", "not sure"}), ("flushed_alone", {"not sure"})],
)
def test_the_model_of_power_failures_finds_naive_writers(program, monkeypatch, naive, found):
    monkeypatch.setattr(saving, "write_atomic", NAIVE[naive])
    one = Desk(load_documents(program))
    edited(one, random.Random(3))
    assert {kind for kind, _ in judged(program, one)} == found


# --- kills -----------------------------------------------------------------------------------------------------------


def version(number):
    """The texts of a version: a file that is a mixture of two of them has two numbers in it."""
    points = "".join(f"[points.Q{index}]\npose = [{number}, 0, 0, 0, 0, 0]\n" for index in range(60))
    cell = CELL + "".join(f"# version {number}\n" for _ in range(60))
    return {
        "points": f"schema = 1\n{points}",
        "cell": cell,
        "program": "".join(f"' version {number}\n" for _ in range(60)),
    }


def versions(path):
    """The numbers of the versions that are in a file; empty: it is cut off, too."""
    text = path.read_text()
    found = re.findall(r"^pose = \[(\d+), 0, 0, 0, 0, 0\]$|version (\d+)$", text, re.MULTILINE)
    return {int(a or b) for a, b in found} if len(found) == 60 and text.endswith("\n") else set()


def save_for_ever(program, channel):
    one = Desk(load_documents(program))
    for number in range(1, 10**6):
        one.change(replace(one.documents, **version(number)), "version")
        one.save()
        os.write(channel, b"%d\n" % number)


def killed(program, delay_s):
    """Save one version after the other in a process of its own until it is killed; return the last acknowledged one."""
    incoming, outgoing = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of other libraries; the child runs none of them
        child = os.fork()
    if not child:
        try:
            save_for_ever(program, outgoing)
        finally:
            os._exit(1)
    os.close(outgoing)
    first = os.read(incoming, 1)  # the process saves from here on
    signal.sigtimedwait([], delay_s)
    os.kill(child, signal.SIGKILL)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL
    with os.fdopen(incoming, "rb") as stream:
        lines = (first + stream.read()).split(b"\n")
    return int(lines[-2])  # what comes after the last line end is no whole line


def after_kills(program, count):
    """Yield the numbers in the three files after each kill, and the last version that was acknowledged."""
    draw = random.Random(11)
    for _ in range(count):
        for name, text in version(0).items():
            program.with_name({"points": FILES[0], "cell": FILES[1], "program": FILES[2]}[name]).write_text(text)
        last = killed(program, draw.uniform(0.0, 0.02))
        yield [versions(program.with_name(name)) for name in FILES], last


def is_whole(found, last):
    """Whether each file is one version, saved in their order, and none older than what was acknowledged."""
    if any(len(numbers) != 1 for numbers in found):
        return False
    points, cell, program = (numbers.pop() for numbers in found)
    return last + 1 >= points >= cell >= program >= last


def test_a_kill_leaves_whole_files_of_the_last_version_or_the_next(program):
    between = 0
    for found, last in after_kills(program, KILLS):
        between += found[0] != {last}
        assert is_whole(found, last)
    assert between  # some were killed within a save
    one = Desk(load_documents(program))
    one.change(replace(one.documents, **version(7)), "version")
    one.save()
    assert sorted(path.name for path in program.parent.iterdir()) == sorted(FILES)


def test_kills_find_a_naive_writer(program, monkeypatch):
    monkeypatch.setattr(saving, "write_atomic", NAIVE["in_place"])
    assert not all(is_whole(found, last) for found, last in after_kills(program, 200))
