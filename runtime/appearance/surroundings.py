"""What stands around a robot: obstacles, tables on legs, and parts."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePosixPath

import numpy as np

from runtime.appearance.coarser import coarser
from runtime.appearance.scene import SceneBody, SceneJoint, Shape
from runtime.appearance.solids import Z, box, cylinder
from runtime.cell.body_mesh import BodyMesh
from runtime.cell.cell import ObstacleSpec, PartSpec
from runtime.core.frames import Array, pose
from runtime.core.mesh import Mesh

LEG = 0.045
"""Edge of a table's leg, m."""
LEG_INSET = 0.05
"""Distance of the middle of a leg from the edges of its table, m."""
LOWEST_TABLE, THICKEST_TABLE = 0.15, 0.15
"""A box whose underside is higher than the one, and which is thinner than the other, m, is the top of a table."""
MOST_FACES = 60_000
"""Triangles of all meshes of parts and obstacles that are kept: about 0.6 MB in a log."""
LEVEL = 0.999
"""Cosine of how far a top may lean and still stand on legs."""


Names = Mapping[BodyMesh, str]
"""The names that meshes have in a scene."""


def mesh_names(bodies: Iterable[ObstacleSpec | PartSpec]) -> Names:
    """Return a name for each mesh of parts and obstacles."""
    meshes = dict.fromkeys(each.mesh for each in bodies if each.mesh is not None)
    return {mesh: f"cell:{k}:{PurePosixPath(mesh.name).stem[:40]}" for k, mesh in enumerate(meshes)}


def drawn_meshes(names: Names) -> dict[str, Mesh]:
    """Return the meshes of a scene by their names, coarser where they are many."""
    return dict(zip(names.values(), coarser([each.mesh for each in names], MOST_FACES), strict=True))


def obstacle_bodies(obstacles: Sequence[ObstacleSpec]) -> list[SceneBody]:
    """Return a body for each obstacle, fixed in the world."""
    return [
        SceneBody(name=_name(each), parent=None, X_parent_body=each.X_world_obstacle)  # its middle
        for each in obstacles
    ]


def obstacle_shapes(obstacles: Sequence[ObstacleSpec], names: Names) -> list[Shape]:
    """Return the shape of each obstacle, and legs to the floor where it is a table."""
    return [shape for each in obstacles for shape in _obstacle(each, names)]


def _name(obstacle: ObstacleSpec) -> str:
    return f"obstacle:{obstacle.name}"


def _obstacle(obstacle: ObstacleSpec, names: Names) -> list[Shape]:
    name, size = _name(obstacle), obstacle.size
    if obstacle.mesh is not None:
        return [_meshed(name, names[obstacle.mesh], "obstacle", obstacle.name)]
    # without legs: a round top is rather a drum than a table
    if obstacle.shape == "cylinder":
        return [_upright(name, size, "obstacle", obstacle.name)]
    under = float(obstacle.X_world_obstacle[2, 3] - size[2] / 2.0)
    level = obstacle.X_world_obstacle[2, 2] >= LEVEL
    if not (level and under >= LOWEST_TABLE and size[2] <= THICKEST_TABLE and min(size[:2]) >= 4.0 * LEG_INSET):
        return [box(name, np.eye(4), size, "obstacle", obstacle.name)]
    x, y = size[0] / 2.0 - LEG_INSET, size[1] / 2.0 - LEG_INSET
    z = -(size[2] + under) / 2.0
    legs = [
        box(name, pose([sx * x, sy * y, z]), (LEG, LEG, under), "leg", "leg")
        for sx in (-1.0, 1.0)
        for sy in (-1.0, 1.0)
    ]
    return [box(name, np.eye(4), size, "table", obstacle.name), *legs]


def part_bodies(parts: Sequence[PartSpec]) -> list[SceneBody]:
    """Return a body for each part: where it stands at first, and with a joint by which its poses are its own."""
    return [
        SceneBody(
            name=_part_name(part),
            parent=None,
            X_parent_body=part.X_world_part,
            joint=SceneJoint(kind="prismatic", axis=np.array([0.0, 0.0, 1.0]), source="part", index=index),
        )
        for index, part in enumerate(parts)
    ]


def part_shapes(parts: Sequence[PartSpec], names: Names) -> list[Shape]:
    """Return the shape of each part."""
    return [_part(part, names) for part in parts]


def _part(part: PartSpec, names: Names) -> Shape:
    body = _part_name(part)
    if part.mesh is not None:
        return _meshed(body, names[part.mesh], "part", part.name)
    if part.shape == "cylinder":
        return _upright(body, part.size, "part", part.name)
    return box(body, np.eye(4), part.size, "part", part.name)


def _meshed(body: str, mesh: str, role: str, name: str) -> Shape:
    return Shape(body=body, kind="mesh", X_body_shape=np.eye(4), size=(), role=role, name=name, mesh=mesh)


def _upright(body: str, size: Array, role: str, name: str) -> Shape:
    """Return the cylinder along z in a box of ``size`` (3,) m."""
    radius, half = float(size[0]) / 2.0, float(size[2]) / 2.0
    return cylinder(body, -half * Z, half * Z, (radius, radius), role, name)


def _part_name(part: PartSpec) -> str:
    return f"part:{part.name}"
