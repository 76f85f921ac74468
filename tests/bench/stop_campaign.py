"""Stops at random cycles of random chains, by the controller: ``make stop-campaign``.

Each chain of ``tests.runtime.motion.chains`` runs on a controller with the ideal arm up to a random cycle, where it is
paused, or stopped by an alarm of category 1. Judged is the log, without the code of the stop:

limits   speed and acceleration of every joint at every moment of the stop; a stop is as short as these allow
range    every joint within its range
curve    at every cycle the tool is where it would have been at some moment, had the motion gone on
path     it is on the path of its move, or in a zone of that
rest     the arm comes to rest within 2 s, or when its motion would have ended
alarm    no alarm but the one that stops it

The first cycle of a stop is joined to what was sent before, and in the last one the command rests on a set-point. How
far the tool is off the curve in these two is a figure of its own.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array
from tests.bench import figures
from tests.bench.figures import Row
from tests.bench.jog_campaign import controller_at
from tests.runtime.motion.chains import (
    ON_PATH_M,
    ROBOTS,
    SLACK,
    Chain,
    around,
    off_path,
    polynomials,
    random_chain,
    spline,
    worst_share,
)
from tests.runtime.motion.motions import TOOL, Bench, bench

KINDS = ("limits", "range", "curve", "path", "rest", "alarm")
LONGEST_CYCLES = 250
BETWEEN_M = 1e-6
"""By how much a command may miss its path between two rows of the plan, m; there a stop may rest."""
STOPS, MOVES = 100, 4
CHUNK = 25
"""Stops between two lines of progress."""


@dataclass(frozen=True, kw_only=True)
class Stopped:
    """The ``setpoints`` (N + 1, n) of a motion that was stopped, ``before`` of them sent when the stop was asked for.

    ``whole`` (M + 1, n) are those of the plan and ``command`` (M + 1,) the moves that they belong to.
    """

    setpoints: Array
    before: int
    whole: Array
    command: Array
    alarms: int


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What is wrong with a stop, by kind, and its figures: m off the curve where it is joined, and s to rest."""

    broken: Counter[str]
    joined_m: float
    off_m: float
    rest_s: float
    left_s: float


def stopped(robot: Bench, run: Chain, cycle: int, *, pause: bool) -> Stopped:
    """Run moves up to a cycle and stop there; return what the log says."""
    machine = controller_at(robot.spec.name, run.start)
    machine.speed_cap = None
    machine.use_tool(TOOL)
    plan = machine.move_chain(run.commands)
    for _ in range(cycle):
        machine.cycle()
    sent = machine.recorder.cycle
    if pause:
        while not machine.hold():
            machine.cycle()
    else:
        machine.alarm("RBL530", "stopped")
        while machine.moving and machine.cycle():
            pass
    rows = machine.signals()["q_plan"][:: robot.profile.ticks_per_cycle]
    return Stopped(
        setpoints=rows,
        before=sent,
        whole=plan.setpoints,
        command=plan.command,
        alarms=len(machine.alarms) - (0 if pause else 1),
    )


def judge(robot: Bench, run: Chain, found: Stopped) -> Judged:
    """Return what a stop breaks."""
    rows, before, spec = found.setpoints, found.before, robot.spec
    moving = np.flatnonzero((np.diff(rows, axis=0) != 0.0).any(axis=1))
    rest = int(moving[-1]) + 1 if len(moving) else 0
    # a pause that does not fit is tried again in the next cycle
    differs = np.flatnonzero((rows[: len(found.whole)] != found.whole[: len(rows)]).any(axis=1))
    joined_at = int(differs[0]) - 1 if len(differs) else rest
    after = spline(rows, np.zeros(1))[joined_at : rest + 1, 0]
    u, on = nearest(found.whole, after)
    tool = robot.tool(after)[:, :3, 3]
    curve = np.linalg.norm(tool - robot.tool(on)[:, :3, 3], axis=1)
    number = found.command[np.clip(np.round(u).astype(int), 0, len(found.command) - 1)]
    off = off_path(robot, run, tool[1:-1], number[1:-1])
    joined = float(np.maximum(curve[:1].max(initial=0.0), curve[-1:].max(initial=0.0)))
    lasts, left = max(rest - before, 0), len(found.whole) - before
    count = Counter(
        limits=int(not worst_share(robot, rows, before) <= SLACK),
        range=int(not ((rows >= spec.lower - 1e-8) & (rows <= spec.upper + 1e-8)).all()),
        curve=int(not curve[1:-1].max(initial=0.0) <= ON_PATH_M),
        path=int(not off <= BETWEEN_M),
        rest=int(not lasts <= max(left, LONGEST_CYCLES)),
        alarm=found.alarms,
    )
    period_s = robot.profile.period_s
    return Judged(broken=count, joined_m=joined, off_m=off, rest_s=lasts * period_s, left_s=left * period_s)


