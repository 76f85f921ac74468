"""Inertia about an axis and gravity torque on it (JPH06190750A eqs 1-5; docs/dynamics.md).

``D_i``, the inertia that the drive of axis i feels, is element (i, i) of the mass matrix; it is taken from one
unit-acceleration pass (axis i accelerated by 1 rad/s2 at rest, without gravity), which the document's Lagrangian
eq (4) equals to rounding. ``T_i`` is the torque that holds axis i against gravity. Velocity terms are left out, as
in the document. Called by the dynamics task, one axis at a time.
"""

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import RobotSpec


def axis_inertia(model: ArmModel, q: Array, axis: int) -> float:
    """Return D_i, kg m2, of axis ``axis`` (0-based) at posture q (n,) rad, without the rotor."""
    return float(model.inertia_column(q, axis)[axis])


def axis_row(model: ArmModel, q: Array, axis: int) -> Array:
    """Return row ``axis`` of the mass matrix (n,), kg m2, without the rotor; D_i is its element ``axis``."""
    return frozen(model.inertia_column(q, axis))  # a copy: handed over through ITA


def axis_gravity(model: ArmModel, q: Array, axis: int) -> float:
    """Return T_i, N m, of axis ``axis`` (0-based) at posture q (n,) rad."""
    return float(model.gravity(q)[axis])


def inertia_range(spec: RobotSpec, payload: Payload = NO_PAYLOAD, postures: int = 2000) -> tuple[Array, Array]:
    """Return the smallest and largest D_i (n,) over the joint ranges, bare and with ``payload``, kg m2.

    Sampled at ``postures`` fixed pseudo-random postures, so the same robot always gives the same numbers.
    """
    # sampled: the extremes over all postures have no closed form, and bounds for checks need no last digit
    model = ArmModel(spec)
    samples = np.random.default_rng(560).uniform(spec.lower, spec.upper, (postures, spec.n))
    found = []
    for carried in (NO_PAYLOAD, payload):
        model.set_payload(carried)
        found.append([np.diag(model.mass_matrix(q)) for q in samples])
    D = np.array(found)
    return D.min(axis=(0, 1)), D.max(axis=(0, 1))
