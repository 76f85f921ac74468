"""``make wrist-campaign``: random straight moves that change the sign of J5.

They are planned under KEEP, by the document's method, and by ours.

Moves are drawn as points are taught: the start anywhere in the joint ranges, the end a tenth to a half of the way to
another such posture, with the other sign of J5, arm and elbow alike, the tool above the floor; speeds from 50 to 500
mm/s, a tool of 200 mm. Nothing is known of whether the straight line between them can be moved along at all.

- KEEP: planned with the sign of J5 kept, slowed as far as it takes. It cannot end as taught; counted is how often it
  runs at all.
- document: the first of C1 (any), C3, C4, C6 and the linear way from there, at the programmed speed; executed where
  every 8 ms sample keeps position and speed of every joint and the end is the taught one. The document's switch is a
  step of speed, so accelerations are counted apart.
- ours: ``CartesianPlanner.plan``. Every plan is checked again from its rows alone, at every servo tick: position,
speed and
  acceleration of every joint, the line, the end angles. What fails there would fail in the middle of a path.
"""

import multiprocessing
import re
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.motion.cartesian_planner import CartesianPlanner, MovePlan, speed_limits
from runtime.motion.commands import MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path import LinePath
from runtime.motion.path_ik import Arm, LineSolver, WristSolver
from runtime.motion.velocity_profile import profile
from runtime.motion.wrist.switch import PathTiming, WristLimits, first_trigger, law_from
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.settings.profile import Profile, WristOptions
from tests.bench import figures
from tests.bench.figures import Row

ROBOTS = ("irb2400", "puma560")
TOOL = pose((0.0, 0.0, 0.2))
DOCUMENT = WristOptions(shape="linear", look_ahead=0, remedies=False)
BATCH = 250


@dataclass
class Tally:
    """Counts of one batch: outcomes by method, reasons by method, slow-downs and posture deviations of ours."""

    counts: Counter = field(default_factory=Counter)
    slowdowns: list = field(default_factory=list)
    deviations: list = field(default_factory=list)
    seconds: float = 0.0

    def add(self, other: "Tally") -> None:
        self.counts += other.counts
        self.slowdowns += other.slowdowns
        self.deviations += other.deviations
        self.seconds += other.seconds


class Bench:
    """One robot and its planners."""

    def __init__(self, name: str) -> None:
        self.spec = load_builtin(name)
        self.kinematics = Kinematics(self.spec)
        self.profile = Profile()
        self.planner = CartesianPlanner(self.spec, self.kinematics, self.profile)
        self.fine = FineInterpolator(self.profile.ticks_per_cycle, self.profile.period_s, np.zeros(6))
        self.speed, self.acceleration = (self.spec.per_axis("limits", each) for each in ("speed", "acceleration"))

    def draw(self, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray, float]:
        """Return start, end (6,) rad and speed m/s of a move with a change of J5 sign."""
        lower, upper = self.spec.lower, self.spec.upper
        while True:
            start, other = random.uniform(lower, upper), random.uniform(lower, upper)
            end = start + (other - start) * random.uniform(0.1, 0.5)
            end[4] = -np.sign(start[4]) * random.uniform(0.03, abs(upper[4]))
            here, there = (self.kinematics.branch_of(q) for q in (start, end))
            alike = (here.arm, here.elbow) == (there.arm, there.elbow) and here.wrist != there.wrist
            if alike and all((self.kinematics.forward(q) @ TOOL)[2, 3] > 0.0 for q in (start, end)):
                return start, end, random.uniform(0.05, 0.5)

    def keep(self, start: np.ndarray, command: MoveLinear) -> str:
        try:
            plan = self.planner.plan(start, replace(command, wrist="keep"), TOOL)
        except Fault as fault:
            return f"refused {fault.code}"
        return "ends as taught" if np.abs(plan.q[-1] - command.q_end).max() < 1e-6 else "ends in the other posture"

    def document(self, start: np.ndarray, command: MoveLinear) -> str:
        """Carry the move out by the flow chart alone, and return what becomes of it."""
        arm = Arm(spec=self.spec, kinematics=self.kinematics, fine=self.fine, X_flange_tool=TOOL)
        path = LinePath.between(self.kinematics.forward(start) @ TOOL, command.X_world_tool)
        line, end = LineSolver(arm, path, start), command.q_end
        s = profile(speed_limits(path, command, self.spec.path, self.profile), self.profile.period_s)
        q = line.rows(s)
        q[0] = start
        timing = PathTiming(s=s, period_s=self.profile.period_s, length=path.length)
        found = first_trigger(q, end, timing, WristLimits.of(self.spec, DOCUMENT), DOCUMENT)
        if found is not None:
            k = found.index - 1
            q = WristSolver(line, law_from(q, s, k, end[3:], "linear"), q[k], end).rows(s)
        if not np.isfinite(q).all():
            return "no solution (H1)"
        if not np.abs(q[-1] - end).max() <= np.radians(1e-6):
            return "other configuration at the end (H2)"
        rate = np.abs(np.diff(q, axis=0)).max(axis=0) / self.profile.period_s
        if not (rate[3:] <= self.speed[3:] * (1 + 1e-9)).all():
            return "wrist too fast (H3)"
        if not (rate[:3] <= self.speed[:3] * (1 + 1e-9)).all():
            return "main axis too fast (H4)"
        if not ((q >= self.spec.lower - 1e-9) & (q <= self.spec.upper + 1e-9)).all():
            return "range left"
        ddq = np.abs(self.fine.expand(q)[2]).max(axis=0)
        return "executed" if (ddq <= self.acceleration).all() else "executed, with a step of speed"

    def violations(self, plan: MovePlan, end: np.ndarray) -> list[str]:
        """Return what a plan does wrong, from its rows alone."""
        q, dq, ddq = self.fine.expand(plan.q)
        tool = (self.kinematics.forward(plan.q) @ TOOL)[:, :3, 3]
        checks = {
            "position": ((q >= self.spec.lower - 1e-8) & (q <= self.spec.upper + 1e-8)).all(),
            "speed": (np.abs(dq) <= self.speed * (1 + 1e-9)).all(),
            "acceleration": (np.abs(ddq) <= self.acceleration * (1 + 1e-9)).all(),
            "line": plan.path.deviation(tool).max() < 1e-9,
            "place on the line": np.abs(tool - plan.path.points(plan.s)).max() < 1e-9,
            "end": np.abs(plan.q[-1] - end).max() < np.radians(1e-6),
        }
        return [name for name, good in checks.items() if not good]


