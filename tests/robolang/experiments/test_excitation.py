"""The motions by which a robot is identified: within every limit, off the ground, stopped where something is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from robolang.experiments.excitation import LEAST_STROKE, MARGIN, Request, bench, folds, plan, plan_table, posture
from robolang.experiments.identify import RubbingPlant, identify, with_errors
from robolang.project.project import load_project
from runtime.core.faults import Fault
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.plant.shapes import Shapes
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from tests.robolang.experiments.identified import ROOT, SPEC

pytestmark = pytest.mark.physics


@pytest.mark.parametrize("robot", ["puma560", "manutec_r3", "irb2400"])
def test_test_motions_keep_every_limit(robot):
    spec = load_builtin(robot)
    request = Request(robot=spec, axes=(0,))
    for axis in range(spec.n):
        test = plan(request, NO_PAYLOAD, axis)
        for position in test.positions:
            starts = test.starts(float(position))
            for start in starts:
                assert start >= spec.lower[axis] + MARGIN - 1e-9
                assert start + test.stroke <= spec.upper[axis] - MARGIN + 1e-9
            assert starts[0] < position < starts[1] + test.stroke
        rows = test.rows[:, None]
        _, dq, ddq = FineInterpolator(8, 8e-3, rows[0]).expand(rows)
        assert np.abs(dq).max() <= 0.51 * spec.axes[axis].limits.speed
        assert np.abs(ddq).max() <= 0.51 * spec.axes[axis].limits.acceleration


@pytest.mark.parametrize("robot", ["puma560", "manutec_r3", "irb2400"])
def test_the_arm_keeps_out_of_itself_in_all_of_its_test_motions(robot):
    """By the shapes of the very plant that makes the motion."""
    spec = load_builtin(robot)
    for axis in range(spec.n):
        request = Request(robot=spec, axes=(axis,), positions=2)
        assert_unfolded(request, plan(request, NO_PAYLOAD, axis))


def assert_unfolded(request, test):
    first, last = min(test.starts(test.positions[0])), max(test.starts(test.positions[-1])) + test.stroke
    q = np.array(test.q)
    q[test.axis] = test.starts(test.positions[0])[0]  # where the plant begins: shapes that meet there never do
    shapes = Shapes(request.robot, replace(bench(request), home=q))
    for q[test.axis] in np.linspace(first, last, 50):
        assert shapes.folded(q) is None, (test.axis, q)


def test_what_folds_everywhere_leaves_no_room():
    model = ArmModel(SPEC)
    _, (low, high) = posture(SPEC, model, 2, lambda q: True)
    assert low == high


def test_other_axes_stand_inside_their_ranges_where_the_inertia_is_near_its_mean():
    model, rng = ArmModel(SPEC), np.random.default_rng(3)
    D = np.array([np.diag(model.mass_matrix(q)) for q in rng.uniform(SPEC.lower, SPEC.upper, (500, 6))]).mean(axis=0)
    for axis in range(6):
        q, (low, high) = posture(SPEC, model, axis, folds(Request(robot=SPEC, axes=(axis,))))
        assert model.inertia_column(q, axis)[axis] == pytest.approx(D[axis], rel=0.12)
        assert (q > SPEC.lower + MARGIN).all()
        assert (q < SPEC.upper - MARGIN).all()
        assert high - low > 0.85 * (SPEC.upper[axis] - SPEC.lower[axis])  # J2 would reach the ground


@pytest.mark.parametrize("robot", ["puma560", "irb2400", "manutec_r3"])
@pytest.mark.parametrize(("axis", "joints"), [(0, (1, 2)), (1, (2,))])
def test_the_postures_of_a_table_are_over_the_ground_with_all_of_their_motions(robot, axis, joints):
    spec = load_builtin(robot)
    kinematics = Kinematics(spec)
    request = Request(robot=spec, axes=(axis,), table=4)
    grid = plan_table(request, NO_PAYLOAD, plan(request, NO_PAYLOAD, axis))
    assert grid.joints == joints
    assert len(grid.tests) == 4 ** len(joints)
    for test in (grid.tests[0], grid.tests[-1]):
        assert_unfolded(request, test)
    for joint, angles in zip(joints, grid.angles, strict=True):
        assert np.ptp(np.diff(angles)) < np.radians(0.03)
        assert angles[0] > spec.lower[joint] + 0.9 * MARGIN
        assert angles[-1] < spec.upper[joint] - 0.9 * MARGIN
        assert np.ptp(angles) > 0.4 * (spec.upper[joint] - spec.lower[joint])
    for number, test in enumerate(grid.tests):
        index = np.unravel_index(number, (4,) * len(joints))
        assert [test.q[joint] for joint in joints] == [angles[k] for k, angles in zip(index, grid.angles, strict=True)]
        (position,) = test.positions
        for start in test.starts(position):
            q = np.tile(test.q, (len(test.rows), 1))
            q[:, axis] = start + test.rows
            assert (kinematics.forward(q)[:, 2, 3] > 0.19).all()


def test_a_table_shrinks_off_the_ground():
    """The shoulder of the Puma hangs the arm down at both ends of its range: the grid is what is left."""
    grid = plan_table(request := Request(robot=SPEC, axes=(0,), table=3), NO_PAYLOAD, plan(request, NO_PAYLOAD, 0))
    low, high = np.degrees(grid.angles[0][[0, -1]])
    assert -45.0 + 20.0 < low < high < 225.0 - 20.0


def test_a_table_without_room_is_refused_before_anything_moves(monkeypatch):
    request = Request(robot=SPEC, axes=(1,), table=2)
    test = plan(request, NO_PAYLOAD, 1)
    monkeypatch.setattr("robolang.experiments.excitation.CLEARANCE", 9.0)
    with pytest.raises(Fault, match=r"J2.*J3") as caught:
        plan_table(request, NO_PAYLOAD, test)
    assert caught.value.code == "RBL420"


def test_a_torque_that_is_not_there_at_a_posture_of_a_table_is_refused_with_it():
    request = Request(robot=changed(0, torque=35.0), axes=(0,), table=3)
    test = plan(Request(robot=SPEC, axes=(0,)), NO_PAYLOAD, 0)
    with pytest.raises(Fault, match=r"\bJ1 .*J2 1\.3, J3 -?\d+\.\d deg"):
        plan_table(request, NO_PAYLOAD, test)


def changed(axis, **limits):
    axes = list(SPEC.axes)
    axes[axis] = replace(axes[axis], limits=replace(axes[axis].limits, **limits))
    return replace(SPEC, axes=tuple(axes))


def test_an_axis_without_room_is_refused_before_anything_moves():
    spec = changed(2, lower=-1.6, upper=-1.6 + 2 * LEAST_STROKE + MARGIN)
    told = []
    with pytest.raises(Fault) as caught:
        identify(Request(robot=spec, axes=(0, 2)), lambda *where: told.append(where))
    assert caught.value.code == "RBL420"
    assert "J3" in caught.value.message
    assert caught.value.hint
    assert told == []  # not even the axis that could have been


def test_a_torque_that_is_not_there_is_refused_with_place_and_joint():
    spec = changed(1, torque=45.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: .* J2 .*-?\d+\.\d N m") as caught:
        identify(Request(robot=spec, axes=(1,)), lambda *where: pytest.fail("it moved"))
    assert caught.value.code == "RBL420"


def test_less_torque_makes_the_test_slower():
    fast, slow = (plan(Request(robot=spec, axes=(1,)), NO_PAYLOAD, 1) for spec in (SPEC, changed(1, torque=90.0)))
    assert len(slow.rows) > len(fast.rows)


def test_an_axis_that_is_not_there_is_refused():
    with pytest.raises(Fault) as caught:
        identify(Request(robot=SPEC, axes=(6,)))
    assert caught.value.code == "RBL420"


def test_a_plant_that_does_not_follow_stops_the_identification():
    real = with_errors(SPEC, 1, low=9.0, high=10.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: ") as caught:
        identify(Request(robot=SPEC, axes=(1,), real=real))
    assert caught.value.code in ("RBL511", "RBL512")


def test_a_contact_stops_the_identification(monkeypatch):
    """The Puma reaches the ground when nothing keeps it off."""
    monkeypatch.setattr("robolang.experiments.excitation.CLEARANCE", -9.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: floor") as caught:
        identify(Request(robot=SPEC, axes=(1,)))
    assert caught.value.code == "RBL516"


def test_positions_are_equally_spaced_and_told():
    told = []
    request = Request(robot=SPEC, axes=(5,), plant="rigid", positions=3)
    (found,) = identify(request, lambda axis, number, q: told.append((axis, number, round(q, 9))))
    assert np.ptp(np.diff(found.positions)) < 1e-12
    assert told == [(5, k + 1, round(q, 9)) for k, q in enumerate(found.positions)]


def test_one_position_is_the_middle():
    (found,) = identify(Request(robot=SPEC, axes=(3,), plant="rigid", positions=1))
    assert found.positions == pytest.approx([np.radians(30.0)])
    assert found.spread == 0.0


def test_the_same_request_gives_the_same_bytes():
    request = Request(robot=SPEC, axes=(5,), positions=2)
    first, second = identify(request), identify(request)
    assert first[0].identified.tobytes() == second[0].identified.tobytes()


def test_friction_of_the_ideal_arm_brakes_it():
    cell = replace(load_project(ROOT / "programs/pick_and_place.rbl").cell, parts=(), obstacles=())
    plant = RubbingPlant(SPEC, cell, 1e-3)
    plant.dq[:] = 0.5
    model = ArmModel(SPEC, rotors=spec_rotors(SPEC))
    model.set_payload(Payload(mass=cell.hand.mass, cog=cell.hand.cog))
    before = plant.dq.copy()
    plant.step(model.torque(plant.q, plant.dq, np.zeros(6)))  # holds the speed but for friction
    work = (plant.dq - before) @ model.mass_matrix(plant.q) @ before
    assert work < 0.0
