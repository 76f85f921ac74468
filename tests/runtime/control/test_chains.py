"""Moves in a row on the ideal arm: what is sent, which line runs, stops in a blend, overrides, under a seam sensor."""

import numpy as np
import pytest

from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.core.program_line import ProgramLine
from runtime.core.units import MM
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear
from runtime.motion.motion_planner import ChainFault, ChainPlan
from runtime.motion.seam import SeamLimits, SeamTracker
from tests.runtime.control import test_seam_stops
from tests.runtime.control.test_controller import CELL, carried_payload, controller, down, signals

LINES = tuple(ProgramLine(line=line, number=10 * line) for line in (1, 2, 3))


def corner(robot: Controller, zone: float = 0.05) -> list[Command]:
    """Down, sideways, and back on an arc."""
    X = robot.tool_poses(np.array(robot.areas.ina))
    low, aside = (pose(X[:3, 3] + np.array(step), X[:3, :3]) for step in ((0, 0, -0.15), (0, 0.15, -0.15)))
    via = pose(X[:3, 3] + np.array([0.0, 0.1, 0.0]))
    return [
        MoveLinear(X_world_tool=low, zone=zone, speed=0.4),
        MoveLinear(X_world_tool=aside, zone=zone, speed=0.4),
        MoveArc(X_via=via, X_world_tool=X, speed=0.4),
    ]


def started(cycles: int = 0, lines: tuple[ProgramLine, ...] = LINES) -> tuple[Controller, ChainPlan]:
    robot = controller()
    robot.load(carried_payload())
    chain = robot.move_chain(corner(robot), lines)
    for _ in range(cycles):
        assert robot.cycle()
    return robot, chain


def run_out(robot: Controller) -> None:
    while robot.moving:
        assert robot.cycle()


def test_every_row_of_the_chain_is_sent_and_none_else():
    robot, chain = started()
    assert [each.cycles > 0 for each in chain.corners] == [True, True]
    run_out(robot)
    log = signals(robot)
    np.testing.assert_array_equal(log["q_plan"][::8][: len(chain.q)], chain.setpoints)
    np.testing.assert_array_equal(robot.areas.ina, chain.q[-1])
    assert robot.recorder.cycle == len(chain.q) - 1 + 4
    ddq = np.abs(np.diff(log["dq_cmd"], axis=0)) / 1e-3
    assert (ddq <= CELL.robot.per_axis("limits", "acceleration") * 1.001).all()


def test_the_line_changes_in_the_middle_of_a_corner_with_the_rows_it_belongs_to():
    robot, chain = started()
    assert (robot.statement, robot.chain_index) == (LINES[0], 0)
    seen = []
    while robot.moving:
        robot.cycle()
        seen.append(robot.chain_index)
        assert robot.statement == LINES[robot.chain_index]
    assert sorted(set(seen)) == [0, 1, 2]
    assert seen == sorted(seen)
    log = signals(robot)
    lines = log["line"][::8][: len(chain.q)]
    np.testing.assert_array_equal(lines, np.array([each.line for each in LINES])[chain.command])
    np.testing.assert_array_equal(log["number"], 10 * log["line"])
    moves = np.flatnonzero(np.diff(lines)) + 1
    for row, before, corner in zip(moves, chain.parts, chain.corners, strict=False):
        assert row == before.last + 1
        assert corner.cycles > 0
        there = robot.tool_poses(before.plan.q[-1:])[0, :3, 3]
        off = np.linalg.norm(robot.tool_poses(chain.q)[:, :3, 3] - there, axis=1)
        assert abs(int(np.argmin(off)) - row) <= 2


def test_without_lines_the_line_is_the_callers_and_there_is_one_for_every_move():
    robot, _ = started(lines=())
    robot.statement = LINES[2]
    run_out(robot)
    assert robot.statement == LINES[2]
    with pytest.raises(ValueError, match=r"3 .*2 "):
        started(lines=LINES[:2])


def test_a_chain_that_is_refused_moves_nothing_and_names_its_move():
    robot = controller()
    commands = corner(robot)
    robot.statement = LINES[1]
    far = MoveLinear(X_world_tool=pose((3.0, 0.0, 0.5)))
    with pytest.raises(ChainFault, match="RBL410") as caught:
        robot.move_chain([*commands, far], (*LINES, LINES[0]))
    assert caught.value.index == 3
    assert not robot.moving
    assert robot.statement == LINES[1]
    robot.move(commands[0])
    with pytest.raises(RuntimeError, match="running"):
        robot.move_chain(commands, LINES)


