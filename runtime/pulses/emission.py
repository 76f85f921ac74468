"""Pulses that a channel can emit: no step below its lowest frequency, and no pulse lost (document 004, 4.5).

A channel cannot run below F_min, so a step of fewer than dP_min = ceil(F_min dT) pulses cannot be emitted as it is.

``compensate``, S06 of the document: such a step is raised to dP_min, and what it emits too much is carried, signed,
until a step of 2 dP_min or more can give it back:

    0 < |d| < dP_min            e = sgn(d) dP_min           c += e - d
    |d| >= 2 dP_min, c with d   e = d - sgn(d) pay          c -= sgn(d) pay         pay = min(|c|, |d| - dP_min)
    |d| >= dP_min, c against d  e = d - c                   c = 0
    otherwise                   e = d

``hold``, not in the document: where a joint creeps for a whole move there is no such step, and c grows without bound.
There the channel stands still until more than half of dP_min is due, and emits what is due, dP_min at least: its error
is at most half of that, and it never reverses for pulses emitted too many.
``emit`` takes the document's rule while it keeps within ``MOST_CARRIED`` dP_min and leaves no more at the end than one
step can bear, else the second (docs/decisions/0021).

``settle`` makes the sum exact: what is carried after the last point is taken from the last step that can bear it, else
from several, else a step is left out and others raised, else one or two steps are appended. Called once a move and
channel; pulses are whole numbers, so all sums here are exact.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Pulses = NDArray[np.int64]
Rule = Literal["none", "compensate", "hold"]

MOST_CARRIED = 2
"""Most pulses that the document's rule may carry, in terms of dP_min (docs/decisions/0021)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Emission:
    """The pulses of a channel for a move: ``steps`` (N',), N' >= N where steps were appended.

    ``raised`` counts the steps that were changed since their frequency was too low, ``debt`` is the largest error after
    any step, pulses, ``settled`` the error left for the end; ``rule`` is the one that was used.
    """

    steps: Pulses
    raised: int
    debt: int
    settled: int
    rule: Rule


def least_step(min_hz: float, step_s: float) -> int:
    """Return dP_min, the fewest pulses of a step that is not empty."""
    return max(1, math.ceil(min_hz * step_s - 1e-9))


def emit(planned: Pulses, least: int, most: int) -> Emission:
    """Return the emission of ``planned`` steps (N,) pulses, each 0 or from ``least`` to ``most``; the sum is the same.

    ``ValueError`` where a step of ``planned`` exceeds ``most``.
    """
    if len(planned) and int(np.abs(planned).max()) > most:
        raise ValueError(f"a step of {int(np.abs(planned).max())} pulses is over {most}")
    short = (planned != 0) & (np.abs(planned) < least)
    if not short.any():
        return Emission(steps=planned, raised=0, debt=0, settled=0, rule="none")
    steps, raised, left = compensate(planned, least)
    rule: Rule = "compensate"
    worst = _debt(steps, planned)
    # one step has to bear what is left: spread over several, the end of the move would be off its line for longer
    borne = left == 0 or _bearer(steps, left, least, most) is not None
    if worst > MOST_CARRIED * least or int(np.abs(steps).max()) > most or not borne:
        steps, raised, left = hold(planned, least, most)
        rule = "hold"
    settled = settle(steps, -left, least, most)
    return Emission(steps=settled, raised=raised, debt=_debt(settled, planned), settled=left, rule=rule)


def compensate(planned: Pulses, least: int) -> tuple[Pulses, int, int]:
    """Return the steps of S06, how many were raised, and the pulses carried at the end."""
    emitted, carried, raised = [], 0, 0
    for d in planned.tolist():
        size, sign = abs(d), 1 if d > 0 else -1
        e = d
        # the four lines of the table above, in their order
        if 0 < size < least:
            e = sign * least
            raised += 1
        elif carried * sign > 0 and size >= 2 * least:
            e = d - sign * min(abs(carried), size - least)
        elif carried * sign < 0 and size >= least:
            e = d - carried
        carried += e - d
        emitted.append(e)
    return np.array(emitted, dtype=np.int64), raised, carried


def hold(planned: Pulses, least: int, most: int) -> tuple[Pulses, int, int]:
    """Return steps that stand until half of ``least`` is due, how many differ, and the pulses carried at the end."""
    emitted, due = [], 0
    for d in planned.tolist():
        due += d
        size, sign = abs(due), 1 if due > 0 else -1
        # at half of dP_min standing still and one step of it are equally wrong; only more than half is worth a step
        e = sign * min(max(size, least), most) if 2 * size > least else 0
        due -= e
        emitted.append(e)
    steps = np.array(emitted, dtype=np.int64)
    return steps, int((steps != planned).sum()), -due


def settle(steps: Pulses, missing: int, least: int, most: int) -> Pulses:
    """Return steps whose sum is larger by ``missing`` pulses, none of them between 0 and ``least``."""
    found = _spread(steps, missing, least, most)
    if found is None:
        # without a step of the other direction the sum has the missing pulses, or more; the others bear the difference
        against = np.flatnonzero(steps * missing < 0)
        if len(against):
            last = int(against[-1])
            without = steps.copy()
            without[last] = 0
            found = _spread(without, missing + int(steps[last]), least, most)
    if found is not None:
        return found
    # nothing can bear it, so the move gets longer by a step, or by two where the rest is below dP_min: there and back
    sign = 1 if missing > 0 else -1
    more = _pieces(missing, least, most) if abs(missing) >= least else [missing + sign * least, -sign * least]
    return np.append(steps, more)


def _spread(steps: Pulses, missing: int, least: int, most: int) -> Pulses | None:
    """Return steps with ``missing`` given to the last one that can bear it, else to several; None where none can."""
    steps = steps.copy()
    if missing == 0:
        return steps
    at = _bearer(steps, -missing, least, most)
    if at is not None:
        steps[at] += missing
        return steps
    return steps if _shared(steps, missing, least, most) == 0 else None


def _bearer(steps: Pulses, carried: int, least: int, most: int) -> int | None:
    """Return the last step that stays a step when ``carried`` is taken from it."""
    after = steps - carried
    able = (steps != 0) & (steps * after > 0) & (np.abs(after) >= least) & (np.abs(after) <= most)
    found = np.flatnonzero(able)
    return int(found[-1]) if len(found) else None


def _shared(steps: Pulses, missing: int, least: int, most: int) -> int:
    """Give ``missing`` to several steps from the last on, in place; return what is left of it."""
    # from the end: the error is made good as late, and so as near to the taught end, as it can be
    for k in reversed(np.flatnonzero(steps).tolist()):
        if missing == 0:
            break
        size, along = abs(int(steps[k])), missing * int(steps[k]) > 0
        share = min(abs(missing), most - size if along else size - least)
        change = share if missing > 0 else -share
        steps[k] += change
        missing -= change
    return missing


def _pieces(pulses: int, least: int, most: int) -> list[int]:
    """Return ``pulses`` in as few steps of ``least`` to ``most`` as will do."""
    count = -(-abs(pulses) // most)
    size, more = divmod(abs(pulses), count)
    return [(size + (k < more)) * (1 if pulses > 0 else -1) for k in range(count)]


def _debt(steps: Pulses, planned: Pulses) -> int:
    """Return the largest difference between pulses emitted and planned, after any step."""
    off = np.cumsum(steps)
    off[: len(planned)] -= np.cumsum(planned)
    off[len(planned) :] -= int(planned.sum())
    return int(np.abs(off).max()) if len(off) else 0
