"""The plan that was checked is the plan that runs: what starts from the same conditions is planned once."""

import pytest

from robolang.execution.dry_run import motion_check
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.syntax.parser import parse
from runtime.motion.motion_planner import MotionPlanner
from runtime.robot.kinematics.kinematics import Kinematics
from tests.programs.runs import ROOT
from tests.robolang.cli.commands import robolang

PALLETISE = ROOT / "shop/palletise.rbl"


def counted(monkeypatch, kind, name):
    """Count the calls of a method from now on."""
    calls = []
    method = getattr(kind, name)

    def counting(self, *args, **named):
        calls.append(args)
        return method(self, *args, **named)

    monkeypatch.setattr(kind, name, counting)
    return calls


@pytest.mark.physics
@pytest.mark.parametrize("physics", [False, True])
def test_a_run_plans_each_move_once_with_one_kinematics(monkeypatch, physics):
    plannings, kinematics = counted(monkeypatch, MotionPlanner, "plan"), counted(monkeypatch, Kinematics, "__init__")
    project = load_project(PALLETISE)
    plans = PlanMemory(project)
    assert motion_check(project, plans) == ()
    session = Session(project, physics=physics, plans=plans)
    assert session.run().ok
    moves = [run for run in session.record.statements if run.planned_s is not None]
    assert len(moves) == len(plannings) == 12
    assert len(kinematics) == 1


def test_a_run_that_begins_elsewhere_plans_what_the_check_has_not(monkeypatch):
    project = load_project(PALLETISE)
    plans = PlanMemory(project)
    motion_check(project, plans)
    plannings = counted(monkeypatch, MotionPlanner, "plan")
    session = Session(project, physics=False, plans=plans)
    session.controller.areas.ina = session.controller.areas.ina + 1e-12
    assert session.run().ok
    assert plannings


@pytest.mark.physics
def test_a_check_of_the_motion_parses_once_with_one_kinematics(monkeypatch):
    kinematics, parsed = counted(monkeypatch, Kinematics, "__init__"), []
    monkeypatch.setattr("robolang.analysis.analysis.parse", lambda *given: parsed.append(given) or parse(*given))
    assert "total" in robolang("check", "--motion", PALLETISE).stdout
    assert len(parsed) == len(kinematics) == 1