def nearest(setpoints: Array, points: Array) -> tuple[Array, Array]:
    """Return the places u (K,) in rows, and q (K, n) there, at which a command comes nearest to joint angles (K, n)."""
    c = polynomials(around(setpoints))[2:-1]
    grid = np.arange(8 * len(c)) / 8.0

    def at(u: Array) -> tuple[Array, Array]:
        k = np.clip(u.astype(int), 0, len(c) - 1)
        x, a = (u - k)[:, None], c[k]
        return a[:, 0] + x * (a[:, 1] + x * (a[:, 2] + x * a[:, 3])), a[:, 1] + x * (2.0 * a[:, 2] + 3.0 * x * a[:, 3])

    curve = at(grid)[0]
    u = grid[[int(np.argmin(((curve - point) ** 2).sum(axis=1))) for point in points]]
    for _ in range(8):
        place, slope = at(u)
        u = u + ((points - place) * slope).sum(axis=1) / np.maximum((slope**2).sum(axis=1), 1e-30)
        u = np.clip(u, 0.0, len(c) - 1e-9)
    return u, at(u)[0]


def random_stop(robot: Bench, random: np.random.Generator) -> tuple[Chain, Stopped]:
    """Return moves up to a stop, and what became of them when they were stopped somewhere."""
    run = max(random_chain(robot, random, MOVES).runs(), key=lambda run: len(run.commands))
    rows = len(robot.planner.chain(run.start, run.commands, TOOL).q)
    cycle = int(random.integers(1, max(rows, 2)))
    return run, stopped(robot, run, cycle, pause=bool(random.integers(2)))


def campaign(name: str, stops: int, seed: int = 3, progress: bool = False) -> list[Judged]:
    """Return how stops of a robot are judged."""
    robot, random = bench(name), np.random.default_rng(seed)
    found = []
    for k in range(1, stops + 1):
        found.append(judge(robot, *random_stop(robot, random)))
        if progress and k % CHUNK == 0:
            print(f"    {name}: {k} of {stops}", flush=True)
    return found


def rows(smallest: bool) -> Iterator[Row]:
    """Stop chains on every robot."""
    robots, stops = (ROBOTS[:1], 1) if smallest else (ROBOTS, STOPS)
    found = {name: campaign(name, stops, progress=not smallest) for name in robots}
    every = [each for judged in found.values() for each in judged]
    broken = {name: sum((each.broken for each in judged), Counter()) for name, judged in found.items()}
    yield Row(
        figure="random chains stopped at a random cycle, 100 on each of five robots: limits or ranges passed, off the "
        "curve, not at rest, alarms",
        form="{}",
        values=(sum(count.total() for count in broken.values()),),
        good=not any(count.total() for count in broken.values()),
        details=tuple(f"{name}: {dict(count)}" for name, count in broken.items()),
    )
    yield Row(
        figure="the tool off the curve in the first and in the last cycle of a stop, at most",
        form="{:.1e} mm",
        values=(1e3 * float(np.max([each.joined_m for each in every])),),
    )
    lasts = np.array([each.rest_s for each in every])
    late = [each for each in every if each.rest_s > 0.5]
    yield Row(
        figure="time to rest: median, longest; stops of more than 0.5 s",
        form="{:.3f}, {:.3f} s; {}",
        values=(float(np.median(lasts)), float(lasts.max()), len(late)),
    )


if __name__ == "__main__":
    figures.run(rows)
