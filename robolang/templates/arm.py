"""The robot of a project: a built-in one, or a file that the project holds in its own folder.

A cell opens nothing outside of its folder, so a file from elsewhere is copied, with its sidecar and its meshes; one
that is in the folder already is named from there.
"""

from collections.abc import Mapping
from pathlib import Path

from robolang.project.discovery import no_robot
from runtime.core.record import Record
from runtime.core.tomlfile import read_source
from runtime.robot.files import robot_file
from runtime.robot.files.arm_file import ROBOT_ENDINGS, is_model, read_arm_file, sidecar_source
from runtime.robot.files.sidecar_file import sidecar_path


class Arm(Record):
    """A robot: ``reference`` is what the cell of the project says, ``source`` a built-in name or the path of its file.

    ``files`` are those to copy, by their names in the project.
    """

    name: str
    reference: str
    source: str
    files: Mapping[str, bytes]

    @property
    def folder(self) -> Path:
        """The folder of its file, where a cell names it as ``read_as``."""
        return Path() if self.is_builtin else Path(self.source).parent

    @property
    def read_as(self) -> str:
        """What a cell in ``folder`` says."""
        return Path(self.source).name

    @property
    def is_builtin(self) -> bool:
        """Whether it is a robot of the library."""
        return self.source in robot_file.library()


def choose(robot: str, project: Path) -> Arm:
    """Return a robot for a project in a folder; ``Fault`` RBL708 for none, ``FileFault`` RBL6xx for a bad file."""
    if robot in robot_file.library():
        return Arm(name=robot, reference=robot, source=robot, files={})
    if not robot.lower().endswith(ROBOT_ENDINGS):
        raise no_robot(robot)
    path = Path(robot)
    name = read_arm_file(path).name
    inside = _inside(path, project)
    reference, files = (path.name, _copied(path)) if inside is None else (inside, {})
    return Arm(name=name, reference=reference, source=robot, files=files)


def _inside(path: Path, project: Path) -> str | None:
    """Return how a file is named from the folder of a project; None for one that is outside."""
    # resolved: a link in the project that leads out is outside, and the cell would not follow it
    try:
        return path.resolve().relative_to(project.resolve()).as_posix()
    except ValueError:
        return None


def _copied(path: Path) -> dict[str, bytes]:
    files = {path.name: read_source(path).text.encode()}
    # a model without a sidecar is an ideal arm
    sidecar = sidecar_source(path) if is_model(path.name) else None
    return files if sidecar is None else {**files, sidecar_path(path).name: sidecar.text.encode()}
