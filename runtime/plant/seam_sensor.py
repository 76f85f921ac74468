"""A simulated seam sensor: how far the true seam is from the taught one, as a sensor in front of the torch sees it.

``[sensors.NAME]`` of a cell file. The true deviation is a function of the way along the taught path since SEAM ON:

    ramp    from nothing to ``deviation_mm_deg`` over ``over_mm``, and that from there on
    sine    ``deviation_mm_deg`` times sin(2 pi way / ``over_mm``)
    table   a CSV file beside the cell: rows way_mm, x, y, z [, rx, ry, rz], straight in between

A reading adds noise and may be lost; both come from a generator with a seed of its own, so a run repeats byte for byte.
Readings are in the world frame, or in the weld-line frame (X along the travel, Z up) with ``frame = "line"``. Read once
per 8 ms cycle by the controller.
"""

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import numpy as np

from runtime.frames import Array, frozen, rotation_from_rpy, rpy_from_rotation
from runtime.linear import matmul, norm
from runtime.motion.hold import weld_line_frame
from runtime.motion.seam import SeamLimits
from runtime.tomlfile import Table, inside, read_source
from runtime.units import DEG, MM

Kind = Literal["ramp", "sine", "table"]
KINDS: tuple[Kind, ...] = ("ramp", "sine", "table")
SCALE = np.array([MM, MM, MM, DEG, DEG, DEG])
MOST_ROWS = 10_000
SHORTEST_TRAVEL = 1e-6
"""A shorter way has no direction, m."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSpec:
    """A seam sensor in SI: ``way`` (K,) m and ``values`` (K, 6) m and rad of a table; noise, loss and what is believed.

    ``deviation`` (6,) and ``over`` m of a ramp or sine; ``noise`` (6,) standard deviations; ``lost`` share of readings.
    """

    kind: Kind
    deviation: Array
    over: float
    way: Array
    values: Array
    noise: Array
    lost: float
    seed: int
    in_line_frame: bool
    limits: SeamLimits

    def at(self, way: float) -> Array:
        """Return the true deviation (6,) at a way along the path, m."""
        if self.kind == "ramp":
            return np.asarray(self.deviation * min(1.0, way / self.over))
        if self.kind == "sine":
            return np.asarray(self.deviation * math.sin(2.0 * math.pi * way / self.over))
        return np.array([np.interp(way, self.way, column) for column in self.values.T])


class SeamSensor:
    """The sensor as it runs: the same readings in every run."""

    def __init__(self, spec: SensorSpec) -> None:
        self._spec = spec
        self._random = np.random.default_rng(spec.seed)
        self._travel = np.array([1.0, 0.0, 0.0])

    def read(self, way: float, travel: Array) -> Array | None:
        """Return the deviation (6,) seen at a way along the path, m and rad in the world; None when it is lost.

        ``travel`` (3,) is the direction of the path; where it has none, that of the move before counts.
        """
        if norm(travel) > SHORTEST_TRAVEL:
            self._travel = travel
        spec = self._spec
        noise, lost = self._random.normal(size=6) * spec.noise, self._random.random() < spec.lost
        if lost:
            return None
        seen = spec.at(way) + noise
        if not spec.in_line_frame:
            return seen
        R_world_line = weld_line_frame(self._travel)
        turned = matmul(R_world_line, rotation_from_rpy(seen[3:]), R_world_line.T)
        return np.concatenate([matmul(R_world_line, seen[:3]), rpy_from_rotation(turned)])


def read_sensor(table: Table, folder: Path | None) -> SensorSpec:
    """Read ``[sensors.NAME]``; ``FileFault`` RBL6xx at what is wrong. ``folder`` is where the cell file stands."""
    kind = cast(Kind, table.text("kind", choices=KINDS))
    way, values = _rows(table, folder) if kind == "table" else (np.zeros(1), np.zeros((1, 6)))
    deviation = np.zeros(6)
    if kind != "table":
        deviation = np.array(table.numbers("deviation_mm_deg", 6, low=-1000.0, high=1000.0)) * SCALE
    spec = SensorSpec(
        kind=kind,
        deviation=frozen(deviation),
        over=1.0 if kind == "table" else table.number("over_mm", positive=True, high=1e5) * MM,
        way=frozen(way),
        values=frozen(values),
        noise=frozen(np.array(table.numbers("noise_mm_deg", 6, (0.0,) * 6, low=0.0, high=100.0)) * SCALE),
        lost=table.number("lost", 0.0, low=0.0, high=1.0),
        seed=table.integer("seed", 1, low=0, high=2**31),
        in_line_frame=table.text("frame", "world", choices=("world", "line")) == "line",
        limits=SeamLimits(
            filter_s=table.number("filter_ms", 40.0, low=0.0, high=2000.0) * 1e-3,
            most=table.number("most_mm", 20.0, positive=True, high=1000.0) * MM,
            most_turn=table.number("most_deg", 10.0, positive=True, high=90.0) * DEG,
            lost_s=table.number("lost_ms", 100.0, low=0.0, high=60_000.0) * 1e-3,
        ),
    )
    table.done()
    return spec


def _rows(table: Table, folder: Path | None) -> tuple[Array, Array]:
    """Read the CSV file of a sensor: ways (K,) m, rising, and deviations (K, 6) m and rad."""
    name = table.text("file")
    source = read_source(inside(table, name, folder, "file"))
    found: list[list[float]] = []
    try:
        for number, cells in enumerate(csv.reader(io.StringIO(source.text), strict=True), start=1):
            row = _numbers(cells)
            if row is not None:
                found.append(row)
            elif any(cell.strip() for cell in cells) and not (number == 1 and _is_heading(cells)):
                table.fail("RBL604", f"line {number} of '{name}' is not 4 or 7 finite numbers", key="file")
    except csv.Error as error:
        table.fail("RBL604", f"'{name}' is not a CSV file: {error}", key="file")
    rows = np.array(found).reshape(-1, 7)
    if not 1 <= len(rows) <= MOST_ROWS or not (np.diff(rows[:, 0]) > 0.0).all():
        table.fail("RBL605", f"'{name}' must have 1 to {MOST_ROWS} rows whose first number rises", key="file")
    return rows[:, 0] * MM, rows[:, 1:] * SCALE


def _is_heading(cells: Sequence[str]) -> bool:
    """Return whether a first line names its columns: no cell of it is a number."""
    for cell in cells:
        try:
            float(cell)
        except ValueError:
            continue
        return False
    return True


def _numbers(cells: Sequence[str]) -> list[float] | None:
    try:
        row = [float(cell) for cell in cells]
    except ValueError:
        return None
    return (row + [0.0] * 3)[:7] if len(row) in (4, 7) and np.isfinite(row).all() else None
