"""The speed of a move in a table: what is programmed, before it what is reached where that is less.

Of a line that has run several times what its slowest and its fastest run reach.
"""

from collections.abc import Mapping
from typing import Any


def cell(row: Mapping[str, Any]) -> str:
    """Return ``200`` mm/s that are reached, ``83/200`` that are not, ``83-190/200`` of several runs, and % of the
    joints' speeds of a joint move."""
    for unit, name in (("", "mm_s"), (" %", "pct")):
        programmed, reached = row[f"programmed_{name}"], row[f"reached_{name}"]
        if reached is None:
            continue
        if programmed is None:
            return f"{_range(reached, row.get(f'highest_{name}'))}{unit}"
        # a speed that is reached is not printed twice
        slower = "" if row["limited_by"] is None else f"{_range(reached, row.get(f'highest_{name}'))}/"
        return f"{slower}{_number(programmed)}{unit}"
    return ""


def limited(row: Mapping[str, Any]) -> str:
    """Return the limit that keeps a move slow in two words; empty: none does."""
    return row["limited_by"] or ""


def sentence(row: Mapping[str, Any]) -> str:
    """Return what keeps a move from its speed, as a note says it."""
    return f"{row['limited_why']} ({cell(row)} {'mm/s ' if row['reached_mm_s'] is not None else ''}reached)"


def _range(low: float, high: float | None) -> str:
    texts = [_number(each) for each in (low, high) if each is not None]
    return "-".join(dict.fromkeys(texts))


def _number(value: float) -> str:
    return f"{value:.0f}" if value >= 10.0 else f"{value:.1f}"
