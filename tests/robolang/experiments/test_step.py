"""Experiments A4 and A5 of docs/servo.md through the whole controller, on the ideal rigid arm, to 1 %."""

import math
from dataclasses import replace

import numpy as np
import pytest

from robolang.experiments.step import StepRequest, step
from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.core.units import DEG
from runtime.dynamics.equations import axis_inertia
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import Body
from runtime.servo.fixed import rated_range
from runtime.settings.profile import Profile, ServoOptions
from tests.campaign import WHOLE, some

PUMA = load_builtin("puma560")
FIVE = Payload(mass=5.0, cog=np.array([0.0, 0.0, 0.1]))
HALF = Payload(mass=0.5, cog=np.array([0.0, 0.0, 0.05]))
STRONG = replace(PUMA, rated_payload=5.0)
"""The experiments carry 5 kg, twice what the arm is rated for."""
REPLACED = replace(
    STRONG,
    axes=(*STRONG.axes[:5], replace(STRONG.axes[5], body=Body(mass=1e-9, cog=np.zeros(3), inertia=1e-12 * np.eye(3)))),
)
"""A payload that takes the place of link 6, as the document has it, is one added to a link 6 without mass."""
SMALLEST, LARGEST = 2.341, 9.680
STRETCHED = np.radians([0.0, 0.0, -90.0, 0.0, 0.0, 0.0])


def experiment(axis, q, size, carried=NO_PAYLOAD, declared=None, robot=STRONG, profile=None, **servo):
    servo = {
        "velocity_feedforward": 0.0,
        "acceleration_feedforward": 0.0,
        "position_bandwidth": (20.0,),
        "velocity_bandwidth": (80.0,),
        "coupling": "diagonal",
        **servo,
    }
    return StepRequest(
        robot=robot,
        axis=axis,
        q=np.asarray(q),
        size=size,
        carried=carried,
        declared=carried if declared is None else declared,
        profile=replace(profile or Profile(tick_us=500), servo=ServoOptions(**servo)),
        tool=FIVE.cog,
    )


def posture_with(wanted, payload, robot=REPLACED):
    """Return the posture, shoulder between upright and level, at which D' of J1 is ``wanted``."""
    model = ArmModel(robot)
    model.set_payload(payload)
    rotor = spec_rotors(robot)[0]
    low, high = 0.0, math.pi / 2  # level and upright: the inertia falls in between
    for _ in range(60):
        q = np.array([0.0, 0.5 * (low + high), -math.pi / 2, 0.0, 0.0, 0.0])
        low, high = (q[1], high) if axis_inertia(model, q, 0) + rotor > wanted else (low, q[1])
    assert axis_inertia(model, q, 0) + rotor == pytest.approx(wanted, rel=1e-9)
    return q


NEAR = (posture_with(SMALLEST, NO_PAYLOAD), NO_PAYLOAD)
FAR = (posture_with(LARGEST, FIVE), FIVE)


def waist(end, **servo):
    q, carried = end
    return step(replace(experiment(0, q, 0.1, carried, robot=REPLACED, **servo), locked=True))


def test_the_range_is_the_one_of_the_experiment():
    low, high = rated_range(REPLACED, pose(FIVE.cog, np.eye(3)))
    rotor = spec_rotors(REPLACED)[0]
    assert (low[0] + rotor, high[0] + rotor) == pytest.approx((SMALLEST, LARGEST), rel=0.01)


@pytest.mark.parametrize("end", [NEAR, FAR], ids=["smallest", "largest"])
def test_scheduled_gains_answer_alike_at_both_ends(end):
    result = waist(end)
    assert result.stable
    assert result.gain_inertia == pytest.approx(result.inertia, rel=1e-6)
    assert result.overshoot < 0.001
    assert result.settling == pytest.approx(0.147, rel=0.01)


def test_gains_fixed_at_the_smallest_swing_at_the_largest():
    result = waist(FAR, mode="fixed", fixed_at="min")
    assert result.overshoot == pytest.approx(0.17, rel=0.01)
    assert result.settling == pytest.approx(0.41, rel=0.02)  # given to two digits: 0.41 is 0.405 to 0.415
    assert 0.5 * math.sqrt(80.0 / 20.0 * result.gain_inertia / result.inertia) == pytest.approx(0.49, rel=0.01)


def test_gains_fixed_at_the_middle_still_swing():
    """1.7 % is given to a tenth; half a percent in the middle of the range changes it by a twentieth."""
    assert waist(FAR, mode="fixed", fixed_at="mid").overshoot == pytest.approx(0.017, abs=0.001)


def test_gains_fixed_at_the_largest_are_slow_at_the_smallest():
    result = waist(NEAR, mode="fixed", fixed_at="max")
    assert result.overshoot < 0.001
    assert result.settling == pytest.approx(0.186, rel=0.01)


@pytest.mark.parametrize(("Kf", "expected"), some([(0.3, 0.044), (0.6, 0.255), (0.9, 0.74)], 1))
def test_measured_speed_fed_forward_takes_damping_away(Kf, expected):
    request = experiment(0, NEAR[0], 0.01, robot=REPLACED, source="measured", velocity_feedforward=Kf)
    found = step(replace(request, seconds=2.0, locked=True))
    assert found.overshoot == pytest.approx(expected, rel=0.03)


