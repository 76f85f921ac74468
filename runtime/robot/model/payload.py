"""The payload that a program declares with LOAD: everything beyond the flange.

LOAD gives a centre of gravity in the flange frame and a mass (SDA, docs/dynamics.md). The body is then a
point mass there, ``I(origin) = m (|r|^2 E - r r')``, unless an own inertia is given. By default it is added to the
structure of the last link; ``replace`` is the literal reading of the document, where it takes the link's place.
Made once a LOAD, by lowering and by the controller; the limits are those of ``load_rules``.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.robot.model.load_rules import load_fault


@dataclass(frozen=True, slots=True, kw_only=True)
class Payload:
    """Mass kg, centre of gravity (3,) m in the flange frame, own inertia (3, 3) about it, kg m2."""

    mass: float
    cog: Array
    inertia: Array = field(default_factory=lambda: frozen(np.zeros((3, 3))))


NO_PAYLOAD = Payload(mass=0.0, cog=frozen(np.zeros(3)))


def declared(mass: float, cog: Sequence[float] | Array, rated: float, inertia: Array | None = None) -> Payload:
    """Return the payload of a LOAD; ``Fault`` RBL401, RBL402 or RBL403 when no such body can be carried.

    mass kg, cog (3,) m in the flange frame, rated kg of the robot, inertia (3, 3) about the cog in kg m2.
    """
    r = np.asarray(cog, dtype=np.float64)
    # the rule takes plain numbers, so that checking a program needs no arrays: xx, yy, zz, xy, xz, yz of the matrix
    own = np.zeros((3, 3)) if inertia is None else np.asarray(inertia, dtype=np.float64)
    fault = load_fault(mass, r.tolist(), own[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)].tolist(), rated)
    if fault is not None:
        raise fault
    return Payload(mass=float(mass), cog=frozen(r), inertia=frozen(own))
