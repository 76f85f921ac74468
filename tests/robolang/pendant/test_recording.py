"""``record``: what was done at the prompt as a program that does it again."""

import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.pendant import recording
from robolang.pendant.failure import Failure
from robolang.project.discovery import own_cell
from robolang.project.project import load_project
from tests.campaign import some
from tests.programs.runs import some_programs
from tests.robolang.cli.commands import ROOT, robolang
from tests.robolang.pendant.prompting import Requests, prompt
from tests.robolang.pendant.recordings import PICK, assert_same_log, done_again, statements, tolerant
from tests.steps import HANG_S

PROGRAMS = some_programs("recover", "tend", "seam")
"""Errors that are handled; signals and pulses; a sensor. Subroutines, frames and parts are in ``MIXED``."""
SHOP = ROOT / "programs" / "shop"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80"}


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_is_done_again_to_the_byte(program):
    prompted = prompt(program)
    prompted.do("record again.rbl", "run")
    assert_same_log(done_again(prompted, "again.rbl"))


@pytest.mark.physics
def test_a_program_is_done_again_with_physics():
    prompted = prompt(PICK, physics=True)
    prompted.do("record again.rbl", "auto", "MOVE P2, SPEED 150", "MOVE P5", "run")
    assert_same_log(done_again(prompted, "again.rbl", physics=True))


MIXED = {
    PICK: ["MOVE P4, SPEED 150, ACCEL 50", "SPEED 80", "MOVE P1 + (0, 0, 40), TIME 3", "x = HERE.Z - 20", "DEPART 10"],
    SHOP / "palletise.rbl": ["FRAME pallet", "MOVE CORNER + (0, 0, 150), ZONE 20", "FRAME POSE(0, 0, 50, 0, 0, 30)"],
    SHOP / "tend.rbl": ["OUT(3) = 0.5", "PULSE 4, 0.25", "APPROACH CHUCK, 100", "DELAY 0.123", "LOAD part"],
}


STOPPED = [(program, stop) for program in MIXED for stop in (60, 140, 230)]


@pytest.mark.parametrize(("program", "stop"), some(STOPPED, 3, 8), ids=lambda value: getattr(value, "stem", None))
def test_statements_steps_and_stops_within_a_program_are_done_again(program, stop, folder):
    prompted = prompt(tolerant(program, folder), interrupts=Requests(stop=stop))
    prompted.do("record again", "auto", "run")
    live = prompted.pendant.live
    assert live.executor.status.state.value == "paused"
    for line in MIXED[program]:
        live.go_on(lambda _: True)
        prompted.do(line)
    prompted.do("home", "run", "HAND OFF, 0.1")
    done_again(prompted, "again.rbl")


def test_the_values_stand_in_the_statements():
    prompted = prompt(PICK)
    prompted.do("record done", "auto")
    prompted.do(
        "v = 200",
        "SPEED v",
        "SPEEDJ 40",
        "OVERRIDE 50",
        "WRIST HOLD TILT, ADVANCE",
        "MOVE (P1 + (1, 2, 300)) * (0, 0, 5, 0, 0, 10) + (0, 0, 1E-3)",
        "FRAME POSE(10, 0, 0, 0, 0, 90)",
        "p = POSE(-20, -450, 700, 180, 0, 180)",
        "FRAME WORLD",
        "MOVE p + (5, 0, 0), TIME 2, WRIST KEEP",
        "OVERRIDE 100",
        "MOVEJ JOINT(0, 80, -180, 0, -70, 0), ACCEL 30",
        "TOOL POSE(0, 0, 50, 0, 0, 0)",
        "LOAD (0, 0, 60), 0.8, (0.001, 0.001, 0.001, 0, 0, 0)",
        "LOAD empty",
        "TOOL FLANGE",
        "HAND ON",
        "HAND OFF, 0.1",
        "OUT(2) = v / 8",
        "v",
        'PRINT "seen"',
        "PAUSE",
        "MOVE POSE(480, -200, 840, 180, 0, 180), SPEED 212.5, ACCEL 12.5",
        "MOVEC POSE(460, -180, 840, 180, 0, 180), POSE(480, -160, 840, 180, 0, 180)",
        "SPLINE (POSE(460, -180, 840, 180, 0, 180), P1 + (0, 0, 400), POSE(480, -200, 840, 180, 0, 180)), ACCEL 50",
        "DEPART 3",
    )
    found = statements("done.rbl")
    # an offset of the world, in the axes of the frame of its pose
    turned = re.fullmatch(r"MOVE POSE\(-20, -450, 700, 180, 0, 180\) \+ \((\S+), -5, 0\), TIME 2, WRIST KEEP", found[4])
    assert turned is not None
    assert abs(float(turned[1])) < 1e-12
    assert found == [
        "WRIST HOLD TILT, ADVANCE",
        "OVERRIDE 50",
        "MOVE (P1 + (1, 2, 300)) * (0, 0, 5, 0, 0, 10) + (0, 0, 0.001), SPEED 200",
        "FRAME POSE(10, 0, 0, 0, 0, 90)",
        found[4],
        "OVERRIDE 100",
        "MOVEJ JOINT(0, 80, -180, 0, -70, 0), SPEED 40, ACCEL 30",
        "TOOL POSE(0, 0, 50, 0, 0, 0)",
        "LOAD (0, 0, 60), 0.8, (0.001, 0.001, 0.001, 0, 0, 0)",
        "LOAD empty",
        "TOOL FLANGE",
        "HAND ON, 0.3",
        "HAND OFF, 0.1",
        "OUT(2) = 25",
        "PAUSE",
        "FRAME WORLD",
        "MOVE POSE(480, -200, 840, 180, 0, 180), SPEED 212.5, ACCEL 12.5",
        "MOVEC POSE(460, -180, 840, 180, 0, 180), POSE(480, -160, 840, 180, 0, 180), SPEED 200",
        "SPLINE (POSE(460, -180, 840, 180, 0, 180), P1 + (0, 0, 400), POSE(480, -200, 840, 180, 0, 180)), SPEED 200, "
        "ACCEL 50",
        "DEPART 3, SPEED 200",
    ]
    assert_same_log(done_again(prompted, "done.rbl"))


