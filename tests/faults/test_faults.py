"""A reduced fault campaign: every fault named with line and axis in time, clean runs silent, wrong payloads found.

The whole of it is ``make fault-campaign`` and ``make supervision-campaign``.
"""

import dataclasses
from typing import Any

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.project.project import load_project
from tests.faults.campaign import (
    PROGRAM,
    WITHIN_MS,
    clean_campaign,
    inject,
    moving_axes,
    payload_campaign,
    project_of,
    run_fault,
    verdict,
)

pytestmark = pytest.mark.physics


@pytest.fixture(scope="module")
def project():
    return load_project(PROGRAM)


@pytest.fixture(scope="module")
def clean(project):
    return {physics: Session(project, physics=physics).run() for physics in (False, True)}


@pytest.mark.parametrize("fault", WITHIN_MS)
@pytest.mark.parametrize("physics", [False, True])
def test_a_fault_is_named_with_line_and_axis_in_time(project, clean, fault, physics):
    """On J2, in the middle of line 60."""
    at, axes = moving_axes(clean[physics], 60, 0.5)
    assert 1 in axes
    result, alarm = run_fault(project, fault, 1, at, physics)
    assert verdict(alarm, fault, 1, at, 60) == ""
    assert not result.ok
    assert all(np.isfinite(values).all() for values in result.log.values())
    assert result.report["statements"][-1]["number"] == 60


def test_nan_is_caught_in_its_tick_and_the_last_finite_state_is_the_end_of_the_log(project, clean):
    at, _ = moving_axes(clean[True], 60, 0.5)
    for fault in ("encoder nan", "nan torque", "nan state"):
        result, alarm = run_fault(project, fault, 2, at, True)
        assert (alarm["code"], alarm["category"], alarm["axis"]) == ("RBL510", 0, 3)
        assert len(result.log["t"]) == at == round(alarm["time_s"] * 1000)


def test_nothing_moves_after_the_stop_and_the_command_comes_to_rest_on_the_path(project, clean):
    """Category 1: the command ends at rest, on the line of its MOVE, within joint limits."""
    at, _ = moving_axes(clean[False], 60, 0.5)
    session = Session(project, physics=False)
    inject("drive half")(session, 1, at)
    result = session.run()
    run = session.record.statements[-1]
    ticks = result.log["number"] == 60
    p_cmd = session.controller.tool_poses(result.log["q_cmd"][ticks])[:, :3, 3]
    assert run.path.deviation(p_cmd).max() < 1e-5
    assert np.abs(result.log["dq_cmd"][-1]).max() < 1e-9
    spec = project.cell.robot
    assert (np.abs(result.log["dq_cmd"]) <= spec.per_axis("limits", "speed")).all()
    assert (np.abs(np.diff(result.log["dq_cmd"], axis=0)) <= 1.001e-3 * spec.per_axis("limits", "acceleration")).all()
    ticks_before = session.controller.recorder.tick
    assert not session.controller.cycle()
    assert session.controller.recorder.tick == ticks_before


def test_a_starved_dynamics_task_is_noticed_at_its_line():
    project = load_project(PROGRAM)
    project = project.with_profile(dataclasses.replace(project.profile, interpolation_cost_us=8000))
    result = Session(project, physics=False).run()
    (alarm,) = result.report["alarms"]
    assert (alarm["code"], alarm["number"]) == ("RBL521", 30)
    age_ms = result.log["D_age"][round(alarm["time_s"] * 1000) - 1].max()
    assert 400.0 <= age_ms <= 420.0


def test_an_overrun_is_noticed_first_as_a_warning_then_as_an_alarm():
    project = load_project(PROGRAM)
    project = project.with_profile(dataclasses.replace(project.profile, interpolation_cost_us=9000))
    result = Session(project, physics=False).run()
    assert [entry["code"] for entry in result.report["warnings"]] == ["RBL520"]
    assert [entry["code"] for entry in result.report["alarms"]] == ["RBL520"]


@pytest.mark.parametrize("speed", [50, 250])
def test_driving_into_the_table_stops_at_the_line_of_the_move(speed):
    points = {"A": [480.0, 0.0, 760.0, 180.0, 0.0, 180.0], "B": [480.0, 0.0, 560.0, 180.0, 0.0, 180.0]}
    text = f"10 LOAD (0, 0, 60), 0.8\n20 MOVE A\n30 MOVE B, SPEED {speed}\n40 MOVE A\n"
    session = Session(project_of(text, points))
    result = session.run()
    plant: Any = session.controller.plant
    touched = {name for touch in plant.contacts() for name in touch.names}
    assert "obstacle:table" in touched
    alarm = result.report["alarms"][0]
    assert (alarm["code"], alarm["number"], alarm["category"]) == ("RBL516", 30, 1)
    assert alarm["axis"] in (2, 3, 5)
    z_tool = result.log["X_world_tool_fb"][round(alarm["time_s"] * 1000) - 1, 2, 3]
    assert z_tool > 0.590  # pressed in by less than 10 mm


def test_wrong_payloads_are_found_and_small_errors_are_not():
    found, runs = payload_campaign(3, 1, 0.3)
    assert found == runs
    assert payload_campaign(3, 1, 0.05) == (0, runs)


def test_clean_runs_raise_nothing():
    assert clean_campaign(4, seed=11) == 0
