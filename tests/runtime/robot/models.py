"""URDF texts for the tests, and sidecars with the gaps of a template filled in."""

import math
import re
from pathlib import Path

DATA = Path(__file__).parent / "data"
SEVEN = DATA / "seven.urdf"
ANGLES = DATA / "angles.xml"

FILLED = {
    "rated_payload_kg": "3",
    "default_speed_mm_s": "300",
    "max_speed_mm_s": "1000",
    "acceleration_mm_s2": "2000",
    "jerk_mm_s3": "20000",
    "rotation_speed_deg_s": "120",
    "rotation_acceleration_deg_s2": "600",
    "rotation_jerk_deg_s3": "6000",
    "range_deg": "[-90, 90]",
    "max_speed_deg_s": "180",
    "max_acceleration_deg_s2": "900",
    "max_torque_nm": "200",
    "gear_ratio": "100",
    "rotor_inertia_kg_m2": "5e-5",
    "torque_constant_nm_a": "0.2",
    "max_current_a": "12",
    "viscous_friction_nm_s": "1e-4",
    "coulomb_friction_nm": "[0.02, 0.02]",
    "encoder_counts": "131072",
    "current_bandwidth_hz": "300",
    "position_bandwidth_rad_s": "30",
    "velocity_bandwidth_rad_s": "120",
}


def fill(template: str, **other: str) -> str:
    """Return a template with a value for every line marked MISSING."""
    values = FILLED | other
    return re.sub(r"^# (\w+) =   # MISSING: .*$", lambda line: f"{line[1]} = {values[line[1]]}", template, flags=re.M)


def inertial(mass=2.0, cog=(0.01, 0.02, 0.1), inertia=(0.03, 0.04, 0.02, 0.001, -0.002, 0.003), rpy=(0, 0, 0)) -> str:
    names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    entries = " ".join(f'{name}="{value!r}"' for name, value in zip(names, inertia, strict=True))
    origin = f'<origin xyz="{words(cog)}" rpy="{words(rpy)}"/>'
    return f'<inertial>{origin}<mass value="{mass!r}"/><inertia {entries}/></inertial>'


def words(values) -> str:
    return " ".join(repr(float(value)) for value in values)


def joint(
    name,
    parent,
    child,
    xyz=(0, 0, 0.3),
    rpy=(0, 0, 0),
    axis=(0, 0, 1),
    kind="revolute",
    limit='lower="-2" upper="2" velocity="3" effort="50"',
    more="",
) -> str:
    limit = f"<limit {limit}/>" if limit else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{words(xyz)}" rpy="{words(rpy)}"/><axis xyz="{words(axis)}"/>{limit}{more}</joint>'
    )


def urdf(*parts: str, name="made_up") -> str:
    return f'<robot name="{name}">\n' + "\n".join(parts) + "\n</robot>\n"


def chain(frames, last=None, bodies=None, limit='lower="-3" upper="3" velocity="3" effort="50"') -> str:
    """Return the URDF of axes ``(xyz, rpy, axis)``, with a fixed flange ``(xyz, rpy)``."""
    bodies = bodies or [inertial()] * len(frames)
    parts = ['<link name="l0"/>']
    for i, (xyz, rpy, axis) in enumerate(frames, start=1):
        parts.append(joint(f"j{i}", f"l{i - 1}", f"l{i}", xyz, rpy, axis, limit=limit))
        parts.append(f'<link name="l{i}">{bodies[i - 1]}</link>')
    if last is not None:
        xyz, rpy = last
        parts += [
            joint("mount", f"l{len(frames)}", "flange", xyz, rpy, kind="fixed", limit=""),
            '<link name="flange"/>',
        ]
    return urdf(*parts)


SIX = chain(
    [
        ((0, 0, 0.4), (0, 0, 0), (0, 0, 1)),
        ((0, 0, 0), (0, 0, 0), (0, 1, 0)),
        ((0, 0, 0.4), (0, 0, 0), (0, 1, 0)),
        ((0.35, 0, 0), (0, 0, 0), (1, 0, 0)),
        ((0, 0, 0), (0, 0, 0), (0, 1, 0)),
        ((0.08, 0, 0), (0, 0, 0), (1, 0, 0)),
    ],
    ((0.02, 0, 0), (0, math.pi / 2, 0)),
    [inertial(mass, (0.0, 0.0, 0.05), (0.02, 0.02, 0.015, 0, 0, 0)) for mass in (9.0, 7.0, 4.0, 2.5, 1.5, 0.4)],
    limit='lower="-3.5" upper="3.5" velocity="3"',
)
"""A six-axis arm made up for the tests: bodies, ranges and speeds, no torques."""
