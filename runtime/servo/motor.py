"""The motor of each axis: encoder, current limit and current loop.

The encoder counts whole steps: ``alpha = round(q / r) r`` with ``r = 2 pi / (counts |N|)`` at the joint. The
current command is limited by the drive and by the torque limit of the joint, then follows with the lag of the
current loop, ``i += (1 - exp(-wc Ts)) (I - i)``, an exact step of a first-order loop of bandwidth wc. Torque at
the joint is ``Ktn i``; since the lag is a weighted mean of limited values, torque never passes its limit.
Broadcasts over leading dimensions ``(..., n)``, in place.
"""

import math

import numpy as np
from numpy import add, maximum, minimum, multiply, rint, subtract

from runtime.core.frames import Array
from runtime.core.state import Stateful
from runtime.robot.model.spec import RobotSpec


class Encoders:
    """Quantised joint angles."""

    def __init__(self, resolution: Array) -> None:
        self.resolution = resolution
        self._per_step = 1.0 / resolution

    def read(self, q: Array, out: Array) -> None:
        """Write the detected angles of q (..., n) rad to ``out``."""
        multiply(q, self._per_step, out)
        rint(out, out)
        multiply(out, self.resolution, out)


class Motors(Stateful):
    """Current loops and limits of all axes."""

    BUFFERS = ("i",)

    def __init__(self, Ktn: Array, max_current: Array, bandwidth: Array, tick_s: float) -> None:
        self.Ktn = np.asarray(Ktn, dtype=np.float64)
        self.max_current = np.asarray(max_current, dtype=np.float64)
        self._min_current = -self.max_current
        self._share = 1.0 - np.exp(-np.asarray(bandwidth) * tick_s)
        self._limited = np.zeros(np.shape(max_current))
        self.i = np.zeros(np.shape(max_current))
        """Motor current, A (..., n)."""

    def torque(self, command: Array, out: Array) -> None:
        """Follow a current command (..., n) A for one tick and write the joint torque, N m, to ``out``."""
        limited = self._limited
        minimum(command, self.max_current, out=limited)
        maximum(limited, self._min_current, out=limited)
        subtract(limited, self.i, limited)
        multiply(limited, self._share, limited)
        add(self.i, limited, self.i)
        multiply(self.i, self.Ktn, out)


def encoder_resolution(spec: RobotSpec) -> Array:
    """Return the encoder step of every axis at the joint (n,), rad."""
    return np.array([2.0 * math.pi / (axis.motor.encoder_counts * abs(axis.motor.gear_ratio)) for axis in spec.axes])


def current_limit(spec: RobotSpec) -> Array:
    """Return the current limit of every axis (n,), A: the drive's, or the one that gives the joint torque limit."""
    return np.array(
        [min(axis.motor.max_current, axis.limits.torque / axis.motor.joint_torque_constant) for axis in spec.axes]
    )


def torque_limit(spec: RobotSpec) -> Array:
    """Return the largest joint torque of every axis (n,), N m, after both limits."""
    return np.asarray(current_limit(spec) * np.array([axis.motor.joint_torque_constant for axis in spec.axes]))
