"""Limits of supervision; docs/supervision.md has the reasons.

``runtime.settings.profile`` reads them from ``[controller.supervision]``: degrees and milliseconds there, rad and s
here. Shares are of the robot file's own limits, so one set of numbers serves every robot.
"""

from dataclasses import dataclass
from typing import Literal

from runtime.core.units import DEG

Reaction = Literal["stop", "warn", "off"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SupervisionLimits:
    """When an arm no longer does what it was told.

    ``enabled``: off, nothing but a state that is not finite stops the arm; for experiments that are wrong on purpose.
    Following error: ``following_error`` rad plus ``following_lag`` s times the commanded speed. ``saturation_s``:
    longest time that a drive may be asked for more than it can give. ``speed_margin`` (share of the joint's speed
    limit) and ``position_margin`` rad: how far beyond a limit the detected motion may be. ``collision``: unexpected
    torque, as a share of the joint's torque limit; infinite switches it off. ``stale_s``: oldest inertia and gravity
    torque in use while the arm moves. ``overruns``: late cycles in a row that stop the arm. ``payload_mismatch``:
    what a payload other than the declared one does; ``payload_tolerance``: the difference that counts, as a share of
    the rated payload. ``friction``: share of the robot file's friction that the arm really has (None: as much as the
    servo compensates); ``friction_uncertainty``: how well it is known in motion, ``torque_uncertainty``: how well the
    rest of the model is, as a share of the joint's torque limit.
    """

    enabled: bool = True
    following_error: float = 1.0 * DEG
    following_lag: float = 0.02
    saturation_s: float = 0.1
    speed_margin: float = 0.2
    position_margin: float = 1.0 * DEG
    collision: float = 0.2
    stale_s: float = 0.4
    overruns: int = 5
    payload_mismatch: Reaction = "stop"
    payload_tolerance: float = 0.175
    friction: float | None = None
    friction_uncertainty: float = 0.03
    torque_uncertainty: float = 0.002
