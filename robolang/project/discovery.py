"""The files that stand beside a program: which cell it runs in, which points it may use and how its controller is set.

``NAME.rbl`` takes ``NAME.cell.toml``, else ``cell.toml`` of its folder, and ``NAME.points.toml``. With no cell and no
points it gets the built-in ones (docs/language.md). A link that leads nowhere is there all the same: it is reported,
not left out. ``check`` and a run read these files here, so what one refuses the other refuses. Imports no numpy.
"""

import os
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.core.source import STANDARD_INPUT
from robolang.project.builtin import POINTS, cell_text
from robolang.project.points import PointStore, load_points, read_points
from runtime.cell.cell_file import CellFile, parse_cell_file, read_arm_alone, read_cell_file
from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.rounding import beside
from runtime.core.tomlfile import FileFault, Source, read_source
from runtime.robot.files import robot_file
from runtime.robot.files.arm_file import ROBOT_ENDINGS, ArmFile, read_arm_file
from runtime.settings.layers import Layer, Settings, check_axes, compensation_file, settle


class Beside(Record):
    """What stands beside a program; None where it cannot be used, for the reasons in ``faults``, each once."""

    cell: CellFile | None
    points: PointStore | None
    settings: Settings | None
    symbols: CellSymbols
    faults: tuple[Fault, ...]


Texts = Mapping[Path, str | None]
"""Files as somebody types them, in place of those on the disk; None: not there, whatever the disk has."""
_ON_DISK: Texts = MappingProxyType({})


class Typed(Record):
    """A program that somebody edits, with the files beside it as they are typed; none of them need be on the disk."""

    analysis: Analysis
    texts: Texts = _ON_DISK
    cell: Path | None = None


class CellFiles:
    """Cell files, each read once: many programs of a folder run in one cell. ``texts`` hide the files on the disk."""

    def __init__(self, texts: Texts = _ON_DISK) -> None:
        self._read: dict[Path, CellFile | FileFault] = {}
        self._texts = texts

    def has(self, path: Path) -> bool:
        """Return whether a file is there, a link that leads nowhere among them."""
        return self._texts[path] is not None if path in self._texts else os.path.lexists(path)

    def typed(self, path: Path) -> Source | None:
        """Return a file as it is typed; None where the one on the disk counts."""
        text = self._texts.get(path)
        return None if text is None else Source(str(path), text)

    def cell(self, path: Path | None) -> CellFile:
        """Return a cell, the built-in one for None; ``FileFault`` RBL6xx."""
        if path is None:
            return builtin_cell_file()
        if path not in self._read:
            try:
                typed = self.typed(path)
                self._read[path] = read_cell_file(path) if typed is None else parse_cell_file(typed, path.parent)
            except FileFault as fault:
                # a fault is kept as well: a cell of many programs is reported once
                self._read[path] = fault
        found = self._read[path]
        if isinstance(found, FileFault):
            raise found
        return found


@cache
def builtin_cell_file() -> CellFile:
    """Return the built-in cell."""
    return parse_cell_file(Source("cell.toml", cell_text()))


def read_beside(
    program: Path,
    files: CellFiles | None = None,
    *,
    cell: Path | None = None,
    robot: str | None = None,
    layers: tuple[Layer, ...] = (),
) -> Beside:
    """Read the files of a program.

    ``cell`` is a cell file in place of the one beside the program, ``robot`` a built-in robot or a robot file in place
    of the cell's, ``layers`` are settings over the cell's. What is wrong is in ``faults``.
    """
    faults: list[Fault] = []
    files = files or CellFiles()
    where = cell_beside(program, files) if cell is None else cell
    found: CellFile | None = None
    settings: Settings | None = None
    points: PointStore | None = None
    facts: CellFile | ArmFile | None = None
    try:
        found = files.cell(where)
        if robot is not None:
            found = with_robot(found, named_arm(robot))
        # kept where a setting is refused below: the points are checked against the cell all the same
        facts = found
        settings = controller_settings(found, layers)
    except Fault as fault:
        faults += fault.all
        if found is None:
            facts = _arm_alone(where, robot, files)
    cell_file = "" if where is None else str(where)  # nothing can be added to the built-in cell
    try:
        symbols = CellSymbols.of(facts, cell_file=cell_file)
        points = taught_points(program, builtin=where is None, symbols=symbols, files=files)
    except Fault as fault:
        faults += fault.all
    names = None if points is None else points.names
    symbols = CellSymbols.of(facts, names, cell_file=cell_file).replaced(**_could_stand_beside(program, where))
    return Beside(cell=found, points=points, settings=settings, symbols=symbols, faults=tuple(faults))


