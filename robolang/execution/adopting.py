"""An edited program, or other taught points, in the place of those that are carried out.

The machine is moved to the edited program (``interpreter.adopting``); what names statements, such as the record, the
alarms and the moves that are kept, is moved to their new lines. Variables, settings, outputs, the arm and the log stay.
"""

from dataclasses import dataclass, replace
from typing import TypeVar

from robolang.execution.engine import Engine
from robolang.execution.progress import Aside, Progress
from robolang.interpreter.adopting import Lines, ProgramEdit, moved, moved_place
from robolang.interpreter.effects import Origin
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.project.project import Project

Placed = TypeVar("Placed", bound=Origin)


@dataclass(frozen=True, slots=True, kw_only=True)
class Edit:
    """A project before and after an edit, and where the lines of its program went."""

    old: Project
    new: Project
    lines: Lines

    @property
    def program(self) -> ProgramEdit:
        """The edit of the program."""
        return ProgramEdit(old=self.old.program, new=self.new.program, lines=self.lines)


@dataclass(frozen=True, slots=True, kw_only=True)
class Adoption:
    """A state that has been moved to an edited project; ``adopt`` puts it in place."""

    edit: Edit
    machine: MachineSnapshot
    progress: Progress


def prepared(engine: Engine, edit: Edit) -> Adoption:
    """Return the state of an engine in an edited project; ``Fault`` RBL543. Nothing has changed."""
    machine = moved(engine.machine.snapshot(), edit.program)
    return Adoption(edit=edit, machine=machine, progress=_Names(edit).progress(engine, engine.now))


def adopt(engine: Engine, adoption: Adoption) -> None:
    """Let an engine go on with an edited project."""
    become(engine, adoption.edit.new)
    engine.machine.restore(adoption.machine)
    engine.now = adoption.progress
    engine.target.rename(_Names(adoption.edit).of)


def become(engine: Engine, project: Project) -> None:
    """Give an engine a project whose program has not begun: a snapshot of it is restored next."""
    engine.project = project
    engine.machine = engine.machine.successor(project.program, project.points.names)
    engine.world.adopt(project.points, project.cell)
    engine.target.adopt(project)


class _Names:
    """Statements by their places in the edited text."""

    def __init__(self, edit: Edit) -> None:
        self._edit, self._program = edit, edit.program
        self._index = {line.source_line: index for index, line in enumerate(edit.old.program.lines)}

    def of(self, origin: Placed) -> Placed:
        """Return a place in the edited text; one in a line that was removed stays a place of the old text."""
        index = self._index.get(origin.line)
        if origin.source is not None or index is None:
            return origin
        to = self._program.of(index)
        if to is None:
            return replace(origin, line=0, number=None, source=self._edit.old.source)
        old, line = self._edit.old.program.lines[index], self._edit.new.program.lines[to]
        by = line.span.start - old.span.start
        # the part of a statement that was changed is not known: the whole of it is named
        same = old.statement == line.statement
        span = type(origin.span)(origin.span.start + by, origin.span.end + by) if same else line.span
        return replace(origin, line=line.source_line, number=line.number, span=span)

    def any(self, thing: object) -> object:
        """Return what may be a place, or the fault or the move at one."""
        return self.of(thing) if isinstance(thing, Origin) else thing

    def progress(self, engine: Engine, now: Progress) -> Progress:
        """Return how far a program has come, in the edited one; ``Fault`` RBL543."""
        fault, failed = now.fault, now.failed
        changed: dict[str, object] = {
            **self._doing(now),
            "chain": tuple(replace(each, effect=self.of(each.effect)) for each in now.chain),
            "aside": tuple(self._aside(engine, each) for each in now.aside),
            "again": self._machine(now.again),
            "fault": None if fault is None else replace(fault, origin=self.of(fault.origin)),
            "failed": None if failed is None else moved_place(failed, self._program),
        }
        return replace(now, **changed)  # type: ignore[arg-type]

    def _doing(self, now: Progress | Aside) -> dict[str, object]:
        return {
            "doing": tuple(self.of(each) for each in now.doing),
            "request": self.any(now.request),
            "due": self.any(now.due),
            "places": tuple(moved(each, self._program) for each in now.places),
        }

    def _aside(self, engine: Engine, aside: Aside) -> Aside:
        changed: dict[str, object] = {
            **self._doing(aside),
            "statement": self.any(aside.statement),
            "left": engine.target.renamed(aside.left, self.of),
            "again": self._machine(aside.again),
        }
        return replace(aside, **changed)  # type: ignore[arg-type]

    def _machine(self, state: MachineSnapshot | None) -> MachineSnapshot | None:
        return None if state is None else moved(state, self._program)
