"""The rows of a pulse table: a CSV file, each row checked against the position that the rows before it have reached.

    control,frequency_hz,target_pulses,steps
    up|down,f,P,1       pulses at f Hz until the channel stands at P: one time step, abs(P - before) / f = step_s
    wait,0,P,n          no pulses for n steps; the channel stands at P
    end,0,P,0           the last row

Numbers are whole, of at most 15 digits. Lines that begin with # are comments. An error is a ``FileFault`` at its line
and value: RBL631 for a row that no pulse channel can carry out, RBL632 for one that would put the channels of a move
out of step; RBL630 for a file that cannot be read or has more than ``MAX_TABLE_BYTES``.
"""

import math
import re
from pathlib import Path
from typing import NoReturn

import numpy as np

from runtime.core.frames import frozen
from runtime.core.rounding import beside
from runtime.pulses.exported import Channel, Table
from runtime.pulses.manifest import fail, quoted, read_text

HEADER = "control,frequency_hz,target_pulses,steps"
MAX_TABLE_BYTES = 64_000_000
ROW_TOLERANCE_S = 1e-9
"""A row lasts one time step to within this, s."""

_WHOLE = r"0|[1-9][0-9]{0,14}"
_ROW = re.compile(rf"(up|down|wait|end),({_WHOLE}),({_WHOLE}|-[1-9][0-9]{{0,14}}),({_WHOLE})")
_CONTROLS = ("up", "down", "wait", "end")
_FREQUENCY, _TARGET, _STEPS = 1, 2, 3


class Rows:
    """A CSV file being read: each row is checked against the position that the rows before it have reached."""

    def __init__(self, path: Path, channel: Channel, step_s: float) -> None:
        self._path, self._channel, self._step_s = path, channel, step_s
        text = read_text(path, MAX_TABLE_BYTES)
        lines = [line.removesuffix("\r") for line in text.split("\n")]
        self._lines = lines[:-1] if len(lines) > 1 and not lines[-1] else lines
        self._line = 0

    def read(self, stands: int, steps: int) -> tuple[Table, int]:
        """Return the rows that begin at ``stands`` pulses and last ``steps`` steps, and the position at their end."""
        numbered = [(k, line) for k, line in enumerate(self._lines, start=1) if not line.startswith("#")]
        self._line = numbered[0][0] if numbered else len(self._lines)
        if not numbered or numbered[0][1] != HEADER:
            self._fail("RBL631", f"the header must be {HEADER}")
        frequency: list[int] = []
        counts: list[int] = []
        pulses = [stands]
        control, total = "", 0
        for self._line, line in numbered[1:]:
            if control == "end":
                self._fail("RBL631", "a row after the end", column=1)
            control, hz, target, count = self._fields(line)
            self._check(control, hz, target, count, pulses[-1], first=not counts)
            if control != "end":
                frequency.append(hz if control != "down" else -hz)
                counts.append(count)
                pulses.append(target)
                total += count
        if control != "end":
            self._fail("RBL631", "the table has no end", column=len(self._lines[self._line - 1]) + 1)
        if total != steps:
            self._fail("RBL632", f"{self._channel.name} ends after {total} steps, the move after {steps}")
        return self._table(frequency, counts, pulses), pulses[-1]

    def _table(self, frequency: list[int], counts: list[int], pulses: list[int]) -> Table:
        hz, steps = np.array(frequency, dtype=np.float64), np.array(counts, dtype=np.float64)
        change = np.abs(np.diff(np.array(pulses, dtype=np.float64)))
        lasts = np.where(hz == 0.0, steps * self._step_s, change / np.where(hz == 0.0, 1.0, np.abs(hz)))
        return Table(
            file=self._path.name,
            frequency=frozen(hz),
            steps=frozen(steps),
            ends=frozen(np.concatenate([[0.0], np.cumsum(lasts)])),
            pulses=frozen(pulses),
        )

    def _fields(self, line: str) -> tuple[str, int, int, int]:
        found = _ROW.fullmatch(line)
        if found is None:
            self._explain(line)
        control, hz, target, count = found.groups()
        return control, int(hz), int(target), int(count)

    def _explain(self, line: str) -> NoReturn:
        """Say why a line is no row."""
        parts = line.split(",")
        if len(parts) != 4:
            self._fail("RBL631", f"a row has 4 values ({HEADER}), this one {len(parts) if line else 0}", column=1)
        if parts[0] not in _CONTROLS:
            self._fail("RBL631", f"the control is {quoted(parts[0])} and must be {', '.join(_CONTROLS)}", 0)
        names = HEADER.split(",")
        for place, sign in ((_FREQUENCY, ""), (_TARGET, "-?"), (_STEPS, "")):
            if not re.fullmatch(rf"0|{sign}[1-9][0-9]{{0,14}}", parts[place]):
                wanted = f"a whole number{'' if sign else ' from 0'} of at most 15 digits"
                self._fail("RBL631", f"{names[place]} is {quoted(parts[place])}, not {wanted}", place)
        raise AssertionError(line)  # pragma: no cover - one of the four is what the pattern refuses

    def _check(self, control: str, hz: int, target: int, count: int, at: int, *, first: bool) -> None:
        if control in ("up", "down"):
            self._check_pulses(control, hz, target, count, at, first=first)
            return
        if hz:
            self._fail("RBL631", f"'{control}' has no pulses, and frequency {hz} Hz", _FREQUENCY)
        if target != at and first:
            self._fail(
                "RBL632", f"{self._channel.name} stands at {at} pulses, and the table begins at {target}", _TARGET
            )
        if target != at:
            self._fail("RBL631", f"'{control}' stands still at {at} pulses and cannot reach {target}", _TARGET)
        if (count < 1) == (control == "wait"):
            self._fail("RBL631", f"'{control}' with {count} steps", _STEPS)

    def _check_pulses(self, control: str, hz: int, target: int, count: int, at: int, *, first: bool) -> None:
        channel, change = self._channel, target - at
        where = f"{at} pulses" + (f", where {channel.name} stands," if first else "")
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
        fail(self._path, code, message, line=self._line, column=column, excerpt=line)
