"""The MJCF text and the hand's bodies, without MuJoCo."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.project.builtin import cell_text
from runtime.cell.gripper import FINGERS
from runtime.core.frames import frozen, pose_from_xyzrpy, rotation_from_rpy, skew
from runtime.core.tomlfile import Source
from runtime.plant.hand import finger_body, hand_body, palm_body
from runtime.plant.mjcf import build_mjcf, friction_bias, quaternion
from runtime.robot.model.spec import inertia_defect
from tests.runtime.from_texts import parse_cell

CELL = parse_cell(Source("cell.toml", cell_text()))
ANGLE = st.floats(-np.pi, np.pi)


@given(ANGLE, ANGLE, ANGLE)
def test_quaternion_rebuilds_its_rotation(rx: float, ry: float, rz: float) -> None:
    R = rotation_from_rpy([rx, ry, rz])
    w, v = (q := quaternion(R))[0], q[1:]
    again = (w * w - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * w * skew(v)
    np.testing.assert_allclose(again, R, atol=1e-14)


@pytest.mark.parametrize("turn", [[np.pi, 0, 0], [0, np.pi, 0], [0, 0, np.pi], [np.pi, 0, np.pi / 2]])
def test_quaternion_at_half_turns(turn: list[float]) -> None:
    assert np.linalg.norm(quaternion(rotation_from_rpy(turn))) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("opening", [0.0, 0.04, 0.08])
@pytest.mark.parametrize("tool", [[0, 0, 0.1137, 0, 0, 0], [0.02, -0.03, 0.15, 0.4, -0.2, 1.0]])
def test_palm_and_fingers_are_the_stated_hand(opening: float, tool: list[float]) -> None:
    hand = replace(CELL.hand, X_flange_tool=frozen(pose_from_xyzrpy(tool)), cog=frozen([0.003, 0.001, 0.06]))
    R, p = hand.X_flange_tool[:3, :3], hand.X_flange_tool[:3, 3]
    bodies = [(palm := palm_body(hand)).mass * palm.cog]
    mass = palm.mass
    for side, sign in zip(FINGERS, (1.0, -1.0), strict=True):
        finger = finger_body(hand, side)
        bodies.append(finger.mass * (p + R @ (finger.cog + np.array([0.0, sign * opening / 2.0, 0.0]))))
        mass += finger.mass
    assert mass == pytest.approx(hand.mass, rel=1e-14)
    np.testing.assert_allclose(sum(bodies) / mass, hand.cog, atol=1e-15)
    assert inertia_defect(hand_body(hand, opening).inertia) < 1e-12


def test_friction_bias_and_loss_make_the_published_pair() -> None:
    """Forward the joint feels bias - loss = -Tf, backward bias + loss = +Tb (axis 1 turns against its motor)."""
    joints = ET.fromstring(build_mjcf(CELL.robot, CELL)).findall(".//joint[@frictionloss]")
    bias = friction_bias(CELL.robot)
    for joint, axis, c in zip(joints, CELL.robot.axes, bias, strict=True):
        forward, backward = axis.motor.joint_coulomb_friction
        assert c - float(joint.attrib["frictionloss"]) == pytest.approx(-forward)
        assert c + float(joint.attrib["frictionloss"]) == pytest.approx(backward)
    assert bias[0] == pytest.approx(62.6111 * (0.395 - 0.435) / 2.0)


def test_nothing_in_the_text_reaches_outside_it() -> None:
    tags = {element.tag for element in ET.fromstring(build_mjcf(CELL.robot, CELL)).iter()}
    assert not tags & {"include", "plugin", "extension", "mesh", "asset", "hfield", "texture", "weld"}


def test_no_control_is_clamped_and_no_reset_is_left_on() -> None:
    root = ET.fromstring(build_mjcf(CELL.robot, CELL))
    motors = root.findall("./actuator/motor")
    assert [m.attrib["joint"] for m in motors] == [*(f"j{k}" for k in range(1, 7)), "finger_left", "finger_right"]
    assert all(set(m.attrib) == {"name", "joint", "gear"} and m.attrib["gear"] == "1" for m in motors)
    flag = root.find("./option/flag")
    assert flag is not None
    assert flag.attrib == {"autoreset": "disable"}
