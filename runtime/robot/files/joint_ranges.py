"""The axes of a model file as far as they are known without numerics: how many, and the ranges of a URDF.

``robolang check`` judges joint angles by them. The chain itself is built and judged by ``imported`` before anything
moves, so a file with a fault gives fewer axes here, or none.
"""

import math
from collections.abc import Mapping

from runtime.robot.files.xmlfile import Element
from runtime.robot.model.drives import Limits


def ranges_of(root: Element, stated: Mapping[str, tuple[float, float]]) -> tuple[Limits, ...]:
    """Return the ranges of the joints in the order of the chain, rad; speeds, accelerations and torques have no end.

    ``stated`` are those of a sidecar, by joint: they rule.
    """
    # an MJCF nests its bodies: the order of the file is that of the chain; units and defaults are left to the reader
    urdf = root.tag == "robot"
    joints = _chain(root) if urdf else [joint for world in root.all("worldbody") for joint in _hinges(world)]
    found = []
    for joint in joints:
        ends = stated.get(joint.attributes.get("name", ""))
        found.append(_limits(*ends) if ends is not None else _of_urdf(joint) if urdf else _limits(-math.inf, math.inf))
    return tuple(found)


def _hinges(world: Element) -> list[Element]:
    return [element for element in world.walk() if element.tag == "joint"]


def _chain(robot: Element) -> list[Element]:
    """Return the turning joints of a URDF from the base on; what does not hang together is left out."""
    starting: dict[str, list[Element]] = {}
    hung = set()
    for joint in robot.all("joint"):
        starting.setdefault(_link(joint, "parent"), []).append(joint)
        hung.add(_link(joint, "child"))
    # from the roots: joints may stand in any order in the file
    todo = [link.attributes.get("name", "") for link in robot.all("link") if link.attributes.get("name") not in hung]
    found: list[Element] = []
    while todo:
        for joint in starting.pop(todo.pop(), ()):  # each link once: a loop ends
            todo.append(_link(joint, "child"))
            if joint.attributes.get("type") in ("revolute", "continuous"):
                found.append(joint)
    return found


def _link(joint: Element, end: str) -> str:
    return next((each.attributes.get("link", "") for each in joint.all(end)), "")


def _of_urdf(joint: Element) -> Limits:
    limit = joint.one("limit")
    if limit is None or joint.attributes.get("type") == "continuous":
        return _limits(-math.inf, math.inf)
    ends = [limit.number(key) if key in limit.attributes else math.nan for key in ("lower", "upper")]
    # half a range is none: its other end is not 0, whatever the specification says
    return _limits(-math.inf, math.inf) if any(map(math.isnan, ends)) else _limits(*ends)


def _limits(lower: float, upper: float) -> Limits:
    return Limits(lower=lower, upper=upper, speed=math.inf, acceleration=math.inf, torque=math.inf)
