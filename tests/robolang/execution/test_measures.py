"""The report of a run whose rows are dropped is that of the whole log, to the bit; and a log that cannot be kept."""

import errno
import os
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robolang.execution import measures
from robolang.execution.session import Session
from robolang.project.project import load_project
from runtime.control import blocks, recorder
from runtime.control.spill import Spill
from runtime.core.faults import Fault
from runtime.core.units import DEG, MM, PERCENT
from runtime.servo.motor import torque_limit
from tests.messages import fields
from tests.programs.runs import some_programs
from tests.robolang.cli.commands import dry

PROGRAMS = some_programs("palletise", "recover", "seam")
OF_THE_HOST = ("wall_time_s", "realtime_factor", "overruns")


@pytest.fixture
def small_blocks(monkeypatch):
    """Blocks of 16 cycles, so that short statements lie in several of them."""
    blocks._columns.cache_clear()
    monkeypatch.setattr(blocks, "BLOCK_CYCLES", 16)
    monkeypatch.setattr(recorder, "BLOCK_CYCLES", 16)
    yield
    blocks._columns.cache_clear()


def carried_out(path: Path, log: Path | bool = True) -> tuple[Session, Any]:
    session = Session(load_project(path), physics=False, log=log)
    return session, session.run()


def plain(report: dict) -> dict:
    return {key: value for key, value in report.items() if key not in OF_THE_HOST}


def largest(values) -> float | None:
    return float(values.max()) if len(values) else None


def measured(session: Session, log) -> list[tuple]:
    """Measure each statement in the arrays of the whole log."""
    X, seam = log["X_world_tool"][:, :3, 3], log["seam_deviation"]
    joint = np.abs(log["q_cmd"] - log["q_link"]).max(axis=1) / DEG
    tool = np.linalg.norm(log["tool_cmd"] - X, axis=1) / MM
    torque = np.abs(log["tau_sat"] / torque_limit(session.controller.spec)).max(axis=1) / PERCENT
    rows = []
    for run in session.record.statements:
        span = slice(run.first_tick, run.end_tick)
        moved = run.begun and run.path is not None and run.end_tick > run.first_tick
        off = _off_paths(run, (X - seam[:, :3])[span]) if moved else None
        values = (largest(joint[span]), largest(tool[span]), off, largest(torque[span]))
        rows.append(values if run.begun else (None,) * 4)
    return rows


def _off_paths(run, points) -> float:
    """Return how far a tool is off the path of a move and those beside it, mm: here none is shorter than the lag."""
    parts = [] if run.speeds is None else run.speeds.chain.parts[max(run.at - 1, 0) : run.at + 2]
    paths = [run.path, *(part.path for part in parts if part.path is not None)]
    return np.min([path.deviation(points) for path in paths], axis=0).max() / MM


def test_moves_that_are_shorter_than_the_lag_of_the_tool_are_measured_on_their_row(tmp_path):
    program = tmp_path / "row.rbl"
    row = "SPEED 150\nA = HERE\nFOR i = 1 TO 40\nMOVE A + (0, i, 0), ZONE 0.4\nNEXT\n"
    program.write_text("MOVEJ JOINT(0, 60, -190, 0, -20, 0)\n" + row)
    rows = Session(load_project(program), physics=False).run().report["statements"]
    rows = [row for row in rows if row["path_deviation_mm"] is not None]
    assert len(rows) > 30  # a move of less than a cycle may get no row
    # the command is on the row, three moves after the plan: so the tool is not further from it than from the command
    assert all(row["path_deviation_mm"] <= row["tool_error_mm"] + 1e-3 for row in rows)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_the_report_without_a_log_is_that_of_the_whole(small_blocks, path):
    session, whole = carried_out(path)
    _, dropped = carried_out(path, log=False)
    assert len(whole.log["t"]) > 3 * 128
    assert plain(dropped.report) == plain(whole.report)
    keys = ("joint_error_deg", "tool_error_mm", "path_deviation_mm", "peak_torque_pct")
    found = [tuple(row[key] for key in keys) for row in dropped.report["statements"]]
    assert found == measured(session, whole.log)


def test_a_number_that_is_none_is_the_largest():
    one, nan = np.array([1.0, 2.0]), np.array([np.nan, 0.5])
    assert measures._larger(measures._larger(None, one), one / 2) == 2.0
    for pieces in ((one, nan), (nan, one), (nan, nan)):
        assert np.isnan(measures._larger(measures._larger(None, pieces[0]), pieces[1]))


def test_a_first_statement_that_takes_many_blocks_is_measured_whole(small_blocks, tmp_path):
    path = tmp_path / "p.rbl"
    path.write_text("MOVE P1, SPEED 20\nMOVE P2\n")
    _, whole = carried_out(path)
    _, dropped = carried_out(path, log=False)
    assert dropped.report["statements"] == whole.report["statements"]
    assert whole.report["statements"][0]["start_s"] == 0.0
    assert whole.report["statements"][0]["duration_s"] > 2.0


def test_a_run_without_a_log_has_no_signals(tmp_path):
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    _, result = carried_out(tmp_path / "p.rbl", log=False)
    assert result.log.meta["program"] == {"name": "p.rbl", "text": "MOVE P1\n"}
    for asked in (partial(result.log.__getitem__, "t"), partial(result.log.__getitem__, "parts")):
        with pytest.raises(Fault) as caught:
            asked()
        assert caught.value.code == "RBL822"


def test_a_log_that_cannot_be_kept_stops_the_arm_on_its_path(small_blocks, tmp_path):
    path = tmp_path / "p.rbl"
    path.write_text("10 MOVE P1\n20 MOVE P2, SPEED 50\n")
    session, result = carried_out(path, log=tmp_path / "gone")
    (alarm,) = result.report["alarms"]
    assert (alarm["code"], alarm["category"], alarm["line"], alarm["number"]) == ("RBL706", 1, 1, 10)
    # with the third block the first one would have been written
    assert alarm["time_s"] == pytest.approx((2 * 16 + 1) * 0.008)
    assert os.strerror(errno.ENOENT) in alarm["message"]
    log = result.log
    assert len(log["t"]) == session.controller.recorder.tick > 1000 * alarm["time_s"]
    assert all(np.isfinite(values).all() for values in log.values())
    assert np.abs(log["dq_cmd"][-1]).max() < 0.01  # it came to rest under servo


def test_a_full_disk_ends_the_command_with_its_code(small_blocks, tmp_path, monkeypatch):
    def full(spill, data):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Spill, "put", full)
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    result = dry(tmp_path / "p.rbl", "--quiet", "--log", tmp_path / "l.npz", code=4)
    assert {"RBL706", "--log"} <= fields(result.stderr) and "--html" not in result.stderr
    assert sorted(os.listdir(tmp_path)) == ["l.npz", "p.rbl"]  # whole, up to where the arm stands
    result = dry(tmp_path / "p.rbl", "--quiet", "--html", tmp_path / "l.html", code=4)
    assert {"RBL706", "--html"} <= fields(result.stderr) and "--log" not in result.stderr
    dry(tmp_path / "p.rbl", "--quiet", code=0)
