import json

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.view.pace import Pace
from tests.robolang.execution.standing import log_of
from tests.robolang.view.driving import CYCLE_S, INPUT, PROGRAM, Bench

WAITS = 'WAIT IN(1) = 1\nPRINT "seen"\nPULSE 2, 0.5\n'
ALIVE_TURNS = round(0.2 / CYCLE_S)


@pytest.fixture
def bench(tmp_path, monkeypatch):
    return Bench(tmp_path, monkeypatch, PROGRAM)


# --- a run that pages follow -----------------------------------------------------------------------------------------


def log_of_run(path, physics):
    session = Session(load_project(path), physics=physics)
    session.run()
    return log_of(session)


@pytest.mark.parametrize("physics", [False, pytest.param(True, marks=pytest.mark.physics)])
def test_a_run_that_is_driven_is_the_run_to_the_byte(tmp_path, monkeypatch, physics):
    bench = Bench(tmp_path, monkeypatch, PROGRAM, by_hand=False, physics=physics)
    bench.driver.run_through()
    assert log_of(bench.session) == log_of_run(bench.path, physics)
    assert bench.facts.state == "done"


def test_a_pause_of_a_page_stops_time_and_changes_no_path(tmp_path, monkeypatch):
    bench = Bench(tmp_path, monkeypatch, "MOVEJ HERE + (0, 0, 20)\nMOVE HERE + (0, 0, 60)\n", by_hand=False)
    plain = Session(load_project(bench.path), physics=False)
    plain.run()
    bench.driver.begin()
    bench.turns(60)
    assert bench.do("pause") is None
    at = bench.session.executor.time_us
    bench.turns(20)
    assert (bench.facts.state, bench.session.executor.time_us) == ("paused", at)
    assert bench.do("start") is None
    assert bench.facts.state == "done"
    assert np.abs(bench.q - plain.controller.areas.ina).max() < 1e-12


def test_a_run_that_is_followed_is_not_moved_by_hand(tmp_path, monkeypatch):
    bench = Bench(tmp_path, monkeypatch, PROGRAM, by_hand=False)
    bench.driver.begin()
    bench.turns(50)
    assert bench.do("pause") is None
    before = bench.q
    for number in (
        bench.jog(),
        bench.send("teach", name="P1", kind=None, replace=False),
        bench.send("restart"),
        bench.send("end"),
    ):
        bench.turns(3)
        assert bench.answer(number)["code"] == "RBL836"
    assert (bench.q == before).all()


# --- commands --------------------------------------------------------------------------------------------------------


def test_it_stands_before_the_first_statement_until_it_is_started(bench):
    bench.turns(50)
    assert (bench.facts.state, bench.facts.next, bench.session.executor.time_us) == ("paused", 1, 0)
    assert bench.do("start") is None
    assert (bench.facts.state, bench.facts.over, bench.facts.outputs) == ("done", True, [[1, 1.0]])


def test_a_step_is_one_statement(bench):
    lines = []
    for _ in range(4):
        assert bench.do("step") is None
        lines.append(bench.facts.next)
    assert lines == [2, 3, 4, 5]


def test_start_while_it_runs_and_after_its_end_is_refused(bench):
    bench.send("start")
    bench.turns(10)
    number = bench.send("start")
    bench.turn()
    assert bench.answer(number)["code"] == "RBL836"
    bench.rest()
    assert bench.do("start") == "RBL806"
    assert bench.do("restart") is None
    assert (bench.facts.state, bench.facts.next) == ("paused", 1)


def test_a_stop_ends_the_program_and_it_begins_again_after_a_reset(bench):
    bench.send("start")
    bench.turns(40)
    assert bench.do("stop") is None
    assert (bench.facts.state, bench.facts.alarm["code"]) == ("stopped", "RBL530")
    assert bench.do("start") == "RBL804"
    number = bench.jog()
    bench.turns(3)
    assert bench.answer(number)["code"] == "RBL804"
    assert bench.do("reset") is None
    assert bench.facts.alarm is None
    assert bench.do("start") is None
    assert bench.facts.state == "done"


