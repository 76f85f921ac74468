"""Inertia of every axis at a posture and over a plane of two joints, at the link and at the motor.

The total at the motor, which the velocity gain of a drive follows, is D / N^2 + J (docs/motor-inertia.md): D what hangs
on the axis, J the rotor, N the ratio of the gear. ``compensation`` is Jc, what an identification at the motor found
beyond D / N^2, and takes the place of J, which it holds (document 003, 3.5). It is 0 where none is given.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from runtime.core.frames import Array
from runtime.dynamics.compensation import Compensation
from runtime.dynamics.motor_inertia import link_chain, link_inertia, motor_side
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.axis_kind import AxisKind
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec

POINTS = 121
"""Points of a map along each of its joints."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisInertia:
    """An axis (from 1): D and N^2 J at the joint, their sum over N^2 at the motor, kg m2; gravity torque N m.

    Of an axis that slides D and N^2 J are masses, kg, and gravity is a force, N; at the motor it is an inertia again.
    """

    axis: int
    link_inertia: float
    rotor_inertia: float
    motor_inertia: float
    compensation: float
    gravity: float


@dataclass(frozen=True, slots=True, kw_only=True)
class InertiaMap:
    """The inertia of ``axis`` over the ranges of two ``joints`` (all 0-based), the others as they are in ``q``.

    ``x`` and ``y`` (N,) rad are angles of the first and of the second joint, of the ``kinds`` that they have (m of one
    that slides); ``link`` and ``motor`` (N, N) kg m2 the inertia D at the joint and the total at the motor, one row per
    angle of the second joint.
    """

    axis: int
    joints: tuple[int, int]
    kinds: tuple[AxisKind, AxisKind]
    q: Array
    x: Array
    y: Array
    link: Array
    motor: Array


def at_posture(
    spec: RobotSpec, q: Array, payload: Payload, compensation: Compensation | None = None
) -> list[AxisInertia]:
    """Return the inertia of every axis at q (n,) rad with ``payload`` at the flange, added to the last link.

    With a compensation the total at the motor is D / N^2 + Jc, without one D / N^2 + J; its first
    moments are in the gravity torque.
    """
    moments = None if compensation is None or not compensation.first_moments else np.array(compensation.first_moments)
    chain, model = link_chain(spec, payload), ArmModel(spec, first_moments=moments)
    model.set_payload(payload)
    D, rotors, T = link_inertia(chain, q), spec_rotors(spec), model.gravity(q)
    found = np.zeros(spec.n) if compensation is None else motor_side(chain, compensation.at(spec, q))
    total = motor_side(chain, D + rotors) if compensation is None else motor_side(chain, D) + found
    rows = zip(D.tolist(), rotors.tolist(), total.tolist(), found.tolist(), T.tolist(), strict=True)
    return [
        AxisInertia(axis=axis, link_inertia=d, rotor_inertia=rotor, motor_inertia=motor, compensation=extra, gravity=t)
        for axis, (d, rotor, motor, extra, t) in enumerate(rows, start=1)
    ]


def over_plane(spec: RobotSpec, axis: int, joints: tuple[int, int], q: Array, payload: Payload) -> InertiaMap:
    """Return the inertia of ``axis`` on a grid over the ranges of two joints (0-based), in one call."""
    x, y = (np.linspace(spec.lower[joint], spec.upper[joint], POINTS) for joint in joints)
    # a copy, since what broadcast_to returns can only be read
    grid = np.broadcast_to(q, (POINTS, POINTS, spec.n)).copy()
    grid[..., joints[0]], grid[..., joints[1]] = x, y[:, None]
    chain = link_chain(spec, payload)
    D = link_inertia(chain, grid)
    motor = motor_side(chain, D + spec_rotors(spec))
    kinds = spec.axes[joints[0]].kind, spec.axes[joints[1]].kind
    return InertiaMap(axis=axis, joints=joints, kinds=kinds, q=q, x=x, y=y, link=D[..., axis], motor=motor[..., axis])


def extremes(found: InertiaMap) -> dict[str, dict[str, Any]]:
    """Return the smallest and the largest inertia of a map with the two angles of each, plain types, SI and deg.

    Of a joint that slides mm; then no key has deg in its name.
    Where many points have it, the first one stands for them.
    """
    units = np.array([kind.size for kind in found.kinds])
    key = "joints" if any(kind.slides for kind in found.kinds) else "joints_deg"
    places = {"smallest": int(np.argmin(found.motor)), "largest": int(np.argmax(found.motor))}
    out = {}
    for name, index in places.items():
        row, column = divmod(index, len(found.x))
        angles = np.array([found.x[column], found.y[row]]) / units + 0.0
        out[name] = {
            "link_inertia": float(found.link[row, column]),
            "motor_inertia": float(found.motor[row, column]),
            # converted back from radians, an angle of the grid is -157.33333333333334
            key: [float(f"{angle:.10g}") for angle in angles],
        }
    return out


def plain(rows: list[AxisInertia]) -> list[dict[str, Any]]:
    """Return plain types without negative zeros, SI."""
    return [
        {key: value + 0.0 if isinstance(value, float) else value for key, value in asdict(row).items()} for row in rows
    ]
