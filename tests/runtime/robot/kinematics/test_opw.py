import math
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import pose, rotation_about, rotation_from_rpy
from runtime.robot.kinematics import opw
from runtime.robot.kinematics.opw import BRANCHES, Arm, Branch, Elbow, Wrist
from tests.runtime.robot.arms import DEG, Irb2400, opw_parameters

TOOLBOX = {
    "qz": (0, 0, 0, 0, 0, 0),
    "qr": (0, 90, -90, 0, 0, 0),
    "qs": (0, 0, -90, 0, 0, 0),
    "qn": (0, 45, 180, 0, 45, 0),
}
PUMA_DH = (  # d, a, alpha (Robotics Toolbox, Puma560.py)
    (0.672, 0.0, 90.0),
    (0.0, 0.4318, 0.0),
    (0.15005, 0.0203, -90.0),
    (0.4318, 0.0, 90.0),
    (0.0, 0.0, -90.0),
    (0.0, 0.0, 0.0),
)


def dh_frames(q):
    """Frames 0 to 6 of the Puma 560, written out entry by entry."""
    at, frames = np.eye(4), [np.eye(4)]
    for angle, (d, a, alpha_deg) in zip(q, PUMA_DH, strict=True):
        ct, st, ca, sa = math.cos(angle), math.sin(angle), math.cos(alpha_deg * DEG), math.sin(alpha_deg * DEG)
        at = at @ np.array(
            [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]]
        )
        frames.append(at)
    return frames


def joints(seed, count):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 6))


def turned_apart(a, b):
    return np.abs(opw.wrapped(a - b)).max(axis=-1)


def clear_arm(params, q, margin=1e-3):
    """True where front and back, above and below are well apart."""
    theta = params.signs * q + params.offsets
    k, g = math.hypot(params.a2, params.c3), theta[:, 2] + math.atan2(params.a2, params.c3)
    r = params.a1 + params.c2 * np.sin(theta[:, 1]) + k * np.sin(theta[:, 1] + g)
    return (np.abs(r) > margin) & (np.abs(np.sin(g)) > margin)


def clear_of_borders(params, q, margin=1e-3):
    """True where no two branches are close: there joint angles can be recovered from the pose to full precision."""
    wrist = np.sin(params.signs[4] * q[:, 4] + params.offsets[4])
    return clear_arm(params, q, margin) & (np.abs(wrist) > margin)


def missed_by(params, found, X):
    """Largest error of the branches that exist, (..., 8, 6) against poses (..., 4, 4); m and direction cosines."""
    there = ~np.isnan(found).any(axis=-1)
    X_found = opw.forward(params, np.where(there[..., None], found, 0.0))
    return np.abs(X_found - X[..., None, :, :]).max(axis=(-2, -1))[there].max()


# --- forward ---------------------------------------------------------------------------------------------------------


def test_forward_is_the_dh_product_of_the_puma(puma):
    for q in joints(1, 50):
        np.testing.assert_allclose(opw.forward(puma.opw, q), dh_frames(q)[-1], rtol=0, atol=2e-15)


def test_forward_gives_the_published_pose_of_qn(puma):
    # Corke, Robotics, Vision and Control: T = p560.fkine(qn), without the 0.672 m of the pedestal
    X = opw.forward(puma.opw, np.array(TOOLBOX["qn"]) * DEG)
    np.testing.assert_allclose(X[:3, 3], [0.5963, -0.15005, 0.672 - 0.01435], atol=5e-5)
    np.testing.assert_allclose(X[:3, :3], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-15)


def test_forward_is_the_chain_of_lines_of_the_irb2400(irb2400):
    for q in joints(2, 50):
        np.testing.assert_allclose(opw.forward(irb2400.opw, q), Irb2400.forward(q), rtol=0, atol=3e-15)


def test_forward_broadcasts(params):
    q = joints(3, 12).reshape(3, 4, 6)
    X = opw.forward(params, q)
    assert X.shape == (3, 4, 4, 4)
    np.testing.assert_array_equal(X[2, 1], opw.forward(params, q[2, 1]))


# --- mismatch --------------------------------------------------------------------------------------------------------


def test_closed_form_and_chain_agree(puma, irb2400):
    assert opw.mismatch(puma) < 1e-14
    assert opw.mismatch(irb2400) < 1e-14


@pytest.mark.parametrize(("field", "index"), [("signs", i) for i in range(6)] + [("offsets", i) for i in range(6)])
def test_mismatch_sees_every_sign_and_offset(puma, field, index):
    values = getattr(puma.opw, field).copy()
    values[index] = -values[index] if field == "signs" else values[index] + 0.01
    assert opw.mismatch(replace(puma, opw=replace(puma.opw, **{field: values}))) > 1e-3


