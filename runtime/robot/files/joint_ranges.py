"""The axes of a model file as far as they are known without numerics: how many, of which kind, the ranges of a URDF.

``robolang check`` judges joint positions by them. The chain itself is built and judged by ``imported`` before anything
moves, so a file with a fault gives fewer axes here, or none.
"""

import math
from collections.abc import Iterator, Mapping

from runtime.robot.files.xmlfile import Element
from runtime.robot.model.axis_kind import MJCF_KINDS, REVOLUTE, URDF_KINDS, AxisKind
from runtime.robot.model.drives import Limits

Joint = tuple[Element, AxisKind]


def ranges_of(root: Element, stated: Mapping[str, tuple[float, float]]) -> tuple[Limits, ...]:
    """Return the ranges of the joints in the order of the chain, rad or m; speeds, accelerations, torques have no end.

    ``stated`` are those of a sidecar, by joint: they rule.
    """
    urdf, found = root.tag == "robot", []
    for joint, kind in _joints(root):
        ends = stated.get(joint.attributes.get("name", ""))
        if ends is None:  # of an MJCF units and defaults are left to the reader
            ends = _of_urdf(joint) if urdf else (-math.inf, math.inf)
        found.append(_limits(ends, kind))
    return tuple(found)


def kinds_of(root: Element) -> dict[str, AxisKind]:
    """Return the kinds of the joints that have a name, by name."""
    return {name: kind for joint, kind in _joints(root) if (name := joint.attributes.get("name"))}


def _joints(root: Element) -> list[Joint]:
    if root.tag == "robot":
        return _chain(root)
    classes: dict[str, str] = {}
    for default in root.all("default"):
        _read_classes(default, "main", "hinge", classes)
    # an MJCF nests its bodies: the order of the file is that of the chain
    return [joint for world in root.all("worldbody") for joint in _in_bodies(world, "main", classes)]


def _read_classes(default: Element, name: str, inherited: str, into: dict[str, str]) -> None:
    """Enter the type of joints of a default class and of those inside it."""
    own = next((each.attributes["type"] for each in default.all("joint") if "type" in each.attributes), inherited)
    into[name] = own
    for child in default.all("default"):
        _read_classes(child, child.attributes.get("class", ""), own, into)


def _in_bodies(body: Element, childclass: str, classes: Mapping[str, str]) -> Iterator[Joint]:
    for element in body.children:
        if element.tag == "joint":
            usual = classes.get(element.attributes.get("class", childclass), "hinge")
            yield element, MJCF_KINDS.get(element.attributes.get("type", usual), REVOLUTE)
        elif element.tag == "body":
            yield from _in_bodies(element, element.attributes.get("childclass", childclass), classes)


def _chain(robot: Element) -> list[Joint]:
    """Return the moving joints of a URDF from the base on; what does not hang together is left out."""
    starting: dict[str, list[Element]] = {}
    hung = set()
    for joint in robot.all("joint"):
        starting.setdefault(_link(joint, "parent"), []).append(joint)
        hung.add(_link(joint, "child"))
    # from the roots: joints may stand in any order in the file
    todo = [link.attributes.get("name", "") for link in robot.all("link") if link.attributes.get("name") not in hung]
    found: list[Joint] = []
    while todo:
        for joint in starting.pop(todo.pop(), ()):  # each link once: a loop ends
            todo.append(_link(joint, "child"))
            kind = URDF_KINDS.get(joint.attributes.get("type", ""))
            if kind is not None:
                found.append((joint, kind))
    return found


def _link(joint: Element, end: str) -> str:
    return next((each.attributes.get("link", "") for each in joint.all(end)), "")


def _of_urdf(joint: Element) -> tuple[float, float]:
    limit = joint.one("limit")
    if limit is None or joint.attributes.get("type") == "continuous":
        return -math.inf, math.inf
    lower, upper = (limit.number(key) if key in limit.attributes else math.nan for key in ("lower", "upper"))
    # half a range is none: its other end is not 0, whatever the specification says
    return (-math.inf, math.inf) if math.isnan(lower + upper) else (lower, upper)


def _limits(ends: tuple[float, float], kind: AxisKind) -> Limits:
    lower, upper = ends
    rest = math.inf
    return Limits(lower=lower, upper=upper, speed=rest, acceleration=rest, jerk=rest, torque=rest, kind=kind)
