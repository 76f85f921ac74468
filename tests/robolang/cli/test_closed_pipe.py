"""A reader that closes its pipe, as ``| head`` does, changes neither the exit code of a command nor its files."""

import os
import subprocess
import sys

import pytest

from tests.campaign import some
from tests.robolang.cli.commands import ROOT
from tests.steps import HANG_S

STOPPED = "2 LOAD (0, 0, 60), 0.8\n3 X = 0\n4 MOVE P1\n5 IF X = 0 THEN PRINT 1 / X\n"
WRONG = "MOV P1\nMOVE P9\n"
ONLY_SHOWN = ["-c", "from robolang.cli.console import Console; Console(stderr=True).print(1)"]


def left(folder, *words, closed):
    """The exit code of a process whose streams ``closed`` nobody reads; another stream goes nowhere."""
    read, write = os.pipe()
    os.close(read)
    stdout, stderr = (write if name in closed else subprocess.DEVNULL for name in ("stdout", "stderr"))
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, *words]
    try:
        return subprocess.run(command, cwd=folder, env=env, timeout=HANG_S, stdout=stdout, stderr=stderr).returncode
    finally:
        os.close(write)


CLOSED = [("stdout",), ("stderr",), ("stdout", "stderr")]


@pytest.mark.parametrize("closed", some(CLOSED, 0, 2), ids="+".join)
@pytest.mark.parametrize(
    ("text", "words", "code", "files"),
    [
        (STOPPED, "run --no-physics --report r.json --log l.npz p.rbl", 3, {"r.json", "l.npz"}),
        (STOPPED, "compare --no-physics --only scheduled p.rbl", 3, set()),
        (WRONG, "check p.rbl --output-file out.txt", 1, {"out.txt"}),
        (WRONG, "check p.rbl nothing.rbl", 2, set()),
        (WRONG, "fmt p.rbl", 2, set()),
    ],
    ids=["run", "compare", "check", "check-missing", "fmt"],
)
def test_it_changes_no_exit_code_and_no_file(tmp_path, closed, text, words, code, files):
    (tmp_path / "p.rbl").write_text(text)
    assert left(tmp_path, "-m", "robolang", *words.split(), closed=closed) == code
    assert {path.name for path in tmp_path.iterdir()} == {"p.rbl", *files}


def test_a_table_for_a_reader_that_has_left_is_dropped(tmp_path):
    assert left(tmp_path, *ONLY_SHOWN, closed=("stderr",)) == 0