@pytest.mark.parametrize("length", ["a1", "a2", "b", "c1", "c2", "c3", "c4"])
def test_mismatch_sees_a_hundredth_of_a_millimetre(puma, length):
    wrong = replace(puma.opw, **{length: getattr(puma.opw, length) + 1e-5})
    assert opw.mismatch(replace(puma, opw=wrong)) >= 0.99e-5


def test_mismatch_needs_a_closed_form(puma):
    with pytest.raises(ValueError, match="closed form"):
        opw.mismatch(replace(puma, opw=None))


# --- inverse ---------------------------------------------------------------------------------------------------------


def test_joint_angles_are_recovered_in_their_own_branch(params):
    q = joints(4, 3000)
    q = q[clear_of_borders(params, q)]
    assert len(q) > 2900
    X = opw.forward(params, q)
    index = [BRANCHES.index(opw.branch_of(params, one)) for one in q]
    assert set(index) == set(range(8))
    found = opw.inverse(params, X)[np.arange(len(q)), index]
    assert turned_apart(found, q).max() < 1e-9


def test_every_branch_meets_the_pose_and_is_the_one_it_is_named(params):
    q = joints(5, 3000)
    q = q[clear_of_borders(params, q)]
    X = opw.forward(params, q)
    found = opw.inverse(params, X)
    exists = np.asarray(~np.isnan(found).any(axis=-1))
    assert (np.isnan(found).all(axis=-1) == ~exists).all()
    assert exists.any(axis=-1).all()
    assert missed_by(params, found, X) < 1e-12
    assert np.abs(found[exists]).max() <= np.pi
    for one, there in zip(found[:300], exists[:300], strict=True):
        assert [opw.branch_of(params, one[i]) for i in range(8) if there[i]] == [
            BRANCHES[i] for i in range(8) if there[i]
        ]


def test_the_branches_of_a_pose_are_distinct(params):
    q = joints(6, 1000)
    found = opw.inverse(params, opw.forward(params, q[clear_of_borders(params, q)]))
    for i in range(8):
        for j in range(i):
            apart = turned_apart(found[:, i], found[:, j])
            assert not (apart[~np.isnan(apart)] < 1e-3).any()


def test_an_arm_with_a_shoulder_offset_reaches_less_far_behind(irb2400):
    X = Irb2400.forward(np.array([10, 70, -30, 20, 40, 0]) * DEG)
    exists = ~np.isnan(opw.inverse(irb2400.opw, X)).any(axis=-1)
    assert [str(b) for b, there in zip(BRANCHES, exists, strict=True) if there] == [
        "RIGHTY ABOVE NOFLIP",
        "RIGHTY ABOVE FLIP",
        "RIGHTY BELOW NOFLIP",
        "RIGHTY BELOW FLIP",
    ]


def test_one_branch_of_many_poses_is_each_pose_alone(params):
    X = opw.forward(params, joints(7, 60)).reshape(5, 12, 4, 4)
    everything = opw.inverse(params, X)
    assert everything.shape == (5, 12, 8, 6)
    for i, branch in enumerate(BRANCHES):
        together = opw.inverse_branch(params, X, branch)
        np.testing.assert_array_equal(together, everything[..., i, :])
        np.testing.assert_allclose(together[3, 5], opw.inverse_branch(params, X[3, 5], branch), atol=1e-15)


def test_a_planned_line_is_straight_to_a_millionth_of_a_millimetre(puma):
    start, end = np.array([0.45, -0.3, 0.5]), np.array([0.3, 0.45, 0.9])
    s = np.linspace(0.0, 1.0, 500)[:, None]
    X = pose(start + s * (end - start), rotation_from_rpy(s * np.array([0.3, 0.5, -0.4]) + [3.0, 0.1, 0.2]))
    q = opw.inverse_branch(puma.opw, X, Branch.parse("RIGHTY ABOVE NOFLIP"))
    p = np.array([dh_frames(one)[-1][:3, 3] for one in q])
    off_line = np.linalg.norm(np.cross(p - start, end - start), axis=-1) / np.linalg.norm(end - start)
    assert off_line.max() < 1e-12
    assert np.abs(opw.wrapped(np.diff(q, axis=0))).max() < 0.05


# --- borders ---------------------------------------------------------------------------------------------------------


