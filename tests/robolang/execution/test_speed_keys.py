"""Programmed and reached speeds in reports and tables, of programs whose moves are slow on purpose."""

import json

import pytest

from robolang.cli.speed_cells import cell
from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.execution.speed_keys import KEYS, NO_SPEED, of_runs
from robolang.planning.line_times import line_times
from robolang.project.project import load_project

pytestmark = pytest.mark.physics

TEXT = """MOVEJ JOINT(0, 60, -190, 0, -60, 0), SPEED 20
SPEED 200
MOVE HERE + (0, 60, 0), SPEED 100
MOVE (HERE + (0, 60, 0)) * (0, 0, 0, 0, 0, 170)
FOR k = 1 TO 2
MOVE HERE + (0, 0, 5 * k)
NEXT k
MOVE HERE + (0, 50, 0), TIME 2
DELAY 0.1
"""


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    path = tmp_path_factory.mktemp("speeds") / "p.rbl"
    path.write_text(TEXT)
    return load_project(path)


def test_a_report_has_speeds_and_what_limits_them(project):
    statements = Session(project, physics=False).run().report.statements
    found = {each["line"]: {key: each[key] for key in KEYS} for each in statements}
    assert json.loads(json.dumps(found[4])) == found[4]
    assert found[1]["programmed_pct"] == pytest.approx(20.0)
    assert found[1]["reached_pct"] == pytest.approx(20.0, rel=0.03)
    assert found[1]["reached_mm_s"] is None
    assert (found[3]["programmed_mm_s"], found[3]["limited_by"]) == (pytest.approx(100.0), None)
    assert found[4]["programmed_mm_s"] == pytest.approx(200.0)
    assert found[4]["reached_mm_s"] < 100.0
    assert found[4]["limited_by"] == "turning"
    assert found[4]["limited_why"]
    assert found[6]["limited_by"] == "length"
    assert found[8]["programmed_mm_s"] is None
    assert 25.0 < found[8]["reached_mm_s"] < 50.0
    assert found[9] == NO_SPEED


def test_the_table_of_a_program_has_the_slowest_run_of_each_line(project):
    rehearsal = rehearse(project)
    rows = {row.line: row for row in line_times(project, rehearsal)}
    runs = [each.speeds.moves[each.number].reached for each in rehearsal.moves if each.effect.line == 6]
    assert rows[6].reached_mm_s == pytest.approx(min(runs) * 1e3)
    assert runs[0] < runs[1]
    assert rows[4].limited_by == "turning"
    assert rows[9].reached_mm_s is None


def test_of_several_runs_a_limited_one_counts():
    nothing = dict(NO_SPEED)
    fast = nothing | {"programmed_mm_s": 100.0, "reached_mm_s": 99.0}
    slow = nothing | {"programmed_mm_s": 200.0, "reached_mm_s": 199.0, "limited_by": "corner"}
    timed = nothing | {"reached_mm_s": 20.0}
    assert of_runs([fast, slow, timed]) == slow | {"highest_mm_s": 199.0, "highest_pct": None}
    assert of_runs([timed, fast]) == fast | {"highest_mm_s": 99.0, "highest_pct": None}


def test_of_many_runs_the_speeds_are_a_range_with_what_limits_most_of_them():
    """A row of short moves showed the speed of its first ramp alone, which is none of its typical moves."""
    ramp = dict(NO_SPEED) | {"programmed_mm_s": 400.0, "reached_mm_s": 49.0, "limited_by": "length"}
    moves = [ramp | {"reached_mm_s": 300.0 + k, "limited_by": "corner", "limited_why": str(k)} for k in range(3)]
    found = of_runs([ramp, *moves, ramp | {"reached_mm_s": 400.0, "limited_by": None}])
    assert (found["reached_mm_s"], found["highest_mm_s"]) == (49.0, 400.0)
    assert (found["limited_by"], found["limited_why"]) == ("corner", "0")
    assert cell(found) == "49-400/400"
    assert cell(ramp) == "49/400"
    assert cell(of_runs([ramp, ramp])) == "49/400"
    timed = dict(NO_SPEED) | {"reached_pct": 20.0}
    assert cell(of_runs([timed, timed | {"reached_pct": 35.0}])) == "20-35 %"
