"""A robot as plain JSON types, in the units and by the keys of robot files, for ``robot list`` and ``robot show``."""

import math
from typing import Any

from runtime.core.units import DEG, MM
from runtime.robot.files.estimate_bodies import reach_of
from runtime.robot.kinematics.chain import Chain
from runtime.robot.model.estimated import groups
from runtime.robot.model.spec import AxisSpec, Body, RobotSpec


def reach_mm(spec: RobotSpec) -> float:
    """Return the largest distance of the flange from axis 1, mm, rounded to 10 mm, within which it is found."""
    return round(reach_of(Chain.of(spec.axes, spec.X_last_flange), spec.lower, spec.upper) / MM, -1)


def summary(spec: RobotSpec) -> dict[str, Any]:
    """Return the row of a robot in the list."""
    return {
        "name": spec.name,
        "title": spec.title,
        "axes": spec.n,
        "reach_mm": reach_mm(spec),
        "rated_payload_kg": spec.rated_payload,
        "estimated": groups(spec.estimated),
    }


def whole(spec: RobotSpec) -> dict[str, Any]:
    """Return all that is known of a robot; ``estimated`` has the rules of estimates by the names of their values."""
    path = spec.path
    return {
        **summary(spec),
        "axes": [_axis(axis) for axis in spec.axes],
        "path": {
            "default_speed_mm_s": path.default_speed / MM,
            "max_speed_mm_s": path.max_speed / MM,
            "acceleration_mm_s2": path.acceleration / MM,
            "jerk_mm_s3": path.jerk / MM,
            "rotation_speed_deg_s": path.rotation_speed / DEG,
            "rotation_acceleration_deg_s2": path.rotation_acceleration / DEG,
            "rotation_jerk_deg_s3": path.rotation_jerk / DEG,
        },
        "link_radius_mm": [radius / MM for radius in spec.link_radii],
        "X_last_flange": spec.X_last_flange.tolist(),
        "sources": list(spec.sources),
        "notes": list(spec.notes),
        "estimated": dict(spec.estimated),
        "drives": spec.undriven is None,
    }


def _axis(axis: AxisSpec) -> dict[str, Any]:
    limits, motor, kind = axis.limits, axis.motor, axis.kind
    return {
        "name": axis.name,
        **({"kind": kind.name} if kind.slides else {}),
        "placement": axis.placement.tolist(),
        kind.range_key: [limits.lower / kind.size, limits.upper / kind.size],
        kind.speed_key: limits.speed / kind.size,
        kind.acceleration_key: limits.acceleration / kind.size,
        kind.jerk_key: limits.jerk / kind.size,
        kind.force_key: limits.torque,
        **_body(axis.body),
        "motor": {
            kind.transmission_key: kind.transmission(motor.gear_ratio),
            "rotor_inertia_kg_m2": motor.rotor_inertia,
            "torque_constant_nm_a": motor.torque_constant,
            "max_current_a": motor.max_current,
            "viscous_friction_nm_s": motor.viscous_friction,
            "coulomb_friction_nm": list(motor.coulomb_friction),
            "encoder_counts": motor.encoder_counts,
            "current_bandwidth_hz": motor.current_bandwidth / (2.0 * math.pi),
            # JSON has no infinity: a rigid gear has no spring
            kind.stiffness_key: motor.stiffness if motor.elastic else None,
            kind.damping_key: motor.damping if motor.elastic else None,
        },
        "servo": {
            "position_bandwidth_rad_s": axis.bandwidths.position,
            "velocity_bandwidth_rad_s": axis.bandwidths.velocity,
        },
    }


def _body(body: Body) -> dict[str, Any]:
    I_body = body.inertia
    products = (I_body[0, 0], I_body[1, 1], I_body[2, 2], I_body[0, 1], I_body[0, 2], I_body[1, 2])
    return {
        "mass_kg": body.mass,
        "cog_m": [float(value) for value in body.cog],
        "inertia_kg_m2": [float(value) for value in products],
    }
