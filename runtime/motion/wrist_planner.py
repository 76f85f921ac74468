"""Choosing how a move along a path goes through the wrist: the document's switch, then remedies, then a refusal.

The whole move is solved before it starts, on the 8 ms samples and at every servo tick. So what CN103429397A leaves to
chance shows while the arm stands still: no solution of the main axes (H1), another arm configuration at the end (H2), a
wrist (H3) or main axis (H4) beyond its speed, a range passed. Tried in this order (``wrist_remedies``):

    1  the path with its posture, where it ends at the taught angles, slowed by at most ``posture_first``
    2  the switch where the first condition is met, in the shape of the profile
    3  softer starts, other switches, curves that return to the posture before the end: of those that keep every limit
       at the programmed speed the one whose posture, or whose held components, deviate least
    4  of 1 to 3, where each has to be slowed, the one that deviates least of those slowed by at most ``posture_first``;
       where all have to be slowed more, the one slowed least
    5  where none of them has a solution at all, the first detour of J4 and J5 that has one

``remedies = false`` in the profile is the document alone: 1 only where no condition is met, then 2. Called by
``CartesianPlanner``; docs/wrist.md has the hazards and what each remedy is good for.
"""

from dataclasses import replace

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.core.units import DEG, badness
from runtime.motion.commands import MoveLinear, PathMove
from runtime.motion.path import Path
from runtime.motion.path_ik import MOST_SLOWDOWN
from runtime.motion.taught_end import ends
from runtime.motion.wrist.switch import CONDITIONS, Trigger
from runtime.motion.wrist_remedies import DETOUR, HeldPosture, stages
from runtime.motion.wrist_request import Candidate, SampledPath, WristRequest, posture_deviation, trigger_of
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.settings.profile import WristOptions


def choose(sampled: SampledPath, command: PathMove, options: WristOptions) -> Candidate:
    """Return how a move goes: to its taught joint angles, or to any end that its point leaves open.

    ``Fault`` RBL412 (or 410, 411) where it can go to none of them.
    """
    usable: list[Candidate] = []
    refusals: list[Fault] = []
    for q_end in ends(sampled.line, sampled.q, command):
        try:
            found = crossing(_request(sampled, q_end, command, options))
        except Fault as fault:
            refusals.append(fault)
            continue
        # another end may be faster, but not by flipping the tool to save less than what the posture is worth
        if found.ratio <= (1.0 if found.switch is not None else options.posture_first):
            return found
        usable.append(found)
    if usable:
        return min(usable, key=lambda candidate: badness(candidate.ratio))
    if refusals:
        raise refusals[0]
    return Candidate(solver=sampled.line)  # no end to go to: solving the path says where it leaves the reach


def _request(sampled: SampledPath, q_end: Array, command: PathMove, options: WristOptions) -> WristRequest:
    """Return what a move to joint angles q_end (n,) has to keep.

    Where only a pose is taught, the end may be any of its solutions, and the tool may turn by less on the path there: a
    posture is not thrown away for a solution that nobody has taught (docs/decisions/0018).
    """
    taught = command.q_end is not None or bool(command.configuration or command.turns)
    tracked = isinstance(command, MoveLinear) and command.tracked
    return WristRequest(
        sampled=sampled,
        q_end=q_end,
        options=options,
        trigger=trigger_of(sampled, q_end, options),
        held=() if tracked else command.held,
        most_deviation=options.most_deviation if taught else options.untaught_deviation,
        tracked=tracked,
    )


def crossing(request: WristRequest) -> Candidate:
    """Return how a move goes to one end; ``Fault`` RBL412 (or 410, 411) where it cannot."""
    holding = HeldPosture(request)
    usable: list[Candidate] = []
    refusals: list[Fault] = []
    for remedies in stages(request.options):
        for remedy in remedies:
            for candidate in remedy(request, holding):
                candidate = judged(candidate, request)
                if candidate.rejected is not None:
                    refusals.append(candidate.rejected)
                    continue
                if _settles(candidate, request):
                    return candidate
                usable.append(candidate)
        # candidates that have to be slowed are compared only when all of a stage are known
        if usable:
            return _best(usable, request.options)
    raise _refusal(request, refusals)


