"""Reading MJCF: nested bodies to the tree of ``imported``, without MuJoCo.

What is read: ``compiler`` (angle, autolimits, eulerseq), ``default`` classes for joints and geoms, ``body`` with its
pose (quat, euler, axisangle, xyaxes or zaxis), ``inertial`` (diaginertia or fullinertia), ``joint`` of type hinge or
slide (pos, axis, range, armature, damping, frictionloss, actuatorfrcrange), ``site``, which can name the flange. Angles
are degrees unless the compiler says radian. Source of the meanings: the MJCF reference of MuJoCo's documentation.

What would change the dynamics and is not read is refused (RBL621): a mass that MuJoCo would infer from shapes, joint
springs, ``ref``, gravity compensation, includes, macros. Equality constraints close loops (RBL611).
"""

import math
from dataclasses import dataclass
from pathlib import PurePosixPath

import numpy as np

from runtime.core.frames import Array, frozen, pose, rotation_about
from runtime.core.linear import dot, matmul, norm
from runtime.core.units import DEG, GRAVITY
from runtime.robot.files.imported import Hinge, Node, NodeMesh, rotation_z_to
from runtime.robot.files.urdf import unit
from runtime.robot.files.xmlfile import HEAVIEST_LINK, Element
from runtime.robot.model.axis_kind import MJCF_KINDS, REVOLUTE, AxisKind
from runtime.robot.model.spec import Body

_TOP = frozenset(
    [
        "compiler",
        "option",
        "size",
        "statistic",
        "default",
        "asset",
        "worldbody",
        "contact",
        "equality",
        "actuator",
        "sensor",
        "keyframe",
        "visual",
        "custom",
        "include",
    ]
)
_IN_BODY = frozenset(["body", "joint", "freejoint", "inertial", "geom", "site", "camera", "light", "include"])
_ORIENTATIONS = ("quat", "euler", "axisangle", "xyaxes", "zaxis")
# settings that change geometry or bodies, with the default under which they change nothing
_UNREAD_COMPILER = {
    "coordinate": "local",
    "inertiafromgeom": "auto",
    "balanceinertia": "false",
    "boundmass": "0",
    "boundinertia": "0",
    "settotalmass": "-1",
}
_UNREAD_JOINT = {"ref": 0.0, "springref": 0.0, "stiffness": 0.0}
SHOWN = 2
"""Last of the groups of geoms that MuJoCo shows unless it is changed there; later ones are for contacts."""
_GRAVITY_SLACK = 0.05
"""Gravity differs by this much from place to place, m/s2: 9.78 at the equator, 9.83 at the poles."""

Defaults = dict[tuple[str, str], dict[str, str]]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Context:
    """What holds for the whole file: rad per unit of angle, limits by range, Euler sequence, default classes, and the
    file and scale (3,) of each mesh by name."""

    angle: float
    autolimits: bool
    eulerseq: str
    defaults: Defaults
    meshes: dict[str, tuple[str, Array]]


def read_mjcf(model: Element, file_name: str) -> tuple[str, Node]:
    """Return the model's name and the root of its tree; ``FileFault`` at the element that is wrong."""
    for child in model.children:
        if child.tag not in _TOP:
            child.fail("RBL621", f"<{child.tag}> is not read")
    # includes first, wherever they stand: they may hold any part of the model
    for element in model.walk():
        _refuse_include(element, file_name)
    for equality in model.all("equality"):
        for constraint in equality.children:
            constraint.fail("RBL611", f"an equality of kind <{constraint.tag}> closes a loop")
    _check_options(model)
    context = _context(model)
    root = Node(name="world", element=model, X_parent_node=np.eye(4))
    worlds = model.all("worldbody")
    if not worlds:
        model.fail("RBL608", "the model has no <worldbody>")
    names: set[str] = set()
    for world in worlds:
        _fill(root, world, context, "main", names, moving=False)
    _check_actuators(model, names)
    return model.text("model", "robot"), root


def _refuse_include(element: Element, file_name: str) -> None:
    if element.tag != "include":
        return
    # RBL603 of its own for the loop: "give the file that holds the arm" would be no help there
    if element.text("file").removeprefix("./") == file_name:
        element.fail("RBL603", f"{file_name} includes itself")
    element.fail("RBL621", "an include is not followed", "give the file that holds the arm itself")


