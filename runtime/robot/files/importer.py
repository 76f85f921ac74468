"""Arms from URDF and MJCF files, with the sidecar beside them.

``read_arm`` gives the geometry, bodies and ranges of a model file, which is all that kinematics needs; ``load_file``
the whole robot of any robot file, for which the sidecar of a model file must give the drives. The text is checked here
in full (``xmlfile``, ``urdf``, ``mjcf_import``, ``imported``); neither Pinocchio nor MuJoCo reads it: both get the
``RobotSpec``. The root element decides which of the two languages it is, not the file's name.
"""

import math
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from runtime.core.faults import raise_all
from runtime.core.frames import Array, frozen
from runtime.core.tomlfile import FileFault, Source, read_source
from runtime.robot.files import left_out, loader
from runtime.robot.files.arm_file import ArmFile, ModelFile, model_root, read_arm_file, sidecar_source
from runtime.robot.files.body_plausibility import doubt_bodies, doubt_torques, offsets, travels, weight_moment
from runtime.robot.files.estimate import estimate
from runtime.robot.files.imported import ImportedArm, serial_chain
from runtime.robot.files.known import doubt_bodies_alike, doubt_torques_alike, known_of
from runtime.robot.files.loader import body_of
from runtime.robot.files.mjcf_import import read_mjcf
from runtime.robot.files.plausibility import Moving, What, doubt_moving
from runtime.robot.files.robot_file import RobotFile
from runtime.robot.files.sidecar import complete, missing_in_template, template
from runtime.robot.files.sidecar_file import (
    ESTIMATED_KEYS,
    NO_OVERLAY,
    Overlay,
    SidecarFile,
    check_kinds,
    lacking_of,
    read_overlay,
    read_sidecar,
    sidecar_path,
)
from runtime.robot.files.urdf import read_urdf
from runtime.robot.kinematics.closed_form import find_opw
from runtime.robot.model.drives import joint_label
from runtime.robot.model.spec import RobotSpec

UNIT_SLACK = 1e-3
"""Rounding of the length of a unit vector that is printed with three digits or more."""


def load_file(path: Path) -> RobotSpec:
    """Return the robot of a file, by its ending; ``FileFault`` RBL6xx."""
    return build(read_arm_file(path))


def build(file: ArmFile) -> RobotSpec:
    """Return the robot of a file that has been read; ``FileFault`` RBL6xx where its arm cannot be.

    A model without a sidecar has no drives: what an ideal arm needs beyond its limits is estimated, and physics are
    refused (``RobotSpec.undriven``).
    """
    if isinstance(file, RobotFile):
        return loader.build(file)
    if file.sidecar is None:
        return _ideal(file)
    return with_sidecar(file.source, file.sidecar)


def with_sidecar(source: Source, sidecar: SidecarFile) -> RobotSpec:
    """Return the robot of the text of a model file and a sidecar that is filled in; ``FileFault`` RBL6xx."""
    # read once more as an overlay: a chain is built with the ranges and the flange that the sidecar states
    overlay = read_overlay(sidecar.table.source)
    arm = parse_model(source, overlay)
    _check(arm, overlay)
    _check_bodies(arm, overlay)
    return complete(arm, sidecar)


def read_arm(path: Path) -> ImportedArm:
    """Return the arm of a model file without its drives; ``FileFault`` RBL6xx, RBL608 when a joint has no range."""
    arm, sidecar = _with_sidecar(path)
    overlay = NO_OVERLAY if sidecar is None else read_overlay(sidecar)
    _check(arm, overlay)
    return _with_limits_doubted(arm, overlay)


def read_model(path: Path, overlay: Overlay = NO_OVERLAY) -> ImportedArm:
    """Return the arm of a model file alone; ranges that it leaves out are NaN, and bodies are not judged."""
    return _with_limits_doubted(parse_model(read_source(path), overlay), overlay)


