"""Random chains of moves with random zones and overrides, and what must be true of every one: ``make blend-campaign``.

fault     a chain whose moves can be planned one by one is blended without an error
limits    speed and acceleration of every joint within its limits at every servo tick of the whole chain
zone      where the tool is off the path of its own move, it is within the radius of a corner
time      a blended chain is not longer than one that stops at every corner
ends      the chain begins and ends where its moves do
"""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.motion.commands import MoveArc, MoveJoint, MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.motion_planner import MotionPlanner
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.settings.profile import Profile
from tests.bench import figures
from tests.bench.figures import Row

ROBOTS = ("puma560", "irb2400", "manutec_r3")
TOOL = pose([0.0, 0.0, 0.1])
ON_PATH = 2e-6
"""A tool point nearer to the path than this is on it, m."""


def random_command(rng, X, zone):
    """Return a move of up to 0.25 m from a tool pose."""
    way = rng.normal(size=3)
    target = X.copy()
    target[:3, 3] += way / np.linalg.norm(way) * rng.uniform(0.01, 0.25)
    k = rng.normal(size=3)
    target[:3, :3] = rotation_about(k / np.linalg.norm(k), rng.uniform(0.0, 0.4)) @ X[:3, :3]
    kind = rng.integers(3)
    override = 1.0 if rng.random() < 0.5 else float(rng.uniform(0.2, 1.0))
    if kind == 0:
        return MoveJoint(X_world_tool=target, speed=float(rng.uniform(0.1, 1.0)), zone=zone, override=override)
    speed = float(rng.uniform(0.05, 0.8))
    if kind == 1:
        return MoveLinear(X_world_tool=target, speed=speed, zone=zone, override=override)
    via = target.copy()
    side = np.cross(way, rng.normal(size=3))
    via[:3, 3] = 0.5 * (X[:3, 3] + target[:3, 3]) + side / np.linalg.norm(side) * rng.uniform(0.01, 0.1)
    return MoveArc(X_via=via, X_world_tool=target, speed=speed, zone=zone, override=override)


def random_chain(rng, planner, spec, kinematics, moves):
    """Return a start and commands that can be planned one by one."""
    while True:
        q = rng.uniform(spec.lower + 0.3, spec.upper - 0.3)
        start, commands = q, []
        try:
            for _ in range(moves):
                zone = float(rng.choice([0.0, 0.001, 0.01, 0.03, 0.2]))
                command = random_command(rng, kinematics.forward(q) @ TOOL, zone)
                q = planner.plan(q, command, TOOL).q[-1]
                commands.append(command)
        except Fault:
            continue
        return start, commands


def examine(spec, kinematics, planner, start, commands, count):
    """Blend a chain and count what is wrong with it; return how much of the time it saves."""
    try:
        chain = planner.chain(start, commands, TOOL)
    except Fault:
        count["fault"] += 1
        return 0.0
    fine = FineInterpolator(8, 8e-3, chain.q[0])
    fastest, hardest = fine.peaks(chain.setpoints)
    count["limits"] += int(not (fastest <= spec.per_axis("limits", "speed") * (1 + 1e-9)).all())
    count["limits"] += int(not (hardest <= spec.per_axis("limits", "acceleration") * (1 + 1e-9)).all())
    count["ends"] += int((chain.q[0] != start).any() or (chain.q[-1] != chain.parts[-1].plan.q[-1]).any())
    points = (kinematics.forward(chain.q) @ TOOL)[:, :3, 3]
    corners = [(kinematics.forward(part.plan.q[-1]) @ TOOL)[:3, 3] for part in chain.parts[:-1]]
    for part in chain.parts:
        rows = points[part.first : part.last + 1]
        own = part.plan.path
        if own is not None:
            off = ~(own.deviation(rows) <= ON_PATH)
            near = np.zeros(len(rows), dtype=bool)
            for corner, place in zip(chain.corners, corners, strict=True):
                near |= np.linalg.norm(rows - place, axis=1) <= corner.radius + ON_PATH
            count["zone"] += int((off & ~near).any())
    alone = sum(len(part.plan.q) - 1 for part in chain.parts)
    count["time"] += int(len(chain.q) - 1 > alone)
    count["chains"] += 1
    count["corners"] += sum(corner.radius > 0.0 for corner in chain.corners)
    count["blended"] += sum(corner.cycles > 0 for corner in chain.corners)
    return 1.0 - (len(chain.q) - 1) / alone


def campaign(robot, chains, seed=5, moves=5):
    """Return what was counted on a robot, and the mean share of time that blending saves."""
    spec = load_builtin(robot)
    kinematics = Kinematics(spec)
    planner = MotionPlanner(spec, kinematics, Profile())
    rng, count, saved = np.random.default_rng(seed), Counter(), []
    for _ in range(chains):
        start, commands = random_chain(rng, planner, spec, kinematics, moves)
        saved.append(examine(spec, kinematics, planner, start, commands, count))
    return count, float(np.mean(saved))


BROKEN = ("fault", "limits", "zone", "time", "ends")


def rows(smallest: bool) -> Iterator[Row]:
    """Count on every robot."""
    found = {robot: campaign(robot, 2 if smallest else 500, moves=3 if smallest else 5) for robot in ROBOTS}
    broken = [sum(count[name] for name in BROKEN) for count, _ in found.values()]
    details = tuple(
        f"{robot}: {count['chains']} chains, {count['corners']} corners with a zone, {count['blended']} blended, "
        f"broken { {name: count[name] for name in BROKEN} }"
        for robot, (count, _) in found.items()
    )
    yield Row(
        figure="random chains of five moves with zones, 500 on each of three robots: errors, limits or zones passed, "
        "chains longer than with stops",
        form="{}, {}, {}",
        values=tuple(broken),
        good=not any(broken),
        details=details,
    )
    yield Row(
        figure="time that blending saves on them, half of the moves under an override",
        form="{:.1f}, {:.1f}, {:.1f} %",
        values=tuple(100 * saved for _, saved in found.values()),
    )


if __name__ == "__main__":
    figures.run(rows)