def test_straight_wrist_takes_j4_from_the_reference(params):
    q = joints(8, 200)
    q[:, 4] = -params.signs[4] * params.offsets[4]
    q = q[clear_arm(params, q, 0.01)]
    assert len(q) > 150
    X, near = opw.forward(params, q), joints(9, len(q))
    for reference, j4 in ((near, near[:, 3]), (None, 0.0)):
        found = opw.inverse(params, X, reference)
        there = ~np.isnan(found).any(axis=-1)
        # the arm's own two branches are at the wrist singularity, the others bend the wrist
        straight = there & (np.abs(np.sin(found[..., 4] + params.signs[4] * params.offsets[4])) < 1e-12)
        assert (straight.sum(axis=-1) >= 2).all()
        apart = opw.wrapped(found[..., 3] - np.broadcast_to(np.atleast_1d(j4)[:, None], found.shape[:-1]))
        assert np.abs(apart[straight]).max() < 1e-12
        assert missed_by(params, found, X) < 1e-12


@pytest.mark.parametrize("bend", [1e-6, 1e-9, 1e-11, 1e-12, 3e-13, 1e-15])
def test_an_almost_straight_wrist_meets_the_pose_all_the_same(params, bend):
    q = joints(10, 300)
    q[:, 4] = params.signs[4] * (bend - params.offsets[4])
    X = opw.forward(params, q)
    found = opw.inverse(params, X, near=np.full(6, 0.7))
    assert missed_by(params, found, X) < 1e-12


def test_wrist_centre_on_axis_1_takes_j1_from_the_reference(irb2400):
    X = pose([0.0, 0.0, 1.6], rotation_about([0.0, 1.0, 0.0], 0.4))
    X[:3, 3] += 0.085 * X[:3, 2]
    found = opw.inverse(irb2400.opw, X, near=[1.1, 0, 0, 0, 0, 0])
    assert not np.isnan(found).any()
    np.testing.assert_allclose(found[:, 0], 1.1, atol=1e-15)
    np.testing.assert_allclose(opw.inverse(irb2400.opw, X)[:, 0], 0.0, atol=1e-15)
    for q in found:
        np.testing.assert_allclose(Irb2400.forward(q), X, rtol=0, atol=1e-12)


def test_no_branch_inside_the_shoulder_offset(puma):
    assert np.isnan(opw.inverse(puma.opw, pose([0.15005 - 1e-9, 0.0, 1.1]))).all()
    for rho in (0.15005, 0.15005 - 1e-13):
        X = pose([rho, 0.0, 1.1])
        found = opw.inverse(puma.opw, X)
        assert not np.isnan(found).any()
        np.testing.assert_allclose(opw.forward(puma.opw, found), np.broadcast_to(X, (8, 4, 4)), rtol=0, atol=1e-12)


def test_stretched_arm_is_met_and_a_nanometre_more_is_not(params):
    direction = np.array([math.sin(0.9), 0.0, math.cos(0.9)])
    shoulder = np.array([params.a1, params.b, params.c1])
    reach = params.c2 + math.hypot(params.a2, params.c3)
    R = rotation_from_rpy([0.3, 2.0, 0.1])
    X = [pose(shoulder + (reach + more) * direction + params.c4 * R[:, 2], R) for more in (0.0, 1e-9)]
    for branch in (b for b in BRANCHES if b.arm is Arm.RIGHTY):
        q = opw.inverse_branch(params, X[0], branch)
        np.testing.assert_allclose(opw.forward(params, q), X[0], rtol=0, atol=1.5e-12)
        assert np.isnan(opw.inverse_branch(params, X[1], branch)).all()


def test_folded_arm_is_met_and_a_nanometre_less_is_not():
    params = opw_parameters((0.1, -0.05, 0.0, 0.6, 0.7, 0.5, 0.08))
    gap = 0.7 - math.hypot(0.05, 0.5)
    at = [pose([0.1 + gap + more, 0.0, 0.68]) for more in (0.0, -1e-9)]
    branch = Branch.parse("RIGHTY ABOVE NOFLIP")
    np.testing.assert_allclose(
        opw.forward(params, opw.inverse_branch(params, at[0], branch)), at[0], rtol=0, atol=1.5e-12
    )
    assert np.isnan(opw.inverse_branch(params, at[1], branch)).all()


def test_far_away_or_not_a_number_is_no_solution(params):
    for x in (3.0, 1e9, np.nan):
        assert np.isnan(opw.inverse(params, pose([x, 0.0, 0.5]))).all()


