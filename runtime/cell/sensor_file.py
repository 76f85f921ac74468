"""``[sensors.NAME]`` of a cell file as it is written: the deviation that a seam sensor reads, its noise and its limits.

Units are those of the keys, mm and deg. ``seam_sensor`` has the meaning and makes a sensor of it. Imports no numerics:
``robolang check`` reads it, and a run reads the same.
"""

import io
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Literal, cast

from runtime.core.record import Record
from runtime.core.tomlfile import Table, inside, read_source

Kind = Literal["ramp", "sine", "table"]
KINDS: tuple[Kind, ...] = ("ramp", "sine", "table")
MOST_ROWS = 10_000


class SensorFile(Record):
    """A seam sensor: ``deviation`` (6,) of a ramp or sine; ``rows`` (K, 7) of a table: distance and deviation."""

    kind: Kind
    deviation: tuple[float, ...]
    over_mm: float
    rows: tuple[tuple[float, ...], ...]
    noise: tuple[float, ...]
    lost: float
    seed: int
    in_line_frame: bool
    filter_ms: float
    most_mm: float
    most_deg: float
    lost_ms: float


def read_sensor_file(table: Table, folder: Path | None) -> SensorFile:
    """Read ``[sensors.NAME]``; ``FileFault`` RBL6xx at the key that is wrong. ``folder`` is that of the cell file."""
    kind = cast(Kind, table.text("kind", choices=KINDS))
    listed = kind == "table"
    nothing = (0.0,) * 6
    found = SensorFile(
        kind=kind,
        # keys of the other kinds are not read, so ``done`` refuses them: a deviation would have no effect on a table
        deviation=nothing if listed else table.numbers("deviation_mm_deg", 6, low=-1000.0, high=1000.0),
        over_mm=1e3 if listed else table.number("over_mm", positive=True, high=1e5),
        rows=(table.attempt(lambda: _rows(table, folder)) or ()) if listed else (),
        noise=table.numbers("noise_mm_deg", 6, nothing, low=0.0, high=100.0),
        lost=table.number("lost", 0.0, low=0.0, high=1.0),
        seed=table.integer("seed", 1, low=0, high=2**31),
        in_line_frame=table.text("frame", "world", choices=("world", "line")) == "line",
        filter_ms=table.number("filter_ms", 40.0, low=0.0, high=2000.0),
        most_mm=table.number("most_mm", 20.0, positive=True, high=1000.0),
        most_deg=table.number("most_deg", 10.0, positive=True, high=90.0),
        lost_ms=table.number("lost_ms", 100.0, low=0.0, high=60_000.0),
    )
    table.done()
    return found


def _rows(table: Table, folder: Path | None) -> tuple[tuple[float, ...], ...]:
    """Read the CSV file of a sensor: rows of 7 whose first number, the distance, rises; ``FileFault`` RBL604, 605."""
    import csv  # a cell without such a file is checked sooner

    name = table.text("file")
    source = read_source(inside(table, name, folder, "file"))
    try:
        # strict: a quote that is never closed would otherwise make one cell of the rest of the file
        lines = list(csv.reader(io.StringIO(source.text), strict=True))
    except csv.Error as error:
        table.fail("RBL604", f"'{name}' is not a CSV file: {error}", key="file")
    found: list[tuple[float, ...]] = []
    for number, cells in enumerate(lines, start=1):
        row = _numbers(cells)
        if row is not None:
            found.append(row)
        elif not _may_be_left_out(number, cells):
            table.fail("RBL604", f"line {number} of '{name}' is not 4 or 7 finite numbers", key="file")
    if not 1 <= len(found) <= MOST_ROWS or not all(one[0] < two[0] for one, two in pairwise(found)):
        table.fail("RBL605", f"'{name}' must have 1 to {MOST_ROWS} rows whose first number rises", key="file")
    return tuple(found)


def _may_be_left_out(number: int, cells: Sequence[str]) -> bool:
    """Return whether a line (from 1) is empty, or the heading of the file."""
    return not any(cell.strip() for cell in cells) or (number == 1 and _is_heading(cells))


def _is_heading(cells: Sequence[str]) -> bool:
    """Return whether a first line names its columns: no cell of it is a number."""
    for cell in cells:
        try:
            float(cell)
        except ValueError:
            continue
        return False
    return True


def _numbers(cells: Sequence[str]) -> tuple[float, ...] | None:
    """Return a row of 4 or 7 finite numbers as 7, without turns where it has 4; None for any other."""
    try:
        row = [float(cell) for cell in cells]
    except ValueError:
        return None
    return tuple((row + [0.0] * 3)[:7]) if len(row) in (4, 7) and all(map(math.isfinite, row)) else None
