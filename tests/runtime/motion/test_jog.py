"""Jogs: where they lead, what bounds them, and that they are slow only where a limit binds."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.core.units import DEG, MM
from runtime.motion.jog import EDGE, STANDOFF, Jog, JogPlan, JogPlanner, JointJog, ToolJog
from runtime.motion.speed_cap import MANUAL_SPEED, PLANNED
from tests.campaign import size
from tests.messages import fields, numbers
from tests.runtime.motion.motions import ROBOTS, TOOL, Bench, bench

SWING = 5e-6
"""Between set-points the command may pass a limit by so much, rad."""


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What the servo sees of a jog, by differences of places: the largest speed m/s, shares of the joints' limits."""

    point: float
    speed: float
    acceleration: float
    beyond: float


def plan(robot: Bench, q: Array, jog: Jog, speed: float = 0.25) -> JogPlan:
    return JogPlanner(robot.spec, robot.kinematics, robot.profile).plan(q, jog, TOOL, speed)


def seen(robot: Bench, q: Array, found: JogPlan) -> Seen:
    motion = robot.at_the_servo(np.concatenate([q[None], found.rows]))
    flange = robot.kinematics.forward(motion[0])
    places = np.stack([(flange @ TOOL)[:, :3, 3], flange[:, :3, 3]])
    lower, upper = np.minimum(robot.spec.lower, q), np.maximum(robot.spec.upper, q)
    return Seen(
        point=float(np.linalg.norm(np.diff(places, axis=1), axis=2).max()) * 1e3,
        speed=float((np.abs(motion[1]) / robot.speed).max()),
        acceleration=float((np.abs(motion[2]) / robot.acceleration).max()),
        beyond=float(np.maximum(lower - motion[0], motion[0] - upper).max()),
    )


def assert_keeps_limits(robot: Bench, q: Array, found: JogPlan, speed: float) -> None:
    it = seen(robot, q, found)
    assert it.point <= MANUAL_SPEED * PLANNED * speed * (1.0 + 1e-3)
    assert max(it.speed, it.acceleration) <= 1.0 + 1e-9
    assert it.beyond <= SWING


def random_posture(robot: Bench, random: np.random.Generator) -> Array:
    """A posture anywhere: inside, at the wrist singularity, near it, at a limit or a little beyond one."""
    lower, upper = robot.spec.lower, robot.spec.upper
    q, axis = random.uniform(lower, upper), int(random.integers(robot.spec.n))
    kind = int(random.integers(5))
    if kind == 1:
        q[4] = 0.0
    if kind == 2:
        q[4] = random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-9.0, -1.0)
    if kind >= 3:
        out = 0.5 * DEG * (kind - 3)
        q[axis] = upper[axis] + out if random.random() < 0.5 else lower[axis] - out
    return np.asarray(q)


def random_jog(robot: Bench, q: Array, random: np.random.Generator) -> Jog:
    sign = float(random.choice([-1.0, 1.0]))
    turn = math.inf if random.random() < 0.3 else float(random.choice([0.1, 1.0, 5.0, 10.0, 45.0])) * DEG
    if random.random() < 0.3:
        return JointJog(axis=int(random.integers(robot.spec.n)), amount=sign * turn)
    direction = int(random.integers(6))
    way = math.inf if math.isinf(turn) else float(random.choice([0.1, 1.0, 10.0, 50.0, 100.0])) * MM
    frame = pose((0.0, 0.0, 0.0), robot.tool(q)[:3, :3]) if random.random() < 0.5 else np.eye(4)
    return ToolJog.along(frame, direction, sign * (way if direction < 3 else turn))


@pytest.mark.parametrize("name", ROBOTS)
def test_every_jog_from_anywhere_keeps_all_limits_and_its_path(name):
    robot, random = bench(name), np.random.default_rng(7)
    moved = 0
    for _ in range(size(1000, 40)):
        q, speed = random_posture(robot, random), float(random.choice([0.05, 0.25, 1.0]))
        jog = random_jog(robot, q, random)
        try:
            found = plan(robot, q, jog, speed)
        except Fault as refused:
            assert refused.code in ("RBL410", "RBL411", "RBL412")
            continue
        moved += 1
        assert_keeps_limits(robot, q, found, speed)
        if isinstance(jog, ToolJog):
            off = robot.tool(found.rows)[:, :3, 3] - robot.tool(q)[:3, 3]
            along = np.zeros(len(off)) if jog.turns else off @ jog.vector
            assert np.linalg.norm(off - along[:, None] * jog.vector, axis=1).max() < 0.1 * MM
            if not jog.turns:
                assert along[-1] == pytest.approx(found.goes, abs=1e-6)
        if not math.isinf(jog.amount):
            assert found.goes == pytest.approx(jog.amount, abs=1e-9) or found.end.kind == "limit"
    assert moved > 0.3 * size(1000, 40)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_straight_jog_reaches_its_speed_and_gains_it_smoothly(name):
    robot = bench(name)
    found = plan(robot, robot.home(), ToolJog.along(np.eye(4), 2, 100 * MM), 1.0)
    it = seen(robot, robot.home(), found)
    assert 0.99 * MANUAL_SPEED * PLANNED < it.point
    places = robot.tool(np.concatenate([[robot.home()] * 2, found.rows, [found.rows[-1]] * 2]))[:, 2, 3]
    gained = np.diff(places, 2) / 8e-3**2
    assert np.abs(gained).max() < 1.3 * MANUAL_SPEED / 0.25
    assert np.abs(np.diff(gained)).max() < 0.3  # m/s2 from one cycle to the next: no step of acceleration


