"""``make view-bench``: how large the page of a run is, and what writing it costs against the run.

Half an hour is made from a minute: its rows and statements are repeated, since a run of half an hour takes minutes.
"""

import statistics
import tempfile
import time
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from robolang.execution.session import Session
from robolang.logs.log import Log
from robolang.project.project import Project, load_project
from robolang.view.page import Bundle, write_page
from robolang.view.run_page import pack_run
from tests.bench import figures
from tests.bench.figures import Row

PROGRAM = Path("programs/pick_and_place.rbl")
MOST_MB = {"short": 1.2, "minute": 3.5, "half an hour": 25.0}
MOST_SHARE = 0.1
"""Writing a page may take this part of the run that it shows."""
ROUND = """\
LOAD empty
FOR k = 1 TO {rounds}
  MOVE P2 + (2 * k, 3 * k, 0)
  MOVE P3 + (0, 0, 60 + 2 * k)
  MOVE P4 + (0, 2 * k, k), SPEED 150
  MOVEJ P5, SPEED 40
NEXT k
"""
"""No round is as another, so that gzip gains nothing by it."""


class Repeated:
    """The rows of a run so many times, one after another: ``runtime.control.signals.Rows``."""

    def __init__(self, rows, times):
        self._rows = rows
        # whole cycles and frames alone, so that the next round begins with them
        self._ticks = rows.ticks // 16 * 16
        self._whole = {"tick": self._ticks, "cycle": self._ticks // 8, "frame": self._ticks // 16}
        self.ticks, self.cycles, self.frames = (times * count for count in self._whole.values())
        self.ticks_per_cycle, self.tick_us, self.tools = rows.ticks_per_cycle, rows.tick_us, rows.tools

    def read(self, name, first, last):
        base = "frame" if name in ("parts", "fingers") else "cycle" if name in CYCLES else "tick"
        count, at = self._whole[base], np.arange(first, last)
        found = self._rows.read(name, 0, count)[at % count]
        return found + (at // count * self._ticks * self.tick_us)[:, None] if name == "read_us" else found


CYCLES = ("q_plan", "D", "T", "read_us", "payload_mass", "line", "number", "wrist_mode", "seam_deviation", "tool")


def repeated(log: Log, times: int) -> Log:
    """Return a log with the rows and the statements of another, so many times."""
    rows, meta = Repeated(log.rows, times), log.needed_meta()
    round_s = rows.ticks / times * 0.001
    statements = [
        {**each, "start_s": each["start_s"] + k * round_s}
        for k in range(times)
        for each in meta["report"]["statements"]
    ]
    return Log(rows, {**meta, "report": {**meta["report"], "statements": statements}})


def minute(folder: Path, rounds: int) -> Project:
    """Return a project that moves for nearly a minute, so that nothing is thinned; fewer rounds: for less."""
    for kind in ("points", "cell"):
        name = f"{PROGRAM.stem}.{kind}.toml"
        (folder / f"minute.{kind}.toml").write_text((PROGRAM.parent / name).read_text())
    (folder / "minute.rbl").write_text(ROUND.format(rounds=rounds))
    return load_project(folder / "minute.rbl")


def written(log: Log, folder: Path) -> tuple[float, float]:
    """Write a page and return its size, MB, and the time that it took, s."""
    began = time.perf_counter()
    write_page(folder / "page.html", [pack_run(log, "run")], Bundle.installed())
    return (folder / "page.html").stat().st_size / 1e6, time.perf_counter() - began


def share(project: Project, folder: Path, rounds: int, physics: bool) -> tuple[Log, float]:
    """Return the log of a run, and the median time of a page as a share of that of its run, the two in turn."""
    shares = []
    for _ in range(rounds):
        session, began = Session(project, physics=physics), time.perf_counter()
        log = session.run().log
        took = time.perf_counter() - began
        shares.append(written(log, folder)[1] / took)
    return log, statistics.median(shares)


def peak_mb(log: Log, folder: Path) -> float:
    """Return the most memory, MB, that writing a page takes."""
    tracemalloc.start()
    try:
        written(log, folder)
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


def rows(smallest: bool) -> Iterator[Row]:
    """Measure the pages of three runs."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        short, short_share = share(load_project(PROGRAM), folder, 1 if smallest else 5, not smallest)
        long, long_share = share(minute(folder, 1 if smallest else 15), folder, 1 if smallest else 3, not smallest)
        hours = repeated(long, 2 if smallest else -(-1_800_000 // long.count("t")))
        for what, log in (("short", short), ("minute", long), ("half an hour", hours)):
            size, took = written(log, folder)
            yield Row(
                figure=FIGURES[what],
                form="{:.2f} MB",
                values=(size,),
                good=size <= MOST_MB[what],
                details=(f"{log.count('t') * 1e-3:.1f} s simulated, written in {took:.2f} s",),
            )
        yield Row(
            figure="memory that writing the page of half an hour takes",
            form="{:.0f} MB",
            values=(peak_mb(hours, folder),),
        )
    yield Row(
        figure="writing the page of a run against the run: of 5.3 s, of a minute",
        form="{:.3f}, {:.3f} of its time",
        values=(short_share, long_share),
        good=smallest or max(short_share, long_share) <= MOST_SHARE,
    )


FIGURES = {
    "short": f"page of a run of `{PROGRAM}`, 5.3 s",
    "minute": "page of a run of a minute",
    "half an hour": "page of half an hour",
}

if __name__ == "__main__":
    figures.run(rows)
