"""Where a TIME or a SPEED of a program is not kept, and what would help: RBL429.

A TIME counts as kept within one cycle. A SPEED is compared by time, with what it and the acceleration of the path let
expect (``MoveTimes.expected_s``): a move that is too short to reach it is no fault (docs/decisions/0030). Of a row of
moves between two stops the one that loses most time is named, with the number of the others. Called by
``PlanFindings``.
"""

from robolang.execution.planned_move import Found, PlanFinding, PlannedMove
from runtime.core.rounding import beside, down, up
from runtime.core.units import MM
from runtime.motion.reached import Reached, Why
from runtime.motion.speeds import REACHED
from runtime.motion.wider_zones import WiderZone

CODE = "RBL429"
_AS_LONG = 1.02
"""A time that is longer by less is as long."""


def slowed(move: PlannedMove) -> Found:
    """Find a TIME that is not kept, or a SPEED whose move takes far longer than this speed lets expect."""
    if move.effect.time_s is not None:
        if move.speeds.late_for_time(move.number):
            yield _of_time(move, move.effect.time_s, move.reached)
    elif move.effect.speed_mm_s is not None and move.number in move.speeds.slowed:
        yield _of_speed(move, move.effect.speed_mm_s, move.reached)


def _under(move: PlannedMove) -> str:
    override = move.effect.override_pct
    return f" under OVERRIDE {override:g}" if override != 100.0 else ""


def _of_time(move: PlannedMove, time_s: float, found: Reached) -> PlanFinding:
    # under OVERRIDE 50 a TIME of 2 s is to take 4 s
    override = move.plan.override
    seconds = round(found.seconds, 3)
    takes, programmed = beside(seconds, time_s / override)
    why = _why(found)
    keeps = f"give TIME {up(seconds * override):g} or more"
    return PlanFinding(
        code=CODE,
        message=f"the move takes {takes} s, not the {programmed} s of TIME {time_s:g}{_under(move)}: {why.text}",
        remedy=lambda: sentence(keeps, *_remedies(move, why)),
    )


def _of_speed(move: PlannedMove, speed: float, found: Reached) -> PlanFinding:
    why, row = _why(found), move.speeds.slowed[move.number]
    moves = [move.speeds.moves[k] for k in row]
    takes, expected = sum(each.seconds for each in moves), sum(each.expected_s for each in moves)
    reaches = f"the move reaches {found.reached / MM:.1f} mm/s at most, not"
    if found.programmed is None or found.reached >= REACHED * found.programmed:
        reaches = "the move is slowed below"
    others = f"with {len(row) - 1} more in its row " if len(row) > 1 else ""
    takes_s = f"{others}takes {takes:.3f} s instead of {expected:.3f} s"
    return PlanFinding(
        code=CODE,
        message=f"{reaches} SPEED {speed:g}{_under(move)}, and {takes_s}: {why.text}",
        remedy=lambda: sentence(*_remedies(move, why), _lower(move, why, len(row) == 1)),
    )


def sentence(*remedies: str) -> str:
    """Return what helps as one sentence; "" is none."""
    text = "; or ".join(filter(None, remedies))
    return f"{text[:1].upper()}{text[1:]}."


def _remedies(move: PlannedMove, why: Why) -> list[str]:
    """Return a zone that makes the moves faster, where planning finds one; else what helps by the reason."""
    wider = None if why.kind == "cusp" else move.speeds.wider_zone(move.number)
    return [why.remedy] if wider is None else [zone_remedy(wider)]


def zone_remedy(wider: WiderZone) -> str:
    """Return a zone to give, and what it saves."""
    shortest, longest = (f"{length / MM:.1f}" for length in (wider.shortest, wider.longest))
    lengths = longest if shortest == longest else f"{shortest} to {longest}"
    return (
        f"give ZONE {wider.zone / MM:g} at the corners of these {wider.moves} moves of {lengths} mm, which then take "
        f"{wider.seconds:.3f} s and not {wider.now_s:.3f} s"
    )


def _lower(move: PlannedMove, why: Why, alone: bool) -> str:
    """Return which SPEED to give: one that planning keeps, where the limit does not hold at that speed as well."""
    if why.kind == "cusp":  # it is slow there at any speed
        return ""
    if alone and why.kind in ("turning", "radius"):
        keeps = move.speeds.times.slower(move.number)
        speed = down(keeps / MM) if keeps > 0.0 else 0.0
        takes_s = move.speeds.seconds_at(move.number, speed * MM) if speed > 0.0 else None
        if takes_s is not None:
            longer = takes_s > move.reached.seconds * _AS_LONG + move.speeds.times.period_s
            return f"give SPEED {speed:g}, which takes {f'{takes_s:.3f} s' if longer else 'as long'}"
    return "lower SPEED"


def _why(found: Reached) -> Why:
    assert found.why is not None  # a move that is late has a reason
    return found.why
