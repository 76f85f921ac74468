"""Every number of a live frame is that of the log at its time."""

import struct
from pathlib import Path

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.view.frames import Frames, layout

TOOLS = """LOAD (0, 0, 60), 0.8
MOVE P2
TOOL POSE(0, 0, 250, 0, 0, 0)
DELAY 0.05
MOVEJ P2 + (0, 0, -100)
"""


class Kept:
    """Takes what pages would get."""

    def __init__(self):
        self.frames = []

    def show_frame(self, frame):
        self.frames.append(frame)

    def show_status(self, text):
        pass

    def show_notes(self, notes):
        pass

    def begin(self, row):
        pass

    def say(self, text):
        pass


def shown(program, physics, monkeypatch):
    """The frames of a run, one a cycle: their ticks (K,), numbers by name (K, count); and the log."""
    monkeypatch.setattr("robolang.view.frames.FRAME_S", -1.0)
    kept = Kept()
    frames = Frames(kept)
    session = Session(load_project(program), physics=physics, observer=frames)
    frames.follow(session)
    log = session.run().log
    names = layout(session.controller)
    rows = np.array([np.frombuffer(frame[8:], "<f4") for frame in kept.frames])
    columns = np.split(rows, np.cumsum([count for _, count in names])[:-1], axis=1)
    ticks = [round(struct.unpack("<d", frame[:8])[0] * 1e3) for frame in kept.frames]
    return np.array(ticks), {name: values for (name, _), values in zip(names, columns, strict=True)}, log


def assert_frames_are_of_the_log(ticks, found, log):
    assert len(ticks) > 100
    for name in ("q_link", "q_cmd", "tau_sat"):
        np.testing.assert_allclose(found[name][1:], log[name][ticks[1:]], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(found["tool"], log["X_world_tool"][ticks, :3, 3], atol=1e-6)
    np.testing.assert_allclose(found["tool_error"][:, 0], log["tool_error"][ticks], atol=1e-7)
    assert 0.9 * log["tool_speed"].max() < found["tool_speed"].max() <= 1.001 * log["tool_speed"].max()


@pytest.mark.physics
def test_a_frame_has_the_numbers_of_the_log_at_its_time(monkeypatch):
    assert_frames_are_of_the_log(*shown("programs/pick_and_place.rbl", True, monkeypatch))


def test_another_tool_is_elsewhere_and_has_no_speed(tmp_path, monkeypatch):
    for beside in Path("programs").glob("pick_and_place.*.toml"):
        (tmp_path / beside.name).write_bytes(beside.read_bytes())
    program = tmp_path / "pick_and_place.rbl"
    program.write_text(TOOLS, "utf-8")
    ticks, found, log = shown(program, False, monkeypatch)
    assert len(log.rows.tools) == 2
    assert_frames_are_of_the_log(ticks, found, log)
