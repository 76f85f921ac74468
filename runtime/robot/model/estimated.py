"""What of a robot is estimated, in words: the values of ``RobotSpec.estimated`` by what they belong to."""

from collections.abc import Iterable, Mapping

_GROUPS = {
    "mass_kg": "bodies",
    "cog_m": "bodies",
    "inertia_kg_m2": "bodies",
    "range_deg": "ranges",
    "max_speed_deg_s": "speeds",
    "max_acceleration_deg_s2": "accelerations",
    "max_torque_nm": "torques",
    "motor": "drives",
    "servo": "loops",
    "rated_payload_kg": "payload",
    "path": "path limits",
    "link_radius_mm": "link radii",
}


def groups(names: Iterable[str]) -> list[str]:
    """Return the kinds of values that some dotted names belong to, each once, in the order of the table above."""
    found = {_GROUPS.get(part) for name in names for part in name.split(".")}
    return [group for group in dict.fromkeys(_GROUPS.values()) if group in found]


_DECISIVE = frozenset(
    (
        "mass_kg",
        "cog_m",
        "inertia_kg_m2",
        "max_torque_nm",
        "gear_ratio",
        "rotor_inertia_kg_m2",
        "viscous_friction_nm_s",
        "coulomb_friction_nm",
    )
)
"""Values from which motion and torque follow; others only limit what is planned, or scale what is reported."""


def decisive(names: Iterable[str]) -> bool:
    """Return whether torques and tracking errors of a run follow from estimates."""
    return any(name.rpartition(".")[2] in _DECISIVE for name in names)


def mark(estimated: Mapping[str, str], name: str) -> str:
    """Return ``~`` for a value that is an estimate, nothing for another."""
    return "~" if name in estimated else ""


def axis_key(axis: int, key: str) -> str:
    """Return the dotted name of a value of an axis (0-based): ``axes.1.max_torque_nm``."""
    return f"axes.{axis + 1}.{key}"
