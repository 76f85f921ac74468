"""The statements of a run that have begun, as pages get them: what is new, and what has been taken back.

The run's thread adds statements and takes them back, the server's thread reads; neither waits. Every entry has its
place in the run and a number of its own that is never used again, so a page that has got some of them misses exactly
those with a greater number, and the place of the first of these is where its list is cut. What is added between two
looks of the server's thread is found by the next one.
"""

import json
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import takewhile
from typing import Any

MOST_STATEMENTS = 10_000
"""Statements that are kept for a page that comes late."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A statement that has begun: JSON, its place in the run from 0 on, and a number that no other one has."""

    place: int
    number: int
    row: str


@dataclass(slots=True, kw_only=True, eq=False)
class Got:
    """What a page has got: up to which change, which number, and how many statements of the run that makes."""

    changes: int = 0
    number: int = 0
    end: int = 0


class Begun:
    """The statements of one run after another."""

    def __init__(self) -> None:
        self._entries: deque[Entry] = deque(maxlen=MOST_STATEMENTS)
        self._count = 0
        self._number = 0
        self._changes = 0

    # --- the run's thread --------------------------------------------------------------------------------------------

    def add(self, statement: Mapping[str, Any]) -> None:
        """Add a statement that begins."""
        self._append(json.dumps(statement, separators=(",", ":")))

    def settle(self, story: "Begun") -> None:
        """Become the statements of ``story``; those that are the same here stay what they are."""
        oldest = story._count - len(story._entries)
        rows = {each.place: each.row for each in story._entries}
        # older ones than are kept are not compared
        same = takewhile(lambda each: each.place < oldest or rows.get(each.place) == each.row, self._entries)
        stay = max((each.place + 1 for each in same), default=oldest)
        if stay < oldest:
            # nothing of what is here is next to the story
            self._entries.clear()
            stay = oldest
        self._cut(stay)
        for each in story._entries:
            if each.place >= stay:
                self._append(each.row)

    def _cut(self, count: int) -> None:
        """Take back the statements after the first ``count``."""
        while self._entries and self._entries[-1].place >= count:
            self._entries.pop()
        if self._count > count:
            self._changes += 1
        self._count = count

    def _append(self, row: str) -> None:
        self._number += 1
        self._entries.append(Entry(place=self._count, number=self._number, row=row))
        self._count += 1
        # last: who reads it before the entry is there must find another one later
        self._changes += 1

    # --- the server's thread -----------------------------------------------------------------------------------------

    def news(self, got: Got) -> str | None:
        """Return what a page has not got yet as a message; None: it has all. ``from``: its list is cut there first."""
        # read before the entries: what comes in between is sent now, and looked for once more
        changes = self._changes
        if changes == got.changes:
            return None
        # a copy: the run goes on adding to them
        entries = self._entries.copy()
        new = [*takewhile(lambda each: each.number > got.number, reversed(entries))][::-1]
        end = entries[-1].place + 1 if entries else 0
        start, before = new[0].place if new else end, got.end
        got.changes, got.number, got.end = changes, new[-1].number if new else got.number, end
        if not new and end == before:
            return None
        return f'{{"kind":"statements","from":{start},"rows":[{",".join(each.row for each in new)}]}}'
