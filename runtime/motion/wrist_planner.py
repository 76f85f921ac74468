"""Choosing the way of a move along a path through the wrist: the document's switch, then its remedies, then a refusal.

The whole move is tried before it starts, on the 8 ms samples and at every servo tick. So what CN103429397A leaves to
chance shows while the arm stands still: no solution of the main axes (H1), another arm configuration at the end (H2), a
wrist (H3) or main axis (H4) beyond its speed, a range passed. Tried in this order:

    1  the path with its posture, where it ends at the taught angles, slowed by at most ``posture_first``
    2  the switch where the first condition is met, in the shape of the profile
    3  softer starts, other switches, ways that return to the posture before the end: of those that keep every limit at
       the programmed speed the one whose posture, or whose held components, deviate least
    4  of 1 to 3, where each has to be slowed, the one that deviates least of those slowed by at most ``posture_first``;
       where all have to be slowed more, the one slowed least
    5  where none of them has a solution at all, detours of the wrist on its way, likewise

``remedies = false`` in the profile is the document alone: 1 only where no condition is met, then 2. Places to try are
shares of the path, so the choice does not depend on the sampling. Called by ``CartesianPlanner``; docs/wrist.md has the
hazards and what each remedy is good for.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import HALF_TURN, Array, inverse, is_half_turn, rotation_angles
from runtime.core.linear import matmul
from runtime.core.rounding import beside
from runtime.core.units import DEG, badness
from runtime.motion.commands import Component, MoveJoint, PathMove, in_configuration
from runtime.motion.path import Path
from runtime.motion.path_ik import MOST_SLOWDOWN, LineSolver, WristSolver
from runtime.motion.wrist.hold import COMPONENTS, Suppression, WristTable, component_deviation, held_ways
from runtime.motion.wrist.switch import (
    CONDITIONS,
    SAME_ANGLES,
    Trigger,
    WristLimits,
    first_trigger,
    law_between,
    law_from,
)
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.robot.kinematics.kinematics import LIMIT_ROUNDING, Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import WristOptions

EARLIER = (0.9, 0.75, 0.6, 0.45, 0.3, 0.15, 0.0)
"""Switches tried when the document's does not do: shares of the way to it."""

LATER = (0.25, 0.5, 0.75)
"""And shares of the way from it to the end."""

SOFTER = (1.0, 0.25)
"""Widths of the soft start tried beside that of the profile."""

HELD_EARLIER = (0.75, 0.45, 0.15)
"""Those of them from which a posture is held as well: choosing it costs more than all the rest."""

HELD_WINDOWS = (0.15, 0.4)
"""Shares of the way over which the choice of a held posture is averaged."""

WINDOWS = (0.1, 0.2, 0.35, 0.5)
"""Half widths of the part of the path in which the wrist goes from one configuration to the other, tried last."""

MIDDLES = (0.5, 0.25, 0.75)
"""Middles of that part, beside the one about which the wrist has to turn least."""

DETOUR = "detour of the wrist"
DETOURS = ((0, 45), (0, -45), (60, 0), (-60, 0), (0, 80), (0, -80), (60, 80), (-60, -80), (120, 80), (-120, -80))
"""How far J4 and J5 go out of their way at half of it, deg, where nothing else places the main axes at all."""

SHORTEST_TRAVEL = 1e-6
"""A shorter way has no direction in which tilt and advance could be counted, m."""

