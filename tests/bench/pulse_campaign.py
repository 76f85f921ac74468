"""Random straight moves of four machines as pulse tables, and what must be true of every one: ``make pulse-campaign``.

Each move is planned, put into tables and taken from them again. Counted are moves that break a law:

    sum       pulses of a channel are round(end) - round(start), to the pulse
    least     no step that is not empty is below the channel's lowest frequency
    step      every channel has rows for the same number of steps
    bound     the tool is off the line by no more than sum_m |dp/dq_m| delta_m (1/2 + debt_m)
    smooth    second difference of the way along the line within a' dT^2, and four times that bound
    hint      a move refused for its frequency goes at the speed that the refusal names
"""

import re
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from robolang.project.project import builtin_cell
from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.core.units import MM, badness
from runtime.motion.commands import MoveLinear
from runtime.pulses.channels import default_channels, motor_pulse
from runtime.pulses.emission import least_step
from runtime.pulses.machine import RobotArm, Stand
from runtime.pulses.mechanism import load_builtin
from runtime.pulses.move import counted, plan_move
from runtime.pulses.table import rows_of
from runtime.settings.profile import Profile
from tests.bench import figures
from tests.bench.figures import Row

MACHINES = ("xy", "cylindrical", "scara", "puma560")
STEPS_HZ = (50, 100, 200)
SLACK = 1.02
"""What the bound leaves out: the curvature of the mechanism over one pulse."""


@dataclass(slots=True)
class Count:
    """What was counted on one machine."""

    moves: int = 0
    refused: Counter = field(default_factory=Counter)
    broken: Counter = field(default_factory=Counter)
    rules: Counter = field(default_factory=Counter)
    appended: int = 0
    worst_mm: float = 0.0
    worst_share: float = 0.0
    steps: int = 0


def machine_and_pulses(name):
    """Return a machine and its pulse equivalents."""
    if name != "puma560":
        found = load_builtin(name)
        return found, found.pulse
    cell = builtin_cell()
    arm = RobotArm(cell.robot, Profile(), cell.hand.X_flange_tool, cell.home)
    return arm, tuple(motor_pulse(axis.motor.gear_ratio) for axis in cell.robot.axes)


def random_move(machine, rng):
    """Return a stand and a command from it: both ends within the joint ranges, the line perhaps not."""
    lower = np.array([joint.lower for joint in machine.joints])
    upper = np.array([joint.upper for joint in machine.joints])
    q = rng.uniform(lower, upper)
    speed = float(rng.uniform(20.0, 300.0)) * MM
    if isinstance(machine, RobotArm):
        X = machine.kinematics.forward(q) @ builtin_cell().hand.X_flange_tool
        k = rng.normal(size=3)
        R = rotation_about(k / np.linalg.norm(k), rng.uniform(0.0, 0.6)) @ X[:3, :3]
        way = rng.normal(size=3)
        end = X[:3, 3] + way / np.linalg.norm(way) * rng.uniform(0.001, 0.4)
        return Stand(q=q), MoveLinear(X_world_tool=pose(end, R), speed=speed)
    end = machine.points(rng.uniform(lower, upper)[None])[0]
    start = machine.points(q[None])[0]
    end = start + (end - start) * rng.uniform(0.002, 1.0)
    turn = rng.uniform(-1.0, 1.0) if "theta4" in machine.has else 0.0
    command = MoveLinear(X_world_tool=pose(end, rotation_about([0.0, 0.0, 1.0], turn)), speed=speed)
    return Stand(q=q, R=np.eye(3)), command


def levers(machine, q):
    """Return the largest |dp/dq_m| (M,) over postures q (K, M), by central differences."""
    found = []
    for m in range(q.shape[1]):
        h = np.zeros(q.shape[1])
        h[m] = 1e-5
        found.append(np.linalg.norm(machine.points(q + h) - machine.points(q - h), axis=1).max() / 2e-5)
    return np.array(found)


def examine(machine, channels, stand, command, step_hz, count):
    """Plan one move and count what is wrong with it."""
    start = counted(stand.q, channels)
    try:
        move = plan_move(machine, stand, command, channels, start, 1.0 / step_hz)
    except Fault as fault:
        count.refused[fault.code] += 1
        if fault.code == "RBL430":
            speed = float(re.search(r"SPEED ([\d.e+-]+)", fault.hint)[1])
            try:
                plan_move(machine, stand, replace(command, speed=speed * MM), channels, start, 1.0 / step_hz)
            except Fault:
                count.broken["hint"] += 1
        return
    if move.steps is None:
        return
    count.moves += 1
    pulses = np.array([channel.pulse for channel in channels])
    wanted = np.floor(move.q[-1] / pulses + 0.5) - start
    for k, (channel, each) in enumerate(zip(channels, move.emitted, strict=True)):
        sizes = np.abs(each.steps[each.steps != 0])
        count.rules[each.rule] += 1
        count.broken["sum"] += int(each.steps.sum() != wanted[k])
        count.broken["least"] += int((sizes < least_step(channel.min_hz, 1.0 / step_hz)).any())
        rows = rows_of(each.steps, int(start[k]), move.count, step_hz)
        lasting, at = 0.0, int(start[k])
        for row in rows:
            lasting += row.steps / step_hz if row.frequency == 0 else abs(row.target - at) / row.frequency
            at = row.target
        count.broken["step"] += int(not abs(lasting * step_hz - move.count) <= 1e-6 or at != start[k] + wanted[k])
    debts = np.array([each.debt for each in move.emitted])
    bound = SLACK * float((levers(machine, move.q) * pulses * (0.5 + debts)).sum()) + 1e-12
    count.broken["bound"] += int(not move.error.max() <= bound)
    start_point, end_point = move.curve.ends
    if move.curve.length > 1e-6:
        along = (move.points - start_point) @ (end_point - start_point) / move.curve.length
        hardest = move.steps.acceleration * move.curve.length / step_hz**2
        count.broken["smooth"] += int(not np.abs(np.diff(along, 2)).max(initial=0.0) <= hardest + 4.0 * bound)
    count.appended += move.count - move.steps.n
    count.worst_mm = max(count.worst_mm, float(move.error.max()) / MM, key=badness)
    count.worst_share = max(count.worst_share, float(move.error.max()) / bound, key=badness)
    count.steps += move.count


