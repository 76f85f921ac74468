"""The speed of a move as reports have it, in the units that people read: of a run, of a line of a planned program."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from runtime.core.units import MM, PERCENT
from runtime.motion.reached import Reached

KEYS = ("programmed_mm_s", "reached_mm_s", "programmed_pct", "reached_pct", "limited_by", "limited_why")
"""Programmed and highest planned speed: of the tool point, mm/s, or of the joints of a joint move, %; the limit that
keeps the move slow, in a word and in a sentence. None: there is none."""

UNITS = ("mm_s", "pct")
"""Of the tool point, and of the joints of a joint move."""
NO_SPEED: Mapping[str, Any] = dict.fromkeys(KEYS)


def speed_keys(found: Reached | None) -> dict[str, Any]:
    """Return the keys of a move; None of all without motion."""
    if found is None or not found.seconds > 0.0:
        return dict(NO_SPEED)
    size, unit = (PERCENT, "pct") if found.of_joints else (MM, "mm_s")
    programmed = None if found.programmed is None else found.programmed / size
    # of the other kind there is no speed: a joint move has no path, and a path no share of joints
    keys = dict(NO_SPEED) | {f"programmed_{unit}": programmed, f"reached_{unit}": found.reached / size}
    if found.why is not None:
        keys |= {"limited_by": found.why.short, "limited_why": found.why.text}
    return keys


def _ratio(row: Mapping[str, Any]) -> float:
    """Return the share of its programmed speed that a move reaches, of the keys above; 1 where none is programmed."""
    # one of the two, or neither with a TIME
    for unit in UNITS:
        programmed, reached = row[f"programmed_{unit}"], row[f"reached_{unit}"]
        if programmed is not None and reached is not None:
            return float(reached / programmed)
    return 1.0


def of_runs(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the keys of a line that has run several times: the speed of its slowest run, a limited one first.

    ``highest_mm_s`` or ``highest_pct`` is the speed of its fastest run for the same programmed one. What is limited has
    the limit of most of the runs that are, in the words of the slowest of these.
    """
    found = min(rows, key=_slower_first)
    named = Counter(row["limited_by"] for row in rows if row["limited_by"] is not None)
    usual = [row for row in rows if named and row["limited_by"] == named.most_common(1)[0][0]]
    limited = min(usual, key=_slower_first, default=found)
    keys = {key: found[key] for key in KEYS}
    keys |= {key: limited[key] for key in ("limited_by", "limited_why")}
    return keys | {f"highest_{unit}": _highest(rows, found, unit) for unit in UNITS}


def _slower_first(row: Mapping[str, Any]) -> tuple[bool, float]:
    return row["limited_by"] is None, _ratio(row)


def _highest(rows: Sequence[Mapping[str, Any]], like: Mapping[str, Any], unit: str) -> float | None:
    """Return the highest speed of runs with the programmed speed of one of them."""
    programmed = f"programmed_{unit}"
    reached = [row[f"reached_{unit}"] for row in rows if row[programmed] == like[programmed]]
    return max((each for each in reached if each is not None), default=None)
