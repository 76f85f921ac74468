"""What a point depends on, on three robots: a cell with a frame that is turned and a tool that is bent."""

from dataclasses import replace

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import Point, PointStore
from robolang.project.project import builtin_cell
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics

PALLET = (400.0, -200.0, 150.0, 0.0, 0.0, 30.0)
TORCH = (20.0, 0.0, 180.0, 0.0, 35.0, 0.0)


def surroundings(*points: Point, robot: str = "puma560", X_flange_tool=None) -> Surroundings:
    """The built-in cell with another robot, a frame ``pallet`` and a tool ``torch``; the hand's tool is in use."""
    cell = builtin_cell()
    spec = load_builtin(robot)
    cell = replace(
        cell,
        robot=spec,
        home=cell.home if robot == "puma560" else 0.5 * (spec.lower + spec.upper),
        frames={**cell.frames, "pallet": lowering.pose_si(PALLET)},
        tools={**cell.tools, "torch": lowering.pose_si(TORCH)},
    )
    return Surroundings(
        points=PointStore(path="p.points.toml", points={point.name.upper(): point for point in points}),
        cell=cell,
        kinematics=Kinematics(spec),
        X_flange_tool=cell.hand.X_flange_tool if X_flange_tool is None else X_flange_tool,
        q_last=np.array(cell.home),
    )


def torch(around: Surroundings) -> Surroundings:
    """The same with the tool ``torch`` in use."""
    return replace(around, X_flange_tool=around.cell.tools["torch"])


def without_closed_form(around: Surroundings) -> Surroundings:
    """The same with an arm whose J4 is out of line, so that only Newton's method solves its poses."""
    spec = around.cell.robot
    placement = np.array(spec.axes[3].placement)
    c, s = np.cos(0.2), np.sin(0.2)
    placement[:3, :3] = placement[:3, :3] @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    bent = replace(spec, opw=None, axes=(*spec.axes[:3], replace(spec.axes[3], placement=placement), *spec.axes[4:]))
    return replace(around, cell=replace(around.cell, robot=bent), kinematics=Kinematics(bent))
