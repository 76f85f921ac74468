"""Paths of many short moves, planned as programs: their times against length over speed (``make measured``).

An ideal controller runs along the path at SPEED and needs one ramp more, to gain the speed and to lose it: with the
acceleration a and the jerk j of the path, length / v + v / a + a / j.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

import robolang
from runtime.core.frames import Array
from runtime.core.units import MM
from runtime.robot.files.loader import load_builtin
from tests.bench import figures
from tests.bench.figures import Row
from tests.bench.gcode_campaign import CELL, ROBOT

PIECES = (1, 5, 20, 100, 1000)
SPREAD = 1.02
"""By how much the times of one line in pieces may differ."""
HEIGHT = "900.0000, 180, 0, 180"


@dataclass(frozen=True, slots=True, kw_only=True)
class Polyline:
    """Corners (K + 1, 2) mm in a plane before the arm, run at ``speed`` mm/s with a ``zone`` mm at each."""

    corners: Array
    speed: float
    zone: float

    @property
    def length_mm(self) -> float:
        """Sum of the distances from corner to corner."""
        return float(np.linalg.norm(np.diff(self.corners, axis=0), axis=1).sum())

    @property
    def text(self) -> str:
        """The program: a joint move to the first corner, a line to each of the others."""
        (first, *others) = (f"POSE({x:.4f}, {y:.4f}, {HEIGHT})" for x, y in self.corners)
        moves = (f"MOVE {pose}, SPEED {self.speed:g}, ZONE {self.zone:g}" for pose in others)
        return "\n".join([f"MOVEJ {first}, SPEED 30", *moves]) + "\n"

    @property
    def ideal_s(self) -> float:
        """Length over speed and one ramp."""
        path, speed = load_builtin(ROBOT).path, self.speed * MM
        return self.length_mm / self.speed + speed / path.acceleration + path.acceleration / path.jerk

    def seconds(self) -> float:
        """Return the planned time of its lines, as ``check --motion`` prints it."""
        plan = robolang.plan(robolang.Project.from_text(self.text, cell=CELL))
        assert plan.ok, plan.refused
        return sum(line.seconds for line in plan.lines[1:])


def line(pieces: int) -> Polyline:
    """Return 200 mm straight at 200 mm/s, in pieces with zones as long as they are."""
    y = np.linspace(-100.0, 100.0, pieces + 1)
    return Polyline(corners=np.stack([np.full_like(y, 900.0), y], axis=1), speed=200.0, zone=200.0 / pieces)


def circle(chords: int) -> Polyline:
    """Return a circle of 100 mm at 100 mm/s."""
    turn = np.linspace(0.0, 2.0 * math.pi, chords + 1)
    corners = np.stack([900.0 + 100.0 * np.cos(turn), 100.0 * np.sin(turn)], axis=1)
    return Polyline(corners=corners, speed=100.0, zone=3.0)


def dense(moves: int) -> Polyline:
    """Return moves of 1 mm on one line at 300 mm/s, with zones of less than half of them."""
    y = np.arange(moves + 1) - 0.5 * moves
    return Polyline(corners=np.stack([np.full_like(y, 900.0), y], axis=1), speed=300.0, zone=0.4)


def spiral(moves: int) -> Polyline:
    """Return seven rounds outwards to 70 mm at 400 mm/s, in moves of about 3 mm."""
    share = np.sqrt(np.linspace(0.02, 1.0, moves + 1))
    radius, turn = 70.0 * share, 14.0 * math.pi * share
    corners = np.stack([900.0 + radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    return Polyline(corners=corners, speed=400.0, zone=1.5)


def rows(smallest: bool) -> Iterator[Row]:
    """Plan every path."""
    pieces = PIECES[:2] if smallest else PIECES
    times = [line(count).seconds() for count in pieces]
    spread = max(times) / min(times)
    yield Row(
        figure="200 mm at SPEED 200 in 1, 5, 20, 100, 1,000 pieces, zones as long as they are",
        form=", ".join(["{:.3f}"] * len(times)) + " s",
        values=tuple(times),
        good=spread <= SPREAD,
    )
    paths = (circle(30), dense(20)) if smallest else (circle(90), dense(400), spiral(490))
    yield against_ideal(
        "circle in 90 chords, 400 moves of 1 mm, spiral of 490 moves, against length over SPEED and a ramp", paths
    )


def against_ideal(figure: str, paths: Sequence[Polyline]) -> Row:
    """Return the row of the ratios of times."""
    ratios = [path.seconds() / path.ideal_s for path in paths]
    return Row(figure=figure, form=", ".join(["{:.3f}"] * len(ratios)), values=tuple(ratios))


if __name__ == "__main__":
    figures.run(rows)
