"""What is read of a URDF, as names: every other element and attribute is left out.

Files of makers are full of what belongs to other programs: simulators, hardware interfaces, planners. None of it
changes masses, joints or limits, so it is left out with a note (``left_out``). What would change the arm and is
not read stays refused by the reader that meets it: mimic joints, ball and planar joints, springs.
Source: the URDF specification, wiki.ros.org/urdf/XML.
"""

from runtime.core.record import Record


class Known(Record):
    """The children and attributes that are read of one element."""

    children: frozenset[str] = frozenset()
    attributes: frozenset[str] = frozenset()


def _known(children: str = "", attributes: str = "") -> Known:
    return Known(children=frozenset(children.split()), attributes=frozenset(attributes.split()))


_SHAPE = _known("origin geometry", "name")
URDF = {
    "robot": _known("link joint", "name version"),
    "link": _known("inertial visual collision", "name type"),
    "inertial": _known("origin mass inertia"),
    "visual": _SHAPE,
    "collision": _SHAPE,
    "geometry": _known("mesh box cylinder sphere capsule"),
    "mesh": _known("", "filename scale"),
    "box": _known("", "size"),
    "cylinder": _known("", "radius length"),
    "sphere": _known("", "radius"),
    "capsule": _known("", "radius length"),
    "joint": _known("origin parent child axis limit dynamics mimic", "name type"),
    "origin": _known("", "xyz rpy"),
    "mass": _known("", "value"),
    "inertia": _known("", "ixx iyy izz ixy ixz iyz"),
    "parent": _known("", "link"),
    "child": _known("", "link"),
    "axis": _known("", "xyz"),
    "limit": _known("", "lower upper velocity effort"),
    "dynamics": _known("", "damping friction spring_stiffness spring_reference"),
    "mimic": _known("", "joint multiplier offset"),
}
"""By tag; a tag names one thing wherever it is read."""

MACROS = frozenset(["include", "macro", "property"])
"""Elements of xacro before it had a namespace: without them a part of the arm may be missing."""
