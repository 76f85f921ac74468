"""From a robot file to a ``RobotSpec`` in SI: joint frames, bodies that are possible, a closed form that fits.

``robot_file`` reads the file; the steps that need vectors are here. Published body data that no body can have (zero
mass, a broken triangle inequality) are refused unless the file states a ``correction``; the smallest one that works is
named in the message (``corrections``). Read at start, no rate.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul
from runtime.core.tomlfile import FileFault, Table
from runtime.core.units import DEG
from runtime.robot.files import robot_file
from runtime.robot.files.body_plausibility import (
    doubt_bodies,
    doubt_torques,
    offsets,
    travels,
    turning_torques,
    weight_moment,
)
from runtime.robot.files.corrections import check_bodies, correct
from runtime.robot.files.geometry import Geometry, geometry_of
from runtime.robot.files.plausibility import in_tables
from runtime.robot.files.robot_file import AxisDrive, AxisFile, OpwRow, RobotFile
from runtime.robot.files.sidecar_file import BodyRow
from runtime.robot.model.drives import joint_label
from runtime.robot.model.spec import AxisSpec, Body, Correction, OpwParameters, RobotSpec


@cache
def load_builtin(name: str) -> RobotSpec:
    """Return a built-in robot; ``KeyError`` for another name."""
    return build(robot_file.builtin(name))


def build(file: RobotFile) -> RobotSpec:
    """Return the robot of a file; ``FileFault`` RBL606 or RBL615 where its bodies or its closed form cannot be."""
    # bodies before the closed form: an impossible body is the more useful message of the two
    geometry = geometry_of(file)
    axes, published, corrections = _chain(file.axes, geometry)
    spec = RobotSpec(
        name=file.name,
        title=file.title,
        sources=file.sources,
        notes=file.notes,
        rated_payload=file.rated_payload,
        axes=axes,
        X_last_flange=frozen(geometry.X_last_flange),
        path=file.path,
        opw=None if file.opw is None else _opw(file.opw),
        corrections=corrections,
        published=published,
        link_radii=file.link_radii,
        estimated=file.estimated,
        warnings=_doubts(file, axes, published, corrections, geometry),
    )
    _check_opw(spec, file.table)
    return spec


def _doubts(
    file: RobotFile,
    axes: Sequence[AxisSpec],
    published: Sequence[Body],
    corrections: Sequence[Correction],
    geometry: Geometry,
) -> tuple[FileFault, ...]:
    """Return the doubts about a robot file (``plausibility``); a corrected body is not judged.

    A body that the source got wrong and that was mended on purpose says nothing about the units of the file.
    """
    corrected = {item.axis for item in corrections}
    labels = [joint_label(k, axis.name) for k, axis in enumerate(axes)]
    bodies = [None if k in corrected else body for k, body in enumerate(published)]
    lengths, place = (
        offsets(geometry.placements, geometry.X_last_flange),
        in_tables([axis.drive.table for axis in file.axes]),
    )
    limits = [axis.limits for axis in axes]
    slid = travels(axes, np.array([own.lower for own in limits]), np.array([own.upper for own in limits]))
    weight = weight_moment([axis.body for axis in axes], lengths, slid)
    return (
        *doubt_bodies(labels, bodies, lengths, slid, place),
        *file.warnings,
        *doubt_torques(labels, turning_torques(limits), weight, place),
    )


def _opw(row: OpwRow) -> OpwParameters:
    return OpwParameters.of(row.lengths_m, np.array(row.offsets_deg) * DEG, np.array(row.signs))


def _chain(
    files: tuple[AxisFile, ...], geometry: Geometry
) -> tuple[tuple[AxisSpec, ...], tuple[Body, ...], tuple[Correction, ...]]:
    """Return the axes, their bodies as published and the corrections of these."""
    axes: list[AxisSpec] = []
    published: list[Body] = []
    corrections: list[Correction] = []
    for index, (file, placement, X_joint_body) in enumerate(
        zip(files, geometry.placements, geometry.X_joint_body, strict=True)
    ):
        axis = axis_spec(file.drive, placement, _body(file, X_joint_body))
        axes.append(axis)
        published.append(axis.body)
        if file.drive.correction is not None:
            corrections.append(correct(file.drive.correction, axes, index))
    check_bodies([file.drive.table for file in files], axes)
    return tuple(axes), tuple(published), tuple(corrections)


def axis_spec(drive: AxisDrive, placement: Array, body: Body) -> AxisSpec:
    """Return an axis with the drive of its file; ``placement`` (4, 4) in the frame of the axis before it."""
    return AxisSpec(
        name=drive.name,
        placement=frozen(placement),
        body=body,
        motor=drive.motor,
        limits=drive.limits,
        bandwidths=drive.bandwidths,
    )


def _body(file: AxisFile, X_joint_body: Array) -> Body:
    # the file states the body in another frame than that of the joint, see ``geometry``
    R = X_joint_body[:3, :3]
    inertia = matmul(R, inertia_matrix(file.inertia_kg_m2), R.T)
    cog = matmul(R, np.array(file.cog_m)) + X_joint_body[:3, 3]
    return Body(mass=file.mass_kg, cog=frozen(cog), inertia=frozen(inertia))


def body_of(row: BodyRow) -> Body:
    """Return the body that a sidecar states, in the frame of its axis."""
    return Body(mass=row.mass_kg, cog=frozen(row.cog_m), inertia=frozen(inertia_matrix(row.inertia_kg_m2)))


def inertia_matrix(values: tuple[float, ...]) -> Array:
    """Return the 3x3 matrix of (xx, yy, zz[, xy, xz, yz]); the products are the matrix entries themselves."""
    xx, yy, zz, xy, xz, yz = (*values, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _check_opw(spec: RobotSpec, table: Table) -> None:
    """Refuse closed-form parameters that describe another arm than the table of axes (RBL615)."""
    if spec.opw is None:
        return
    from runtime.robot.kinematics import opw

    # given parameters are not trusted: an arm with a wrong closed form would move to wrong places without an error
    error = opw.mismatch(spec)
    if not error < 1e-9:
        table.fail("RBL615", f"the closed form and the table of axes differ by {error * 1000:.6f} mm", key="kinematics")
