"""Reading URDF: links and joints to the tree of ``imported``.

A joint's ``origin`` places its child link's frame in the parent's at angle zero (``rpy`` about fixed axes, R = Rz Ry
Rx); ``axis`` is in that frame, through its origin, x when it is left out. The inertia is about the centre of
gravity, in the frame of the inertial's own origin. Source: the URDF specification, wiki.ros.org/urdf/XML.

``revolute`` and ``continuous`` joints turn, ``fixed`` ones join; anything else is refused (RBL621). A continuous joint
has no range, and none is invented for it. Shapes are ignored, but a mesh outside the folder is refused (RBL602).
"""

import math

import numpy as np

from runtime.core.frames import Array, frozen, pose, rotation_from_rpy
from runtime.core.linear import dot, matmul
from runtime.robot.files.imported import Hinge, Node
from runtime.robot.files.xmlfile import HEAVIEST_LINK, Element
from runtime.robot.model.spec import Body

_IGNORED = ("gazebo", "transmission", "material", "sensor", "ros2_control")
_TURNING = ("revolute", "continuous")


def read_urdf(robot: Element) -> tuple[str, Node]:
    """Return the robot's name and the root of its tree; ``FileFault`` at the element that is wrong."""
    for child in robot.children:
        if child.tag not in ("link", "joint", *_IGNORED):
            child.fail("RBL621", f"<{child.tag}> is not read")
    links = _by_name(robot.all("link"))
    joints = _by_name(robot.all("joint"))
    if not links:
        robot.fail("RBL608", "the robot has no link")
    nodes = {
        name: Node(name=name, element=link, X_parent_node=np.eye(4), body=_body(link)) for name, link in links.items()
    }
    placed: dict[str, str] = {}
    for name, joint in joints.items():
        start, hung = (_end(joint, end, nodes) for end in ("parent", "child"))
        if hung in placed:
            joint.fail("RBL611", f"link {hung!r} hangs on two joints, {placed[hung]!r} and {name!r}: a loop")
        placed[hung] = name
        _join(joint, nodes[start], nodes[hung])
    return robot.text("name", "robot"), _root(robot, nodes, placed)


def _by_name(elements: list[Element]) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in elements:
        name = element.text("name")
        if name in found:
            element.fail("RBL610", f"two {element.tag}s are named {name!r}")
        found[name] = element
    return found


def _end(joint: Element, end: str, nodes: dict[str, Node]) -> str:
    element = joint.one(end)
    if element is None:
        joint.fail("RBL608", f"joint {joint.text('name')!r} has no <{end}>")
    link = element.text("link")
    if link not in nodes:
        element.fail("RBL610", f"there is no link {link!r}")
    return link


def _root(robot: Element, nodes: dict[str, Node], placed: dict[str, str]) -> Node:
    roots = [node for name, node in nodes.items() if name not in placed]
    if not roots:
        robot.fail("RBL611", "every link hangs on another: the joints form a loop")
    if len(roots) > 1:
        roots[1].element.fail("RBL611", f"links {roots[0].name!r} and {roots[1].name!r} are not joined")
    reached, todo = set(), [roots[0]]
    while todo:
        node = todo.pop()
        reached.add(node.name)
        todo += node.children
    for name, node in nodes.items():
        if name not in reached:
            node.element.fail("RBL611", f"link {name!r} hangs on itself, in a loop, and not on {roots[0].name!r}")
    return roots[0]


def _join(joint: Element, parent: Node, child: Node) -> None:
    kind = joint.text("type")
    child.X_parent_node = _origin(joint)
    parent.children.append(child)
    if kind == "fixed":
        return
    if kind not in _TURNING:
        joint.fail("RBL621", f"joint {joint.text('name')!r} is {kind}; only revolute, continuous and fixed are read")
    if (mimic := joint.one("mimic")) is not None:
        mimic.fail("RBL621", f"joint {joint.text('name')!r} mimics another: it is not an axis of its own")
    child.hinge = _hinge(joint, ranged=kind == "revolute")


def _hinge(joint: Element, ranged: bool) -> Hinge:
    limit, dynamics, axis = joint.one("limit"), joint.one("dynamics"), joint.one("axis")

    def given(key: str) -> float | None:
        return limit.number(key) if limit is not None and key in limit.attributes else None

    # lower and upper are 0 when they are left out (the specification), which is no range: they must be written
    lower, upper = (given("lower"), given("upper")) if ranged else (None, None)
    name = joint.text("name")
    if limit is not None and lower is not None and upper is not None and not lower < upper:
        limit.fail("RBL607", f"joint {name!r} goes from {lower:g} to {upper:g} rad")
    for key in ("velocity", "effort"):
        value = given(key)
        if limit is not None and value is not None and not value >= 0.0:
            limit.fail("RBL605", f"'{key}' of joint {name!r} is {value:g} and must be 0 or more")
    return Hinge(
        name=name,
        element=joint,
        axis=unit(axis, "xyz") if axis is not None else frozen([1.0, 0.0, 0.0]),
        anchor=frozen(np.zeros(3)),
        lower=lower,
        upper=upper,
        speed=given("velocity") or None,  # 0 is how many files say that they do not know
        effort=given("effort") or None,
        damping=dynamics.number("damping", 0.0, low=0.0) if dynamics is not None else 0.0,
        friction=dynamics.number("friction", 0.0, low=0.0) if dynamics is not None else 0.0,
        armature=0.0,
        in_degrees=False,
    )


def unit(element: Element, key: str) -> Array:
    """Return the direction (3,) of an attribute as a unit vector; RBL605 for one of no length."""
    values = np.array(element.numbers(key, 3))
    length = math.sqrt(dot(values, values))
    if not length > 1e-9:
        element.fail("RBL605", f"'{key}' of <{element.tag}> has no direction")
    return frozen(values / length)


def _origin(element: Element) -> Array:
    origin = element.one("origin")
    if origin is None:
        return np.eye(4)
    return pose(origin.point("xyz"), rotation_from_rpy(origin.numbers("rpy", 3, (0.0,) * 3)))


def _body(link: Element) -> Body | None:
    inertial = link.one("inertial")
    if inertial is None:
        return None
    mass, inertia = inertial.one("mass"), inertial.one("inertia")
    if mass is None or inertia is None:
        inertial.fail("RBL608", f"the inertial of link {link.text('name')!r} needs <mass> and <inertia>")
    xx, yy, zz, xy, xz, yz = (inertia.number(key) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    X = _origin(inertial)
    R = X[:3, :3]
    I_own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    kg = mass.number("value", low=0.0, high=HEAVIEST_LINK)
    return Body(mass=kg, cog=frozen(X[:3, 3]), inertia=frozen(matmul(R, I_own, R.T)))
