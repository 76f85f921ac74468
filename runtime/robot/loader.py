"""Reading a robot file into a ``RobotSpec``: every key known, every limit present, every body possible.

Nothing is guessed: a missing limit is an error that names the axis and the key, and so is a key nobody reads.
Published body data that no body can have (zero mass, a broken triangle inequality) are refused unless the file
states a ``correction``; the smallest one that works is named in the message. A correction moves inertia across a
joint in a way that leaves the equations of motion unchanged (``spec.shift_between_links``).
"""

import math
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np

from runtime.frames import Array, frozen
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
    dh_transform,
    inertia_defect,
    shift_between_links,
)
from runtime.tomlfile import Source, Table, load_table, read_source
from runtime.units import DEG, MM

SCHEMA = 1
SLACK = 1e-9
"""A correction may exceed the smallest possible one by this much, kg m2."""

TOKEN_MASS = 1e-6
"""The mass that a correction may give to a body published without one, kg: a milligram moves nothing."""

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
    kinematics.text("form", choices=("dh",))
    opw = _opw(kinematics.table("opw")) if "opw" in kinematics else None
    kinematics.done()
    path = _path_limits(table.table("path"))
    axis_tables = table.tables("axes")
    if not 1 <= len(axis_tables) <= 7:
        table.fail("RBL605", f"a robot has 1 to 7 axes, not {len(axis_tables)}", key="axes")
    axes, published, corrections, X_last_flange = _chain(axis_tables)
    spec = RobotSpec(
        name=name,
        title=title,
        sources=_texts(table, "sources"),
        notes=_texts(table, "notes"),
        rated_payload=table.number("rated_payload_kg", low=0.0, high=5000.0),
        axes=axes,
        X_last_flange=frozen(X_last_flange),
        path=path,
        opw=opw,
        corrections=corrections,
        published=published,
    )
    table.done()
    _check_opw(spec, table)
    return spec


def _texts(table: Table, key: str) -> tuple[str, ...]:
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


def _path_limits(table: Table) -> PathLimits:
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
    tables: list[Table],
) -> tuple[tuple[AxisSpec, ...], tuple[Body, ...], tuple[Correction, ...], Array]:
    """Walk the DH rows: returns the axes, their bodies as published, the corrections and the flange placement."""
    axes: list[AxisSpec] = []
    published: list[Body] = []
    corrections: list[Correction] = []
    names: set[str] = set()
    placement = np.eye(4)
    for index, table in enumerate(tables):
        X_joint_dh = dh_transform(
            table.number("d_m", low=-10.0, high=10.0),
            table.number("a_m", low=-10.0, high=10.0),
            table.number("alpha_deg", low=-360.0, high=360.0) * DEG,
        )
        placement = placement @ _turn(table.number("theta_offset_deg", 0.0, low=-360.0, high=360.0) * DEG)
        axis = AxisSpec(
            name=_unique(table, names),
            placement=frozen(placement),
            body=_body(table, X_joint_dh),
            motor=_motor(table.table("motor")),
            limits=_limits(table),
            bandwidths=_bandwidths(table.table("servo")),
        )
        correction = table.table("correction") if "correction" in table else None
        table.done()
        axes.append(axis)
        published.append(axis.body)
        if correction is not None:
            corrections.append(_correct(correction, axes, index))
        placement = X_joint_dh
    _check_bodies(tables, axes)
    return tuple(axes), tuple(published), tuple(corrections), placement