def _could_stand_beside(program: Path, cell: Path | None) -> dict[str, str]:
    """Return the files that names can be added to; nothing stands beside the standard input."""
    if str(program) == STANDARD_INPUT:
        return {}
    return {"points_file": str(points_file(program)), "no_cell": "" if cell is not None else str(own_cell(program))}


def _arm_alone(cell: Path | None, robot: str | None, files: CellFiles) -> ArmFile | None:
    """Return the robot of a cell that cannot be used, so that a points file is checked all the same."""
    return None if cell is None or robot is not None else read_arm_alone(cell, files.typed(cell))


def _sibling(program: Path, ending: str) -> Path:
    # not with_suffix, which fails for a program without a name, such as '': reading it says what is wrong
    return program.parent / f"{program.stem}{ending}"


def own_cell(program: Path) -> Path:
    """Return where the cell file of a program alone stands, or would."""
    return _sibling(program, ".cell.toml")


def cell_beside(program: Path, files: CellFiles | None = None) -> Path | None:
    """Return the cell file of a program; None when it has none and runs in the built-in cell."""
    for candidate in (own_cell(program), program.parent / "cell.toml"):
        if (files or CellFiles()).has(candidate):
            return candidate
    return None


def points_file(program: Path) -> Path:
    """Return where the taught points of a program stand, or would."""
    return _sibling(program, ".points.toml")


def taught_points(
    program: Path, *, builtin: bool, symbols: CellSymbols = NOTHING_KNOWN, files: CellFiles | None = None
) -> PointStore:
    """Return the points of a program; ``FileFault`` RBL30x or RBL311 for a file that cannot be used.

    ``builtin``: without a file of its own it has the built-in points, not none; ``symbols`` as for ``load_points``.
    """
    beside, files = points_file(program), files or CellFiles()
    if files.has(beside):
        typed = files.typed(beside)
        return load_points(beside, symbols) if typed is None else read_points(typed, symbols)
    if not builtin:
        return PointStore(path=str(beside))
    # poses that were taught on the default robot; --robot may use them on another one
    return load_points(POINTS, symbols.replaced(robot=None))


def named_arm(name: str) -> ArmFile:
    """Return the file of a built-in robot by name, or of a robot file by its path; ``Fault`` RBL708, RBL6xx."""
    if name in robot_file.library():
        return robot_file.builtin(name)
    if name.lower().endswith(ROBOT_ENDINGS):
        return read_arm_file(Path(name))
    raise no_robot(name)


_EXPAND = "; a xacro file is expanded first, where its package is installed: xacro arm.urdf.xacro > arm.urdf"


def no_robot(name: str) -> Fault:
    """Return the fault of a name that no robot has (RBL708)."""
    import difflib  # needed for a hint only

    near = difflib.get_close_matches(name.lower(), robot_file.library(), n=1)  # all are in small letters
    guess = f"did you mean {near[0]}? " if near else ""
    return Fault(
        "RBL708",
        f"there is no robot '{name}'",
        f"{guess}built in: {', '.join(robot_file.library())}; a robot file is named by its path, which ends "
        f"in .toml, .urdf or .xml{_EXPAND if name.lower().endswith('.xacro') else ''}",
    )


def with_robot(cell: CellFile, arm: ArmFile) -> CellFile:
    """Return a cell with another robot; ``Fault`` RBL709 for one that cannot stand at home there."""
    if len(arm.limits) != len(cell.home):
        raise Fault(
            "RBL709", f"{arm.name} has {len(arm.limits)} axes, the home position of the cell has {len(cell.home)}"
        )
    for index, (angle, limits) in enumerate(zip(cell.home, arm.limits, strict=True)):
        kind = limits.kind
        if not limits.lower <= angle * kind.size <= limits.upper:
            shown, low, high = beside(angle, limits.lower / kind.size, limits.upper / kind.size)
            raise Fault(
                "RBL709",
                f"the home position of the cell has J{index + 1} at {shown} {kind.unit}; its range on {arm.name} is "
                f"{low} to {high} {kind.unit}",
            )
    return cell.replaced(arm=arm)


def controller_settings(cell: CellFile, layers: tuple[Layer, ...] = ()) -> Settings:
    """Return the settings of a cell's controller under others over them; ``FileFault`` or ``Fault`` RBL6xx.

    Whether a compensation file fits and a loop is stable is judged by ``project``: it needs a model of the arm.
    """
    settings = settle(cell.controller, *layers)
    check_axes(settings, len(cell.arm.limits), cell.arm.name)
    compensation = compensation_file(settings)
    if compensation is not None:
        read_source(compensation)
    return settings
