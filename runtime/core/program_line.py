"""A line of a program, as the runtime knows it: what runs, for the log and for alarms.

A line is counted in two manners that are never put into one field (docs/decisions/0025). ``line`` is its place in the
file, from 1, which editors and diagnostics use. ``number`` is the line number before the statement (``30 MOVE P1``),
which GOTO uses; most lines have none. The front end derives a class with more from this one
(``robolang.interpreter.effects.Origin``), and gets it back from an alarm.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramLine:
    """A line of a program: its place in the file, from 1, and its line number, None where it has none.

    ``line`` 0 is on no line of the program: a statement that was fed.
    """

    line: int
    number: int | None = None


def named(line: int | None, number: int | None) -> str:
    """Return a line as messages name it, 0 or None: no line of the program; the only place that words a line."""
    if not line:
        return "the fed statement"
    return f"line {line}" if number is None else f"line {line} (number {number})"


def logged(statement: ProgramLine | None) -> tuple[int, int]:
    """Return the line of the file and the line number of a statement as the log has them, 0 for none."""
    return (0, 0) if statement is None else (statement.line, statement.number or 0)
