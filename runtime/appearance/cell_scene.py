"""The scene of a cell: robot, hand, obstacles, parts, frames and taught points."""

from collections.abc import Mapping
from types import MappingProxyType

from runtime.appearance.arm import arm_bodies, arm_shapes, mesh_shapes, reach_of
from runtime.appearance.colours import colours_of
from runtime.appearance.hand import hand_bodies, hand_shapes
from runtime.appearance.own_meshes import own_meshes
from runtime.appearance.scene import Mark, Scene, View
from runtime.appearance.surroundings import (
    drawn_meshes,
    mesh_names,
    obstacle_bodies,
    obstacle_shapes,
    part_bodies,
    part_shapes,
)
from runtime.appearance.untrusted import LONGEST_TEXT
from runtime.cell.cell import CellSpec
from runtime.core.frames import Array

NO_POINTS: Mapping[str, Array] = MappingProxyType({})


def scene_of(cell: CellSpec, points: Mapping[str, Array] = NO_POINTS) -> Scene:
    """Return what a cell looks like; ``points`` are taught points by name, X_world_point (4, 4).

    Bodies: ``base``, ``link1`` to ``linkN``, ``flange``, ``tool``, ``finger_left``, ``finger_right``, ``part:NAME`` and
    ``obstacle:NAME``.
    """
    spec = cell.robot
    own = own_meshes(spec.meshes)
    names = mesh_names((*cell.obstacles, *cell.parts))
    return Scene(
        robot=spec.name[:LONGEST_TEXT],
        reach=reach_of(spec),
        bodies=(
            *arm_bodies(spec),
            *hand_bodies(cell.hand),
            *part_bodies(cell.parts),
            *obstacle_bodies(cell.obstacles),
        ),
        shapes=(
            *arm_shapes(spec, {number for number, _, _ in own.links}),
            *mesh_shapes(own),
            *hand_shapes(cell.hand),
            *part_shapes(cell.parts, names),
            *obstacle_shapes(cell.obstacles, names),
        ),
        colours=colours_of(spec.name),
        meshes=MappingProxyType({**{name: mesh for _, name, mesh in own.links}, **drawn_meshes(names)}),
        frames=marks(cell.frames),
        points=marks(points),
        camera=None if cell.camera is None else View(position=cell.camera.position, target=cell.camera.target),
    )


def marks(places: Mapping[str, Array]) -> tuple[Mark, ...]:
    """Return named places, X_world_place (4, 4), as marks."""
    # cut as the reader of a scene demands: a model file and a points file know no longest name
    return tuple(Mark(name=name[:LONGEST_TEXT], X_world_mark=X) for name, X in places.items())
