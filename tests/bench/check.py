"""``make bench``: what checking costs, as whole processes from a cold start, and what planning does.

The programs of text are made here: 50 lines and 10,000, of all that programs usually have. For planning each program
of ``programs/`` is rehearsed on all its ways and its motion looked at, as ``check --motion`` does; the ratio is the
time that the robot would need over the time that took, in one process.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from robolang.planning.motion_findings import findings
from robolang.planning.path_coverage import explore
from robolang.project.builtin import cell_text
from robolang.project.project import load_project
from tests.bench import figures
from tests.bench.figures import Row

PROGRAMS = Path(__file__).parents[2] / "programs"
COMMAND = Path(sys.executable).with_name("robolang")
BLOCK = """\
FOR i{0} = 1 TO 3
  APPROACH P{1}, 50, ZONE 10
  MOVE P{1} + (0, 0, 10 * i{0}), SPEED 100
  IF IN(1) = 1 THEN OUT(2) = i{0} ELSE DELAY 0.1
  total = total + ABS(i{0} - 2) * 3
  WAIT IN(3), TIMEOUT 5
  MOVEJ P{1}
  PRINT "round "; i{0}; " of "; total
NEXT i{0}
DEPART 30
"""


INPUTS = "\n[inputs.1]\nchanges = [[0, 0]]\n[inputs.3]\nchanges = [[0, 0]]\n"


def text(lines: int) -> str:
    """Return a program of so many lines without a finding."""
    blocks = (lines - 4) // 10
    body = "".join(BLOCK.format(block, 1 + block % 5) for block in range(blocks))
    rest = "' and so on\n" * (lines - 4 - 10 * blocks)
    return f"SPEED 250\nSPEEDJ 50\ntotal = 0\n{body}{rest}MOVE P5\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What a process cost, s: time from outside and processor time."""

    wall: float
    processor: float


def cold(lines: int, processes: int) -> Cost:
    """Return the median cost of ``robolang check`` of a program of so many lines; the first of several is left out."""
    costs = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.rbl"
        path.write_text(text(lines))
        path.with_name("cell.toml").write_text(cell_text() + INPUTS)
        path.with_suffix(".points.toml").write_text((PROGRAMS / "pick_and_place.points.toml").read_text())
        for _ in range(processes):
            began, before = time.perf_counter(), os.times()
            done = subprocess.run([COMMAND, "check", path], capture_output=True, text=True, check=False)
            wall, after = time.perf_counter() - began, os.times()
            spent = after.children_user + after.children_system - before.children_user - before.children_system
            costs.append(Cost(wall=wall, processor=spent))
            assert done.returncode == 0 and not done.stdout, done.stdout
    kept = costs[1:] or costs
    return Cost(
        wall=statistics.median(cost.wall for cost in kept), processor=statistics.median(cost.processor for cost in kept)
    )


class Start(NamedTuple):
    """A command that is started cold, the exit code that it has, and what its environment has in addition."""

    words: tuple[str, ...]
    code: int = 0
    environment: tuple[tuple[str, str], ...] = ()


BARE = Start((sys.executable, "-c", "pass"))
EMPTY = """\
import typer
app = typer.Typer()
app.command("a")(lambda: None)
app.command("b")(lambda: None)
app(prog_name="e")
"""
"""An app of typer with two commands that do nothing."""


def check_of(program: Path, code: int = 0) -> Start:
    return Start((str(COMMAND), "check", str(program)), code)


def cold_ratio(processes: int, one: Start, peer: Start = BARE) -> float:
    """Return the processor time of a command, in those of its peer.

    Both are the least of so many runs, in turn. The first of each is left out: it may write bytecode, and the variable
    that forbids this is not passed on, since the compiler would be measured.
    """
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    quiet = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    times: dict[Start, list[float]] = {one: [], peer: []}
    for _ in range(processes + 1):
        for start, spent in times.items():
            # wait4 gives microseconds; os.times counts in hundredths of a second, half of a bare start
            words, environment = list(start.words), {**kept, **dict(start.environment)}
            _, status, usage = os.wait4(os.posix_spawn(words[0], words, environment, file_actions=quiet), 0)
            assert os.waitstatus_to_exitcode(status) == start.code, words
            spent.append(usage.ru_utime + usage.ru_stime)
    return min(times[one][1:]) / min(times[peer][1:])


