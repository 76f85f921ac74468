"""The dynamics task of Fig 7: one axis after another, resumed wherever the 8 ms interrupt left it.

    300 i = 1 -> 302 read encoders -> 304 D_i -> 306 T_i -> 308 store in ITA -> 310 next i, or from the start

It names the cost of its next step in microseconds; the scheduler lets it work once the idle time has paid for that.
The next interrupt may come in the middle of a step: what was paid stays paid. The angles are read anew for every axis,
so the cells of ITA are of different ages (docs/timing.md). It was a generator, which is shorter but cannot be copied.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from runtime.control.memory_areas import Areas, AxisLoad
from runtime.core.frames import Array
from runtime.core.state import Stateful
from runtime.dynamics.equations import axis_gravity, axis_row
from runtime.dynamics.source import InertiaRows
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.load_rules import LoadMode


@dataclass(frozen=True, slots=True, kw_only=True)
class StepCosts:
    """Declared cost of each step of Fig 7 for one axis, us."""

    read: int
    inertia: int
    gravity: int
    store: int

    @property
    def total(self) -> int:
        """Cd, the cost of one axis, us."""
        return self.read + self.inertia + self.gravity + self.store

    @classmethod
    def of_axis(cls, total_us: int) -> "StepCosts":
        """Split the cost of one axis over its steps: 5 % read, 60 % inertia, 30 % gravity, the rest store."""
        read, inertia, gravity = total_us * 5 // 100, total_us * 60 // 100, total_us * 30 // 100
        return cls(read=read, inertia=inertia, gravity=gravity, store=total_us - read - inertia - gravity)


class DynamicsTask(Stateful):
    """Refreshes ITA for ever, step by step; the scheduler pays ``cost_us``, us, before each ``work``.

    ``read_angles`` returns the detected angles (n,) rad. ``rows`` is where inertia comes from; None: the
    unit-acceleration pass of ``model``.
    """

    VALUES = ("cost_us", "_step", "_axis", "_version", "_payload_version", "_read_us", "_row", "_T")
    PARTS = ("_loaded",)

    def __init__(
        self,
        areas: Areas,
        model: ArmModel,
        costs: StepCosts,
        read_angles: Callable[[], Array],
        load_mode: LoadMode = "add",
        rows: InertiaRows | None = None,
    ) -> None:
        self._areas, self._model, self._read_angles, self._load_mode = areas, model, read_angles, load_mode
        # InertiaRows passes a payload on to the model: T and D carry the same one, set once
        self._loaded: ArmModel | InertiaRows = rows or model
        self._inertia_row: Callable[[Array, int], Array] = partial(axis_row, model) if rows is None else rows.row
        # 21 steps in a cycle by default: each is one look-up, with the cost and the number of the next
        self._steps = (
            (self._read, costs.inertia, 1),
            (self._inertia, costs.gravity, 2),
            (self._gravity, costs.store, 3),
            (self._store, costs.read, 0),
        )
        self.cost_us = costs.read
        self._step = self._axis = self._read_us = 0
        self._version = 1  # 0 is that of ``fill``
        self._payload_version = -1  # of no LOAD: the first step takes what is in SDA
        self._row: Array = np.zeros(model.n)
        self._T = 0.0

    def work(self, now_us: int) -> None:
        """Carry out the step that has been paid for; it ends at ``now_us``."""
        step, self.cost_us, self._step = self._steps[self._step]
        step(now_us)

    def fill(self, q: Array, now_us: int) -> None:
        """Refresh all of ITA at joint angles q (n,) rad at once.

        Called before the brakes open, so that no servo ever works with an empty cell.
        """
        areas = self._areas
        if areas.sda_version:
            self._loaded.set_payload(areas.sda, self._load_mode)
        for axis in range(self._model.n):
            row = self._inertia_row(q, axis)
            areas.ita[axis] = AxisLoad(
                D=float(row[axis]),
                T=axis_gravity(self._model, q, axis),
                row=row,
                read_us=now_us,
                version=0,
                payload_version=areas.sda_version,
            )

    def _read(self, now_us: int) -> None:
        # a copy: the servo reads its encoders again before the axis is done
        self._areas.ang[:] = self._read_angles()
        self._read_us = now_us

    def _inertia(self, now_us: int) -> None:
        areas = self._areas
        # at the first step that uses it; the gravity of the axis follows with the same payload
        if self._payload_version != areas.sda_version:
            self._loaded.set_payload(areas.sda, self._load_mode)
            self._payload_version = areas.sda_version
        self._row = self._inertia_row(areas.ang, self._axis)

    def _gravity(self, now_us: int) -> None:
        self._T = axis_gravity(self._model, self._areas.ang, self._axis)

    def _store(self, now_us: int) -> None:
        axis, row = self._axis, self._row
        load = AxisLoad(
            D=float(row[axis]),
            T=self._T,
            row=row,
            read_us=self._read_us,
            version=self._version,
            payload_version=self._payload_version,
        )
        self._areas.publish(axis, load, now_us)
        self._axis = (axis + 1) % self._model.n
        if self._axis == 0:
            self._version += 1
