"""Arms with gear springs for the tests: the Manutec in its cell, whole or with all axes but one held fast."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from runtime.cell.cell import CellSpec
from runtime.core.frames import frozen
from runtime.plant.hand import hand_body
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from tests.runtime.from_texts import load_cell

CELL = load_cell(Path(__file__).parents[3] / "programs" / "manutec_pick_and_place.cell.toml")
SPEC = CELL.robot
LOCKED = 1e9
"""Rotor inertia at the joint of an axis that is to stand still, kg m2."""


def with_motors(spec: RobotSpec, **changes: list) -> RobotSpec:
    """Return the robot with other motor values, one per axis."""
    axes = [
        replace(axis, motor=replace(axis.motor, **{name: values[index] for name, values in changes.items()}))
        for index, axis in enumerate(spec.axes)
    ]
    return replace(spec, axes=tuple(axes))


def frictionless(spec: RobotSpec) -> RobotSpec:
    return with_motors(spec, viscous_friction=[0.0] * spec.n, coulomb_friction=[(0.0, 0.0)] * spec.n)


def undamped(spec: RobotSpec) -> RobotSpec:
    return with_motors(frictionless(spec), damping=[0.0] * spec.n)


def only(spec: RobotSpec, axis: int) -> RobotSpec:
    """Return the frictionless robot with one axis that moves and twists; huge rotors hold the others, all rigid."""
    motors = [item.motor for item in spec.axes]
    return with_motors(
        frictionless(spec),
        rotor_inertia=[m.rotor_inertia if k == axis else LOCKED / m.gear_ratio**2 for k, m in enumerate(motors)],
        stiffness=[m.stiffness if k == axis else math.inf for k, m in enumerate(motors)],
    )


def empty(spec: RobotSpec = SPEC, home_deg: list | None = None) -> CellSpec:
    """Return the cell of a robot with nothing lying about."""
    home = CELL.home if home_deg is None else frozen(np.radians(home_deg))
    return replace(CELL, robot=spec, parts=(), obstacles=(), home=home)


def true_arm(spec: RobotSpec = SPEC) -> ArmModel:
    """Return Pinocchio's arm with the open hand as it really is."""
    hand, model = hand_body(CELL.hand, CELL.hand.stroke), ArmModel(spec)
    model.set_payload(Payload(mass=hand.mass, cog=hand.cog, inertia=hand.inertia))
    return model
