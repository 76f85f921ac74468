"""Alarms and warnings of a run as people, reports and tools get them: at the statement that ran.

The controller keeps the statement with each alarm (``effects.Origin``), so the place is that of the statement itself.
The calls that led to it follow as related places.
"""

from itertools import groupby

from robolang.core.diagnostics import Diagnostic, Related, Severity, to_json
from robolang.core.source import Source
from robolang.interpreter.effects import Origin
from robolang.interpreter.events import Failed
from runtime.core.faults import Alarm
from runtime.core.program_line import ProgramLine

SHOWN_CALLS = 3
"""Calls that are shown at each end of a long chain of them."""


def as_diagnostic(alarm: Alarm, severity: Severity) -> Diagnostic:
    """Return an alarm as a diagnostic at its statement."""
    return Diagnostic(
        code=alarm.code,
        severity=severity,
        message=alarm.message,
        span=_of_session(alarm.statement).span,
        source=_of_session(alarm.statement).source,
        hint=alarm.hint,
        related=calls(alarm.calls),
    )


def failure(fault: Failed) -> Diagnostic:
    """Return a fault that the program does not catch as a diagnostic at its place."""
    return Diagnostic(
        code=fault.code,
        message=fault.message,
        span=fault.origin.span,
        source=fault.origin.source,
        hint=fault.hint,
        related=calls(fault.calls),
    )


def as_json(alarm: Alarm, severity: Severity, source: Source, tick_us: int) -> dict[str, object]:
    """Return an alarm as an object of plain JSON types: that of its diagnostic, and what the run adds (signals.md)."""
    return {
        **to_json(as_diagnostic(alarm, severity), source),
        "number": None if alarm.statement is None else alarm.statement.number,
        "axis": None if alarm.axis is None else alarm.axis + 1,
        "time_s": alarm.tick * tick_us / 1_000_000,
        "category": alarm.category,
    }


def calls(chain: tuple[ProgramLine, ...]) -> tuple[Related, ...]:
    """Return the calls that led to a place, outermost first, as related places.

    The same call again and again is one of them, of many the first and the last are shown.
    """
    rows = [(span, len(list(same))) for span, same in groupby(_of_session(each).span for each in chain)]
    hidden = rows[SHOWN_CALLS : max(SHOWN_CALLS, len(rows) - SHOWN_CALLS)]
    if len(hidden) > 1:  # a note in place of one row saves nothing
        rows = rows[:SHOWN_CALLS] + rows[-SHOWN_CALLS:]
    more = f", after {sum(count for _, count in hidden)} more calls" if len(hidden) > 1 else ""
    return tuple(
        Related(span=span, message=f"called here{more * (at == SHOWN_CALLS)}{_times(count)}")
        for at, (span, count) in enumerate(rows)
    )


def _times(count: int) -> str:
    return f", {count} times within itself" if count > 1 else ""


def _of_session(statement: ProgramLine | None) -> Origin:
    assert isinstance(statement, Origin)  # a session gives the controller nothing else, and before its first cycle
    return statement
