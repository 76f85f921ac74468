"""What happened in a run beside its motion, at its time and its line: alarms, warnings, notes, what PRINT showed."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from robolang.core.diagnostics import Diagnostic
from robolang.core.diagnostics import Severity as Rank
from robolang.core.source import Source
from robolang.execution.alarms import as_json
from robolang.execution.progress import BY_HAND
from robolang.execution.session import Session
from robolang.execution.status import ENDED
from robolang.interpreter.effects import Origin
from runtime.core.faults import Alarm
from runtime.robot.model.estimated import decisive, groups

Severity = Literal["error", "warning", "note", "print"]

MOST_LIVE = 500
"""Alarms, and warnings, that a live page lists, the last ones; a loop may raise thousands."""

_WORDS: dict[Rank, Severity] = {Rank.ERROR: "error", Rank.WARNING: "warning"}


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


def of_run(meta: Mapping[str, Any]) -> list[Note]:
    """Return the notes of a run from the ``meta`` of its log (docs/signals.md), by time."""
    report = meta["report"]
    # a log of an earlier version has no list of estimates
    estimated = of_estimates(report.get("robot_estimated", ()))
    events = _events(report, meta["program"]["name"])
    return in_order([*estimated, *events, *_findings(meta), *_statements(report), *_printed(report)])


def of_estimates(names: Sequence[str]) -> list[Note]:
    """Return the note about values of the robot that are estimates (``RobotSpec.estimated``), where results follow
    from them; it has no time."""
    if not decisive(names):
        return []
    text = f"{len(names)} values of the robot are estimates: {', '.join(groups(names))}"
    return [Note(time_s=None, line=None, code=None, severity="note", text=text)]


def of_finding(item: Mapping[str, Any], program: str, begins: Mapping[int, float]) -> Note:
    """Return what a check has found, as ``execution.findings`` gives it, at the time, s, at which its line begins.

    The page shows one text: what is in a file beside the ``program`` has its place before its words.
    """
    text = "\n".join(filter(None, (item["message"], item["hint"])))
    severity: Severity = item["severity"] if item["severity"] in ("error", "warning") else "note"
    here, line = item["file"] == program, item["line"]
    return Note(
        time_s=begins.get(line) if here else None,
        line=line if here else None,
        code=item["code"],
        severity=severity,
        text=text if here else f"{item['file']}:{line}: {text}",
    )


def of_live(session: Session, stated: Iterable[Note] = ()) -> list[Note]:
    """Return what is known of a session while it goes on: alarms, warnings, what was found in its text before.

    ``stated``: the notes of its statements. What is touched is a warning once nothing changes it any more.
    """
    source, tick_us, controller = session.project.source, session.project.profile.tick_us, session.controller
    touches = controller.touches
    # what is still touched when the program has ended is as complete as in the report
    ended = session.executor.status.state in ENDED
    touched = [] if touches is None else touches.records if ended else touches.over()
    found: dict[str, list[dict[str, Any]]] = {
        key: [_as_json(alarm, rank, source, tick_us) for alarm in alarms[-MOST_LIVE:]]
        for key, rank, alarms in (
            ("alarms", Rank.ERROR, session.record.alarms),
            ("warnings", Rank.WARNING, [*controller.warnings, *controller.touch_warnings(touched)]),
        )
    }
    return in_order(
        [*_events(found, source.path), *(_finding(session, item) for item in session.project.diagnostics), *stated]
    )


def _as_json(alarm: Alarm, severity: Rank, source: Source, tick_us: int) -> dict[str, Any]:
    """Return an alarm as ``as_json`` does; one of set-points has the place that they have in the record: their name."""
    item, of = as_json(alarm, severity, source, tick_us), alarm.statement
    if isinstance(of, Origin) and of.source is not None and of.source.path == BY_HAND:
        item["file"] = of.source.text
    return item


def _finding(session: Session, item: Diagnostic) -> Note:
    # of the text, so of no moment of the run
    return Note(
        time_s=None,
        line=session.project.source.place(item.span.start).line,
        code=item.code,
        severity=_WORDS.get(item.severity, "note"),
        text=f"{item.message}\n{item.hint}",
    )


def in_order(notes: Iterable[Note]) -> list[Note]:
    """Return notes by time, those without one at the end."""
    # sorted keeps the order of those at one time: an alarm stands before the note of its statement
    return sorted(notes, key=lambda note: math.inf if note.time_s is None else note.time_s)


def _events(report: Mapping[str, Any], program: str) -> Iterator[Note]:
    kinds: tuple[tuple[str, Severity], ...] = (("alarms", "error"), ("warnings", "warning"))
    for key, severity in kinds:
        for item in report[key]:
            text = "\n".join(filter(None, (item["message"], item["hint"])))
            # a line of what was jogged or typed is no line of the program
            here = item.get("file", program) == program
            line, text = (item["line"], text) if here else (None, f"{item['file']}: {text}")
            yield Note(time_s=item["time_s"], line=line, code=item["code"], severity=severity, text=text)


def _findings(meta: Mapping[str, Any]) -> Iterator[Note]:
    begins: dict[int, float] = {}
    for item in meta["report"]["statements"]:
        if item["begun"]:
            begins.setdefault(item["line"], item["start_s"])
    # a log of an earlier version has none
    for item in meta.get("findings", ()):
        yield of_finding(item, meta["program"]["name"], begins)


def _statements(report: Mapping[str, Any]) -> Iterator[Note]:
    for item in report["statements"]:
        for text in item["notes"]:
            yield Note(time_s=item["start_s"], line=item["line"], code=None, severity="note", text=text)


def _printed(report: Mapping[str, Any]) -> Iterator[Note]:
    for item in report["printed"]:
        yield Note(time_s=item["time_s"], line=None, code=None, severity="print", text=item["text"])
