"""The mass that the motors feel, for a status line: from a motion where there has been one, else from the rest.

In motion the supervision of the controller weighs what is carried (``runtime.supervision.torque_observer``), and its
estimate holds until the next LOAD or HAND. Without one the arm is weighed as it stands, by the same least squares over
the axes, over ``WINDOW_S``: the torque beyond that of the model with the declared payload. At rest dry friction may
carry any weight within its band, so an axis that stands weighs by its Coulomb friction. For the built-in robots that is
more than any payload, and they feel nothing before they have moved; the ideal arm and one with light gears do. An axis
that gravity does not load, such as an upright waist, has no part in it.
"""

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from runtime.control.controller import Controller
from runtime.control.drive_train import drive_data, load_model
from runtime.core.frames import Array
from runtime.supervision.torque_observer import FEWEST, Observer

WINDOW_S = 0.2
"""Time over which the torques of an arm that stands are averaged, s."""
STEADY = 0.3
"""Acceleration of an axis, rad/s2, above which the arm does not stand: its inertia would be taken for weight."""
MOST = 0.25
"""Standard deviation, as a share of the rated payload, from which on a posture tells nothing."""

Source: TypeAlias = Literal["motion", "rest"]


@dataclass(frozen=True, slots=True, kw_only=True)
class FeltPayload:
    """Mass beyond the flange with its standard deviation, kg, felt in a motion or at rest."""

    mass: float
    deviation: float
    source: Source


class PayloadSense:
    """Feels what the arm of a controller carries. It reads the controller and changes nothing of it."""

    def __init__(self, controller: Controller) -> None:
        spec, profile = controller.spec, controller.profile
        self._controller = controller
        self._most = MOST * spec.rated_payload
        ticks = round(0.5 * WINDOW_S / profile.tick_s)
        self._half_s = ticks * profile.tick_s
        # an observer of its own: over the two cycles of the supervision an encoder step looks like an acceleration
        drives = replace(drive_data(spec, profile), ticks=ticks)
        self._observer = Observer(spec, profile.supervision, drives, load_model(spec, profile))

    def felt(self) -> FeltPayload | None:
        """Return the mass that is felt now.

        None where the arm accelerates and has not been weighed, with the brakes on, in the first ``WINDOW_S`` of a run,
        and where friction hides a mass in this posture.
        """
        weighed = self._controller.drives.supervisor.observer
        if weighed.steps >= FEWEST:
            return self._believed(weighed, "motion")
        return self._at_rest()

    def _at_rest(self) -> FeltPayload | None:
        controller, observer = self._controller, self._observer
        rows, n = controller.recorder.recent(observer.rows), controller.spec.n
        # brakes carry the arm, and the motors feel nothing
        if controller.halted or len(rows) < observer.rows:
            return None
        tau, q = rows[:, n : 2 * n], rows[:, 2 * n : 3 * n]
        if not _acceleration(q, self._half_s) <= STEADY:
            return None
        observer.declare(controller.areas.sda, controller.profile.load_mode)
        observer.update(tau, q)
        observer.learn()
        return self._believed(observer, "rest")

    def _believed(self, observer: Observer, source: Source) -> FeltPayload | None:
        mass, deviation = observer.estimate()
        if not deviation <= self._most:
            return None
        return FeltPayload(mass=mass, deviation=deviation, source=source)


def _acceleration(q: Array, half_s: float) -> float:
    """Return the largest mean acceleration of a joint over rows (N, n) rad, first to middle to last."""
    return float(np.abs(q[-1] - 2.0 * q[len(q) // 2] + q[0]).max()) / half_s**2
