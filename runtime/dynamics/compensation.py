"""The compensation file ``NAME.compensation.toml``: the inertia that identification found beyond the model, by axis.

    J_total,i = D_i / N_i^2 + Jc_i            kg m2 at the motor end (document 003, EFORT, 3.5: S3 and S4)

Jc is the identified inertia minus that of the model's links, so it includes the rotor, the gear and all that the model
lacks. It takes the place of the rotor inertia J in D' = D + N^2 J of eqs (9) and (10); the two are never added
(docs/identification.md). One scalar per axis: D_ii does not depend on the axis' own angle, so neither does Jc. It may
depend on the joints beyond the axis, as a table over one or two of them. The first moment that a link has beyond the
model is given with it: the weight that the same passes showed (``first_moments``).

::

    schema = 1
    robot = "puma560"
    date = "2026-11-24"                 # optional
    positions = 5
    [payload]                           # carried by the arm, and declared
    mass_kg = 0.0
    cog_mm = [0.0, 0.0, 0.0]
    [[axes]]                            # one for each axis, from J1
    compensation_kg_m2 = 2.1e-4         # Jc; all figures at the motor
    spread_kg_m2 = 1e-8                 # largest minus smallest over the positions; this and the two below are
    model_kg_m2 = 4.2e-4                # left out of an axis that was not identified, whose Jc is the rotor's J
    identified_kg_m2 = 6.3e-4
    table_joints = [2, 3]               # optional, all three: joints beyond the axis, one or two,
    table_deg = [[-90, 0], [0, 45, 90]] # their angles, rising,
    table_kg_m2 = [1e-4, ...]           # and Jc over them, the angle of the last joint first
    first_moment_kg_m = [0.2, 0.0, 0.0] # optional: of the link beyond the model, in its own frame

Every error is a ``FileFault`` at its line. Read once, before anything moves.
"""

import datetime
from dataclasses import dataclass, field, replace
from itertools import pairwise, product
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import norm
from runtime.core.rounding import beside
from runtime.core.tomlfile import Table, load_table, read_source
from runtime.core.units import DEG, MM
from runtime.dynamics.equations import axis_inertia, inertia_range
from runtime.dynamics.first_moments import scale
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.payload import NO_PAYLOAD, Payload, declared
from runtime.robot.model.spec import RobotSpec

