"""The report of a run as an object: the plain JSON that it is, with attributes that say what is in it."""

import html
from collections.abc import Sequence
from typing import Any, Generic, TypeVar, overload

import numpy as np

from robolang.core import tables

_SHOWN = ("line", "number", "text", "start_s", "duration_s", "joint_error_deg", "tool_error_mm", "peak_torque_pct")


T = TypeVar("T")


class Key(Generic[T]):
    """An attribute that is the key of its name; ``text`` is its docstring."""

    def __init__(self, text: str) -> None:
        self.__doc__ = text
        self._name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, found: None, owner: type) -> "Key[T]": ...
    @overload
    def __get__(self, found: dict[str, Any], owner: type) -> T: ...
    def __get__(self, found: dict[str, Any] | None, owner: type) -> "Key[T] | T":
        """Return the value of the key."""
        if found is None:
            return self
        # the JSON is believed: its keys are those that build_report writes
        value: T = found[self._name]
        return value

    def __set__(self, found: dict[str, Any], value: T) -> None:
        # a number that was measured and one that somebody wrote there must not look alike
        raise AttributeError(f"{self._name} of a report is read only")


class StatementReport(dict[str, Any]):
    """What one statement did, and how well; the keys are those of the JSON report (docs/signals.md)."""

    line = Key[int | None]("Line of the file, from 1; None: it was fed and is in no line.")
    number = Key[int | None]("Its line number, None where it has none.")
    text = Key[str]("The statement as it is formatted.")
    begun = Key[bool]("Whether it was reached; numbers of one that was not are None.")
    start_s = Key[float | None]("When it began, s of simulated time.")
    duration_s = Key[float | None]("How long it took, s.")
    planned_s = Key[float | None]("How long its motion was planned to take, s; None without motion.")
    programmed_mm_s = Key[float | None]("Programmed speed of the tool point, mm/s; None with TIME and of MOVEJ.")
    reached_mm_s = Key[float | None]("Highest planned speed of the tool point, mm/s; None of MOVEJ.")
    programmed_pct = Key[float | None]("Programmed speed of MOVEJ, % of the joints' speeds; None with TIME.")
    reached_pct = Key[float | None]("Highest planned speed of MOVEJ, % of the joints' speeds.")
    limited_by = Key[str | None]("What keeps the move from its speed, such as ``J5 speed``; None: nothing does.")
    limited_why = Key[str | None]("The same in words, with place and numbers.")
    joint_error_deg = Key[float | None]("Largest distance of a joint from its command, deg.")
    joint_error_mm = Key[float | None](
        "Largest distance of a joint that slides from its command, mm; no key where all joints turn."
    )
    tool_error_mm = Key[float | None]("Largest distance of the tool point from its command, mm.")
    path_deviation_mm = Key[float | None](
        "Largest distance of the tool point from the paths of this move and of those beside it, mm; None without one."
    )
    peak_torque_pct = Key[float | None]("Largest torque of a joint, % of its limit.")
    notes = Key[list[str]]("What there is to say of it.")


class Report(dict[str, Any]):
    """The report of a run. ``report["sim_time_s"]`` and ``report.sim_time_s`` are the same number."""

    program = Key[str]("The program file.")
    robot = Key[str]("The name of the robot.")
    ok = Key[bool]("Whether no alarm ended the run.")
    physics = Key[bool]("Whether MuJoCo was the arm, and not the ideal one.")
    sim_time_s = Key[float]("Simulated time of the run, s: the cycle time of a program that ran to its end.")
    wall_time_s = Key[float]("Time that the run took on this computer, s.")
    statements = Key[list[StatementReport]]("The statements that were carried out, in order.")
    printed = Key[list[dict[str, Any]]]("What PRINT showed: ``time_s`` and ``text``.")
    objects = Key[dict[str, dict[str, list[float]]]](
        "Where each part is at the end: ``pose_mm_deg`` of six numbers, mm and deg."
    )
    alarms = Key[list[dict[str, Any]]](
        "The alarms, the one that stopped the arm first: ``code``, ``message``, ``line``, ``time_s`` and others."
    )
    warnings = Key[list[dict[str, Any]]]("The warnings, with the keys of the alarms.")

    @property
    def joint_error_deg(self) -> float:
        """Largest distance of a joint from its command in the run, deg; NaN where nothing moved."""
        return self._largest("joint_error_deg")

    @property
    def tool_error_mm(self) -> float:
        """Largest distance of the tool point from its command in the run, mm; NaN where nothing moved."""
        return self._largest("tool_error_mm")

    @property
    def path_deviation_mm(self) -> float:
        """Largest distance of the tool point from a straight line in the run, mm; NaN without one."""
        return self._largest("path_deviation_mm")

    @property
    def peak_torque_pct(self) -> float:
        """Largest torque of a joint in the run, % of its limit; NaN where nothing moved."""
        return self._largest("peak_torque_pct")

    def at_line(self, line: int) -> list[StatementReport]:
        """Return what ran in a line: a line number in a program that has them, else a line of the file."""
        key = "line" if all(each.number is None for each in self.statements) else "number"
        return [each for each in self.statements if each[key] == line]

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` with a row for each statement; ``ImportError`` without pandas."""
        return tables.to_pandas(self._columns())

    def to_polars(self) -> Any:
        """Return a ``polars.DataFrame`` with a row for each statement; ``ImportError`` without polars."""
        return tables.to_polars(self._columns())

    def _columns(self) -> dict[str, list[Any]]:
        # those with one value: what is nested is in the report itself
        nested = ("notes", "touched", "wrist", "seam")
        names = [name for name in (self.statements[0] if self.statements else _SHOWN) if name not in nested]
        return {name: [each[name] for each in self.statements] for name in names}

    def _largest(self, name: str) -> float:
        # numpy's, which does not pass over NaN
        numbers = [each[name] for each in self.statements if each[name] is not None]
        return float(np.max(numbers)) if numbers else float("nan")

    def __repr__(self) -> str:
        """Return one line: a report of a long program would fill a screen."""
        return f"<Report of {self.program} on {self.robot}: {_outcome(self)}>"

    def _repr_html_(self) -> str:
        rows = [[_text(each[name]) for name in _SHOWN] for each in self.statements]
        return f"<p>{html.escape(repr(self)[1:-1])}</p>{_table(_SHOWN, rows)}"


def report_of(found: dict[str, Any]) -> Report:
    """Return the report that plain JSON holds, of a run or of a file."""
    return Report({**found, "statements": [StatementReport(each) for each in found["statements"]]})


def _outcome(report: Report) -> str:
    alarms, warnings = len(report.alarms), len(report.warnings)
    came_out = "ok" if report.ok else f"{alarms} alarm{'s' * (alarms != 1)}"
    more = f", {warnings} warning{'s' * (warnings != 1)}" if warnings else ""
    return f"{report.sim_time_s:.3f} s, {len(report.statements)} statements, {came_out}{more}"


def _text(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    # texts of programs are other people's words
    head = "".join(f"<th>{html.escape(each)}</th>" for each in headings)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(each)}</td>" for each in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