def test_what_was_ordered_before_a_pause_moves_nothing_after_it(bench):
    before = bench.q
    start, jog, pause = bench.send("start"), bench.jog(), bench.send("pause")
    bench.turns(50)
    assert [bench.answer(number).get("code") for number in (start, jog, pause)] == ["RBL836", "RBL836", None]
    assert (bench.q == before).all()


def test_an_override_holds_for_the_moves_that_begin_then(bench):
    assert bench.do("override", percent=20) is None
    assert bench.do("start") is None
    slow = bench.session.executor.time_us
    assert bench.facts.override == 20.0
    assert bench.do("restart") is None
    assert bench.do("override", percent=100) is None
    assert bench.do("start") is None
    assert bench.session.executor.time_us - slow < 0.8 * slow


def test_an_input_is_held_and_given_back(tmp_path, monkeypatch):
    bench = Bench(tmp_path, monkeypatch, WAITS, cell=INPUT)
    bench.send("start")
    bench.turns(50)
    assert (bench.facts.state, bench.facts.inputs) == ("waiting", [[1, 0.0, False]])
    number = bench.send("input", number=1, state=1)
    bench.turns(3)
    assert "code" not in bench.answer(number)
    assert bench.facts.inputs == [[1, 1.0, True]]
    bench.rest()
    assert bench.facts.state == "done"
    assert any('"seen"' in text for text in bench.page.said)
    assert bench.do("input", number=1, state=None) is None
    assert bench.facts.inputs == [[1, 0.0, False]]
    assert bench.do("input", number=2, state=1) == "RBL534"


def test_an_alarm_is_shown_with_its_line(tmp_path, monkeypatch):
    bench = Bench(tmp_path, monkeypatch, "PRINT 1\nMOVE POSE(9000, 0, 500, 180, 0, 180)\n")
    assert bench.do("start") is None
    assert bench.facts.state == "alarm"
    assert bench.facts.alarm["line"] == 2


def test_a_run_keeps_its_own_pace(bench):
    assert bench.do("pace", factor=2) == "RBL836"


def test_it_is_left_at_rest(bench):
    bench.send("start")
    bench.turns(40)
    bench.driver.leave()
    bench.driver.work()
    assert bench.facts.state == "paused"
    assert not bench.session.controller.moving


def test_a_page_ends_it_at_rest(bench):
    bench.send("start")
    bench.turns(40)
    number = bench.send("end")
    bench.driver.work()
    assert bench.answer(number)["ok"]
    assert bench.facts.state == "paused"


# --- jogs ------------------------------------------------------------------------------------------------------------


def test_a_jog_goes_on_while_it_is_held_and_stops_after_its_release(bench):
    start, number = bench.q[0], bench.jog("J1", speed=100)
    bench.turns(100, alive=number)
    moved = bench.q[0]
    assert moved > start + 0.05
    assert (bench.facts.doing, bench.facts.mode) == ("jog", "MANUAL")
    bench.send("release", jog=number)
    took = bench.rest()
    assert took < 40
    assert bench.q[0] > moved
    rests = bench.q
    bench.turns(50, alive=number)
    assert (bench.q == rests).all()


def test_a_jog_without_signs_stops_after_the_dead_man(bench):
    number = bench.jog("J1")
    bench.turns(60, alive=number)
    began = bench.session.executor.time_us
    bench.rest()
    braking = 40
    assert bench.session.executor.time_us - began < (ALIVE_TURNS + braking) * CYCLE_S * 1e6
    bench.send("alive", jog=number)
    rests = bench.q
    bench.turns(30, alive=number)
    assert (bench.q == rests).all()


