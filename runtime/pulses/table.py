"""Positioning tables: the pulses of a channel as the rows that a PLC runs (document 004, 4.6 and 4.7).

A row is a frequency and an absolute target; the channel runs at that frequency until it is there and takes the next
row. With 1/dT a whole number every frequency |dP|/dT is whole and every row lasts exactly dT, which keeps channels in
step. A table counts in one direction and cannot stand still, so it ends where a channel reverses or waits; the step
timer waits and starts the next one.

Neutral form, one file for each channel and move, ``#`` for comments:

    control,frequency_hz,target_pulses,steps
    up,400,-2818,1          run counting up; down: counting down; each lasts one step
    wait,0,-2818,5          stand for 5 steps
    end,0,-2818,0           last row
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

from runtime.pulses.emission import Pulses

Control = Literal["up", "down", "wait", "end"]
HEADER = "control,frequency_hz,target_pulses,steps"


@dataclass(frozen=True, slots=True)
class Row:
    """A row: its control, frequency in Hz, absolute target in pulses, and number of steps."""

    control: Control
    frequency: int
    target: int
    steps: int


@dataclass(frozen=True, slots=True, kw_only=True)
class DataTable:
    """One table of a PLC: rows in one direction, from step ``first`` of the move and from ``start`` pulses on."""

    first: int
    start: int
    rows: tuple[Row, ...]

    @property
    def up(self) -> bool:
        """Whether it counts up."""
        return self.rows[0].control == "up"


def rows_of(steps: Pulses, start: int, count: int, step_hz: int) -> tuple[Row, ...]:
    """Return the rows of a channel at ``start`` pulses that emits ``steps`` (N,) and waits until step ``count``.

    ``step_hz`` is 1/dT, Hz.
    """
    rows, position = [], start
    values = steps.tolist()
    values += [0] * (count - len(values))  # channels end together: one that is done waits for the longest
    for still, group in groupby(values, key=lambda d: d == 0):
        if still:
            rows.append(Row("wait", 0, position, len(list(group))))
            continue
        for d in group:  # a row a step even where the frequency repeats: rows of all channels change together
            position += d
            rows.append(Row("up" if d > 0 else "down", abs(d) * step_hz, position, 1))
    return (*rows, Row("end", 0, position, 0))


def data_tables(rows: Sequence[Row], start: int) -> Iterator[DataTable]:
    """Yield the tables of a channel's rows: one for each stretch in one direction without a wait."""
    # split where the PLC would stop or count without end: at a wait and at a change of direction (F174)
    first, position = 0, start
    for control, group in groupby(rows, key=lambda row: row.control):
        run = tuple(group)
        if control in ("up", "down"):
            yield DataTable(first=first, start=position, rows=run)
        first += sum(row.steps for row in run)
        position = run[-1].target


def as_csv(rows: Sequence[Row], comments: Sequence[str]) -> str:
    """Return the neutral form."""
    lines = [*(f"# {comment}" for comment in comments), HEADER]
    lines += [f"{row.control},{row.frequency},{row.target},{row.steps}" for row in rows]
    return "\n".join(lines) + "\n"
