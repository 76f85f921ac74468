"""Random chains of moves on five robots, and what must be true of every one, judged without the planner's own code.

The set-points alone are looked at, as the control points of a cubic B-spline (docs/decisions/0066), whose speed and
acceleration are taken at their extremes within each cycle; the paths are those that the commands state. A chain is
planned as the controller does, from each stop to the next one.

fault    moves that can be planned one by one can be planned in a row
limits   speed, acceleration and, with ``JERK_HELD``, jerk of every joint at every moment
range    every joint within its range
zone     the tool is within the zone of a corner of its move wherever it is off the path of it
stop     at a stop the tool is where the program says, at rest, and the joints are where the next move begins
time     no chain is slower than the one that stops at every corner
"""

from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose, rotation_about
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear
from runtime.motion.motion_planner import ChainPlan
from tests.runtime.motion.motions import TOOL, Bench

ROBOTS = ("puma560", "irb2400", "manutec_r3", "ur5e", "cobra600")
"""Three with a closed form, one that is solved numerically, and one of four axes, of which one slides."""
HOME = {"ur5e": np.radians([0.0, -80.0, 100.0, -110.0, -90.0, 0.0])}
"""Where the arm is not folded and the wrist is bent, for a robot whose ranges hold many such regions."""
ON_PATH_M = 1e-9
"""A tool point nearer to a path, m, is on it."""
AT_REST_M = 1e-6
"""The same in the first and the last cycle: the command there is on the line between two set-points, beside an arc."""
SLACK = 1.0 + 1e-9
KINDS = ("fault", "limits", "range", "zone", "stop", "time")
ZONES = ((0.0, 0.0), (5e-4, 5e-3), (5e-3, 0.03), (0.3, 0.3))
"""Ranges of zones, m: a stop, small, as long as short moves, and longer than any move."""
LONGEST_M = 0.25
JERK_HELD = True
"""Whether the planner keeps the jerk of the joints, which is then judged with the other limits."""


@dataclass(frozen=True, kw_only=True)
class Chain:
    """Moves from ``start`` (n,), ``ends`` (K + 1, n) the joints at which they begin and end, the first included.

    ``alone`` (K,) are the cycles that each takes when it stops at both ends.
    """

    start: Array
    commands: tuple[Command, ...]
    ends: tuple[Array, ...]
    alone: tuple[int, ...]

    def runs(self) -> list["Chain"]:
        """Return the parts between stops."""
        found, first = [], 0
        for k, command in enumerate(self.commands):
            if not command.zone > 0.0 or k == len(self.commands) - 1:
                commands, ends = self.commands[first : k + 1], self.ends[first : k + 2]
                found.append(Chain(start=ends[0], commands=commands, ends=ends, alone=self.alone[first : k + 1]))
                first = k + 1
        return found


def random_move(robot: Bench, q: Array, random: np.random.Generator) -> Command:
    """Return a move of up to 0.25 m from joint angles q (n,) with random options; not every one can be planned."""
    X = robot.tool(q)
    off = random.normal(size=3)
    off[2] *= 1.0 if robot.spec.n == 6 else 0.3
    off *= 10.0 ** random.uniform(-2.7, np.log10(LONGEST_M)) / np.linalg.norm(off)
    axis = random.normal(size=3) if robot.spec.n == 6 else np.array([0.0, 0.0, 1.0])
    turn = rotation_about(axis / np.linalg.norm(axis), random.uniform(0.0, 0.5) if random.random() < 0.7 else 0.0)
    end = pose(X[:3, 3] + off, turn @ X[:3, :3])
    options = _options(random)
    kind = random.integers(3)
    if kind == 0:
        return MoveJoint(X_world_tool=end, speed=float(random.uniform(0.1, 1.0)), **options)
    options["speed"] = float(10.0 ** random.uniform(-1.3, 0.0))
    if robot.spec.n == 6 and random.random() < 0.3:
        options["wrist"] = str(random.choice(["auto", "keep"]))
        if random.random() < 0.3:
            options |= {"wrist": "auto", "held": ("TILT",)}
    if kind == 1:
        return MoveLinear(X_world_tool=end, **options)
    side = np.cross(off, random.normal(size=3))
    bulge = 0.5 * off + side * random.uniform(0.2, 0.8) * np.linalg.norm(off) / np.linalg.norm(side)
    return MoveArc(X_via=pose(X[:3, 3] + bulge), X_world_tool=end, **options)


def _options(random: np.random.Generator) -> dict[str, Any]:
    low, high = ZONES[random.choice(len(ZONES), p=(0.1, 0.3, 0.4, 0.2))]
    return {
        "zone": float(random.uniform(low, high)),
        "override": 1.0 if random.random() < 0.6 else float(random.uniform(0.2, 1.0)),
        "acceleration": 1.0 if random.random() < 0.6 else float(random.uniform(0.1, 1.0)),
        "duration": None if random.random() < 0.85 else float(random.uniform(0.2, 3.0)),
    }


