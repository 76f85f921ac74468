"""The tables that ``robolang robot show`` prints: of a robot, and of a model file that has no drives."""

import math
from typing import TYPE_CHECKING, Any

from rich import box
from rich.table import Table

from robolang.core.diagnostics import safe
from runtime.robot.model.estimated import axis_key, mark

if TYPE_CHECKING:
    from runtime.robot.files.imported import ImportedArm
    from runtime.robot.model.spec import Body, Correction, RobotSpec


class _Marked:
    """Numbers of an axis (0-based) as the tables have them, ``~`` before those that are estimates."""

    def __init__(self, spec: "RobotSpec", axis: int) -> None:
        self._estimated, self._axis = spec.estimated, axis

    def __call__(self, key: str, value: float | str) -> str:
        text = value if isinstance(value, str) else f"{value:g}"
        return f"{mark(self._estimated, axis_key(self._axis, key))}{text}"


def estimates(spec: "RobotSpec") -> list[str]:
    """Return what is estimated and by which rules, axes that share a rule together."""
    found: dict[tuple[str, str], list[str]] = {}
    for name, rule in spec.estimated.items():
        axis, key = _split(name)
        found.setdefault((key, rule), []).append(axis)
    return [_estimate(key, [axis for axis in axes if axis], rule) for (key, rule), axes in found.items()]


def _split(name: str) -> tuple[str, str]:
    """Return the axis of a dotted name, ``J1`` or nothing, and the key in it."""
    if not name.startswith("axes."):
        return "", name
    _, number, key = name.split(".", 2)
    return f"J{number}", key


def _estimate(key: str, axes: list[str], rule: str) -> str:
    where = "" if not axes else f" of {axes[0]}" if len(axes) == 1 else f" of {axes[0]} to {axes[-1]} ({len(axes)})"
    return f"{key}{where}{f': {rule}' if rule else ''}"


