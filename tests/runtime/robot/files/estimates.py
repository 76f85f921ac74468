"""Estimates over the values of the built-in robots, whose drives were left out: the table of docs/robots-estimates.md.

``python -m tests.runtime.robot.files.estimates`` prints it.
"""

import math

import numpy as np

from runtime.robot.files.estimate import Known, estimate
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.chain import Chain

ARMS = ("puma560", "manutec_r3", "irb2400")
OWN = {
    ("puma560", "max_acceleration_deg_s2"),
    ("puma560", "N Kt"),
    ("puma560", "motor.max_current_a"),
    ("puma560", "motor.current_bandwidth_hz"),
}
"""What the library itself calls an estimate, beside all drives of the IRB 2400, loops and path limits."""
GUESSED = ("servo.position_bandwidth_rad_s", "path.max_speed_mm_s", "path.acceleration_mm_s2")


def known(spec, *, bodies=True, turning=True, torque=True, payload=True):
    """What is known of a robot of the library without its drives; a part that is False is left out too."""
    nothing = np.full(spec.n, math.nan)
    return Known(
        chain=Chain.of(spec.axes, spec.X_last_flange),
        bodies=tuple(axis.body if bodies else None for axis in spec.axes),
        mended=(False,) * spec.n,
        lower=spec.lower,
        upper=spec.upper,
        endless=(False,) * spec.n,
        speed=spec.per_axis("limits", "speed") if turning else nothing,
        torque=spec.per_axis("limits", "torque") if torque else nothing,
        armature=np.zeros(spec.n),
        damping=np.zeros(spec.n),
        friction=np.zeros(spec.n),
        payload=spec.rated_payload if payload else math.nan,
    )


def per_axis(found, key, n):
    return np.array([np.mean(found[f"axes.{k}.{key}"].value) for k in range(1, n + 1)])


def whole(found, key):
    return np.array([found[key].value])


def ratios(name):
    """Estimate over the value of the library (n,) or (1,), by key; friction, rotor and torque constant at the joint."""
    spec = load_builtin(name)
    motors = [axis.motor for axis in spec.axes]
    bare = estimate(known(spec, bodies=False, turning=False, torque=False, payload=False))
    limits = estimate(known(spec, turning=False, torque=False, payload=False))
    torques = estimate(known(spec, torque=False))
    drives = estimate(known(spec))

    def motor(key):
        return per_axis(drives, f"motor.{key}", spec.n)

    N = motor("gear_ratio")
    path = spec.path
    return {
        "mass that moves": np.array([per_axis(bare, "mass_kg", spec.n).sum() / sum(a.body.mass for a in spec.axes)]),
        "rated_payload_kg": whole(limits, "rated_payload_kg") / spec.rated_payload,
        "max_speed_deg_s": np.deg2rad(per_axis(limits, "max_speed_deg_s", spec.n)) / spec.per_axis("limits", "speed"),
        "max_torque_nm": per_axis(torques, "max_torque_nm", spec.n) / spec.per_axis("limits", "torque"),
        "max_acceleration_deg_s2": np.deg2rad(per_axis(drives, "max_acceleration_deg_s2", spec.n))
        / spec.per_axis("limits", "acceleration"),
        "motor.gear_ratio": N / np.abs([m.gear_ratio for m in motors]),
        "N^2 J": N**2 * motor("rotor_inertia_kg_m2") / [m.reflected_inertia for m in motors],
        "N Kt": N * motor("torque_constant_nm_a") / [m.joint_torque_constant for m in motors],
        "motor.max_current_a": motor("max_current_a") / [m.max_current for m in motors],
        "N Tc": N * motor("coulomb_friction_nm") / [np.mean(m.joint_coulomb_friction) for m in motors],
        "N^2 B": N**2 * motor("viscous_friction_nm_s") / [m.joint_viscous_friction for m in motors],
        "motor.current_bandwidth_hz": 2
        * math.pi
        * motor("current_bandwidth_hz")
        / [m.current_bandwidth for m in motors],
        "servo.position_bandwidth_rad_s": per_axis(drives, "servo.position_bandwidth_rad_s", spec.n)[:1]
        / spec.axes[0].bandwidths.position,
        "path.max_speed_mm_s": whole(drives, "path.max_speed_mm_s") / 1e3 / path.max_speed,
        "path.acceleration_mm_s2": whole(drives, "path.acceleration_mm_s2") / 1e3 / path.acceleration,
    }


def guessed(name, key):
    """Whether the library itself has an estimate there."""
    return (
        (name, key) in OWN
        or key in GUESSED
        or (name == "irb2400" and key not in ("max_speed_deg_s", "rated_payload_kg"))
    )


def table():
    """The table in Markdown; a value of the library that is itself an estimate is marked with ~."""
    found = {name: ratios(name) for name in ARMS}
    lines = [f"| estimate over value | {' | '.join(f'`{name}`' for name in ARMS)} |", "|---|" + "---|" * len(ARMS)]
    for key in found[ARMS[0]]:
        cells = []
        for name in ARMS:
            text = " ".join(f"{ratio:.2f}" if ratio < 10.0 else f"{ratio:.0f}" for ratio in found[name][key])
            cells.append(f"~ {text}" if guessed(name, key) else text)
        lines.append(f"| {key} | {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
