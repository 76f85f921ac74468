"""What a URDF holds and the import does not read: one note for each kind of element or attribute (RBL641)."""

from runtime.core.tomlfile import FileFault
from runtime.robot.files.urdf_elements import URDF
from runtime.robot.files.xmlfile import Element, is_elsewhere

_LISTED = 60
"""Kinds that are noted; a file with more is no robot, and its notes would be no help."""


def notes(robot: Element) -> tuple[FileFault, ...]:
    """Return one note (RBL641) for each kind, at the first place where it stands; none for an MJCF."""
    if robot.tag != "robot":
        return ()
    # by kind and not by place: a file of a maker has hundreds of such elements
    found: dict[str, list[Element]] = {}
    for element in robot.walk_read():
        known = URDF[element.tag]
        for child in element.children:
            if child.tag not in known.children:
                found.setdefault(f"<{child.tag}>", []).append(child)
        if is_elsewhere(element):
            found.setdefault("a mesh at an absolute place (file://)", []).append(element)
        for key in element.attributes:
            # a namespace that is declared and not used says nothing
            if key not in known.attributes and not key.startswith("xmlns"):
                found.setdefault(f"'{key}' of <{element.tag}>", []).append(element)
    return tuple(_note(kind, places) for kind, places in list(found.items())[:_LISTED])


def _note(kind: str, places: list[Element]) -> FileFault:
    times = "" if len(places) == 1 else f" ({len(places)} times)"
    return places[0].fault("RBL641", f"{kind} is left out{times}: it is not part of the arm")