def test_each_line_says_where_it_comes_from():
    prompted = prompt(PICK, interrupts=Requests(stop=40))
    prompted.do("record done", "auto", "run", "x = 3", "OUT(x) = 1")
    lines = Path("done.rbl").read_text().splitlines()
    assert [line.split("  ' ")[1] for line in lines if "  ' " in line] == [
        "line 4 (number 10)",
        "line 5 (number 20): HAND OFF",
        "line 6 (number 30): MOVE P1",
        "prompt: OUT(x) = 1",
    ]
    assert str(PICK) in lines[2]


def test_a_statement_in_the_middle_of_a_wait_divides_it(folder):
    (folder / "a.rbl").write_text("DELAY 1\nHAND ON, 0.8\nMOVE P2\n")
    prompted = prompt(folder / "a.rbl", interrupts=Requests(stop=50))
    prompted.do("record done", "auto", "run", "OUT(1) = 1", "HAND OFF, 0.16")
    live = prompted.pendant.live
    live.go_on(seconds=0.8)
    prompted.do("LOAD (0, 0, 60), 0.8", "run")
    first = float(statements("done.rbl")[0].removeprefix("DELAY "))
    found = statements("done.rbl")
    assert found[1:3] == ["OUT(1) = 1", "HAND OFF, 0.16"]
    assert float(found[3].removeprefix("DELAY ")) == pytest.approx(1.0 - first)
    hand = float(found[4].removeprefix("HAND ON, "))
    assert found[5] == "LOAD (0, 0, 60), 0.8"
    assert float(found[6].removeprefix("DELAY ")) == pytest.approx(0.8 - hand)
    assert found[7:] == ["MOVE P2"]
    assert_same_log(done_again(prompted, "done.rbl"))


ARC = "MOVEC P2 + (0, 0, 40), P2 + (0, 80, 0), SPEED 100"
CURVE = "SPLINE (P2 + (0, 0, 40), P2 + (0, 60, 20), P2 + (0, 80, 0)), SPEED 100"


@pytest.mark.parametrize("line", ["MOVE P2, TIME 4", "MOVEJ P2, SPEED 20", "DEPART 90, SPEED 60", ARC, CURVE])
def test_a_move_that_was_left_and_regained_is_done_again(folder, line):
    (folder / "a.rbl").write_text(f"MOVE P2 - OFFSET\n{line}\nMOVE P4\n".replace(" - OFFSET", " + (0, -60, 0)"))
    prompted = prompt(folder / "a.rbl")
    prompted.do("record done", "auto")
    live = prompted.pendant.live
    live.go_on(lambda statement: statement.line == 2)
    live.go_on(seconds=0.24 if line.startswith("MOVEJ") else 0.72)
    prompted.do("MOVEJ HERE * (0, 0, -5)")
    assert live.executor.regain()
    live.drive()
    prompted.do("run")
    log, again = done_again(prompted, "done.rbl")
    found = statements("done.rbl")
    assert len(found) == 6
    assert "JOINT(" in found[1]
    # the tool takes the same path, an arc and a spline too
    if line in (ARC, CURVE):
        there = again["X_world_tool"][:, :3, 3]
        for p in log["X_world_tool"][::50, :3, 3]:
            assert np.linalg.norm(there - p, axis=1).min() < 1e-3


