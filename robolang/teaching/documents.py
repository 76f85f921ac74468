"""What a pendant edits: a program, its taught points and its cell, as texts; one value that edits replace as a whole.

The texts need not be on the disk: ``robolang.project.project.load_project`` takes ``Documents.typed`` and reads them as
if they were saved. ``desk`` keeps the documents of a session, with undo and saving. Imports no numerics.
"""

import os
from dataclasses import dataclass
from pathlib import Path

from robolang.analysis.analysis import Analysis
from robolang.core.source import Source, read_program
from robolang.project.discovery import Texts, Typed, cell_beside, named_arm, own_cell, points_file
from robolang.project.points import points_source
from runtime.core.tomlfile import read_source

UNNAMED = "unnamed.rbl"
"""The name, in the working folder, of a program that has none yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Documents:
    """A program, its points file and its cell file, without byte order marks, line ends as they are in the files.

    ``path`` is that of the program. ``points`` None: no points file; ``cell`` None: no cell file, so the built-in cell.
    ``cell_path``: where the cell file stands, or would. ``named``: whether the program has a name of its own.
    ``robot``: the name of the robot in place of the cell's, for which a new points file is; empty: that of the cell.
    """

    path: Path
    program: str
    points: str | None
    cell: str | None
    cell_path: Path
    named: bool = True
    robot: str = ""

    @property
    def points_path(self) -> Path:
        """Where the points file stands, or would."""
        return points_file(self.path)

    def path_of(self, field: str) -> Path:
        """Return where ``program``, ``points`` or ``cell`` stands, or would."""
        return {"program": self.path, "points": self.points_path, "cell": self.cell_path}[field]

    @property
    def texts(self) -> Texts:
        """The texts by path, in the order in which they are saved: what a program names is there before it."""
        return {self.points_path: self.points, self.cell_path: self.cell, self.path: self.program}

    @property
    def source(self) -> Source:
        """The text of the program with its path."""
        return Source(str(self.path), self.program)

    def typed(self, analysis: Analysis | None = None) -> Typed:
        """Return what ``load_project`` takes; ``analysis``: of this program, where it is known."""
        return Typed(
            analysis=analysis or Analysis(source=self.source),
            texts=self.texts,
            cell=None if self.cell is None else self.cell_path,
        )


def load_documents(program: Path | None = None, cell: Path | None = None, robot: str | None = None) -> Documents:
    """Read a program with its points file and its cell file; ``program`` None: a new one, in the working folder.

    ``cell`` is a cell file in place of the one beside the program, ``robot`` a built-in robot or a robot file in place
    of the cell's. Raises ``FileFault`` for what cannot be read: RBL701, RBL702, RBL104, RBL106, RBL311, RBL600; for the
    robot ``Fault`` RBL708 or RBL6xx. What is wrong inside a text is found when it is used or edited.
    """
    if program is None:
        path = Path(UNNAMED)
        # files of that name belong to another program; the cell is that of the folder
        beside = path.with_name("cell.toml")
        found, text, points = cell or (beside if os.path.lexists(beside) else None), "", None
    else:
        # the program first: no other file is beside one that cannot exist
        path, text = program, read_program(program).text
        found, points = cell or cell_beside(path), _points(path)
    return Documents(
        path=path,
        program=text,
        points=points,
        cell=None if found is None else read_source(found).text,
        cell_path=found or own_cell(path),
        named=program is not None,
        robot="" if robot is None else named_arm(robot).name,
    )


def _points(program: Path) -> str | None:
    path = points_file(program)
    # a link that leads nowhere is there: it is reported
    return points_source(path).text if path.is_symlink() or path.exists() else None
