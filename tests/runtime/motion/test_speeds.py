"""How fast planned moves are and why, on moves that are made slow on purpose, and measured without the code."""

from dataclasses import dataclass

import numpy as np
import pytest

from runtime.core.frames import pose, rotation_about
from runtime.core.units import DEG
from runtime.motion.chain.timing import Limits
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear, MoveSpline
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.move_times import SLOWED
from runtime.motion.reached import Reached
from runtime.motion.speed_cap import MANUAL_SPEED
from runtime.motion.speeds import NEAR, REACHED, Speeds
from tests.runtime.motion.motions import ROBOTS, TOOL, Bench, bench, random_chain
from tests.together import together

BENT, STRAIGHT = (np.array([0.0, 60.0, -190.0, 0.0, bend, 0.0]) * DEG for bend in (-60.0, -3.0))
"""Postures of the Puma: the wrist well bent, and near the singularity where it is straight."""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A chain with what was found of it."""

    robot: Bench
    commands: list[Command]
    plan: ChainPlan
    moves: tuple[Reached, ...]

    def speed(self, k: int) -> float:
        """The highest speed of the tool in cycles that lie within move ``k``, m/s."""
        part = self.plan.parts[k]
        points = self.robot.tool(self.plan.q[part.first + (k > 0) : part.last + 1])[:, :3, 3]
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).max()) / self.robot.profile.period_s


def judged(commands, start=BENT, override=1.0, cap=None, robot="puma560") -> Judged:
    found = bench(robot)
    plan = found.planner.chain(start, commands, TOOL, override, cap)
    speeds = Speeds(found.planner, plan, commands, TOOL, override, cap)
    return Judged(robot=found, commands=commands, plan=plan, moves=speeds.moves)


def line(by, *, turn=0.0, start=BENT, **options) -> MoveLinear:
    """A line to ``by`` (3,) m from where the tool is at ``start``, turned by ``turn`` deg about its own axis."""
    X = bench("puma560").tool(start)
    R = X[:3, :3] @ rotation_about(np.array([0.0, 0.0, 1.0]), turn * DEG)
    return MoveLinear(X_world_tool=pose(X[:3, 3] + np.array(by), R), **options)


def straight_wrist(**options) -> list[Command]:
    first = line((0.0, 0.05, 0.0), start=STRAIGHT, wrist="keep", speed=0.3, zone=0.01, **options)
    return [first, line((0.0, 0.05, 0.1), start=STRAIGHT, wrist="keep", speed=0.3, **options)]


def zigzag(zone: float) -> list[Command]:
    corners = [(0.0, 0.01, 0.0), (0.0, 0.01, 0.01), (0.0, 0.0, 0.01), (0.0, 0.0, 0.02), (0.0, 0.01, 0.02)]
    return [line(by, speed=0.3, zone=zone) for by in corners]


def tiny_arc() -> list[Command]:
    X = bench("puma560").tool(BENT)
    via, end = (pose(X[:3, 3] + np.array(by), X[:3, :3]) for by in ((-0.008, 0.0, 0.0), (-0.00117, -0.00283, 0.0)))
    return [MoveArc(X_via=via, X_world_tool=end, speed=0.4)]


def wave() -> list[Command]:
    X = bench("puma560").tool(BENT)
    places = [(0.0, 0.03 * (k + 1), 0.01 * (-1) ** k) for k in range(4)]
    *through, end = (pose(X[:3, 3] + np.array(by), X[:3, :3]) for by in places)
    return [MoveSpline(X_through=tuple(through), X_world_tool=end, speed=0.6)]


SLOW = {
    "a joint, fast beside a singularity": (straight_wrist(), {"start": STRAIGHT}, 0, "joint"),
    "the same under an override": (straight_wrist(override=0.5), {"start": STRAIGHT, "override": 0.8}, 0, "joint"),
    "a single move beside it": (
        [line((0.0, 0.1, 0.0), start=STRAIGHT, wrist="keep", speed=0.9)],
        {"start": STRAIGHT},
        0,
        "joint",
    ),
    "a tool that turns far on a short path": ([line((0.0, 0.06, 0.0), turn=170.0, speed=0.25)], {}, 0, "turning"),
    "a tool that turns in place": ([line((0.0, 0.0, 0.0), turn=150.0, duration=0.3)], {}, 0, "turning"),
    "a corner in a tiny zone": (zigzag(0.0003), {}, 2, "corner"),
    "a line between two stops": ([line((0.02, 0.0, 0.0), speed=0.5)], {}, 0, "length"),
    "a line that hardly moves": ([line((0.0005, 0.0, 0.0), speed=0.5)], {}, 0, "length"),
    "a spline that bends": (wave(), {}, 0, "radius"),
    "a tiny arc": (tiny_arc(), {}, 0, "radius"),
    "a joint move between two stops": ([MoveJoint(q_end=BENT + 5.0 * DEG)], {}, 0, "length"),
    "a TIME that is too short": ([line((0.0, 0.1, 0.0), duration=0.3)], {}, 0, "length"),
    "a joint move in too short a TIME": ([MoveJoint(q_end=BENT + [0, 0, 0, 0, 0, 1.6], duration=0.1)], {}, 0, "joint"),
    "the cap of MANUAL": ([line((0.0, 0.3, 0.0), speed=0.5)], {"cap": MANUAL_SPEED}, 0, "cap"),
}


@together("case", SLOW)
def test_each_move_is_slow_for_the_reason_that_it_was_given(case):
    commands, options, number, kind = SLOW[case]
    found = judged(commands, **options)
    why = found.moves[number].why
    assert why is not None and why.kind == kind, why
    assert why.text and why.remedy and "nan" not in why.text
    assert (why.axis is not None) == (kind == "joint")


def test_moves_that_keep_what_they_are_programmed_have_no_reason():
    commands = [
        line((0.0, 0.15, 0.0), speed=0.2, zone=0.02),
        line((0.0, 0.15, 0.15), duration=3.0),
        MoveJoint(q_end=BENT + 40.0 * DEG * np.array([1.0, 0, 0, 0, 0, 0]), speed=0.2),
        MoveJoint(q_end=BENT, duration=4.0),
    ]
    moves = judged(commands).moves
    assert [move.why for move in moves] == [None] * 4
    assert [move.programmed for move in moves] == [0.2, None, 0.2, None]
    assert [move.expected_s > 0.0 for move in moves] == [True, False, False, False]


@pytest.mark.parametrize("robot", ROBOTS)
def test_speeds_and_times_are_those_of_the_rows(robot):
    """On random chains; a move is as fast as its rows, and all together take the time of the chain."""
    random, found = np.random.default_rng(5), bench(robot)
    reasons = 0
    for _ in range(2):
        start, commands = random_chain(found, random, 4)
        chain = judged(commands, start=start, robot=robot)
        seconds = sum(move.seconds for move in chain.moves)
        assert seconds == pytest.approx((len(chain.plan.q) - 1) * found.profile.period_s, abs=1e-9)
        for k, (move, part) in enumerate(zip(chain.moves, chain.plan.parts, strict=True)):
            assert abs(move.seconds - part.planned_s) <= found.profile.period_s
            if part.path is None or move.programmed is None:
                continue
            assert move.reached == pytest.approx(min(chain.speed(k), move.programmed), rel=1e-9)
            slow = move.reached < REACHED * move.programmed or move.seconds > SLOWED * move.expected_s
            assert (move.why is not None) == slow
            reasons += slow
    assert reasons > 0


def test_a_joint_takes_its_limit_at_the_place_that_is_named():
    chain = judged(straight_wrist(), start=STRAIGHT)
    why, part = chain.moves[0].why, chain.plan.parts[0]
    row = int(np.searchsorted(part.s, why.at))
    limits = chain.robot.planner.limits.joints
    near = Limits.passed(limits, chain.plan.setpoints)[("speed", "acceleration", "jerk").index(why.quantity)]
    # three set-points stand before the first
    assert near[row : row + 6, why.axis].max() == pytest.approx(why.share, abs=0.02)
    assert NEAR <= why.share <= 1.0 + 1e-9
    assert f"J{why.axis + 1}" in why.short and why.quantity[:4] in why.short


def test_a_corner_is_named_from_either_of_its_moves_with_the_speed_in_it():
    chain = judged([line((0.0, 0.03, 0.0), speed=0.3, zone=0.003), line((0.0, 0.03, 0.03), speed=0.3)])
    first, second = (move.why for move in chain.moves)
    assert "at its end" in first.text
    assert "at its start" in second.text
    row = chain.plan.parts[0].last
    points = chain.robot.tool(chain.plan.q[row - 3 : row + 4])[:, :3, 3]
    slowest = np.linalg.norm(np.diff(points, axis=0), axis=1).min() / chain.robot.profile.period_s
    assert float(second.text.split(" mm/s")[0].split()[-1]) == pytest.approx(1e3 * slowest, abs=0.06)
    assert "ZONE" not in second.remedy


def test_a_wide_zone_takes_the_reason_away():
    commands = [line((0.0, 0.3, 0.0), speed=0.1, zone=0.05), line((0.0, 0.3, 0.3), speed=0.1)]
    assert [move.why for move in judged(commands).moves] == [None, None]


def test_a_dense_polyline_names_its_ramp_at_its_ends_alone():
    """Moves of 1 mm on one line: those in the middle keep their speed, those of the ramp are too short for it."""
    commands = [line((0.0, 0.001 * (k + 1), 0.0), speed=0.2, zone=0.0005) for k in range(50)]
    whys = [None if move.why is None else move.why.kind for move in judged(commands).moves]
    assert set(whys[:6]) == {"length"}
    assert set(whys[22:28]) == {None}
