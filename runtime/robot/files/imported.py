"""An arm as URDF and MJCF files describe it: a tree of frames, made one serial chain of axes that turn or slide.

Both readers give the same tree. A ``Node`` is a frame with a body, fixed to the node before it or moved by one joint
of its own, its hinge, which turns or slides. ``serial_chain`` walks it from the root: nodes fixed together become one
link, masses added, inertias moved by the parallel axis theorem,

    I_c = sum_i  R_i I_i R_i' + m_i (|r_i|^2 E - r_i r_i'),   r_i from the common centre of gravity,

and each axis gets the frame that ``RobotSpec`` needs: z along the hinge, origin on it. Branches and loops are
refused (RBL611), and so is a body that cannot be (RBL606) unless the sidecar states a correction for it.

The result holds no drives: such files have none. Forward and inverse kinematics need no more than this.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import PurePath

import numpy as np

from runtime.core.frames import Array, frozen, inverse, pose, rotation_about, skew
from runtime.core.linear import matmul
from runtime.core.tomlfile import FileFault
from runtime.robot.files.corrections import flat, inertia_text
from runtime.robot.files.xmlfile import Element
from runtime.robot.model.axis_kind import REVOLUTE, AxisKind
from runtime.robot.model.drives import joint_label
from runtime.robot.model.spec import Body, LinkMesh, OpwParameters, inertia_defect

FEWEST_AXES, MOST_AXES = 2, 7
INERTIA_SLACK = 1e-9
"""Rounding of printed inertias that is accepted, kg m2."""

_NO_DIRECTION = 1e-200
"""Below this the axis is z or -z to the last bit, and the square of its length would underflow."""

FLANGE_NAMES = ("flange", "tool0")
"""Names that decide which of several last frames is the flange."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hinge:
    """A joint that turns or slides: unit ``axis`` (3,) and ``anchor`` (3,) m in its node's frame; values of the file.

    None for a value that the file leaves out. ``lower`` and ``upper`` rad, ``speed`` rad/s, ``effort`` N m, ``damping``
    N m s/rad, ``friction`` N m, ``armature`` kg m2, all at the joint; m for rad, N and kg of one that slides.
    ``in_degrees``: the file has degrees; ``endless``: the joint has no end stops.
    """

    name: str
    element: Element
    axis: Array
    anchor: Array
    lower: float | None
    upper: float | None
    speed: float | None
    effort: float | None
    damping: float
    friction: float
    armature: float
    in_degrees: bool
    endless: bool = False
    kind: AxisKind = REVOLUTE


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeMesh:
    """A mesh file at a pose (4, 4) in its node's frame; ``scale`` (3,) makes its numbers m."""

    file: str
    X_node_mesh: Array
    scale: Array


@dataclass(slots=True, kw_only=True, eq=False)
class Node:
    """A frame of the file with its body (None: it has no mass), its hinge (None: fixed) and the nodes after it.

    ``X_parent_node`` (4, 4) holds at joint angle zero. ``marker``: a frame that only names a place. ``between``: it is
    between two joints of one body, which moves with the last of them. ``meshes`` show it.
    """

    name: str
    element: Element
    X_parent_node: Array
    body: Body | None = None
    hinge: Hinge | None = None
    marker: bool = False
    between: bool = False
    meshes: tuple[NodeMesh, ...] = ()
    children: "list[Node]" = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedAxis:
    """One axis: ``placement`` (4, 4) as in ``AxisSpec``, ``body`` in the axis frame, ``hinge`` as the file has it.

    ``impossible``: the fault, at its place, of a body that cannot exist; None for one that can. ``link`` is the element
    that moves with the joint. ``bodiless``: no part of the link has an inertial in the file. ``between``: ``Node``.
    """

    name: str
    link: Element
    placement: Array
    body: Body
    hinge: Hinge
    impossible: FileFault | None
    bodiless: bool
    between: bool

    @property
    def kind(self) -> AxisKind:
        """Whether it turns or slides."""
        return self.hinge.kind


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedArm:
    """A serial arm of a URDF or MJCF file. ``lower``, ``upper`` (n,) rad or m; ``flange`` names its last frame.

    ``warnings`` are the doubts about it (``plausibility``), ``notes`` name what is left out in its file.
    """

    name: str
    path: str
    axes: tuple[ImportedAxis, ...]
    X_last_flange: Array
    flange: str
    lower: Array
    upper: Array
    opw: OpwParameters | None = None
    warnings: tuple[FileFault, ...] = ()
    notes: tuple[FileFault, ...] = ()
    meshes: tuple[LinkMesh, ...] = ()

    @property
    def n(self) -> int:
        """Number of axes."""
        return len(self.axes)

    @property
    def title(self) -> str:
        """The arm as messages and tables name it."""
        return f"{self.name} ({PurePath(self.path).name})"


