from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from runtime.core.frames import frozen, pose, rotation_about
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import BRANCHES, Branch, wrapped
from runtime.robot.model.spec import RobotSpec
from tests.campaign import size
from tests.runtime.robot.arms import DEG, Irb2400

HOME = np.array([10, 60, -210, -20, 40, 30]) * DEG


@pytest.fixture(scope="module")
def puma_kinematics(puma) -> Kinematics:
    return Kinematics(puma)


@pytest.fixture(scope="module", params=["puma", "irb2400"])
def kinematics(request) -> Kinematics:
    return Kinematics(request.getfixturevalue(request.param))


class PinModel:
    """The arm in Pinocchio, from the placements alone."""

    def __init__(self, spec: RobotSpec) -> None:
        self.model, parent = pin.Model(), 0
        for axis in spec.axes:
            parent = self.model.addJoint(parent, pin.JointModelRZ(), pin.SE3(axis.placement), axis.name)
        flange = pin.Frame("flange", parent, 0, pin.SE3(spec.X_last_flange), pin.FrameType.OP_FRAME)
        self.flange = self.model.addFrame(flange)
        self.data = self.model.createData()

    def forward(self, q):
        pin.framesForwardKinematics(self.model, self.data, q)
        return self.data.oMf[self.flange].homogeneous.copy()

    def jacobian(self, q):
        return pin.computeFrameJacobian(self.model, self.data, q, self.flange, pin.LOCAL_WORLD_ALIGNED).copy()


def joints(seed, count):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 6))


def within_limits(spec, seed, count):
    return np.random.default_rng(seed).uniform(spec.lower, spec.upper, (count, 6))


# --- forward and Jacobian --------------------------------------------------------------------------------------------


def test_forward_and_jacobian_are_pinocchios(kinematics):
    model = PinModel(kinematics.spec)
    for q in joints(1, 50):
        np.testing.assert_allclose(kinematics.forward(q), model.forward(q), rtol=0, atol=3e-15)
        np.testing.assert_allclose(kinematics.jacobian(q), model.jacobian(q), rtol=0, atol=5e-15)


def test_forward_of_the_irb2400_is_the_data_sheets(irb2400):
    q = joints(2, 20)
    expected = np.array([Irb2400.forward(one) for one in q])
    np.testing.assert_allclose(Kinematics(irb2400).forward(q), expected, rtol=0, atol=4e-15)


def test_jacobian_is_the_derivative_of_forward(kinematics):
    step = 1e-6
    for q in joints(3, 20):
        J = kinematics.jacobian(q)
        for i in range(6):
            ahead, behind = (kinematics.forward(q + sign * step * np.eye(6)[i]) for sign in (1.0, -1.0))
            spin = (ahead - behind)[:3, :3] / (2.0 * step) @ kinematics.forward(q)[:3, :3].T
            expected = [*(ahead - behind)[:3, 3] / (2.0 * step), spin[2, 1], spin[0, 2], spin[1, 0]]
            np.testing.assert_allclose(J[:, i], expected, rtol=0, atol=1e-9)


def test_the_last_frame_counts(puma):
    long_hand = replace(puma, X_last_flange=frozen(pose([0.1, 0.0, 0.2])))
    np.testing.assert_allclose(
        Kinematics(long_hand).forward(HOME), Kinematics(puma).forward(HOME) @ pose([0.1, 0.0, 0.2]), atol=1e-15
    )


def test_many_at_once_are_each_alone(kinematics):
    q = joints(4, 12).reshape(3, 4, 6)
    X, J = kinematics.forward(q), kinematics.jacobian(q)
    assert (X.shape, J.shape) == ((3, 4, 4, 4), (3, 4, 6, 6))
    np.testing.assert_allclose(X[2, 3], kinematics.forward(q[2, 3]), rtol=0, atol=1e-15)
    np.testing.assert_allclose(J[1, 2], kinematics.jacobian(q[1, 2]), rtol=0, atol=1e-15)
    found = kinematics.inverse_branch(X, BRANCHES[0], near=q)
    assert found.shape == (3, 4, 6)
    np.testing.assert_allclose(found[2, 3], kinematics.inverse_branch(X[2, 3], BRANCHES[0], near=q[2, 3]), atol=1e-14)