def random_start(robot: Bench, random: np.random.Generator) -> Array:
    """Return joint angles (n,) from which most moves lead somewhere."""
    spec = robot.spec
    if spec.name in HOME:
        return np.asarray(HOME[spec.name] + random.uniform(-0.6, 0.6, spec.n))
    while True:
        q = spec.lower + (spec.upper - spec.lower) * random.uniform(0.3, 0.7, spec.n)
        if spec.n < 6:
            return np.asarray(q)
        q[4] = random.choice([-1.0, 1.0]) * random.uniform(0.5, 1.2)
        if robot.tool(q)[2, 3] > 0.2:
            return np.asarray(q)


def random_chain(robot: Bench, random: np.random.Generator, moves: int) -> Chain:
    """Return moves that can be planned one by one."""
    start = random_start(robot, random)
    ends, commands, alone = [start], [], []
    while len(commands) < moves:
        command = random_move(robot, ends[-1], random)
        try:
            plan = robot.planner.plan(ends[-1], replace(command, zone=0.0), TOOL)
        except Fault:
            continue
        commands.append(command)
        ends.append(plan.q[-1])
        alone.append(len(plan.q) - 1)
    return Chain(start=start, commands=tuple(commands), ends=tuple(ends), alone=tuple(alone))


def examine(robot: Bench, chain: Chain) -> tuple[Counter[str], float]:
    """Return what is wrong with a chain, by kind, and the share of the time that its zones save."""
    count: Counter[str] = Counter()
    cycles = stopping = 0
    for run in chain.runs():
        try:
            found = robot.planner.chain(run.start, run.commands, TOOL)
        except Fault:
            count["fault"] += 1
            continue
        count.update(broken(robot, run, found))
        cycles, stopping = cycles + len(found.q) - 1, stopping + sum(run.alone)
        count["time"] += int(not len(found.q) - 1 <= sum(run.alone))
    return count, 1.0 - cycles / max(stopping, 1)


def broken(robot: Bench, run: Chain, found: ChainPlan) -> Counter[str]:
    """Return what is wrong with the plan of moves between two stops."""
    setpoints = found.setpoints
    knots = spline(setpoints, np.zeros(1))[:, 0]
    spec = robot.spec
    points = robot.tool(knots)[:, :3, 3]
    ends = np.isin(np.arange(len(knots)), (0, len(knots) - 1))
    at_end = robot.tool(setpoints[-1:])[0, :3, 3] - target(robot, run, len(run.commands) - 1)
    return Counter(
        limits=int(not worst_share(robot, setpoints, jerk=JERK_HELD) <= SLACK),
        range=int(not ((setpoints >= spec.lower - 1e-8) & (setpoints <= spec.upper + 1e-8)).all()),
        zone=int(
            not off_path(robot, run, points[~ends], found.command[~ends]) <= ON_PATH_M
            or not off_path(robot, run, points[ends], found.command[ends]) <= AT_REST_M
        ),
        stop=int(
            not np.linalg.norm(at_end) <= ON_PATH_M
            or not np.array_equal(setpoints[0], run.start)
            or not np.array_equal(setpoints[-1], run.ends[-1])
        ),
    )


def around(setpoints: Array) -> Array:
    """Return set-points (N + 1, n) with those before and after, at rest, that a cubic segment needs (N + 7, n)."""
    return np.concatenate([np.repeat(setpoints[:1], 3, axis=0), setpoints, np.repeat(setpoints[-1:], 3, axis=0)])


BASIS = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0
"""Coefficients of 1, u, u^2, u^3 of the four control points of a segment."""


def polynomials(padded: Array) -> Array:
    """Return the coefficients (M - 3, 4, n) of the segments of control points (M, n)."""
    return np.stack([sum(BASIS[p, k] * padded[k : len(padded) - 3 + k] for k in range(4)) for p in range(4)], axis=1)


def spline(setpoints: Array, u: Array) -> Array:
    """Return where the command is (N + 1, K, n): at shares u (K,) of the cycles in which it passes rows 0 to N."""
    c = polynomials(around(setpoints))[2:-1]
    return np.asarray(sum(c[:, None, p] * (u**p)[None, :, None] for p in range(4)))