def _turn(angle: float) -> Array:
    X = np.eye(4)
    X[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    return X


def _unique(table: Table, names: set[str]) -> str:
    name = table.text("name")
    if name in names:
        table.fail("RBL610", f"two axes are named '{name}'", key="name")
    names.add(name)
    return name


def _body(table: Table, X_joint_dh: Array) -> Body:
    mass = table.number("mass_kg", low=0.0, high=10000.0)
    cog = np.array(table.numbers("cog_m", 3, low=-10.0, high=10.0))
    values = table.numbers("inertia_kg_m2", None, low=-1e5, high=1e5)
    if len(values) not in (3, 6):
        table.fail("RBL613", f"'{table.name('inertia_kg_m2')}' needs xx, yy, zz or xx, yy, zz, xy, xz, yz",
                   key="inertia_kg_m2")  # fmt: skip
    R = X_joint_dh[:3, :3]
    inertia = R @ inertia_matrix(values) @ R.T
    return Body(mass=mass, cog=frozen(R @ cog + X_joint_dh[:3, 3]), inertia=frozen(inertia))


def inertia_matrix(values: tuple[float, ...]) -> Array:
    """Return the 3x3 matrix of (xx, yy, zz[, xy, xz, yz]); the products are the matrix entries themselves."""
    xx, yy, zz, xy, xz, yz = (*values, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _motor(table: Table) -> Motor:
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
        stiffness=table.number("joint_stiffness_nm_rad", positive=True) if elastic else math.inf,
        damping=table.number("joint_damping_nm_s_rad", low=0.0) if elastic else 0.0,
    )
    table.done()
    return motor


def _limits(table: Table) -> Limits:
    lower, upper = table.numbers("range_deg", 2, low=-3600.0, high=3600.0)
    if not lower < upper:
        table.fail("RBL607", f"'{table.name('range_deg')}' goes from {lower:g} to {upper:g}", key="range_deg")
    return Limits(
        lower=lower * DEG,
        upper=upper * DEG,
        speed=table.number("max_speed_deg_s", positive=True) * DEG,
        acceleration=table.number("max_acceleration_deg_s2", positive=True) * DEG,
        torque=table.number("max_torque_nm", positive=True),
    )


def _bandwidths(table: Table) -> Bandwidths:
    bandwidths = Bandwidths(
        position=table.number("position_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
        velocity=table.number("velocity_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
    )
    table.done()
    return bandwidths


def _correct(table: Table, axes: list[AxisSpec], index: int) -> Correction:
    """Apply the correction of the last axis in ``axes``; refuse one that is needless or larger than needed."""
    shift = table.number("inertia_shift_kg_m2", low=0.0)
    mass = table.number("added_mass_kg", low=0.0)
    reason = table.text("reason")
    table.done()
    axis = axes[index]
    published = axis.body
    needed = _smallest_shift(published.inertia) or 0.0
    if shift > needed + SLACK:
        table.fail("RBL606", f"the shift of {shift:g} kg m2 is larger than the {needed:.12g} that J{index + 1} needs",
                   f"write inertia_shift_kg_m2 = {needed:.12g}", key="inertia_shift_kg_m2")  # fmt: skip
    if mass > 0.0 and published.mass > 0.0:
        table.fail("RBL606", f"J{index + 1} has a mass already", "write added_mass_kg = 0", key="added_mass_kg")
    if mass > TOKEN_MASS:
        table.fail("RBL606", f"an added mass of {mass:g} kg is more than the {TOKEN_MASS:g} that a body needs",
                   "if the mass is known, write it as mass_kg with its source", key="added_mass_kg")  # fmt: skip
    if shift == 0.0 and mass == 0.0:
        table.fail("RBL606", f"J{index + 1} needs no correction, or not this one", "remove [axes.correction]")
    before = axes[index - 1].body if index else published
    own, other = shift_between_links(axis, before, shift)
    own = Body(mass=own.mass + mass, cog=own.cog, inertia=frozen(own.inertia))
    axes[index] = _with_body(axis, own)
    if index:  # the base takes what the first link gives, without a trace: it does not move
        axes[index - 1] = _with_body(
            axes[index - 1], Body(mass=other.mass, cog=other.cog, inertia=frozen(other.inertia))
        )
    return Correction(axis=index, inertia_shift=shift, added_mass=mass, reason=reason)


def _with_body(axis: AxisSpec, body: Body) -> AxisSpec:
    return AxisSpec(
        name=axis.name,
        placement=axis.placement,
        body=body,
        motor=axis.motor,
        limits=axis.limits,
        bandwidths=axis.bandwidths,
    )


def _smallest_shift(inertia: Array) -> float | None:
    """Return the least shift (kg m2) across the joint that makes an inertia a body's; None when none does.

    The defect never grows with the shift s, which is added about two of the three axes: it is the larger of
    ``2 max - trace``, and max grows by at most s while the trace grows by 2 s, and of ``-min``. So bisection finds it.
    """

    def mended(shift: float) -> bool:
        return inertia_defect(inertia + shift * np.diag([1.0, 1.0, 0.0])) <= 1e-3 * SLACK

    low, high = 0.0, 4.0 * float(np.abs(inertia).sum())
    if mended(low):
        return 0.0
    if not mended(high):
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if mended(middle) else (middle, high)
    return round(high, 10)  # a number that people copy; the slack covers the rest


def _check_bodies(tables: list[Table], axes: list[AxisSpec]) -> None:
    for index, (table, axis) in enumerate(zip(tables, axes, strict=True)):
        defect = inertia_defect(axis.body.inertia)
        if defect > SLACK:
            table.fail(
                "RBL606",
                f"the inertia of J{index + 1} is not a body's: {defect:g} kg m2 are missing",
                _inertia_hint(axis.body.inertia),
                key="inertia_kg_m2",
            )
        if not axis.body.mass > 0.0:
            hint = f"state [axes.correction] with added_mass_kg = {TOKEN_MASS:g}, inertia_shift_kg_m2 = 0 and a reason"
            table.fail("RBL606", f"J{index + 1} has no mass", hint, key="mass_kg")


def _inertia_hint(inertia: Array) -> str:
    shift = _smallest_shift(inertia)
    if shift is None:
        return "no shift of inertia across the joint can mend that; check the order xx, yy, zz and the signs"
    return f"state [axes.correction] with inertia_shift_kg_m2 = {shift:.12g}, added_mass_kg = 0 and a reason"


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
