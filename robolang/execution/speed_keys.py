"""The speed of a move as reports have it, in the units that people read: of a run, of a line of a planned program."""

from collections.abc import Mapping, Sequence
from typing import Any

from runtime.core.units import MM, PERCENT
from runtime.motion.reached import Reached

KEYS = ("programmed_mm_s", "reached_mm_s", "programmed_pct", "reached_pct", "limited_by", "limited_why")
"""Programmed and highest planned speed: of the tool point, mm/s, or of the joints of a joint move, %; the limit that
keeps the move slow, in a word and in a sentence. None: there is none."""

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
    for unit in ("mm_s", "pct"):
        programmed, reached = row[f"programmed_{unit}"], row[f"reached_{unit}"]
        if programmed is not None and reached is not None:
            return float(reached / programmed)
    return 1.0


def slowest(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the speed of the slowest of several runs of a line, for its programmed speed; a limited one first."""
    found = min(rows, key=lambda row: (row["limited_by"] is None, _ratio(row)))
    return {key: found[key] for key in KEYS}
