"""The grasp by friction: what is held stays where it is in the hand, what is not held falls or stays behind.

The arm is driven by a computed-torque controller that knows everything, so that what is measured is the grasp.
"""

from dataclasses import replace

import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.cell.cell import CellSpec
from runtime.cell.gripper import FINGERS
from runtime.core.frames import Array, inverse, pose_from_xyzrpy, rotation_angle
from runtime.core.tomlfile import Source
from runtime.core.units import DEG
from runtime.plant.hand import hand_body
from runtime.plant.inertia import box_inertia
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from tests.runtime.from_texts import parse_cell

pytestmark = pytest.mark.physics

CELL = parse_cell(Source("cell.toml", cell_text()))
SPEC = CELL.robot
ROTORS = spec_rotors(SPEC)
VISCOUS = np.array([axis.motor.joint_viscous_friction for axis in SPEC.axes])
DRY = np.array([axis.motor.joint_coulomb_friction for axis in SPEC.axes])

FINGER_GEOMS = {f"{kind}_{side}" for kind in ("pad", "shank") for side in FINGERS}


def about(mass: float, inertia: Array, r: Array) -> Array:
    return inertia + mass * (float(r @ r) * np.eye(3) - np.outer(r, r))


def true_load(cell: CellSpec, with_part: bool) -> Payload:
    hand, part = hand_body(cell.hand), cell.parts[0]
    if not with_part:
        return Payload(mass=hand.mass, cog=hand.cog, inertia=hand.inertia)
    p = cell.hand.X_flange_tool[:3, 3]
    mass = hand.mass + part.mass
    cog = (hand.mass * hand.cog + part.mass * p) / mass
    inertia = about(hand.mass, hand.inertia, hand.cog - cog)
    inertia = inertia + about(part.mass, box_inertia(part.mass, part.size), p - cog)
    return Payload(mass=mass, cog=cog, inertia=inertia)


class Rig:
    """A plant with a controller that tracks joint trajectories closely."""

    def __init__(self, cell: CellSpec = CELL) -> None:
        self.cell, self.plant, self.model = cell, MujocoPlant(cell.robot, cell), ArmModel(cell.robot)
        self.kinematics = Kinematics(cell.robot)
        self.at = np.array(cell.home)
        self.carries(False)

    def carries(self, part: bool) -> None:
        self.model.set_payload(true_load(self.cell, part))

    def track(self, q: Array, dq: Array, ddq: Array) -> None:
        plant = self.plant
        wanted = ddq + 1600.0 * (q - plant.q) + 80.0 * (dq - plant.dq)
        dry = np.where(dq > 0.0, DRY[:, 0], -DRY[:, 1]) * np.tanh(np.abs(dq) / 1e-3)
        tau = self.model.torque(plant.q.copy(), plant.dq.copy(), wanted) + ROTORS * wanted
        assert plant.step(tau + VISCOUS * plant.dq + dry)

    def hold(self, seconds: float) -> None:
        zero = np.zeros(SPEC.n)
        for _ in range(round(seconds / self.plant.tick_s)):
            self.track(self.at, zero, zero)

    def go(self, x_mm: float, y_mm: float, z_mm: float, seconds: float = 0.6) -> None:
        """Move the tool point there, pointing down, joints interpolated by a fifth-order polynomial."""
        X = pose_from_xyzrpy([x_mm / 1e3, y_mm / 1e3, z_mm / 1e3, np.pi, 0.0, np.pi])
        X_flange = X @ inverse(self.cell.hand.X_flange_tool)
        branch = self.kinematics.branch_of(self.cell.home)
        start, end = self.at, self.kinematics.inverse_branch(X_flange, branch, near=self.at)
        ticks = round(seconds / self.plant.tick_s)
        for s in np.arange(1, ticks + 1) / ticks:
            way = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            speed, bend = 30.0 * s**2 * (1.0 - s) ** 2, 60.0 * s * (1.0 - 3.0 * s + 2.0 * s**2)
            self.track(start + way * (end - start), speed * (end - start) / seconds, bend * (end - start) / seconds**2)
        self.at = end

    def close(self, closed: bool) -> None:
        self.plant.close_hand(closed)
        self.hold(self.cell.hand.dwell)

    def part_in_tool(self) -> Array:
        return inverse(self.plant.X_world_tool()) @ self.plant.parts()["part"]

    def pick(self) -> None:
        """Go down to the part and close the hand around it."""
        self.go(480.0, -220.0, 640.0)
        self.close(True)


def slip(before: Array, after: Array) -> tuple[float, float]:
    """Return how far (m) and by which angle (rad) the part has moved in the hand."""
    return float(np.linalg.norm(after[:3, 3] - before[:3, 3])), rotation_angle(before[:3, :3], after[:3, :3])


