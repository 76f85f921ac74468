"""What of a robot is estimated, in words: the values of ``RobotSpec.estimated`` by what they belong to."""

from collections.abc import Iterable, Mapping

from runtime.robot.model.axis_kind import KINDS

_GROUPS = {
    "mass_kg": "bodies",
    "cog_m": "bodies",
    "inertia_kg_m2": "bodies",
    **{kind.range_key: "ranges" for kind in KINDS.values()},
    **{kind.speed_key: "speeds" for kind in KINDS.values()},
    **{kind.acceleration_key: "accelerations" for kind in KINDS.values()},
    **{kind.jerk_key: "jerks" for kind in KINDS.values()},
    **{kind.force_key: "torques" for kind in KINDS.values()},
    "motor": "drives",
    "servo": "loops",
    "rated_payload_kg": "payload",
    "path": "path limits",
    "link_radius_mm": "link radii",
}


def groups(names: Iterable[str]) -> list[str]:
    """Return the kinds of values that some dotted names belong to, each once, in the order of the table above."""
    # a limit of the tool point has the name of one of a sliding axis: what it is in decides
    parts = (part for name in names for part in (["path"] if name.startswith("path.") else name.split(".")))
    found = {_GROUPS.get(part) for part in parts}
    return [group for group in dict.fromkeys(_GROUPS.values()) if group in found]


_DECISIVE = frozenset(
    (
        "mass_kg",
        "cog_m",
        "inertia_kg_m2",
        *(kind.force_key for kind in KINDS.values()),
        *(kind.transmission_key for kind in KINDS.values()),
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
