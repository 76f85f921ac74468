"""The MuJoCo model of a robot in its cell, written as MJCF text from ``RobotSpec`` and ``CellSpec``.

Everything the controller's Pinocchio model has must come out the same here to 1e-9
(tests/runtime/plant/test_plant_model.py): the same placements, the same bodies, rotor inertia as ``armature`` N^2 J.
The plant has in addition what the controller does not know: viscous friction N^2 B (``damping``), Coulomb friction,
the true hand, parts, contacts.

Coulomb friction that differs by direction: ``frictionloss`` is symmetric, so it takes the mean m = (Tf + Tb) / 2
and the rest is a constant torque c = (Tb - Tf) / 2 that the plant applies (``friction_bias``). Turning forward
the joint feels c - m = -Tf, backward c + m = +Tb, and at rest it holds any torque in [-Tf, Tb] as it should.

Elastic gears. Where the robot file gives a spring, the joint is two hinges in series on one axis of one body: the
motor's, with rotor inertia N^2 J, friction and actuator, and the gear's, with spring K and damper C and nothing else.
The first angle is the motor's at the joint side, the link stands at their sum. MuJoCo lets a body have several
joints, so no massless body is needed between them: with M_l the inertia of what the link carries, the inertia of the
two is [[M_l + N^2 J, M_l], [M_l, M_l]], which is regular whenever the rotor has inertia. An axis that slides has slides
in their place. Written out,

    N^2 J ddq_m = tau - friction - K (q_m - q_l) - C (dq_m - dq_l),      M_l ddq_l + h = K (q_m - q_l) + C (dq_m - dq_l)

A grasp is friction between pads and part and nothing else. Two errors of the simulation let a held part wander:

* Regularisation. What sticks creeps at v = R f / b; R = A (1 - d) / d for the impedance d and the inverse inertia
  A that the row sees, divided by ``impratio`` for friction (MuJoCo documentation, Computation, "Constraint
  model"). With the values below that is under 1e-6 m/s for a held part and 1e-6 rad/s for a joint at rest.
* Curvature, which is far larger. The rows ask for J a = -b J v and leave out J' v, the difference of the
  accelerations that pad and part have at zero ``qacc``: a pad on a turning arm moves on an arc, a free part along a
  tangent. The relative speed u = J v then settles at J' v / b; the integrator, which steps with the new speed, adds
  (h / 2 - h) J' v to it. So the part drifts by J' v (1 / b - h / 2): 1.5 mm/s for each m/s2 with the contact time
  constant of 4 h, whatever ``impratio`` or ``noslip`` (neither changes it). The drift vanishes at b
  h = 2, where u alternates undamped (its factor per step is 1 - b h); ``GRIP_DAMPING`` = 1.75 leaves a seventh of the
  drift of the stiffest ordinary contact and a factor of -0.75. tests/runtime/plant/test_plant_grasp.py measures it.
  Shorter steps would have bought the same for 20 times the cost; a weld would have been no grasp.

The text is built here and never read from a user's file, so none of the files that MJCF can open (includes, plugins,
meshes) is ever read (R22): of the meshes of a cell it has the corners of their hulls. MuJoCo is not imported here
(``cell_model``). Read at start, no rate.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping

import numpy as np

from runtime.cell.body_mesh import BodyMesh
from runtime.cell.cell import CellSpec, HandSpec, ObstacleSpec, PartSpec
from runtime.cell.gripper import FINGERS, finger_sign, fingers_of, is_holder, palm_box
from runtime.core.decompositions import symmetric_eigen
from runtime.core.frames import Array, pose
from runtime.core.linear import matmul, norm
from runtime.core.units import GRAVITY
from runtime.plant.hand import finger_body, palm_body
from runtime.plant.inertia import part_inertia
from runtime.robot.model.spec import AxisSpec, Body, RobotSpec

# who meets whom: a geom collides where its contype meets the other's conaffinity, in either order
ENVIRONMENT, ARM, HAND, PART = 1, 2, 4, 8
NOTHING: tuple[int, int] = (0, 0)
COLLIDES = {
    "environment": (ENVIRONMENT, ARM | HAND | PART),
    "arm": (ARM, ENVIRONMENT | PART),
    "hand": (HAND, ENVIRONMENT | PART),
    "part": (PART, ENVIRONMENT | ARM | HAND | PART),
}

CONTACT_TIME = 4.0
"""Time constant of contacts in physics steps; MuJoCo's floor is 2, below about 3 a box on a table chatters."""

GRIP_DAMPING = 1.75
"""b h of the friction between pad and part: damping of slip per physics step; 2 has no drift but no decay."""

