"""The example programs: those of ``programs`` in a checkout, which an installed robolang has in its package."""

import difflib
from pathlib import Path

from robolang.core.storage import add_files, only_one
from robolang.project.discovery import cell_beside, points_file
from robolang.templates.template import CELL, POINTS, PROGRAM, TEST, title_of
from robolang.templates.writing import refuse_existing
from runtime.cell.cell_file import read_cell_file
from runtime.core.bounded_files import read_bounded
from runtime.core.faults import Fault
from runtime.core.record import Record

_HERE = Path(__file__).parent
_INSTALLED, _CHECKOUT = _HERE / "programs", _HERE.parents[1]
MOST_BYTES = 1_000_000


class Example(Record):
    """An example: its name, its program, and the files that it needs by the ending that each gets."""

    name: str
    program: Path
    files: dict[str, Path]

    @property
    def title(self) -> str:
        """What it does: its first sentence."""
        return title_of(self.program.read_text("utf-8"))

    def meshes(self) -> dict[str, Path]:
        """Return the files of meshes that its cell names, by the names that they have there."""
        cell = self.files.get(CELL)
        return {} if cell is None else {name: cell.parent / name for name in read_cell_file(cell).meshes}


def examples() -> list[Example]:
    """Return all examples by name."""
    # a folder `programs` beside an installed package is somebody else's: only a checkout has a project file there
    checkout = (_CHECKOUT / "pyproject.toml").is_file() and (_CHECKOUT / "programs").is_dir()
    folder = _CHECKOUT / "programs" if checkout else _INSTALLED
    return sorted((_example(path) for path in folder.rglob(f"*{PROGRAM}")), key=lambda each: each.name)


def example(name: str) -> Example:
    """Return an example by its name; ``Fault`` RBL844 where none has it."""
    known = {each.name: each for each in examples()}
    # as a file it has its ending, and that is how one types it
    wanted = name.removesuffix(PROGRAM)
    if wanted not in known:
        near = difflib.get_close_matches(wanted.lower(), known, n=1)
        guess = f"did you mean {near[0]}? " if near else ""
        raise Fault("RBL844", f"there is no example '{name}'", f"{guess}'robolang examples' lists them all")
    return known[wanted]


def copy_example(name: str, folder: Path) -> list[Path]:
    """Copy an example into a folder, which is made where it is not there, and return its files.

    ``Fault`` RBL844, RBL841 where a file would be overwritten, RBL706.
    """
    found = example(name)
    files = {f"{found.name}{ending}": read_bounded(path, MOST_BYTES) for ending, path in found.files.items()}
    files |= {name: read_bounded(path, MOST_BYTES) for name, path in found.meshes().items()}
    # read before the lock and before a folder is made: a program that cannot be read leaves nothing
    with only_one(folder):
        refuse_existing(folder, files)
        add_files(folder, files)
    return [folder / each for each in files]


def _example(program: Path) -> Example:
    # the cell of a folder becomes that of the program: in another folder it would be the cell of every program there
    beside = {
        PROGRAM: program,
        CELL: cell_beside(program),
        POINTS: points_file(program),
        TEST: program.with_suffix(TEST),
    }
    files = {ending: path for ending, path in beside.items() if path is not None and path.is_file()}
    return Example(name=program.stem, program=program, files=files)
