"""A simulated seam sensor: the deviation of the true seam from the taught one, as a sensor before the torch reads it.

``[sensors.NAME]`` of a cell file. The true deviation is a function of the distance along the taught path since SEAM ON:

    ramp    from zero to ``deviation_mm_deg`` over ``over_mm``, constant from there on
    sine    ``deviation_mm_deg`` times sin(2 pi distance / ``over_mm``)
    table   a CSV file beside the cell: rows way_mm, x, y, z [, rx, ry, rz], linear in between

A reading adds noise and may be lost; both come from a generator with a seed of its own, so a run repeats byte for byte.
Readings are in the world frame, or in the weld-line frame (X along the travel, Z up) with ``frame = "line"``. Read once
per 8 ms cycle by the controller (docs/wrist.md, CN103429397A embodiment 3).
"""

import copy
import math
from dataclasses import dataclass

import numpy as np

from runtime.cell.sensor_file import Kind, SensorFile
from runtime.core.frames import Array, frozen, rotation_from_rpy, rpy_from_rotation
from runtime.core.linear import matmul, norm
from runtime.core.units import DEG, MM
from runtime.motion.seam import SeamLimits
from runtime.motion.wrist.hold import weld_line_frame

SCALE = np.array([MM, MM, MM, DEG, DEG, DEG])
SHORTEST_TRAVEL = 1e-6
"""A shorter path has no direction, m."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSpec:
    """A seam sensor in SI: ``distance`` (K,) m and ``values`` (K, 6) m and rad of a table; noise, loss and limits.

    ``deviation`` (6,) and ``over`` m of a ramp or sine; ``noise`` (6,) standard deviations; ``lost`` share of readings.
    """

    kind: Kind
    deviation: Array
    over: float
    distance: Array
    values: Array
    noise: Array
    lost: float
    seed: int
    in_line_frame: bool
    limits: SeamLimits

    @staticmethod
    def of(file: SensorFile) -> "SensorSpec":
        """Return the sensor that a cell file describes."""
        # ramp and sine have no table: one row of zeros keeps the arrays two-dimensional
        rows = np.array(file.rows or ((0.0,) * 7,))
        return SensorSpec(
            kind=file.kind,
            deviation=frozen(np.array(file.deviation) * SCALE),
            over=file.over_mm * MM,
            distance=frozen(rows[:, 0] * MM),
            values=frozen(rows[:, 1:] * SCALE),
            noise=frozen(np.array(file.noise) * SCALE),
            lost=file.lost,
            seed=file.seed,
            in_line_frame=file.in_line_frame,
            limits=SeamLimits(
                filter_s=file.filter_ms * 1e-3,
                most=file.most_mm * MM,
                most_turn=file.most_deg * DEG,
                lost_s=file.lost_ms * 1e-3,
            ),
        )

    def at(self, distance: float) -> Array:
        """Return the true deviation (6,), m and rad, at ``distance`` m along the path; constant past a table."""
        if self.kind == "ramp":
            return np.asarray(self.deviation * min(1.0, distance / self.over))
        if self.kind == "sine":
            return np.asarray(self.deviation * math.sin(2.0 * math.pi * distance / self.over))
        return np.array([np.interp(distance, self.distance, column) for column in self.values.T])


class SeamSensor:
    """The sensor as it runs: the same readings in every run."""

    def __init__(self, spec: SensorSpec) -> None:
        self._spec = spec
        self._random = np.random.default_rng(spec.seed)
        self._travel = np.array([1.0, 0.0, 0.0])

    def __deepcopy__(self, memo: dict[int, object]) -> "SeamSensor":
        """Return a sensor that will give the same readings, noise and losses included."""
        # the generator alone changes: the specification is shared, and the direction is replaced as a whole
        twin = copy.copy(self)
        twin._random = copy.deepcopy(self._random, memo)
        return twin

    def read(self, distance: float, travel: Array) -> Array | None:
        """Return the deviation (6,) read at ``distance`` m along the path, m and rad in the world; None: lost.

        ``travel`` (3,) is the direction of the path; where it has none, that of the move before counts.
        """
        # a move that turns on the spot has no direction to build the weld-line frame on
        if norm(travel) > SHORTEST_TRAVEL:
            self._travel = travel
        spec = self._spec
        # drawn in every cycle, used or not: one lost reading more must not change the noise of all later ones
        noise, lost = self._random.normal(size=6) * spec.noise, self._random.random() < spec.lost
        if lost:
            return None
        seen = spec.at(distance) + noise
        if not spec.in_line_frame:
            return seen
        R_world_line = weld_line_frame(self._travel)
        # a rotation changes its frame by similarity; the three angles themselves are no vector
        turned = matmul(R_world_line, rotation_from_rpy(seen[3:]), R_world_line.T)
        return np.concatenate([matmul(R_world_line, seen[:3]), rpy_from_rotation(turned)])
