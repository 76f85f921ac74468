"""The dynamics task of Fig 7: one axis after another, resumed wherever the 8 ms interrupt left it.

    300 i = 1 -> 302 read encoders -> 304 D_i -> 306 T_i -> 308 store in ITA -> 310 next i, or from the start

It is a generator and yields, *before* each step, that step's cost in microseconds; the scheduler resumes it once
the idle time has paid for the step. The next interrupt may come in the middle of a step: what was paid stays paid.
The angles are read anew for every axis, so the cells of ITA are of different ages (docs/timing.md).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from runtime.control.memory_areas import Areas, AxisLoad
from runtime.core.frames import Array
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


def dynamics_task(
    areas: Areas,
    model: ArmModel,
    costs: StepCosts,
    read_angles: Callable[[], Array],
    now_us: Callable[[], int],
    load_mode: LoadMode = "add",
    rows: InertiaRows | None = None,
) -> Iterator[int]:
    """Refresh ITA for ever; yields the cost in us of the step that follows.

    ``read_angles`` returns the detected angles (n,) rad, ``now_us`` the time at which the running step ends. ``rows``
    is where inertia comes from; None: the unit-acceleration pass of ``model``.
    """
    payload_version = -1
    version = 0
    while True:
        version += 1
        for axis in range(model.n):
            yield costs.read
            areas.ang[:] = read_angles()
            read_us = now_us()
            yield costs.inertia
            if payload_version != areas.sda_version:
                (rows or model).set_payload(areas.sda, load_mode)
                payload_version = areas.sda_version
            row = axis_row(model, areas.ang, axis) if rows is None else rows.row(areas.ang, axis)
            yield costs.gravity
            T = axis_gravity(model, areas.ang, axis)
            yield costs.store
            load = AxisLoad(
                D=float(row[axis]), T=T, row=row, read_us=read_us, version=version, payload_version=payload_version
            )
            areas.publish(axis, load, now_us())