def batch(name: str, seed: int, moves: int) -> Tally:
    """Return the tally of so many moves of a robot."""
    bench, random, tally = Bench(name), np.random.default_rng(seed), Tally()
    for _ in range(moves):
        start, end, speed = bench.draw(random)
        command = MoveLinear(X_world_tool=bench.kinematics.forward(end) @ TOOL, q_end=end, speed=speed)
        tally.counts["KEEP", bench.keep(start, command)] += 1
        tally.counts["document", bench.document(start, command)] += 1
        began = time.perf_counter()
        try:
            plan = bench.planner.plan(start, command, TOOL)
        except Fault as fault:
            tally.counts["ours", f"refused {fault.code}"] += 1
            tally.counts["why", re.sub(r"-?[0-9.]+", "#", fault.message.split(": ")[-1])] += 1
            continue
        finally:
            tally.seconds += time.perf_counter() - began
        wrong = bench.violations(plan, end)
        tally.counts["ours", f"FAILS: {', '.join(wrong)}" if wrong else "executed"] += 1
        tally.counts["how", plan.wrist.remedy or "document" if plan.wrist else "path"] += 1
        tally.slowdowns.append(plan.slowdown.factor if plan.slowdown else 1.0)
        tally.deviations.append(np.degrees(plan.wrist.deviation) if plan.wrist else 0.0)
    return tally


def tally_of(name: str, moves: int) -> Tally:
    """Return the tally of so many moves of a robot, planned by two processes."""
    sizes, total = [min(BATCH, moves - k) for k in range(0, moves, BATCH)], Tally()
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        for job in [pool.submit(batch, name, 2400 + k, size) for k, size in enumerate(sizes)]:
            total.add(job.result())
    return total


COUNTED = {
    "`WRIST KEEP`, slowed as far as it takes: ends at the taught angles": ("KEEP", ("ends as taught",)),
    "it runs, and ends in the other posture": ("KEEP", ("ends in the other posture",)),
    "the document's method alone at the programmed speed: position and speed kept at every 8 ms sample": (
        "document",
        ("executed", "executed, with a step of speed"),
    ),
    "the same, accelerations kept too (its switch is a step of speed)": ("document", ("executed",)),
    "ours, position, speed and acceleration kept at every servo tick": ("ours", ("executed",)),
    "refused before motion, with a reason": ("ours", ("refused",)),
    "failures in the middle of a path: plans that break a limit, the line or the end": ("ours", ("FAILS",)),
}
"""What is counted by figure: the method, and what becomes of a move, or how that begins."""


def share(tally: Tally, method: str, outcomes: tuple[str, ...]) -> float:
    """Return in per cent how many moves of a method had one of these outcomes."""
    counts = {what: count for (of, what), count in tally.counts.items() if of == method}
    begins = tuple(outcome for outcome in outcomes if outcome in ("refused", "FAILS"))
    found = sum(count for what, count in counts.items() if what in outcomes or what.startswith(begins))
    return 100.0 * found / sum(counts.values())


def details(name: str, tally: Tally) -> Iterator[str]:
    """Say all that was counted on a robot."""
    moves = sum(count for (of, _), count in tally.counts.items() if of == "KEEP")
    yield f"{name}: {moves} moves, {1e3 * tally.seconds / moves:.0f} ms of planning each"
    for method in ("KEEP", "document", "ours", "how", "why"):
        for (of, what), count in sorted(tally.counts.items(), key=lambda item: -item[1]):
            if of == method:
                yield f"{name}: {method:9} {count:6} {100 * count / moves:6.1f} %  {what}"
    slow, turned = np.array(tally.slowdowns), np.array(tally.deviations)
    slowed = slow[slow > 1.0]
    if len(slowed):
        yield (
            f"{name}: of {len(slow)} executed {len(slow) - len(slowed)} at the programmed speed, the others slowed "
            f"{np.median(slowed):.2f} times in the median, at most {slow.max():.1f}"
        )
        below = np.percentile(turned, 90)
        yield f"{name}: posture deviation: median {np.median(turned):.1f} deg, 90 % below {below:.1f} deg"


def rows(smallest: bool) -> Iterator[Row]:
    """Count on every robot."""
    tallies = {name: batch(name, 2400, 3) if smallest else tally_of(name, 5000) for name in ROBOTS}
    for figure, (method, outcomes) in COUNTED.items():
        shares = tuple(share(tally, method, outcomes) for tally in tallies.values())
        yield Row(
            figure=figure,
            form="{:.1f} %, {:.1f} %",
            values=shares,
            good=outcomes != ("FAILS",) or not any(shares),
            details=tuple(line for name, tally in tallies.items() for line in details(name, tally))
            if outcomes == ("FAILS",)
            else (),
        )


if __name__ == "__main__":
    figures.run(rows)
