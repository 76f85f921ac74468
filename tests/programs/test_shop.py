"""The programs of programs/shop on MuJoCo: what they do to the parts, what they print, how long they take."""

import re

import numpy as np
import pytest

from robolang.execution.dry_run import rehearse
from tests.programs.runs import ROOT, run

pytestmark = pytest.mark.physics

SHOP = sorted(path.stem for path in (ROOT / "shop").glob("*.rbl"))
ALL = sorted(str(path.relative_to(ROOT)) for path in ROOT.rglob("*.rbl"))


def printed(name):
    return [entry["text"] for entry in run(f"shop/{name}.rbl")[1].report["printed"]]


def place(name, part):
    return np.array(run(f"shop/{name}.rbl")[1].report["objects"][part]["pose_mm_deg"][:3])


def test_there_are_at_least_ten_programs():
    assert len(ALL) >= 10
    assert set(SHOP) == {"cans", "dispense", "glue", "inspect", "nuts", "palletise", "recover", "sort", "tend"}


@pytest.mark.parametrize("name", SHOP)
def test_a_program_is_clean_and_runs_to_its_end_without_an_alarm_or_a_warning(name):
    session, result = run(f"shop/{name}.rbl")
    assert session.project.diagnostics == ()
    assert result.ok, result.report["alarms"]
    assert result.report["warnings"] == []
    assert result.warnings == ()


@pytest.mark.parametrize("name", ALL)
def test_the_rehearsal_takes_as_long_as_the_run(name):
    """To one cycle, as the issue of the rehearsal asks; under a seam sensor the path, and with it the end, moves."""
    session, result = run(name)
    planned = rehearse(session.project)
    assert planned.refused == ()
    assert planned.total_us == pytest.approx(result.report["sim_time_s"] * 1e6, abs=8000.0)


@pytest.mark.parametrize("name", ALL)
def test_every_move_begins_and_ends_as_rehearsed(name):
    """In a chain as well, where one statement follows the other in the middle of a blend, and so does the log's line.

    The end of a chain may come a cycle later, when the arm has yet to come into position.
    """
    session, result = run(name)
    tick_us = session.project.profile.tick_us
    ran = [each for each in session.record.statements if each.text.startswith(("MOVE", "SPLINE", "APPROACH", "DEPART"))]
    planned = rehearse(session.project).moves
    assert [each.origin.line for each in ran] == [move.effect.line for move in planned]
    for each, move in zip(ran, planned, strict=True):
        assert each.first_tick * tick_us == move.begins_us
        assert each.end_tick * tick_us == pytest.approx(move.ends_us, abs=8000.0)
        lines = result.log["line"][each.first_tick : each.end_tick]
        assert (lines == each.origin.line).all()


def test_parts_are_put_on_the_pallet():
    (line,) = printed("palletise")
    assert float(re.fullmatch(r"put down 2 parts in ([\d.]+) s", line)[1]) == pytest.approx(
        run("shop/palletise.rbl")[1].report["sim_time_s"]
    )
    for k, part in enumerate(("part_1", "part_2")):
        assert place("palletise", part) == pytest.approx([400.0 + 100.0 * k, 150.0, 640.0], abs=0.5)


def test_parts_are_sorted_by_their_kind():
    assert printed("sort") == ["left", "right"]
    assert place("sort", "part_1") == pytest.approx([420.0, 120.0, 640.0], abs=0.5)
    assert place("sort", "part_2") == pytest.approx([540.0, 120.0, 640.0], abs=0.5)


def test_the_machine_is_tended_with_its_handshake():
    session, _ = run("shop/tend.rbl")
    history = session.world.signals._history
    (start, _), (end, _) = history[1]
    assert (end - start) / 1e6 == pytest.approx(0.8, abs=0.02)  # output 1 until input 2 has followed it
    assert (history[2][1][0] - history[2][0][0]) / 1e6 == pytest.approx(0.2)
    assert re.fullmatch(r"one part in 1[01](\.\d)? s", printed("tend")[0])
    assert place("tend", "part_1") == pytest.approx([400.0, -220.0, 640.0], abs=0.5)


def test_a_bead_is_laid_without_a_stop():
    """From the valve's opening to its closing the nozzle never stands, and stays within the zones of its corners."""
    session, result = run("shop/dispense.rbl")
    opened, closed = (at for at, _ in session.world.signals._history[5])
    log = result.log
    t = log["t"] * 1e6
    X = session.controller.tool_poses(log["q_cmd"])[:, :3, 3]
    bead = (t > opened + 400e3) & (t < closed - 400e3)
    speed = np.linalg.norm(np.diff(X[bead], axis=0), axis=1) / session.project.profile.tick_s
    assert speed.min() > 0.02
    assert speed.max() < 0.125
    assert printed("dispense")[0].startswith("bead of 526 mm in ")


def test_glue_is_laid_through_all_taught_points_at_one_speed():
    session, result = run("shop/glue.rbl")
    (row,) = (each for each in session.record.statements if each.text.startswith("SPLINE"))
    X = session.controller.tool_poses(result.log["q_cmd"])[row.first_tick : row.end_tick, :3, 3]
    speed = np.linalg.norm(np.diff(X, axis=0), axis=1) / session.project.profile.tick_s
    middle = speed[len(speed) // 4 : -len(speed) // 4]
    assert middle.min() == pytest.approx(0.1, rel=0.01)
    assert middle.max() == pytest.approx(0.1, rel=0.01)
    for point in row.points:
        assert np.linalg.norm(X - np.array(point.pose[:3]) / 1000.0, axis=1).min() < 1e-4
    assert row.path.deviation(X).max() < 5e-5


def test_stations_are_looked_at_from_four_sides():
    assert printed("inspect") == ["12 pictures from 3 stations, the last at 441 mm from home"]


def test_what_goes_wrong_is_answered():
    lines = printed("recover")
    assert lines == ["cannot go there (RBL410)", "no signal", "error RBL501", "3 faults answered"]
    statements = run("shop/recover.rbl")[1].report["statements"]
    waits = [entry for entry in statements if entry["text"].startswith("WAIT")]
    assert [entry["duration_s"] for entry in waits] == [pytest.approx(0.5, abs=0.009)]


def test_cans_are_stacked_by_a_cup():
    for k, part in enumerate(("can_1", "can_2")):
        assert place("cans", part) == pytest.approx([480.0, 220.0, 630.0 + 60.0 * k], abs=1.0)
    notes = [note for entry in run("shop/cans.rbl")[1].report["statements"] for note in entry["notes"]]
    assert notes == ["holds 'can_1'", "holds 'can_2'"]
    assert not run("shop/cans.rbl")[1].log["fingers"].any()


def test_nuts_that_are_meshes_are_stacked():
    for k, part in enumerate(("nut_1", "nut_2")):
        assert place("nuts", part) == pytest.approx([480.0, 180.0, 620.0 + 40.0 * k], abs=0.5)
    _, result = run("shop/nuts.rbl")
    notes = [note for entry in result.report["statements"] for note in entry["notes"]]
    assert notes == ["holds 'nut_1'", "holds 'nut_2'"]
    opening = 2.0 * result.log["fingers"].min(axis=1)
    assert np.median(opening[opening < 0.05]) == pytest.approx(0.04, abs=1e-4)  # over the flats
    assert set(result.log.needed_meta()["scene"]["meshes"]) == {"cell:0:bracket", "cell:1:nut"}