def _check_options(model: Element) -> None:
    """Refuse settings that would change the dynamics and are not read; ``FileFault`` RBL621."""
    for compiler in model.all("compiler"):
        for key, usual in _UNREAD_COMPILER.items():
            if compiler.text(key, usual) != usual:
                compiler.fail("RBL621", f'compiler {key}="{compiler.text(key)}" is not read')
    for option in model.all("option"):
        gravity = np.array(option.numbers("gravity", 3, (0.0, 0.0, -GRAVITY)))
        if not np.abs(gravity - [0.0, 0.0, -GRAVITY]).max() <= _GRAVITY_SLACK:
            option.fail("RBL621", "gravity is not that of an arm standing on the ground", "turn the first body instead")


def _context(model: Element) -> _Context:
    """Return what compiler and defaults set for the whole file; a later compiler section overrides an earlier one."""
    settings: dict[str, str] = {}
    for compiler in model.all("compiler"):
        settings |= compiler.attributes
        if compiler.text("angle", "degree") not in ("degree", "radian"):
            compiler.fail("RBL610", "angle must be degree or radian")
        if len(seq := compiler.text("eulerseq", "xyz")) != 3 or not set(seq.lower()) <= set("xyz"):
            compiler.fail("RBL610", "eulerseq must be three of x, y, z, X, Y, Z")
    defaults: Defaults = {}
    for element in model.all("default"):
        _read_defaults(element, "main", {}, defaults)
    return _Context(
        angle=1.0 if settings.get("angle", "degree") == "radian" else DEG,
        autolimits=settings.get("autolimits", "true") == "true",
        eulerseq=settings.get("eulerseq", "xyz"),
        defaults=defaults,
        meshes=_mesh_files(model, settings, defaults),
    )


def _read_defaults(element: Element, name: str, inherited: dict[str, dict[str, str]], into: Defaults) -> None:
    """Enter class ``name`` and those inside it: each takes over what its parent sets."""
    own = {kind: dict(values) for kind, values in inherited.items()}
    # the other kinds (site, camera, actuator ...) set nothing that is read
    for kind in ("joint", "geom", "mesh"):
        for setting in element.all(kind):
            own[kind] = own.get(kind, {}) | setting.attributes
        into[name, kind] = own.get(kind, {})
    for child in element.all("default"):
        class_name = child.text("class")
        if (class_name, "joint") in into:
            child.fail("RBL610", f"two default classes are named {class_name!r}")
        _read_defaults(child, class_name, own, into)


def _with_defaults(element: Element, context: _Context, childclass: str) -> Element:
    """Return the element with what its default class sets for it."""
    name = element.text("class", childclass)
    if name != "main" and (name, element.tag) not in context.defaults:
        element.fail("RBL610", f"there is no default class {name!r}")
    attributes = context.defaults.get((name, element.tag), {}) | element.attributes
    return Element(element.source, element.tag, attributes, element.line, element.column, element.children)


def _fill(node: Node, body: Element, context: _Context, childclass: str, names: set[str], *, moving: bool) -> None:
    """Hang on ``node`` what a body holds. ``moving``: a joint lies between it and the world, so its mass counts."""
    # a body fixed to the world is the base: it never moves, and files often give it no inertial
    node.body = _body(body, context, childclass, node.name) if moving else None
    node.meshes = (*node.meshes, *_meshes(body, context, childclass))
    for child in body.children:
        if child.tag not in _IN_BODY:
            child.fail("RBL621", f"<{child.tag}> is not read")
        if child.tag == "site" and child.attributes.get("name"):
            node.children.append(
                Node(name=child.text("name"), element=child, X_parent_node=_pose(child, context), marker=True)
            )
        if child.tag == "body":
            _add_body(node, child, context, childclass, names, moving)


def _add_body(parent: Node, body: Element, context: _Context, childclass: str, names: set[str], moving: bool) -> None:
    if body.number("gravcomp", 0.0) != 0.0 or body.text("mocap", "false") != "false":
        body.fail("RBL621", "gravcomp and mocap are not read")
    # a class of the body holds for its own joints and for all bodies inside it, unless an element names another
    childclass = body.text("childclass", childclass)
    X_parent_body = _pose(body, context)
    joints = [child for child in body.children if child.tag in ("joint", "freejoint")]
    name = body.text("name", "")
    for index, joint in enumerate(joints):  # several joints of a body move one inside the other, in this order
        last = index == len(joints) - 1  # the nodes between have no mass and no name of their own
        hinge = _hinge(_with_defaults(joint, context, childclass), context, names)
        node = Node(name=name if last else "", element=body, X_parent_node=X_parent_body, hinge=hinge, between=not last)
        parent.children.append(node)
        parent, X_parent_body = node, np.eye(4)
    if not joints:
        node = Node(name=name, element=body, X_parent_node=X_parent_body)
        parent.children.append(node)
    _fill(node, body, context, childclass, names, moving=moving or bool(joints))


