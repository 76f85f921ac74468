"""Reading URDF: links and joints to the tree of ``imported``.

A joint's ``origin`` places its child link's frame in the parent's at angle zero (``rpy`` about fixed axes, R = Rz Ry
Rx); ``axis`` is in that frame, through its origin, x when it is left out. The inertia is about the centre of
gravity, in the frame of the inertial's own origin. Source: the URDF specification, wiki.ros.org/urdf/XML.

``revolute`` and ``continuous`` joints turn, ``prismatic`` ones slide, ``fixed`` ones join; another kind of joint is
refused (RBL621), and so are springs. Elements of other programs are left out (``left_out``). A continuous joint has
no range, and none is invented for it. Of shapes only the meshes of ``visual`` are kept, by name, for pictures; a
mesh outside the folder is refused (RBL602).
"""

import math

import numpy as np

from runtime.core.frames import Array, frozen, pose, rotation_from_rpy
from runtime.core.linear import dot, matmul
from runtime.core.mesh_files import MESH_ENDINGS
from runtime.robot.files.imported import Hinge, Node, NodeMesh
from runtime.robot.files.xmlfile import HEAVIEST_LINK, Element, is_elsewhere
from runtime.robot.model.axis_kind import URDF_KINDS, AxisKind
from runtime.robot.model.spec import Body


def read_urdf(robot: Element) -> tuple[str, Node]:
    """Return the robot's name and the root of its tree; ``FileFault`` at the element that is wrong."""
    links = _by_name(robot.all("link"))
    joints = _by_name(robot.all("joint"))
    if not links:
        robot.fail("RBL608", "the robot has no link")
    nodes = {
        name: Node(name=name, element=link, X_parent_node=np.eye(4), body=_body(link), meshes=_meshes(link))
        for name, link in links.items()
    }
    placed: dict[str, str] = {}
    for name, joint in joints.items():
        start, hung = (_end(joint, end, nodes) for end in ("parent", "child"))
        if hung in placed:
            # refused before it is joined: the tree would hold the link twice, and its mass with it
            joint.fail("RBL611", f"link {hung!r} is the child of two joints, {placed[hung]!r} and {name!r}: a loop")
        placed[hung] = name
        _join(joint, nodes[start], nodes[hung])
    return robot.text("name", "robot"), _root(robot, nodes, placed)


def _by_name(elements: list[Element]) -> dict[str, Element]:
    """Return elements by their names, in file order; ``FileFault`` RBL610 at the second of one name."""
    found: dict[str, Element] = {}
    for element in elements:
        name = element.text("name")
        if name in found:
            element.fail("RBL610", f"two {element.tag}s are named {name!r}")
        found[name] = element
    return found


def _end(joint: Element, end: str, nodes: dict[str, Node]) -> str:
    """Return the link at an end of a joint, ``parent`` or ``child``; ``FileFault`` RBL608 or RBL610 for none."""
    element = joint.one(end)
    if element is None:
        joint.fail("RBL608", f"joint {joint.text('name')!r} has no <{end}>")
    link = element.text("link")
    if link not in nodes:
        element.fail("RBL610", f"there is no link {link!r}")
    return link


def _root(robot: Element, nodes: dict[str, Node], placed: dict[str, str]) -> Node:
    """Return the one link that is no joint's child and carries all others; ``FileFault`` RBL611 for loops and islands.

    ``placed``: the joint whose child each link is, by link.
    """
    roots = [node for name, node in nodes.items() if name not in placed]
    if not roots:
        robot.fail("RBL611", "every link is the child of a joint: the joints form a loop")
    if len(roots) > 1:
        roots[1].element.fail("RBL611", f"links {roots[0].name!r} and {roots[1].name!r} are not joined")
    # one root does not mean one tree: links in a loop of their own have a parent each, and none of them is the root
    reached, todo = set(), [roots[0]]
    while todo:
        node = todo.pop()
        reached.add(node.name)
        todo += node.children
    for name, node in nodes.items():
        if name not in reached:
            node.element.fail("RBL611", f"link {name!r} is not joined to {roots[0].name!r}: its joints form a loop")
    return roots[0]


def _join(joint: Element, parent: Node, child: Node) -> None:
    """Hang one link on another by a joint; ``FileFault`` RBL621 for a kind that is not read."""
    kind = joint.text("type")
    child.X_parent_node = _origin(joint)
    parent.children.append(child)
    if kind == "fixed":
        return
    if kind not in URDF_KINDS:
        joint.fail("RBL621", f"joint {joint.text('name')!r} is {kind}; only {', '.join(URDF_KINDS)} and fixed are read")
    if (mimic := joint.one("mimic")) is not None:
        mimic.fail("RBL621", f"joint {joint.text('name')!r} mimics another: it is not an axis of its own")
    child.hinge = _hinge(joint, URDF_KINDS[kind], ranged=kind != "continuous")


