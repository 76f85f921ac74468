"""The sidecar ``arm.robot.toml`` of an ``arm.urdf`` or ``arm.xml``: drives and limits, which such files do not hold.

Its keys are those of a robot file in TOML (docs/robots-import.md), without geometry and bodies, with one ``[[axes]]``
for each joint in the order of the chain. Its ranges, speeds and torques replace those of the model file. Imports
no numerics: ``robolang check`` reads it, and a run reads the same.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, Table
from runtime.robot.files.gaps import listed, whole
from runtime.robot.files.marks import load_marked
from runtime.robot.files.robot_file import INERTIA_FORMS, AxisDrive, axis_drive, estimated_jerks, rated_payload
from runtime.robot.model import drives
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE, AxisKind
from runtime.robot.model.drives import PathLimits

SCHEMA = 1
ENDING = ".robot.toml"

_TRANSMISSIONS = {
    REVOLUTE: "motor turns per joint turn, negative when they turn against each other",
    PRISMATIC: "mm of the axis per motor turn, negative when the axis goes back as the motor turns forward",
}
_MOTOR_KEYS = {
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
BODY_KEYS = ("mass_kg", "cog_m", "inertia_kg_m2")
"""Optional keys of an axis, all or none: a body that replaces that of the model, in the frame of the axis."""
ESTIMATED_KEYS = (PAYLOAD_KEY, "path", "axes")
"""What an ideal arm takes from estimates where its sidecar lacks values."""


def limit_keys(kind: AxisKind) -> dict[str, str]:
    """Return the keys of the limits of an axis that a sidecar must have, with their units."""
    return {
        kind.range_key: f"[lower, upper], {kind.unit}",
        kind.speed_key: f"{kind.unit}/s",
        kind.acceleration_key: f"{kind.unit}/s2",
        kind.force_key: f"{kind.force} at the joint",
    }


def groups(kind: AxisKind) -> dict[str, dict[str, str]]:
    """Return the keys of the inner tables of an axis, with their units, by the name of the table."""
    return {"motor": {kind.transmission_key: _TRANSMISSIONS[kind], **_MOTOR_KEYS}, "servo": SERVO_KEYS}


def sidecar_path(model: Path) -> Path:
    """Return the path of the sidecar of a model file: ``arm.urdf`` has ``arm.robot.toml``."""
    return model.with_name(f"{model.stem}{ENDING}")


class BodyRow(Record):
    """A body that a sidecar states: kg, (3,) m and (3 or 6,) kg m2 in the frame of its axis."""

    mass_kg: float
    cog_m: tuple[float, ...]
    inertia_kg_m2: tuple[float, ...]


class Overlay(Record):
    """What the geometry of an arm takes from its sidecar: flange, ranges by joint, joints with a correction.

    Ranges are rad or m. ``tables`` are those of the axes, by joint; ``bodies`` replace those of the model.
    """

    flange: str | None
    ranges: dict[str, tuple[float, float]]
    tables: dict[str, Table]
    corrected: frozenset[str]
    bodies: dict[str, BodyRow]


NO_OVERLAY = Overlay(flange=None, ranges={}, tables={}, corrected=frozenset(), bodies={})


def read_overlay(source: Source) -> Overlay:
    """Return the geometry that a sidecar states, filled in or not; ``FileFault`` RBL6xx.

    Kinematics needs ranges before the drives are known: 'robolang kin' works with a template that is not filled in.
    """
    table = load_marked(source).table
    bodies: dict[str, BodyRow] = {}
    ranges: dict[str, tuple[float, float]] = {}
    tables: dict[str, Table] = {}
    corrected: set[str] = set()
    for axis in table.tables("axes", required=False):
        name = axis.text("name")
        tables[name], kind = axis, drives.axis_kind(axis)
        if kind.range_key in axis:
            ranges[name] = drives.joint_range(axis, kind)
        if "correction" in axis:
            corrected.add(name)
        if (body := body_row(axis)) is not None:
            bodies[name] = body
    flange = table.text("flange") if "flange" in table else None
    return Overlay(flange=flange, ranges=ranges, tables=tables, corrected=frozenset(corrected), bodies=bodies)


def check_kinds(overlay: Overlay, kinds: Mapping[str, AxisKind]) -> None:
    """Refuse an axis that a sidecar has as one of the other kind (RBL610); ``kinds`` of the model, by joint."""
    for name, table in overlay.tables.items():
        own, kind = drives.axis_kind(table), kinds.get(name)
        if kind is not None and own is not kind:
            message = f"this axis {own.moves}, and joint '{name}' of the model {kind.moves}"
            table.fail("RBL610", message, f'write kind = "{kind.name}"', key="kind")


def body_row(axis: Table) -> BodyRow | None:
    """Return the body that an axis of a sidecar states, None without one; ``FileFault`` RBL60x, RBL613."""
    axis.ask(*BODY_KEYS)
    if not any(key in axis for key in BODY_KEYS):
        return None
    inertia = axis.numbers("inertia_kg_m2", None, low=-1e5, high=1e5)
    if len(inertia) not in (3, 6):
        axis.fail("RBL613", f"'{axis.name('inertia_kg_m2')}' needs {INERTIA_FORMS}", key="inertia_kg_m2")
    return BodyRow(
        mass_kg=axis.number("mass_kg", low=0.0, high=10000.0),
        cog_m=axis.numbers("cog_m", 3, low=-10.0, high=10.0),
        inertia_kg_m2=inertia,
    )


class SidecarFile(Record):
    """A sidecar that is filled in; texts that it does not have are empty. ``table`` is the whole file.

    ``estimated`` has the rules of the values that are marked as estimates (``marks``), and of jerk limits that the file
    does not state.
    """

    title: str
    sources: tuple[str, ...]
    notes: tuple[str, ...]
    rated_payload: float
    axes: tuple[AxisDrive, ...]
    path: PathLimits
    link_radii: tuple[float, ...]
    estimated: dict[str, str]
    table: Table


def lacking_of(source: Source, model: str) -> FileFault | None:
    """Return the one fault (RBL608) that lists all keys which a sidecar lacks, None where it lacks none."""
    table = load_marked(source).table
    return _gaps(table, table.tables("axes", required=False), model)


def read_sidecar(source: Source, model: str, estimates: Mapping[str, Any] = MappingProxyType({})) -> SidecarFile:
    """Return the sidecar of the file named ``model``; ``FileFault`` RBL6xx, RBL608 lists all missing keys.

    ``estimates`` is the content of another sidecar of that model, from which keys are taken that this one lacks.
    """
    marked = load_marked(source, estimates)
    table = marked.table
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    if (named := table.text("robot")) != model:
        table.fail("RBL610", f"this sidecar is for '{named}', not for '{model}'", key="robot")
    axes = table.tables("axes")
    # before anything is read: a template lacks some hundred values, and one error a key would show the first alone
    if (gaps := _gaps(table, axes, model)) is not None:
        raise gaps
    found = SidecarFile(
        title=table.text("title", ""),
        sources=drives.texts(table, "sources"),
        notes=drives.texts(table, "notes"),
        rated_payload=rated_payload(table),
        link_radii=drives.link_radii(axes),
        axes=tuple(_axis(axis) for axis in axes),
        path=drives.path_limits(table.table("path")),
        estimated=marked.estimated(),
        table=table,
    )
    table.text("flange", "")  # read by ``read_overlay``; named here so that it is a known key
    table.done()
    return found.replaced(estimated={**found.estimated, **estimated_jerks(found.axes)})


def _axis(table: Table) -> AxisDrive:
    body_row(table)  # read by ``read_overlay``; here so that its keys are known
    return axis_drive(table)


def _gaps(table: Table, axes: list[Table], model: str) -> FileFault | None:
    """Return one ``FileFault`` RBL608 that names all keys still to be filled in, None where there are none."""
    own = [] if PAYLOAD_KEY in table else [PAYLOAD_KEY]
    own += _lacking_in(table, "path", PATH_KEYS)
    missing = [_lacking_of(axis) for axis in axes]
    # at the first table that lacks something; the message names the keys of all
    incomplete = [table] if own else [axis for axis, here in zip(axes, missing, strict=True) if here]
    if not incomplete:
        return None
    gaps = [*whole(own, {"path": [f"path.{key}" for key in PATH_KEYS]}), lacking(missing)]
    # from the working folder: a sidecar stands beside its model
    path = Path(table.source.path).parent / model
    return incomplete[0].fault(
        "RBL608",
        f"missing in this file: {'; '.join(gap for gap in gaps if gap)}",
        f"fill in the lines marked MISSING, or 'robolang robot import {path} --estimate --force'; an ideal arm "
        "(--no-physics) needs none",
    )


def _lacking_of(axis: Table) -> list[str]:
    """Return the keys that one axis lacks, those of inner tables with the name of the table."""
    kind = drives.axis_kind(axis)
    lacking = [key for key in limit_keys(kind) if key not in axis]
    for group, keys in groups(kind).items():
        lacking += _lacking_in(axis, group, keys)
    return whole_groups(lacking, kind)


def _lacking_in(table: Table, name: str, keys: Iterable[str]) -> list[str]:
    """Return as ``name.key`` which keys an inner table lacks; all of them where the table itself is missing."""
    inner = table.table(name) if name in table else None
    return [f"{name}.{key}" for key in keys if inner is None or key not in inner]


def whole_groups(keys: Sequence[str], kind: AxisKind) -> list[str]:
    """Return the keys that an axis lacks, with those of an inner table that lacks all of them in one entry."""
    inner = {f"axes.{group}": [f"{group}.{key}" for key in keys] for group, keys in groups(kind).items()}
    return whole(keys, inner)


def lacking(missing: Sequence[Sequence[str]]) -> str:
    """Return in words which keys of a sidecar each axis lacks (``whole_groups``)."""
    keys = dict.fromkeys(key for here in missing for key in here)
    return listed({key: [k for k, here in enumerate(missing) if key in here] for key in keys}, len(missing))
