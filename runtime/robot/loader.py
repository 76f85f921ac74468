"""Reading a robot file into a ``RobotSpec``: every key known, every limit present, every body possible.

Nothing is guessed: a missing limit is an error that names the axis and the key, and so is a key nobody reads.
The geometry comes as Denavit-Hartenberg rows or as joint lines in space (``geometry``). Published body data that no
body can have (zero mass, a broken triangle inequality) are refused unless the file states a ``correction``; the
smallest one that works is named in the message (``corrections``).
"""

import math
from collections.abc import Sequence
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np

from runtime.frames import Array, frozen
from runtime.linear import matmul
from runtime.robot.corrections import check_bodies, correct
from runtime.robot.geometry import Geometry, read_form, read_geometry
from runtime.robot.plausibility import doubt_bodies, doubt_limits_and_drives, in_tables, offsets
from runtime.robot.spec import (
    AxisSpec,
    Bandwidths,
    Body,
    Correction,
    Limits,
    Motor,
    OpwParameters,
    PathLimits,
    RobotSpec,
    joint_label,
)
from runtime.tomlfile import FileFault, Source, Table, load_table, read_source
from runtime.units import DEG, MM

SCHEMA = 1
STIFFEST = 1e8
"""No gear is stiffer than this at the joint, N m/rad."""

FASTEST_SPRING = 1e4
"""A rotor that swings faster against its gear, rad/s, needs physics steps below 25 us: such a gear is rigid."""

WIDEST = 3600.0 * DEG
"""No joint turns further than ten turns to a side, rad."""

FASTEST_LOOP = 8000.0
"""No loop is stable beyond this at the shortest servo period: bandwidth times 0.25 ms is 2, 1/s (see ``project``)."""


def library() -> list[str]:
    """Return the names of the built-in robots."""
    files = resources.files("runtime.robot.library")
    return sorted(item.name.removesuffix(".toml") for item in files.iterdir() if item.name.endswith(".toml"))


@cache
def load_builtin(name: str) -> RobotSpec:
    """Return a built-in robot; ``KeyError`` when there is none of that name."""
    if name not in library():
        raise KeyError(name)
    text = resources.files("runtime.robot.library").joinpath(f"{name}.toml").read_text("utf-8")
    return parse_robot(Source(f"{name}.toml", text))


def load_robot(path: Path) -> RobotSpec:
    """Read a robot file; ``FileFault`` (RBL6xx) at the line that is wrong."""
    return parse_robot(read_source(path))


def parse_robot(source: Source) -> RobotSpec:
    """Build a ``RobotSpec`` from the text of a robot file; ``FileFault`` at the line that is wrong."""
    table = load_table(source)
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    name, title = table.text("name"), table.text("title")
    kinematics = table.table("kinematics")
    form = read_form(kinematics)
    opw = _opw(kinematics.table("opw")) if "opw" in kinematics else None
    kinematics.done()
    path = path_limits(table.table("path"))
    axis_tables = table.tables("axes")
    if not 1 <= len(axis_tables) <= 7:
        table.fail("RBL605", f"a robot has 1 to 7 axes, not {len(axis_tables)}", key="axes")
    geometry = read_geometry(form, table, axis_tables)
    axes, published, corrections = _chain(axis_tables, geometry)
    spec = RobotSpec(
        name=name,
        title=title,
        sources=texts(table, "sources"),
        notes=texts(table, "notes"),
        rated_payload=table.number("rated_payload_kg", low=0.0, high=5000.0),
        axes=axes,
        X_last_flange=frozen(geometry.X_last_flange),
        path=path,
        opw=opw,
        corrections=corrections,
        published=published,
        warnings=_doubts(axes, published, corrections, geometry, axis_tables),
    )
    table.done()
    _check_opw(spec, table)
    return spec


def _doubts(axes: Sequence[AxisSpec], published: Sequence[Body], corrections: Sequence[Correction], geometry: Geometry,
            tables: Sequence[Table]) -> tuple[FileFault, ...]:  # fmt: skip
    """Return what is unlikely about a robot file; a corrected body is not judged."""
    corrected = {item.axis for item in corrections}
    labels = [joint_label(k, axis.name) for k, axis in enumerate(axes)]
    bodies = [None if k in corrected else body for k, body in enumerate(published)]
    lengths = offsets(geometry.placements, geometry.X_last_flange)
    return (
        *doubt_bodies(labels, bodies, lengths, in_tables(tables)),
        *doubt_limits_and_drives(axes, geometry.X_last_flange, tables),
    )


