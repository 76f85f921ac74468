"""Signals in the units people read: mm, deg, N m, %, as attributes of a log and of a part of it.

The arrays of a log are SI under the names of docs/signals.md; each attribute here names its unit and is one of them
times a factor, or the difference of two.
"""

from typing import Protocol

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import MM


class _Source(Protocol):
    @property
    def joint_units(self) -> Array:
        """Unit of each axis in SI (n,)."""

    def __getitem__(self, name: str, /) -> Array:
        """Return a signal in SI."""


class HumanUnits:
    """Attributes over ``self[name]``; N ticks, n axes."""

    @property
    def t(self: _Source) -> Array:
        """Start of each tick, s (N,)."""
        return self["t"]

    @property
    def joints(self: _Source) -> Array:
        """True joint angles, deg, of a sliding axis its position, mm (N, n)."""
        return np.asarray(self["q_link"] / self.joint_units)

    @property
    def joints_cmd(self: _Source) -> Array:
        """Commanded joint angles, deg, of a sliding axis mm (N, n)."""
        return np.asarray(self["q_cmd"] / self.joint_units)

    @property
    def joint_error(self: _Source) -> Array:
        """Command less true joint angle, deg, of a sliding axis mm (N, n)."""
        return np.asarray((self["q_cmd"] - self["q_link"]) / self.joint_units)

    @property
    def torque_nm(self: _Source) -> Array:
        """Torque that the motors give at the joints, N m, of a sliding axis the force, N (N, n)."""
        return self["tau_sat"]

    @property
    def tool_mm(self: _Source) -> Array:
        """True tool point in the world, mm (N, 3)."""
        return np.asarray(self["X_world_tool"][:, :3, 3] / MM)

    @property
    def tool_cmd_mm(self: _Source) -> Array:
        """Commanded tool point in the world, mm (N, 3)."""
        return np.asarray(self["tool_cmd"] / MM)

    @property
    def tool_error_mm(self: _Source) -> Array:
        """Distance of the true tool point from the commanded one, mm (N,)."""
        return np.asarray(self["tool_error"] / MM)

    @property
    def tool_speed_mm_s(self: _Source) -> Array:
        """Speed of the true tool point, mm/s (N,)."""
        return np.asarray(self["tool_speed"] / MM)
