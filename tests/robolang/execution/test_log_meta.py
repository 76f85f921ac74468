"""What a log says of its run: enough for a picture, nothing of the host, and the tool that was in use."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.execution import log_meta
from robolang.execution.result import RunResult
from robolang.execution.session import Session
from robolang.logs.files import read_log, write_log
from robolang.project.project import load_project
from runtime.appearance.cell_scene import scene_of
from runtime.cell.signals import InputSpec, Signals
from runtime.core.mesh import Mesh
from tests.robolang.cli.commands import BUILTIN

INPUTS = """
[inputs.1]
changes = [[0.05, 1], [0.2, 0]]
[inputs.2]
follows = 3
delay_s = 0.1
[inputs.4]
changes = [[0, 1], [1000, 0]]
"""


def carried_out(folder: Path, text: str, cell: str = "") -> RunResult:
    folder.mkdir(exist_ok=True)
    (folder / "p.rbl").write_text(text)
    if cell:
        (folder / "p.cell.toml").write_text((BUILTIN / "cell.toml").read_text() + cell)
        (folder / "p.points.toml").write_text((BUILTIN / "points.toml").read_text())
    return Session(load_project(folder / "p.rbl"), physics=False).run()


def rows(result: RunResult, kind: str) -> list[tuple]:
    assert result.log.events == sorted(result.log.events, key=lambda event: event["time_s"])
    return [(each["name"], each["time_s"], each["value"]) for each in result.log.events if each["kind"] == kind]


def test_inputs_outputs_and_the_hand_are_events(tmp_path):
    text = "OUT(3) = 1\nDELAY 0.08\nPULSE 5, 0.04\nHAND ON, 0.08\nOUT(3) = 0\nDELAY 0.24\nPULSE 6, 100\nDELAY 0.008\n"
    result = carried_out(tmp_path, text, INPUTS)
    assert rows(result, "output") == [
        ("3", 0.0, 1.0),
        ("5", 0.0, 0.0),
        ("6", 0.0, 0.0),
        ("5", 0.08, 1.0),
        ("5", 0.12, 0.0),
        ("3", 0.16, 0.0),
        ("6", 0.4, 1.0),  # its end is after the run
    ]
    assert rows(result, "input") == [
        ("1", 0.0, 0.0),
        ("2", 0.0, 0.0),
        ("4", 0.0, 1.0),
        ("1", 0.05, 1.0),
        ("2", 0.1, 1.0),
        ("1", 0.2, 0.0),
        ("2", 0.26, 0.0),
    ]
    assert rows(result, "hand") == [("hand", 0.08, 1.0)]


def test_a_forced_input_is_an_event():
    signals = Signals({1: InputSpec(changes=((0, 0.0), (20_000, 1.0), (60_000, 0.0)))})
    signals.force(1, 1.0, 10_000)
    signals.force(1, None, 30_000)
    signals.force(1, 0.0, 40_000)
    mark = signals.snapshot()
    signals.force(1, 1.0, 50_000)
    assert signals.input_changes(70_000) == {1: [(0, 0.0), (10_000, 1.0), (40_000, 0.0), (50_000, 1.0)]}
    signals.restore(mark)
    assert signals.forced == {1: 0.0}
    assert signals.input_changes(70_000) == {1: [(0, 0.0), (10_000, 1.0), (40_000, 0.0)]}
    signals.force(1, None, 45_000)
    assert signals.input_changes(70_000) == {1: [(0, 0.0), (10_000, 1.0), (40_000, 0.0), (45_000, 1.0), (60_000, 0.0)]}
    assert signals.input_changes(44_999)[1][-1] == (40_000, 0.0)


def test_the_log_says_what_the_run_was_of(tmp_path):
    result = carried_out(tmp_path, "10 MOVE P1 ' é </script>\n")
    write_log(tmp_path / "l.npz", result.log)
    read = read_log(tmp_path / "l.npz")
    assert read.meta == result.log.meta
    found = read.needed_meta()
    assert found["program"] == {"name": "p.rbl", "text": "10 MOVE P1 ' é </script>\n"}
    assert found["cell"]["text"].splitlines()[-1]
    assert set(found["points"]) == {"P1", "P2", "P3", "P4", "P5"}
    end = result.log["tool_cmd"][-1] * 1e3
    assert found["points"]["P1"]["p_mm"] == pytest.approx(end.tolist(), abs=0.01)
    assert [axis["name"] for axis in found["robot"]["axes"]] == ["J1", "J2", "J3", "J4", "J5", "J6"]
    assert [body["name"] for body in found["scene"]["bodies"]][-3:] != []
    assert {point["name"] for point in found["scene"]["points"]} == set(found["points"])
    assert (found["tick_s"], found["cycle_s"]) == (0.001, 0.008)
    assert found["home"] == pytest.approx(result.log["q_cmd"][0].tolist(), abs=1e-9)
    assert found["report"]["statements"] == result.report["statements"]


@pytest.mark.parametrize("text", ["10 MOVE P1\n20 PRINT 1 / (TIMER - TIMER)\n", "10 MOVE P1 + (0, 0, -1)\n20 STOP\n"])
def test_nothing_of_the_host_is_in_it(tmp_path, text):
    one, two = carried_out(tmp_path / "here", text), carried_out(tmp_path / "there", text)
    assert one.report["wall_time_s"] != two.report["wall_time_s"]
    assert one.log.meta == two.log.meta
    written = json.dumps(one.log.meta)
    assert all(word not in written for word in (str(tmp_path), "here/", "wall_time_s", "realtime_factor", "overruns"))
    assert one.log.meta["report"]["program"] == "p.rbl"
    assert [row["code"] for row in one.log.meta["report"]["alarms"]] == [row["code"] for row in one.report["alarms"]]


def test_what_was_found_before_the_run_is_in_it_without_folders(tmp_path):
    text = "MOVE P1\nx = 1\nDELAY 0.1\n"
    one, two = carried_out(tmp_path / "here", text), carried_out(tmp_path / "there", text)
    assert one.log.meta == two.log.meta
    (item,) = one.log.meta["findings"]
    place = ("RBL225", "warning", "p.rbl", 2, 1)
    assert tuple(item[key] for key in ("code", "severity", "file", "line", "column")) == place


def test_the_tool_in_use_counts_and_not_the_last_one(tmp_path):
    text = "10 MOVE P1\n20 TOOL POSE(0, 0, 200, 0, 0, 0)\n30 MOVE P2\n40 TOOL FLANGE\n50 MOVE P1 + (0, 0, 100)\n"
    result = carried_out(tmp_path, text)
    plain = carried_out(tmp_path, "10 MOVE P1\n")
    first, second = result.report["statements"][0], plain.report["statements"][0]
    assert {**first, "notes": []} == {**second, "notes": []}
    assert max(row["path_deviation_mm"] or 0.0 for row in result.report["statements"]) < 1.0
    log = result.log
    # each tool is where the program says: on the z axis of the flange, which the tools of this program share
    for number, mm in ((30, 200.0), (50, 0.0)):
        rows = np.flatnonzero(log["number"] == number)[16:]
        X = log["X_world_tool"][rows]
        flange = X[:, :3, 3] - X[:, :3, 2] * mm / 1e3
        assert np.abs(flange - log._chain.flange(log["q_link"][rows])[:, :3, 3]).max() < 1e-12
    assert log["tool_speed"].max() < 2.0  # a change of the tool is no jump
    write_log(tmp_path / "l.npz", log)
    assert read_log(tmp_path / "l.npz")["X_world_tool"].tobytes() == log["X_world_tool"].tobytes()


def test_parts_are_where_the_ideal_hand_carries_them(tmp_path):
    result = carried_out(tmp_path, "MOVE P1\nHAND ON\nMOVE P2\nHAND OFF\nMOVE P4\n")
    log = result.log
    part = log["parts"][:, 0].astype(np.float64)
    held = np.flatnonzero(log["line"][16 * np.arange(len(part))] == 3)[1:]
    X = log["X_world_tool"][16 * held]
    off = np.einsum("kij,ki->kj", X[:, :3, :3], part[held, :3] - X[:, :3, 3])
    assert np.ptp(part[held, :3], axis=0).max() > 0.05
    assert np.ptp(off, axis=0).max() < 1e-6
    assert np.abs(np.linalg.norm(part[:, 3:], axis=1) - 1.0).max() < 1e-6
    assert (part[:, 3] >= 0.0).all()
    assert log["fingers"][held].max() == 0.0
    assert part[-1, :3] == pytest.approx(np.array(result.report["objects"]["part"]["pose_mm_deg"][:3]) / 1e3, abs=1e-6)


def test_a_scene_that_no_reader_takes_costs_no_log(tmp_path, monkeypatch):
    empty = Mesh(vertices=np.zeros((1, 3)), faces=np.zeros((0, 3), dtype=np.int32))
    monkeypatch.setattr(log_meta, "scene_of", lambda *given: replace(scene_of(*given), meshes={"m": empty}))
    result = carried_out(tmp_path, "LOAD empty\nDELAY 0.1\n")
    assert result.log.needed_meta()["scene"] is None
    for name in ("l.npz", "l.mcap"):
        write_log(tmp_path / name, result.log)
        assert read_log(tmp_path / name).meta == result.log.meta