Solver = LineSolver | WristSolver
Excess = Callable[[Array], tuple[float, int, str]]
"""Of samples q (N + 1, n): factor by which they are too fast (1 and less: not), axis (0-based), ``speed`` or other."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """How a move goes: its solver; the condition that made it leave the path (None: it does not); what else was done.

    ``ratio`` is the factor by which it is too fast at the programmed speed; ``deviation`` rad by how much the posture,
    or what is held of it, is left.
    """

    solver: Solver
    ratio: float = 1.0
    deviation: float = 0.0
    trigger: Trigger | None = None
    switch: float | None = None
    remedy: str = ""
    held: tuple[Component, ...] = ()


def ends(line: LineSolver, q: Array, command: PathMove) -> Iterator[Array]:
    """Yield the joint angles (n,) at which a move may end: the taught ones, or those that its point leaves open.

    q (N + 1, n): the path in the configuration of its start.
    Of a taught pose the end in the configuration of the start comes first, then the others that such a move can
    reach, arm and elbow as they are, those first to which the wrist turns least; none where the pose is out of reach.
    ``Fault`` RBL412 when the point names another arm or elbow, or turns that no solution has.
    """
    arm = line.arm
    if command.q_end is not None:
        there = arm.kinematics.branch_of(command.q_end)
        if (there.arm, there.elbow) != (line.branch.arm, line.branch.elbow):
            raise Fault(
                "RBL412",
                f"the end is taught {there}, the move starts {line.branch}: a {line.path.move} "
                "cannot change the configuration of the arm",
                "Teach the end in the arm configuration of the "
                "start, or go there over a via point; WRIST KEEP ends in the configuration of the "
                "start.",
            )
        yield np.array(command.q_end)
        return
    kept = bool(np.isfinite(q[-1]).all())
    wanted = kept and as_taught(arm.kinematics, q[-1], command)
    if wanted:
        yield q[-1]  # nearly always the one that is taken: the others are not looked for before they are asked for
    X_end = matmul(line.path.X_end, inverse(arm.X_flange_tool))
    turns = command.turns[: arm.kinematics.n]
    solutions = arm.kinematics.solutions(X_end, line.q_start)
    others = [
        turned(arm.kinematics, each.q, turns, line.q_start)
        for each in solutions
        if (each.branch.arm, each.branch.elbow) == (line.branch.arm, line.branch.elbow)
    ]
    others = [end for end in others if arm.kinematics.limit_margin(end) >= -LIMIT_ROUNDING]
    others.sort(key=lambda end: float(np.abs(end - line.q_start)[-WRIST_AXES:].max()))
    fitting = [end for end in others if as_taught(arm.kinematics, end, command)]
    yield from fitting
    if (kept or others) and not wanted and not fitting:
        words = " ".join(command.configuration) or f"with turns {list(command.turns)}"
        raise Fault(
            "RBL412", f"the end is taught {words}, the move starts {line.branch}: no {line.path.move} reaches it"
        )


def turned(kinematics: Kinematics, q: Array, turns: tuple[int, ...], near: Array) -> Array:
    """Return joint angles (n,) with as many whole turns on each joint as a point asks for.

    180 and -180 deg are the same angle with the same number of turns: the one nearer to ``near`` (n,) is taken.
    """
    middle = 2.0 * np.pi * np.array([*turns, *[0] * (len(q) - len(turns))])
    within = Kinematics.nearest_turns(q, middle)
    half = is_half_turn(within - middle)
    either = kinematics.freer_half_turn(Kinematics.nearest_turns(q, near), near)
    sides = np.sort([within, within - np.copysign(2.0 * np.pi, within - middle)], axis=0)
    within = np.where(half, np.clip(either, *sides), within)
    return np.concatenate([within[: len(turns)], q[len(turns) :]])


def as_taught(kinematics: Kinematics, q: Array, command: PathMove | MoveJoint) -> bool:
    """Return whether joint angles (n,) have the configuration and the turns that the end of a move is taught with."""
    turns = np.array(command.turns[: len(q)], dtype=np.float64)
    fits = in_configuration(kinematics.branch_of(q), command.configuration)
    return fits and bool((np.abs(q[: len(turns)] - 2.0 * np.pi * turns) <= np.pi + HALF_TURN).all())


def choose(
    line: LineSolver,
    s: Array,
    q: Array,
    q_end: Array,
    period_s: float,
    options: WristOptions,
    excess: Excess,
    most_deviation: float = math.pi,
    held: tuple[Component, ...] | None = (),
) -> Choice:
    """Return how a move to the taught joint angles q_end (n,) goes; ``Fault`` RBL412 (or 410, 411) where it cannot.

    s (N + 1,): its path parameter at the programmed speed, ``period_s`` apart; q (N + 1, n): the path in the
    configuration of its start. ``most_deviation`` rad: the tool may
    turn that far from its posture on the path. ``held`` None is for a path that a sensor will shift: nothing is held,
    and the wrist does not return to the posture before the end.
    """
    trigger = first_trigger(q, q_end, s, period_s, wrist_limits(line.arm.spec, options), options, line.path.length)
    arrives = bool(np.abs(q[-1] - q_end).max() <= SAME_ANGLES)
    tried = _candidates(line, q, s, q_end, trigger, arrives, period_s, options, held)
    held = held or ()
    found: list[Choice] = []
    failures: list[Fault] = []
    for choice in tried:
        if found and choice.remedy == DETOUR:
            break
        try:
            rows = choice.solver.joints(s)
        except Fault as fault:
            failures.append(fault)
            continue
        ratio, axis, quantity = excess(rows)
        if not ratio <= MOST_SLOWDOWN:
            failures.append(
                Fault(
                    "RBL412",
                    f"J{axis + 1} would pass its limit of {quantity} so far that the move "
                    f"would have to be slowed {ratio:.0f} times",
                )
            )
            continue
        choice = replace(choice, ratio=ratio)
        if choice.switch is None:
            if ratio <= options.posture_first:
                return choice
        else:
            deviation = posture_deviation(line, s, rows)
            if not deviation <= most_deviation:
                turn, most = beside(deviation / DEG, most_deviation / DEG, form=".0f")
                failures.append(
                    Fault(
                        "RBL412",
                        f"the tool would turn up to {turn} deg from its posture on the path, more than {most} deg",
                    )
                )
                continue
            if ratio <= 1.0 and not choice.remedy and not held:
                return choice  # as the document has it
            choice = replace(choice, deviation=posture_deviation(line, s, rows, held) if held else deviation)
        found.append(choice)
    if not found:
        raise _refusal(line, trigger, arrives, failures, _what_would_do(line, s, excess))
    fastest = min((choice.ratio for choice in found), key=badness)
    slowest = 1.0 if fastest <= 1.0 else max(fastest, options.posture_first)
    quick = [choice for choice in found if choice.ratio <= slowest]
    # rounded: no tie is decided by the last digits
    return min(quick, key=lambda choice: (badness(round(choice.deviation, 9)), round(choice.ratio, 9)))


def posture_deviation(line: LineSolver, s: Array, q: Array, held: tuple[Component, ...] = ()) -> float:
    """Return by how much the tool turns from its posture on the path, rad: the whole angle, or of held components."""
    R = matmul(line.arm.kinematics.forward(q), line.arm.X_flange_tool)[:, :3, :3]
    planned = line.planned(s)[:, :3, :3]
    if not held or line.path.length < SHORTEST_TRAVEL:
        return float(rotation_angles(planned, R).max())
    return float(component_deviation(line.path, s, planned, R)[:, [COMPONENTS.index(each) for each in held]].max())


def wrist_limits(spec: RobotSpec, options: WristOptions) -> WristLimits:
    """Return theta_kd and the ranges of the wrist axes: the profile's, else the robot's."""
    limits = spec.per_axis("limits", "speed")[-WRIST_AXES:]
    speed = np.broadcast_to(options.speed, WRIST_AXES) if options.speed else limits
    return WristLimits(speed=speed, lower=spec.lower[-WRIST_AXES:], upper=spec.upper[-WRIST_AXES:])


def _candidates(
    line: LineSolver,
    q: Array,
    s: Array,
    q_end: Array,
    trigger: Trigger | None,
    arrives: bool,
    period_s: float,
    options: WristOptions,
    held: tuple[Component, ...] | None,
) -> Iterator[Choice]:
    """Yield what to try: the path itself where it arrives, the document's switch, other switches."""
    if arrives and (trigger is None or options.remedies):
        yield Choice(solver=line)
    end = q_end[-WRIST_AXES:]
    index = len(s) - 1 if trigger is None else trigger.index - 1
    finite = np.isfinite(q).all(axis=1)
    usable = min(len(s) - 2, len(s) - 1 if finite.all() else int(np.argmin(finite)) - 1)

    suppression = _suppression(line, options, held or ())
    rate = float(np.diff(s).max()) / period_s

    def at(k: int, width: float, remedy: str = "") -> Choice:
        law = law_from(q, s, k, end, options.shape, width)
        return Choice(solver=WristSolver(line, law, q[k], q_end), trigger=trigger, switch=float(s[k]), remedy=remedy)

    ways: dict[int, Iterator[WristTable]] = {}

    def holding(k: int, remedy: str = "") -> Iterator[Choice]:
        """Yield the way from a sample in the next of ``HELD_WINDOWS``."""
        if suppression is not None:
            if k not in ways:
                slope = law_from(q, s, k, end, "linear").slope
                ways[k] = held_ways(suppression, line.path, q[k], slope, end, float(s[k]), rate, HELD_WINDOWS)
            way = next(ways[k])
            yield Choice(
                solver=WristSolver(line, way, q[k], q_end),
                trigger=trigger,
                switch=float(s[k]),
                remedy=remedy,
                held=held or (),
            )

    if trigger is not None:
        yield at(index, options.width)
        yield from holding(index)
    if not options.remedies:
        return
    widths = (options.width, *SOFTER) if options.shape == "smooth" else (options.width,)
    seen = {index}
    if trigger is not None:
        for width in widths[1:]:
            yield at(index, width, "softer start")
        yield from holding(index, "softer start")
    held_places = [share * s[index] for share in HELD_EARLIER]
    where = [(share * s[index], "earlier switch") for share in EARLIER]
    where += [(s[index] + share * (1.0 - s[index]), "later switch") for share in LATER]
    for place, remedy in where:
        k = int(np.searchsorted(s, place, side="right")) - 1
        if k in seen or k > usable:
            continue
        seen.add(k)
        for width in widths:
            yield at(k, width, remedy)
        if place in held_places:
            for _ in HELD_WINDOWS:
                yield from holding(k, remedy)
    if held is not None:
        yield from _windows(line, q, s, q_end, trigger)
    for j4, j5 in DETOURS:
        law = replace(law_from(q, s, 0, end, "hermite"), slope=np.zeros(WRIST_AXES), detour=np.radians([j4, j5, 0.0]))
        yield Choice(solver=WristSolver(line, law, q[0], q_end), trigger=trigger, switch=0.0, remedy=DETOUR)