def _hinge(joint: Element, context: _Context, names: set[str]) -> Hinge:
    """Return what a joint says of itself and enter its name in ``names``; ``FileFault`` for a ball."""
    name = joint.text("name", "") or f"joint{len(names) + 1}"
    kind = None if joint.tag == "freejoint" else MJCF_KINDS.get(joint.text("type", "hinge"))
    if kind is None:
        joint.fail("RBL621", f"joint {name!r} is neither a hinge nor a slide")
    if name in names:
        joint.fail("RBL610", f"two joints are named {name!r}")
    names.add(name)
    for key, usual in _UNREAD_JOINT.items():
        if joint.number(key, usual) != usual:
            joint.fail("RBL621", f"'{key}' of joint {name!r} is not read")
    lower, upper = _range(joint, context, name, kind)
    effort = _effort(joint, name)
    return Hinge(
        name=name,
        element=joint,
        axis=unit(joint, "axis") if "axis" in joint.attributes else frozen([0.0, 0.0, 1.0]),
        anchor=frozen(joint.point("pos")),
        lower=lower,
        upper=upper,
        speed=None,
        effort=effort,
        damping=joint.number("damping", 0.0, low=0.0),
        friction=joint.number("frictionloss", 0.0, low=0.0),
        armature=joint.number("armature", 0.0, low=0.0),
        in_degrees=context.angle != 1.0 and kind is REVOLUTE,
        kind=kind,
    )


def _effort(joint: Element, name: str) -> float | None:
    """Return the effort, N m or N, that a joint has in both directions, None where the file gives none; RBL607."""
    if "actuatorfrcrange" not in joint.attributes:
        return None
    low, high = joint.numbers("actuatorfrcrange", 2)
    if not low < high:
        joint.fail(
            "RBL607", f"actuatorfrcrange of joint {name!r} is [{low:g}, {high:g}]: the first must be the smaller one"
        )
    return min(abs(low), abs(high)) or None


def _range(joint: Element, context: _Context, name: str, kind: AxisKind) -> tuple[float | None, float | None]:
    """Return the ends of a range, rad or m, None where the joint has none; ``FileFault`` RBL607 or RBL608."""
    limited = joint.text("limited", "auto")
    if limited not in ("true", "false", "auto"):
        joint.fail("RBL610", f"limited of joint {name!r} must be true, false or auto")
    if "range" not in joint.attributes or limited == "false":
        return None, None
    lower, upper = joint.numbers("range", 2)
    if not lower < upper:
        joint.fail(
            "RBL607", f"the range of joint {name!r} is [{lower:g}, {upper:g}]: the first must be the smaller one"
        )
    if limited == "auto" and not context.autolimits:
        joint.fail("RBL608", f'joint {name!r} has a range and autolimits is off: it needs limited="true"')
    # the setting is for angles: a slide has m whatever it says
    size = context.angle if kind is REVOLUTE else 1.0
    return lower * size, upper * size


def _body(body: Element, context: _Context, childclass: str, name: str) -> Body | None:
    """Return the body in its own frame, None where it has no mass; ``FileFault`` RBL610 or RBL621."""
    # without <inertial> MuJoCo would infer mass and inertia from the shapes and their density; only shapes whose mass
    # is stated as 0 say that the body has none
    inertial = body.one("inertial")
    if inertial is None:
        for geom in (_with_defaults(g, context, childclass) for g in body.all("geom")):
            if geom.number("mass", 1.0, low=0.0) > 0.0:
                geom.fail(
                    "RBL621",
                    f"the mass of body {name!r} would have to be inferred from its shapes",
                    "write an <inertial> with mass, pos and diaginertia or fullinertia",
                )
        return None
    X = _pose(inertial, context)
    R = X[:3, :3]
    if "fullinertia" in inertial.attributes:
        if any(key in inertial.attributes for key in (*_ORIENTATIONS, "diaginertia")):
            inertial.fail("RBL610", "fullinertia goes with neither an orientation nor diaginertia")
        xx, yy, zz, xy, xz, yz = inertial.numbers("fullinertia", 6)
        # order of MuJoCo's fullinertia: xx, yy, zz, xy, xz, yz
        I_own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        I_own = np.diag(inertial.numbers("diaginertia", 3))
    mass = inertial.number("mass", low=0.0, high=HEAVIEST_LINK)
    return Body(mass=mass, cog=frozen(X[:3, 3]), inertia=frozen(matmul(R, I_own, R.T)))


