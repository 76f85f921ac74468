"""The meshes that the model of an imported arm names, as shapes on its links.

Only files in the folder of the model are opened, wherever links in it lead (R22). What cannot be used is left out and
noted; the link is then drawn from its joint frames. Meshes go into every log, so fine ones are made coarser.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from runtime.appearance.coarser import coarser
from runtime.core.bounded_files import RefusedError, read_bounded, resolved_inside, stays_inside
from runtime.core.frames import frozen
from runtime.core.linear import matmul
from runtime.core.mesh import Mesh
from runtime.core.mesh_files import MESH_ENDINGS, MOST_BYTES, MeshError, read_mesh
from runtime.robot.model.spec import LinkMesh

MOST_FACES = 30_000
"""Triangles of all meshes of a robot that are kept: about 0.3 MB in a log."""
MOST_MESHES = 200
"""Mesh files of a robot that are read."""
MOST_COPIED = 100_000_000
"""Bytes of all mesh files that a copy of a model gets."""
LARGEST = 20.0
"""A mesh that is larger, m, is in another unit than its scale says."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnMeshes:
    """Meshes by link (0: the base), in the frame of the link, m; ``notes`` on what was left out."""

    links: tuple[tuple[int, str, Mesh], ...]
    notes: tuple[str, ...]


def own_meshes(meshes: tuple[LinkMesh, ...]) -> OwnMeshes:
    """Return what can be drawn of the mesh files of a robot."""
    found: list[tuple[int, str, Mesh]] = []
    notes, torn = [], set()
    for index, each in enumerate(meshes):
        try:
            if index >= MOST_MESHES:
                raise MeshError(f"is one of more than {MOST_MESHES}")
            found.append((each.link, f"{index}:{Path(each.file).stem[:40]}", _placed(each)))
        except MeshError as error:
            notes.append(f"{each.file} {error}")
            torn.add(each.link)
    # a link that lacks one of its meshes would have a hole: its joint frames draw it instead
    whole = [each for each in found if each[0] not in torn]
    coarse = coarser([mesh for _, _, mesh in whole], MOST_FACES)
    links = tuple((link, name, mesh) for (link, name, _), mesh in zip(whole, coarse, strict=True))
    return OwnMeshes(links=links, notes=tuple(notes))


def _placed(mesh: LinkMesh) -> Mesh:
    """Return a mesh in the frame of its link, m; ``MeshError``."""
    read = read_mesh(_located(mesh)[1])
    vertices = read.vertices * mesh.scale
    if not np.ptp(vertices, axis=0).max() <= LARGEST:
        raise MeshError(f"is larger than {LARGEST:g} m: its scale is that of another unit")
    X = mesh.X_link_mesh
    placed = frozen(matmul(vertices, X[:3, :3].T) + X[:3, 3])
    # a mirrored mesh has its faces inside out
    mirrored = bool(np.prod(mesh.scale) < 0.0)
    return Mesh(vertices=placed, faces=read.faces[:, ::-1] if mirrored else read.faces)


def mesh_files(meshes: tuple[LinkMesh, ...]) -> dict[str, bytes]:
    """Return the mesh files of a robot by their names in the folder of its model.

    What cannot be drawn is left out, and so is what comes after ``MOST_COPIED`` bytes.
    """
    found: dict[str, bytes] = {}
    for each in meshes[:MOST_MESHES]:
        try:
            name, path = _located(each)
            data = read_bounded(path, MOST_BYTES) if path.suffix.lower() in MESH_ENDINGS else b""
        # RefusedError: own_meshes notes it where the mesh would be drawn
        except (MeshError, RefusedError):
            continue
        if data and sum(map(len, found.values())) + len(data) <= MOST_COPIED:
            found[name] = data
    return found


def _located(mesh: LinkMesh) -> tuple[str, Path]:
    """Return name and path of a mesh file inside of the folder of its model; ``MeshError``.

    A name with ``package://`` counts from a folder of that name, or from the model's own.
    """
    folder = Path(mesh.folder)
    name = re.sub(r"^(package|model)://", "", mesh.file)
    # a package may be the folder of the model itself, whose name nobody knows here
    names = [name]
    if name != mesh.file and "/" in name:
        names.append(name.split("/", 1)[1])
    for each in names:
        if not stays_inside(each):
            break
        try:
            path = resolved_inside(folder / each, folder, strict=True)
        except (OSError, RuntimeError, ValueError):
            continue
        if path is None:
            raise MeshError("is a link that leads out of the folder of the model")
        return each, path
    raise MeshError("is not in the folder of the model")