def worst_share(robot: Bench, setpoints: Array, sent: int = 0, *, jerk: bool = False) -> float:
    """Return the largest share of a limit of a joint that a command from rest to rest takes, at any moment.

    ``sent`` set-points before are not judged: their differences are those of a motion before. ``jerk``: it is judged.
    """
    h = robot.profile.period_s
    c = polynomials(around(setpoints))[sent:]
    # the speed is a parabola in u: largest at an end, or where the acceleration is 0
    with np.errstate(divide="ignore", invalid="ignore"):
        turning = np.clip(np.nan_to_num(-c[:, 2] / (3.0 * c[:, 3])), 0.0, 1.0)
    speeds = [np.abs(c[:, 1] + 2.0 * c[:, 2] * u + 3.0 * c[:, 3] * u**2) / h for u in (0.0, 1.0, turning)]
    gains = [np.abs(2.0 * c[:, 2] + 6.0 * c[:, 3] * u) / h**2 for u in (0.0, 1.0)]
    shares = [np.max(speeds, axis=0) / robot.speed, np.max(gains, axis=0) / robot.acceleration]
    if jerk:
        shares.append(np.abs(6.0 * c[:, 3]) / h**3 / robot.spec.per_axis("limits", "jerk"))
    return float(np.max([share.max() for share in shares]))


def target(robot: Bench, run: Chain, number: int) -> Array:
    """Return where the tool is (3,) at the end of a move, as the command states it."""
    X = run.commands[number].X_world_tool
    return robot.tool(run.ends[number + 1])[:3, 3] if X is None else np.asarray(X[:3, 3])


def off_path(robot: Bench, run: Chain, points: Array, command: NDArray[np.int32]) -> float:
    """Return how far tool points (N, 3) are off the paths of their moves, m, at most, outside of zones.

    ``command`` (N,) is the move of each point; one beside it in the row may be the one that it is on.
    """
    worst = 0.0
    places = [robot.tool(run.start)[:3, 3], *(target(robot, run, k) for k in range(len(run.commands)))]
    for number in range(len(run.commands)):
        mine = points[command == number]
        off = np.full(len(mine), np.inf)
        for k in range(max(number - 1, 0), min(number + 2, len(run.commands))):
            off = np.minimum(off, distance(robot, run, k, places, mine))
        for k in (number - 1, number):
            if 0 <= k < len(run.commands) - 1:
                inside = np.linalg.norm(mine - places[k + 1], axis=1) <= run.commands[k].zone * SLACK
                off = np.where(inside, 0.0, off)
        worst = float(np.maximum(worst, off.max(initial=0.0)))
    return worst


def distance(robot: Bench, run: Chain, number: int, places: list[Array], points: Array) -> Array:
    """Return how far points (N, 3) are from the path that a command states."""
    command, start, end = run.commands[number], places[number], places[number + 1]
    if isinstance(command, MoveLinear):
        return from_line(points, start, end)
    if isinstance(command, MoveArc):
        return from_arc(points, start, command.X_via[:3, 3], end)
    return from_joint_line(robot, points, run.ends[number], run.ends[number + 1])


def from_line(points: Array, start: Array, end: Array) -> Array:
    """Return the distances (N,) of points (N, 3) from a line between two points."""
    along = end - start
    share = np.clip((points - start) @ along / max(float(along @ along), 1e-30), 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - start - share[:, None] * along, axis=1))


def from_arc(points: Array, start: Array, via: Array, end: Array) -> Array:
    """Return the distances (N,) of points (N, 3) from the arc over three points."""
    a, b = via - start, end - start
    across = np.cross(a, b)
    centre = start + np.cross((a @ a) * b - (b @ b) * a, across) / (2.0 * (across @ across))
    normal = across / np.linalg.norm(across)
    first = start - centre
    radius = float(np.linalg.norm(first))
    first /= radius
    second = np.cross(normal, first)

    def angle(at: Array) -> Array:
        return np.asarray(np.arctan2((at - centre) @ second, (at - centre) @ first) % (2.0 * np.pi))

    sweep = float(angle(end[None])[0])
    # beyond the end and nearer to the start than to it is before the start
    at = angle(points)
    at = np.where(at <= sweep, at, np.where(at - sweep < 0.5 * (2.0 * np.pi - sweep), sweep, 0.0))
    on = centre + radius * (np.cos(at)[:, None] * first + np.sin(at)[:, None] * second)
    return np.asarray(np.linalg.norm(points - on, axis=1))


def from_joint_line(robot: Bench, points: Array, q_start: Array, q_end: Array) -> Array:
    """Return the distances (N,) of points (N, 3) from the curve of a joint move, by Newton from the nearest of 400."""
    shares = np.linspace(0.0, 1.0, 401)

    def at(s: Array) -> Array:
        return np.asarray(robot.tool(q_start + s[:, None] * (q_end - q_start))[:, :3, 3])

    curve = at(shares)
    s = shares[np.argmin(((points[:, None] - curve) ** 2).sum(axis=2), axis=1)]
    for _ in range(6):
        # differences of the curve stand for its derivative
        step = 1e-5
        here, ahead = at(s), at(s + step)
        slope = (ahead - here) / step
        gain = ((points - here) * slope).sum(axis=1) / np.maximum((slope**2).sum(axis=1), 1e-30)
        s = np.clip(s + gain, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - at(s), axis=1))