# --- inverse ---------------------------------------------------------------------------------------------------------


def test_joint_angles_within_limits_come_back(kinematics):
    q = within_limits(kinematics.spec, 5, size(500, 100))
    q = q[np.abs(np.sin(q[:, 4])) > 0.05]
    for one in q:
        X = kinematics.forward(one)
        found = {s.branch: s for s in kinematics.solutions(X, near=one)}
        for solution in found.values():
            np.testing.assert_allclose(kinematics.forward(solution.q), X, rtol=0, atol=1e-12)
        same = found[kinematics.branch_of(one)]
        np.testing.assert_allclose(same.q, one, rtol=0, atol=1e-9)
        expected = min((one - kinematics.spec.lower).min(), (kinematics.spec.upper - one).min())
        assert same.limit_margin == pytest.approx(expected, abs=1e-9)
        assert same.limit_margin > -1e-9


def test_solutions_are_listed_in_order_and_named_rightly(puma_kinematics):
    found = puma_kinematics.solutions(puma_kinematics.forward(HOME))
    assert [s.branch for s in found] == list(BRANCHES)
    assert [puma_kinematics.branch_of(s.q) for s in found] == list(BRANCHES)
    assert not found[0].q.flags.writeable


def test_a_pose_out_of_reach_has_no_solution(puma_kinematics):
    assert puma_kinematics.solutions(pose([2.0, 0.0, 0.5])) == []
    assert np.isnan(puma_kinematics.inverse_branch(pose([2.0, 0.0, 0.5]), BRANCHES[3])).all()


def test_joints_are_turned_into_their_range(puma_kinematics):
    # J2 of the Puma goes from -45 to 225 deg, J3 from -225 to 45: 200 and -200 are inside, -160 and 160 are not
    q = np.array([10, 200, -200, 150, 50, 30]) * DEG
    X = puma_kinematics.forward(q)
    branch = puma_kinematics.branch_of(q)
    np.testing.assert_allclose(puma_kinematics.inverse_branch(X, branch), q, atol=1e-12)
    far = puma_kinematics.inverse_branch(X, branch, near=q - 2.0 * np.pi)
    np.testing.assert_allclose(far, q - 2.0 * np.pi, atol=1e-12)


@pytest.mark.parametrize(("near_deg", "expected_deg"), [(None, -160), (190, 200), (-100, -160), (900, 200)])
def test_of_two_turns_in_range_the_nearer_is_taken(puma_kinematics, near_deg, expected_deg):
    # J6 of the Puma goes from -266 to 266 deg: both -160 and 200 are inside
    q = HOME.copy()
    q[5] = 200 * DEG
    near = None if near_deg is None else np.array([*HOME[:5], near_deg * DEG])
    branch = puma_kinematics.branch_of(q)
    (same,) = [s for s in puma_kinematics.solutions(puma_kinematics.forward(q), near) if s.branch == branch]
    assert same.q[5] == pytest.approx(expected_deg * DEG, abs=1e-12)


def test_a_joint_outside_its_range_gives_a_negative_margin(puma_kinematics):
    q = HOME.copy()
    q[4] = 107 * DEG  # 7 deg beyond J5
    for near in (None, HOME, HOME + 2.0 * np.pi):
        (same,) = [
            s
            for s in puma_kinematics.solutions(puma_kinematics.forward(q), near)
            if s.branch == puma_kinematics.branch_of(q)
        ]
        assert same.limit_margin == pytest.approx(-7 * DEG, abs=1e-12)
        assert same.q[4] == pytest.approx(107 * DEG, abs=1e-12)


def test_a_joint_on_its_limit_stays_there(irb2400):
    # J1 of the IRB 2400 has exactly one turn: rounding must not throw it to the other end of it
    kinematics = Kinematics(irb2400)
    for j1 in (-np.pi, np.pi, -np.pi - 1e-11, np.pi + 1e-11):
        q = np.array([j1, 0.3, -0.2, 0.4, 0.5, 0.6])
        (same,) = [
            s for s in kinematics.solutions(kinematics.forward(q), near=q) if s.branch == kinematics.branch_of(q)
        ]
        np.testing.assert_allclose(same.q, q, atol=1e-12)
        assert abs(same.limit_margin) < 2e-11


