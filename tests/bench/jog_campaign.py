"""Random sequences of jogs on live controllers, and what their logs must show (R06): ``make jog-campaign``.

speed     no tool point and no flange over 250 mm/s at any tick: commanded, and with physics the links as well
range     no joint over its limit at any tick, but where it began beyond it; no further out there
stop      the set-point of the cycle after the dead-man has expired, after Esc and after a lost terminal lies before the
          planned one on the path, and the command rests within ``REST_S``
back      from a posture at a limit or at a singularity a jog leads back

The checker reads the recorded log, the times of the keys and the planned set-points, and nothing of the planner.
"""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from robolang.execution.rig import fitted, plant_of
from robolang.project.project import builtin_cell
from robolang.teaching.dead_man import Act, DeadMan
from robolang.teaching.jogging import ANGULAR_STEPS, FRAMES, LINEAR_STEPS, JogRequest, JogSettings, axes_of, plan_jog
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.core.units import DEG
from runtime.motion.motion_planner import MotionPlanner
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import Payload
from runtime.settings.profile import Profile
from tests.bench import figures
from tests.bench.figures import Row

ROBOTS = ("puma560", "irb2400", "manutec_r3")
CELL = builtin_cell()
CAP = 0.25
"""m/s, for tool point and flange."""
SWING = 5e-6
"""Between set-points the command may pass a limit by so much, rad."""
LINK = 0.1 * DEG
"""A link swings past the limit at which its command stands by so much at most, rad."""
STANDS = 1e-6
"""A joint that turns by less in a cycle, rad, stands: between two pieces of a course there is nothing to stop."""
REST_S = 0.5
"""Time from a stop to rest, s."""
PERIOD_S = 8e-3
LONG_S = 1.5
KINDS = ("speed", "range", "stop", "rest", "alarm", "refused")


@dataclass(frozen=True, kw_only=True)
class Stop:
    """A stop in a log: the cycle that has to send the first row of it, and the end of the jog.

    ``planned`` (n,): where the plan is with that cycle, ``before`` (n,): the one before it, ``left``: rows from it on.
    """

    cycle: int
    planned: np.ndarray
    before: np.ndarray
    left: int
    end: int = 0


@cache
def planner_of(name):
    spec = load_builtin(name)
    return MotionPlanner(spec, Kinematics(spec), fitted(Profile(), False))


def controller_at(name, q, physics=False):
    """Return a controller whose arm stands at q, in an empty cell, in MANUAL."""
    planner, profile = planner_of(name), fitted(Profile(), physics)
    spec = planner.kinematics.spec
    cell = replace(CELL, robot=spec, home=q, obstacles=(), parts=())
    plant = plant_of(cell, profile.tick_s, physics)
    robot = Controller(spec, plant, profile, CELL.hand.X_flange_tool, planner=planner)
    robot.speed_cap = CAP
    if physics:  # the hand is declared, and its payload has reached the servo
        robot.load(Payload(mass=CELL.hand.mass, cog=CELL.hand.cog))
        for _ in range(12):
            robot.cycle()
    return robot


def inside(spec, rng, share=0.0):
    """Return joint angles within the ranges, ``share`` of them away from the limits."""
    width = spec.upper - spec.lower
    return rng.uniform(spec.lower + share * width, spec.upper - share * width)


def posture(spec, rng):
    """Return joint angles anywhere: inside, at the wrist singularity or near it, at a limit or slightly beyond one."""
    q, axis, kind = inside(spec, rng), int(rng.integers(spec.n)), int(rng.integers(6))
    if kind == 1:
        q[4] = 0.0
    if kind == 2:
        q[4] = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-6.0, -1.0)
    if kind == 3:
        q[axis] = rng.choice([spec.lower[axis], spec.upper[axis]])
    if kind == 4:
        q[axis] = rng.choice([spec.lower[axis] - 0.3 * DEG, spec.upper[axis] + 0.3 * DEG])
    return q


def settings_of(rng):
    speed = float(rng.choice([5.0, 25.0, 25.0, 100.0, 100.0]))
    return JogSettings(frame=str(rng.choice(FRAMES)), speed=speed)


def request_of(spec, rng, held):
    axis = str(rng.choice(axes_of(spec.n)))
    sign = float(rng.choice([-1.0, 1.0]))
    if held:
        return JogRequest(axis=axis, amount=sign * math.inf)
    return JogRequest(axis=axis, amount=sign * float(rng.choice(LINEAR_STEPS if len(axis) == 1 else ANGULAR_STEPS)))


def user_frame(rng):
    k = rng.normal(size=3)
    return pose(rng.uniform(-1.0, 1.0, 3), rotation_about(k / np.linalg.norm(k), rng.uniform(0.0, 3.0)))


