"""A line of a program, as the runtime knows it: what runs, for the log and for alarms.

A line is counted in two manners that are never put into one field. ``line`` is its place in the file, from 1: that is
what editors, diagnostics and people who look at the file go by. ``number`` is the line number that the programmer has
written before the statement (``30 MOVE P1``), which GOTO goes by; most lines have none. The front end derives from this
class what it knows more (``robolang.interpreter.effects.Origin``), and gets it back from an alarm.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramLine:
    """A line of a program: its place in the file, from 1, and its line number, None where it has none."""

    line: int
    number: int | None = None


def named(line: int, number: int | None) -> str:
    """Return a line in words for people; the only place that makes them of a line and its number."""
    return f"line {line}" if number is None else f"line {line} (number {number})"


def logged(statement: ProgramLine | None) -> tuple[int, int]:
    """Return a statement as the log has it: line of the file and line number, 0 for none."""
    return (0, 0) if statement is None else (statement.line, statement.number or 0)
