"""Moves behind conditions that the simulated inputs do not meet are planned too, and said with the way to them."""

import json
import re
from collections import deque
from importlib import resources

import pytest

from robolang.core.source import Span
from robolang.execution.dry_run import rehearse
from robolang.interpreter.branch_oracle import Decisions
from robolang.planning import motion_findings, path_coverage
from robolang.planning.motion_findings import findings
from robolang.planning.path_coverage import _queue, explore
from robolang.project.project import load_project
from tests.messages import heads, numbers
from tests.robolang.cli.commands import robolang

pytestmark = pytest.mark.physics

FAR = "MOVE P1 + (900, 0, 0)"


@pytest.fixture
def found(tmp_path):
    (tmp_path / "cell.toml").write_text(
        builtin("cell.toml") + "\n[inputs.1]\nchanges = [[0, 0]]\n[inputs.2]\nchanges = [[0, 0], [0.5, 1]]\n"
    )
    (tmp_path / "p.points.toml").write_text(builtin("points.toml"))

    def look(text):
        (tmp_path / "p.rbl").write_text(text)
        project = load_project(tmp_path / "p.rbl")
        assert project.ok, project.diagnostics
        explored = explore(project)
        said = findings(project, explored.rehearsal, None, explored.detours)
        return [(item.code, project.source.place(item.span.start).line, item.message) for item in said], explored

    return look


def builtin(name):
    return resources.files("robolang.project.builtin").joinpath(name).read_text("utf-8")


def test_a_branch_that_the_inputs_do_not_take_is_planned(found):
    said, explored = found(f"MOVE P2\nIF IN(1) = 1 THEN\n{FAR}\nENDIF\nMOVE P5")
    assert [(code, line) for code, line, _ in said] == [("RBL410", 3)]
    assert "'IN(1) = 1' in line 2 " in said[0][2]
    assert len(explored.rehearsal.moves) == 2
    assert explored.missed == ()


def test_a_time_out_is_tried(found):
    said, _ = found(f"WAIT IN(2) = 1, TIMEOUT 9, GOTO *LATE\nEND\n*LATE {FAR}")
    assert [(code, line) for code, line, _ in said] == [("RBL410", 3)]
    assert "'IN(2) = 1' in line 1 " in said[0][2]


def test_a_way_behind_a_way(found):
    said, explored = found(f"IF IN(1) THEN\nIF IN(1) = 2 THEN {FAR}\nENDIF")
    assert [(code, line) for code, line, _ in said] == [("RBL410", 2)]
    assert re.search(r"'IN\(1\)' in line 1 .*'IN\(1\) = 2' in line 2 ", said[0][2])
    assert len(explored.detours) == 2


def test_what_the_program_decides_alone_goes_its_way(found):
    said, explored = found(f"x = 1\nIF x = 2 THEN {FAR}")
    assert said == []
    assert explored.detours == ()
    assert [node.span.start for node in explored.missed] == [20]


def test_a_collision_behind_a_branch(found):
    said, _ = found("MOVE P2\nIF IN(1) THEN MOVE P1 + (0, 0, -30) ELSE MOVE P5")
    assert [(code, line) for code, line, _ in said] == [("RBL421", 2)]


def test_an_error_that_the_program_wants_is_no_finding(found):
    said, explored = found("MOVE P2\nWAIT IN(2), TIMEOUT 5\nMOVE P5")
    assert said == []
    assert [item.code for detour in explored.detours for item in detour.rehearsal.refused] == ["RBL503"]


def test_what_was_looked_at_is_not_looked_at_again(found):
    text = "MOVE P1 + (0, 0, -30)\nIF IN(1) THEN DELAY 1"
    said, explored = found(text)
    assert [(code, line) for code, line, _ in said] == [("RBL421", 1)]
    assert " (if" not in said[0][2]
    first, detour = explored.rehearsal.moves[0], explored.detours[0].rehearsal.moves[0]
    assert detour.plan is first.plan  # planned once


def test_loops_come_to_an_end(found):
    said, explored = found("WHILE IN(1) = 0\nMOVE P2, SPEED 900\nMOVE P5, SPEED 900\nIF IN(2) THEN END\nWEND\nMOVE P1")
    assert said == []
    assert explored.missed == ()
    assert len(explored.detours) == 2


def test_the_first_rehearsal_is_the_plain_one(found, tmp_path):
    _, explored = found("MOVE P2, ZONE 20\nIF IN(1) THEN MOVE P1\nMOVE P3")
    plain = rehearse(load_project(tmp_path / "p.rbl"))
    assert explored.rehearsal.total_us == plain.total_us
    assert explored.rehearsal.times_us == plain.times_us