def texts(table: Table, key: str) -> tuple[str, ...]:
    """Return an optional list of texts; ``FileFault`` RBL613."""
    value = table.raw_list(key)
    if not all(isinstance(item, str) for item in value):
        table.fail("RBL613", f"'{key}' must be a list of texts", key=key)
    return tuple(value)


def _opw(table: Table) -> OpwParameters:
    lengths = {key: table.number(f"{key}_m", low=-10.0, high=10.0) for key in ("a1", "a2", "b", "c1", "c2", "c3", "c4")}
    offsets = table.numbers("offsets_deg", 6, low=-360.0, high=360.0)
    signs = table.numbers("signs", 6, low=-1.0, high=1.0)
    if not all(abs(sign) == 1.0 for sign in signs):
        table.fail("RBL605", "'signs' must be 1 or -1", key="signs")
    table.done()
    return OpwParameters(**lengths, offsets=frozen(np.array(offsets) * DEG), signs=frozen(signs))


def path_limits(table: Table) -> PathLimits:
    """Read ``[path]`` in mm and deg into SI; ``FileFault`` RBL60x."""
    limits = PathLimits(
        default_speed=table.number("default_speed_mm_s", positive=True) * MM,
        max_speed=table.number("max_speed_mm_s", positive=True) * MM,
        acceleration=table.number("acceleration_mm_s2", positive=True) * MM,
        jerk=table.number("jerk_mm_s3", positive=True) * MM,
        rotation_speed=table.number("rotation_speed_deg_s", positive=True) * DEG,
        rotation_acceleration=table.number("rotation_acceleration_deg_s2", positive=True) * DEG,
        rotation_jerk=table.number("rotation_jerk_deg_s3", positive=True) * DEG,
    )
    if limits.default_speed > limits.max_speed:
        table.fail("RBL605", "'path.default_speed_mm_s' is above 'path.max_speed_mm_s'", key="default_speed_mm_s")
    table.done()
    return limits


def _chain(
    tables: list[Table], geometry: Geometry
) -> tuple[tuple[AxisSpec, ...], tuple[Body, ...], tuple[Correction, ...]]:
    """Return the axes, their bodies as published and the corrections of these."""
    axes: list[AxisSpec] = []
    published: list[Body] = []
    corrections: list[Correction] = []
    names: set[str] = set()
    for index, (table, placement, X_joint_body) in enumerate(
        zip(tables, geometry.placements, geometry.X_joint_body, strict=True)
    ):
        axis = AxisSpec(
            name=_unique(table, names),
            placement=frozen(placement),
            body=_body(table, X_joint_body),
            motor=motor(table.table("motor")),
            limits=limits(table),
            bandwidths=bandwidths(table.table("servo")),
        )
        correction = table.table("correction") if "correction" in table else None
        table.done()
        axes.append(axis)
        published.append(axis.body)
        if correction is not None:
            corrections.append(correct(correction, axes, index))
    check_bodies(tables, axes)
    return tuple(axes), tuple(published), tuple(corrections)


def _unique(table: Table, names: set[str]) -> str:
    name = table.text("name")
    if name in names:
        table.fail("RBL610", f"two axes are named '{name}'", key="name")
    names.add(name)
    return name


def _body(table: Table, X_joint_body: Array) -> Body:
    mass = table.number("mass_kg", low=0.0, high=10000.0)
    cog = np.array(table.numbers("cog_m", 3, low=-10.0, high=10.0))
    values = table.numbers("inertia_kg_m2", None, low=-1e5, high=1e5)
    if len(values) not in (3, 6):
        table.fail("RBL613", f"'{table.name('inertia_kg_m2')}' needs xx, yy, zz or xx, yy, zz, xy, xz, yz",
                   key="inertia_kg_m2")  # fmt: skip
    R = X_joint_body[:3, :3]
    inertia = matmul(R, inertia_matrix(values), R.T)
    return Body(mass=mass, cog=frozen(matmul(R, cog) + X_joint_body[:3, 3]), inertia=frozen(inertia))


