"""The compensation file ``NAME.compensation.toml``: what identification found beyond the model, axis by axis.

    J_total,i = D_i / N_i^2 + Jc_i            kg m2 at the motor end (document 003, EFORT, 3.5: S3 and S4)

Jc is the identified inertia minus that of the model's links, so it holds the rotor, the gear and whatever the model
misses. It takes the place of the rotor inertia J in D' = D + N^2 J of eqs (9) and (10); the two are never added
(docs/identification.md). One scalar per axis: D_ii does not depend on the axis' own angle, so neither does Jc.

::

    schema = 1
    robot = "puma560"
    date = "2026-11-24"                 # optional
    positions = 5
    [payload]                           # what the arm carried and was declared
    mass_kg = 0.0
    cog_mm = [0.0, 0.0, 0.0]
    [[axes]]                            # one for each axis, from J1
    compensation_kg_m2 = 2.1e-4         # Jc; all figures at the motor
    spread_kg_m2 = 1e-8                 # largest minus smallest over the positions; this and the two below are
    model_kg_m2 = 4.2e-4                # left out of an axis that was not identified, whose Jc is the rotor's J
    identified_kg_m2 = 6.3e-4

Every error is a ``FileFault`` at its line. Read once, before anything moves.
"""

import datetime
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from runtime.dynamics.equations import inertia_range
from runtime.faults import Fault
from runtime.frames import Array
from runtime.robot.model import spec_rotors
from runtime.robot.payload import NO_PAYLOAD, Payload, declared
from runtime.robot.spec import RobotSpec
from runtime.tomlfile import Table, load_table, read_source
from runtime.units import MM

SCHEMA = 1
MOST_POSITIONS = 1000
MOST = 10.0
"""Largest N^2 Jc that is believed, in terms of the largest D + N^2 J of the axis."""
_POSTURES = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisCompensation:
    """One axis, kg m2 at the motor: ``compensation`` Jc; None where the axis was not identified."""

    compensation: float
    spread: float | None = None
    model: float | None = None
    identified: float | None = None


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


def load_compensation(path: Path, spec: RobotSpec) -> Compensation:
    """Read the compensation file of a robot; ``FileFault`` RBL6xx or RBL40x at the line that is wrong."""
    table = load_table(read_source(path))
    _schema(table)
    robot = table.text("robot")
    if robot != spec.name:
        table.fail("RBL617", f"the compensation is that of '{robot}'; this robot is {spec.name}", key="robot")
    axes = table.tables("axes")
    if len(axes) != spec.n:
        table.fail("RBL613", f"'axes' has {len(axes)} entries; {spec.name} has {spec.n} axes", key="axes")
    found = Compensation(
        robot=robot,
        date=_date(table),
        positions=table.integer("positions", low=1, high=MOST_POSITIONS),
        payload=_payload(table.table("payload"), spec),
        axes=tuple(_axis(item) for item in axes),
    )
    table.done()
    _believe(found, spec, axes)
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
    return "\n".join(lines) + "\n"


def _schema(table: Table) -> None:
    schema = table.number("schema")
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
    try:
        return declared(mass, cog, max(mass, spec.rated_payload))
    except Fault as fault:
        table.fail(fault.code, fault.message, fault.hint, key="cog_mm")


def _axis(table: Table) -> AxisCompensation:
    compensation = table.number("compensation_kg_m2")
    if not any(f"{name}_kg_m2" in table for name in ("spread", "model", "identified")):
        table.done()
        return AxisCompensation(compensation=compensation)
    spread = table.number("spread_kg_m2", low=0.0)
    model, identified = (table.number(f"{name}_kg_m2", positive=True) for name in ("model", "identified"))
    table.done()
    return AxisCompensation(compensation=compensation, spread=spread, model=model, identified=identified)


def _believe(found: Compensation, spec: RobotSpec, axes: list[Table]) -> None:
    """Refuse a Jc with which the inertia in the gains is not positive, or beyond anything the axis can have."""
    rotors = found.rotors(spec)
    smallest, largest = inertia_range(spec, postures=_POSTURES)
    most = MOST * (largest + spec_rotors(spec))
    for axis, table in enumerate(axes):
        total = float(smallest[axis] + rotors[axis])
        if not (total > 0.0 and rotors[axis] <= most[axis]):
            why = (f"more than {MOST:g} times what J{axis + 1} has" if total > 0.0
                   else f"which leaves J{axis + 1} {total:.3g} kg m2 at the joint where it is lightest")  # fmt: skip
            table.fail("RBL605", f"'compensation_kg_m2' of J{axis + 1} is {found.axes[axis].compensation:.4g}, {why}",
                       key="compensation_kg_m2")  # fmt: skip


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')
