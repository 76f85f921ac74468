"""A program with the files beside it: cell, taught points and controller profile, read and checked together.

Which files those are is in ``beside``. With none of them a program runs on the built-in cell: the default robot, a
hand, a table and a part, with P1 to P5 taught (docs/language.md).
"""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from robolang.beside import cell_beside, taught_points
from robolang.checker import check
from robolang.diagnostics import Diagnostic, has_errors, in_order
from robolang.nodes import Program
from robolang.parser import parse
from robolang.points import PointStore
from robolang.source import Source, read_program
from runtime.dynamics.compensation import load_compensation
from runtime.faults import Fault
from runtime.frames import Array
from runtime.plant.cell import CellSpec, load_cell, parse_cell
from runtime.profile import Profile, ServoMode, Settings, load_profile_file, read_layer, read_options, settle
from runtime.robot import importer, loader
from runtime.robot.spec import RobotSpec
from runtime.tomlfile import Source as TomlSource
from runtime.tomlfile import Table, inside


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """Everything a run needs. ``diagnostics`` may hold errors: then the program must not run."""

    source: Source
    program: Program
    diagnostics: tuple[Diagnostic, ...]
    cell: CellSpec
    points: PointStore
    settings: Settings

    @property
    def profile(self) -> Profile:
        """The controller profile in force."""
        return self.settings.profile

    def with_profile(self, profile: Profile) -> "Project":
        """Return the same project under another controller profile."""
        return replace(self, settings=replace(self.settings, profile=profile))

    @property
    def ok(self) -> bool:
        """Whether the program may run."""
        return not has_errors(self.diagnostics)


def load_project(path: Path | str, cell: Path | str | None = None, robot: str | None = None,
                 servo: ServoMode | None = None, profile: Path | str | None = None,
                 options: Mapping[str, tuple[str, Any]] | None = None) -> Project:  # fmt: skip
    """Read a program and the files beside it.

    ``cell`` names a cell file, ``robot`` a built-in robot or a robot file that replaces the cell's, ``servo`` the
    servo mode that replaces the profile's, ``profile`` a profile file whose values go over the cell's, and ``options``
    single settings over both: dotted key to (name of the option, value). Raises ``FileFault`` or
    ``Fault`` for a file that cannot be used; what is wrong with the program itself is in ``diagnostics``.
    """
    source = read_program(path)
    where = Path(path)
    given = {**({} if servo is None else {"servo.mode": ("--servo", servo)}), **(options or {})}
    cell_path = _cell_path(where, cell)
    cell_spec, settings = load_cell_and_settings(where, cell, robot, profile, given)
    used = cell_spec.robot
    points = taught_points(where, builtin=cell_path is None, robot=used.name, axes=used.n)
    parsed = parse(source)
    found = check(parsed.program, points=points.names, rated_payload_kg=used.rated_payload, sensors=cell_spec.sensors,
                  tools=cell_spec.tools, frames=cell_spec.frames, loads=cell_spec.loads,
                  inputs=cell_spec.inputs)  # fmt: skip
    return Project(
        source=source,
        program=parsed.program,
        diagnostics=in_order((*parsed.diagnostics, *found)),
        cell=cell_spec,
        points=points,
        settings=settings,
    )


def load_any_robot(name: str) -> RobotSpec:
    """Return a built-in robot by name or the robot of a file; ``Fault`` RBL708, ``FileFault`` RBL6xx.

    A file is a robot file (``.toml``), or a URDF or MJCF file (``.urdf``, ``.xml``) with its sidecar.
    """
    if name in loader.library():
        return loader.load_builtin(name)
    if name.lower().endswith(importer.ROBOT_ENDINGS):
        return importer.load_file(Path(name))
    near = difflib.get_close_matches(name, loader.library(), n=1)
    guess = f"did you mean {near[0]}? " if near else ""
    raise Fault(
        "RBL708",
        f"there is no robot '{name}'",
        f"{guess}built in: {', '.join(loader.library())}; a robot file is named by its path, which ends in .toml, "
        ".urdf or .xml",
    )


def builtin_cell() -> CellSpec:
    """Return the built-in cell."""
    return parse_cell(TomlSource("cell.toml", _builtin("cell.toml")))


def _builtin(name: str) -> str:
    return resources.files("robolang.builtin").joinpath(name).read_text("utf-8")


