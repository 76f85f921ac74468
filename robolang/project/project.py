"""A program with the files beside it: cell, taught points and controller profile, read and checked together.

Which files those are is in ``discovery``. With none of them a program runs on the built-in cell: the default robot, a
hand, a table and a part, with P1 to P5 taught (docs/language.md).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Unpack

from robolang.analysis.analysis import Analysis
from robolang.core.calls import checked, refuse
from robolang.core.diagnostics import Diagnostic, has_errors
from robolang.core.source import Source, read_program
from robolang.project import discovery
from robolang.project.arguments import Files, PathLike, options_of, points_text
from robolang.project.discovery import CellFiles, Typed, controller_settings, read_beside
from robolang.project.points import PointStore
from robolang.syntax.ast import Program
from runtime.cell import cell as cells
from runtime.cell.cell import CellSpec
from runtime.core.faults import Fault, raise_all
from runtime.core.frames import Array
from runtime.dynamics.compensation import load_compensation
from runtime.robot.files import importer, loader, robot_file
from runtime.robot.files.arm_file import ROBOT_ENDINGS
from runtime.robot.model.spec import RobotSpec
from runtime.settings.layers import (
    Layer,
    Settings,
    check_axes,
    compensation_file,
    load_profile_file,
    read_options,
    settle,
)
from runtime.settings.profile import Profile, ServoMode

_READ = 'Read it: cell=pathlib.Path("cell.toml").read_text("utf-8"); Project.load takes the path of a cell.'


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """Everything a run needs. ``diagnostics`` are those of the analysis; with an error the program must not run.

    ``cell_text`` is the text of the cell file, of the built-in cell too.
    """

    analysis: Analysis
    diagnostics: tuple[Diagnostic, ...]
    cell: CellSpec
    cell_text: str
    points: PointStore
    settings: Settings

    @classmethod
    @checked
    def load(cls, program: PathLike, **files: Unpack[Files]) -> "Project":
        """Read a program and the files beside it, or those that are named.

        Raises ``FileFault`` or ``Fault`` for a file or an argument that cannot be used; errors of the program itself
        are in ``diagnostics``.
        """
        return _given(program, files.get("cell"), files)

    @classmethod
    @checked
    def from_text(
        cls,
        text: str,
        *,
        points: Mapping[str, Sequence[float]] | None = None,
        name: str = "program.rbl",
        **files: Unpack[Files],
    ) -> "Project":
        """Return the project of a text; nothing of it need be on the disk.

        ``points``: name to x, y, z mm and rx, ry, rz deg of the tool in the world; None: those of the built-in cell.
        ``cell`` is the text of a cell file here; None: the built-in cell. ``name`` stands in messages. Raises as
        ``load``.
        """
        where, cell = Path(name), files.get("cell")
        if isinstance(cell, Path) or (cell is not None and cell.endswith(".toml") and "\n" not in cell):
            refuse("cell", f"the text of a cell file is needed, but {str(cell)!r} is a path", _READ)
        texts = {
            discovery.points_file(where): None if points is None else points_text(points),
            discovery.own_cell(where): cell,
            # what happens to lie in the working folder is not meant
            where.with_name("cell.toml"): None,
        }
        typed = Typed(analysis=Analysis(source=Source(name, text)), texts=texts)
        return _given(typed, None, files)

    @property
    def source(self) -> Source:
        """The text of the program."""
        return self.analysis.source

    @property
    def program(self) -> Program:
        """The tree of the program."""
        return self.analysis.program

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


def _given(program: PathLike | Typed, cell: PathLike | None, files: Files) -> Project:
    robot = files.get("robot")
    return load_project(
        program, cell, None if robot is None else str(robot), profile=files.get("profile"), options=options_of(files)
    )


def load_project(
    program: Path | str | Analysis | Typed,
    cell: Path | str | None = None,
    robot: str | None = None,
    servo: ServoMode | None = None,
    profile: Path | str | None = None,
    options: Mapping[str, tuple[str, Any]] | None = None,
) -> Project:
    """Read a program and the files beside it.

    ``program`` is its path, or an analysis of its text, which is then neither read nor parsed again, or what somebody
    types, with texts in place of the files beside it. ``cell`` names a cell file, ``robot`` a built-in robot or a robot
    file that replaces the cell's, ``servo`` the servo mode that replaces the profile's, ``profile`` a profile file with
    values that replace the cell's, and ``options`` single settings that replace both: dotted key to (name of the
    option, value). Raises ``FileFault`` or ``Fault`` for a file that cannot be used; the errors of the program itself
    are in ``diagnostics``.
    """
    typed = _typed(program)
    analysis, where = typed.analysis, Path(typed.analysis.source.path)
    given = {**({} if servo is None else {"servo.mode": ("servo", servo)}), **(options or {})}
    files, cell = CellFiles(typed.texts), typed.cell if cell is None else Path(cell)
    found = read_beside(where, files, cell=cell, robot=robot, layers=_layers(profile, given))
    # all of them, as a check reports them; the first alone would need one run for each error
    raise_all(found.faults)
    # what could not be used is None and has its fault, which has been raised
    assert found.cell is not None and found.points is not None and found.settings is not None
    spec = cells.build(found.cell)
    settings = judged(spec.robot, spec.hand.X_flange_tool, found.settings)
    analysis = analysis.within(found.symbols)
    return Project(
        analysis=analysis,
        diagnostics=analysis.diagnostics,
        cell=spec,
        cell_text=found.cell.text,
        points=found.points,
        settings=settings,
    )


def _typed(program: Path | str | Analysis | Typed) -> Typed:
    if isinstance(program, Typed):
        return program
    return Typed(analysis=program if isinstance(program, Analysis) else Analysis(source=read_program(program)))


def load_any_robot(name: str) -> RobotSpec:
    """Return a built-in robot by name or the robot of a file; ``Fault`` RBL708, ``FileFault`` RBL6xx.

    A file is a robot file (``.toml``), or a URDF or MJCF file (``.urdf``, ``.xml``) with its sidecar.
    """
    if name in robot_file.library():
        return loader.load_builtin(name)
    if name.lower().endswith(ROBOT_ENDINGS):
        spec = importer.load_file(Path(name))
        # for a robot by itself, as for a step response or an identification, the drives are what matters
        if spec.undriven is not None:
            raise spec.undriven
        return spec
    raise discovery.no_robot(name)


def builtin_cell() -> CellSpec:
    """Return the built-in cell."""
    return cells.build(discovery.builtin_cell_file())


def load_cell_and_settings(
    program: Path | None,
    cell: Path | str | None,
    robot: str | None,
    profile: Path | str | None,
    options: Mapping[str, tuple[str, Any]],
) -> tuple[CellSpec, Settings]:
    """Return the cell of a program (None: the built-in cell) and the settings in force; see ``load_project``."""
    where = Path(cell) if cell is not None else None if program is None else discovery.cell_beside(program)
    file = CellFiles().cell(where)
    if robot is not None:
        file = discovery.with_robot(file, discovery.named_arm(robot))
    settings = controller_settings(file, _layers(profile, options))
    spec = cells.build(file)
    return spec, judged(spec.robot, spec.hand.X_flange_tool, settings)


def load_settings(
    robot: RobotSpec, X_flange_tool: Array, profile: Path | str | None, options: Mapping[str, tuple[str, Any]]
) -> Settings:
    """Return the settings of a controller without a cell: profile file, then options; ``Fault`` RBL6xx."""
    settings = settle(*_layers(profile, options))
    check_axes(settings, robot.n, robot.name)
    return judged(robot, X_flange_tool, settings)


def _layers(profile: Path | str | None, options: Mapping[str, tuple[str, Any]]) -> tuple[Layer, Layer]:
    return ({} if profile is None else load_profile_file(Path(profile))), read_options(options)


def judged(robot: RobotSpec, X_flange_tool: Array, settings: Settings) -> Settings:
    """Return settings with their compensation file; ``FileFault`` or ``Fault`` RBL61x where they do not fit the arm."""
    settings = _compensated(robot, settings)
    _check_gains(robot, X_flange_tool, settings)
    return settings


def _compensated(robot: RobotSpec, settings: Settings) -> Settings:
    """Give the servo the compensation file that is named."""
    path = compensation_file(settings)
    if path is None:
        return settings
    found = load_compensation(path, robot)
    servo = replace(
        settings.profile.servo,
        rotors=tuple(found.rotors(robot).tolist()),
        rotor_tables=found.rotor_tables(robot),
        first_moments=found.first_moments,
    )
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
        # the place of the setting that the user gave, the most specific first, not of a default
        given = next((settings[name] for name in culprits if settings[name].origin != "default"), None)
        # the defaults do not fit this robot: no file has a place that could be shown
        if given is None:
            raise Fault("RBL616", message)
        given.fail("RBL616", message)