def play(robot, plan, stop_s, late=0):
    """Play a jog; bring it to rest in the first cycle after ``stop_s`` from its start, None: let it end.

    ``late`` cycles of delay are the seeded defect. Return the stop, None where the jog ended before.
    """
    robot.play(plan.rows)
    first, cycles = robot.recorder.cycle, 0
    due = math.inf if stop_s is None else math.floor(stop_s / PERIOD_S) + 1
    stop = None
    while robot.moving and not robot.alarms:
        if cycles == due and cycles < len(plan.rows):
            before = plan.rows[cycles - 1] if cycles else np.array(robot.areas.ina)
            stop = Stop(
                cycle=first + cycles,
                planned=passed(plan.rows, cycles, before),
                before=before,
                left=len(plan.rows) - cycles,
            )
        if cycles >= due + late:
            robot.hold()
        robot.cycle()
        cycles += 1
    return _ended(robot, stop)


def passed(rows, k, before):
    """Where the command is with set-point k of rows, after the set-point ``before``."""
    return (before + 4.0 * rows[k] + rows[min(k + 1, len(rows) - 1)]) / 6.0


def _ended(robot, stop):
    if not robot.alarms:
        robot.set_aside()
    return None if stop is None else replace(stop, end=robot.recorder.cycle)


def keys_held(rng):
    """Return the times of the repeats of a held key, s, from the one on with which the jog goes on."""
    return (rng.uniform(0.02, 0.05) * np.arange(int(rng.integers(1, 25)))).tolist()


def hold_key(robot, plan, times, ended):
    """Play a held jog under a dead-man that sees the key at ``times`` (from the start of the jog); return the stop.

    ``ended``: "expired" after the last of them, or "escape" and "lost" right after it.
    """
    dead_man = DeadMan(key="X+", repeats=2, seen_s=0.0, continuous=True)
    robot.play(plan.rows)
    first, cycles, stop, stopping = robot.recorder.cycle, 0, None, False
    # what must be true is computed from the keys alone
    last = times[-1]
    until = last + (0.2 if ended == "expired" else 0.01)
    due = math.floor(until / PERIOD_S + 1e-9) + 1
    queue = list(times)
    while robot.moving and not robot.alarms:
        now = cycles * PERIOD_S
        while queue and queue[0] <= now:
            dead_man.press("X+", queue.pop(0), moving=True)
        if not stopping and not queue and ended != "expired" and now > until:
            stopping = dead_man.press("escape", now, moving=True) is Act.STOP if ended == "escape" else True
        if not stopping and dead_man.expired(now):
            dead_man.stop()
            stopping = True
        if cycles == due and cycles < len(plan.rows):
            stop = Stop(
                cycle=first + cycles,
                planned=passed(plan.rows, cycles, plan.rows[cycles - 1]),
                before=plan.rows[cycles - 1],
                left=len(plan.rows) - cycles,
            )
        if stopping:
            robot.hold()
        robot.cycle()
        cycles += 1
    return _ended(robot, stop)


def check(robot, stops, physics):
    """Return what a log breaks."""
    broken, log = Counter(), robot.signals()
    tick_s = float(log["t"][1] - log["t"][0])
    ticks = round(PERIOD_S / tick_s)
    spec = robot.spec
    for signal, swing in (("q_cmd", SWING), *((("q_link", LINK),) if physics else ())):
        q = log[signal]
        flange = robot.kinematics.forward(q)
        for places in (flange[:, :3, 3], (flange @ robot.X_flange_tool)[:, :3, 3]):
            fastest = np.linalg.norm(np.diff(places, axis=0), axis=1).max() / tick_s
            broken["speed"] += int(not fastest <= CAP)
            broken[f"fastest {signal}"] = max(broken[f"fastest {signal}"], fastest)
        lower, upper = np.minimum(spec.lower, q[0]) - swing, np.maximum(spec.upper, q[0]) + swing
        broken["range"] += int(not ((q >= lower) & (q <= upper)).all())
    rows = log["q_plan"][::ticks]
    for stop in stops:
        way = stop.planned - stop.before
        gone = passed(rows, stop.cycle, rows[stop.cycle - 1]) - stop.before
        # before the planned one along its step: the joint that turns most in it has turned less
        axis = int(np.argmax(np.abs(way)))
        early = abs(gone[axis]) < abs(way[axis]) and gone[axis] * way[axis] >= 0.0
        ends_itself = stop.left <= 3
        broken["stop"] += int(not (early or ends_itself or np.abs(way).max() < STANDS))
        moving = np.flatnonzero((np.diff(rows[stop.cycle : stop.end], axis=0) != 0.0).any(axis=1))
        broken["rest"] += int(not moving.max(initial=0) * PERIOD_S <= REST_S)
    broken["alarm"] += len(robot.alarms)
    return broken