def inertia_matrix(values: tuple[float, ...]) -> Array:
    """Return the 3x3 matrix of (xx, yy, zz[, xy, xz, yz]); the products are the matrix entries themselves."""
    xx, yy, zz, xy, xz, yz = (*values, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def motor(table: Table) -> Motor:
    """Read ``[axes.motor]``, motor side; ``FileFault`` RBL60x."""
    ratio = table.number("gear_ratio", low=-10000.0, high=10000.0)
    if not abs(ratio) >= 1e-3:
        table.fail("RBL605", f"'{table.name('gear_ratio')}' is {ratio:g} and must not be zero", key="gear_ratio")
    forward, backward = table.numbers("coulomb_friction_nm", 2, low=0.0)
    elastic = "joint_stiffness_nm_rad" in table or "joint_damping_nm_s_rad" in table
    motor = Motor(
        gear_ratio=ratio,
        rotor_inertia=table.number("rotor_inertia_kg_m2", low=0.0),
        torque_constant=table.number("torque_constant_nm_a", positive=True),
        max_current=table.number("max_current_a", positive=True),
        viscous_friction=table.number("viscous_friction_nm_s", low=0.0),
        coulomb_friction=(forward, backward),
        encoder_counts=table.integer("encoder_counts", low=4, high=2**30),
        current_bandwidth=table.number("current_bandwidth_hz", positive=True) * 2.0 * math.pi,
        stiffness=table.number("joint_stiffness_nm_rad", positive=True, high=STIFFEST) if elastic else math.inf,
        damping=table.number("joint_damping_nm_s_rad", low=0.0) if elastic else 0.0,
    )
    _check_spring(table, motor)
    table.done()
    return motor


def _check_spring(table: Table, motor: Motor) -> None:
    """Refuse a spring without a mass on the motor's side, or one that swings too fast to be simulated."""
    if not motor.elastic:
        return
    if not motor.rotor_inertia > 0.0:
        table.fail("RBL605", f"'{table.name('rotor_inertia_kg_m2')}' is 0, and the spring of the gear needs a rotor",
                   key="rotor_inertia_kg_m2")  # fmt: skip
    if not motor.stiffness <= motor.reflected_inertia * FASTEST_SPRING**2:
        table.fail("RBL605", f"the spring of {motor.stiffness:g} N m/rad swings the rotor too fast to be simulated",
                   "a gear as stiff as that is rigid: leave out joint_stiffness_nm_rad and joint_damping_nm_s_rad",
                   key="joint_stiffness_nm_rad")  # fmt: skip


def limits(table: Table) -> Limits:
    """Read the range, speed, acceleration and torque of an axis in deg and N m; ``FileFault`` RBL60x."""
    lower, upper = table.numbers("range_deg", 2, low=-WIDEST / DEG, high=WIDEST / DEG)
    if not lower < upper:
        table.fail("RBL607", f"'{table.name('range_deg')}' goes from {lower:g} to {upper:g}", key="range_deg")
    return Limits(
        lower=lower * DEG,
        upper=upper * DEG,
        speed=table.number("max_speed_deg_s", positive=True) * DEG,
        acceleration=table.number("max_acceleration_deg_s2", positive=True) * DEG,
        torque=table.number("max_torque_nm", positive=True),
        rated_moment=_optional(table, "rated_moment_nm"),
        rated_inertia=_optional(table, "rated_inertia_kg_m2"),
    )


def _optional(table: Table, key: str) -> float | None:
    """Return a number above 0, None where the file has none."""
    table.ask(key)
    return table.number(key, positive=True) if key in table else None


def bandwidths(table: Table) -> Bandwidths:
    """Read ``[axes.servo]``, 1/s; ``FileFault`` RBL60x."""
    bandwidths = Bandwidths(
        position=table.number("position_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
        velocity=table.number("velocity_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
    )
    table.done()
    return bandwidths


def _check_opw(spec: RobotSpec, table: Table) -> None:
    """Refuse closed-form parameters that describe another arm than the table of axes (RBL615)."""
    if spec.opw is None:
        return
    from runtime.robot import opw  # needs RobotSpec only; imported here because opw imports this package's spec

    if spec.n != 6:
        table.fail("RBL615", f"the closed form is for 6 axes, not {spec.n}", key="kinematics")
    error = opw.mismatch(spec)
    if not error < 1e-9:
        table.fail("RBL615", f"the closed form and the table of axes differ by {error * 1000:.6f} mm", key="kinematics")
