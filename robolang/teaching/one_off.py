"""One point taught from the command line: into the points file of a program, without a controller.

The tool in use is that of the hand, or one of the cell that is named; the frame is the world, or one of the cell. An
existing point keeps its own kind, frame and tool where no others are named.
"""

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import Point
from robolang.project.project import load_project
from robolang.teaching import points_document
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.teaching.postures import reached, reached_point
from robolang.teaching.taught import Kind, Taught, taught_point
from robolang.teaching.touch_up import TouchUp, change
from robolang.values.poses import Place, Six
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.robot.kinematics.kinematics import Kinematics


@dataclass(frozen=True, slots=True, kw_only=True)
class Naming:
    """What is named for the point: its kind, a ``frame`` and a ``tool`` of the cell; None: not named."""

    as_: Kind | None = None
    frame: str | None = None
    tool: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class TaughtOnce:
    """The point and its notes, what it was before (None: it is new), and by how much it has changed."""

    taught: Taught
    old: Point | None
    change: TouchUp | None


class OneOff:
    """One point of the program at ``path``; the files are read at once and written by ``save``."""

    def __init__(
        self, path: Path, name: str, naming: Naming, cell: Path | None = None, robot: str | None = None
    ) -> None:
        """``Fault`` and ``FileFault`` for files that cannot be used, RBL305 for a tool that is not there."""
        documents = load_documents(path, cell)
        self._desk, self._naming, self._name = Desk(documents), naming, name
        project = load_project(documents.typed(), robot=robot)
        self._old = project.points.get(name)
        spec = project.cell.robot
        self.around = Surroundings(
            points=project.points,
            cell=project.cell,
            kinematics=Kinematics(spec),
            X_flange_tool=lowering.tool(naming.tool, project.cell) if naming.tool else project.cell.hand.X_flange_tool,
            q_last=np.array(project.cell.home),
        )

    @property
    def axes(self) -> int:
        """Number of axes of the robot."""
        return self.around.cell.robot.n

    @property
    def _frame(self) -> str:
        """The frame of a pose: as named, else that of the point as it is."""
        named = self._naming.frame
        if named is None:
            return "" if self._old is None else self._old.frame
        return "" if named.upper() == "WORLD" else named

    def joints_of(self, pose: Six) -> Array:
        """Return joint angles (n,) rad for the tool at a pose, mm and deg, in the frame.

        Those nearest to the point as it is, or to home; ``Fault`` RBL410, RBL411 or RBL412 where it is not reached.
        """
        around = self.around
        near = np.array(around.q_last)
        if self._old is not None:
            # a point that is out of reach says nothing of where the arm should stand
            with suppress(Fault):
                near = reached_point(self._old, around, near)
        return reached(Place(pose=pose, frame=self._frame), around, near)

    def teach(self, q: Array, new_as: Kind | None = None) -> TaughtOnce:
        """Put the point into the points file, at joint angles q (n,) rad; ``save`` writes it. ``Fault`` RBL30x.

        ``new_as``: the kind of a new point where none is named.
        """
        old, around, naming = self._old, self.around, self._naming
        named = old
        if old is not None and old.pose is not None:
            # what is named replaces what the point has
            named = old.replaced(frame=self._frame, tool=old.tool if naming.tool is None else naming.tool)
        name, as_ = (self._name, naming.as_ or new_as) if old is None else (old.name, naming.as_)
        taught = taught_point(name, as_, q, around, frame=self._frame, old=named)
        if naming.tool is not None and taught.point.pose is not None:
            # as it was named, also where that of the hand is the same
            taught = replace(taught, point=taught.point.replaced(tool=naming.tool))
        documents = points_document.set_point(self._desk.documents, taught.point, around.cell.robot.name)
        self._desk.change(documents, f"teach {name}")
        return TaughtOnce(taught=taught, old=old, change=None if old is None else change(old, taught.point, q, around))

    def save(self) -> tuple[Path, ...]:
        """Write what has been taught, and return the files; ``Fault`` RBL312, RBL714."""
        return self._desk.save()