def _suppression(line: LineSolver, options: WristOptions, held: tuple[Component, ...]) -> Suppression | None:
    """Return what holds posture components; None where there are none, or no direction of travel to count them in.

    Nor without a closed form: 125 solutions by steps in every cycle would take half a minute.
    """
    if not held or line.path.length < SHORTEST_TRAVEL or not line.arm.kinematics.closed_form:
        return None
    travel = line.path.X_end[:3, 3] - line.path.X_start[:3, 3]
    speed = wrist_limits(line.arm.spec, options).speed
    return Suppression(line.arm.kinematics, line.arm.X_flange_tool, travel, held, speed)


def _windows(line: LineSolver, q: Array, s: Array, q_end: Array, trigger: Trigger | None) -> Iterator[Choice]:
    """Yield ways that leave the path and return to it: where the wrist turns least on them, and elsewhere.

    Before and after, the tool has the posture of the path; in between the wrist goes from one solution to the other. At
    one place J4 and J6 of the two are always half a turn apart, but beside a singularity both turn fast: what one has
    before it and the other behind it is close, and what J4 and J6 would have to turn there, they need not.
    """
    back = LineSolver(line.arm, line.path, q_end, to_end=True)
    q_back = back.rows(s)
    limits = line.arm.spec.per_axis("limits", "speed")[-WRIST_AXES:]
    leaves, joins = q[:, -WRIST_AXES:] / limits, q_back[:, -WRIST_AXES:] / limits
    both = np.isfinite((leaves + joins).sum(axis=1))
    if not both.any():
        return
    for half in WINDOWS:
        firsts = np.searchsorted(s, np.maximum(s - half, 0.0), side="right") - 1
        lasts = np.minimum(np.searchsorted(s, np.minimum(s + half, 1.0)), len(s) - 1)
        turned = np.abs(joins[lasts] - leaves[firsts]).max(axis=1)
        nearest = float(s[int(np.nanargmin(turned))]) if np.isfinite(turned).any() else 0.5
        for middle in (nearest, *MIDDLES):
            low, high = max(0.0, middle - half), min(1.0, middle + half)
            first, last = int(np.searchsorted(s, low, side="right")) - 1, int(np.searchsorted(s, high))
            last = min(last, len(s) - 1)
            if last - first < 4 or not (both[first] and both[last]):
                continue
            law = law_between(q, q_back, s, first, last)
            solver = WristSolver(line, law, q[first], q_end, back)
            remedy = "back to the posture" if last < len(s) - 1 else "other switch"
            yield Choice(solver=solver, trigger=trigger, switch=float(s[first]), remedy=remedy)


