"""A program with the files beside it: cell, taught points and controller profile, read and checked together.

Which files those are is in ``beside``. With none of them a program runs on the built-in cell: the default robot, a
hand, a table and a part, with P1 to P5 taught (docs/language.md).
"""

import difflib
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path

import numpy as np

from robolang.beside import cell_beside, taught_points
from robolang.checker import check
from robolang.diagnostics import Diagnostic, has_errors, in_order
from robolang.nodes import Program
from robolang.parser import parse
from robolang.points import PointStore
from robolang.source import Source, read_program
from runtime.faults import Code, Fault, register
from runtime.plant.cell import CellSpec, load_cell, parse_cell
from runtime.profile import Profile, ServoMode, parse_profile
from runtime.robot import importer, loader
from runtime.robot.spec import RobotSpec
from runtime.tomlfile import Source as TomlSource

register(
    Code(
        code="RBL708",
        name="robot-unknown",
        meaning="No built-in robot and no robot file has the given name.",
        remedy="Name a built-in robot or the path of a robot file ending in .toml, .urdf or .xml.",
    ),
    Code(
        code="RBL709",
        name="robot-does-not-fit-cell",
        meaning="The robot given on the command line has another number of axes than the cell's home position.",
        remedy="Give a cell file made for that robot with --cell.",
    ),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """Everything a run needs. ``diagnostics`` may hold errors: then the program must not run."""

    source: Source
    program: Program
    diagnostics: tuple[Diagnostic, ...]
    cell: CellSpec
    points: PointStore
    profile: Profile

    @property
    def ok(self) -> bool:
        """Whether the program may run."""
        return not has_errors(self.diagnostics)


def load_project(path: Path | str, cell: Path | str | None = None, robot: str | None = None,
                 servo: ServoMode | None = None) -> Project:  # fmt: skip
    """Read a program and the files beside it.

    ``cell`` names a cell file, ``robot`` a built-in robot or a robot file that replaces the cell's, ``servo`` the
    servo mode that replaces the profile's. Raises ``FileFault`` or ``Fault`` for a file that cannot be used; what is
    wrong with the program itself is in ``diagnostics``.
    """
    source = read_program(path)
    where = Path(path)
    cell_path = Path(cell) if cell is not None else cell_beside(where)
    cell_spec = load_cell(cell_path) if cell_path is not None else builtin_cell()
    if robot is not None:
        cell_spec = _with_robot(cell_spec, load_any_robot(robot))
    used = cell_spec.robot
    points = taught_points(where, builtin=cell_path is None, robot=used.name, axes=used.n)
    profile = parse_profile(cell_spec.controller)
    if servo is not None:
        profile = replace(profile, servo=replace(profile.servo, mode=servo))
    _check_gains(used, profile)
    parsed = parse(source)
    found = check(parsed.program, points=points.names, rated_payload_kg=used.rated_payload)
    return Project(
        source=source,
        program=parsed.program,
        diagnostics=in_order((*parsed.diagnostics, *found)),
        cell=cell_spec,
        points=points,
        profile=profile,
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


def _check_gains(robot: RobotSpec, profile: Profile) -> None:
    """Refuse bandwidths at which no sampled loop is stable: with period Ts its pole is 1 - K Ts, so K Ts < 2 (RBL616).

    Necessary, not sufficient: the current loop and the sampling of the speed take their share of it.
    """
    most = 2.0 / profile.tick_s
    for index, axis in enumerate(robot.axes, start=1):
        for name in ("position", "velocity"):
            value = getattr(axis.bandwidths, name)
            if not value < most:
                raise Fault(
                    "RBL616",
                    f"{name}_bandwidth_rad_s = {value:g} of J{index} of {robot.name} cannot be stable at a servo "
                    f"period of {profile.tick_s * 1e3:g} ms; it must be below {most:g}",
                )


def _with_robot(cell: CellSpec, robot: RobotSpec) -> CellSpec:
    if robot.n != len(cell.home):
        raise Fault("RBL709", f"{robot.name} has {robot.n} axes, the cell's home position {len(cell.home)}")
    if not ((robot.lower <= cell.home) & (cell.home <= robot.upper)).all():
        axis = int(np.argmax(np.maximum(robot.lower - cell.home, cell.home - robot.upper)))
        raise Fault("RBL709", f"the cell's home position is outside the range of J{axis + 1} of {robot.name}")
    return replace(cell, robot=robot)