FINGER_ARMATURE = 2.0
"""Moving mass of the finger drive (spindle, motor) seen by one finger, kg: not part of the hand's weight."""

FINGER_SPEED = 0.25
"""Speed at which a finger closes under its full force, m/s: force / speed is the damping of the drive."""

_STIFF = "0.9999 0.9999 0.001 0.5 2"
"""Impedance of what should not give: dry joint friction, finger stops and the gearing between the fingers."""

_CONTACT = "0.99 0.99 0.001 0.5 2"
"""Impedance of contacts: the part sinks 0.4 um into the table."""

_LINK_RADIUS = (0.06, 0.04)
"""Radius of the links of the first three axes and of the wrist, m, of an arm whose shapes are not known: looks, and a
coarse body that meets obstacles and parts."""

APART = 3
"""Joints between two links from which on they may meet one another."""

FINGER = ("pad", "shank")
"""Shapes of a finger."""


def build_mjcf(
    spec: RobotSpec, cell: CellSpec | None = None, *, timestep: float = 1e-3, payload: Body | None = None
) -> str:
    """Return the MJCF text of a robot, alone or in its cell.

    Args: ``timestep`` of the physics in s; ``payload`` a body fixed to the flange, given in the flange frame (to
    compare with the controller's model). Joints come in the order of the axes, each elastic one followed by the
    hinge of its gear, then the two fingers, then the parts. Actuators come in the order of axes and fingers; their
    controls are joint torques N m and finger forces N (positive opens).
    """
    root = ET.Element("mujoco", model=spec.name)
    # the order of bodies and joints is relied on: CellModel counts places in the state by it
    _options(root, timestep)
    parts, obstacles = (cell.parts, cell.obstacles) if cell else ((), ())
    hulls = _hulls(root, (*obstacles, *parts))
    world = ET.SubElement(root, "worldbody")
    _surroundings(world, obstacles, hulls)
    last = _arm(world, spec, timestep)
    flange = _body(last, "hand" if cell else "flange", spec.X_last_flange)
    if cell is not None:
        _hand(flange, cell.hand, timestep)
    else:
        ET.SubElement(
            flange, "site", name="tool", size="0.005"
        )  # X_world_tool reads it; an arm alone has it at the flange
    if payload is not None:
        _inertial(_body(flange, "payload", np.eye(4)), payload)
    for part in parts:
        _part(world, part, hulls)
    if cell is not None:
        _contacts(root, spec, cell, timestep)
        if not cell.hand.is_cup:
            _coupling(root, timestep)
    _actuators(root, spec, fingers_of(cell.hand) if cell is not None else ())
    ET.indent(root)
    return ET.tostring(root, encoding="unicode")


def joint_name(index: int) -> str:
    """Return the name of the hinge that axis ``index`` (0-based) drives: the motor's, where the gear is elastic."""
    return f"j{index + 1}"


def gear_joint(index: int) -> str:
    """Return the name of the hinge between motor and link of axis ``index``, which exists where the gear is elastic."""
    return f"j{index + 1}_gear"


def friction_bias(spec: RobotSpec) -> Array:
    """Return the constant joint torques (n,) N m that make symmetric dry friction the published asymmetric one."""
    return np.array([(tb - tf) / 2.0 for tf, tb in (axis.motor.joint_coulomb_friction for axis in spec.axes)])


def _options(root: ET.Element, timestep: float) -> None:
    # the bodies of the robot file as they are: MuJoCo must neither infer nor correct mass and inertia
    ET.SubElement(
        root,
        "compiler",
        angle="radian",
        autolimits="true",
        inertiafromgeom="false",
        balanceinertia="false",
        boundmass="0",
        boundinertia="0",
        fusestatic="false",
    )
    option = ET.SubElement(
        root,
        "option",
        timestep=repr(timestep),
        gravity=f"0 0 {-GRAVITY!r}",
        integrator="implicitfast",
        solver="Newton",
        cone="elliptic",
        impratio="20",
        iterations="50",
        tolerance="1e-10",
    )
    # a reset would teleport the arm: the plant stops at the last valid state instead
    ET.SubElement(option, "flag", autoreset="disable")
    default = ET.SubElement(root, "default")
    ET.SubElement(
        default,
        "geom",
        condim="3",
        friction="0.5 0.005 0.0001",
        solref=f"{CONTACT_TIME * timestep!r} 1",
        solimp=_CONTACT,
    )


Hulls = Mapping[BodyMesh, str]
"""The name of the asset of each mesh."""