SCHEMA = 1
MOST_POSITIONS = 1000
MOST = 10.0
"""Largest N^2 Jc that is accepted, in terms of the largest D + N^2 J of the axis."""
MOST_JOINTS, MOST_ANGLES = 2, 50
"""Size of the largest table that is read."""
FURTHEST = 3600.0
"""Largest angle of a table, deg."""
FAR = 0.3
"""Distance at which the rated payload may have been left out of the model, m."""
_POSTURES = 200
"""Postures that bound D of an axis; a bound of 10 times does not need the 2000 of ``inertia_range``."""
_FEW = 20
"""Postures of the other joints at each point of a table, which may have 2500 points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisCompensation:
    """One axis, kg m2 at the motor: ``compensation`` Jc; None where the axis was not identified.

    ``table``: Jc over joints beyond the axis, where it is known; ``compensation`` is its mean then. ``first_moment``:
    that of the link beyond the model, kg m in its frame; empty where it was not identified.
    """

    compensation: float
    spread: float | None = None
    model: float | None = None
    identified: float | None = None
    table: JointTable | None = None
    first_moment: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Compensation:
    """Compensations of all axes of ``robot``, found with ``payload`` at ``positions`` places of each axis."""

    robot: str
    positions: int
    axes: tuple[AxisCompensation, ...]
    payload: Payload = field(default=NO_PAYLOAD)
    date: str = ""

    def rotors(self, spec: RobotSpec) -> Array:
        """Return N^2 Jc of every axis (n,), kg m2 at the joint: it is added to D in place of N^2 J."""
        return np.array([a.compensation for a in self.axes]) * spec.per_axis("motor", "gear_ratio") ** 2

    @property
    def first_moments(self) -> tuple[tuple[float, ...], ...]:
        """First moment of each link beyond the model, kg m in its frame; () where none was identified."""
        if not any(axis.first_moment for axis in self.axes):
            return ()
        return tuple(axis.first_moment or (0.0, 0.0, 0.0) for axis in self.axes)

    def at(self, spec: RobotSpec, q: Array) -> Array:
        """Return N^2 Jc of every axis (n,) at joint angles q (n,) rad, kg m2 at the joint."""
        found = self.rotors(spec)
        for axis, table in enumerate(self.rotor_tables(spec)):
            found[axis] += 0.0 if table is None else table.at(q)
        return found

    def rotor_tables(self, spec: RobotSpec) -> tuple[JointTable | None, ...]:
        """Return N^2 (Jc(q) - Jc) of every axis, kg m2 at the joint, to be added to ``rotors``; () without tables."""
        if all(axis.table is None for axis in self.axes):
            return ()
        squared = (spec.per_axis("motor", "gear_ratio") ** 2).tolist()
        return tuple(
            axis.table and replace(axis.table, values=tuple(N2 * (Jc - axis.compensation) for Jc in axis.table.values))
            for N2, axis in zip(squared, self.axes, strict=True)
        )


def load_compensation(path: Path, spec: RobotSpec) -> Compensation:
    """Read the compensation file of a robot; ``FileFault`` RBL6xx or RBL40x at the line that is wrong."""
    table = load_table(read_source(path))
    _schema(table)
    robot = table.text("robot")
    # by name: the same numbers on another arm would be accepted by every other check
    if robot != spec.name:
        table.fail("RBL617", f"the compensation is that of '{robot}'; this robot is {spec.name}", key="robot")
    axes = table.tables("axes")
    if len(axes) != spec.n:
        table.fail("RBL613", f"'axes' has {len(axes)} entries; {spec.name} has {spec.n} axes", key="axes")
    # the checks against the arm come last, when every value is one of its kind
    found = Compensation(
        robot=robot,
        date=_date(table),
        positions=table.integer("positions", low=1, high=MOST_POSITIONS),
        payload=_payload(table.table("payload"), spec),
        axes=tuple(_axis(item, axis, spec.n) for axis, item in enumerate(axes)),
    )
    table.done()
    _check_inertias(found, spec, axes)
    _check_moments(found, spec, axes)
    return found


def as_toml(found: Compensation) -> str:
    """Return the text of a compensation file, numbers in full; ``load_compensation`` reads the same values back."""
    lines = [f"schema = {SCHEMA}", f'robot = "{_escaped(found.robot)}"']
    lines += [f'date = "{found.date}"'] if found.date else []
    lines += [f"positions = {found.positions}", "", "[payload]", f"mass_kg = {float(found.payload.mass)!r}"]
    lines += [f"cog_mm = [{', '.join(repr(float(x / MM)) for x in found.payload.cog)}]"]
    for number, axis in enumerate(found.axes, start=1):
        why = "" if axis.identified is not None else ", not identified: the rotor of the robot file"
        lines += ["", f"[[axes]]  # J{number}{why}"]
        for name in ("compensation", "spread", "model", "identified"):
            value = getattr(axis, name)
            lines += [] if value is None else [f"{name}_kg_m2 = {float(value)!r}"]
        lines += [] if axis.table is None else _table_lines(axis.table)
        moment = ", ".join(repr(float(h)) for h in axis.first_moment)
        lines += [f"first_moment_kg_m = [{moment}]"] if moment else []
    return "\n".join(lines) + "\n"


def _table_lines(table: JointTable) -> list[str]:
    """Return the lines of a table, one line of values for each angle of the first joint; angles to 1e-9 deg."""
    # rounded angles: 45 deg in rad and back is 45.00000000000001, which nobody would type
    angles = ", ".join(f"[{', '.join(repr(round(angle / DEG, 9)) for angle in grid)}]" for grid in table.grid)
    size = len(table.values) // len(table.grid[0])
    rows = [table.values[k : k + size] for k in range(0, len(table.values), size)]
    return [
        f"table_joints = [{', '.join(str(joint + 1) for joint in table.joints)}]",
        f"table_deg = [{angles}]",
        "table_kg_m2 = [",
        *(f"  {', '.join(repr(float(Jc)) for Jc in row)}," for row in rows),
        "]",
    ]


def _schema(table: Table) -> None:
    schema = table.number("schema")
    # not by range, as elsewhere: a file of a newer program needs another message than a typing error
    if schema != SCHEMA:
        age = "newer" if schema > SCHEMA else "older"
        table.fail("RBL618", f"'schema' is {schema:g}, of {age} version; this one reads schema {SCHEMA}", key="schema")


def _date(table: Table) -> str:
    date = table.text("date", "")
    try:
        return datetime.date.fromisoformat(date).isoformat() if date else ""
    except ValueError:
        table.fail("RBL605", f"'date' is '{date[:40]}', not a day as in 2026-11-24", key="date")


def _payload(table: Table, spec: RobotSpec) -> Payload:
    mass = table.number("mass_kg", low=0.0)
    cog = np.array(table.numbers("cog_mm", 3)) * MM
    table.done()
    # the payload of the identification may be above the rated one: a test bench is no program
    try:
        return declared(mass, cog, max(mass, spec.rated_payload))
    except Fault as fault:
        table.fail(fault.code, fault.message, fault.hint, key="cog_mm")


def _axis(table: Table, axis: int, n: int) -> AxisCompensation:
    found = AxisCompensation(compensation=table.number("compensation_kg_m2"), table=_joint_table(table, axis, n))
    if any(f"{name}_kg_m2" in table for name in ("spread", "model", "identified")):
        spread = table.number("spread_kg_m2", low=0.0)
        model, identified = (table.number(f"{name}_kg_m2", positive=True) for name in ("model", "identified"))
        found = replace(found, spread=spread, model=model, identified=identified)
    if "first_moment_kg_m" in table:
        found = replace(found, first_moment=tuple(table.numbers("first_moment_kg_m", 3)))
    table.done()
    return found


def _joint_table(table: Table, axis: int, n: int) -> JointTable | None:
    """Read the table of axis ``axis`` (0-based) of ``n``, None where it has none."""
    if not any(f"table_{name}" in table for name in ("joints", "deg", "kg_m2")):
        return None
    joints = _table_joints(table, axis, n)
    grid = tuple(_angles(table, angles) for angles in table.raw_list("table_deg"))
    if len(grid) != len(joints):
        table.fail(
            "RBL613",
            f"'{table.name('table_deg')}' must have {len(joints)} lists of angles, one for each joint, not {len(grid)}",
            key="table_deg",
        )
    values = table.numbers("table_kg_m2", prod(len(angles) for angles in grid))
    return JointTable(joints=tuple(joint - 1 for joint in joints), grid=grid, values=values)


def _table_joints(table: Table, axis: int, n: int) -> tuple[int, ...]:
    """Return the joints (from 1) of the table of axis ``axis`` (0-based) of ``n``; ``FileFault`` RBL605 or RBL613.

    Beyond the axis and rising: D_ii depends on no other joint, and one order means one file for one table.
    """
    joints, name = table.numbers("table_joints", None), table.name("table_joints")
    if not 1 <= len(joints) <= MOST_JOINTS:
        table.fail("RBL613", f"'{name}' must name one or two joints", key="table_joints")
    if not all(joint in range(axis + 2, n + 1) for joint in joints) or not _rising(joints):
        beyond = f"joints beyond J{axis + 1}, up to J{n} and rising" if axis + 1 < n else "no joint: none is beyond it"
        table.fail("RBL605", f"'{name}' must name {beyond}", key="table_joints")
    return tuple(int(joint) for joint in joints)


def _angles(table: Table, angles: Any) -> tuple[float, ...]:
    """Return one list of ``table_deg``, rad."""
    key = "table_deg"
    found = Table(table.source, {key: angles}, table.keys).numbers(key, None, low=-FURTHEST, high=FURTHEST)
    if not 2 <= len(found) <= MOST_ANGLES:
        table.fail(
            "RBL613", f"a list of '{table.name(key)}' must have 2 to {MOST_ANGLES} angles, not {len(found)}", key=key
        )
    found = tuple(angle * DEG for angle in found)
    if not _rising(found):
        table.fail("RBL605", f"the angles of a list of '{table.name(key)}' must rise", key=key)
    return found


def _rising(values: tuple[float, ...]) -> bool:
    return all(before < after for before, after in pairwise(values))


def _check_inertias(found: Compensation, spec: RobotSpec, axes: list[Table]) -> None:
    """Refuse a Jc with which the inertia in the gains is not positive, or far beyond that of the axis; RBL605."""
    squared = spec.per_axis("motor", "gear_ratio") ** 2
    smallest, largest = inertia_range(spec, postures=_POSTURES)
    most = MOST * (largest + spec_rotors(spec))
    for axis, (entry, table) in enumerate(zip(found.axes, axes, strict=True)):
        # with the smallest D that the axis has there: a gain that is negative in one posture is unstable in it
        values = [("compensation_kg_m2", entry.compensation, float(smallest[axis]))]
        if entry.table is not None:
            at_points = _smallest_over(entry.table, spec, axis)
            values += [("table_kg_m2", Jc, D) for Jc, D in zip(entry.table.values, at_points, strict=True)]
        for key, Jc, D in values:
            # both conditions hold for numbers only: NaN is refused
            total = float(D + squared[axis] * Jc)
            if not (total > 0.0 and squared[axis] * Jc <= most[axis]):
                lightest = f"which leaves J{axis + 1} {total:.3g} kg m2 at the joint where it is lightest"
                why = f"more than {MOST:g} times the inertia of J{axis + 1}" if total > 0.0 else lightest
                verb = "has" if key == "table_kg_m2" else "is"
                table.fail("RBL605", f"'{key}' of J{axis + 1} {verb} {Jc:.4g}, {why}", key=key)


def _check_moments(found: Compensation, spec: RobotSpec, axes: list[Table]) -> None:
    """Refuse a first moment far beyond that of the link, RBL605."""
    most = MOST * (scale(spec) + FAR * spec.rated_payload)
    for axis, (moment, table) in enumerate(zip(found.first_moments, axes, strict=False)):
        size = norm(np.asarray(moment))
        if not size <= most[axis]:
            long, bound = beside(size, float(most[axis]), form=".4g")
            table.fail(
                "RBL605",
                f"'first_moment_kg_m' of J{axis + 1} is {long} long; at most {bound} is accepted for that link",
                key="first_moment_kg_m",
            )


def _smallest_over(table: JointTable, spec: RobotSpec, axis: int) -> list[float]:
    """Return the smallest D of the axis at each point of its table, the other joints in a few postures, kg m2."""
    # a fixed seed: the same file must be accepted or refused in every run
    model, found = ArmModel(spec), []
    samples = np.random.default_rng(560).uniform(spec.lower, spec.upper, (_FEW, spec.n))
    for angles in product(*table.grid):
        samples[:, table.joints] = angles
        found.append(float(np.min([axis_inertia(model, q, axis) for q in np.clip(samples, spec.lower, spec.upper)])))
    return found


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')
