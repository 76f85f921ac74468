"""What supervision knows of the drives of an arm, beside the robot file: a value."""

from dataclasses import dataclass

from runtime.core.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveData:
    """Drives of n axes that a servo works in ``ticks`` ticks of ``tick_s`` s a cycle.

    ``torque`` (n,) N m are the torque limits, ``resolution`` (n,) rad the encoder steps, ``lag`` (n,) s how late a
    servo without full velocity feed-forward follows, ``friction`` the share of the friction that the servo compensates.
    """

    torque: Array
    resolution: Array
    lag: Array
    ticks: int
    tick_s: float
    friction: float
