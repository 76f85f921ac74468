"""Published bodies that no body can have, and the smallest change that makes them possible without changing the motion.

A rigid body has a positive mass, positive principal moments, and none above the sum of the other two. Identified
parameters often break that: only what moves the joints can be identified. MuJoCo refuses such bodies. A robot file
may therefore state a correction of three kinds, none larger than it must be (docs/dynamics.md):

* ``inertia_shift_kg_m2`` s moves ``S = s (E - z z')`` across the joint from the link before it (z: the joint axis). S
  is the same tensor seen from either link and vanishes along the axis, so no equation of motion changes.
* ``added_mass_kg`` gives a body published without mass at most a milligram.
* ``added_inertia_kg_m2`` gives a body published as a point mass, with no moments about its own centre, the moments of
  a grain of dust: at most 1e-12 kg m2 about every axis, which rounding hides in every sum it enters.
"""

import math
from dataclasses import replace

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.rounding import beside
from runtime.core.tomlfile import Table
from runtime.robot.files.robot_file import CorrectionRow
from runtime.robot.model.spec import AxisSpec, Body, Correction, inertia_defect, shift_between_links

SLACK = 1e-9
"""A correction may exceed the smallest possible one by this much, kg m2."""

TOKEN_MASS = 1e-6
"""The mass that a correction may give to a body published without one, kg: a milligram moves nothing."""

TOKEN_INERTIA = 1e-12
"""The moments that a correction may give to a body published as a point, kg m2."""


def correct(row: CorrectionRow, axes: list[AxisSpec], index: int) -> Correction:
    """Apply the correction of the last axis in ``axes``; ``FileFault`` RBL606 for one needless or too large."""
    shift, mass, moments = row.inertia_shift, row.added_mass, row.added_inertia
    axis = axes[index]
    correction = Correction(axis=index, inertia_shift=shift, added_mass=mass, added_inertia=moments, reason=row.reason)
    _check_need(row.table, axis.body, correction)
    # the first link takes its shift from the base, which does not move and has no inertia that counts
    before = axes[index - 1].body if index else axis.body
    own, other = shift_between_links(axis, before, shift)
    axes[index] = replace(axis, body=_body(own.mass + mass, own.cog, own.inertia + moments * np.eye(3)))
    if index:
        axes[index - 1] = replace(axes[index - 1], body=_body(other.mass, other.cog, other.inertia))
    return correction


def _check_need(table: Table, published: Body, correction: Correction) -> None:
    """Refuse a correction that is more than the published body needs; ``FileFault`` RBL606."""
    name = f"J{correction.axis + 1}"
    _check_shift(table, published, correction.inertia_shift, name)
    _check_mass(table, published, correction.added_mass, name)
    _check_moments(table, published, correction, name)
    if correction.inertia_shift == 0.0 and correction.added_mass == 0.0 and correction.added_inertia == 0.0:
        table.fail("RBL606", f"{name} needs no correction, or not this one", "remove [axes.correction]")


def _check_shift(table: Table, published: Body, shift: float, name: str) -> None:
    needed = smallest_shift(published.inertia) or 0.0
    if not shift <= needed + SLACK:
        table.fail(
            "RBL606",
            f"the shift of {shift:g} kg m2 is larger than the {needed:.12g} that {name} needs",
            f"write inertia_shift_kg_m2 = {needed:.12g}",
            key="inertia_shift_kg_m2",
        )


def _check_mass(table: Table, published: Body, mass: float, name: str) -> None:
    if mass > 0.0 and published.mass > 0.0:
        table.fail("RBL606", f"{name} has a mass already", "write added_mass_kg = 0", key="added_mass_kg")
    if mass > TOKEN_MASS:
        added, token = beside(mass, TOKEN_MASS)
        table.fail(
            "RBL606",
            f"an added mass of {added} kg is more than the {token} that a body needs",
            "if the mass is known, write it as mass_kg with its source",
            key="added_mass_kg",
        )


