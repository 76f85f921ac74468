"""Where the arm of a live controller is, in mm and deg: what ``pos`` and the screen show."""

from dataclasses import dataclass

import numpy as np

from robolang.execution import lowering
from robolang.execution.executor import Executor
from robolang.project.project import Project
from robolang.values.poses import Frame, Place, Six
from runtime.control.controller import Controller
from runtime.core.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmView:
    """Commanded joints with their ranges, in ``units`` (deg, mm of an axis that slides), the tool pose in the frame in
    force and in the world (mm, deg)."""

    joints: tuple[float, ...]
    ranges: tuple[tuple[float, float], ...]
    units: tuple[str, ...]
    tool_in_frame: Six
    tool_in_world: Six
    frame: Frame
    tool: Frame
    configuration: str


def view(project: Project, controller: Controller, executor: Executor) -> ArmView:
    """Return where the arm is commanded to be."""
    q: Array = np.array(controller.areas.ina)
    robot, kinematics = project.cell.robot, controller.kinematics
    world = executor.world
    # as the language takes a place, so that the prompt shows the numbers that HERE and P.X would give
    place = Place(joints=tuple(float(value) for value in q / robot.units))
    return ArmView(
        joints=tuple(float(value) for value in q / robot.units),
        ranges=tuple(
            (float(low), float(high))
            for low, high in zip(robot.lower / robot.units, robot.upper / robot.units, strict=True)
        ),
        units=tuple(axis.kind.unit for axis in robot.axes),
        tool_in_frame=lowering.components(place, executor.frame, world.around),
        tool_in_world=lowering.components(place, "", world.around),
        frame=executor.frame,
        tool=world.tool,
        configuration=str(kinematics.branch_of(q)) if kinematics.closed_form else "",
    )