def _cell_path(program: Path | None, cell: Path | str | None) -> Path | None:
    if cell is not None:
        return Path(cell)
    return None if program is None else cell_beside(program)


def load_cell_and_settings(program: Path | None, cell: Path | str | None, robot: str | None,
                           profile: Path | str | None, options: Mapping[str, tuple[str, Any]],
                           ) -> tuple[CellSpec, Settings]:  # fmt: skip
    """Return the cell of a program (None: the built-in cell) and the settings in force; see ``load_project``."""
    cell_path = _cell_path(program, cell)
    cell_spec = load_cell(cell_path) if cell_path is not None else builtin_cell()
    if robot is not None:
        cell_spec = _with_robot(cell_spec, load_any_robot(robot))
    return cell_spec, load_settings(
        cell_spec.robot, cell_spec.hand.X_flange_tool, cell_spec.controller, profile, options
    )


def load_settings(robot: RobotSpec, X_flange_tool: Array, controller: Table | None, profile: Path | str | None,
                  options: Mapping[str, tuple[str, Any]]) -> Settings:  # fmt: skip
    """Return the controller's settings: cell, then profile file, then options; ``FileFault`` or ``Fault`` RBL6xx."""
    file = load_profile_file(Path(profile)) if profile is not None else {}
    settings = settle(read_layer(controller), file, read_options(options))
    for name in ("position", "velocity"):
        given = settings[f"servo.{name}_bandwidth_rad_s"]
        if len(given.value) not in (0, 1, robot.n):
            given.fail("RBL613", f"'servo.{name}_bandwidth_rad_s' has {len(given.value)} entries; {robot.name} has "
                       f"{robot.n} axes", "give one number for all axes or one for each")  # fmt: skip
    settings = _compensated(robot, settings)
    _check_gains(robot, X_flange_tool, settings)
    return settings


def _compensated(robot: RobotSpec, settings: Settings) -> Settings:
    """Give the servo the compensation file that is named: inside the folder of the file that names it."""
    given = settings["servo.compensation"]
    if not given.value:
        return settings
    path = Path(given.value)
    if given.table is not None:
        path = inside(given.table, given.value, Path(given.table.source.path).parent, given.name)
    found = load_compensation(path, robot)
    servo = replace(settings.profile.servo, rotors=tuple(found.rotors(robot).tolist()),
                    rotor_tables=found.rotor_tables(robot), first_moments=found.first_moments)  # fmt: skip
    return replace(settings, profile=replace(settings.profile, servo=servo))


def _check_gains(robot: RobotSpec, X_flange_tool: Array, settings: Settings) -> None:
    """Refuse gains with which no sampled loop is stable (RBL616, ``runtime.servo.fixed``), where they were given."""
    from runtime.servo.fixed import excesses

    for excess in excesses(robot, settings.profile, X_flange_tool):
        message = (
            f"{excess.what} = {excess.value:.6g} of J{excess.axis + 1} of {robot.name} cannot be stable at a servo "
            f"period of {settings.profile.tick_s * 1e3:g} ms; it must be below {excess.bound:g}"
            if excess.key.endswith("bandwidth_rad_s")
            else f"{excess.what} = {excess.value:.6g} of J{excess.axis + 1} of {robot.name} is positive feedback that "
            f"cannot be stable; it must be below {excess.bound:g}"
        )
        key = f"servo.{excess.key}"
        culprits = (key, "servo.feedforward", "servo.fixed_at", "servo.mode", "servo_period_ms")
        given = next((settings[name] for name in culprits if settings[name].origin != "default"), None)
        if given is None:
            raise Fault("RBL616", message)
        given.fail("RBL616", message)


def _with_robot(cell: CellSpec, robot: RobotSpec) -> CellSpec:
    if robot.n != len(cell.home):
        raise Fault("RBL709", f"{robot.name} has {robot.n} axes, the cell's home position {len(cell.home)}")
    if not ((robot.lower <= cell.home) & (cell.home <= robot.upper)).all():
        axis = int(np.argmax(np.maximum(robot.lower - cell.home, cell.home - robot.upper)))
        raise Fault("RBL709", f"the cell's home position is outside the range of J{axis + 1} of {robot.name}")
    return replace(cell, robot=robot)
