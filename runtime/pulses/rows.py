"""The rows of a pulse table: a CSV file, each row checked against the position that the rows before it have reached.

    control,frequency_hz,target_pulses,steps
    up|down,f,P,1       pulses at f Hz until the channel is at P: one time step, abs(P - before) / f = step_s
    wait,0,P,n          no pulses for n steps; the channel stays at P
    end,0,P,0           the last row

Numbers are whole, of at most 15 digits. Lines that begin with # are comments. An error is a ``FileFault`` at its line
and value: RBL631 for a row that no pulse channel can carry out, RBL632 for one that would put the channels of a move
out of step; RBL630 for a file that cannot be read or has more than ``MAX_TABLE_BYTES``.
"""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from runtime.core.frames import frozen
from runtime.core.rounding import beside
from runtime.core.tomlfile import FilePlace
from runtime.pulses.exported import Channel, Table
from runtime.pulses.manifest import fail, quoted, read_text

HEADER = "control,frequency_hz,target_pulses,steps"
MAX_TABLE_BYTES = 64_000_000
ROW_TOLERANCE_S = 1e-9
"""A row lasts one time step to within this, s."""

# at most 15 digits: every such number is a float exactly, and no literal takes long to parse
_WHOLE = r"0|[1-9][0-9]{0,14}"
_ROW = re.compile(rf"(up|down|wait|end),({_WHOLE}),({_WHOLE}|-[1-9][0-9]{{0,14}}),({_WHOLE})")
_CONTROLS = ("up", "down", "wait", "end")
_FREQUENCY, _TARGET, _STEPS = 1, 2, 3


class _Row(NamedTuple):
    """A row as written: control, frequency Hz, absolute target in pulses, number of steps."""

    control: str
    hz: int
    target: int
    steps: int