def sequence(name, rng, physics=False, late=0):
    """Run one random sequence of jogs; return what its log breaks and what it did."""
    spec = planner_of(name).kinematics.spec
    q = inside(spec, rng, 0.35) if physics else posture(spec, rng)
    robot, stops, done = controller_at(name, q, physics), [], Counter()
    X_user, settings = user_frame(rng), settings_of(rng)
    for _ in range(int(rng.integers(1, 4))):
        ended = str(rng.choice(["step", "step", "stopped", "expired", "escape", "lost"]))
        request = request_of(spec, rng, ended not in ("step", "stopped"))
        try:
            plan = plan_jog(robot, request, settings, X_user)
        except Fault as fault:
            done[fault.code] += 1
            continue
        try:
            stop = carry_out(robot, plan, ended, rng, late)
        except Fault:
            return Counter(refused=1), done  # the controller takes every jog that was planned
        done[ended] += 1
        if stop is not None:
            stops.append(stop)
        settings = settings.next_frame() if rng.random() < 0.3 else settings
        if robot.alarms:
            break
    if robot.recorder.tick < 2:
        return Counter(), done
    return check(robot, stops, physics), done


def carry_out(robot, plan, ended, rng, late):
    """Carry out a jog that ends as drawn; return its stop, None: it had ended before."""
    if ended in ("step", "stopped"):
        # a long step is never seen to its end: that takes much time and shows little
        cut = ended == "stopped" or plan.seconds > LONG_S
        return play(robot, plan, float(rng.uniform(0.0, min(plan.seconds, LONG_S))) if cut else None, late)
    # the step of the press and the pause are over: the jog begins with the second repeat
    return hold_key(robot, plan, keys_held(rng), ended)


def leads_back(name, rng):
    """Return whether a joint jog leads back from a posture at a limit or singular, within its limits."""
    spec = planner_of(name).kinematics.spec
    q = inside(spec, rng)
    axis = int(rng.integers(spec.n))
    inward = float(rng.choice([-1.0, 1.0]))
    if rng.random() < 0.5:
        q[axis] = (spec.upper if inward < 0.0 else spec.lower)[axis] - inward * float(rng.choice([0.0, 1e-12]))
    else:
        q[4], axis = 0.0, 4
    robot = controller_at(name, q)
    stood = np.array(robot.areas.ina)
    try:
        plan = plan_jog(robot, JogRequest(axis=f"J{axis + 1}", amount=inward * 5.0), JogSettings())
        play(robot, plan, None)
    except Fault:
        return False
    moved = np.array(robot.areas.ina) - stood
    return bool(abs(moved[axis] - inward * 5.0 * DEG) < 1e-9) and not sum(
        check(robot, [], False)[each] for each in KINDS
    )


def campaign(index, sequences, with_physics, postures, seed=15):
    """Return what was counted on one robot: broken and fastest, what was done, postures that a jog leads back from."""
    name, total, done = ROBOTS[index], Counter(), Counter()
    for k in range(sequences + with_physics):
        # numbers of its own for each sequence, so that one that breaks something is repeated alone
        broken, did = sequence(name, np.random.default_rng([seed, index, k]), physics=k >= sequences)
        if any(broken[each] for each in KINDS):
            done[f"broken: {name} {k}"] += 1
        add(total, broken)
        done += did
    rng = np.random.default_rng([seed, index])
    return total, done, sum(leads_back(name, rng) for _ in range(postures))


def add(total, more):
    """Add counts, and keep the largest of speeds."""
    for each, value in more.items():
        total[each] = max(total[each], value) if each.startswith("fastest") else total[each] + value


def rows(smallest: bool) -> Iterator[Row]:
    """Run the sequences on every robot."""
    sequences, with_physics, postures = (2, 0, 2) if smallest else (3334, 40, 167)
    total, done, back = Counter(), Counter(), 0
    for index in range(len(ROBOTS)):
        broken, did, leads = campaign(index, sequences, with_physics, postures)
        add(total, broken)
        done += did
        back += leads
    yield Row(
        figure="random sequences of jogs, on each of three robots 3,334 and 40 with physics: over 250 mm/s, over a "
        "limit, late stops, not at rest in 0.5 s, alarms, refused by the controller",
        form="{}, {}, {}, {}, {}, {}",
        values=tuple(total[each] for each in KINDS),
        good=not any(total[each] for each in KINDS),
        details=(str(dict(done)),),
    )
    yield Row(
        figure="fastest tool point or flange in them: commanded, links with physics",
        form="{:.1f}, {:.1f} mm/s",
        values=tuple(1e3 * total[f"fastest {signal}"] for signal in ("q_cmd", "q_link")),
    )
    yield Row(
        figure="501 postures at a limit or singular from which a joint jog does not lead back",
        form="{}",
        values=(3 * postures - back,),
        good=back == 3 * postures,
    )


if __name__ == "__main__":
    figures.run(rows)
