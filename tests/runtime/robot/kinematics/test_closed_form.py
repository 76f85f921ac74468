"""The closed form is found where there is one, and only there."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.frames import inverse, pose, rotation_about, rotation_from_rpy
from runtime.core.tomlfile import Source
from runtime.robot.files.importer import parse_model
from runtime.robot.kinematics import opw
from runtime.robot.kinematics.closed_form import find_opw
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import BRANCHES, PlacedOpw
from runtime.robot.model.axis_kind import REVOLUTE
from tests.campaign import examples
from tests.runtime.robot.models import chain

Y, Z = np.eye(3)[1:]


class Axis:
    kind = REVOLUTE

    def __init__(self, placement):
        self.placement = placement


def axes_of(params, X_before, X_behind, slides, rolls):
    """The chain of an arm with these parameters, drawn line by line: frames slid and rolled about each joint."""
    a, signs = params, params.signs
    inner = [
        pose([0, 0, a.c1]),
        pose([a.a1, a.b, 0]),
        pose([0, 0, a.c2]),
        pose([a.a2, 0, a.c3]),
        np.eye(4),
        np.eye(4),
    ]
    directions = [Z, Y, Y, Z, Y, Z]
    axes, carried = [], X_before
    for X, direction, sign, offset, slide, roll in zip(
        inner, directions, signs, params.offsets, slides, rolls, strict=True
    ):
        turn = pose(rotation=rotation_about(direction, offset))
        to_z = rotation_about([1, 0, 0], -np.pi / 2) if direction is Y else np.eye(3)
        flip = np.eye(3) if sign > 0 else np.diag([1.0, -1.0, -1.0])
        X_axis = pose(slide * direction, to_z @ flip @ rotation_about(Z, roll))
        axes.append(Axis(carried @ X @ turn @ X_axis))
        carried = inverse(X_axis)
    return axes, carried @ pose([0, 0, a.c4]) @ X_behind


def chain_forward(axes, X_last_flange, q):
    X = np.eye(4)
    for axis, angle in zip(axes, q, strict=True):
        X = X @ axis.placement @ pose(rotation=rotation_about(Z, angle))
    return X @ X_last_flange


def same_numbers(found, params):
    for name in ("a1", "a2", "b", "c1", "c2", "c3", "c4"):
        assert getattr(found, name) == pytest.approx(getattr(params, name), abs=1e-12)
    np.testing.assert_array_equal(found.signs, params.signs)
    np.testing.assert_allclose(opw.wrapped(found.offsets - params.offsets), 0.0, atol=1e-12)
    assert not isinstance(found, PlacedOpw)


def test_the_puma_and_the_irb2400_get_their_published_parameters(puma, irb2400):
    for spec in (puma, irb2400):
        same_numbers(find_opw(spec.axes, spec.X_last_flange), spec.opw)


angles = st.floats(-3.0, 3.0, allow_subnormal=False)
sixes = st.tuples(*[angles] * 6)


@examples(60)
@given(before=sixes, behind=sixes, slides=sixes, rolls=sixes, seed=st.integers(0, 10**6))
def test_arms_in_any_frames_are_solved_in_closed_form(params, before, behind, slides, rolls, seed):
    X_before, X_behind = (pose(x[:3], rotation_from_rpy(x[3:])) for x in (before, behind))
    axes, X_last = axes_of(params, X_before, X_behind, slides, rolls)
    found = find_opw(axes, X_last)
    assert found is not None
    q = np.random.default_rng(seed).uniform(-3.0, 3.0, 6)
    X = chain_forward(axes, X_last, q)
    np.testing.assert_allclose(opw.forward(found, q), X, atol=1e-10)
    rows = opw.inverse(found, X)
    assert np.isfinite(rows).all(axis=1).any()
    for row in rows[np.isfinite(rows).all(axis=1)]:
        np.testing.assert_allclose(chain_forward(axes, X_last, row), X, atol=1e-10)
    assert min(np.abs(opw.wrapped(row - q)).max() for row in rows[np.isfinite(rows).all(axis=1)]) < 1e-5


@pytest.mark.parametrize("joint", range(6))
@pytest.mark.parametrize("tilt", [1e-6, 1e-3, 0.3])
def test_an_arm_that_is_bent_anywhere_has_none(irb2400, joint, tilt):
    axes = [Axis(axis.placement) for axis in irb2400.axes]
    bend = pose(rotation=rotation_about(np.array([0.6, 0.8, 0.0]), tilt))
    axes[joint].placement = axes[joint].placement @ bend
    found = find_opw(axes, irb2400.X_last_flange)
    if joint == 0:  # another base: the same arm
        assert isinstance(found, PlacedOpw)
    else:
        assert found is None


def test_an_offset_wrist_has_none(irb2400):
    axes = [Axis(axis.placement) for axis in irb2400.axes]
    axes[4].placement = pose([1e-3, 0.0, 0.0]) @ axes[4].placement
    assert find_opw(axes, irb2400.X_last_flange) is None


def test_an_urdf_of_an_industrial_arm_is_solved_branch_by_branch():
    y, x, z = (0, 1, 0), (1, 0, 0), (0, 0, 1)
    none = (0, 0, 0)
    frames = [
        (none, none, z),
        ((0.1, 0, 0.615), none, y),
        ((0, 0, 0.705), none, y),
        ((0.258, 0, 0.135), none, x),
        ((0.497, 0, 0), none, y),
        (none, none, x),
    ]
    arm = parse_model(Source("irb.urdf", chain(frames, ((0.085, 0, 0), (0, np.pi / 2, 0)))))
    kinematics = Kinematics(arm)
    assert kinematics.closed_form
    assert (arm.opw.a1, arm.opw.a2, arm.opw.c2, arm.opw.c3) == pytest.approx((0.1, -0.135, 0.705, 0.755), abs=1e-12)
    q = np.array([0.3, 0.2, -0.4, 0.5, 0.6, -0.7])
    branch = kinematics.branch_of(q)
    assert branch in BRANCHES
    np.testing.assert_allclose(kinematics.inverse_branch(kinematics.forward(q), branch, q), q, atol=1e-9)
    rounded = parse_model(Source("irb.urdf", chain(frames, ((0.085, 0, 0), (0, 1.5708, 0)))))
    assert rounded.opw is not None  # only the flange is turned: the arm keeps its closed form
    frames[1] = ((0.1, 0, 0.615), (3.7e-6, 0, 0), y)
    assert parse_model(Source("irb.urdf", chain(frames))).opw is None