class Rows:
    """A CSV file being read: each row is checked against the position that the rows before it have reached."""

    def __init__(self, path: Path, channel: Channel, step_s: float) -> None:
        self._path, self._channel, self._step_s = path, channel, step_s
        text = read_text(path, MAX_TABLE_BYTES)
        lines = [line.removesuffix("\r") for line in text.split("\n")]
        self._lines = lines[:-1] if len(lines) > 1 and not lines[-1] else lines
        self._line = 0

    def read(self, stands: int, steps: int) -> tuple[Table, int]:
        """Return the rows that begin at ``stands`` pulses and last ``steps`` steps, and the position at their end.

        ``FileFault`` RBL631 or RBL632 at the first row that cannot be played.
        """
        rows: list[_Row] = []
        ended, at = False, stands
        for line in self._body():
            if ended:
                self._fail("RBL631", "a row after the end", column=1)
            row = self._fields(line)
            self._check(row, at, first=not rows)
            ended = row.control == "end"
            if not ended:
                rows.append(row)
                at = row.target
        if not ended:
            self._fail("RBL631", "the table has no end", column=len(self._lines[self._line - 1]) + 1)
        total = sum(row.steps for row in rows)
        if total != steps:
            self._fail("RBL632", f"{self._channel.name} ends after {total} steps, the move after {steps}")
        return self._table(rows, stands), at

    def _body(self) -> Iterator[str]:
        """Yield the lines after the header, without comments; ``FileFault`` RBL631 for another header.

        ``_line`` is the number of the last one that was yielded.
        """
        numbered = ((k, line) for k, line in enumerate(self._lines, start=1) if not line.startswith("#"))
        self._line, header = next(numbered, (len(self._lines), ""))
        if header != HEADER:
            self._fail("RBL631", f"the header must be {HEADER}")
        for self._line, line in numbered:
            yield line

    def _table(self, rows: list[_Row], start: int) -> Table:
        """Return rows as they are played from ``start`` pulses on."""
        hz = np.array([row.hz if row.control != "down" else -row.hz for row in rows], dtype=np.float64)
        steps = np.array([row.steps for row in rows], dtype=np.float64)
        pulses = [start, *(row.target for row in rows)]
        # a wait lasts its steps; any other row lasts as long as its pulses take, which is one step within rounding
        change = np.abs(np.diff(np.array(pulses, dtype=np.float64)))
        lasts = np.where(hz == 0.0, steps * self._step_s, change / np.where(hz == 0.0, 1.0, np.abs(hz)))
        return Table(
            file=self._path.name,
            frequency=frozen(hz),
            steps=frozen(steps),
            ends=frozen(np.concatenate([[0.0], np.cumsum(lasts)])),
            pulses=frozen(pulses),
        )

    def _fields(self, line: str) -> _Row:
        # one pattern for the good row, since a table may have a million; what is wrong is found in a second pass
        found = _ROW.fullmatch(line)
        if found is None:
            self._explain(line)
        control, hz, target, count = found.groups()
        return _Row(control, int(hz), int(target), int(count))

    def _explain(self, line: str) -> NoReturn:
        """Raise ``FileFault`` RBL631 at the first value for which a line is no row."""
        parts = line.split(",")
        if len(parts) != 4:
            self._fail("RBL631", f"a row has 4 values ({HEADER}), this one {len(parts) if line else 0}", column=1)
        if parts[0] not in _CONTROLS:
            self._fail("RBL631", f"the control is {quoted(parts[0])} and must be {', '.join(_CONTROLS)}", 0)
        names = HEADER.split(",")
        for place, sign in ((_FREQUENCY, ""), (_TARGET, "-?"), (_STEPS, "")):
            if not re.fullmatch(rf"0|{sign}[1-9][0-9]{{0,14}}", parts[place]):
                form = f"a whole number{'' if sign else ' from 0'} of at most 15 digits"
                self._fail("RBL631", f"{names[place]} is {quoted(parts[place])}, not {form}", place)
        raise AssertionError(line)  # pragma: no cover - one of the four is what the pattern refuses

    def _check(self, row: _Row, at: int, *, first: bool) -> None:
        """Refuse a row that a channel at ``at`` pulses cannot play; ``FileFault`` RBL631 or RBL632."""
        control, hz, target, count = row
        if control in ("up", "down"):
            self._check_pulses(row, at, first=first)
            return
        if hz:
            self._fail("RBL631", f"'{control}' has no pulses, and frequency {hz} Hz", _FREQUENCY)
        # at the first row the fault is in how tables fit together, later in the row itself: two codes, two remedies
        if target != at and first:
            self._fail("RBL632", f"{self._channel.name} is at {at} pulses, and the table begins at {target}", _TARGET)
        if target != at:
            self._fail("RBL631", f"'{control}' stays at {at} pulses and cannot reach {target}", _TARGET)
        if (count < 1) == (control == "wait"):
            self._fail("RBL631", f"'{control}' with {count} steps", _STEPS)

    def _check_pulses(self, row: _Row, at: int, *, first: bool) -> None:
        control, hz, target, count = row
        channel, change = self._channel, target - at
        where = f"{at} pulses" + (f", where {channel.name} is," if first else "")
        if count != 1:
            self._fail("RBL631", f"'{control}' lasts 1 step, not {count}", _STEPS)
        if (change <= 0) if control == "up" else (change >= 0):
            self._fail("RBL631", f"'{control}' cannot lead from {where} to {target}", _TARGET)
        if not channel.min_hz <= hz <= channel.max_hz:
            self._fail(
                "RBL631",
                f"{hz} Hz is not between {channel.min_hz:g} and {channel.max_hz:g} Hz, the range of {channel.name}",
                _FREQUENCY,
            )
        if not hz or not abs(abs(change) / hz - self._step_s) <= ROW_TOLERANCE_S:
            takes, step = beside(abs(change) / hz * 1e3 if hz else math.inf, self._step_s * 1e3)
            lasts = f"lasts {takes} ms" if hz else "never ends"
            self._fail("RBL632", f"from {where} to {target} at {hz} Hz {lasts}; a step has {step} ms", _FREQUENCY)

    def _fail(self, code: str, message: str, place: int = 0, column: int | None = None) -> NoReturn:
        """Raise ``FileFault`` at the ``place``-th value of the current line, or at ``column``."""
        line = self._lines[self._line - 1]
        if column is None:
            column = 1 + sum(len(part) + 1 for part in line.split(",")[:place])
        fail(self._path, code, message, place=FilePlace(str(self._path), self._line, column, line))