def _hinge(joint: Element, kind: AxisKind, ranged: bool) -> Hinge:
    """Return what a joint of a kind says of itself; ``ranged`` False: it has no end stops."""
    name, limit, dynamics, axis = joint.text("name"), joint.one("limit"), joint.one("dynamics"), joint.one("axis")
    if dynamics is not None and dynamics.number("spring_stiffness", 0.0) != 0.0:
        dynamics.fail("RBL621", f"joint {name!r} has a spring, which is not read")
    lower, upper = _range(limit, name, kind) if limit is not None and ranged else (None, None)
    speed, effort = _most(limit, "velocity", name), _most(limit, "effort", name)
    return Hinge(
        name=name,
        element=joint,
        # x is the specification's default for an axis that is left out
        axis=unit(axis, "xyz") if axis is not None else frozen([1.0, 0.0, 0.0]),
        anchor=frozen(np.zeros(3)),
        lower=lower,
        upper=upper,
        speed=speed,
        effort=effort,
        damping=dynamics.number("damping", 0.0, low=0.0) if dynamics is not None else 0.0,
        friction=dynamics.number("friction", 0.0, low=0.0) if dynamics is not None else 0.0,
        armature=0.0,
        in_degrees=False,
        endless=not ranged,
        kind=kind,
    )


def _range(limit: Element, name: str, kind: AxisKind) -> tuple[float | None, float | None]:
    """Return the ends of a joint's range, rad or m, None for what is left out; ``FileFault`` RBL607 for an empty one.

    The specification has 0 for an end that is left out, which gives no range: both must be written to count.
    """
    lower, upper = _given(limit, "lower"), _given(limit, "upper")
    if lower is not None and upper is not None and not lower < upper:
        given = f"{lower:g} to {upper:g} {kind.coordinate}"
        limit.fail("RBL607", f"the range of joint {name!r} is {given}: lower must be below upper")
    return lower, upper


def _most(limit: Element | None, key: str, name: str) -> float | None:
    """Return the largest speed or effort of a joint, None where the file gives none or 0; ``FileFault`` RBL605."""
    value = None if limit is None else _given(limit, key)
    if limit is not None and value is not None and not value >= 0.0:
        limit.fail("RBL605", f"'{key}' of joint {name!r} is {value:g} and must be 0 or more")
    return value or None  # 0 stands in many files for a value that is not known: <limit> requires both attributes


def _given(limit: Element, key: str) -> float | None:
    return limit.number(key) if key in limit.attributes else None


def unit(element: Element, key: str) -> Array:
    """Return the direction (3,) of an attribute as a unit vector; RBL605 for one of no length."""
    values = np.array(element.numbers(key, 3))
    length = math.sqrt(dot(values, values))
    if not length > 1e-9:
        element.fail("RBL605", f"'{key}' of <{element.tag}> has no direction")
    return frozen(values / length)


def _origin(element: Element) -> Array:
    """Return the pose (4, 4) of the ``<origin>`` of an element, the unit pose where it has none."""
    origin = element.one("origin")
    if origin is None:
        return np.eye(4)
    return pose(origin.point("xyz"), rotation_from_rpy(origin.numbers("rpy", 3, (0.0,) * 3)))


def _body(link: Element) -> Body | None:
    """Return the body of a link in the link's frame, None for a link without ``<inertial>``; ``FileFault`` RBL608."""
    inertial = link.one("inertial")
    if inertial is None:
        return None
    mass, inertia = inertial.one("mass"), inertial.one("inertia")
    if mass is None or inertia is None:
        inertial.fail("RBL608", f"the inertial of link {link.text('name')!r} needs <mass> and <inertia>")
    xx, yy, zz, xy, xz, yz = (inertia.number(key) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    X = _origin(inertial)
    R = X[:3, :3]
    # the products stand in the file as entries of the matrix, not as the negative integrals of some textbooks
    I_own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    kg = mass.number("value", low=0.0, high=HEAVIEST_LINK)
    return Body(mass=kg, cog=frozen(X[:3, 3]), inertia=frozen(matmul(R, I_own, R.T)))


def _meshes(link: Element) -> tuple[NodeMesh, ...]:
    """Return the mesh files that show a link; shapes without a file are left out.

    Where those of ``visual`` are in a format that is not read, as COLLADA, those of ``collision`` show it if they are.
    """
    shown, simple = _of_shapes(link.all("visual")), _of_shapes(link.all("collision"))
    return simple if simple and _are_read(simple) and not _are_read(shown) else shown


def _are_read(meshes: tuple[NodeMesh, ...]) -> bool:
    return all(mesh.file.lower().endswith(MESH_ENDINGS) for mesh in meshes)


def _of_shapes(shapes: list[Element]) -> tuple[NodeMesh, ...]:
    found = []
    for visual in shapes:
        geometry = visual.one("geometry")
        mesh = None if geometry is None else geometry.one("mesh")
        if mesh is not None and "filename" in mesh.attributes and not is_elsewhere(mesh):
            scale = frozen(mesh.numbers("scale", 3, (1.0, 1.0, 1.0)))
            found.append(NodeMesh(file=mesh.text("filename"), X_node_mesh=frozen(_origin(visual)), scale=scale))
    return tuple(found)
