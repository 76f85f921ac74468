"""The file of an arm, by its ending: a robot file in TOML, or a model file (URDF, MJCF) with its sidecar.

Either gives axes, ranges and rated payload without numerics; ``importer`` makes a robot of it. Nothing outside of the
folder of a file is opened.
"""

from pathlib import Path

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, read_source
from runtime.robot.files import robot_file
from runtime.robot.files.joint_ranges import kinds_of, ranges_of
from runtime.robot.files.plausibility import doubt_axes
from runtime.robot.files.robot_file import RobotFile
from runtime.robot.files.sidecar_file import (
    NO_OVERLAY,
    SidecarFile,
    check_kinds,
    lacking_of,
    read_overlay,
    read_sidecar,
    sidecar_path,
)
from runtime.robot.files.xmlfile import Element, parse_xml
from runtime.robot.model.drives import Limits, PathLimits

MODEL_ENDINGS = (".urdf", ".xml")
ROBOT_ENDINGS = (".toml", *MODEL_ENDINGS)
"""Endings of the names of robot files."""
_TAGS = ("robot", "mujoco")
"""Root elements of URDF and MJCF; they decide which of the two a file is, since both may end in .xml."""


class ModelFile(Record):
    """A model file, well-formed, and its sidecar. Without a complete one it is an ideal arm: what it lacks is estimated
    by ``importer``, and not known here. ``partial`` is the text of a sidecar that lacks values."""

    source: Source
    name: str
    ranges: tuple[Limits, ...]
    sidecar: SidecarFile | None
    partial: Source | None

    @property
    def rated_payload(self) -> float | None:
        """Heaviest load at the flange, kg; None without a sidecar."""
        return None if self.sidecar is None else self.sidecar.rated_payload

    @property
    def path(self) -> PathLimits | None:
        """Limits of the tool point; None without a sidecar."""
        return None if self.sidecar is None else self.sidecar.path

    @property
    def limits(self) -> tuple[Limits, ...]:
        """Limits of every axis; of a model without a sidecar the ranges alone, the others without end."""
        return self.ranges if self.sidecar is None else tuple(axis.limits for axis in self.sidecar.axes)

    @property
    def warnings(self) -> tuple[FileFault, ...]:
        """Doubts about the ranges, speeds, jerks and gears of its sidecar (RBL627 to RBL629)."""
        return () if self.sidecar is None else doubt_axes(self.sidecar.axes)


ArmFile = RobotFile | ModelFile


def is_model(name: str) -> bool:
    """Return whether a name is that of a URDF or MJCF file."""
    return name.lower().endswith(MODEL_ENDINGS)


def read_arm_file(path: Path) -> ArmFile:
    """Return the content of the file of an arm; ``FileFault`` RBL6xx."""
    source = read_source(path)
    if not is_model(path.name):
        return robot_file.parse(source)
    root = model_root(source)
    text = sidecar_source(path)
    overlay = NO_OVERLAY if text is None else read_overlay(text)
    # before what it lacks: the keys of an axis follow from its kind
    check_kinds(overlay, kinds_of(root))
    complete = text is not None and lacking_of(text, path.name) is None
    key = "name" if root.tag == "robot" else "model"  # the attribute with the name in URDF and in MJCF
    return ModelFile(
        source=source,
        name=root.text(key, "robot"),
        ranges=ranges_of(root, overlay.ranges),
        sidecar=read_sidecar(text, path.name) if text is not None and complete else None,
        partial=None if complete else text,
    )


def model_root(source: Source) -> Element:
    """Return the root element of a model file; ``FileFault`` RBL621 for XML of another kind."""
    root = parse_xml(source)
    if root.tag not in _TAGS:
        root.fail("RBL621", f"<{root.tag}> is neither URDF (<robot>) nor MJCF (<mujoco>)")
    return root


def sidecar_source(model: Path) -> Source | None:
    """Return the text of the sidecar of a model file, None where there is none; ``FileFault`` RBL600."""
    # a symbolic link that leads nowhere does not exist; it is read, and refused, rather than taken for no sidecar
    beside = sidecar_path(model)
    return read_source(beside) if beside.is_symlink() or beside.exists() else None