def _hulls(root: ET.Element, bodies: Iterable[PartSpec | ObstacleSpec]) -> Hulls:
    """Write the hull of each mesh once."""
    meshes = dict.fromkeys(body.mesh for body in bodies if body.mesh is not None)
    names = {mesh: f"hull{k}" for k, mesh in enumerate(meshes)}
    asset = ET.SubElement(root, "asset") if names else root
    for mesh, name in names.items():
        # without faces MuJoCo finds those of the hull itself
        ET.SubElement(asset, "mesh", name=name, vertex=row(mesh.hull.vertices.ravel()), inertia="convex")
    return names


def _surroundings(world: ET.Element, obstacles: Iterable[ObstacleSpec], hulls: Hulls) -> None:
    ET.SubElement(world, "light", pos="0 -1 3", dir="0 0.3 -1", diffuse="0.7 0.7 0.7")
    _geom(world, "floor", "environment", type="plane", size="3 3 0.1", rgba="0.85 0.86 0.88 1")
    for each in obstacles:
        _geom(
            world,
            f"obstacle:{each.name}",
            "environment",
            each.X_world_obstacle,
            rgba="0.55 0.47 0.38 1",
            **_solid(each, hulls),
        )


def _arm(world: ET.Element, spec: RobotSpec, timestep: float) -> ET.Element:
    """Nest the links; returns the body of the last one."""
    parent = world
    for index, axis in enumerate(spec.axes):
        parent = _body(parent, f"link{index + 1}", axis.placement)
        _inertial(parent, axis.body)
        _hinge(parent, index, axis, timestep)
        if axis.motor.elastic:
            _gear_spring(parent, index, axis)
        end = spec.axes[index + 1].placement if index + 1 < spec.n else spec.X_last_flange
        _link_geom(parent, index, end[:3, 3], spec.link_radii[index] if spec.link_radii else _radius(index))
    return parent


def _hinge(body: ET.Element, index: int, axis: AxisSpec, timestep: float) -> None:
    forward, backward = axis.motor.joint_coulomb_friction
    ET.SubElement(
        body,
        "joint",
        name=joint_name(index),
        type="slide" if axis.kind.slides else "hinge",
        axis="0 0 1",
        range=row([axis.limits.lower, axis.limits.upper]),
        armature=repr(axis.motor.reflected_inertia),
        damping=repr(axis.motor.joint_viscous_friction),
        frictionloss=repr((forward + backward) / 2.0),
        # two steps: MuJoCo's shortest time constant, so that dry friction holds at once
        solreffriction=f"{2.0 * timestep!r} 1",
        solimpfriction=_STIFF,
        solreflimit=f"{CONTACT_TIME * timestep!r} 1",
    )


def _gear_spring(body: ET.Element, index: int, axis: AxisSpec) -> None:
    """Turn the link against its motor: a second hinge on the same axis of the same body (see the module)."""
    ET.SubElement(
        body,
        "joint",
        name=gear_joint(index),
        type="slide" if axis.kind.slides else "hinge",
        axis="0 0 1",
        limited="false",
        stiffness=repr(axis.motor.stiffness),
        damping=repr(axis.motor.damping),
    )


def _radius(index: int) -> float:
    """Return the radius of a link of an arm whose shapes are not known, m."""
    return _LINK_RADIUS[0] if index < 3 else _LINK_RADIUS[1]


def _link_geom(body: ET.Element, index: int, end: Array, radius: float) -> None:
    """Draw a link as a capsule to the next joint; only links beyond the first can run into something."""
    group, name = ("arm" if index else "", f"link{index + 1}")
    if norm(end) < 1e-3:
        _geom(body, name, group, type="sphere", size=repr(radius), rgba="0.95 0.75 0.2 1")
        return
    fromto = row([0.0, 0.0, 0.0, *end])
    _geom(body, name, group, type="capsule", fromto=fromto, size=repr(radius), rgba="0.95 0.75 0.2 1")


def _hand(flange: ET.Element, hand: HandSpec, timestep: float) -> None:
    _inertial(flange, palm_body(hand))
    size, X_tool_palm = palm_box(hand)
    X_flange_palm = matmul(hand.X_flange_tool, X_tool_palm)
    _geom(flange, "palm", "hand", X_flange_palm, type="box", size=row(size / 2.0), rgba="0.3 0.32 0.35 1")
    ET.SubElement(flange, "site", {"name": "tool", "size": "0.003", **place(hand.X_flange_tool)})
    if hand.is_cup:
        length = hand.finger_length
        X_flange_cup = matmul(hand.X_flange_tool, pose([0.0, 0.0, -length / 2.0]))
        # rigid, and as wide as its rim all along: the soft lip is in the rule of what seals
        radius_half = row([hand.pad[0], length / 2.0])
        _geom(flange, "cup", "hand", X_flange_cup, type="cylinder", size=radius_half, rgba="0.1 0.1 0.1 1")
    for side in fingers_of(hand):
        _finger(flange, hand, side, timestep)