def test_what_stops_short_ends_where_the_arm_came_to_rest():
    prompted = prompt(PICK, interrupts=Requests(halt=90))
    prompted.do("record done", "auto")
    with pytest.raises(Failure):
        prompted.do("run")
    prompted.pendant.interrupts = prompted.pendant.live._interrupts = Requests()
    prompted.do("reset", "MOVE P4")
    found = statements("done.rbl")
    assert found[2].startswith("MOVE JOINT(")
    assert found[3:] == ["MOVE P4"]
    # the brakes have left the arm a little beyond the last command: it goes on from there
    start = [run.first_tick for run in prompted.pendant.live.session.record.statements][-1]
    again = Session(load_project("done.rbl"), physics=False)
    result = again.run()
    expected = prompted.pendant.live.session.result(0.0).log["q_plan"]
    assert np.abs(result.log["q_plan"][again.record.statements[-1].first_tick - 1] - expected[start]).max() < 1e-9
    assert np.abs(result.log["q_plan"][-1] - expected[-1]).max() < 1e-9


def test_a_move_that_rests_on_its_path_ends_there():
    prompted = prompt(PICK, interrupts=Requests(stop=70))
    prompted.do("record done", "auto", "run")
    assert statements("done.rbl")[2].startswith("MOVE JOINT(")
    result = Session(load_project("done.rbl"), physics=False).run()
    assert np.abs(result.log["q_plan"][-1] - prompted.pendant.live.q).max() < 1e-9


def test_what_is_taken_back_is_taken_out():
    prompted = prompt(PICK)
    timeline = prompted.pendant.live.timeline
    prompted.do("record done", "auto", "OUT(1) = 1", "MOVE P2", "LOAD empty", "OUT(2) = 1")
    timeline.back(3)
    prompted.do("OUT(3) = 1")
    assert statements("done.rbl") == ["OUT(1) = 1", "OUT(3) = 1"]
    prompted.do("run")
    timeline.back(2)
    prompted.do("")
    assert statements("done.rbl")[-1] == "LOAD (0, 0, 60), 0.8"
    timeline.back()
    prompted.do("run")
    assert_same_log(done_again(prompted, "done.rbl"))


def test_again_begins_anew_and_a_recording_that_ended_is_left():
    prompted = prompt(PICK)
    prompted.do("auto", "MOVE P2", "record done")
    assert statements("done.rbl") == ["MOVE P2"]
    assert prompted.do("record").startswith("done.rbl: 1 lines")
    prompted.do("MOVE P4")
    assert statements("done.rbl") == ["MOVE P2"]
    prompted.do("record done", "again")
    assert statements("done.rbl") == []
    robolang("check", "done.rbl")
    assert prompted.do("record", "record").endswith("nothing is recorded; record FILE begins\n")


def test_points_stand_beside_it_as_they_were():
    prompted = prompt(PICK)
    prompted.do("record done", "auto", "MOVE P2", "MOVE P4")
    record = prompted.pendant.live.session.record
    first, second = record.statements
    other = second.points[0].replaced(pose=(480.0, 220.0, 800.123456789, 180.0, 0.0, -90.0))
    taught = second.points[0].replaced(name="p2", pose=first.points[0].pose, comment="")
    for point in (other, taught, other.replaced(name="P2")):
        effect = replace(second.effect, target=second.effect.target.replaced(point=point.name.upper()))
        record.statements.append(replace(second, effect=effect, points=(point,)))
    prompted.do("")
    assert statements("done.rbl") == ["MOVE P2", "MOVE P4", "MOVE P4_2", "MOVE P2", "MOVE P2_2"]
    points = load_project("done.rbl").points
    assert [*points.points] == ["P2", "P4", "P4_2", "P2_2"]
    assert points.get("P4_2").pose == other.pose
    assert points.get("P2").replaced(name="") == first.points[0].replaced(name="")
    assert points.robot == "puma560"


@pytest.mark.parametrize("where", ["own", "folder", "built-in", "built-in beside another"])
def test_the_cell_stands_beside_it_where_it_is_not_found_anyway(folder, where):
    text = (PICK.with_name("pick_and_place.cell.toml")).read_text().replace("dwell_s = 0.3", "dwell_s = 0.4")
    program = folder / "a.rbl"
    program.write_text("HAND OFF\n")
    if where == "own":
        own_cell(program).write_text(text)
    elif where == "folder":
        (folder / "cell.toml").write_text(text)
    elif where == "built-in beside another":
        (folder / "sub").mkdir()
        (folder / "sub" / "cell.toml").write_text(text)
    path = folder / ("sub" if where == "built-in beside another" else ".") / "done.rbl"
    prompted = prompt(program)
    prompted.do(f"record {path}", "auto", "run", "MOVE POSE(480, 0, 840, 180, 0, -135)")
    assert own_cell(path).exists() == (where not in ("folder", "built-in"))
    assert load_project(path).cell.hand.dwell == (0.3 if where.startswith("built-in") else 0.4)
    assert_same_log(done_again(prompted, str(path)))


