"""A program that comes to a move again from the same place plans it once, before the run as well as in check."""

from robolang.execution.dry_run import motion_check, rehearse
from robolang.project.project import load_project
from runtime.motion.motion_planner import MotionPlanner

TEXT = """
n = 0
ON ERROR GOTO *H
*AGAIN
MOVE POSE(3000, 0, 500, 180, 0, 0)
END
*H n = n + 1
IF n < 50 THEN RESUME
MOVE P1
MOVE P5
"""


def test_a_move_that_is_refused_again_and_again_is_planned_once(tmp_path, monkeypatch):
    planned = []
    plan = MotionPlanner.plan

    def counted(self, *args):
        planned.append(args)
        return plan(self, *args)

    monkeypatch.setattr(MotionPlanner, "plan", counted)
    (tmp_path / "p.rbl").write_text(TEXT)
    project = load_project(tmp_path / "p.rbl")
    assert motion_check(project) == ()
    assert len(planned) == 3
    assert len(rehearse(project).moves) == 2
