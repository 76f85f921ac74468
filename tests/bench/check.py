"""``make bench``: what checking costs, as whole processes from a cold start, and what planning does.

The programs of text are made here: 50 lines and 10,000, of all that programs usually have. For planning each program
of ``programs/`` is rehearsed on all its ways and its motion looked at, as ``check --motion`` does; the ratio is the
time that the robot would need over the time that took, in one process.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from robolang.exploration import explore
from robolang.motion_findings import findings
from robolang.project import load_project

PROGRAMS = Path(__file__).parents[2] / "programs"
COMMAND = Path(sys.executable).with_name("robolang")
PROCESSES = 9
ROUNDS = 5
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


def text(lines: int) -> str:
    """Return a program of so many lines without a finding."""
    blocks = (lines - 4) // 10
    body = "".join(BLOCK.format(block, 1 + block % 5) for block in range(blocks))
    rest = "' and so on\n" * (lines - 4 - 10 * blocks)
    return f"SPEED 250\nSPEEDJ 50\ntotal = 0\n{body}{rest}PRINT total\n"


def cold(lines: int) -> float:
    """Return the median time of ``robolang check`` of a program of so many lines, s."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.rbl"
        path.write_text(text(lines))
        times = []
        for _ in range(PROCESSES + 1):
            began = time.perf_counter()
            done = subprocess.run([COMMAND, "check", path], capture_output=True, text=True, check=False)
            times.append(time.perf_counter() - began)
            assert done.returncode == 0 and not done.stdout, done.stdout
    return statistics.median(times[1:])


def ratio(path: Path) -> tuple[float, float]:
    """Return the robot's time for a program, s, and how much faster it is planned and looked at."""
    project = load_project(path)
    best = float("inf")
    for _ in range(ROUNDS):
        began = time.perf_counter()
        explored = explore(project)
        findings(project, explored.rehearsal, None, explored.detours)
        best = min(best, time.perf_counter() - began)
    robot_s = explored.rehearsal.total_us / 1e6
    return robot_s, robot_s / best


def main() -> None:
    """Print the figures."""
    for lines in (50, 10_000):
        print(f"robolang check, {lines} lines, cold: {1e3 * cold(lines):.0f} ms")
    for path in sorted(PROGRAMS.rglob("*.rbl")):
        robot_s, times = ratio(path)
        print(f"check --motion {path.relative_to(PROGRAMS)}: {robot_s:.2f} s of the robot, {times:.0f} times faster")


if __name__ == "__main__":
    main()