def judged(candidate: Candidate, request: WristRequest) -> Candidate:
    """Return a candidate with its speed ratio and its deviation, or with the fault for which it is rejected."""
    sampled, line = request.sampled, request.sampled.line
    try:
        rows = candidate.solver.joints(sampled.s)
    except Fault as fault:
        return replace(candidate, rejected=fault)
    ratio, axis, quantity = sampled.excess(rows)
    if not ratio <= MOST_SLOWDOWN:
        return replace(candidate, rejected=_too_fast(ratio, axis, quantity))
    if candidate.switch is None:
        return replace(candidate, ratio=ratio)
    deviation = posture_deviation(line, sampled.s, rows)
    if not deviation <= request.most_deviation:
        return replace(candidate, rejected=_too_far(deviation, request.most_deviation))
    if request.held:
        deviation = posture_deviation(line, sampled.s, rows, request.held)
    return replace(candidate, ratio=ratio, deviation=deviation)


def _settles(candidate: Candidate, request: WristRequest) -> bool:
    """Return whether a candidate ends the search: a path kept fast enough, or the switch as the document has it.

    With held components the document's switch is compared with others, since it disregards the posture. Of the detours
    the first that can be executed is taken: the larger ones after it turn the tool further.
    """
    if candidate.switch is None:
        return candidate.ratio <= request.options.posture_first
    if candidate.remedy == DETOUR:
        return True
    return candidate.ratio <= 1.0 and not candidate.remedy and not request.held


def _best(candidates: list[Candidate], options: WristOptions) -> Candidate:
    """Return the candidate with the least deviation of those that are fast enough (rules 3 and 4)."""
    fastest = min((candidate.ratio for candidate in candidates), key=badness)
    slowest = 1.0 if fastest <= 1.0 else max(fastest, options.posture_first)
    quick = [candidate for candidate in candidates if candidate.ratio <= slowest]
    # rounded: no tie is decided by the last digits, which differ between processors
    return min(quick, key=lambda candidate: (badness(round(candidate.deviation, 9)), round(candidate.ratio, 9)))


def _too_fast(ratio: float, axis: int, quantity: str) -> Fault:
    return Fault(
        "RBL412",
        f"J{axis + 1} would pass its limit of {quantity} so far that the move would have to be slowed "
        f"{ratio:.0f} times",
    )


def _too_far(deviation: float, most_deviation: float) -> Fault:
    turn, most = beside(deviation / DEG, most_deviation / DEG, form=".0f")
    return Fault("RBL412", f"the tool would turn up to {turn} deg from its posture on the path, more than {most} deg")


def _refusal(request: WristRequest, refusals: list[Fault]) -> Fault:
    """Return the refusal of a move for which no candidate did: why the wrist has to change, and what the first met."""
    # the first refusal is that of the document's switch, which the profile decides; the others are only counted
    sampled, trigger = request.sampled, request.trigger
    if trigger is not None and not request.arrives:
        return explained(refusals[0], sampled.line.path, trigger, len(refusals) - 1, _advice(sampled))
    if refusals:
        return refusals[0]
    return Fault(
        "RBL412",
        f"the end needs another wrist configuration than {sampled.line.branch}, and no condition of the "
        "profile lets the wrist change",
    )


def _advice(sampled: SampledPath) -> str:
    """Return what makes a refused move possible: the wrist of its start, where that does, or another line."""
    via = (
        "A via point beside the line, or another place of the work piece, gives the main axes room; a slower SPEED "
        "does not."
    )
    try:
        q = sampled.line.joints(sampled.s)
        ratio, _, _ = sampled.excess(q)
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


def explained(fault: Fault, path: Path, trigger: Trigger, others: int = 0, hint: str = "") -> Fault:
    """Return the refusal of a candidate with the reason why the wrist has to change at all."""
    # RBL411 stays: a joint that leaves its range has another remedy than a wrist that cannot change
    axis = "" if trigger.axis is None else f" of J{trigger.axis + 1}"
    others_too = f", nor from {others} other switches" if others else ""
    return Fault(
        fault.code if fault.code == "RBL411" else "RBL412",
        f"the wrist has to change on this {path.move} ({trigger.condition}, {CONDITIONS[trigger.condition]}{axis}, "
        f"at {100 * trigger.share:.1f} % of the path) and cannot from there{others_too}: {fault.message}",
        hint or fault.hint,
    )
