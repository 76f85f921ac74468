"""The cell: its robot, hand, parts and obstacles in SI, with their true properties.

Masses here are the *true* ones: the plant is built from them. The controller knows a payload from ``LOAD`` in the
program alone, and the difference between the two is what payload supervision has to notice. Lengths are mm and
angles degrees in the file, SI in ``CellSpec``; a pose is ``[x, y, z, rx, ry, rz]`` with ``R = Rz @ Ry @ Rx``
(docs/language.md). ``cell_file`` reads the file. Read once, before anything moves.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeVar

import numpy as np

from runtime.cell.body_mesh import BodyMesh
from runtime.cell.cell_file import CellFile, ObstacleFile, PartFile
from runtime.cell.seam_sensor import SensorSpec
from runtime.cell.signals import InputSpec
from runtime.core.frames import Array, frozen, pose_from_xyzrpy
from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG, MM
from runtime.robot.files import importer, robot_file
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.spec import RobotSpec
from runtime.settings.layers import Layer

T = TypeVar("T")
U = TypeVar("U")


@dataclass(frozen=True, slots=True, kw_only=True)
class HandSpec:
    """A hand with two parallel fingers or a suction cup, as it really is; frames: flange and tool (the grip point).

    ``mass`` kg and ``cog`` (3,) m in the flange frame; ``X_flange_tool`` (4, 4): z points to the work piece, the
    fingers close along y; ``stroke`` m between the pads when open; ``grip_force`` N of each finger; ``dwell`` s
    that HAND waits; ``pad`` (3,) m: width along x, thickness, length along z of a finger pad, centred on the tool
    point; ``finger_length`` m from the palm to the tool point.

    ``kind`` ``suction``: a cup whose rim is round the tool point, in its x-y plane. ``finger_length`` is then that of
    the cup, ``grip_force`` its holding force, ``pad`` its radius, its radius and its diameter, and ``stroke`` 0.
    """

    mass: float
    cog: Array
    X_flange_tool: Array
    stroke: float
    grip_force: float
    dwell: float
    pad: Array
    finger_length: float
    kind: str = "fingers"

    @property
    def is_cup(self) -> bool:
        """Whether it holds by suction."""
        return self.kind == "suction"


@dataclass(frozen=True, slots=True, kw_only=True)
class PartSpec:
    """A loose body: ``size`` (3,) m, true ``mass`` kg, ``X_world_part`` (4, 4) of its centre, sliding ``friction``.

    ``shape``: the box of that size, or the cylinder along z or the ``mesh`` that it encloses.
    """

    name: str
    size: Array
    mass: float
    X_world_part: Array
    friction: float
    shape: str = "box"
    mesh: BodyMesh | None = None

    @property
    def cog(self) -> Array:
        """The centre of gravity (3,) m from the centre of the box, in its frame."""
        return np.zeros(3) if self.mesh is None else self.mesh.solid.cog


@dataclass(frozen=True, slots=True, kw_only=True)
class ObstacleSpec:
    """A fixed body: ``size`` (3,) m and ``X_world_obstacle`` (4, 4) of its centre; ``shape`` as of a part."""

    name: str
    size: Array
    X_world_obstacle: Array
    shape: str = "box"
    mesh: BodyMesh | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadSpec:
    """A load a program may declare by name: ``mass`` kg, ``cog`` (3,) m in the flange frame."""

    mass: float
    cog: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraSpec:
    """From where pictures of a cell are taken: ``position`` (3,) m, and ``target`` (3,) m in their middle."""

    position: Array
    target: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class CellSpec:
    """A cell in SI: robot, home joints (n,) rad, hand, parts, obstacles and the names a program may use.

    ``tools`` are poses X_flange_tool, ``frames`` poses X_world_frame (4, 4), ``sensors`` seam sensors, ``inputs`` the
    course of each input. ``controller`` are the settings of the controller profile in the file, ``doubts`` parts that
    cannot rest where they are. ``camera`` None: pictures show the whole of the cell.
    """

    robot: RobotSpec
    home: Array
    hand: HandSpec
    parts: tuple[PartSpec, ...]
    obstacles: tuple[ObstacleSpec, ...]
    loads: Mapping[str, LoadSpec]
    tools: Mapping[str, Array]
    frames: Mapping[str, Array]
    sensors: Mapping[str, SensorSpec]
    inputs: Mapping[int, InputSpec]
    controller: Layer
    doubts: tuple[FileFault, ...]
    camera: CameraSpec | None = None

    @property
    def warnings(self) -> tuple[FileFault, ...]:
        """Doubts about the robot (``plausibility``) and the cell."""
        return (*self.robot.warnings, *self.doubts)


def build(file: CellFile) -> CellSpec:
    """Return the cell of a file that has been read; ``FileFault`` RBL6xx where its arm cannot be."""
    hand, robot = file.hand, _robot(file)
    return CellSpec(
        robot=robot,
        home=frozen(np.array(file.home) * robot.units),
        hand=HandSpec(
            kind=hand.kind,
            mass=hand.mass_kg,
            cog=_lengths(hand.cog_mm),
            X_flange_tool=_pose(hand.tcp_mm_deg),
            stroke=hand.stroke_mm * MM,
            grip_force=hand.grip_force_n,
            dwell=hand.dwell_s,
            pad=_lengths(hand.pad_mm),
            finger_length=hand.finger_length_mm * MM,
        ),
        parts=tuple(
            PartSpec(
                name=part.name,
                shape=part.shape,
                mesh=_mesh(part),
                size=_lengths(part.size_mm),
                mass=part.mass_kg,
                friction=part.friction,
                X_world_part=_pose(part.pose_mm_deg),
            )
            for part in file.parts
        ),
        obstacles=tuple(
            ObstacleSpec(
                name=each.name,
                shape=each.shape,
                mesh=_mesh(each),
                size=_lengths(each.size_mm),
                X_world_obstacle=_pose(each.pose_mm_deg),
            )
            for each in file.obstacles
        ),
        loads=_each(file.loads, lambda load: LoadSpec(mass=load.mass_kg, cog=_lengths(load.cog_mm))),
        tools=_each(file.tools, _pose),
        frames=_each(file.frames, _pose),
        sensors=_each(file.sensors, SensorSpec.of),
        inputs=file.inputs,
        controller=file.controller,
        doubts=file.doubts,
        camera=_camera(file),
    )


def _mesh(body: PartFile | ObstacleFile) -> BodyMesh | None:
    return None if body.mesh is None else body.mesh.mesh


def _camera(file: CellFile) -> CameraSpec | None:
    if file.camera is None:
        return None
    return CameraSpec(position=_lengths(file.camera.position_mm), target=_lengths(file.camera.target_mm))


def _robot(file: CellFile) -> RobotSpec:
    # the file of the library itself, not one of the same name beside the cell: a built-in robot is built only once
    arm = file.arm
    is_builtin = arm.name in robot_file.library() and arm is robot_file.builtin(arm.name)
    return load_builtin(arm.name) if is_builtin else importer.build(arm)


def _lengths(values_mm: tuple[float, ...]) -> Array:
    return frozen(np.array(values_mm) * MM)


def _pose(values_mm_deg: tuple[float, ...]) -> Array:
    # the one place where mm and deg of a cell become SI: everything after it computes without units of files
    values = np.array(values_mm_deg)
    return frozen(pose_from_xyzrpy([*(values[:3] * MM), *(values[3:] * DEG)]))


def _each(found: Mapping[str, T], make: Callable[[T], U]) -> Mapping[str, U]:
    # read-only: a cell is shared by planner, plant and report
    return MappingProxyType({name: make(each) for name, each in found.items()})
