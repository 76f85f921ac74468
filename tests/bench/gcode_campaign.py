"""Milling programs in G-code, planned on a robot: ``make gcode-campaign``, where ``LINUXCNC_PROGRAMS`` names a folder.

Every program of the folder that ``gcode`` reads is scaled and placed into a box before the arm and written as a
program of this language. Counted are those that are planned without an error and those whose tool leaves its path
outside of a ZONE; the times are compared with those of a look-ahead (``lookahead``). Without a folder the two programs
of ``gcode_programs`` are taken.

The tests of LinuxCNC's trajectory planner are such a folder: tests/trajectory-planner of github.com/LinuxCNC/linuxcnc.
"""

import hashlib
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robolang.execution.dry_run import Rehearsal, RehearsedMove, rehearse
from robolang.project.project import Project
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.units import MM
from runtime.robot.files.loader import load_builtin
from tests.bench import figures
from tests.bench.figures import Row
from tests.bench.gcode import NOTHING_MM, Cut, read
from tests.bench.gcode_words import UnsupportedError
from tests.bench.lookahead import Stretch, seconds

FOLDER = "LINUXCNC_PROGRAMS"
OWN = Path(__file__).parent / "gcode_programs"
ROBOT = "irb2400"
CELL = f"""schema = 1
robot = "{ROBOT}"
[home]
joints_deg = [0, 10, 0, 0, 80, 0]
[hand]
mass_kg = 0.1
cog_mm = [0, 0, 1]
tcp_mm_deg = [0, 0, 0, 0, 0, 0]
stroke_mm = 80
grip_force_n = 120
dwell_s = 0.3
"""
CENTRE_MM, BOX_MM = np.array([900.0, 0.0, 850.0]), np.array([240.0, 240.0, 200.0])
FREE_MM = 5.0
"""ZONE of a corner that may be cut by as much as helps, mm."""
LONGEST_S = 60.0
"""A program that would take longer at its feeds is run with all of them higher, s."""
MOST_MOVES = 12_000
"""A program with more moves is left out: the text of a program is 1 MB at most."""
ON_PATH_M = 1e-9
"""A tool point nearer to its path, m, is on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A program of this language: its ``text``, and the moves that it states."""

    text: str
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """What became of a program: why it is ``refused``, "" where it is not, and how it compares."""

    name: str
    moves: int
    refused: str
    off_mm: float = 0.0
    """Largest distance of the tool from its path outside of all zones."""
    seconds: float = 0.0
    ideal_s: float = 0.0
    """Time of the ideal look-ahead, with c = 1."""
    bound_s: float = 0.0
    """The bound of every motion, with c = 2."""
    planning_s: float = 0.0
    """Processor time of the planning."""

    @property
    def ratio(self) -> float:
        """Time against that of the look-ahead."""
        return self.seconds / self.ideal_s

    def __str__(self) -> str:
        if self.refused:
            return f"{self.name}: {self.moves} moves, {self.refused}"
        return (
            f"{self.name}: {self.moves} moves, {self.seconds:.3f} s, {self.ratio:.3f} of the look-ahead, "
            f"{self.seconds / self.bound_s:.3f} of the bound, planned in {self.planning_s / self.seconds:.2f} of its "
            f"time, off by {self.off_mm:.1e} mm"
        )


def task(cuts: Sequence[Cut]) -> Task:
    """Return a program for the moves of another; those that lead nowhere are left out, as other controllers do."""
    path = load_builtin(ROBOT).path
    points = np.array([np.zeros(3), *(each for cut in cuts for each in (cut.end, cut.via) if each is not None)])
    least, most = points.min(axis=0), points.max(axis=0)
    scale = float(np.min([1.0, *(BOX_MM / np.maximum(most - least, 1e-9))]))

    def placed(point: Array) -> Array:
        # as it stands in the text, so that all compare the same numbers
        return np.asarray(np.round(CENTRE_MM + scale * (point - 0.5 * (least + most)), 4))

    at = placed(np.zeros(3))
    lines, found = [f"MOVEJ {_pose(at)}, SPEED 30"], []
    faster = _faster(cuts, scale)
    for cut in cuts:
        end = placed(cut.end)
        if float(np.abs(end - at).max()) < NOTHING_MM:
            continue
        zone = FREE_MM if cut.tolerance is None else round(cut.tolerance * scale, 4)
        feed = np.inf if cut.feed is None else np.maximum(cut.feed * faster, 1.0)
        speed = round(float(np.minimum(path.max_speed / MM, feed)), 3)
        via = None if cut.via is None else placed(cut.via)
        options = f"SPEED {speed:g}, {f'ZONE {zone:g}' if zone > 0.0 else 'FINE'}"
        lines.append(f"MOVE {_pose(end)}, {options}" if via is None else f"MOVEC {_pose(via)}, {_pose(end)}, {options}")
        way = np.array([at, end] if via is None else [at, via, end]) * MM
        found.append(Stretch(points=way, speed=speed * MM, zone=zone * MM))
        at = end
    return Task(text="\n".join(lines) + "\n", stretches=tuple(found))


def _pose(point: Array) -> str:
    return f"POSE({', '.join(f'{each:.4f}' for each in point)}, 180, 0, 180)"