@pytest.mark.parametrize("kind", ["line", "arc", "joint"])
def test_a_move_alone_may_be_of_any_kind(kind):
    robot = controller()
    first, _, last = corner(robot)
    q = np.array(robot.areas.ina)
    if kind == "arc":
        X = robot.tool_poses(q)
        via, end = (pose(X[:3, 3] + np.array(step), X[:3, :3]) for step in ((0.05, 0.05, 0.0), (0.0, 0.1, 0.0)))
        last = MoveArc(X_via=via, X_world_tool=end)
    command = {"line": first, "arc": last, "joint": MoveJoint(q_end=q + 0.2, speed=0.5)}[kind]
    plan = robot.move(command)
    assert isinstance(plan, MovePlan)
    run_out(robot)
    np.testing.assert_array_equal(signals(robot)["q_plan"][::8][: len(plan.q)], plan.setpoints)
    assert (plan.path is None) == (kind == "joint")
    assert robot.wrist_mode == 0


def off_way(robot: Controller, chain: ChainPlan, q: Array) -> float:
    """Return the largest distance of tool points from the way of the chain, as it is played without a stop, m."""
    twin = controller()
    twin.move_chain(corner(twin))
    run_out(twin)
    way = twin.tool_poses(signals(twin)["q_cmd"])[:, :3, 3]
    points = robot.tool_poses(q)[:, :3, 3]
    return float(np.max([np.linalg.norm(way - p, axis=1).min() for p in points[::4]]))


@pytest.mark.parametrize("shift", [-12, -4, -1, 0, 3, 8])
@pytest.mark.parametrize("index", [0, 1])
def test_a_stop_in_or_before_a_blend_ends_at_rest_on_the_blended_way_within_joint_limits(shift, index):
    _, whole = started()
    robot, chain = started(whole.parts[index].last + shift)
    statement = robot.statement
    robot.alarm("RBL530", "stopped")
    cycles = 0
    while robot.cycle():
        cycles += 1
        assert cycles < 120
    log = signals(robot)
    assert off_way(robot, chain, log["q_cmd"]) < 5e-4  # points of the way are 0.4 mm apart
    assert np.abs(log["dq_cmd"][-1]).max() < 1e-9
    assert (np.abs(log["dq_cmd"]) <= CELL.robot.per_axis("limits", "speed") * 1.001).all()
    ddq = np.abs(np.diff(log["dq_cmd"], axis=0)) / 1e-3  # sees a little of what lies between two ticks
    assert (ddq <= CELL.robot.per_axis("limits", "acceleration") * 1.02).all()
    assert robot.recorder.cycle < len(chain.q)
    assert robot.statement == statement  # a stop belongs to the line that ran
    assert robot.alarms[0].statement == statement
    robot.acknowledge()
    assert not robot.moving
    robot.move(down(robot, 0.02))
    run_out(robot)


def test_the_override_holds_for_moves_planned_after_it_and_leaves_accelerations():
    robot = controller()
    assert robot.override == 1.0
    X = robot.tool_poses(np.array(robot.areas.ina))

    def fastest(dy: float) -> float:
        plan = robot.move(MoveLinear(X_world_tool=pose(X[:3, 3] + [0.0, dy, 0.0], X[:3, :3]), speed=0.3))
        run_out(robot)
        return float(np.diff(plan.s).max() * plan.path.length / 8e-3)

    assert fastest(0.2) == pytest.approx(0.3, rel=0.02)
    robot.override = 0.25
    assert fastest(0.0) == pytest.approx(0.075, rel=0.02)
    chain = robot.move_chain(corner(robot), LINES)
    assert all(np.diff(part.plan.s).max() * part.path.length / 8e-3 <= 0.1 * (1 + 1e-6) for part in chain.parts)
    assert chain.corners[0].cycles > 0
    for wrong in (0.0, -0.5, 1.001, float("nan")):
        with pytest.raises(Fault, match=r"RBL404: OVERRIDE.* 0 .*100"):
            robot.override = wrong
    assert robot.override == 0.25


def off(y_mm: float = 2.0) -> SeamTracker:
    return SeamTracker("torch", SeamLimits(), 8e-3, lambda way, travel: np.array([0.0, y_mm * MM, 0.0, 0.0, 0.0, 0.0]))


