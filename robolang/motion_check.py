"""The motion that a program will make, planned without making it.

Every statement is lowered and every MOVE planned from where the one before it ends, with the planner that the run
uses. The first refusal ends the check: where the arm would be after it is not known.
"""

import numpy as np

from robolang import lowering
from robolang.diagnostics import Diagnostic
from robolang.effects import Effect, MoveTo, SetPayload
from robolang.interpreter import execute
from robolang.project import Project
from runtime.faults import Fault
from runtime.frames import Array
from runtime.motion.planner import LinePlanner
from runtime.robot.kinematics import Kinematics


def motion_check(project: Project) -> tuple[Diagnostic, ...]:
    """Return what keeps a checked program from being carried out: RBL30x and RBL4xx at their statements."""
    cell = project.cell
    kinematics = Kinematics(cell.robot)
    planner = LinePlanner(cell.robot, kinematics, project.profile)
    q = np.array(cell.home)
    for effect in execute(project.program):
        try:
            q = _end_of(effect, q, project, planner, kinematics)
        except Fault as fault:
            return (Diagnostic(code=fault.code, message=fault.message, span=effect.span, hint=fault.hint),)
    return ()


def _end_of(effect: Effect, q: Array, project: Project, planner: LinePlanner, kinematics: Kinematics) -> Array:
    cell = project.cell
    if isinstance(effect, MoveTo):
        command = lowering.move(effect, project.points, cell, kinematics)
        return np.array(planner.plan(q, command, cell.hand.X_flange_tool).q[-1])
    if isinstance(effect, SetPayload):
        lowering.payload(effect, cell)
    else:
        lowering.dwell_s(effect, cell)
    return q