def campaign(moves, seed=11, min_hz=None):
    """Return what was counted on each machine, ``moves`` that could be planned on each."""
    found = {}
    for name in MACHINES:
        machine, pulses = machine_and_pulses(name)
        channels = default_channels(machine.joints, pulses, min_hz)
        rng, count = np.random.default_rng(seed), Count()
        while count.moves < moves:
            stand, command = random_move(machine, rng)
            placed = machine.placed(command.X_world_tool[:3, 3])
            examine(placed, channels, stand, command, int(rng.choice(STEPS_HZ)), count)
        found[name] = count
    return found


def cost(name: str, duration: float, rounds: int) -> tuple[float, int]:
    """Return the time of planning one move of a duration and making its rows, s, and its steps of 10 ms."""
    machine, pulses = machine_and_pulses(name)
    channels = default_channels(machine.joints, pulses, None)
    stand = machine.home
    end = machine.points(stand.q[None])[0] + [0.0, 0.1, 0.0]
    machine = machine.placed(end)
    R = np.eye(3)
    if isinstance(machine, RobotArm):
        R = (machine.kinematics.forward(stand.q) @ builtin_cell().hand.X_flange_tool)[:3, :3]
    start, times = counted(stand.q, channels), []
    command = MoveLinear(X_world_tool=pose(end, R), duration=duration)
    for _ in range(rounds):
        began = time.perf_counter()
        move = plan_move(machine, stand, command, channels, start, 0.01)
        for k, each in enumerate(move.emitted):
            rows_of(each.steps, int(start[k]), move.count, 100)
        times.append(time.perf_counter() - began)
    return min(times), move.count


def details(name: str, count: Count) -> Iterator[str]:
    """Say what was counted on a machine."""
    yield (
        f"{name}: {count.moves} moves, raised by document {count.rules['compensate']}, by ours {count.rules['hold']} "
        f"of {sum(count.rules.values())}, {count.appended} steps appended, at most {count.worst_mm:.4f} mm off, "
        f"{count.worst_share:.2f} of the bound"
    )
    if sum(count.broken.values()) or sum(count.refused.values()):
        yield f"{name}: broken {dict(+count.broken)}, refused {dict(count.refused)}"


def rows(smallest: bool) -> Iterator[Row]:
    """Count on every machine, and measure the cost of a move."""
    low, high = (campaign(3 if smallest else 500, min_hz=min_hz) for min_hz in (None, 500.0))
    both = [*low.values(), *high.values()]
    broken = [sum(sum(count.broken.values()) for count in found.values()) for found in (low, high)]
    yield Row(
        figure="2,000 random moves on four machines, steps of 5, 10, 20 ms; moves that break a law, at 191 "
        "and at 500 Hz",
        form="{}, {}",
        values=tuple(broken),
        good=not any(broken),
        details=tuple(
            line
            for hz, found in ((191, low), (500, high))
            for name, count in found.items()
            for line in details(f"{hz} Hz, {name}", count)
        ),
    )
    hints, refused = sum(count.broken["hint"] for count in both), sum(count.refused["RBL430"] for count in both)
    yield Row(
        figure="moves refused for frequency that do not go at the speed named",
        form="{} of {}",
        values=(hints, refused),
        good=hints == 0,
    )
    shares = [max((count.worst_share for count in found.values()), key=badness) for found in (low, high)]
    yield Row(
        figure="largest path error, in terms of its bound",
        form="{:.2f} at 191 Hz, {:.2f} at 500 Hz",
        values=tuple(shares),
        good=all(share <= 1.0 for share in shares),
    )
    yield Row(
        figure="steps appended after the end",
        form="{} at 191 Hz, {} at 500 Hz",
        values=tuple(sum(count.appended for count in found.values()) for found in (low, high)),
    )
    whole = 2.0 if smallest else 16.0
    long, short = ([cost(name, seconds, 1 if smallest else 5) for name in MACHINES] for seconds in (whole, whole / 2))
    yield Row(
        figure="a move of 1,600 steps planned and put into rows, ratio to 800 steps: xy, cylindrical, scara, puma560",
        form="{:.1f}, {:.1f}, {:.1f}, {:.1f}",
        values=tuple(a / b for (a, _), (b, _) in zip(long, short, strict=True)),
        details=tuple(
            f"{name}: {steps} steps, {1e3 * seconds:.1f} ms"
            for name, (seconds, steps) in zip(MACHINES, long, strict=True)
        ),
    )


if __name__ == "__main__":
    figures.run(rows)