def _finger(flange: ET.Element, hand: HandSpec, side: str, timestep: float) -> None:
    """A finger slides along the tool's y axis; its coordinate is the distance of the pad from the tool point."""
    sign = finger_sign(side)
    width, thickness, length = (float(value) for value in hand.pad)
    # at zero opening both bodies are at the tool point, so that the joint coordinate is the distance of the pad
    finger = _body(flange, f"finger_{side}", hand.X_flange_tool)
    _inertial(finger, finger_body(hand, side))
    ET.SubElement(
        finger,
        "joint",
        name=f"finger_{side}",
        type="slide",
        axis=f"0 {sign!r} 0",
        range=row([0.0, hand.stroke / 2.0]),
        armature=repr(FINGER_ARMATURE),
        damping=repr(hand.grip_force / FINGER_SPEED),
        solreflimit=f"{2.0 * timestep!r} 1",
        solimplimit=_STIFF,
    )
    y_pad, y_shank = sign * thickness / 2.0, sign * thickness * 0.625
    top, tip = -hand.finger_length, length / 2.0
    pad, shank = pose([0.0, y_pad, 0.0]), pose([0.0, y_shank, (top + tip) / 2.0])
    shank_size = np.array([width, thickness * 0.75, tip - top])
    _geom(finger, f"pad_{side}", "hand", pad, type="box", size=row(hand.pad / 2.0), rgba="0.1 0.1 0.1 1")
    _geom(finger, f"shank_{side}", "hand", shank, type="box", size=row(shank_size / 2.0), rgba="0.4 0.42 0.45 1")


def own_pairs(spec: RobotSpec, hand: HandSpec) -> list[tuple[str, str]]:
    """Return which shapes of the arm and its hand may meet one another: links ``APART`` joints or more apart.

    Nearer ones are kept off one another by the ranges of their joints; the hand counts as the last link. Empty for an
    arm whose shapes are not known.
    """
    if not spec.link_radii:
        return []
    shapes = [(f"link{axis + 1}", axis) for axis in range(spec.n)]
    shapes += [(name, spec.n - 1) for name in ("palm", *hand_geoms(hand))]
    return [(a, b) for a, one in shapes for b, other in shapes if one + APART <= other]


def hand_geoms(hand: HandSpec) -> tuple[str, ...]:
    """Return the names of the shapes of a hand beside its palm."""
    return ("cup",) if hand.is_cup else tuple(f"{part}_{side}" for side in fingers_of(hand) for part in FINGER)


def own_pair_name(first: str, second: str) -> str:
    """Return the name of a pair of ``own_pairs``."""
    return f"{first}+{second}"


def without_pairs(xml: str, pairs: Iterable[tuple[str, str]]) -> str:
    """Return a model of ``build_mjcf`` without some pairs of ``own_pairs``."""
    root, names = ET.fromstring(xml), {own_pair_name(*pair) for pair in pairs}
    for contact in root.iter("contact"):
        for each in [each for each in contact if each.get("name") in names]:
            contact.remove(each)
    return ET.tostring(root, encoding="unicode")


def _contacts(root: ET.Element, spec: RobotSpec, cell: CellSpec, timestep: float) -> None:
    contact = ET.SubElement(root, "contact")
    for first, second in own_pairs(spec, cell.hand):
        ET.SubElement(
            contact,
            "pair",
            name=own_pair_name(first, second),
            geom1=first,
            geom2=second,
            condim="1",
            solimp=_CONTACT,
            solref=f"{CONTACT_TIME * timestep!r} 1",
        )
    _grip(contact, cell, timestep)


def _grip(contact: ET.Element, cell: CellSpec, timestep: float) -> None:
    """State the contacts of what holds with parts: their slip is damped faster than MuJoCo's time constants allow."""
    holders = [name for name in hand_geoms(cell.hand) if is_holder(name)]
    for part in cell.parts:
        for holder in holders:
            ET.SubElement(
                contact,
                "pair",
                geom1=holder,
                geom2=f"part:{part.name}",
                condim="3",
                friction=f"{part.friction!r} {part.friction!r} 0.005 0.0001 0.0001",
                solref=f"{CONTACT_TIME * timestep!r} 1",
                # negative: stiffness and damping themselves; friction rows have no position, so no stiffness
                solreffriction=f"-1 {-GRIP_DAMPING / timestep!r}",
                solimp=_CONTACT,
            )


