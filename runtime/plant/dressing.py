"""The shapes of a scene as geoms of MuJoCo: without mass and contact, in a group of their own.

MuJoCo has neither cylinders with rounded rims nor tapered limbs, so those are meshes, each written once.
"""

import xml.etree.ElementTree as ET
from collections.abc import Mapping

import numpy as np

from runtime.appearance.scene import Scene, Shape
from runtime.appearance.turned import turned
from runtime.core.frames import Array, pose
from runtime.core.linear import matmul
from runtime.core.mesh import Mesh
from runtime.plant.mjcf import place, row

GROUP = 2
"""Geom group of what is only seen; physics has its shapes in group 0."""
LEAST_AREA = 1e-10
"""Area of the smallest mesh that is drawn, m2: MuJoCo refuses one without any."""
_LEAST_VERTICES = 4  # of a mesh of MuJoCo
EDGE = 0.0012
"""Half the thickness of the edges of a part, m."""

Carriers = Mapping[str, tuple[ET.Element, Array]]
"""The element that carries a body of the scene, and X_element_body (4, 4)."""


def dress(root: ET.Element, scene: Scene, carriers: Carriers) -> None:
    """Add the shapes of a scene to the MJCF document ``root``, each on the element that carries its body.

    Those of ``undrawable`` meshes are left out.
    """
    wardrobe = _Wardrobe(root, scene)
    for index, shape in enumerate(scene.shapes):
        carrier, X_carrier_body = carriers[shape.body]
        wardrobe.put(carrier, matmul(X_carrier_body, shape.X_body_shape), shape, f"shape{index}")


def undrawable(scene: Scene) -> tuple[str, ...]:
    """Return the names of the meshes that have no area to be seen, which a file may well have."""
    return tuple(name for name, mesh in scene.meshes.items() if not _has_area(mesh))


def dressed(mjcf: str, scene: Scene) -> str:
    """Return the MJCF text of ``build_mjcf`` with a scene on its bodies; what physics has as shapes is in group 3.

    Motion is not changed, to the last bit. A run has no need of it; it is for those who watch physics itself.
    """
    root = ET.fromstring(mjcf)
    for geom in root.iter("geom"):
        if geom.get("name", "floor") != "floor":
            geom.set("group", "3")
    world = root.find("worldbody")
    assert world is not None, "build_mjcf writes one"
    elements = {body.get("name"): body for body in root.iter("body")}
    carriers: dict[str, tuple[ET.Element, Array]] = {}
    for body in scene.bodies:
        # what physics does not move is a part of the body that carries it there
        element, X = (world, np.eye(4)) if body.parent is None else carriers[body.parent]
        own = elements.get(body.name)
        carriers[body.name] = (element, matmul(X, body.X_parent_body)) if own is None else (own, np.eye(4))
    dress(root, scene, carriers)
    return ET.tostring(root, encoding="unicode")


class _Wardrobe:
    """The materials and meshes that have been written to a document."""

    def __init__(self, root: ET.Element, scene: Scene) -> None:
        self._assets, self._scene = ET.SubElement(root, "asset"), scene
        self._turned: dict[tuple[str, tuple[float, ...]], str | None] = {}
        for role, colour in scene.colours.items():
            shine = {"metal": ("0.5", "0.6"), "rubber": ("0.1", "0.1")}.get(role, ("0.25", "0.4"))
            ET.SubElement(self._assets, "material", name=role, rgba=rgba(colour), specular=shine[0], shininess=shine[1])
        # numbered: a name may be any text, which XML does not take
        self._meshes = {name: self._write(f"mesh{k}", mesh) for k, (name, mesh) in enumerate(scene.meshes.items())}

    def put(self, carrier: ET.Element, X: Array, shape: Shape, name: str) -> None:
        """Add a shape at X_carrier_shape."""
        if shape.kind == "box":
            _geom(carrier, X, shape.role, name, type="box", size=row(np.array(shape.size) / 2.0))
            if shape.role == "part":
                self._edges(carrier, X, shape, name)
        elif shape.kind == "sphere":
            _geom(carrier, X, shape.role, name, type="sphere", size=row(shape.size))
        elif (mesh := self._mesh_of(shape)) is not None:
            _geom(carrier, X, shape.role, name, type="mesh", mesh=mesh)

    def _mesh_of(self, shape: Shape) -> str | None:
        if shape.mesh is not None:
            return self._meshes[shape.mesh]
        key = (shape.kind, shape.size)
        if key not in self._turned:
            self._turned[key] = self._write(f"turned{len(self._turned)}", turned(shape))
        return self._turned[key]

    def _write(self, name: str, mesh: Mesh) -> str | None:
        """Write a mesh and return its name; None for one that cannot be drawn."""
        if not _has_area(mesh):
            return None
        # a triangle has too few
        vertices = np.resize(mesh.vertices, (max(len(mesh.vertices), _LEAST_VERTICES), 3))
        # a shell: MuJoCo refuses a mesh whose volume is nearly none, which a file may well have
        ET.SubElement(
            self._assets,
            "mesh",
            name=name,
            inertia="shell",
            vertex=row(vertices.ravel()),
            face=" ".join(map(str, mesh.faces.ravel().tolist())),
        )
        return name

    def _edges(self, carrier: ET.Element, X: Array, shape: Shape, name: str) -> None:
        """Draw the twelve edges of a part, by which it is seen before a table of nearly its colour."""
        half = np.array(shape.size) / 2.0
        for axis in range(3):
            size = np.full(3, EDGE)
            size[axis] = half[axis] + EDGE
            across = [k for k in range(3) if k != axis]
            for signs in ((-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)):
                at = np.zeros(3)
                at[across] = half[across] * signs
                edge = f"{name}_edge{axis}{signs[0] > 0:d}{signs[1] > 0:d}"
                _geom(carrier, matmul(X, pose(at)), "edge", edge, type="box", size=row(size))


def _has_area(mesh: Mesh) -> bool:
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return bool(np.sqrt((np.cross(b - a, c - a) ** 2).sum(axis=1)).sum() / 2.0 >= LEAST_AREA)


def rgba(colour: str) -> str:
    """Return the rgba text of a colour ``#rrggbb``."""
    return row([*(int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)), 1.0])


def _geom(carrier: ET.Element, X: Array, role: str, name: str, **attributes: str) -> None:
    ET.SubElement(
        carrier,
        "geom",
        {
            "name": name,
            "material": role,
            "group": str(GROUP),
            "contype": "0",
            "conaffinity": "0",
            "mass": "0",
            **place(X),
            **attributes,
        },
    )