def robots(rows: list[dict[str, Any]]) -> Table:
    """Return the list of robots; a row as ``robot_data.summary`` gives it."""
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    table.add_column("name", no_wrap=True)
    table.add_column("title", overflow="fold")
    for heading in ("axes\n", "reach\nmm", "payload\nkg"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("estimated", overflow="fold")
    for row in rows:
        numbers = (f"{row['axes']}", f"{row['reach_mm']:.0f}", f"{row['rated_payload_kg']:g}")
        table.add_row(safe(row["name"]), safe(row["title"]), *numbers, ", ".join(row["estimated"]) or "nothing")
    return table


def model_limits(arm: "ImportedArm") -> Table:
    """Return the limits that a model file gives."""

    def shown(value: float | None, unit: float = 1.0) -> str:
        return "-" if value is None else f"{value / unit:g}"

    kinds = list(dict.fromkeys(axis.kind for axis in arm.axes))
    units, forces, inertias = (", ".join(getattr(kind, of) for kind in kinds) for of in ("unit", "force", "inertia"))
    speeds = ", ".join(f"{kind.unit}/s" for kind in kinds)
    headings = (f"range\n{units}", f"speed\n{speeds}", f"torque\n{forces}", f"armature\n{inertias}")
    table = _table("Limits in the file", *headings)
    for index, axis in enumerate(arm.axes, start=1):
        hinge, size = axis.hinge, axis.kind.size
        # the unit of a row where the heading has two
        own = f" {axis.kind.unit}" if len(kinds) > 1 else ""
        reach = f"{shown(hinge.lower, size)} .. {shown(hinge.upper, size)}{own}"
        table.add_row(
            safe(f"J{index} {axis.name}"), reach, shown(hinge.speed, size), shown(hinge.effort), f"{hinge.armature:g}"
        )
    return table


def model_bodies(arm: "ImportedArm") -> Table:
    """Return the bodies of a model file."""
    table = _table(
        "Bodies in their axis frames (inertia xx yy zz about the centre)", "mass\nkg", "cog\nmm", "inertia\nkg m2"
    )
    for index, axis in enumerate(arm.axes, start=1):
        cog = " ".join(f"{round(1000 * x, 3) + 0.0:g}" for x in axis.body.cog)
        table.add_row(f"J{index}", f"{axis.body.mass:g}", cog, _moments(axis.body))
    return table


def bullets(lines: list[str]) -> Table:
    """Return texts as a list."""
    grid = Table.grid(padding=(0, 1, 0, 0))
    for line in lines:
        grid.add_row("  -", safe(line))
    return grid


def _table(title: str, *headings: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", padding=(0, 1, 0, 0))
    table.add_column("axis", overflow="fold")
    for heading in headings:
        table.add_column(heading, justify="right", overflow="fold")  # fold: a number is never cut
    return table


def limits(spec: "RobotSpec") -> Table:
    """Return ranges, speeds, accelerations, jerks and torques."""
    units = list(dict.fromkeys(axis.kind.unit for axis in spec.axes))
    range_, speed, rate, jerk = (",\n".join(f"{unit}{per}" for unit in units) for per in ("", "/s", "/s2", "/s3"))
    force = ",\n".join(dict.fromkeys(axis.kind.force for axis in spec.axes))
    headings = (f"range\n{range_}", f"speed\n{speed}", f"accel\n{rate}", f"jerk\n{jerk}", f"torque\n{force}")
    table = _table("Limits", *headings)
    for index, axis in enumerate(spec.axes, start=1):
        limits, kind, shown = axis.limits, axis.kind, _Marked(spec, index - 1)
        # the unit of a row where the heading has two
        own = f" {kind.unit}" if len(units) > 1 else ""
        table.add_row(
            safe(f"J{index} {axis.name}"),
            shown(kind.range_key, f"{limits.lower / kind.size:g} .. {limits.upper / kind.size:g}{own}"),
            shown(kind.speed_key, limits.speed / kind.size),
            shown(kind.acceleration_key, limits.acceleration / kind.size),
            shown(kind.jerk_key, limits.jerk / kind.size),
            shown(kind.force_key, limits.torque),
        )
    return table


def wrist(spec: "RobotSpec") -> Table:
    """Return what a payload may load the wrist with."""
    from runtime.robot.kinematics.wrist_load import WRIST_AXES, rated_inertia, rated_moment

    title = "Payload at the wrist (~: estimated from the drive)"
    slides = any(axis.kind.slides for axis in spec.axes[-WRIST_AXES:])
    headings = ("moment, weight\nN m, N", "inertia, mass\nkg m2, kg") if slides else ("moment\nN m", "inertia\nkg m2")
    table = _table(title, *headings)
    # numbered before the cut: on seven axes the wrist begins at J5
    for index, axis in list(enumerate(spec.axes, start=1))[-WRIST_AXES:]:
        moment, inertia = axis.limits.rated_moment, axis.limits.rated_inertia
        table.add_row(
            safe(f"J{index} {axis.name}"),
            f"{'~' if moment is None else ''}{rated_moment(axis):.3g}",
            f"{'~' if inertia is None else ''}{rated_inertia(axis):.3g}",
        )
    return table


def drives(spec: "RobotSpec") -> Table:
    """Return the motors, with their rotors at the joint too."""
    table = _table(
        "Drives (motor side; N^2 J at the joint)",
        "gear\nN, mm/turn" if spec.slides.any() else "gear\nN",
        "rotor J\nkg m2",
        "N^2 J\nkg m2",
        "Kt\nN m/A",
        "limit\nA",
        "Coulomb +/-\nN m",
        "viscous\nN m s",
    )
    for index, axis in enumerate(spec.axes, start=1):
        motor, shown = axis.motor, _Marked(spec, index - 1)
        table.add_row(
            f"J{index}",
            shown(f"motor.{axis.kind.transmission_key}", axis.kind.transmission(motor.gear_ratio)),
            shown("motor.rotor_inertia_kg_m2", motor.rotor_inertia),
            shown("motor.rotor_inertia_kg_m2", f"{motor.reflected_inertia:.4f}"),
            shown("motor.torque_constant_nm_a", motor.torque_constant),
            shown("motor.max_current_a", motor.max_current),
            shown("motor.coulomb_friction_nm", "{:g}/{:g}".format(*motor.coulomb_friction)),
            shown("motor.viscous_friction_nm_s", motor.viscous_friction),
        )
    return table


def springs(spec: "RobotSpec") -> list[Table]:
    """Return one table of the gear springs, or none when every gear is rigid."""
    if not any(axis.motor.elastic for axis in spec.axes):
        return []
    table = _table(
        "Gear springs (at the joint)", "stiffness\nN m/rad", "damping\nN m s/rad", "wind-up at\ntorque limit\ndeg"
    )
    for index, axis in enumerate(spec.axes, start=1):
        motor = axis.motor
        windup = axis.limits.torque / motor.stiffness / axis.kind.size
        values = (f"{motor.stiffness:g}", f"{motor.damping:g}", f"{windup:.3f}") if motor.elastic else ("rigid", "", "")
        table.add_row(f"J{index}", *values)
    return [table]


def loops(spec: "RobotSpec") -> Table:
    """Return bandwidths and encoders."""
    table = _table("Servo loops", "position Kp\n1/s", "velocity Kv\n1/s", "current loop\nHz", "encoder\ncounts/turn")
    for index, axis in enumerate(spec.axes, start=1):
        shown = _Marked(spec, index - 1)
        table.add_row(
            f"J{index}",
            shown("servo.position_bandwidth_rad_s", axis.bandwidths.position),
            shown("servo.velocity_bandwidth_rad_s", axis.bandwidths.velocity),
            # rad/s here, Hz in robot files
            shown("motor.current_bandwidth_hz", axis.motor.current_bandwidth / (2.0 * math.pi)),
            shown("motor.encoder_counts", f"{axis.motor.encoder_counts}"),
        )
    return table


def bodies(spec: "RobotSpec") -> Table:
    """Return the bodies as they are published and as they are used."""
    table = _table(
        "Bodies in their axis frames (inertia xx yy zz about the centre)",
        "mass\nkg",
        "cog\nmm",
        "inertia published\nkg m2",
        "inertia used\nkg m2",
    )
    for index, (axis, published) in enumerate(zip(spec.axes, spec.published, strict=True), start=1):
        used, printed, shown = _moments(axis.body), _moments(published), _Marked(spec, index - 1)
        cog = " ".join(f"{round(1000 * x, 3) + 0.0:g}" for x in axis.body.cog)
        table.add_row(
            f"J{index}",
            shown("mass_kg", axis.body.mass),
            shown("cog_m", cog),
            shown("inertia_kg_m2", printed),
            used if used != printed else "the same",
        )  # of a column of numbers the few that differ would not be seen
    return table


def _moments(body: "Body") -> str:
    import numpy as np

    return " ".join(f"{x:.6g}" for x in np.diag(body.inertia))


def corrections(spec: "RobotSpec") -> list[str]:
    """Return the corrections of published bodies in words."""
    return [f"J{item.axis + 1}: {'; '.join(_changes(item))}. {item.reason}" for item in spec.corrections]


def _changes(correction: "Correction") -> list[str]:
    axis, changes = correction.axis + 1, []
    if correction.inertia_shift:
        giver = f"link {axis - 1}" if axis > 1 else "the base"
        changes.append(f"{correction.inertia_shift:g} kg m2 across the joint, from {giver} to link {axis}")
    if correction.added_mass:
        changes.append(f"{correction.added_mass:g} kg added on the axis")
    if correction.added_inertia:
        changes.append(f"{correction.added_inertia:g} kg m2 added about every axis")
    return changes
