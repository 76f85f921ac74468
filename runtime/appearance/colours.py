"""Colours of what is drawn: of a robot by its name, of everything else one for each role."""

from collections.abc import Mapping
from types import MappingProxyType

_SURROUNDINGS = {
    "metal": "#a6aeb6",
    "rubber": "#23262b",
    "palm": "#4a5058",
    "table": "#c9a777",
    "leg": "#7d858e",
    "part": "#1f9e89",
    "edge": "#0b5d50",
    "floor": "#e6eaee",
    "obstacle": "#b3a68f",
}
# body, covers of the joints, accent: near to what these machines wear in a plant, nobody's exact paint
_ROBOTS = {
    "puma560": ("#f0ece0", "#3b4148", "#c8102e"),
    "manutec_r3": ("#e8b021", "#3f4347", "#2f3337"),
    "irb2400": ("#ee6a1e", "#3a3d42", "#d9dcdf"),
}
_ANY_ROBOT = ("#e4e8ec", "#3b4148", "#1f77b4")


def colours_of(robot: str) -> Mapping[str, str]:
    """Return the colours, ``#rrggbb``, of all roles in a scene with a robot of this name."""
    own = dict(zip(("body", "cover", "accent"), _ROBOTS.get(robot, _ANY_ROBOT), strict=True))
    return MappingProxyType(own | _SURROUNDINGS)
