"""The picture of corners in docs/motion.md: what is programmed, the zones, and where the tool goes as it is planned."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robolang.execution.svg import label
from runtime.core.frames import Array, pose
from runtime.core.units import DEG, MM
from runtime.motion.commands import MoveLinear
from tests.runtime.motion.motions import TOOL, bench

WIDTH, HEIGHT, TOP, SIDE = 960, 378, 64, 296
"""Of the picture, of the room above its panels, and of a panel, which is square; pixels."""
SLOW = 0.02
"""A speed, m/s, at which two set-points are 0.16 mm apart: the path of a corner is the same at every speed."""
GREY, BLUE, ZONE = "#888", "#1f5fa8", "#e7eef7"


@dataclass(frozen=True, kw_only=True)
class Panel:
    """Places (K + 1, 2) mm that moves go through with a ``zone`` mm, and what of it is shown: ``width`` mm about
    ``centre`` (2,) mm. The zones of the corners ``circled`` are drawn."""

    title: str
    places: Array
    zone: float
    centre: Array
    width: float
    circled: Sequence[int]

    def tool(self) -> Array:
        """Return where the tool goes (N, 2), mm: set-points of the plan, by the kinematics of the arm."""
        robot = bench("puma560")
        start = robot.home()
        X = robot.tool(start)
        moves = [
            MoveLinear(X_world_tool=pose(X[:3, 3] + np.array([*place, 0.0]) * MM, X[:3, :3]), speed=SLOW, zone=zone)
            for place, zone in zip(
                self.places[1:] - self.places[0], [self.zone * MM] * (len(self.places) - 2) + [0.0], strict=True
            )
        ]
        plan = robot.planner.chain(start, moves, TOOL)
        assert all(corner.reach > 0.0 for corner in plan.corners)
        return (robot.tool(plan.q)[:, :2, 3] - X[:2, 3]) / MM + self.places[0]

    def drawn(self, left: float) -> list[str]:
        """Return its SVG, ``left`` pixels from the edge of the picture."""
        scale = SIDE / self.width
        corner = self.centre - 0.5 * self.width

        def shown(points: Array) -> str:
            x, y = ((np.atleast_2d(points) - corner) * scale).T
            return " ".join(f"{a:.1f},{SIDE - b:.1f}" for a, b in zip(x, y, strict=True))

        parts = [
            f'<svg x="{left:.0f}" y="{TOP}" width="{SIDE}" height="{SIDE}">',
            f'<rect width="{SIDE}" height="{SIDE}" fill="#fff" stroke="#ccc"/>',
        ]
        for number in self.circled:
            x, y = shown(self.places[number]).split(",")
            parts.append(f'<circle cx="{x}" cy="{y}" r="{self.zone * scale:.1f}" fill="{ZONE}" stroke="#b9cbe0"/>')
        parts += [
            f'<polyline points="{shown(self.places)}" fill="none" stroke="{GREY}" stroke-dasharray="6 4"/>',
            f'<polyline points="{shown(self.tool())}" fill="none" stroke="{BLUE}" stroke-width="2.5"/>',
            *(
                f'<circle cx="{x}" cy="{y}" r="3" fill="{GREY}"/>'
                for x, y in (shown(place).split(",") for place in self.places)
            ),
            "</svg>",
        ]
        return [label(left + 0.5 * SIDE, TOP - 12, self.title, "middle"), *parts]


def panels() -> list[Panel]:
    """Return a lone corner, and chords of a circle whose zones do not reach each other, and do."""
    angles = np.arange(-60.0, 61.0, 20.0) * DEG
    chords = 30.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    middle = np.array([28.5, 0.0])
    return [
        Panel(
            title="a corner with ZONE 20",
            places=np.array([[0.0, 0.0], [60.0, 0.0], [60.0, 60.0]]),
            zone=20.0,
            centre=np.array([49.0, 11.0]),
            width=64.0,
            circled=[1],
        ),
        Panel(
            title="chords of 10.4 mm with ZONE 2",
            places=chords,
            zone=2.0,
            centre=middle,
            width=26.0,
            circled=range(1, 6),
        ),
        Panel(
            title="the same chords with ZONE 10",
            places=chords,
            zone=10.0,
            centre=middle,
            width=26.0,
            circled=[3],
        ),
    ]


def corners() -> str:
    """Return the picture as SVG."""
    gap = (WIDTH - 3 * SIDE) / 4.0
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="sans-serif" font-size="12" fill="#222">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
    ]
    keys = (
        (f'stroke="{GREY}" stroke-dasharray="6 4"', "programmed"),
        (f'stroke="{BLUE}" stroke-width="2.5"', "planned path of the tool"),
    )
    x = gap
    for look, name in keys:
        parts += [f'<line x1="{x:.0f}" y1="20" x2="{x + 32:.0f}" y2="20" {look}/>', label(x + 40, 24, name, "start")]
        x += 60 + 7 * len(name)
    parts += [
        f'<circle cx="{x + 20:.0f}" cy="20" r="8" fill="{ZONE}" stroke="#b9cbe0"/>',
        label(x + 36, 24, "zone", "start"),
    ]
    for number, panel in enumerate(panels()):
        parts += panel.drawn(gap + number * (SIDE + gap))
    return "\n".join([*parts, "</svg>"]) + "\n"
