"""The sidecar ``arm.robot.toml`` of an ``arm.urdf`` or ``arm.xml``: drives and limits, which such files do not hold.

Its keys are those of a robot file in TOML (docs/robots-import.md), without geometry and bodies, with one ``[[axes]]``
for each joint in the order of the chain. What it says of ranges, speeds and torques rules over the model file. Imports
no numerics: ``robolang check`` reads it, and a run reads the same.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from runtime.core.tomlfile import Source, Table, load_table
from runtime.robot.files.gaps import listed, whole
from runtime.robot.files.robot_file import CorrectionRow, correction, rated_payload
from runtime.robot.model import drives
from runtime.robot.model.drives import Bandwidths, Limits, Motor, PathLimits

SCHEMA = 1
ENDING = ".robot.toml"

LIMIT_KEYS = {
    "range_deg": "[lower, upper], deg",
    "max_speed_deg_s": "deg/s",
    "max_acceleration_deg_s2": "deg/s2",
    "max_torque_nm": "N m at the joint",
}
MOTOR_KEYS = {
    "gear_ratio": "motor turns per joint turn, negative when they turn against each other",
    "rotor_inertia_kg_m2": "kg m2 at the motor, with brake and pinion",
    "torque_constant_nm_a": "N m/A at the motor",
    "max_current_a": "A",
    "viscous_friction_nm_s": "N m s/rad at the motor",
    "coulomb_friction_nm": "[forward, backward], N m at the motor, both positive",
    "encoder_counts": "counts per motor turn",
    "current_bandwidth_hz": "Hz of the closed current loop",
}
SERVO_KEYS = {
    "position_bandwidth_rad_s": "Kp, 1/s",
    "velocity_bandwidth_rad_s": "Kv, 1/s, four times Kp or more",
}
PATH_KEYS = {
    "default_speed_mm_s": "speed of a MOVE without SPEED, mm/s",
    "max_speed_mm_s": "mm/s",
    "acceleration_mm_s2": "mm/s2",
    "jerk_mm_s3": "mm/s3",
    "rotation_speed_deg_s": "deg/s",
    "rotation_acceleration_deg_s2": "deg/s2",
    "rotation_jerk_deg_s3": "deg/s3",
}
PAYLOAD_KEY = "rated_payload_kg"
GROUPS = {"motor": MOTOR_KEYS, "servo": SERVO_KEYS}


def sidecar_path(model: Path) -> Path:
    """Return where the sidecar of a model file stands: ``arm.urdf`` has ``arm.robot.toml``."""
    return model.with_name(f"{model.stem}{ENDING}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlay:
    """What the geometry of an arm takes from its sidecar: flange, ranges (rad) by joint, joints with a correction.

    ``tables`` are where the ranges stand, by joint.
    """

    flange: str | None
    ranges: dict[str, tuple[float, float]]
    tables: dict[str, Table]
    corrected: frozenset[str]


NO_OVERLAY = Overlay(flange=None, ranges={}, tables={}, corrected=frozenset())


def read_overlay(source: Source) -> Overlay:
    """Return what a sidecar, filled in or not, says of the geometry; ``FileFault`` RBL6xx."""
    table = load_table(source)
    ranges: dict[str, tuple[float, float]] = {}
    tables: dict[str, Table] = {}
    corrected: set[str] = set()
    for axis in table.tables("axes", required=False):
        name = axis.text("name")
        if "range_deg" in axis:
            ranges[name], tables[name] = drives.joint_range(axis), axis
        if "correction" in axis:
            corrected.add(name)
    flange = table.text("flange") if "flange" in table else None
    return Overlay(flange=flange, ranges=ranges, tables=tables, corrected=frozenset(corrected))


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisDrive:
    """One ``[[axes]]`` of a sidecar; ``table`` for places."""

    name: str
    motor: Motor
    limits: Limits
    bandwidths: Bandwidths
    correction: CorrectionRow | None
    table: Table


@dataclass(frozen=True, slots=True, kw_only=True)
class SidecarFile:
    """A sidecar that is filled in; empty texts and None where it says nothing. ``table`` is the whole file."""

    title: str
    sources: tuple[str, ...]
    notes: tuple[str, ...]
    rated_payload: float
    axes: tuple[AxisDrive, ...]
    path: PathLimits
    link_radii: tuple[float, ...]
    table: Table


def read_sidecar(source: Source, model: str) -> SidecarFile:
    """Return the sidecar of the file named ``model``; ``FileFault`` RBL6xx, RBL608 lists all that is missing."""
    table = load_table(source)
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    if (named := table.text("robot")) != model:
        table.fail("RBL610", f"this sidecar is for '{named}', not for '{model}'", key="robot")
    axes = table.tables("axes")
    _check_complete(table, axes)
    found = SidecarFile(
        title=table.text("title", ""),
        sources=drives.texts(table, "sources"),
        notes=drives.texts(table, "notes"),
        rated_payload=rated_payload(table),
        link_radii=drives.link_radii(axes),
        axes=tuple(_axis(axis) for axis in axes),
        path=drives.path_limits(table.table("path")),
        table=table,
    )
    table.text("flange", "")
    table.done()
    return found


def _axis(table: Table) -> AxisDrive:
    found = AxisDrive(
        name=table.text("name"),
        motor=drives.motor(table.table("motor")),
        limits=drives.limits(table),
        bandwidths=drives.bandwidths(table.table("servo")),
        correction=correction(table),
        table=table,
    )
    table.done()
    return found


def _check_complete(table: Table, axes: list[Table]) -> None:
    """Name every key that a person has still to fill in, in one message."""
    path = table.table("path") if "path" in table else None
    own = [PAYLOAD_KEY] if PAYLOAD_KEY not in table else []
    own += [f"path.{key}" for key in PATH_KEYS if path is None or key not in path]
    missing: list[set[str]] = []
    for axis in axes:
        here = {key for key in LIMIT_KEYS if key not in axis}
        for group, keys in GROUPS.items():
            inner = axis.table(group) if group in axis else None
            here |= {f"{group}.{key}" for key in keys if inner is None or key not in inner}
        missing.append(here)
    if own or any(missing):
        where = table if own else next(axis for axis, here in zip(axes, missing, strict=True) if here)
        gaps = [*whole(own, {"path": [f"path.{key}" for key in PATH_KEYS]}), lacking(missing)]
        where.fail(
            "RBL608",
            f"missing in this file: {'; '.join(gap for gap in gaps if gap)}",
            "fill in the lines marked MISSING",
        )


def lacking(missing: Sequence[Collection[str]]) -> str:
    """Return in words what each axis has not of the keys of a sidecar."""
    inner = {f"axes.{group}": [f"{group}.{key}" for key in keys] for group, keys in GROUPS.items()}
    keys = [*LIMIT_KEYS, *(key for keys in inner.values() for key in keys)]
    return listed({key: [k for k, here in enumerate(missing) if key in here] for key in keys}, len(missing), inner)
