"""Where the table of a job stands before an arm, and the files of a template with the table there."""

from collections.abc import Mapping, Sequence
from typing import Any, cast

import tomlkit

from robolang.templates.template import CELL, POINTS, TEST
from runtime.core.record import Record

DECIMALS = 6
"""Of the joint angles at home, deg: less than 0.0001 mm at a reach of 5 m."""
_TURNS = {0: (1, 0), 90: (0, 1), 180: (-1, 0), -90: (0, -1)}
"""Cosine and sine of the headings: exact, so that numbers in files stay round."""

Numbers = Sequence[float]


class Placement(Record):
    """A table: ``from_mm`` (3,) the middle of its top in the template, ``to_mm`` (3,) before the arm.

    ``heading_deg`` turns it about the upright through the base of the arm, ``yaw_deg`` (0 or 180) the tool about its
    own axis at every point. ``home`` (n,) are the joints at the point HOME, deg, of an axis that slides mm;
    ``slides``: there is one.
    """

    from_mm: tuple[float, float, float]
    to_mm: tuple[float, float, float]
    heading_deg: int
    yaw_deg: int
    home: tuple[float, ...]
    slides: bool = False

    def position(self, position_mm: Numbers) -> list[float]:
        """Return where a position (3,) mm of the template comes to, mm."""
        x, y, z = (to + at - was for to, at, was in zip(self.to_mm, position_mm, self.from_mm, strict=True))
        c, s = _TURNS[self.heading_deg]
        return [_plain(c * x - s * y), _plain(s * x + c * y), _plain(z)]

    def pose(self, pose_mm_deg: Numbers) -> list[float]:
        """Return where a pose (6,) mm and deg that is turned about the upright only comes to."""
        *position, rx, ry, rz = pose_mm_deg
        # R = Rz Ry Rx: a turn about the upright of the world adds to rz alone
        return [*self.position(position), rx, ry, _turned(rz + self.heading_deg)]

    def files(self, texts: Mapping[str, str], robot: str, name: str) -> dict[str, str]:
        """Return the files of a template by ending, for a ``robot`` as the cell names it and its ``name``."""
        return {
            **texts,
            CELL: self._cell(texts[CELL], robot),
            POINTS: self._points(texts[POINTS], name),
            TEST: self._test(texts[TEST]),
        }

    def _cell(self, text: str, robot: str) -> str:
        # tomlkit, and not a writer of its own: comments and layout of the template stay
        table = cast(dict[str, Any], tomlkit.parse(text))
        table["robot"] = robot
        if self.slides:
            # the key of a cell whose joints have different units
            del table["home"]["joints_deg"]
        table["home"]["joints" if self.slides else "joints_deg"] = list(self.home)
        for item in (*table.get("parts", ()), *table.get("obstacles", ()), *table.get("frames", {}).values()):
            item["pose_mm_deg"] = self.pose(item["pose_mm_deg"])
        return tomlkit.dumps(table)

    def _points(self, text: str, robot: str) -> str:
        table = cast(dict[str, Any], tomlkit.parse(text))
        table["robot"] = robot
        for point in table["points"].values():
            *rest, rz = point["pose"]
            point["pose"] = [*rest, _turned(rz + self.yaw_deg)]
        return tomlkit.dumps(table)

    def _test(self, text: str) -> str:
        table = cast(dict[str, Any], tomlkit.parse(text))
        parts = table["expect"].get("parts", {})
        for name in [name for name in parts if name != "part_mm"]:
            parts[name] = self.position(parts[name])
        return tomlkit.dumps(table)


def _plain(value: float) -> float:
    """Return a number as one writes it: without rests of a sum, and whole where it is."""
    # three decimals of a mm or deg, as points are taught
    rounded = round(float(value), 3)
    return int(rounded) if rounded == int(rounded) else rounded


def _turned(angle_deg: float) -> float:
    """Return an angle in (-180, 180] deg."""
    return _plain(180.0 - (180.0 - angle_deg) % 360.0)