def parse_model(source: Source, overlay: Overlay = NO_OVERLAY) -> ImportedArm:
    """Return the arm of the text of a model file; ``FileFault`` RBL6xx at the element that is wrong.

    Its limits are not doubted yet: a sidecar may state others.
    """
    root = model_root(source)
    name, tree = read_urdf(root) if root.tag == "robot" else read_mjcf(root, Path(source.path).name)
    arm = _with_bodies(serial_chain(tree, source.path, name, overlay.flange), overlay)
    check_kinds(overlay, {axis.name: axis.kind for axis in arm.axes})
    # ranges of the sidecar replace those of the model before anything is computed from them
    ranges = [
        overlay.ranges.get(axis.name, (low, high))
        for axis, low, high in zip(arm.axes, arm.lower, arm.upper, strict=True)
    ]
    lower, upper = np.array(ranges).T
    return replace(
        arm,
        lower=frozen(lower),
        upper=frozen(upper),
        opw=find_opw(arm.axes, arm.X_last_flange),
        warnings=(*_doubted_axes(arm), *_doubted_bodies(arm), *doubt_bodies_alike(arm)),
        notes=left_out.notes(root),
    )


def _with_bodies(arm: ImportedArm, overlay: Overlay) -> ImportedArm:
    """Return the arm with the bodies that its sidecar states; whether they can be is judged there (``complete``)."""
    # before the doubts: those are about the bodies that count
    axes = [
        replace(axis, body=body_of(overlay.bodies[axis.name]), impossible=None, bodiless=False)
        if axis.name in overlay.bodies
        else axis
        for axis in arm.axes
    ]
    return replace(arm, axes=tuple(axes))


def _doubted_axes(arm: ImportedArm) -> Iterator[FileFault]:
    """Yield the axes of a URDF that are no unit vectors, as its specification asks for (RBL628)."""
    for index, axis in enumerate(arm.axes):
        element = axis.hinge.element.one("axis")  # in MJCF an attribute, which need not be a unit vector
        if element is None:
            continue
        length = math.hypot(*element.numbers("xyz", 3))
        if not abs(length - 1.0) <= UNIT_SLACK:
            message = f"the axis of {joint_label(index, axis.name)} has length {length:g}: only its direction is used"
            yield element.fault("RBL628", message, "an axis of a URDF is a unit vector")


def _doubted_bodies(arm: ImportedArm) -> list[FileFault]:
    labels = [joint_label(index, axis.name) for index, axis in enumerate(arm.axes)]
    bodies = [axis.body if axis.impossible is None else None for axis in arm.axes]
    return doubt_bodies(
        labels,
        bodies,
        _offsets(arm),
        _travels(arm),
        lambda what, axis: (arm.axes[axis].hinge.element if what == "length" else arm.axes[axis].link).fault,
    )


def _offsets(arm: ImportedArm) -> Array:
    return offsets([axis.placement for axis in arm.axes], arm.X_last_flange)


def _travels(arm: ImportedArm) -> Array:
    return travels(arm.axes, arm.lower, arm.upper)


def _with_limits_doubted(arm: ImportedArm, overlay: Overlay) -> ImportedArm:
    """Return the arm with the doubts about its ranges, and about speeds and torques that no sidecar states."""

    def place(what: What, axis: int) -> Callable[[str, str, str], FileFault]:
        name, joint = arm.axes[axis].name, arm.axes[axis].hinge.element
        # a range of the sidecar has replaced that of the model: the warning belongs to the file that states it
        if what == "range" and name in overlay.ranges:
            table, key = overlay.tables[name], arm.axes[axis].kind.range_key
            return lambda code, message, hint: table.fault(code, message, hint, key=key)
        return (joint.one("limit") or joint).fault

    joints = [
        Moving(
            label=joint_label(index, axis.name),
            lower=lower,
            upper=upper,
            speed=math.nan if axis.hinge.speed is None else axis.hinge.speed,
            in_units=axis.hinge.in_degrees or axis.name in overlay.ranges,
            kind=axis.kind,
        )
        for index, (axis, lower, upper) in enumerate(zip(arm.axes, arm.lower.tolist(), arm.upper.tolist(), strict=True))
    ]
    weight = weight_moment([axis.body for axis in arm.axes], _offsets(arm), _travels(arm))
    # a force says nothing about N mm
    torques = [math.nan if axis.kind.slides else axis.hinge.effort or math.nan for axis in arm.axes]
    labels = [joint.label for joint in joints]
    doubts = (*doubt_moving(joints, place), *doubt_torques(labels, torques, weight, place))
    return replace(arm, warnings=(*arm.warnings, *doubts, *doubt_torques_alike(arm)))