def starts(smallest: bool) -> Iterator[Row]:
    """Measure cold starts beside their peers."""
    processes = 2 if smallest else 40
    yield Row(
        figure="`robolang check programs/shop/palletise.rbl`, whole process, CPU time against a bare start of Python",
        form="{:.1f} times",
        values=(ratio := cold_ratio(processes, check_of(PROGRAMS / "shop" / "palletise.rbl")),),
        good=smallest or ratio <= 5.0,
    )
    with tempfile.TemporaryDirectory() as folder:
        broken, empty = Path(folder) / "broken.rbl", Path(folder) / "empty.py"
        broken.write_text("10 MOV P1\n")
        empty.write_text(EMPTY)
        typed = (str(COMMAND),)
        peer = (sys.executable, str(empty))
        line = (("COMP_WORDS", "robolang ru"), ("COMP_CWORD", "1"))
        yield Row(
            figure="the same, a program of one line with an error (`10 MOV P1`)",
            form="{:.1f} times",
            values=(ratio := cold_ratio(processes, check_of(broken, 1)),),
            good=smallest or ratio <= 5.0,
        )
        yield Row(
            figure="`robolang --help`, whole process, CPU time against that of an app of typer with two empty commands",
            form="{:.2f} times",
            values=(ratio := cold_ratio(processes, Start((*typed, "--help")), Start((*peer, "--help"))),),
            good=smallest or ratio <= 1.2,
        )
        ours = Start(typed, environment=(*line, ("_ROBOLANG_COMPLETE", "complete_bash")))
        theirs = Start(peer, environment=(*line, ("_E_COMPLETE", "complete_bash")))
        yield Row(
            figure="completion of a command in bash, against that app",
            form="{:.2f} times",
            values=(ratio := cold_ratio(processes, ours, theirs),),
            good=smallest or ratio <= 1.2,
        )


def ratio(path: Path, rounds: int) -> tuple[float, float]:
    """Return the robot's time for a program, s, and how much faster it is planned and its motion examined."""
    project = load_project(path)
    best = float("inf")
    for _ in range(rounds):
        began = time.perf_counter()
        explored = explore(project)
        findings(project, explored.rehearsal, None, explored.detours)
        best = min(best, time.perf_counter() - began)
    robot_s = explored.rehearsal.total_us / 1e6
    return robot_s, robot_s / best


def planning(paths: list[Path], rounds: int) -> Row:
    """Measure the planning of programs; those without motion say nothing."""
    found = {path.relative_to(PROGRAMS).as_posix(): ratio(path, rounds) for path in paths}
    times = [ratio for _, ratio in found.values()]
    return Row(
        figure="planning all branches of a program and checking its motion, against the time of the robot, "
        "in one process",
        form="{:.0f} to {:.0f} times, median {:.0f}",
        values=(min(times), max(times), statistics.median(times)),
        details=tuple(
            f"{name}: {robot_s:.2f} s of the robot, {ratio:.0f} times" for name, (robot_s, ratio) in found.items()
        ),
    )


def rows(smallest: bool) -> Iterator[Row]:
    """Measure checking and planning."""
    few, many, processes = (50, 200, 1) if smallest else (50, 10_000, 10)
    yield Row(
        figure="`robolang check` of a program of 50 lines, whole process, cold",
        form="{:.0f} ms",
        values=(1e3 * cold(few, processes).wall,),
    )
    yield Row(
        figure="10,000 lines checked, the branches through them followed, CPU time",
        form="{:.2f} s",
        values=(cold(many, processes).processor,),
    )
    yield from starts(smallest)
    paths = [PROGRAMS / "pick_and_place.rbl"] if smallest else sorted(PROGRAMS.rglob("*.rbl"))
    yield planning(paths, 1 if smallest else 5)


if __name__ == "__main__":
    figures.run(rows)