def _faster(cuts: Sequence[Cut], scale: float) -> float:
    """Return by how much all feeds are raised."""
    before = np.array([np.zeros(3), *(cut.end for cut in cuts[:-1])])
    ways = [float(np.linalg.norm(cut.end - start)) for cut, start in zip(cuts, before, strict=True)]
    lasts = sum(way * scale / cut.feed for way, cut in zip(ways, cuts, strict=True) if cut.feed is not None)
    return float(np.maximum(1.0, lasts / LONGEST_S))


def examine(name: str, cuts: Sequence[Cut], settings: dict[str, object] | None = None) -> Result:
    """Plan the moves of a program and compare."""
    asked = task(cuts)
    project = Project.from_text(asked.text, cell=CELL, settings=settings or {})
    begins = time.process_time()
    rehearsal = rehearse(project)
    planning_s = time.process_time() - begins
    refused = [item for item in (*project.diagnostics, *rehearsal.refused) if item.code]
    if rehearsal.refused or not project.ok:
        return Result(name=name, moves=len(asked.stretches), refused=str(refused[0]))
    moves, period_s = rehearsal.moves[1:], project.profile.period_s
    acceleration = project.cell.robot.path.acceleration
    return Result(
        name=name,
        moves=len(asked.stretches),
        refused="",
        off_mm=off_path(rehearsal, asked.stretches) / MM,
        seconds=sum(len(move.q) - 1 for move in moves) * period_s,
        ideal_s=seconds(asked.stretches, acceleration),
        bound_s=seconds(asked.stretches, acceleration, corner=2.0),
        planning_s=planning_s,
    )


def off_path(rehearsal: Rehearsal, stretches: Sequence[Stretch]) -> float:
    """Return how far the tool is off its path, m, at most, where it is in the zone of neither corner of its move."""
    moves = rehearsal.moves[1:]
    assert len(moves) == len(stretches)
    worst = 0.0
    for number, (move, stretch) in enumerate(zip(moves, stretches, strict=True)):
        points = _tool(rehearsal, move)
        off = _distance(move, points)
        corners = [(stretch.points[-1], stretch.zone)]
        if number:
            corners.append((stretch.points[0], stretches[number - 1].zone))
        for corner, zone in corners:
            # to where a pose is rounded in the text; a program places nothing nearer
            off = np.where(np.linalg.norm(points - corner, axis=1) <= zone + ON_PATH_M, 0.0, off)
        worst = float(np.maximum(worst, off.max(initial=0.0)))
    return worst


def _tool(rehearsal: Rehearsal, move: RehearsedMove) -> Array:
    # the first row is the last of the move before it
    return np.asarray(matmul(rehearsal.kinematics.forward(move.q[1:]), move.X_flange_tool)[:, :3, 3])


def _distance(move: RehearsedMove, points: Array) -> Array:
    return np.zeros(len(points)) if move.plan.path is None else np.asarray(move.plan.path.deviation(points))


def programs(folder: Path | None) -> Iterator[tuple[str, list[Cut]]]:
    """Yield the programs of a folder that can be read, by size; of those that are alike the first."""
    seen: set[str] = set()
    for path in sorted((folder or OWN).rglob("*.ngc"), key=lambda path: (path.stat().st_size, path.name)):
        text = path.read_text("utf-8", errors="replace")
        key = hashlib.sha256(text.encode()).hexdigest()
        if key in seen:
            continue
        seen.add(key)
        try:
            cuts = read(text)
        except UnsupportedError:
            continue
        if 0 < len(cuts) <= MOST_MOVES:
            yield path.stem, cuts


def named_folder() -> Path | None:
    """Return the folder that the environment names, None without one."""
    named = os.environ.get(FOLDER)
    return Path(named) if named else None


def rows(smallest: bool) -> Iterator[Row]:
    """Plan every program."""
    found = []
    for name, cuts in programs(None if smallest else named_folder()):
        found.append(examine(name, cuts))
        if not smallest:
            print(f"    {found[-1]}", flush=True)
    planned = [each for each in found if not each.refused]
    off = [each for each in planned if not each.off_mm <= ON_PATH_M / MM]
    ratios = np.array([each.ratio for each in planned])
    planning_s, lasts_s = (sum(getattr(each, name) for each in planned) for name in ("planning_s", "seconds"))
    yield Row(
        figure="milling programs in G-code: planned, of all that are read; with the tool off its path outside of ZONE",
        form="{} of {}; {}",
        values=(len(planned), len(found), len(off)),
        good=len(planned) == len(found) and not off,
        details=tuple(str(each) for each in found if each.refused or each in off),
    )
    yield Row(
        figure="their time against that of a trapezoid look-ahead: median, largest; programs of at most 1.1",
        form="{:.3f}, {:.3f}; {}",
        values=(float(np.median(ratios)), float(ratios.max()), int((ratios <= 1.1).sum())),
    )
    yield Row(
        figure="processor time of planning them against the time of the robot: all, largest",
        form="{:.2f}, {:.2f}",
        values=(planning_s / lasts_s, float(np.max([each.planning_s / each.seconds for each in planned]))),
    )


if __name__ == "__main__":
    figures.run(rows)