@pytest.mark.parametrize("name", ROBOTS)
def test_near_a_singularity_a_jog_is_slow_there_only(name):
    robot = bench(name)
    q = robot.home()
    q[4] = 1.0 * DEG
    far, near = (plan(robot, each, ToolJog.along(np.eye(4), 1, 100 * MM), 1.0) for each in (robot.home(), q))
    assert far.slow is None and near.slow is not None and near.slow.share < 0.5
    assert near.slow.axis in (3, 5) and abs(near.slow.at) < 20 * MM
    assert seen(robot, q, near).point > 0.6 * MANUAL_SPEED * PLANNED
    assert_keeps_limits(robot, q, near, 1.0)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("direction", range(6))
def test_a_jog_begins_at_the_wrist_singularity(name, direction):
    robot = bench(name)
    q = robot.home()
    q[4] = 0.0
    amount = 5 * MM if direction < 3 else 2 * DEG
    ways = []
    for sign in (1.0, -1.0):
        try:
            ways.append(plan(robot, q, ToolJog.along(np.eye(4), direction, sign * amount)))
        except Fault:
            continue
        assert_keeps_limits(robot, q, ways[-1], 0.25)
    assert ways


@pytest.mark.parametrize("name", ROBOTS)
def test_a_joint_jog_leads_out_of_every_limit_and_not_further(name):
    robot = bench(name)
    for axis in range(robot.spec.n):
        for limit, inward in ((robot.spec.upper, -1.0), (robot.spec.lower, 1.0)):
            for out in (0.0, 1e-12, 0.5 * DEG):
                q = robot.home()
                q[axis] = limit[axis] - inward * out
                found = plan(robot, q, JointJog(axis=axis, amount=inward * 5.0 * DEG))
                assert found.rows[-1, axis] == pytest.approx(q[axis] + inward * 5.0 * DEG, abs=1e-12)
                assert_keeps_limits(robot, q, found, 0.25)
                for amount in (1.0 * DEG, math.inf):
                    with pytest.raises(Fault) as refused:
                        plan(robot, q, JointJog(axis=axis, amount=-inward * amount))
                    assert refused.value.code == "RBL411" and f"J{axis + 1}" in fields(refused.value.message)


def test_a_fast_start_at_a_limit_does_not_swing_past_it():
    robot = bench("manutec_r3")
    # near its singularity the wrist turns fast for a small turn of the tool, and here J6 begins at its limit
    q = np.array([69.723, -60.515, 36.248, -17.903, -2.245, -265.0]) * DEG
    q[5] = robot.spec.lower[5]
    found = plan(robot, q, ToolJog.along(np.eye(4), 4, -10.0 * DEG), 1.0)
    assert found.rows[0, 5] - q[5] > 3e-5, "the first step is large"
    assert_keeps_limits(robot, q, found, 1.0)


def test_as_far_as_it_goes_ends_before_the_limit_and_an_amount_may_end_at_it():
    robot = bench("puma560")
    q = robot.home()
    far = plan(robot, q, JointJog(axis=3, amount=math.inf), 1.0)
    assert far.end.kind == "limit" and far.end.axis == 3 and far.end.limit == robot.spec.upper[3]
    assert far.rows[-1, 3] == pytest.approx(robot.spec.upper[3] - STANDOFF, abs=1e-12)
    room = float(robot.spec.upper[3] - q[3])
    to_it = plan(robot, q, JointJog(axis=3, amount=room - EDGE), 1.0)
    assert_keeps_limits(robot, q, to_it, 1.0)
    with pytest.raises(Fault) as refused:
        plan(robot, q, JointJog(axis=3, amount=room + 1.0 * DEG))
    assert refused.value.code == "RBL411"
    assert fields(refused.value.message) >= {"J4", "170", "deg"}


def test_amounts_out_of_reach_are_refused_with_how_far_the_arm_can_go():
    robot = bench("puma560")
    far = plan(robot, robot.home(), ToolJog.along(np.eye(4), 0, math.inf))
    assert far.end.kind == "reach" and far.slow is not None
    with pytest.raises(Fault) as refused:
        plan(robot, robot.home(), ToolJog.along(np.eye(4), 0, 2.0))
    assert refused.value.code == "RBL410"
    assert fields(refused.value.message) >= {"2000", "mm"}
    most = numbers(refused.value.message)
    assert any(each == pytest.approx(far.goes / MM + 1.0, abs=0.5) for each in most)


def test_a_turn_goes_round_once():
    robot = bench("irb2400")
    found = plan(robot, robot.home(), ToolJog.along(np.eye(4), 5, math.inf), 1.0)
    assert found.end.kind == "turn" and found.goes == pytest.approx(2.0 * math.pi)
    with pytest.raises(Fault) as refused:
        plan(robot, robot.home(), ToolJog.along(np.eye(4), 5, 400.0 * DEG), 1.0)
    assert refused.value.code == "RBL404"


def test_a_slow_jog_as_far_as_it_goes_is_planned_for_some_time_only():
    robot = bench("irb2400")
    for jog in (JointJog(axis=0, amount=math.inf), ToolJog.along(np.eye(4), 1, -math.inf)):
        found = plan(robot, robot.home(), jog, 0.01)
        assert found.end.kind == "time" and found.seconds < 130.0


@pytest.mark.parametrize("speed", [0.0, -0.1, 1.01, math.nan])
def test_a_speed_that_is_no_share_is_misuse(speed):
    with pytest.raises(ValueError):
        plan(bench("puma560"), bench("puma560").home(), JointJog(axis=0, amount=0.1), speed)


@pytest.mark.parametrize("amount", [0.0, math.nan])
def test_an_amount_that_is_none_is_misuse(amount):
    with pytest.raises(ValueError):
        plan(bench("puma560"), bench("puma560").home(), JointJog(axis=0, amount=amount))
