"""A suction cup: it seals on flat faces, and holds up to its force and by friction, as a formula says."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.cell.sealing import seals
from runtime.core.frames import Array, pose_from_xyzrpy
from runtime.core.units import DEG, GRAVITY
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.plant.rigid_plant import RigidPlant
from runtime.plant.suction import Suction
from runtime.plant.touches import Bodies
from tests.runtime.plant.test_plant_grasp import CELL, Rig, shake, slip

pytestmark = pytest.mark.physics

RADIUS = 0.015
BOX = replace(
    CELL.parts[0], size=np.array([0.06, 0.04, 0.04]), X_world_part=pose_from_xyzrpy([0.48, -0.22, 0.62, 0, 0, 0])
)
CAN = replace(BOX, shape="cylinder", size=np.array([0.04, 0.04, 0.04]))
WEIGHT = BOX.mass * GRAVITY


def cell(part=BOX, force=100.0, **changes):
    """The built-in cell with a cup of 30 mm; the top of the part is at P1."""
    pad = np.array([RADIUS, RADIUS, 2.0 * RADIUS])
    hand = replace(CELL.hand, kind="suction", stroke=0.0, grip_force=force, pad=pad)
    return replace(CELL, hand=hand, parts=(replace(part, **changes),))


def over(x_mm: float, y_mm: float, gap_mm: float, *turn_deg: float) -> Array:
    """The tool over the middle of the top of a part that is at the origin."""
    return pose_from_xyzrpy([x_mm / 1e3, y_mm / 1e3, 0.02 + gap_mm / 1e3, np.pi, 0.0, 0.0]) @ pose_from_xyzrpy(
        [0.0, 0.0, 0.0, *(np.array(turn_deg or (0.0, 0.0, 0.0)) * DEG)]
    )


@pytest.mark.parametrize(
    ("part", "X_part_tool", "expected"),
    [
        (BOX, over(0, 0, 0), True),
        (BOX, over(14.9, 4.9, 0.9, 0, 0, 30), True),
        (BOX, over(15.1, 0, 0), False),
        (BOX, over(0, 5.1, 0), False),
        (BOX, over(0, 0, 1.1), False),
        (BOX, over(0, 0, -1.9), True),
        (BOX, over(0, 0, -2.1), False),
        (BOX, over(0, 0, 0, 3.5, 0, 0), True),
        (BOX, over(0, 0, 0, 4.5, 0, 0), False),
        (BOX, over(0, 0, np.nan), False),
        (CAN, over(0, 0, 0), True),
        (CAN, over(3.5, 3.5, 0), True),
        (CAN, over(5.1, 0, 0), False),
        (CAN, pose_from_xyzrpy([0.0, 0.02, 0.0, 90 * DEG, 0.0, 0.0]), False),
        (BOX, pose_from_xyzrpy([0.0, 0.02, 0.0, 90 * DEG, 0.0, 0.0]), True),
        (BOX, pose_from_xyzrpy([0.0, -0.02, 0.0, 90 * DEG, 0.0, 0.0]), False),
    ],
)
def test_a_cup_seals_where_its_whole_rim_is_on_a_flat_face(part, X_part_tool, expected):
    X_world_part = pose_from_xyzrpy([0.3, -0.2, 0.5, 0.4, -0.7, 2.0])
    assert seals(cell().hand, X_world_part @ X_part_tool, part, X_world_part) is expected


@pytest.mark.parametrize("part", [BOX, CAN], ids=["box", "can"])
def test_what_is_held_stays_under_the_cup(part):
    """Lift, then swings with more than 3 m/s2 and all joints turning."""
    rig = Rig(cell(part))
    rig.pick()
    assert (rig.plant.hand().holding, rig.plant.hand().opening) == ("part", 0.0)
    held = rig.part_in_tool()
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    moved, turned, acceleration = shake(rig, 2.0)
    assert acceleration > 3.0
    assert (moved < 5e-4, turned < 0.3 * DEG) == (True, True), (moved, turned / DEG)
    assert slip(held, rig.part_in_tool())[0] < 5e-4
    rig.plant.close_hand(False)
    rig.hold(0.4)
    assert rig.plant.hand().holding is None
    assert rig.plant.parts()["part"][2, 3] == pytest.approx(0.62, abs=2e-3)


@pytest.mark.parametrize(("share", "lifted"), [(0.97, False), (1.03, True)])
def test_a_part_is_lifted_if_the_force_is_more_than_its_weight(share, lifted):
    rig = Rig(cell(force=share * WEIGHT))
    rig.pick()
    rig.go(480.0, -220.0, 660.0, seconds=2.0)
    assert (rig.plant.hand().holding is not None) is lifted
    assert rig.plant.parts()["part"][2, 3] == pytest.approx(0.64 if lifted else 0.62, abs=2e-3)


@pytest.mark.parametrize(("share", "held"), [(0.8, False), (1.2, True)])
def test_a_part_slides_off_if_friction_is_less_than_what_accelerates_it(share, held):
    """At most 5.77 d / T^2 sideways; what presses is the force less the weight."""
    shear = BOX.mass * 5.77 * 0.2 / 0.5**2
    rig = Rig(cell(force=60.0, friction=share * shear / (60.0 - WEIGHT)))
    rig.pick()
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0, seconds=1.5)
    before = rig.part_in_tool()
    rig.go(480.0, -20.0, 850.0, seconds=0.5)
    assert (slip(before, rig.part_in_tool())[0] < 1e-3) is held


def test_what_the_part_is_pulled_with_pushes_the_hand():
    """Force and moment about any point add up to nothing."""
    rng = np.random.default_rng(2)
    X_world_tool = pose_from_xyzrpy([*rng.uniform(-1.0, 1.0, 3), 0.3, -0.4, 1.9])
    X_world_part = X_world_tool @ np.linalg.inv(over(5.0, 2.0, 0.2))
    bodies = Bodies(
        names=("part",),
        size=BOX.size[None],
        p=X_world_part[None, :3, 3],
        R=X_world_part[None, :3, :3],
        p_tool=X_world_tool[:3, 3],
        R_tool=X_world_tool[:3, :3],
        pad_length=0.03,
        holders=1,
    )
    forces, centres = np.zeros((3, 6)), rng.uniform(-1.0, 1.0, (3, 3))
    suction = Suction(cell(), bodies, forces, 1, centres)
    suction.pull(True)
    assert suction.held() == ["part"]
    assert forces[2, :3] == pytest.approx(-100.0 * X_world_tool[:3, 2])
    assert forces[1, :3] == pytest.approx(-forces[2, :3])
    moments = [forces[k, 3:] + np.cross(p, forces[k, :3]) for k, p in enumerate(centres)]
    assert sum(moments) == pytest.approx(np.zeros(3), abs=1e-9)
    suction.pull(False)
    assert (suction.held(), forces.any()) == ([], False)


def test_a_restored_state_goes_on_to_the_bit():
    rig = Rig(cell())
    rig.pick()
    twin = MujocoPlant(rig.cell.robot, rig.cell)
    twin.restore(rig.plant.snapshot())
    for _ in range(20):
        for plant in (rig.plant, twin):
            assert plant.step(np.zeros(6))
    assert twin.gripped() == rig.plant.gripped() == ("part",)
    assert twin.moved().tobytes() == rig.plant.moved().tobytes()


@pytest.mark.parametrize(("gap", "held"), [(0.5e-3, "part"), (1.5e-3, None)])
def test_the_ideal_arm_takes_what_the_cup_seals_on(gap, held):
    """At home the tool is 200 mm over P1."""
    plant = RigidPlant(CELL.robot, cell(X_world_part=pose_from_xyzrpy([0.48, -0.22, 0.82 - gap, 0, 0, 0])))
    plant.close_hand(True)
    assert plant.hand().holding == held
    assert plant.moved().shape == (9,)