def _mesh_files(model: Element, settings: dict[str, str], defaults: Defaults) -> dict[str, tuple[str, Array]]:
    """Return file and scale (3,) of each mesh of the assets that has a file, by name."""
    folder = settings.get("meshdir", settings.get("assetdir", ""))
    found = {}
    for mesh in (each for asset in model.all("asset") for each in asset.all("mesh")):
        own = defaults.get((mesh.text("class", "main"), "mesh"), {}) | mesh.attributes
        if "file" in own:
            full = Element(mesh.source, mesh.tag, own, mesh.line, mesh.column)
            file = full.text("file")
            scale = frozen(full.numbers("scale", 3, (1.0, 1.0, 1.0)))
            found[full.text("name", PurePosixPath(file).stem)] = (str(PurePosixPath(folder) / file), scale)
    return found


def _meshes(body: Element, context: _Context, childclass: str) -> tuple[NodeMesh, ...]:
    """Return the mesh files that show a body: of the geoms that MuJoCo itself shows."""
    found = []
    for geom in (_with_defaults(each, context, childclass) for each in body.all("geom")):
        name = geom.attributes.get("mesh")
        if name in context.meshes and geom.number("group", 0.0) <= SHOWN:
            file, scale = context.meshes[name]
            found.append(NodeMesh(file=file, X_node_mesh=frozen(_pose(geom, context)), scale=scale))
    return tuple(found)


def _pose(element: Element, context: _Context) -> Array:
    return pose(element.point("pos"), _rotation(element, context))


def _rotation(element: Element, context: _Context) -> Array:
    """Return the rotation (3, 3) of an element by the one orientation that it gives; ``FileFault`` RBL610 for two."""
    given = [key for key in _ORIENTATIONS if key in element.attributes]
    if len(given) > 1:
        element.fail("RBL610", f"<{element.tag}> has two orientations, {given[0]} and {given[1]}")
    if not given:
        return np.eye(3)
    return {"quat": _quat, "euler": _euler, "axisangle": _axisangle, "xyaxes": _xyaxes, "zaxis": _zaxis}[given[0]](
        element, context
    )


def _quat(element: Element, context: _Context) -> Array:
    q = np.array(element.numbers("quat", 4))  # w first, of any length: MuJoCo normalises it as well
    length = norm(q)
    if not length > 1e-9:
        element.fail("RBL605", "a quaternion of no length")
    w, x, y, z = q / length
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _euler(element: Element, context: _Context) -> Array:
    """Return the rotation of three angles: small letters turn about the moving axes, capitals about the fixed ones."""
    R = np.eye(3)
    for letter, angle in zip(context.eulerseq, element.numbers("euler", 3), strict=True):
        turn = rotation_about(np.eye(3)["xyz".index(letter.lower())], angle * context.angle)
        R = matmul(R, turn) if letter.islower() else matmul(turn, R)
    return R


def _axisangle(element: Element, context: _Context) -> Array:
    *axis, angle = element.numbers("axisangle", 4)
    return np.asarray(rotation_about(_direction(element, np.array(axis)), angle * context.angle))


def _xyaxes(element: Element, context: _Context) -> Array:
    values = np.array(element.numbers("xyaxes", 6))
    x = _direction(element, values[:3])
    # y made square to x, since six printed digits seldom are
    y = _direction(element, values[3:] - matmul(values[3:], x) * x)
    return np.stack([x, y, np.cross(x, y)], axis=-1)


def _zaxis(element: Element, context: _Context) -> Array:
    return rotation_z_to(_direction(element, np.array(element.numbers("zaxis", 3))))


def _direction(element: Element, v: Array) -> Array:
    length = math.sqrt(dot(v, v))
    if not length > 1e-9:
        element.fail("RBL605", f"an axis of <{element.tag}> has no direction")
    return v / length


def _check_actuators(model: Element, names: set[str]) -> None:
    """Refuse an actuator of a joint that is not there (RBL610); actuators are not read otherwise: drives are ours."""
    for section in model.all("actuator"):
        for actuator in section.children:
            joint = actuator.attributes.get("joint")
            if joint is not None and joint not in names:
                actuator.fail("RBL610", f"there is no joint {joint!r}")
