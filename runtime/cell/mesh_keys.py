"""The keys of a part or an obstacle that is a mesh: its file, inside the folder of the cell file, and its scale.

Reading a mesh needs numerics, which are imported where a cell has one: a check of any other cell starts sooner.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Table, inside

if TYPE_CHECKING:
    from runtime.cell.body_mesh import BodyMesh

MOST_FILES = 100
"""Mesh files of a cell."""
LONGEST_MM, SHORTEST_MM = 20_000.0, 1.0
"""The longest edge of the box around a mesh is between these: beyond them its numbers are in another unit."""
THINNEST_MM = 0.1
"""Least edge of the box around a mesh, as that of a box."""
FILLED = 1.2
"""Volume of the hull over that of the mesh from which on RBL645 notes that contacts fill what is hollow."""


class MeshFile(Record):
    """A mesh that has been read. ``filled``: the user has noted that contacts are those of its hull."""

    mesh: "BodyMesh"
    filled: bool

    @property
    def size_mm(self) -> tuple[float, ...]:
        """The edges of the box around it, mm."""
        return tuple(float(each) * 1000.0 for each in self.mesh.size)

    def doubt(self, what: str, item: Table) -> FileFault | None:
        """Return the note (RBL645) that contacts of a body have another shape than its mesh."""
        if self.filled or not self.mesh.filled > FILLED:
            return None
        return item.fault(
            "RBL645",
            f"{what} is hollow or has corners that go in, and contacts fill them: their shape, its convex hull, has "
            f"{self.mesh.filled:.2f} times the volume of the mesh",
            key="file",
        )


class MeshKeys:
    """Reads the meshes of one cell file, each file once for a scale."""

    def __init__(self, folder: Path | None) -> None:
        """``folder`` is that of the cell file, None for a cell held as text, which can name no file."""
        self._folder = folder
        self._read: dict[tuple[str, float], BodyMesh | _Refused] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The files that the cell names, each once."""
        return tuple(dict.fromkeys(name for name, _ in self._read))

    def read(self, table: Table) -> MeshFile:
        """Read ``file``, ``scale`` and ``filled``; ``FileFault`` RBL602, RBL605, RBL643 or RBL644."""
        name = table.text("file")
        scale = table.number("scale", 1.0, low=1e-6, high=1e6)
        filled = table.flag("filled", default=False)
        path = inside(table, name, self._folder, "file")
        # by the name, not by the file: two links to one file are two names
        if (name, scale) not in self._read:
            # before it is read: a hundred hulls take minutes already
            if len(self._read) >= MOST_FILES:
                table.fail("RBL643", f"'{name}' is one of more than {MOST_FILES} meshes", key="file")
            self._read[name, scale] = _read(path, name, scale)
        found = self._read[name, scale]
        # every body that names it has its fault at its own line
        if isinstance(found, _Refused):
            table.fail(found.code, f"'{name}' {found.why}", key="file")
        _check_size(table, found, scale)
        return MeshFile(mesh=found, filled=filled)


class _Refused(Record):
    """Why a file gives no mesh."""

    code: str
    why: str


def _read(path: Path, name: str, scale: float) -> "BodyMesh | _Refused":
    try:
        from runtime.cell.body_mesh import read_body_mesh
        from runtime.core.mesh_files import MeshError
        from runtime.core.solid import NoSolidError
    except ModuleNotFoundError as error:
        # an install that checks text has no numerics: the other programs of the folder are checked all the same
        return _Refused(code="RBL643", why=f"cannot be read: that needs {error.name}, which is not installed")
    try:
        return read_body_mesh(path, name, scale)
    except MeshError as error:
        return _Refused(code="RBL643", why=str(error))
    except NoSolidError as error:
        return _Refused(code="RBL644", why=str(error))


def _check_size(table: Table, mesh: "BodyMesh", scale: float) -> None:
    edges = [float(each) * 1000.0 for each in mesh.size]
    if not (SHORTEST_MM <= max(edges) <= LONGEST_MM and min(edges) >= THINNEST_MM):
        shown = " x ".join(f"{each:.6g}" for each in edges)
        table.fail(
            "RBL605",
            f"'{mesh.name}' is {shown} mm with scale {scale:g}; its longest edge must be between {SHORTEST_MM:g} and "
            f"{LONGEST_MM:g} mm, its shortest at least {THINNEST_MM:g} mm",
            "scale times a number of the file is mm: 1 for a file in mm, 1000 for one in m, 25.4 for one in inches",
            key="scale" if "scale" in table else "file",
        )
