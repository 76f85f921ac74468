"""The recording of a prompt: what was done since the start state of the cell, kept in a file as a program.

The program is made anew from the record of the run after every line, so what ``back`` takes back is no more in it, and
after ``again`` it begins anew. It stands with its points, and where it needs one with its cell, in files of its own.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from robolang.core.source import MAX_BYTES
from robolang.core.source import Source as ProgramSource
from robolang.core.storage import check_writable, write_atomic
from robolang.pendant.failure import of_fault
from robolang.pendant.output import Output
from robolang.pendant.outputs import refuse_open
from robolang.project.builtin import cell_text
from robolang.project.discovery import own_cell, points_file
from robolang.syntax.formatter import format_source
from robolang.teaching.desk import Desk
from robolang.teaching.documents import Documents
from robolang.teaching.points_document import point_values
from robolang.teaching.toml_text import numbers, set_table, written
from runtime.cell.cell_file import parse_cell_file
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source, read_source

if TYPE_CHECKING:
    from robolang.pendant.live import Live
    from robolang.project.points import Point
    from robolang.project.project import Project
    from robolang.teaching.recorded import Recorded

_MARK = "Recorded at the prompt of robolang"
_HEAD = (
    f"' {_MARK}: what was done since the start state of the cell.",
    "' It is written anew after every line of the prompt, and begins anew with again.",
)
_FORMATTED = 500
"""Lines up to which the program has the layout of ``fmt``: it is written after every line, and that takes time."""


class _Choice(Protocol):
    @property
    def robot(self) -> str | None:
        """The robot in place of the cell's."""


class Recordable(Protocol):
    """A prompt, as far as it is recorded; ``Pendant`` is one."""

    desk: Desk
    output: Output

    @property
    def choice(self) -> _Choice:
        """What the command line has chosen."""

    @property
    def project(self) -> "Project":
        """The documents, read as a program."""

    @property
    def built(self) -> "Live | None":
        """The controller, where a line has needed it already."""


class Recording:
    """What is recorded, if anything: ``path`` of the program, and how many ``statements`` it has."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.statements = 0
        self._written: dict[Path, str] = {}

    def begin(self, path: Path, pendant: Recordable) -> None:
        """Record to a file, ``.rbl`` being added to another name; ``Fault`` RBL706, with no file changed."""
        if path.suffix != ".rbl":
            # not with_suffix: a name such as station.2 has a dot of its own
            path = path.parent / f"{path.name}.rbl"
        files = (points_file(path), own_cell(path), path)
        refuse_open(files, pendant.desk.documents)
        for file in files:
            check_writable(file)
            _refuse_foreign(file)
        cell = _cell(path, pendant.desk.documents)
        if cell is not None:
            # a robot file lies in the folder of its cell, and in another folder it is not found
            parse_cell_file(Source(str(own_cell(path)), cell), path.parent)
        self.path, self.statements, self._written = path, 0, {}
        self.write(pendant)

    def stop(self) -> None:
        """Record no more; the files stay."""
        self.path = None

    @contextmanager
    def kept(self, pendant: Recordable) -> Iterator[None]:
        """Write what has been done within the block, also where that failed or the terminal was lost."""
        done = False
        try:
            yield
            done = True
        finally:
            try:
                self.write(pendant)
            except Fault as fault:
                # it would fail again after each line
                self.stop()
                if done:
                    raise
                pendant.output.problem(of_fault(fault).text)

    def write(self, pendant: Recordable) -> None:
        """Write what has been done so far, where it is recorded; ``Fault`` RBL706, RBL810."""
        if self.path is None:
            return
        refuse_open([self.path], pendant.desk.documents)
        found = _recorded(pendant)
        texts = _texts(self.path, found, pendant)
        if len(texts[self.path].encode()) > MAX_BYTES:
            message = f"the program would have more than {MAX_BYTES} bytes; {self.path} has what was done before"
            raise Fault("RBL810", message, "Record the next part to another file, after again.")
        for path, text in texts.items():
            # most lines of a prompt do nothing, and a write flushes the disk
            if self._written.get(path) != text:
                _write(path, text.encode())
                self._written[path] = text
        self.statements = 0 if found is None else len(found.lines)


def _write(path: Path, data: bytes) -> None:
    write_atomic(path, lambda stream: stream.write(data))


def _refuse_foreign(path: Path) -> None:
    """Refuse a file that is there and is no recording: it may be the only one of its kind."""
    if path.exists() and _MARK not in read_source(path).text.partition("\n")[0]:
        raise Fault("RBL706", f"{path} is there already and is no recording", "Give another name.")


def _recorded(pendant: Recordable) -> "Recorded | None":
    """Return what has been done; None where there is no controller yet."""
    live = pendant.built
    if live is None:
        return None
    # late, as all that imports numerics
    from robolang.teaching.recorded import recorded

    return recorded(live.session.record, live.arm.joints)


def _texts(path: Path, found: "Recorded | None", pendant: Recordable) -> dict[Path, str]:
    """Return the files by path, in the order of writing: what a program names is there before it."""
    documents = pendant.desk.documents
    texts: dict[Path, str] = {}
    # an old file there would count, so it is replaced even where no point is named any more
    if found is not None and (found.points or points_file(path).exists()):
        texts[points_file(path)] = _points(found.points, pendant.project.cell.robot.name)
    cell = _cell(path, documents)
    if cell is not None:
        texts[own_cell(path)] = cell
    head = [*_HEAD, *([f"' Program: {documents.path}"] if documents.named else [])]
    if pendant.choice.robot is not None:
        head.append(f"' Robot: --robot {pendant.choice.robot}")
    lines = [*head, "", *(found.lines if found is not None else ())]
    text = "".join(f"{line}\n" for line in lines)
    texts[path] = text if len(lines) > _FORMATTED else format_source(ProgramSource(str(path), text)).text
    return texts


def _points(points: "tuple[Point, ...]", robot: str) -> str:
    text = f"# {_MARK}: the taught points that it names, as they were then.\nschema = 1\nrobot = {written(robot)}\n"
    for point in points:
        text = set_table(text, "points", point.name, {**point_values(point), **_exact(point)})
    return text


def _exact(point: "Point") -> dict[str, str | None]:
    """Return the numbers of a point in full: another program is to go to the same place."""
    values = {"pose": point.pose, "joints": point.joints}
    return {key: None if value is None else numbers(map(repr, value)) for key, value in values.items()}


def _cell(path: Path, documents: Documents) -> str | None:
    """Return the cell file of a recording, None where the program finds the same cell without one."""
    beside = path.with_name("cell.toml")
    # compared by its text: changes of the cell that are not saved yet count in this session
    found = read_source(beside).text if beside.exists() else None
    if found == documents.cell and not own_cell(path).exists():
        return None
    return f"# {_MARK}: its cell.\n" + (cell_text() if documents.cell is None else documents.cell)
