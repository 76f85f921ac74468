"""Points that a page teaches: saved at once, since a page has no session of its own that could be lost later."""

from typing import cast

from robolang.execution.session import Session
from robolang.project.project import Project, load_project
from robolang.teaching.desk import Desk
from robolang.teaching.line_map import LineMap
from robolang.teaching.points_document import set_point
from robolang.teaching.taught import Kind, taught_point
from robolang.view.messages import Teach
from runtime.core.faults import Fault


class PageTeaching:
    """Teaches points into the files of a program that is run. ``robot`` replaces that of the cell."""

    def __init__(self, desk: Desk, robot: str | None = None) -> None:
        self._desk, self._robot = desk, robot

    def project(self) -> Project:
        """Return the program with its files as they are now."""
        return load_project(self._desk.typed, robot=self._robot)

    def teach(self, session: Session, wanted: Teach) -> tuple[str, ...]:
        """Teach a point where the arm stands, save it, and let the program go on with it; return what is to be known.

        ``Fault`` RBL808 for a point that is there already and is not to be replaced; RBL303, RBL718 for the name;
        RBL312, RBL714 where the file cannot be written. The points are then as before.
        """
        executor, before = session.executor, session.executor.project
        old = before.points.get(wanted.name)
        if old is not None and not wanted.replace:
            raise Fault("RBL808", f"{old.name} is taught already", "Confirm that it is to be replaced.")
        # spelled as it is taught: names differ by more than their case
        name = wanted.name if old is None else old.name
        q, around = session.controller.areas.ina, session.world.around
        taught = taught_point(name, cast("Kind | None", wanted.kind), q, around, frame=executor.frame, old=old)
        self._desk.change(set_point(self._desk.documents, taught.point, before.cell.robot.name), f"teach {name}")
        try:
            executor.adopt(self.project(), self._desk.lines)
            self._save(session, before)
        except Fault:
            # for good: nobody has a redo here
            self._desk.refuse()
            raise
        return taught.notes

    def _save(self, session: Session, before: Project) -> None:
        try:
            self._desk.save()
        except Fault:
            # it is not in the files, so the program does not go on with it either
            session.executor.adopt(before, LineMap())
            raise
