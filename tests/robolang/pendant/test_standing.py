"""Where a program stands after stops, alarms, edits and what is typed in between."""

import pytest

from robolang.pendant.failure import Failure
from tests.robolang.pendant.prompting import Requests, prompt

MOVES = "10 MOVEJ JOINT(10,0,0,0,45,0)\n20 MOVEJ JOINT(20,0,0,0,45,0)\n40 MOVEJ JOINT(30,0,0,0,45,0)\n60 END\n"


@pytest.fixture
def opened(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def open_one(text, **how):
        (tmp_path / "p.rbl").write_text(text)
        return prompt(tmp_path / "p.rbl", **how)

    return open_one


def test_a_stop_on_the_return_to_the_path_stops_the_program_too(opened):
    session = opened("MOVEJ JOINT(40,0,0,0,45,0)\n")
    session.do("run for 0.5", "jog J1 3")
    interrupts = Requests(stop=5)
    session.pendant.interrupts.take = interrupts.take
    session.do("continue")
    stopped = session.do("pos")
    assert "held in: MOVEJ" in session.do("where")
    assert session.do("pos") == stopped
    session.do("continue")
    assert "ended" in session.do("where")


@pytest.mark.parametrize("line", ["*L", "15", "20"])
def test_a_line_without_a_statement_is_stopped_at_by_the_next_one(opened, line):
    session = opened("10 x = 1\n15 ' note\n20 *L\n30 x = 2\n40 END\n")
    assert "next: 30 x = 2" in session.do(f"runto {line}")
    session = opened("10 x = 1\n15 ' note\n20 *L\n30 x = 2\n40 END\n")
    session.do(f"break {line}")
    assert "next: 30 x = 2" in session.do("run")


def test_a_line_after_the_last_statement_is_no_stop(opened):
    session = opened("10 x = 1\n20 ' note\n")
    with pytest.raises(Failure, match="RBL803"):
        session.do("runto 20")


def test_a_statement_that_failed_begins_again_after_it_is_repaired(opened):
    session = opened("10 x = 0\n15 z = 1\n20 y = 1 / (z - 1)\n30 x = 9\n")
    with pytest.raises(Failure, match="RBL501"):
        session.do("run")
    session.do("reset", "jog J1 1", "z = 3")
    with pytest.raises(Failure, match="RBL806"):
        session.do("run")
    session.do("continue")
    assert session.do("x; y").split() == ["9", "0.5"]


def test_a_program_that_is_over_stays_over_whatever_is_typed(opened):
    session = opened(MOVES)
    session.do("run", "jog J1 1", "x = 2")
    assert "ended" in session.do("where")
    assert "->" not in session.do("list")
    with pytest.raises(Failure, match="RBL806"):
        session.do("run")
    assert "next: 10" in session.do("restart")


def test_a_typed_statement_that_failed_fails_nothing_else(opened):
    session = opened(MOVES)
    session.do("a = 0")
    with pytest.raises(Failure, match="RBL501"):
        session.do("b = 1 / a")
    assert "next: 20" in session.do("step")


def test_a_typed_move_that_is_held_is_shown_as_typed(opened):
    session = opened(MOVES, interrupts=Requests(stop=20))
    session.do("MOVEJ JOINT(60,0,0,0,45,0)")
    assert "held in: MOVEJ JOINT(60,0,0,0,45,0)" in session.do("where")
    with pytest.raises(Failure, match="RBL811"):
        session.do("run")
    session.do("continue")
    assert "next: 10" in session.do("where")


def test_a_line_that_is_not_reached_is_named(opened):
    session = opened(MOVES)
    session.do("runto 40")
    assert "line 1 was not reached" in session.do("runto 10")


@pytest.mark.parametrize(("word", "meant"), [("savee", "save"), ("exit", "quit"), ("ls", "list"), ("delete P1", "del")])
def test_a_slip_names_the_command_that_was_meant(opened, word, meant):
    session = opened(MOVES)
    with pytest.raises(Failure) as caught:
        session.do(word)
    assert meant in caught.value.text.splitlines()[-1].split()[-1]


def test_an_edit_of_one_of_equal_lines_moves_the_program_with_the_others(opened):
    session = opened("x = 0\nx = x + 1\nx = x + 1\nx = x + 1\nEND\n")
    session.do("runto 3", "edit 2:", "run")
    assert session.do("x") == "3\n"  # the first of them had been carried out


def test_an_undo_after_a_save_leaves_the_program_where_it_stands(opened):
    session = opened("10 x=0\n20 x=x+1\n30 y=x*10\n40 x=x+1\n50 z=x\n60 end\n")
    session.do("runto 50", "20", "save", "undo")
    assert "next: 50" in session.do("where")
    session.do("run")
    assert session.do("z") == "2\n"


def test_lines_are_shown_while_the_edited_program_has_errors(opened):
    session = opened("10 X=1\n20 Y=1\n30 Z=X\n40 PRINT Z\n50 END\n")
    session.do("runto 50", "10", "20")
    assert "next: 50 END" in session.do("where")
    assert "-> 50 END" in session.do("list")
    assert "40 PRINT Z" in session.do("back")


def test_redo_survives_a_change_that_is_refused(opened):
    session = opened("10 GOSUB 100\n20 END\n100 x = 1\n110 x = 2\n120 RETURN\n")
    session.do("15 PRINT 2", "undo", "step into", "step into")
    with pytest.raises(Failure, match="RBL543"):
        session.do("10")
    assert "line 15" in session.do("redo")


@pytest.mark.parametrize(
    "line", ["list ²", "break ²", "edit ²: x", "save as .", "save as /", "record a\0b", "log \ud800.npz"]
)
def test_odd_names_are_refused_with_a_code(opened, line):
    session = opened(MOVES)
    with pytest.raises(Failure) as caught:
        session.do(line)
    assert all(code.startswith("RBL") and code != "RBL900" for code in caught.value.codes)


def test_an_edit_is_no_step_of_back(opened):
    session = opened(MOVES)
    session.do("step", "step", "teach A", "15 PRINT 1", "undo", "copy A B")
    assert "20 MOVEJ" in session.do("back")
    assert "10 MOVEJ" in session.do("back")
    with pytest.raises(Failure, match="RBL545"):
        session.do("back 3")
