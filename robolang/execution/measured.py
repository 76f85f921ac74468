"""What the prompt can read of the axes besides the language: functions of an axis number, for values and watches.

They are no functions of programs: what an axis measures depends on the servo, and a program that branched on it could
not be checked. An array of the program that has such a name is meant before them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisFunction:
    """A function of an axis, counted from 1: ``read`` gives the values (n,) of all axes in ``unit``."""

    name: str
    unit: str
    help: str
    read: Callable[[Controller], Array]


def _torque(controller: Controller) -> Array:
    return _last(controller, 1)


def _angle(controller: Controller) -> Array:
    return np.asarray(controller.servo.alpha / controller.spec.units)


def _error(controller: Controller) -> Array:
    servo = controller.servo
    return np.asarray((servo.q_ref - servo.alpha) / controller.spec.units)


def _rate(controller: Controller) -> Array:
    return np.asarray(_last(controller, 3) / controller.spec.units)


def _last(controller: Controller, group: int) -> Array:
    """Return a group of n columns of the last tick that was recorded; zeros before the first."""
    n = controller.spec.n
    rows = controller.recorder.recent(1)
    # the recorder has (tau_cmd, tau_sat, q_fb, dq_fb) in a row
    return np.array(rows[-1, group * n : (group + 1) * n]) if len(rows) else np.zeros(n)


_TABLE = (
    AxisFunction(name="TORQUE", unit="Nm", help="torque that the motor of an axis gives, at the joint", read=_torque),
    AxisFunction(name="ANGLE", unit="deg", help="detected angle of an axis", read=_angle),
    AxisFunction(name="RATE", unit="deg/s", help="detected speed of an axis", read=_rate),
    AxisFunction(
        name="LAG", unit="deg", help="distance of the detected angle of an axis from its command", read=_error
    ),
)

AXIS_FUNCTIONS = MappingProxyType({function.name: function for function in _TABLE})
"""Every function of an axis by its name."""


def measured(controller: Controller, key: str, index: int) -> float | None:
    """Return what an axis, from 1, measures; None: no function of axes has this name. ``Fault`` RBL507."""
    function, axes = AXIS_FUNCTIONS.get(key), controller.spec.n
    if function is None:
        return None
    if not 1 <= index <= axes:
        raise Fault("RBL507", f"{key} has the axes 1 to {axes}, no {index}")
    return float(function.read(controller)[index - 1])