@pytest.mark.parametrize(("factor", "share"), [(20.0, 1.0), (1.0, 1.0), (0.5, 0.5)])
def test_a_jog_is_no_faster_than_the_time_of_its_dead_man(tmp_path, monkeypatch, factor, share):
    bench = Bench(tmp_path, monkeypatch, PROGRAM, pace=Pace(factor))

    def sleep(seconds):
        bench.now += seconds

    monkeypatch.setattr("robolang.view.pace.wall_s", lambda: bench.now)
    monkeypatch.setattr("robolang.view.pace.time.sleep", sleep)
    number = bench.jog("J1")
    for _ in range(100):
        bench.send("alive", jog=number)
        bench.driver.turn()
    assert bench.facts.doing == "jog"
    simulated = bench.session.executor.time_us * 1e-6
    assert simulated == pytest.approx((bench.now - 1000.0) * share, rel=0.05)
    # the program keeps its own pace
    bench.send("release", jog=number)
    while bench.facts.doing != "nothing":
        bench.driver.turn()
    began, at = bench.now, bench.session.executor.time_us
    bench.send("restart")
    bench.send("start")
    for _ in range(100):
        bench.driver.turn()
    assert bench.facts.doing == "program"
    simulated = (bench.session.executor.time_us - at) * 1e-6
    assert simulated == pytest.approx((bench.now - began) * factor, rel=0.05)


def test_late_signs_do_not_revive_a_jog(bench):
    number = bench.jog("J1")
    bench.turns(40, alive=number)
    bench.now += 0.25
    bench.send("alive", jog=number)
    assert bench.rest(alive=number) < 40


def test_a_jog_stops_when_its_page_goes_or_another_comes(bench):
    number = bench.jog("J1")
    bench.turns(40, alive=number)
    bench.exchange.join()
    assert bench.rest(alive=number) < 40
    number = bench.jog("J1")
    bench.turns(40, alive=number)
    assert bench.facts.doing == "jog"
    bench.exchange.leave(bench.page)
    assert bench.rest() < 40


def test_a_press_that_was_released_moves_nothing(bench):
    before = bench.q
    number = bench.jog("X")
    bench.send("release", jog=number)
    bench.turns(20)
    assert bench.answer(number)["code"] == "RBL836"
    assert (bench.q == before).all()


def test_a_press_that_expires_before_its_turn_moves_nothing(bench):
    before = bench.q
    number = bench.jog("X")
    bench.now += 0.3
    bench.turns(20)
    assert bench.answer(number)["code"] == "RBL836"
    assert (bench.q == before).all()


@pytest.mark.parametrize("sign", [1, -1])
def test_a_step_is_of_its_size_while_signs_come(bench, sign):
    before = bench.session.controller.tool_poses(bench.q)[2, 3]
    number = bench.jog("Z", sign=sign, step=10)
    bench.rest(alive=number)
    moved = bench.session.controller.tool_poses(bench.q)[2, 3] - before
    assert moved == pytest.approx(0.01 * sign, abs=1e-7)


def test_a_step_without_signs_is_stopped_too(bench):
    before = bench.q
    bench.jog("J1", step=90, speed=10)
    bench.rest()
    assert 0.0 < bench.q[0] - before[0] < np.deg2rad(30)


def test_a_jog_in_the_tool_frame_goes_along_the_tool(bench):
    tool = bench.session.controller.tool_poses(bench.q)
    number = bench.jog("X", frame="tool", step=5)
    bench.rest(alive=number)
    moved = bench.session.controller.tool_poses(bench.q)[:3, 3] - tool[:3, 3]
    assert moved == pytest.approx(0.005 * tool[:3, 0], abs=1e-7)


@pytest.mark.parametrize(
    ("fields", "code"),
    [({"axis": "J7"}, "RBL720"), ({"axis": "J7", "step": 1}, "RBL720"), ({"axis": "RX", "step": 9000}, "RBL404")],
)
def test_a_jog_that_the_arm_cannot_make_is_refused(bench, fields, code):
    before = bench.q
    number = bench.jog(**fields)
    bench.turns(10, alive=number)
    assert bench.answer(number)["code"] == code
    assert (bench.q == before).all()


def test_no_jog_while_the_program_runs(bench):
    bench.send("start")
    bench.turns(40)
    number = bench.jog("J1")
    bench.turns(5, alive=number)
    assert bench.answer(number)["code"] == "RBL836"
    assert bench.facts.doing == "program"


# --- remarks ---------------------------------------------------------------------------------------------------------


