"""Ctrl-C and SIGTERM in a paced run: exit code 130 or 143, report and log complete, within the move."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

from robolang.cli.main import app
from robolang.logs import files
from runtime.control.controller import Controller
from tests.robolang.cli.commands import ROOT, robolang
from tests.steps import HANG_S


def start(folder, *words):
    """Start a paced run of 60 s and return it once its move has been announced, a few cycles into the run."""
    (folder / "p.rbl").write_text("10 DELAY 0.1\n20 MOVE P1, TIME 60\n")
    process = subprocess.Popen(
        [sys.executable, "-m", "robolang", "run", "--no-physics", "--realtime", "p.rbl", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    while "MOVE P1" not in (line := process.stderr.readline()):
        assert line, "the run ended too soon"
    return process


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_the_first_signal_ends_the_run_with_complete_files(tmp_path, number, code):
    log = "l.npz" if number == signal.SIGINT else "l.mcap"
    process = start(tmp_path, "--report", "r.json", "--log", log)
    process.send_signal(number)
    _, stderr = process.communicate(timeout=HANG_S)
    assert process.returncode == code
    assert "p.rbl:2:4: error RBL530" in stderr
    report = json.loads((tmp_path / "r.json").read_text())
    assert [(alarm["code"], alarm["line"], alarm["number"]) for alarm in report["alarms"]] == [("RBL530", 2, 20)]
    assert report["ok"] is False
    assert 0.1 <= report["sim_time_s"] < 60.0  # before the move has ended
    assert report["alarms"][0]["category"] == 1
    assert 0.0 < report["sim_time_s"] - report["alarms"][0]["time_s"] < 1.5  # the controlled stop is in the log
    if log == "l.npz":
        ticks = len(np.load(tmp_path / log)["t"])
    else:
        with (tmp_path / log).open("rb") as stream:
            reader = make_reader(stream, validate_crcs=True)
            ticks = sum(1 for _ in reader.iter_messages(topics=["/controller"]))
    assert ticks == report["cycles"] * 8
    assert sorted(path.name for path in tmp_path.iterdir()) == [log, "p.rbl", "r.json"]


def test_a_signal_while_the_files_are_written_does_not_cut_them_off(tmp_path, monkeypatch):
    """In this process: SIGINT and SIGTERM arrive while the bytes of the log go out."""
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    write_npz = files._WRITERS[".npz"]
    for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):

        def interrupted(stream, signals, number=number):
            os.kill(os.getpid(), number)
            write_npz(stream, signals)

        monkeypatch.setitem(files._WRITERS, ".npz", interrupted)
        words = ["--report", tmp_path / "r.json", "--log", tmp_path / "l.npz"]
        robolang("run", "--no-physics", tmp_path / "p.rbl", *words, code=code)
        assert len(np.load(tmp_path / "l.npz")["t"]) > 700
        assert json.loads((tmp_path / "r.json").read_text())["ok"] is True
        assert sorted(path.name for path in tmp_path.iterdir()) == ["l.npz", "p.rbl", "r.json"]


def test_the_second_signal_ends_the_run_in_motion_with_complete_files(tmp_path, monkeypatch):
    """In this process: both signals arrive in one cycle, so the arm is stopped at once and not on its path."""
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    cycle, seen = Controller.cycle, []

    def interrupted(controller):
        seen.append(1)
        if len(seen) == 40:
            os.kill(os.getpid(), signal.SIGINT)
            os.kill(os.getpid(), signal.SIGINT)
        return cycle(controller)

    monkeypatch.setattr(Controller, "cycle", interrupted)
    words = ["--report", tmp_path / "r.json", "--log", tmp_path / "l.npz"]
    robolang("run", "--no-physics", tmp_path / "p.rbl", *words, code=130)
    with np.load(tmp_path / "l.npz") as log:
        assert len(log["t"]) == 40 * 8
        assert np.abs(log["dq_cmd"][-1]).max() > 0.05
    assert json.loads((tmp_path / "r.json").read_text())["alarms"][0]["code"] == "RBL530"


def test_the_second_signal_leaves_at_once_and_leaves_no_half_file(tmp_path, monkeypatch):
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    (tmp_path / "l.npz").write_text("old")

    def interrupted(stream, signals):
        stream.write(b"half")
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
        raise AssertionError("not reached")

    monkeypatch.setitem(files._WRITERS, ".npz", interrupted)
    robolang("run", "--no-physics", tmp_path / "p.rbl", "--log", tmp_path / "l.npz", code=143)
    assert (tmp_path / "l.npz").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["l.npz", "p.rbl"]


def test_the_handlers_of_the_caller_are_put_back(tmp_path):
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    robolang("run", "--no-physics", "--quiet", tmp_path / "p.rbl")
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_while_the_motion_is_checked_says_that_nothing_has_moved(tmp_path, monkeypatch, number, code):
    program = tmp_path / "p.rbl"
    program.write_text("MOVE P1\n")
    monkeypatch.setattr("robolang.execution.dry_run.rehearse", lambda *_, **__: os.kill(os.getpid(), number) or ())
    handlers = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
    found = CliRunner().invoke(app, ["run", "--no-physics", str(program), "--report", str(tmp_path / "r.json")])
    assert found.exit_code == code
    assert signal.Signals(number).name in found.output
    assert not (tmp_path / "r.json").exists()
    assert [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)] == handlers
