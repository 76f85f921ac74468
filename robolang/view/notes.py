"""What happened in a run beside its motion, at its time and its line: alarms, warnings, notes, what PRINT showed."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

Severity = Literal["error", "warning", "note", "print"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Note:
    """One event: time s, line of the file, code (None: none); ``p`` m in the world where it has a place.

    Without a time it is in no moment of what the page shows.
    """

    time_s: float | None
    line: int | None
    code: str | None
    severity: Severity
    text: str
    p: tuple[float, float, float] | None = None


def of_report(report: Mapping[str, Any]) -> list[Note]:
    """Return the notes of a run from its report (docs/signals.md), by time."""
    return in_order([*_events(report), *_statements(report), *_printed(report)])


def in_order(notes: Iterable[Note]) -> list[Note]:
    """Return notes by time, those without one at the end."""
    # sorted keeps the order of those at one time: an alarm stands before the note of its statement
    return sorted(notes, key=lambda note: math.inf if note.time_s is None else note.time_s)


def _events(report: Mapping[str, Any]) -> Iterator[Note]:
    kinds: tuple[tuple[str, Severity], ...] = (("alarms", "error"), ("warnings", "warning"))
    for key, severity in kinds:
        for item in report[key]:
            text = "\n".join(filter(None, (item["message"], item["hint"])))
            yield Note(time_s=item["time_s"], line=item["line"], code=item["code"], severity=severity, text=text)


def _statements(report: Mapping[str, Any]) -> Iterator[Note]:
    for item in report["statements"]:
        for text in item["notes"]:
            yield Note(time_s=item["start_s"], line=item["line"], code=None, severity="note", text=text)


def _printed(report: Mapping[str, Any]) -> Iterator[Note]:
    for item in report["printed"]:
        yield Note(time_s=item["time_s"], line=None, code=None, severity="print", text=item["text"])
