"""R20: a program cannot read or write files, open sockets, start processes or run Python.

``watched`` runs it under an audit hook, which is told of each of these; every kind was seen to be noticed.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.syntax.formatter import format_source
from tests.campaign import some
from tests.robolang.cli import watched
from tests.robolang.cli.commands import ROOT
from tests.steps import HANG_S

PROGRAMS = [ROOT / "programs/shop" / f"{name}.rbl" for name in some(("palletise", "sort", "recover", "inspect"), 2)]
HOSTILE = """\
CONST greeting$ = "{0.__class__} %s $(id) `id` ../../etc/passwd file:///etc/passwd"
DIM a(3)
__import__ = 5
eval = __import__ + 1
PRINT greeting$; __import__; eval; LEN(greeting$)
text$ = "__import__('os').system('id')"
PRINT text$ + STR$(SQR(eval)); VAL("1E3"); ROUND(10 / 3, 3)
ON ERROR GOTO *BAD
x = VAL(text$)
text$ = text$ + "/etc/passwd"
x = VAL(text$)
a(eval + 3) = 1
x = 1 / (x * 0)
MOVE P1 + (0, 0, 9000)
ON ERROR STOP
FOR i = 1 TO 3
  CALL twice(i)
NEXT i
LOAD (0, 0, 60), 0.8
MOVE P1, SPEED 500
OUT(1) = 1
PULSE 2, 0.1
PRINT P1.X; HERE.Z; TIMER
END
*BAD
PRINT "caught "; ERR
x = 0
RESUME NEXT
SUB twice(n)
  PRINT n * 2
ENDSUB
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "job.rbl"
    path.write_text(HOSTILE)
    return path


def events(*words):
    return by_seed(*words)[""]


def by_seed(*words):
    """What a process of ``watched`` saw; without the byte code that Python keeps of modules it imports first."""
    done = subprocess.run(
        [sys.executable, "-B", "-m", "tests.robolang.cli.watched", *map(str, words)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=HANG_S,
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stderr.splitlines()[-1])
    return {seed: [tuple(event) for event in seen] for seed, seen in found.items()}


def test_a_program_that_tries_asks_python_for_nothing_and_what_is_promised_not_to_happen_is_noticed(program):
    kinds = {"os.open": "open", "eval": "compile", "socket.socket": "socket.__new__"}
    seen = by_seed(program, "", *watched.SEEDS)
    assert seen[""] == []
    for seed in watched.SEEDS:
        assert kinds.get(seed, seed) in {event for event, _ in seen[seed]}


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_programs_ask_python_for_nothing(path):
    assert events(path) == []


@pytest.mark.parametrize("words", [("check",), ("check", "--motion"), ("fmt", "--check")], ids=" ".join)
def test_a_check_writes_nothing_and_starts_nothing(program, words):
    """R26, as far as Python is asked; the import of numpy and the like asks for no process either."""
    program.write_text(format_source(Source("job.rbl", HOSTILE)).text)
    assert events("-", *words, program) == []


def test_a_whole_run_writes_its_log_and_its_report_and_nothing_else(program, tmp_path):
    log, report = tmp_path / "run.npz", tmp_path / "run.json"
    found = events("-", "run", "--no-physics", "--log", log, "--report", report, program)
    assert {path.parent for path in tmp_path.iterdir()} == {tmp_path}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["job.rbl", "run.json", "run.npz"]
    assert [event for event, _ in found if event not in ("write", "os.rename", "os.remove")] == []
    assert len([event for event, _ in found if event == "os.rename"]) == 2
    for event, name in found:
        assert Path(name).is_relative_to(tmp_path), (event, name)