def _ideal(file: ModelFile) -> RobotSpec:
    """Return the arm of a model file without a complete sidecar, for runs without physics; ``FileFault`` RBL6xx.

    What neither file states is estimated.
    """
    partial, path = file.partial, Path(file.source.path)
    stated = NO_OVERLAY if partial is None else read_overlay(partial)
    arm = parse_model(file.source, stated)
    _check(arm, stated)
    # through the text of a sidecar: an ideal arm is then the arm that the import of the same file makes
    text = Source(str(sidecar_path(path)), template(arm, estimate(known_of(arm))))
    if partial is None:
        return replace(with_sidecar(file.source, read_sidecar(text, path.name)), undriven=_undriven(arm, path))
    # a body that the sidecar corrects is known, although it cannot be as it is published
    guessed = {name: body for name, body in read_overlay(text).bodies.items() if name not in stated.corrected}
    built = parse_model(file.source, stated.replaced(bodies={**guessed, **stated.bodies}))
    # not its head: a sidecar that does not name its model and its schema is refused as ever
    values = {key: value for key, value in tomllib.loads(text.text).items() if key in ESTIMATED_KEYS}
    known = read_sidecar(partial, path.name, values)
    return replace(complete(built, known), undriven=lacking_of(partial, path.name))


def _with_sidecar(path: Path) -> tuple[ImportedArm, Source | None]:
    source, sidecar = read_source(path), sidecar_source(path)
    return parse_model(source, NO_OVERLAY if sidecar is None else read_overlay(sidecar)), sidecar


def _check(arm: ImportedArm, overlay: Overlay) -> None:
    """Refuse impossible bodies without a correction (RBL606), and joints without a range (RBL608), all of them."""
    faults = [
        axis.impossible
        for axis in arm.axes
        if axis.impossible is not None and not axis.bodiless and axis.name not in overlay.corrected
    ]
    raise_all([*faults, *_open_ended(arm)])


def _check_bodies(arm: ImportedArm, overlay: Overlay) -> None:
    """Refuse moving links that have no inertial in the file, in one fault (RBL606) at the first joint."""
    axes = [axis for axis in arm.axes if axis.bodiless and axis.name not in overlay.corrected]
    if axes:
        names = _names(arm, {axis.name for axis in axes})
        axes[0].hinge.element.fail("RBL606", f"links of {names} have no mass and no inertia", _estimates(arm))


def _open_ended(arm: ImportedArm) -> list[FileFault]:
    """Return the one fault of joints without a range (RBL608), at the first of them."""
    axes = [axis for k, axis in enumerate(arm.axes) if not np.isfinite(arm.lower[k] + arm.upper[k])]
    if not axes:
        return []
    message = f"no position limits for {_names(arm, {axis.name for axis in axes})}"
    keys = " or ".join(dict.fromkeys(axis.kind.range_key for axis in axes))
    # how far an axis slides follows from nothing else in a file
    estimates = "" if any(axis.kind.slides for axis in axes) else f"; {_estimates(arm)}"
    hint = f"write them there, or {keys} in {sidecar_path(Path(arm.path)).name}{estimates}"
    return [axes[0].hinge.element.fault("RBL608", message, hint)]


def _names(arm: ImportedArm, names: set[str]) -> str:
    return ", ".join(joint_label(k, axis.name) for k, axis in enumerate(arm.axes) if axis.name in names)


def _estimates(arm: ImportedArm) -> str:
    return f"'robolang robot import {arm.path} --estimate' estimates what is missing"


def _undriven(arm: ImportedArm, path: Path) -> FileFault:
    beside = sidecar_path(path).name
    return arm.axes[0].hinge.element.fault(
        "RBL608",
        f"no drives, path limits and rated payload: there is no {beside}; missing for {missing_in_template(arm)}",
        f"'robolang robot import {path} --estimate' writes {beside} with estimates; an ideal arm (--no-physics) "
        "needs none",
    )
