"""Limits of supervision; docs/supervision.md has the reasons.

``runtime.settings.layers`` reads them from ``[controller.supervision]``: degrees and milliseconds there, rad and s
here. Shares are of the robot file's own limits, so one set of numbers serves every robot.
"""

import math
from typing import Literal

from runtime.core.record import Record
from runtime.core.tomlfile import Table
from runtime.settings.setting import choice, custom, flag, number, whole

Reaction = Literal["stop", "warn", "off"]


def _share(table: Table, name: str) -> float:
    return table.number(name, low=0.0, high=2.0)


class SupervisionLimits(Record):
    """When an arm no longer follows its commands.

    ``enabled``: off, nothing but a state that is not finite stops the arm; for experiments that are wrong on purpose.
    Following error: ``following_error`` rad plus ``following_lag`` s times the commanded speed. ``saturation_s``:
    longest time that a drive may be commanded more than it can give. ``speed_margin`` (share of the joint's speed
    limit) and ``position_margin`` rad: how far beyond a limit the detected motion may be. ``collision``: unexpected
    torque, as a share of the joint's torque limit; infinite switches it off. ``stale_s``: oldest inertia and gravity
    torque in use while the arm moves. ``overruns``: late cycles in a row that stop the arm. ``payload_mismatch``:
    what a payload other than the declared one does; ``payload_tolerance``: the difference that counts, as a share of
    the rated payload. ``friction``: share of the robot file's friction that the arm really has (None: as much as the
    servo compensates); ``friction_uncertainty``: how well it is known in motion, ``torque_uncertainty``: how well the
    rest of the model is, as a share of the joint's torque limit.
    """

    enabled: bool = flag("enabled", True)
    following_error: float = number("following_error_deg", 1.0, "deg", positive=True, high=180.0)
    following_lag: float = number("following_lag_ms", 20.0, "ms", low=0.0, high=1000.0)
    saturation_s: float = number("saturation_ms", 100.0, "ms", low=0.0, high=60_000.0)
    speed_margin: float = number("speed_margin", 0.2, low=0.0, high=10.0)
    position_margin: float = number("position_margin_deg", 1.0, "deg", low=0.0, high=90.0)
    # 0 becomes infinite, which no residual exceeds: the checks need no case for it
    collision: float = number("collision", 0.2, si=lambda share: share or math.inf, low=0.0, high=10.0)
    stale_s: float = number("stale_dynamics_ms", 400.0, "ms", positive=True, high=60_000.0)
    overruns: int = whole("overruns", 5, low=1, high=1_000_000)
    payload_mismatch: Reaction = choice("payload_mismatch", "stop", "warn", "off")
    # between 5 % of the rated payload, which is never to be reported, and 30 %, which always is (docs/supervision.md)
    payload_tolerance: float = number("payload_tolerance", 0.175, low=0.01, high=10.0)
    friction: float | None = custom("friction", None, "", _share, lambda share: share)
    friction_uncertainty: float = number("friction_uncertainty", 0.03, low=0.0, high=1.0)
    torque_uncertainty: float = number("torque_uncertainty", 0.002, low=1e-4, high=1.0)