def test_measured_acceleration_fed_forward_beyond_one_is_unstable():
    assert not waist(NEAR, source="measured", acceleration_feedforward=1.05).stable


DROOPS = [
    ("bare, no compensation", PUMA, NO_PAYLOAD, NO_PAYLOAD, 0.0, 0.317),
    ("5 kg, no compensation", REPLACED, FIVE, FIVE, 0.0, 0.338),
    ("5 kg, LOAD right", REPLACED, FIVE, FIVE, 1.0, 0.0),
    ("5 kg, LOAD says 0.5 kg", REPLACED, FIVE, HALF, 1.0, 0.275),
]


@pytest.mark.parametrize(
    ("robot", "carried", "said", "gravity", "droop_deg"),
    [row[1:] for row in some(DROOPS, 2, 3)],
    ids=[row[0] for row in some(DROOPS, 2, 3)],
)
def test_gravity_droop_of_the_shoulder(robot, carried, said, gravity, droop_deg):
    result = step(experiment(1, STRETCHED, 0.0, carried, said, robot, gravity_compensation=gravity))
    assert result.droop / DEG == pytest.approx(droop_deg, rel=0.01, abs=5e-5)


@pytest.mark.parametrize(
    ("carried", "said", "gravity"), some([(FIVE, FIVE, 0.0), (FIVE, HALF, 1.0), (HALF, FIVE, 1.0)], 2)
)
def test_gravity_droop_follows_the_formula(carried, said, gravity):
    """error = (T_true - T_model) / (Kv Kp Dm'), with torques from the model at the posture that is reached."""
    result = step(experiment(1, STRETCHED, 0.0, carried, said, gravity_compensation=gravity))
    model = ArmModel(STRONG)
    torques = []
    for payload in (carried, said):
        model.set_payload(payload)
        torques.append(model.gravity(STRETCHED)[1])
    expected = (torques[0] - gravity * torques[1]) / (80.0 * 20.0 * result.gain_inertia)
    assert result.droop == pytest.approx(expected, rel=0.01)


RATED = Payload(mass=PUMA.rated_payload, cog=FIVE.cog)
POSTURES = np.random.default_rng(8).uniform(0.95 * PUMA.lower, 0.95 * PUMA.upper, (8, 6))


def over_the_range(axis, locked, coupling, whole=WHOLE):
    """Return settling times and overshoots, bare and with rated payload: at 8 postures, or at the least inertia of an
    axis and at the largest among them."""
    loads = [(q, carried) for q in POSTURES for carried in (NO_PAYLOAD, RATED)]
    if not whole:
        loads = [pick(loads, key=lambda load: inertia(axis, *load)) for pick in (min, max)]
    results = [
        step(
            replace(
                experiment(axis, q, 0.5 * DEG, carried, robot=PUMA, coupling=coupling),
                locked=locked,
                seconds=0.6 if whole else 0.3,
            )
        )
        for q, carried in loads
    ]
    assert all(result.stable for result in results)
    return [result.settling for result in results], [result.overshoot for result in results]


def inertia(axis, q, carried):
    model = ArmModel(PUMA)
    model.set_payload(carried)
    return axis_inertia(model, q, axis)


@pytest.mark.parametrize(("locked", "coupling"), [(True, "diagonal"), (False, "full")], ids=["one axis", "whole rows"])
@pytest.mark.parametrize("axis", some(range(6), 0, 4))
def test_scheduled_answers_are_alike_over_the_whole_range(axis, locked, coupling):
    settling, overshoot = over_the_range(axis, locked, coupling)
    assert max(settling) / min(settling) < 1.03
    assert max(overshoot) - min(overshoot) < 0.01


def test_axes_that_yield_to_one_another_are_what_the_diagonal_leaves_out():
    settling, overshoot = over_the_range(2, locked=False, coupling="diagonal")
    assert 1.03 < max(settling) / min(settling) < 1.08
    assert max(overshoot) < 0.01


def test_an_axis_or_a_posture_that_the_robot_has_not_is_refused():
    with pytest.raises(ValueError, match=r"\b1\b.*\b6\b"):
        step(experiment(6, STRETCHED, 0.1))
    with pytest.raises(ValueError, match=r"J1 at 160\.1 deg"):
        step(experiment(0, STRETCHED, 160.1 * DEG))


@pytest.mark.physics
def test_a_step_in_which_the_arm_touches_itself_is_no_response_of_the_servo():
    """The hand is stopped by link 1, 11 deg short of where the step ends."""
    robot = load_builtin("manutec_r3")
    request = StepRequest(
        robot=robot,
        axis=2,
        q=np.radians([0, 0, -130, 0, 0, 0]),
        size=-33 * DEG,
        plant="mujoco",
        ideal=False,
        seconds=0.6,
    )
    with pytest.raises(Fault, match=r"\bJ3\b.*\blink 1\b") as caught:
        step(request)
    assert caught.value.code == "RBL516"
    assert step(replace(request, size=-1 * DEG)).stable