def _check_moments(table: Table, published: Body, correction: Correction, name: str) -> None:
    # judged after the shift, which may already give a rod the moments that it lacks
    moments = correction.added_inertia
    if moments > 0.0 and not flat(shifted(published.inertia, correction.inertia_shift)):
        table.fail(
            "RBL606",
            f"{name} has moments about every axis already",
            "remove added_inertia_kg_m2",
            key="added_inertia_kg_m2",
        )
    if moments > TOKEN_INERTIA:
        added, token = beside(moments, TOKEN_INERTIA)
        table.fail(
            "RBL606",
            f"{added} kg m2 are more than the {token} that a body needs",
            "if the inertia is known, write it as inertia_kg_m2 with its source",
            key="added_inertia_kg_m2",
        )


def inertia_text(defect: float) -> str:
    """Return what is wrong with an inertia of which ``defect`` kg m2 are missing (``inertia_defect``)."""
    if not math.isfinite(defect):
        return "is not finite"
    return (
        f"is not physically possible: the largest principal moment exceeds the sum of the other two by {defect:g} kg m2"
    )


def flat(inertia: Array) -> bool:
    """Return whether an inertia (3, 3) has no moment about some axis: a point or a rod without thickness."""
    return not float(np.linalg.eigvalsh(inertia)[0]) > 0.5 * TOKEN_INERTIA


def _body(mass: float, cog: Array, inertia: Array) -> Body:
    return Body(mass=mass, cog=cog, inertia=frozen(inertia))


def shifted(inertia: Array, shift: float) -> Array:
    """Return an inertia (3, 3) with a shift, kg m2, across the joint."""
    return np.asarray(inertia + shift * np.diag([1.0, 1.0, 0.0]))


def smallest_shift(inertia: Array) -> float | None:
    """Return the least shift (kg m2) across the joint that makes an inertia a body's; None when none does.

    The defect never grows with the shift s, which is added about two of the three axes: it is the larger of
    ``2 max - trace``, and max grows by at most s while the trace grows by 2 s, and of ``-min``. So bisection finds it.
    """

    # 1e-3 of the slack: the number is rounded afterwards, and must still mend the body
    def mended(shift: float) -> bool:
        return inertia_defect(shifted(inertia, shift)) <= 1e-3 * SLACK

    low, high = 0.0, 4.0 * float(np.abs(inertia).sum())
    if mended(low):
        return 0.0
    if not mended(high):
        return None
    for _ in range(60):  # to the last bit of a double
        middle = 0.5 * (low + high)
        low, high = (low, middle) if mended(middle) else (middle, high)
    return round(high, 10)  # a number to be copied by hand; the slack covers the rounding


def check_bodies(tables: list[Table], axes: list[AxisSpec]) -> None:
    """Refuse a robot with an impossible body, naming the correction that mends it; ``FileFault`` RBL606."""
    for index, (table, axis) in enumerate(zip(tables, axes, strict=True)):
        defect = inertia_defect(axis.body.inertia)
        if not defect <= SLACK:
            table.fail(
                "RBL606",
                f"the inertia of J{index + 1} {inertia_text(defect)}",
                _inertia_hint(axis.body.inertia),
                key="inertia_kg_m2",
            )
        if not axis.body.mass > 0.0:
            hint = f"state [axes.correction] with added_mass_kg = {TOKEN_MASS:g}, inertia_shift_kg_m2 = 0 and a reason"
            table.fail("RBL606", f"J{index + 1} has no mass", hint, key="mass_kg")
        if flat(axis.body.inertia):
            hint = f"state [axes.correction] with added_inertia_kg_m2 = {TOKEN_INERTIA:g}, or the moments it really has"
            table.fail("RBL606", f"J{index + 1} has no inertia about some axis", hint, key="inertia_kg_m2")


def _inertia_hint(inertia: Array) -> str:
    shift = smallest_shift(inertia)
    if shift is None:
        return "no shift of inertia across the joint can mend that; check the order xx, yy, zz and the signs"
    point = f", added_inertia_kg_m2 = {TOKEN_INERTIA:g}" if flat(shifted(inertia, shift)) else ""
    return f"state [axes.correction] with inertia_shift_kg_m2 = {shift:.12g}, added_mass_kg = 0{point} and a reason"
