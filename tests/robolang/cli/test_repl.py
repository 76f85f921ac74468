"""``robolang repl`` as a process: exit codes of scripts, streams, what is written."""

import os
import signal
import subprocess
import sys
from functools import partial
from subprocess import CompletedProcess

import pytest

from tests.ready import Piped
from tests.robolang.cli.commands import ROOT, shell
from tests.steps import HANG_S

PICK = ROOT / "programs" / "pick_and_place.rbl"


def repl(lines, *words, cwd):
    """Exit code, results and problems of a script."""
    process = Piped(["repl", "--no-physics", *words], cwd=cwd, typed="\n".join(lines) + "\n")
    return CompletedProcess(words, process.wait(), *process.communicate())


@pytest.mark.parametrize(
    "lines, code",
    [
        (["1 + 2", "quit"], 0),
        (["MOVE P99"], 1),
        (["teach P7"], 1),
        (["tech P7"], 1),
        (["pos 3"], 2),
        (["help nowhere"], 2),
        (["MOVE P1 + (0, 0, 9000)"], 3),
        (["x = 0", "y = 1 / x"], 3),
        (["run", "run"], 3),
        (["10 MOVE P1", "save as nowhere/mine"], 4),
    ],
)
def test_a_script_ends_with_the_exit_codes_of_run(tmp_path, lines, code):
    result = repl(lines, cwd=tmp_path)
    assert result.returncode == code, result.stdout + result.stderr
    assert "Traceback" not in result.stderr


def test_a_file_that_cannot_be_used_is_reported_at_the_start(tmp_path):
    assert repl(["pos"], "nowhere.rbl", cwd=tmp_path).returncode == 2
    assert repl(["pos"], "--robot", "nobody", cwd=tmp_path).returncode == 2
    (tmp_path / "bad.cell.toml").write_text("schema = 1\nrobot = 3\n")
    assert repl(["pos"], "--cell", "bad.cell.toml", cwd=tmp_path).returncode == 2


def test_results_go_to_stdout_and_problems_to_stderr(tmp_path):
    result = repl(["1 + 2", "MOVE P99", "3 + 4"], "--keep-going", str(PICK), cwd=tmp_path)
    assert result.stdout.splitlines() == ["> 1 + 2", "3", "> MOVE P99", "> 3 + 4", "7"]
    assert "RBL301" in result.stderr
    assert result.returncode == 1


def test_a_text_that_is_not_utf8_is_an_error_with_its_place(tmp_path):
    result = shell("repl", cwd=tmp_path, input=b'PRINT "\xff\xfe"\n', text=False)
    assert result.returncode in (1, 2)
    assert b"Traceback" not in result.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_a_script_on_its_path_and_ends_it(tmp_path, number):
    command = [sys.executable, "-m", "robolang", "repl", "--no-physics", "--realtime"]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        env=env,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # tests that run in the background of a shell ignore Ctrl-C, and so would what they start
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    process.stdin.write("PRINT 1\nDELAY 3000\nPRINT 2\n")
    process.stdin.flush()
    for line in process.stdout:
        if line.startswith("> DELAY"):
            break
    process.send_signal(number)
    results, problems = process.communicate(timeout=HANG_S)
    assert process.returncode == 128 + number, problems
    assert "2" not in results and "Traceback" not in problems