# --- names -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("qz", "RIGHTY BELOW NOFLIP"),
        ("qr", "RIGHTY ABOVE NOFLIP"),
        ("qs", "RIGHTY ABOVE NOFLIP"),
        ("qn", "RIGHTY ABOVE NOFLIP"),
    ],
)
def test_the_toolbox_poses_have_these_branches(puma, name, text):
    assert str(opw.branch_of(puma.opw, np.array(TOOLBOX[name]) * DEG)) == text


def test_on_a_border_rounding_does_not_decide_the_name():
    params = opw_parameters((0.0, 0.0, 0.0, 0.6, 0.5, 0.5, 0.08))
    for noise in (1e-15, -1e-15):
        straight_up_and_straight = np.array([0.4, noise, noise, 0.3, noise, 0.2])
        assert str(opw.branch_of(params, straight_up_and_straight)) == "RIGHTY ABOVE NOFLIP"
    assert str(opw.branch_of(params, [0.4, -1e-9, 1e-9, 0.3, -1e-9, 0.2])) == "LEFTY BELOW FLIP"


def test_names_are_where_the_joints_stand(puma):
    q = joints(11, 2000)
    for one in q[clear_of_borders(puma.opw, q)]:
        frames = dh_frames(one)
        x_waist = frames[1][:3, 0]
        # in the vertical plane of the arm, seen from the shoulder: (outwards along the waist's x, up)
        elbow, wrist = ((p @ x_waist, p[2]) for p in (frames[i][:3, 3] - [0, 0, 0.672] for i in (2, 4)))
        outwards = math.copysign(1.0, wrist[0])
        above_line = outwards * (wrist[0] * elbow[1] - wrist[1] * elbow[0]) > 0.0
        assert opw.branch_of(puma.opw, one) == Branch(
            arm=Arm.RIGHTY if wrist[0] > 0.0 else Arm.LEFTY,
            elbow=Elbow.ABOVE if above_line else Elbow.BELOW,
            wrist=Wrist.NOFLIP if math.sin(one[4]) > 0.0 else Wrist.FLIP,
        )


def test_names_are_those_of_paul_and_zhang(puma):
    """J1 and J2 by the classical formulas for the Puma: 'r' adds asin(d3 / rho), 'u' of 'r' adds Psi."""
    a2, a3, d3, d4 = 0.4318, 0.0203, 0.15005, 0.4318
    for q in joints(12, 200):
        X = opw.forward(puma.opw, q)
        x, y, z = X[:3, 3] - [0, 0, 0.672]
        rho = math.hypot(x, y)
        for branch, found in zip(BRANCHES, opw.inverse(puma.opw, X), strict=True):
            righty = branch.arm is Arm.RIGHTY
            j1 = math.atan2(y, x) + (math.asin(d3 / rho) if righty else math.pi - math.asin(d3 / rho))
            v = x * math.cos(j1) + y * math.sin(j1)
            psi = math.acos((a2**2 - d4**2 - a3**2 + v**2 + z**2) / (2.0 * a2 * math.hypot(v, z)))
            j2 = math.atan2(z, v) + (psi if (branch.elbow is Elbow.ABOVE) == righty else -psi)
            assert np.abs(opw.wrapped(found[:2] - [j1, j2])).max() < 1e-6


def test_the_flipped_wrist_is_half_a_turn_about_its_first_and_last_axis(params):
    X = opw.forward(params, joints(13, 50))
    kept = opw.inverse_branch(params, X, Branch.parse("RIGHTY ABOVE NOFLIP"))
    flipped = opw.inverse_branch(params, X, Branch.parse("RIGHTY ABOVE FLIP"))
    there = ~np.isnan(kept).any(axis=-1)
    change = opw.wrapped(flipped - kept)[there]
    np.testing.assert_allclose(change[:, :3], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.abs(change[:, [3, 5]]), np.pi, atol=1e-9)
    np.testing.assert_allclose(flipped[there, 4], -kept[there, 4], atol=1e-12)
    assert (kept[there, 4] >= 0.0).all()


def test_branches_read_and_write_as_text():
    assert len({str(branch) for branch in BRANCHES}) == 8
    for branch in BRANCHES:
        assert Branch.parse(str(branch)) == branch
    assert Branch.parse(" noflip  lefty ABOVE").arm is Arm.LEFTY


@pytest.mark.parametrize("text", ["", "LEFTY", "LEFTY RIGHTY ABOVE", "LEFTY ABOVE NOFLIP FLIP", "LEFT ABOVE FLIP"])
def test_other_text_is_not_a_branch(text):
    with pytest.raises(ValueError, match="branch"):
        Branch.parse(text)
