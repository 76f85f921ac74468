"""An arm of a model file with the drives of its sidecar, and the template of a sidecar.

``sidecar_file`` reads the sidecar. A template has the values of the model file, and for every other one either an
estimate that is marked as one (``marks``), where somebody asked for estimates, or a line marked MISSING, commented out:
such a file is refused until a person has filled it in (RBL608, every gap listed).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from runtime.core.tomlfile import FileFault
from runtime.robot.files import corrections as rules
from runtime.robot.files.body_plausibility import doubt_torques, offsets, travels, turning_torques, weight_moment
from runtime.robot.files.estimate import Estimate
from runtime.robot.files.imported import ImportedArm, ImportedAxis
from runtime.robot.files.loader import axis_spec
from runtime.robot.files.marks import ESTIMATE, RULE
from runtime.robot.files.plausibility import doubt_axes, in_tables
from runtime.robot.files.sidecar_file import (
    PATH_KEYS,
    PAYLOAD_KEY,
    SidecarFile,
    groups,
    lacking,
    limit_keys,
    whole_groups,
)
from runtime.robot.model.axis_kind import REVOLUTE, AxisKind
from runtime.robot.model.drives import RISE_S, joint_label
from runtime.robot.model.spec import AxisSpec, Correction, RobotSpec

TYPED = 1e-9
"""A position that is this near to a number of deg or mm with few decimals was typed as that number, deg or mm."""


def complete(arm: ImportedArm, file: SidecarFile) -> RobotSpec:
    """Return the robot of an imported arm and its sidecar; ``FileFault`` RBL610 or RBL606 where they do not fit."""
    _check_names(file, arm)
    built, corrections = _axes(arm, file)
    return RobotSpec(
        name=arm.name,
        title=file.title or arm.title,
        sources=file.sources,
        notes=file.notes,
        rated_payload=file.rated_payload,
        axes=built,
        X_last_flange=arm.X_last_flange,
        path=file.path,
        opw=arm.opw,
        corrections=corrections,
        published=tuple(axis.body for axis in arm.axes),
        link_radii=file.link_radii,
        estimated=file.estimated,
        meshes=arm.meshes,
        warnings=(*arm.warnings, *doubt_axes(file.axes), *_doubted_torques(arm, file)),
    )


def _doubted_torques(arm: ImportedArm, file: SidecarFile) -> list[FileFault]:
    labels = [joint_label(k, axis.name) for k, axis in enumerate(arm.axes)]
    lengths = offsets([axis.placement for axis in arm.axes], arm.X_last_flange)
    weight = weight_moment([axis.body for axis in arm.axes], lengths, travels(arm.axes, arm.lower, arm.upper))
    place = in_tables([axis.table for axis in file.axes])
    return doubt_torques(labels, turning_torques([axis.limits for axis in file.axes]), weight, place)


def _check_names(file: SidecarFile, arm: ImportedArm) -> None:
    if len(file.axes) != arm.n:
        file.table.fail("RBL610", f"{Path(arm.path).name} has {arm.n} axes, this file {len(file.axes)}", key="axes")
    for axis, imported in zip(file.axes, arm.axes, strict=True):
        if axis.name != imported.name:
            axis.table.fail(
                "RBL610", f"this axis is '{axis.name}', and joint '{imported.name}' comes here in the chain", key="name"
            )


def _axes(arm: ImportedArm, file: SidecarFile) -> tuple[tuple[AxisSpec, ...], tuple[Correction, ...]]:
    built: list[AxisSpec] = []
    corrections: list[Correction] = []
    for index, (axis, imported) in enumerate(zip(file.axes, arm.axes, strict=True)):
        built.append(axis_spec(axis, imported.placement, imported.body))
        if axis.correction is not None:
            corrections.append(rules.correct(axis.correction, built, index))
    rules.check_bodies([axis.table for axis in file.axes], built)
    return tuple(built), tuple(corrections)


def missing_in_template(arm: ImportedArm) -> str:
    """Return in words the keys that the template of an arm leaves to be filled in for its axes."""
    return lacking([_missing_of(axis) for axis in arm.axes])


def _missing_of(axis: ImportedAxis) -> list[str]:
    given = _given_limits(axis)
    limits = [key for key in limit_keys(axis.kind) if key not in given]
    inner = [f"{group}.{key}" for group, keys in groups(axis.kind).items() for key in keys]
    return whole_groups([*limits, *inner], axis.kind)


# --- the template ----------------------------------------------------------------------------------------------------

_HEAD = """\
# Drives and limits of {model}. Written by 'robolang robot import', to be completed by a person.
{how}
# Values that are there come from {model}. A value here rules over the one in that file.
schema = 1
robot = {robot}
flange = {flange}  # the frame that tools are mounted on
# title = "..."
# sources = ["where the drive data come from; which of them are estimates"]
"""
_TO_FILL_IN = (
    "# A line marked MISSING is refused until it is filled in: take the '#' before the key away and write the value."
)
_ESTIMATED = "# {{ estimate = ... }} is an estimate by its rule. Write the real value in its place: key = value."
# not written as an estimate: its value would stay where somebody states another acceleration
_JERK = f"# {{key}} = ...  # {{unit}}; without it the acceleration builds up in {RISE_S:g} s: an estimate"
_BODY_UNITS = {"mass_kg": "kg", "cog_m": "m, in the frame of the axis", "inertia_kg_m2": "xx, yy, zz, xy, xz, yz"}


def template(arm: ImportedArm, estimates: Mapping[str, Estimate] = MappingProxyType({})) -> str:
    """Return the text of a sidecar with what the model file gives filled in, and the rest estimated or marked MISSING.

    ``estimates`` by their dotted names, axes counted from 1 (``estimate``).
    """
    model = Path(arm.path).name
    how = _ESTIMATED.format() if estimates else _TO_FILL_IN
    lines = [_HEAD.format(model=_one_line(model), how=how, robot=quoted(model), flange=quoted(arm.flange))]
    gaps = _Gaps(estimates, "")
    lines += [gaps.line(PAYLOAD_KEY, "heaviest load at the flange, kg"), "", "# Limits of the tool point.", "[path]"]
    lines += [_Gaps(estimates, "path.").line(key, unit) for key, unit in PATH_KEYS.items()]
    for index, axis in enumerate(arm.axes):
        lines += _axis_lines(index, axis, _Gaps(estimates, f"axes.{index + 1}."))
    return "\n".join(lines) + "\n"


def _axis_lines(index: int, axis: ImportedAxis, gaps: "_Gaps") -> list[str]:
    kind, inner = axis.kind, groups(axis.kind)
    lines = ["", f"# J{index + 1}", "[[axes]]", f"name = {quoted(axis.name)}"]
    lines += [f"kind = {quoted(kind.name)}"] if kind.slides else []
    lines += _limit_lines(axis, gaps)
    lines += [_JERK.format(key=kind.jerk_key, unit=f"{kind.unit}/s3")]
    lines += gaps.some(_BODY_UNITS)
    radius = gaps.some({"link_radius_mm": "of the link, to check the arm against itself"})
    lines += radius or ["# link_radius_mm = ...  # of the link, of all axes or none: to check the arm against itself"]
    if axis.impossible is not None and not gaps.some(_BODY_UNITS):
        lines += _correction_lines(axis)
    lines += ["[axes.motor]", *_motor_notes(axis)]
    lines += [gaps.line(key, unit, "motor.") for key, unit in inner["motor"].items()]
    lines += [f"# {kind.stiffness_key} and {kind.damping_key}, at the joint: only for an elastic gear"]
    return [*lines, "[axes.servo]", *(gaps.line(key, unit, "servo.") for key, unit in inner["servo"].items())]


@dataclass(frozen=True, slots=True)
class _Gaps:
    """Lines for the keys that a model file does not give: ``estimates``, of which those of a table have ``prefix``."""

    estimates: Mapping[str, Estimate]
    prefix: str

    def line(self, key: str, unit: str, table: str = "") -> str:
        """Return the line of a key: its estimate, or a mark that it is missing."""
        found = self.estimates.get(f"{self.prefix}{table}{key}")
        if found is None:
            return f"# {key} =   # MISSING: {unit}"
        value = list(found.value) if isinstance(found.value, tuple) else found.value
        return f"{key} = {{ {ESTIMATE} = {value}, {RULE} = {quoted(found.rule)} }}  # {unit}"

    def some(self, units: Mapping[str, str]) -> list[str]:
        """Return the lines of those keys that are estimated."""
        return [self.line(key, unit) for key, unit in units.items() if f"{self.prefix}{key}" in self.estimates]


def _limit_lines(axis: ImportedAxis, gaps: _Gaps) -> list[str]:
    # an estimate rules over a value of the file that is a placeholder
    values, keys = _given_limits(axis), limit_keys(axis.kind)
    estimated = {key for key in keys if f"{gaps.prefix}{key}" in gaps.estimates}
    return [
        f"{key} = {values[key]}  # {unit}" if key in values and key not in estimated else gaps.line(key, unit)
        for key, unit in keys.items()
    ]


def _given_limits(axis: ImportedAxis) -> dict[str, str]:
    """Return the limits that the model file gives, by key, as the sidecar writes them."""
    hinge, kind = axis.hinge, axis.kind
    values: dict[str, str] = {}
    widest = max(abs(hinge.lower or 0.0), abs(hinge.upper or 0.0))
    if hinge.lower is not None and hinge.upper is not None and widest <= kind.widest:  # else it is not read back
        values[kind.range_key] = f"[{as_typed(hinge.lower, kind)}, {as_typed(hinge.upper, kind)}]"
    if hinge.speed is not None:
        values[kind.speed_key] = as_typed(hinge.speed, kind)
    if hinge.effort is not None:
        values[kind.force_key] = repr(hinge.effort)
    return values


def as_typed(position: float, kind: AxisKind = REVOLUTE) -> str:
    """Return rad in deg, m in mm, as somebody typed them: the shortest number that is the same position.

    The shortest that gives the same float again, else the shortest within ``TYPED``: 185 deg that a file has with 14
    digits of rad must not become 185.000000000028. What has no such number keeps 15 digits.
    """
    shown = position / kind.size
    # few decimals first: a drawing has whole degrees more often than tenths
    for places in range(7):
        near = round(shown, places) + 0.0
        if near * kind.size == position or abs(shown - near) <= TYPED:
            return repr(near)
    return repr(float(f"{shown:.15g}"))


def _motor_notes(axis: ImportedAxis) -> list[str]:
    hinge, kind = axis.hinge, axis.kind
    # at the joint and with N unknown: a file gives these three, and none of them can be turned into a motor's
    values = {
        "armature (N^2 times the rotor inertia)": (hinge.armature, kind.inertia),
        "damping (N^2 times the viscous friction)": (hinge.damping, f"{kind.force} s/{kind.coordinate}"),
        "friction (N times the Coulomb friction)": (hinge.friction, kind.force),
    }
    return [
        f"# The model file gives, at the joint: {what} {value!r} {unit}."
        for what, (value, unit) in values.items()
        if value
    ]


def _correction_lines(axis: ImportedAxis) -> list[str]:
    # the smallest correction that makes the body possible, commented out: to accept it is a person's decision
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
