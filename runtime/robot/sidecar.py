"""The sidecar ``arm.robot.toml`` of an ``arm.urdf`` or ``arm.xml``: drives and limits, which such files do not hold.

Its keys are those of a robot file in TOML (docs/robots-import.md), without geometry and bodies, with one ``[[axes]]``
for each joint in the order of the chain. What it says of ranges, speeds and torques rules over the model file. A
template writes what the model file gives and a line marked MISSING, commented out, for everything else: such a file
is refused until a person has filled it in (RBL608, every gap listed), because drive data are never guessed.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from runtime.robot import corrections as rules
from runtime.robot import loader
from runtime.robot.gaps import listed, whole
from runtime.robot.imported import ImportedArm, ImportedAxis
from runtime.robot.plausibility import doubt_limits_and_drives
from runtime.robot.spec import AxisSpec, Correction, RobotSpec
from runtime.tomlfile import Source, Table, load_table
from runtime.units import DEG

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
_GROUPS = {"motor": MOTOR_KEYS, "servo": SERVO_KEYS}


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
            lower, upper = axis.numbers("range_deg", 2, low=-loader.WIDEST / DEG, high=loader.WIDEST / DEG)
            if not lower < upper:
                axis.fail("RBL607", f"'{axis.name('range_deg')}' goes from {lower:g} to {upper:g}", key="range_deg")
            ranges[name], tables[name] = (lower * DEG, upper * DEG), axis
        if "correction" in axis:
            corrected.add(name)
    flange = table.text("flange") if "flange" in table else None
    return Overlay(flange=flange, ranges=ranges, tables=tables, corrected=frozenset(corrected))


def complete(arm: ImportedArm, source: Source) -> RobotSpec:
    """Return the robot of an imported arm and its sidecar; ``FileFault`` RBL608 lists all that is missing."""
    table = load_table(source)
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    model = Path(arm.path).name
    if (named := table.text("robot")) != model:
        table.fail("RBL610", f"this sidecar is for '{named}', not for '{model}'", key="robot")
    axes = table.tables("axes")
    _check_names(table, axes, arm)
    _check_complete(table, axes)
    built, corrections = _axes(arm, axes)
    spec = RobotSpec(
        name=arm.name,
        title=table.text("title", arm.title),
        sources=loader.texts(table, "sources") if "sources" in table else (),
        notes=loader.texts(table, "notes") if "notes" in table else (),
        rated_payload=table.number(PAYLOAD_KEY, low=0.0, high=5000.0),
        axes=built,
        X_last_flange=arm.X_last_flange,
        path=loader.path_limits(table.table("path")),
        opw=arm.opw,
        corrections=corrections,
        published=tuple(axis.body for axis in arm.axes),
        warnings=(*arm.warnings, *doubt_limits_and_drives(built, arm.X_last_flange, axes)),
    )
    table.text("flange", arm.flange)
    table.done()
    return spec


def _check_names(table: Table, axes: list[Table], arm: ImportedArm) -> None:
    if len(axes) != arm.n:
        table.fail("RBL610", f"{Path(arm.path).name} has {arm.n} axes, this file {len(axes)}", key="axes")
    for axis, imported in zip(axes, arm.axes, strict=True):
        if (name := axis.text("name")) != imported.name:
            axis.fail("RBL610", f"'{name}' stands where the chain has joint '{imported.name}'", key="name")


def _check_complete(table: Table, axes: list[Table]) -> None:
    """Name every key that a person has still to fill in, in one message."""
    path = table.table("path") if "path" in table else None
    own = [PAYLOAD_KEY] if PAYLOAD_KEY not in table else []
    own += [f"path.{key}" for key in PATH_KEYS if path is None or key not in path]
    missing: list[set[str]] = []
    for axis in axes:
        here = {key for key in LIMIT_KEYS if key not in axis}
        for group, keys in _GROUPS.items():
            inner = axis.table(group) if group in axis else None
            here |= {f"{group}.{key}" for key in keys if inner is None or key not in inner}
        missing.append(here)
    if own or any(missing):
        where = table if own else next(axis for axis, here in zip(axes, missing, strict=True) if here)
        gaps = [*whole(own, {"path": [f"path.{key}" for key in PATH_KEYS]}), lacking(missing)]
        where.fail("RBL608", f"missing in this file: {'; '.join(gap for gap in gaps if gap)}",
                   "fill in the lines marked MISSING")  # fmt: skip


def lacking(missing: Sequence[Collection[str]]) -> str:
    """Return in words what each axis has not of the keys of a sidecar."""
    inner = {f"axes.{group}": [f"{group}.{key}" for key in keys] for group, keys in _GROUPS.items()}
    keys = [*LIMIT_KEYS, *(key for keys in inner.values() for key in keys)]
    return listed({key: [k for k, here in enumerate(missing) if key in here] for key in keys}, len(missing), inner)


def missing_in_template(arm: ImportedArm) -> str:
    """Return in words what the template of an arm leaves to fill in for its axes."""
    inner = [f"{group}.{key}" for group, keys in _GROUPS.items() for key in keys]
    return lacking([{*inner, *(key for key in LIMIT_KEYS if key not in _given_limits(axis))} for axis in arm.axes])


def _axes(arm: ImportedArm, tables: list[Table]) -> tuple[tuple[AxisSpec, ...], tuple[Correction, ...]]:
    built: list[AxisSpec] = []
    corrections: list[Correction] = []
    for index, (table, imported) in enumerate(zip(tables, arm.axes, strict=True)):
        built.append(
            AxisSpec(
                name=imported.name,
                placement=imported.placement,
                body=imported.body,
                motor=loader.motor(table.table("motor")),
                limits=loader.limits(table),
                bandwidths=loader.bandwidths(table.table("servo")),
            )
        )
        correction = table.table("correction") if "correction" in table else None
        table.done()
        if correction is not None:
            corrections.append(rules.correct(correction, built, index))
    rules.check_bodies(tables, built)
    return tuple(built), tuple(corrections)


# --- the template ----------------------------------------------------------------------------------------------------

_HEAD = """\
# Drives and limits of {model}. Written by 'robolang robot import', to be completed by a person.
# A line marked MISSING is refused until it is filled in: take the '#' before the key away and write the value.
# Values that are there come from {model}. A value here rules over the one in that file.
schema = 1
robot = {robot}
flange = {flange}  # the frame that tools are mounted on
# title = "..."
# sources = ["where the drive data come from; which of them are estimates"]
"""


def template(arm: ImportedArm) -> str:
    """Return the text of a sidecar with what the model file gives filled in and the rest marked MISSING."""
    model = Path(arm.path).name
    lines = [_HEAD.format(model=_one_line(model), robot=quoted(model), flange=quoted(arm.flange))]
    lines += [_gap(PAYLOAD_KEY, "heaviest load at the flange, kg"), "", "# Limits of the tool point.", "[path]"]
    lines += [_gap(key, unit) for key, unit in PATH_KEYS.items()]
    for index, axis in enumerate(arm.axes):
        lines += ["", f"# J{index + 1}", "[[axes]]", f"name = {quoted(axis.name)}", *_limit_lines(axis)]
        if axis.impossible is not None:
            lines += _correction_lines(axis)
        lines += ["[axes.motor]", *_motor_notes(axis)]
        lines += [_gap(key, unit) for key, unit in MOTOR_KEYS.items()]
        lines += ["# joint_stiffness_nm_rad and joint_damping_nm_s_rad, at the joint: only for an elastic gear"]
        lines += ["[axes.servo]", *(_gap(key, unit) for key, unit in SERVO_KEYS.items())]
    return "\n".join(lines) + "\n"


def _gap(key: str, unit: str) -> str:
    return f"# {key} =   # MISSING: {unit}"


def _limit_lines(axis: ImportedAxis) -> list[str]:
    values = _given_limits(axis)
    return [
        f"{key} = {values[key]}  # {unit}" if key in values else _gap(key, unit) for key, unit in LIMIT_KEYS.items()
    ]


def _given_limits(axis: ImportedAxis) -> dict[str, str]:
    """Return what the model file gives of the limits, by key, as the sidecar writes it."""
    hinge = axis.hinge
    values: dict[str, str] = {}
    widest = max(abs(hinge.lower or 0.0), abs(hinge.upper or 0.0))
    if hinge.lower is not None and hinge.upper is not None and widest <= loader.WIDEST:  # else it is not read back
        values["range_deg"] = f"[{_degrees(hinge.lower)}, {_degrees(hinge.upper)}]"
    if hinge.speed is not None:
        values["max_speed_deg_s"] = _degrees(hinge.speed)
    if hinge.effort is not None:
        values["max_torque_nm"] = repr(hinge.effort)
    return values


def _degrees(angle: float) -> str:
    # 15 digits: rad to deg and back loses one, and a range of 180 must not become 180.00000000000003
    return repr(float(f"{angle / DEG:.15g}"))


def _motor_notes(axis: ImportedAxis) -> list[str]:
    hinge = axis.hinge
    said = {
        "armature (N^2 times the rotor inertia)": (hinge.armature, "kg m2"),
        "damping (N^2 times the viscous friction)": (hinge.damping, "N m s/rad"),
        "friction (N times the Coulomb friction)": (hinge.friction, "N m"),
    }
    return [f"# The model file gives, at the joint: {what} {value!r} {unit}." for what, (value, unit) in said.items()
            if value]  # fmt: skip


def _correction_lines(axis: ImportedAxis) -> list[str]:
    assert axis.impossible is not None
    shift = rules.smallest_shift(axis.body.inertia) or 0.0
    shifted = rules.shifted(axis.body.inertia, shift)
    return [
        f"# {_one_line(axis.impossible.message)}. Correct the model file, or state what to change:",
        "# [axes.correction]",
        f"# inertia_shift_kg_m2 = {shift:.12g}",
        f"# added_mass_kg = {rules.TOKEN_MASS if not axis.body.mass > 0.0 else 0.0:g}",
        *([f"# added_inertia_kg_m2 = {rules.TOKEN_INERTIA:g}"] if rules.flat(shifted) else []),
        '# reason = "..."',
    ]


def quoted(text: str) -> str:
    """Return a TOML basic string."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08X}" for c in escaped) + '"'


def _one_line(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)