def rotation_z_to(axis: Array) -> Array:
    """Return the smallest rotation (3, 3) that takes z to a unit vector; half a turn about x for -z."""
    across = math.hypot(axis[0], axis[1])
    if across < _NO_DIRECTION:
        return np.eye(3) if axis[2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    # about the horizontal normal of z and the axis; every such frame serves, this one turns least
    k = np.array([-axis[1], axis[0], 0.0]) / across
    return np.asarray(rotation_about(k, math.atan2(across, axis[2])))


def moved(body: Body, X: Array) -> Body:
    """Return a body given in frame b in frame a, X = X_a_b (4, 4)."""
    R = X[:3, :3]
    return Body(mass=body.mass, cog=matmul(R, body.cog) + X[:3, 3], inertia=matmul(R, body.inertia, R.T))


def combined(bodies: list[Body]) -> Body:
    """Return several bodies of one frame as one; a body of no mass at the origin for none."""
    mass = sum(body.mass for body in bodies)
    # the inertias are kept although there is no centre to move them to: an impossible one is then still found
    if mass <= 0.0:
        return Body(
            mass=0.0, cog=frozen(np.zeros(3)), inertia=frozen(sum((b.inertia for b in bodies), np.zeros((3, 3))))
        )
    cog = sum((body.mass * body.cog for body in bodies), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for body in bodies:
        r = skew(body.cog - cog)
        inertia += body.inertia - body.mass * matmul(r, r)  # skew(r)^2 = r r' - |r|^2 E
    return Body(mass=mass, cog=frozen(cog), inertia=frozen(inertia))


def impossible_inertia(element: Element, inertia: Array, what: str) -> FileFault | None:
    """Return the fault of a matrix that no body can have as its inertia (RBL606), at its element; None for others."""
    defect = inertia_defect(inertia)
    if defect <= INERTIA_SLACK:
        return None
    return element.fault("RBL606", f"the inertia of {what} {inertia_text(defect)}", _mended(element))


def _mended(element: Element) -> str:
    """Return what to do about a body that cannot be."""
    return f"correct it there, or 'robolang robot import {element.source.path} --estimate' writes a body that can be"


def serial_chain(root: Node, path: str, name: str, flange: str | None) -> ImportedArm:
    """Return the one chain of hinges of a tree; ``FileFault`` RBL605, 608, 610, 611 or 621 when it has another form.

    ``flange`` names the frame to use as flange; None takes the only last frame, or one of ``FLANGE_NAMES``.
    """
    axes: list[ImportedAxis] = []
    cluster = list(_fixed(root, np.eye(4)))
    meshes = _meshes(cluster, 0, path)
    while (moving := _moving(cluster)) is not None:
        X, node, hinge = moving
        if hinge.name in {axis.name for axis in axes}:
            hinge.element.fail("RBL610", f"two joints are named {hinge.name!r}")
        # everything after the hinge is counted in the frame of its axis, z along the hinge
        X_node_axis = pose(hinge.anchor, rotation_z_to(hinge.axis))
        cluster = list(_fixed(node, inverse(X_node_axis)))
        axes.append(_with_body(_axis(node, hinge, matmul(X, X_node_axis)), cluster, len(axes)))
        meshes += _meshes(cluster, len(axes), path)
    if not FEWEST_AXES <= len(axes) <= MOST_AXES:
        root.element.fail("RBL605", f"an arm has {FEWEST_AXES} to {MOST_AXES} joints in a row, not {len(axes)}")
    last, X_last_flange = _flange(cluster, flange, root)
    return ImportedArm(
        name=name,
        path=path,
        axes=tuple(axes),
        X_last_flange=frozen(X_last_flange),
        flange=last,
        lower=_limits(axes, "lower"),
        upper=_limits(axes, "upper"),
        meshes=tuple(meshes),
    )


def _meshes(cluster: list[tuple[Array, Node]], link: int, path: str) -> list[LinkMesh]:
    """Return the meshes of all that is fixed together, as those of one link."""
    return [
        LinkMesh(
            link=link,
            file=mesh.file,
            folder=str(PurePath(path).parent),
            X_link_mesh=frozen(matmul(X, mesh.X_node_mesh)),
            scale=mesh.scale,
        )
        for X, node in cluster
        for mesh in node.meshes
    ]


def _moving(cluster: list[tuple[Array, Node]]) -> tuple[Array, Node, Hinge] | None:
    """Return the one node that moves on a link, its pose in the link's frame and its hinge; None at the last link.

    ``FileFault`` RBL611 at the second one where there are several.
    """
    moving = [
        (matmul(X, child.X_parent_node), child, child.hinge)
        for X, member in cluster
        for child in member.children
        if child.hinge
    ]
    if len(moving) > 1:
        names = " and ".join(repr(hinge.name) for _, _, hinge in moving[:2])
        moving[1][1].element.fail("RBL611", f"joints {names} both start at one link: the arm has a branch")
    return moving[0] if moving else None


def _limits(axes: list[ImportedAxis], side: str) -> Array:
    # NaN, not infinity: a missing range must come from the sidecar, and every comparison with it fails until then
    values = [getattr(axis.hinge, side) for axis in axes]
    return frozen([np.nan if value is None else value for value in values])


def _axis(node: Node, hinge: Hinge, placement: Array) -> ImportedAxis:
    return ImportedAxis(
        name=hinge.name,
        link=node.element,
        placement=frozen(placement),
        body=combined([]),
        hinge=hinge,
        impossible=None,
        bodiless=True,
        between=node.between,
    )


def _with_body(axis: ImportedAxis, cluster: list[tuple[Array, Node]], index: int) -> ImportedAxis:
    body = combined([moved(node.body, X) for X, node in cluster if node.body is not None])
    # of all that moves with the hinge, about its common centre of gravity
    what = f"the link of {joint_label(index, axis.name)}"
    impossible = impossible_inertia(axis.hinge.element, body.inertia, what)
    for _, node in cluster:
        if node.body is not None:  # an impossible part would pass unseen beside a large one
            impossible = impossible or impossible_inertia(node.element, node.body.inertia, repr(node.name))
    if not body.mass > 0.0:
        impossible = axis.hinge.element.fault("RBL606", f"{what} has no mass", _mended(axis.hinge.element))
    elif impossible is None and flat(body.inertia):
        message = f"{what} has {body.mass:g} kg and no inertia about some axis"
        impossible = axis.link.fault("RBL606", message, _mended(axis.link))
    return replace(axis, body=body, impossible=impossible, bodiless=all(node.body is None for _, node in cluster))


def _fixed(node: Node, X: Array) -> Iterator[tuple[Array, Node]]:
    """Yield a node and all that is fixed to it, each with its pose in the frame that X refers to."""
    # a list instead of recursion: depth is bounded by the reader, Python's stack by something else
    todo = [(X, node)]
    while todo:
        X_here, here = todo.pop()
        yield X_here, here
        rigid = [child for child in reversed(here.children) if child.hinge is None]
        todo += [(matmul(X_here, child.X_parent_node), child) for child in rigid]


def _flange(cluster: list[tuple[Array, Node]], name: str | None, root: Node) -> tuple[str, Array]:
    """Return name and pose of the flange among the frames of the last link; ``FileFault`` RBL610 or RBL621."""
    frames = {node.name: X for X, node in cluster if node.name}
    if name is not None:
        if name not in frames:
            root.element.fail("RBL610", f"the flange {name!r} is not a frame of the last link: {', '.join(frames)}")
        return name, frames[name]
    ends = _ends(cluster)
    if len(ends) == 1:
        return ends[0]
    for usual in FLANGE_NAMES:
        if usual in frames:
            return usual, frames[usual]
    root.element.fail(
        "RBL621",
        f"the last link ends in several frames: {', '.join(name for name, _ in ends)}",
        "name it: flange = '...' in the sidecar, or 'robolang robot import --flange'",
    )


def _ends(cluster: list[tuple[Array, Node]]) -> list[tuple[str, Array]]:
    """Return the frames of a link, by name, that carry no other frame; markers are no ends and no carriers."""
    parents = {id(child): node for _, node in cluster for child in node.children}
    inner = {id(parents[id(node)]) for _, node in cluster if id(node) in parents and not node.marker}
    return [(node.name, X) for X, node in cluster if id(node) not in inner and not node.marker]
