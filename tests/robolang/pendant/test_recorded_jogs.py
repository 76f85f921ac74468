"""``record``: jogs, long recordings, and whatever else may have been done."""

import io
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.pendant.script import play
from robolang.teaching.recorded import recorded
from tests.campaign import examples
from tests.robolang.pendant.prompting import Requests, prompt
from tests.robolang.pendant.recordings import PICK, assert_same_log, done_again, statements, tolerant


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


LINES = st.lists(
    st.sampled_from(
        [
            "MOVE P1",
            "MOVE P2, SPEED 300, ZONE 20",
            "MOVE P5, ACCEL MAX, ZONE 10",
            "MOVE P3 + (0, 0, 30), ACCEL 40",
            "MOVEJ P4, SPEED 35",
            "MOVEJ JOINT(0, 60, -170, 10, -60, 5)",
            "MOVE P5 * (0, 0, -20, 0, 0, 15), WRIST AUTO",
            "DEPART 25",
            "APPROACH P2, 40, TIME 3",
            "MOVEC P2, P3, SPEED 90",
            "SPLINE (P2, P3, P4), SPEED 90",
            "FRAME POSE(5, -3, 2, 0, 0, 12)",
            "FRAME WORLD",
            "TOOL grip",
            "TOOL POSE(0, 0, 80, 0, 10, 0)",
            "LOAD empty",
            "SPEED 120",
            "SPEEDJ 30",
            "OVERRIDE 60",
            "ACCEL 70",
            "ACCEL MAX",
            "ZONE 15",
            "OUT(1) = 1",
            "PULSE 2, 0.1",
            "DELAY 0.05",
            "HAND OFF, 0.1",
            "WRIST KEEP",
            "WRIST HOLD TILT",
            "run",
            "again",
        ]
    ),
    max_size=12,
)


@examples(200, 4)
@given(lines=LINES)
def test_whatever_was_done_is_done_again(lines, tmp_path_factory):
    folder = tmp_path_factory.mktemp("random")
    prompted = prompt(tolerant(PICK, folder))
    play(io.StringIO("\n".join(["auto", f"record {folder / 'done'}", *lines])), prompted.pendant, keep_going=True)
    assert_same_log(done_again(prompted, str(folder / "done.rbl")))


def test_a_long_recording_is_made_in_linear_time(folder):
    from tests.steps import assert_linear

    def after(rounds: int):
        program = folder / f"{rounds}.rbl"
        program.write_text(f"FOR i = 1 TO {rounds}\nOUT(1) = i\nNEXT\n")
        prompted = prompt(program)
        prompted.do("run")
        return prompted.pendant.live.session.record

    small, large = after(200), after(400)
    assert_linear(lambda record: recorded(record, (0.0,) * 6), small, large)


def test_jogs_are_moves_to_where_they_ended_in_their_time():
    prompted = prompt(PICK)
    prompted.do("record done", "jogspeed 60", "OVERRIDE 50", "jog J3 +5", "jog X -30.5", "jogframe tool", "jog RX 12")
    prompted.do("jog Z -20", "jog J1 -2", "auto", "MOVE P5", "DEPART 5")
    found = statements("done.rbl")
    assert [re.sub(r"\(.*\)", "()", line).split(", TIME")[0] for line in found] == [
        "MOVEJ JOINT()",
        "MOVE JOINT()",
        "MOVE JOINT()",
        "MOVE JOINT()",
        "MOVEJ JOINT()",
        "OVERRIDE 50",
        "MOVE P5",
        "DEPART 5",
    ]
    log, again = done_again(prompted, "done.rbl")
    assert Path("done.rbl").read_text().splitlines()[4].endswith("' by hand: jog J3 +5")
    # as long, but for what the arm takes to come into position
    jogs = prompted.pendant.live.session.record.statements[:5]
    assert [float(line.split("TIME ")[1]) for line in found[:5]] == pytest.approx([run.planned_s for run in jogs])
    assert len(again["t"]) == pytest.approx(len(log["t"]), rel=0.1)


def test_a_jog_that_is_stopped_is_a_move_to_where_it_came_to_rest():
    prompted = prompt(PICK, interrupts=Requests(stop=40))
    prompted.do("record done", "jog X -80", "auto", "DEPART 5")
    (jog, depart) = statements("done.rbl")
    assert jog.startswith("MOVE JOINT(")
    assert float(jog.split("TIME ")[1]) < 0.6
    assert depart == "DEPART 5"
    done_again(prompted, "done.rbl")
