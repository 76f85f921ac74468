"""Experiments B1 to B4 and B7 (docs/motor-inertia.md): the recursion of document 003 against three other ways to D."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from runtime.core.frames import rotation_about
from runtime.dynamics import motor_inertia
from runtime.dynamics.motor_inertia import (
    LinkChain,
    axis_inertia,
    inertia_row,
    link_chain,
    link_inertia,
    motor_side,
)
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from tests.runtime.dynamics import lagrangian

ROBOTS = ["puma560", "manutec_r3", "irb2400", "cobra600"]
PUMA = load_builtin("puma560")
Q_PUBLISHED = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
LOAD = Payload(
    mass=2.3,
    cog=np.array([0.03, -0.02, 0.095]),
    inertia=np.array([[0.004, 0.0003, -0.0002], [0.0003, 0.005, 0.0001], [-0.0002, 0.0001, 0.003]]),
)


def postures(name: str, count: int = 200) -> np.ndarray:
    spec = load_builtin(name)
    return np.random.default_rng(2003).uniform(spec.lower, spec.upper, (count, spec.n))


@cache
def by_pinocchio(name: str, carried: bool, mode: str) -> np.ndarray:
    """M (200, n, n) of the postures."""
    model = ArmModel(load_builtin(name))
    if carried:
        model.set_payload(LOAD, mode)
    return np.array([model.mass_matrix(q) for q in postures(name)])


def turned_flange(spec):
    """The robot with a flange that is off the last axis and turned, so that no part of its pose goes unseen."""
    X = np.eye(4)
    X[:3, :3] = rotation_about(np.array([2.0, -1.0, 2.0]) / 3.0, 0.7)
    X[:3, 3] = [0.04, -0.07, 0.11]
    return replace(spec, X_last_flange=X)


# --- B1: one D by four ways ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ROBOTS)
def test_b1_equals_the_lagrangian_of_the_published_bodies(name):
    """D goes to 4 kg m2 on the Puma and to 115 on the others. Link 6 of the Manutec is published as a point: the robot
    file gives it 1e-12 kg m2 about every axis (docs/dynamics.md), which every axis before it sees too."""
    spec, rows, q = load_builtin(name), lagrangian.published(name), postures(name)
    added = sum(correction.added_inertia for correction in spec.corrections)
    D = np.array([np.diag(lagrangian.mass_matrix(rows, each)) for each in q]) + added
    J = link_inertia(link_chain(spec), q)
    assert np.abs(J - D).max() < 1e-12 / 2.0
    assert D.max() > 1.0


@pytest.mark.parametrize("mode", ["add", "replace"])
def test_b1_with_a_point_mass_in_both_readings_of_load(mode):
    rows, q = lagrangian.published(), postures("puma560", 50)
    point = (2.5, (0.05, -0.03, 0.1))  # the Puma's flange frame is that of its last axis
    D = np.array([np.diag(lagrangian.mass_matrix(rows, each, point, mode)) for each in q])
    chain = link_chain(PUMA, Payload(mass=point[0], cog=np.array(point[1])), mode)
    assert np.abs(link_inertia(chain, q) - D).max() < 1e-12


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize(("carried", "mode"), [(False, "add"), (True, "add"), (True, "replace")])
def test_b1_equals_pinocchio_and_both_forms_are_one(name, carried, mode):
    spec, q = load_builtin(name), postures(name)
    chain = link_chain(spec, LOAD, mode) if carried else link_chain(spec)
    D = np.diagonal(by_pinocchio(name, carried, mode), axis1=1, axis2=2)
    assert np.abs(link_inertia(chain, q) - D).max() < 1e-12
    literal = np.array([[axis_inertia(chain, each, axis) for axis in range(spec.n)] for each in q[:40]])
    assert np.abs(literal - D[:40]).max() < 1e-12


@pytest.mark.parametrize("name", ROBOTS)
def test_the_row_is_that_of_the_mass_matrix(name):
    spec, q = load_builtin(name), postures(name, 200)[:40]
    chain = link_chain(spec, LOAD)
    rows = np.array([[inertia_row(chain, each, axis) for axis in range(spec.n)] for each in q])
    assert np.abs(rows - by_pinocchio(name, True, "add")[:40]).max() < 1e-12
    assert not inertia_row(chain, q[0], 2).flags.writeable


def test_rows_of_a_whole_matrix_have_the_published_coupling():
    row = inertia_row(link_chain(PUMA), Q_PUBLISHED, 0)
    assert round(float(row[1]), 4) == -0.6550


def test_an_axis_that_is_not_there():
    chain = link_chain(PUMA)
    for wrong in (-1, 6):
        with pytest.raises(IndexError, match="of 6"):
            axis_inertia(chain, Q_PUBLISHED, wrong)
        with pytest.raises(IndexError, match="of 6"):
            inertia_row(chain, Q_PUBLISHED, wrong)


# --- B2: the payload -------------------------------------------------------------------------------------------------


def with_separate_body(chain: LinkChain, X_last_flange: np.ndarray, payload: Payload) -> LinkChain:
    """One more link, at the flange, that is the payload; its axis stays at zero."""
    r = payload.cog
    about_origin = payload.inertia + payload.mass * (r @ r * np.eye(3) - np.outer(r, r))
    return LinkChain(
        rotations=np.concatenate([chain.rotations, X_last_flange[None, :3, :3]]),
        offsets=np.concatenate([chain.offsets, X_last_flange[None, :3, 3]]),
        masses=np.append(chain.masses, payload.mass),
        moments=np.concatenate([chain.moments, payload.mass * r[None]]),
        inertias=np.concatenate([chain.inertias, about_origin[None]]),
        gear_ratios=np.append(chain.gear_ratios, 1.0),
        sliding=chain.sliding,
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_b2_merged_into_the_last_link_or_a_body_of_its_own(name):
    spec = turned_flange(load_builtin(name))
    q = postures(name)
    merged = link_inertia(link_chain(spec, LOAD), q)
    separate = with_separate_body(link_chain(spec), spec.X_last_flange, LOAD)
    J = link_inertia(separate, np.concatenate([q, np.zeros((len(q), 1))], axis=1))[:, : spec.n]
    assert (np.abs(J - merged) / merged).max() <= 1e-14
    assert (merged > 1.01 * link_inertia(link_chain(spec), q)).mean() > 0.9  # it can be seen


@pytest.mark.parametrize("mode", ["add", "replace"])
def test_b2_a_turned_flange_carries_it_where_pinocchio_does(mode):
    spec, q = turned_flange(PUMA), postures("puma560")[:40]
    model = ArmModel(spec)
    model.set_payload(LOAD, mode)
    D = np.array([np.diag(model.mass_matrix(each)) for each in q])
    assert np.abs(link_inertia(link_chain(spec, LOAD, mode), q) - D).max() < 1e-12


def test_b2_mass_first_moment_and_inertia_are_sums():
    bare, loaded = link_chain(PUMA), link_chain(PUMA, LOAD)
    r = LOAD.cog
    about_origin = LOAD.inertia + LOAD.mass * (r @ r * np.eye(3) - np.outer(r, r))
    assert loaded.masses[5] - bare.masses[5] == pytest.approx(LOAD.mass, rel=1e-14)
    assert loaded.moments[5] - bare.moments[5] == pytest.approx(LOAD.mass * r, rel=1e-13)
    np.testing.assert_allclose(loaded.inertias[5] - bare.inertias[5], about_origin, rtol=1e-12, atol=1e-16)
    for name in ("masses", "moments", "inertias"):
        assert (getattr(loaded, name)[:5] == getattr(bare, name)[:5]).all()
        assert not getattr(loaded, name).flags.writeable


# --- B3: what J_i depends on -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ROBOTS)
def test_b3_not_on_the_angles_of_the_axes_before_and_its_own(name):
    chain, q = link_chain(load_builtin(name), LOAD), postures(name)
    J = link_inertia(chain, q)
    for axis in range(chain.n):
        turned = q.copy()
        turned[:, : axis + 1] += [0.3, -0.2, 0.5, 0.4, 0.1, 0.6][: axis + 1]
        assert (link_inertia(chain, turned)[:, axis] == J[:, axis]).all()
        assert axis_inertia(chain, turned[0], axis) == axis_inertia(chain, q[0], axis)


@pytest.mark.parametrize("name", ROBOTS[:3])  # of a SCARA J2 to J4 carry what does not change with a joint
def test_b3_but_on_those_of_the_axes_behind(name):
    chain, q = link_chain(load_builtin(name), LOAD), postures(name)
    J = link_inertia(chain, q)
    for axis in range(5):
        turned = q.copy()
        turned[:, axis + 1 :] += 0.4
        assert (np.abs(link_inertia(chain, turned)[:, axis] / J[:, axis] - 1.0) > 1e-6).mean() > 0.9


# --- B4: at the motor ------------------------------------------------------------------------------------------------


def test_b4_motor_side_of_the_puma_in_the_published_posture():
    chain = link_chain(PUMA)
    J = link_inertia(chain, Q_PUBLISHED)
    at_motor = motor_side(chain, J)
    assert at_motor[:5] == pytest.approx([4.7e-4, 1.7e-4, 1.2e-4, 3e-7, 1e-7], rel=0.25)
    assert at_motor[:3] == pytest.approx([4.671e-4, 1.702e-4, 1.247e-4], rel=1e-3)
    rotors = PUMA.per_axis("motor", "rotor_inertia")
    assert rotors.tolist() == [2e-4] * 3 + [3.3e-5] * 3
    published = [2.6152, 4.3038, 0.9366, 0.1926, 0.1713, 0.1941]  # D + N^2 J, Corke and Armstrong-Helouvry 1994
    assert (at_motor + rotors) * chain.gear_ratios**2 == pytest.approx(published, abs=5e-5)
    assert J + spec_rotors(PUMA) == pytest.approx(published, abs=5e-5)


def test_b4_ratios_of_either_sign_and_any_shape():
    chain = link_chain(load_builtin("manutec_r3"))
    assert (chain.gear_ratios < 0.0).any()
    J = np.full((4, 3, 6), 2.0)
    assert motor_side(chain, J) == pytest.approx(np.broadcast_to(2.0 / chain.gear_ratios**2, (4, 3, 6)), rel=1e-15)


# --- shapes ----------------------------------------------------------------------------------------------------------


def test_leading_dimensions():
    chain, block = link_chain(PUMA, LOAD), motor_inertia._BLOCK
    q = postures("puma560", 2 * block + 30)
    J = link_inertia(chain, q)
    assert J.shape == q.shape
    for index in (0, 1, block - 1, block, 2 * block, len(q) - 1):  # both sides of every seam between two blocks
        assert link_inertia(chain, q[index]) == pytest.approx(J[index], rel=1e-13)
        assert link_inertia(chain, q[index]).shape == (6,)
    shaped = link_inertia(chain, q[:24].reshape(2, 3, 4, 6))
    assert shaped.shape == (2, 3, 4, 6)
    assert shaped.reshape(24, 6) == pytest.approx(J[:24], rel=1e-13)
    assert link_inertia(chain, np.empty((0, 6))).shape == (0, 6)
    backwards = np.asfortranarray(q[::-1])
    assert link_inertia(chain, backwards) == pytest.approx(J[::-1], rel=1e-13)


@pytest.mark.parametrize("n", [1, 2])
def test_short_chains(n):
    spec = replace(PUMA, axes=PUMA.axes[:n], X_last_flange=np.eye(4))
    chain, model = link_chain(spec, LOAD), ArmModel(spec)
    model.set_payload(LOAD)
    for q in postures("puma560", 5)[:, :n]:
        D = np.diag(model.mass_matrix(q))
        assert link_inertia(chain, q) == pytest.approx(D, rel=1e-13)
        assert [axis_inertia(chain, q, axis) for axis in range(n)] == pytest.approx(D, rel=1e-13)


# --- B7: steps -------------------------------------------------------------------------------------------------------


@pytest.fixture
def counts(monkeypatch):
    """Number of calls of the two steps of 3.4."""
    found = {"outward": 0, "back": 0}

    def counted(name, step):
        def call(*args):
            found[name] += 1
            return step(*args)

        return call

    for name in found:
        monkeypatch.setattr(motor_inertia, name, counted(name, getattr(motor_inertia, name)))
    return found


def test_b7_fifteen_steps_outward_and_twenty_one_back_for_six_axes(counts):
    chain = link_chain(PUMA)
    for axis in range(6):
        axis_inertia(chain, Q_PUBLISHED, axis)
    assert counts == {"outward": 15, "back": 21}


@pytest.mark.parametrize(("axis", "outward", "back"), [(0, 5, 6), (3, 2, 3), (5, 0, 1)])
def test_b7_steps_of_one_axis(counts, axis, outward, back):
    axis_inertia(link_chain(PUMA), Q_PUBLISHED, axis)
    assert counts == {"outward": outward, "back": back}


def test_b7_whole_rows_take_fewer_than_whole_passes(counts):
    chain = link_chain(PUMA)
    for axis in range(6):
        inertia_row(chain, Q_PUBLISHED, axis)
    assert counts == {"outward": 15, "back": 36}  # 36 and 36 where every pass starts at the base
