"""The motion that a program will make, planned without making it.

Every statement is lowered and every MOVE planned from where the one before it ends, with the planner that the run
uses. The first refusal ends the check: where the arm would be after it is not known.
"""

from dataclasses import replace

import numpy as np

from robolang import lowering
from robolang.diagnostics import Diagnostic
from robolang.effects import MoveTo, SetHand, SetPayload, SetSeam
from robolang.interpreter import execute
from robolang.project import Project
from runtime.faults import Fault
from runtime.motion.planner import LinePlanner
from runtime.robot.kinematics import Kinematics


def motion_check(project: Project) -> tuple[Diagnostic, ...]:
    """Return what keeps a checked program from being carried out: RBL30x and RBL4xx at their statements."""
    cell = project.cell
    kinematics = Kinematics(cell.robot)
    planner = LinePlanner(cell.robot, kinematics, project.profile)
    q, tracked = np.array(cell.home), False
    for effect in execute(project.program):
        try:
            if isinstance(effect, MoveTo):
                command = replace(lowering.move(effect, project.points, cell, kinematics), tracked=tracked)
                q = np.array(planner.plan(q, command, cell.hand.X_flange_tool).q[-1])
            elif isinstance(effect, SetPayload):
                lowering.payload(effect, cell)
            elif isinstance(effect, SetHand):
                lowering.dwell_s(effect, cell)
            elif isinstance(effect, SetSeam):
                tracked = effect.sensor is not None
        except Fault as fault:
            return (Diagnostic(code=fault.code, message=fault.message, span=effect.span, hint=fault.hint),)
    return ()