def _what_would_do(line: LineSolver, s: Array, excess: Excess) -> str:
    """Return what makes a refused move possible: the wrist of its start, where that does, or another line."""
    via = (
        "A via point beside the line, or another place of the work piece, gives the main axes room; a slower SPEED "
        "does not."
    )
    try:
        q = line.joints(s)
        ratio, _, _ = excess(q)
    except Fault:
        return via
    if not ratio <= MOST_SLOWDOWN:
        return via
    angles = ", ".join(f"{angle / DEG:.1f}" for angle in q[-1, -WRIST_AXES:])
    slowed = f", slowed {ratio:.1f} times," if ratio > 1.0 else ""
    return (
        f"With WRIST KEEP it runs{slowed} and ends with J4 to J6 at {angles} deg: teach that end, or go over a via "
        "point."
    )


def _refusal(line: LineSolver, trigger: Trigger | None, arrives: bool, failures: list[Fault], hint: str) -> Fault:
    """Return the refusal of a move for which nothing did: why the wrist has to change, and what the remedies met."""
    if arrives or trigger is None:
        if failures:
            return failures[0]
        return Fault(
            "RBL412",
            f"the end needs another wrist configuration than {line.branch}, and no condition of the "
            "profile lets the wrist change",
        )
    return explained(failures[0], line.path, trigger, len(failures) - 1, hint)


def explained(fault: Fault, path: Path, trigger: Trigger, others: int = 0, hint: str = "") -> Fault:
    """Return the refusal of a way through the wrist with the reason why the wrist has to go at all."""
    axis = "" if trigger.axis is None else f" of J{trigger.axis + 1}"
    tried = f", nor from {others} other switches" if others else ""
    return Fault(
        fault.code if fault.code == "RBL411" else "RBL412",
        f"the wrist has to change on this {path.move} ({trigger.condition}, {CONDITIONS[trigger.condition]}{axis}, "
        f"at {100 * trigger.share:.1f} % of the path) and cannot from there{tried}: {fault.message}",
        hint or fault.hint,
    )