@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("a", {}),
        ("a.rbl", {}),
        ("link", {"link.rbl": None}),
        ("other", {"other.rbl": "MOVE P1\n"}),
        ("other", {"other.points.toml": "schema = 1\n"}),
        ("other", {"other.cell.toml": "schema = 1\n"}),
        ("nowhere/other", {}),
        ("folder", {"folder.rbl": ""}),
    ],
)
def test_what_would_be_lost_is_refused_at_the_start(folder, name, files):
    (folder / "a.rbl").write_text("MOVE P1\n")
    for file, text in files.items():
        if text is None:
            (folder / file).symlink_to(folder / "a.rbl")
        elif not text:
            (folder / file).mkdir()
        else:
            (folder / file).write_text(text)
    before = _contents(folder)
    with pytest.raises(Failure) as caught:
        prompt(folder / "a.rbl").do(f"record {name}")
    assert caught.value.codes == ("RBL706",)
    assert _contents(folder) == before
    assert "RBL706" in robolang("repl", "--record", name, "a.rbl", typed="MOVE P1\n", code=4).stderr
    assert _contents(folder) == before


def _contents(folder: Path) -> dict[str, str | None]:
    return {path.name: None if path.is_dir() else path.read_text() for path in folder.iterdir()}


def test_a_cell_whose_robot_stays_behind_is_refused(folder):
    (folder / "sub").mkdir()
    (folder / "a.rbl").write_text("DELAY 1\n")
    (folder / "arm.toml").write_text((ROOT / "runtime" / "robot" / "library" / "puma560.toml").read_text())
    cell = PICK.with_name("pick_and_place.cell.toml").read_text()
    (folder / "a.cell.toml").write_text(cell.replace('robot = "puma560"', 'robot = "arm.toml"'))
    with pytest.raises(Failure) as caught:
        prompt(folder / "a.rbl").do("record sub/done")
    assert caught.value.codes == ("RBL600",)
    assert list((folder / "sub").iterdir()) == []
    prompt(folder / "a.rbl").do("record done", "run")
    robolang("run", "--no-physics", "--quiet", "done.rbl")


def test_a_recording_that_is_opened_is_not_written_any_more():
    prompted = prompt(PICK)
    prompted.do("record done", "auto", "MOVE P2")
    text = Path("done.rbl").read_text()
    with pytest.raises(Failure) as caught:
        prompted.do("open done.rbl")
    assert caught.value.codes == ("RBL706",)
    prompted.do("DELAY 0.1")
    assert Path("done.rbl").read_text() == text


def test_a_recording_that_is_too_large_keeps_what_it_had(monkeypatch):
    prompted = prompt(PICK)
    prompted.do("record done", "auto", "MOVE P2")
    text = Path("done.rbl").read_text()
    monkeypatch.setattr(recording, "MAX_BYTES", len(text))
    with pytest.raises(Failure) as caught:
        prompted.do("MOVE P4")
    assert caught.value.codes == ("RBL810",)
    assert Path("done.rbl").read_text() == text
    prompted.do("MOVE P2")


def test_a_line_that_fails_is_recorded_as_far_as_it_came_and_both_errors_are_shown(folder):
    (folder / "a.rbl").write_text("FOR i = 0 TO 1\nMOVE P2 + (0, 0, i * 5000)\nNEXT\n")
    prompted = prompt(folder / "a.rbl")
    prompted.do("record done", "auto")
    with pytest.raises(Failure):
        prompted.do("run")
    assert statements("done.rbl") == ["MOVE P2 + (0, 0, 0)"]
    prompted.pendant.recording._written.clear()
    Path("done.rbl").unlink()
    Path("done.rbl").mkdir()
    with pytest.raises(Failure) as caught:
        prompted.do("MOVE P1")  # the alarm is latched
    assert caught.value.codes == ("RBL804",)
    assert "RBL706" in prompted.problems.getvalue()


def test_a_terminal_that_is_lost_in_motion_loses_nothing(folder):
    script = "auto\nMOVE P2\nOUT(1) = 1\nDELAY 600\nOUT(2) = 1\n"
    command = [sys.executable, "-m", "robolang", "repl", "--no-physics", "--realtime", "--record", "done", str(PICK)]
    process = subprocess.Popen(
        command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=_environment()
    )
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write(script)
    process.stdin.flush()
    for line in process.stdout:
        if line.startswith("> DELAY"):
            break
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=HANG_S)
    found = statements("done.rbl")
    assert found[:2] == ["MOVE P2", "OUT(1) = 1"]
    assert "OUT(2) = 1" not in found