def test_a_straight_wrist_is_one_solution_and_keeps_j4(puma_kinematics):
    q = HOME.copy()
    q[4] = 0.0
    X = puma_kinematics.forward(q)
    found = puma_kinematics.solutions(X, near=q)
    (same,) = [s for s in found if np.abs(wrapped(s.q[:3] - q[:3])).max() < 1e-9]
    np.testing.assert_allclose(same.q, q, atol=1e-9)
    assert same.branch == puma_kinematics.branch_of(q)
    np.testing.assert_allclose(puma_kinematics.inverse_branch(X, same.branch, near=q), q, atol=1e-9)
    (free,) = [s for s in puma_kinematics.solutions(X) if np.abs(wrapped(s.q[:3] - q[:3])).max() < 1e-9]
    assert free.q[3] == pytest.approx(0.0, abs=1e-12)
    assert free.q[5] == pytest.approx(q[3] + q[5], abs=1e-9)


def test_a_path_is_followed_through_more_than_a_turn(puma_kinematics):
    start = puma_kinematics.forward(HOME)
    angles = np.linspace(0.0, 2.5 * np.pi, 500)
    X = start @ pose(rotation=rotation_about([0.0, 0.0, 1.0], angles))
    q = np.unwrap(puma_kinematics.inverse_branch(X, puma_kinematics.branch_of(HOME), near=HOME), axis=0)
    np.testing.assert_allclose(q[:, 5], HOME[5] + angles, atol=1e-9)
    np.testing.assert_allclose(q[:, :5], np.broadcast_to(HOME[:5], (500, 5)), atol=1e-9)


# --- turns, limits, what is refused ----------------------------------------------------------------------------------


def test_nearest_turns_ends_within_half_a_turn(puma_kinematics):
    q, near = joints(6, 100), 20.0 * joints(7, 100)
    turned = puma_kinematics.nearest_turns(q, near)
    assert np.abs(turned - near).max() <= np.pi + 1e-12
    np.testing.assert_allclose(wrapped(turned - q), 0.0, atol=1e-12)


def test_limit_margin_is_that_of_the_worst_joint(puma_kinematics):
    q = np.zeros((3, 6))
    q[1, 4], q[2, 0] = 99 * DEG, -161 * DEG
    np.testing.assert_allclose(puma_kinematics.limit_margin(q), np.array([45, 1, -1]) * DEG, atol=1e-12)


def test_branch_of_a_branch_is_itself(puma_kinematics):
    for branch in BRANCHES:
        q = puma_kinematics.inverse_branch(puma_kinematics.forward(HOME), Branch.parse(str(branch)))
        assert puma_kinematics.branch_of(q) == branch


def test_without_its_closed_form_in_the_file_the_arm_is_the_same(puma):
    bare, own = Kinematics(replace(puma, opw=None)), Kinematics(puma)
    assert bare.closed_form
    q = np.array([0.2, 1.0, -2.7, 0.3, 0.9, 0.2])
    assert bare.branch_of(q) == own.branch_of(q)
    for found, known in zip(bare.solutions(own.forward(q)), own.solutions(own.forward(q)), strict=True):
        np.testing.assert_allclose(found.q, known.q, atol=1e-9)


def test_poses_that_are_solved_at_once_have_the_solutions_of_each(kinematics):
    q = within_limits(kinematics.spec, 11, 40)
    q[:10, 4] = 0.0  # branches that merge at the singularity of the wrist
    X = kinematics.forward(q)
    X[-1, :3, 3] += 50.0  # out of reach
    found = kinematics.solutions_each(X, q[0])
    assert len(found) == len(X)
    for pose_found, X_one in zip(found, X, strict=True):
        one = kinematics.solutions(X_one, q[0])
        assert [each.branch for each in pose_found] == [each.branch for each in one]
        np.testing.assert_allclose([each.q for each in pose_found], [each.q for each in one], rtol=0, atol=1e-12)
    assert found[-1] == []
    assert all(len(each) < 8 for each in found[:10])