def test_after_a_stop_and_a_reset_the_line_is_known_at_which_it_goes_on(bench):
    bench.send("start")
    bench.turns(90)
    line = bench.facts.next
    assert line == 3
    assert bench.do("stop") is None
    assert bench.facts.can_continue is False
    assert bench.do("reset") is None
    assert (bench.facts.over, bench.facts.can_continue, bench.facts.next) == (True, True, line)
    number = bench.jog("Z", step=5)
    bench.rest(alive=number)
    assert (bench.facts.can_continue, bench.facts.next) == (True, line)
    assert bench.do("restart") is None
    assert (bench.facts.can_continue, bench.facts.next) == (False, 1)


@pytest.mark.parametrize(
    ("axis", "step", "said"),
    [
        ("Z", 10, " of 10 mm: the page"),
        ("J1", 5, " of 5 deg: the page"),
        ("RZ", 5, " of 5 deg"),
        ("X", None, " mm: the"),
    ],
)
def test_a_jog_whose_page_is_too_slow_says_how_far_it_went(bench, axis, step, said):
    number = bench.jog(axis, step=step)
    bench.turns(60, alive=number)
    # a sign comes too late, and revives nothing
    bench.now += 0.5
    bench.rest(alive=number)
    assert said in bench.facts.remark
    bench.send("override", percent=50)
    bench.turns(2)
    assert bench.facts.remark is None


def test_a_jog_that_was_released_or_has_come_to_its_end_says_nothing(bench):
    number = bench.jog("X")
    bench.turns(60, alive=number)
    bench.send("release", jog=number)
    bench.rest()
    assert bench.facts.remark is None
    number = bench.jog("Z", step=1, speed=100)
    bench.rest(alive=number)
    assert bench.facts.remark is None
    number = bench.jog("Z", step=100)
    bench.turns(60, alive=number)
    bench.exchange.join()
    bench.rest(alive=number)
    assert str(bench.facts.remark).endswith(" of 100 mm")


def test_an_alarm_in_a_jog_is_of_no_line(bench):
    number = bench.jog("Z", step=40)
    bench.turns(40, alive=number)
    assert bench.do("stop") is None
    (note,) = [each for each in json.loads(bench.exchange.notes[1])["rows"] if each["code"] == "RBL530"]
    assert (note["line"], note["text"].startswith("jog Z +40: ")) == (None, True)
    assert bench.facts.alarm["line"] is None


# --- teaching --------------------------------------------------------------------------------------------------------


def test_a_point_is_taught_where_the_arm_stands_and_is_saved(bench):
    number = bench.jog("J1", step=5)
    bench.rest(alive=number)
    assert bench.do("teach", name="HERE1", kind=None, replace=False) is None
    point = load_project(bench.path).points.get("HERE1")
    assert point.joints == pytest.approx(np.rad2deg(bench.q), abs=1e-4)
    assert bench.session.executor.project.points.get("HERE1") == point


def test_a_point_is_replaced_only_where_that_is_meant(bench):
    assert bench.do("teach", name="P77", kind="pose", replace=False) is None
    number = bench.jog("J1", step=5)
    bench.rest(alive=number)
    before = load_project(bench.path).points.get("P77")
    assert bench.do("teach", name="p77", kind=None, replace=False) == "RBL808"
    assert load_project(bench.path).points.get("P77") == before
    assert bench.do("teach", name="p77", kind=None, replace=True) is None
    after = load_project(bench.path).points.get("P77")
    assert (after.name, after.pose == before.pose) == ("P77", False)


@pytest.mark.parametrize("name", ["1P", "N", "MOVE", "a b", "é", "P'); import os", "../x"])
def test_a_name_that_no_point_can_have_is_refused(bench, name):
    assert bench.do("teach", name=name, kind=None, replace=False) in ("RBL303", "RBL718")
    assert not bench.path.with_name("p.points.toml").exists()


def test_a_point_that_cannot_be_saved_is_not_taught(bench, monkeypatch):
    points = bench.session.executor.project.points

    def full(self):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("robolang.core.storage.os.replace", lambda *names: full(None))
    assert bench.do("teach", name="P77", kind=None, replace=False) == "RBL312"
    monkeypatch.undo()
    assert bench.session.executor.project.points.get("P77") is None
    assert points.get("P77") is None
    assert load_project(bench.path).points.get("P77") is None