def shake(rig: Rig, seconds: float) -> tuple[float, float, float]:
    """Swing all joints; returns the largest slip (m, rad) and the largest acceleration of the tool point, m/s2."""
    swing = np.array([4.5, 3.0, 3.0, 8.0, 8.0, 20.0]) * DEG
    w = 2.0 * np.pi * np.array([1.1, 0.9, 1.2, 1.2, 1.4, 1.0])
    start, held, tick = rig.at, rig.part_in_tool(), rig.plant.tick_s
    slips, points = [], []
    for k in range(round(seconds / tick)):
        t = k * tick
        g = min(t / 0.5, (seconds - t) / 0.5, 1.0)
        g = g * g * (3.0 - 2.0 * g)
        rig.track(start + g * swing * np.sin(w * t), g * swing * w * np.cos(w * t), -g * swing * w * w * np.sin(w * t))
        if k % 10 == 0:
            slips.append(slip(held, rig.part_in_tool()))
            points.append(rig.plant.X_world_tool()[:3, 3])
    acceleration = np.linalg.norm(np.diff(points, 2, axis=0), axis=1) / (10 * tick) ** 2
    moved, turned = np.max(slips, axis=0)
    return float(moved), float(turned), float(acceleration.max())


def test_a_held_part_stays_where_it_is_in_the_hand() -> None:
    """Lift, then 5 s of swinging with up to 4 m/s2 and all joints turning: under 0.2 mm and 0.1 deg."""
    rig = Rig()
    rig.pick()
    assert rig.plant.hand().holding == "part"
    assert rig.plant.hand().opening == pytest.approx(CELL.parts[0].size[1], abs=1e-4)
    held = rig.part_in_tool()
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    assert rig.plant.parts()["part"][2, 3] == pytest.approx(0.85, abs=2e-3)
    moved, turned, acceleration = shake(rig, 5.0)
    assert acceleration > 3.0
    assert (moved < 2e-4, turned < 0.1 * DEG) == (True, True), (moved, turned / DEG)
    moved, turned = slip(held, rig.part_in_tool())
    assert (moved < 2e-4, turned < 0.1 * DEG) == (True, True), (moved, turned / DEG)


def test_an_opened_hand_drops_the_part() -> None:
    rig = Rig()
    rig.pick()
    rig.carries(True)
    rig.go(480.0, -220.0, 700.0)
    rig.plant.close_hand(False)
    rig.carries(False)
    assert rig.plant.hand().holding is None
    rig.hold(0.5)
    assert rig.plant.parts()["part"][2, 3] == pytest.approx(0.64, abs=1e-3)
    assert rig.plant.hand().opening == pytest.approx(CELL.hand.stroke, abs=1e-4)


def test_a_hand_that_closes_beside_the_part_takes_nothing() -> None:
    rig = Rig()
    before = rig.plant.parts()["part"]
    rig.go(560.0, -220.0, 640.0)
    rig.close(True)
    assert (rig.plant.hand().closed, rig.plant.hand().holding) == (True, None)
    assert rig.plant.hand().opening == pytest.approx(0.0, abs=1e-4)
    rig.go(560.0, -220.0, 800.0)
    np.testing.assert_allclose(rig.plant.parts()["part"], before, atol=5e-5)


def test_a_slippery_part_slides_out() -> None:
    """2 mu F = 12 N is less than the weight of 14.7 N: what holds the part is friction, and nothing else."""
    part = replace(CELL.parts[0], friction=0.05)
    rig = Rig(replace(CELL, parts=(part,)))
    rig.pick()
    rig.go(480.0, -220.0, 850.0)
    rig.hold(0.5)
    assert rig.plant.parts()["part"][2, 3] < 0.75


@pytest.mark.parametrize(("friction", "aligned"), [(0.3, True), (0.6, False)])
def test_a_part_askew_turns_between_the_pads_or_jams(friction: float, aligned: bool) -> None:
    """The friction cone decides: the line through the edges of 20 mm pads, 40 mm apart, is 26.6 deg off the normal.

    A part that stands askew by 5 deg touches one edge of each pad. With mu = 0.3 (a cone of 16.7 deg) it must
    turn flat, with mu = 0.6 (31 deg) the two contacts hold each other and it stays askew.
    """
    askew = pose_from_xyzrpy([0.48, -0.22, 0.64, 0.0, 0.0, 5.0 * DEG])
    part = replace(CELL.parts[0], X_world_part=askew, friction=friction)
    rig = Rig(replace(CELL, parts=(part,)))
    rig.pick()
    angle = np.arcsin(abs(rig.part_in_tool()[1, 0])) / DEG
    assert angle < 0.1 if aligned else angle > 4.0
    assert rig.plant.hand().holding == "part"


def test_the_table_stops_the_hand() -> None:
    """Told to go 30 mm below the top of the table, the fingers stay on it and carry what the arm pushes with."""
    rig = Rig()
    rig.go(480.0, 150.0, 700.0)
    free = rig.plant.contacts()
    rig.go(480.0, 150.0, 570.0)
    on_table = [touch for touch in rig.plant.contacts() if touch.names[0] == "obstacle:table"]
    assert {touch.names[1] for touch in free} == {"part:part"}
    assert {touch.names[1] for touch in on_table} - {"part:part"} <= FINGER_GEOMS
    assert sum(touch.force for touch in on_table) > 100.0
    tip = rig.plant.X_world_tool()[2, 3] - CELL.hand.pad[2] / 2.0
    assert tip == pytest.approx(0.6, abs=2e-3)