def test_there_is_an_end_to_detours(found, monkeypatch):
    monkeypatch.setattr(path_coverage, "MOST_DETOURS", 3)
    _, explored = found("".join(f"IF IN(1) = {n} THEN MOVE P2\n" for n in range(6)))
    assert len(explored.detours) == 3
    assert len(explored.missed) == 3


def test_the_command_says_how_many_ways_there_were(found, tmp_path):
    found(f"MOVE P2\nIF IN(1) = 1 THEN {FAR}\nx = 1\nIF x = 2 THEN MOVE P3")
    said = robolang("check", "--motion", tmp_path / "p.rbl", "--output-format", "concise", code=1).stdout
    counted, missed = [line for line in said.splitlines() if not heads(line)][-2:]
    assert 1 in numbers(counted)
    assert numbers(missed) == [4]


def test_moves_after_an_error_are_not_planned_because_of_it(found, tmp_path):
    found(f"MOVE P2\n{FAR}\nMOVE P3\nMOVE P5")
    said = robolang("check", "--motion", tmp_path / "p.rbl", "--output-format", "concise", code=1).stdout
    (missed,) = [line for line in said.splitlines() if line.startswith("not planned")]
    assert numbers(missed) == [2, 3, 4]


def test_the_table_is_written_for_other_programs(found, tmp_path):
    found("SPEED 200\nFOR i = 1 TO 3\nMOVE P2\nDELAY 0.1\nWAIT IN(2), TIMEOUT 2\nMOVE P5\nNEXT")
    robolang("check", "--motion", tmp_path / "p.rbl", "--times", tmp_path / "t.json")
    (times,) = json.loads((tmp_path / "t.json").read_text())
    assert (times["robot"], times["complete"], times["other_ways"], times["not_planned"]) == ("puma560", True, 1, [])
    lines = {row["line"]: row for row in times["lines"]}
    assert [lines[line]["count"] for line in (3, 4, 6)] == [3, 3, 3]
    assert lines[4]["seconds"] == pytest.approx(3 * 0.104)  # whole cycles of 8 ms
    assert times["total_s"] == pytest.approx(sum(row["seconds"] for row in times["lines"]))
    assert lines[3]["length_mm"] == pytest.approx(3 * 220.0, rel=1e-6)


def test_times_need_the_motion(tmp_path):
    assert "--times" in robolang("check", "--times", tmp_path / "t.json", code=2).stderr


@pytest.mark.parametrize("line", ["TOOL gripp  ' noqa: RBL305", "WAIT IN(9) = 1, TIMEOUT 2  ' noqa"])
def test_what_keeps_the_motion_from_being_planned_cannot_be_hidden(tmp_path, line):
    (tmp_path / "p.rbl").write_text(f"SPEED 200\n{line}\n{FAR}\n")
    for words in ((), ("--ignore", "RBL305,RBL534")):
        said = robolang("check", "--motion", "--max-cycle", "0.1s", tmp_path / "p.rbl", *words, code=1).stdout
        assert "p.rbl:2:" in said


def test_errors_of_the_cell_are_found_beside_errors_of_the_text(tmp_path):
    (tmp_path / "p.rbl").write_text("MOV P1\nLOAD (0, 0, 0), 6\n")
    said = robolang("check", "--motion", tmp_path / "p.rbl", "--output-format", "concise", code=1).stdout
    assert [line.split()[2] for line in said.splitlines()] == ["RBL112", "RBL402"]


def test_a_way_is_queued_once():
    decisions, known, todo = Decisions(), set(), deque()
    places = {Span(k, k + 1): None for k in range(5)}
    for place in places:
        decisions.took(place, True)
    for forced in ({}, {Span(9, 10): True}, {Span(10, 11): True}):  # three rehearsals that come by the same conditions
        _queue(todo, forced, places, known, decisions)
    assert list(todo) == [{place: False} for place in places]


def test_moves_with_the_same_load_are_not_looked_at_again(found, monkeypatch):
    looked = []
    plain = motion_findings._Moves.folds
    monkeypatch.setattr(motion_findings._Moves, "folds", lambda self, move: looked.append(move) or plain(self, move))
    found("FOR i = 1 TO 3\nLOAD (0, 0, 60), 0.8\nMOVE P2\nMOVE P5\nNEXT\nIF IN(1) THEN DELAY 1")
    assert len(looked) == 6  # those of the first rehearsal, and of the detour none


def test_the_first_finding_of_a_statement_is_said(found):
    said, _ = found("MOVE P2\nFOR i = 1 TO 2\nMOVE P2 + (0, 10 * i, 0), ZONE 50\nMOVE P2 + (0, 10 * i, 60)\nNEXT")
    zones = {line: message for code, line, message in said if code == "RBL414"}
    assert "10.0 mm" in zones[3]