def _coupling(root: ET.Element, timestep: float) -> None:
    """Gear the fingers together: they move by the same amount, as a parallel gripper's do."""
    equality = ET.SubElement(root, "equality")
    left, right = (f"finger_{side}" for side in FINGERS)
    ET.SubElement(
        equality,
        "joint",
        joint1=left,
        joint2=right,
        polycoef="0 1 0 0 0",  # the coordinate of one finger is that of the other
        solref=f"{2.0 * timestep!r} 1",
        solimp=_STIFF,
    )


def _part(world: ET.Element, part: PartSpec, hulls: Hulls) -> None:
    body = _body(world, f"part:{part.name}", part.X_world_part)
    ET.SubElement(body, "freejoint", name=f"part:{part.name}")
    _inertial(body, Body(mass=part.mass, cog=part.cog, inertia=part_inertia(part)))
    # priority: the friction of a contact is that of the part, not the larger of the two
    _geom(
        body,
        f"part:{part.name}",
        "part",
        None,
        priority="1",
        friction=f"{part.friction!r} 0.005 0.0001",
        rgba="0.45 0.55 0.7 1",
        **_solid(part, hulls),
    )


def _solid(body: PartSpec | ObstacleSpec, hulls: Hulls) -> dict[str, str]:
    """Return the attributes of the shape of a part or an obstacle."""
    if body.mesh is not None:
        return {"type": "mesh", "mesh": hulls[body.mesh]}
    half = body.size / 2.0
    if body.shape == "cylinder":
        return {"type": "cylinder", "size": row(half[1:])}
    return {"type": "box", "size": row(half)}


def _actuators(root: ET.Element, spec: RobotSpec, fingers: Iterable[str]) -> None:
    actuator = ET.SubElement(root, "actuator")
    names = [joint_name(index) for index in range(spec.n)]
    # gear 1: the servo gives joint torques, so that the motor's ratio is not applied twice
    for name in [*names, *(f"finger_{side}" for side in fingers)]:
        ET.SubElement(actuator, "motor", name=name, joint=name, gear="1")


def _geom(parent: ET.Element, name: str, group: str, X: Array | None = None, **attributes: str) -> None:
    contype, conaffinity = COLLIDES.get(group, NOTHING)
    given = {"name": name, "contype": str(contype), "conaffinity": str(conaffinity), **attributes}
    ET.SubElement(parent, "geom", given if X is None else given | place(X))


def _body(parent: ET.Element, name: str, X: Array) -> ET.Element:
    return ET.SubElement(parent, "body", {"name": name, **place(X)})


def _inertial(parent: ET.Element, body: Body) -> None:
    """State a body by its principal moments: MuJoCo's own diagonalisation stops at fewer digits."""
    moments, axes = symmetric_eigen(body.inertia)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    # a body on the edge of the triangle inequality (a rod, a corrected link) may miss it by rounding
    moments[2] = min(moments[2], moments[0] + moments[1])
    ET.SubElement(
        parent,
        "inertial",
        pos=row(body.cog),
        quat=row(quaternion(axes)),
        mass=repr(float(body.mass)),
        diaginertia=row(moments),
    )


def place(X: Array) -> dict[str, str]:
    """Return the attributes that place an element at a pose (4, 4) in its parent."""
    return {"pos": row(X[:3, 3]), "quat": row(quaternion(X[:3, :3]))}


def quaternion(R: Array) -> Array:
    """Return (w, x, y, z) of a rotation (3, 3), w or the largest part positive; Shepperd's choice of the pivot."""
    trace = float(np.trace(R))
    squares = np.array([trace, *np.diag(R)])
    pivot = int(np.argmax(squares))
    q = np.empty(4)
    if pivot == 0:
        q[0] = 1.0 + trace
        q[1:] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
        return q / norm(q)
    i, j, k = ((0, 1, 2), (1, 2, 0), (2, 0, 1))[pivot - 1]
    q[1 + i] = 1.0 + R[i, i] - R[j, j] - R[k, k]
    q[0], q[1 + j], q[1 + k] = R[k, j] - R[j, k], R[j, i] + R[i, j], R[k, i] + R[i, k]
    return q / norm(q)


def row(values: Iterable[float]) -> str:
    """Return numbers as the text of an attribute, without loss."""
    return " ".join(repr(float(value)) for value in values)
