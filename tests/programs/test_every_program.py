"""Every program in programs/: clean text, a run on MuJoCo without fault, and the part where P3 says."""

from pathlib import Path

import numpy as np
import pytest

from robolang.execution.lowering import pose_si
from robolang.execution.session import RunResult, Session
from robolang.project.project import load_project
from runtime.core.frames import inverse, rotation_angle
from tests.programs.runs import run

pytestmark = pytest.mark.physics

PROGRAMS = sorted((Path(__file__).parents[2] / "programs").glob("*.rbl"))


@pytest.fixture(scope="module", params=PROGRAMS, ids=lambda path: path.stem)
def program(request) -> Path:
    return request.param


@pytest.fixture
def session(program) -> Session:
    return run(program.name)[0]


@pytest.fixture
def result(program) -> RunResult:
    return run(program.name)[1]


def test_there_are_programs_for_the_small_and_the_large_arm():
    assert {load_project(path).cell.robot.name for path in PROGRAMS} == {"puma560", "manutec_r3"}


def test_the_text_is_clean_and_the_run_has_no_fault(session, result):
    assert session.project.diagnostics == ()
    assert result.ok
    assert len(result.report["statements"]) == 11
    assert all(np.isfinite(values).all() for values in result.log.values())


def test_no_move_gives_up_before_it_is_in_position(result):
    notes = [note for entry in result.report["statements"] for note in entry["notes"]]
    assert notes == ["holds 'part'"]


def test_about_nine_tenths_of_the_rated_payload_are_carried(session, result):
    heaviest = max(entry["mass_kg"] for entry in result.report["payload_history"])
    cell = session.project.cell
    assert heaviest == pytest.approx(cell.hand.mass + cell.parts[0].mass)
    assert 0.9 <= heaviest / cell.robot.rated_payload <= 0.92


def test_no_motor_is_near_its_limit(result):
    peaks = [entry["peak_torque_pct"] for entry in result.report["statements"]]
    assert 25.0 < max(peak for peak in peaks if peak is not None) < 60.0


def test_the_part_stands_where_p3_put_it(session, result):
    points, part = session.project.points, session.project.cell.parts[0]
    X_p1, X_p3 = (pose_si(points.get(name).pose) for name in ("P1", "P3"))
    X_expected = X_p3 @ inverse(X_p1) @ part.X_world_part
    X_actual = session.controller.plant.parts()[part.name]
    assert np.linalg.norm(X_actual[:3, 3] - X_expected[:3, 3]) < 1e-3
    assert np.degrees(rotation_angle(X_actual[:3, :3], X_expected[:3, :3])) < 0.5
    assert session.controller.plant.hand().holding is None