def lines_of(robot: Controller, *steps, **options) -> list[Command]:
    X = robot.tool_poses(np.array(robot.areas.ina))
    commands: list[Command] = []
    for step in steps:
        X = pose(X[:3, 3] + np.array(step), X[:3, :3])
        commands.append(MoveLinear(X_world_tool=X, speed=0.1, **options))
    return commands


STEPS = ((0.0, 0.0, -0.06), (0.0, 0.06, 0.0), (0.0, 0.0, 0.06))


def test_under_a_seam_sensor_a_chain_is_moves_one_after_the_other_without_blends():
    robot, single = controller(), controller()
    commands = lines_of(robot, *STEPS, zone=0.03)
    robot.seam(off())
    chain = robot.move_chain(commands, LINES)
    assert [each.cycles for each in chain.corners] == [0, 0]
    seen = []
    while robot.moving:
        assert robot.cycle()
        seen.append((robot.chain_index, robot.statement))
    assert list(dict.fromkeys(seen)) == list(enumerate(LINES))
    single.seam(off())
    for command in commands:
        single.move(command)
        run_out(single)
    np.testing.assert_allclose(robot.areas.ina, single.areas.ina, atol=1e-4)
    end = robot.tool_poses(np.array(robot.areas.ina))[:3, 3] - commands[-1].X_world_tool[:3, 3]
    np.testing.assert_allclose(end, [0.0, 2.0 * MM, 0.0], atol=2e-5)
    sent = signals(robot)["q_plan"][::8]
    assert np.abs(np.diff(sent, axis=0)).max() < 0.05  # nothing jumps where one move follows the other


def test_under_a_seam_sensor_an_override_scales_the_speed():
    times, fastest = [], []
    for share in (1.0, 0.5):
        robot = controller()
        robot.seam(off())
        robot.move(lines_of(robot, (0.0, 0.2, 0.0), override=share)[0])
        run_out(robot)
        way = robot.tool_poses(signals(robot)["q_plan"][::8])[:, 1, 3]
        times.append(robot.time_us)
        fastest.append(np.diff(way[60:-60]).max() / 8e-3)  # once the deviation of the start is made good
    assert fastest == pytest.approx([0.1, 0.05], rel=0.02)
    assert times[1] > 1.8 * times[0]


def test_a_stop_under_a_seam_sensor_drops_the_moves_that_wait():
    robot = controller()
    robot.seam(off())
    robot.move_chain(lines_of(robot, *STEPS), LINES)
    for _ in range(30):
        robot.cycle()
    robot.alarm("RBL530", "stopped")
    cycles = 0
    while robot.cycle():
        cycles += 1
        assert cycles < 120
    assert robot.statement == LINES[0]
    robot.acknowledge()
    assert not robot.moving


def test_a_seam_is_followed_on_straight_moves_only_and_the_move_is_named():
    robot = controller()
    robot.seam(off())
    commands = [*lines_of(robot, STEPS[0]), MoveJoint(q_end=np.array(robot.areas.ina) + 0.1)]
    with pytest.raises(ChainFault, match=r"RBL412: .*seam") as caught:
        robot.move_chain(commands)
    assert caught.value.index == 1
    assert not robot.moving
    with pytest.raises(Fault, match="RBL412"):
        robot.move(commands[1])
    robot.seam(None)
    robot.move(commands[1])
    run_out(robot)


def test_the_wrist_lamp_follows_the_rows_of_a_chain():
    """A line on which the wrist changes the sign of J5, blended into one on which it does not."""
    start, end = np.radians([-20, 10, 30, 10, 65, -15]), np.radians([0, -10, 45, -55, -65, 85])
    robot = test_seam_stops.controller(home=start)
    X = robot.tool_poses(end)
    chain = robot.move_chain(
        [
            MoveLinear(X_world_tool=X, q_end=end, speed=0.3, zone=0.05),
            MoveLinear(X_world_tool=pose(X[:3, 3] + [0.0, 0.0, 0.1], X[:3, :3]), speed=0.3),
        ],
        LINES[:2],
    )
    assert chain.parts[0].wrist is not None
    assert chain.corners[0].cycles > 0
    modes = []
    while robot.moving:
        assert robot.cycle()
        modes.append(robot.wrist_mode)
    assert 1 in modes
    assert modes[-1] == 0
    log = signals(robot)
    np.testing.assert_array_equal(log["wrist_mode"][::8][: len(chain.q) - 1], chain.modes[:-1])
    assert (log["line"][log["wrist_mode"] == 1] == 1).all()
