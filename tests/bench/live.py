"""``make view-bench``: what a live view costs the thread of the run: CPU time with a page that reads, against without.

The page is a process of its own, which reads all that it gets. Runs with and without it take turns, and the least of
each counts: what else the computer does can only add to it.
"""

import subprocess
import sys
import time
from collections.abc import Iterator

from robolang.execution.session import Session
from robolang.project.project import Project, load_project
from robolang.view.driver import Driver
from robolang.view.guard import LivePage
from robolang.view.live import Live
from tests.bench import figures
from tests.bench.figures import Row

PROGRAM = "programs/pick_and_place.rbl"
MOST = 1.1
PAGE = LivePage(html=b"", script="'none'", style="'none'")
READER = """
import sys
from websockets.sync.client import connect
base, _, query = sys.argv[1].partition("/?")
with connect(f"{base.replace('http', 'ws')}/live?{query}", origin=base, compression=None, max_size=None) as page:
    count = 0
    for message in page:
        count += isinstance(message, bytes)
print(count)
"""
FIGURE = "CPU time of the run's thread with a page that reads, against without"


def plain(project: Project, physics: bool) -> float:
    """Return the CPU time of a run, s."""
    session = Session(project, physics=physics)
    began = time.thread_time()
    session.run()
    return time.thread_time() - began


def followed(project: Project, physics: bool) -> tuple[float, int, float]:
    """Return the CPU time of a run that a page follows, s, how many frames the page got, and the wall time, s."""
    live = Live(PAGE)
    session = Session(project, physics=physics, observer=live.frames)
    with live.serve(session) as url:
        reader = subprocess.Popen([sys.executable, "-c", READER, url], stdout=subprocess.PIPE, text=True)
        while not live.exchange.pages:
            live.exchange.wait(1.0)
        driver = Driver(session, live.exchange, live.frames)
        began, wall = time.thread_time(), time.perf_counter()
        session.run(driver.run_through)
        took, lasted = time.thread_time() - began, time.perf_counter() - wall
    frames, _ = reader.communicate()
    return took, int(frames), lasted


def rows(smallest: bool) -> Iterator[Row]:
    """Measure what a page costs."""
    project = load_project(PROGRAM)
    without, beside = [], []
    for _ in range(1 if smallest else 20):
        without.append(plain(project, not smallest))
        beside.append(followed(project, not smallest))
    ratio = min(took for took, _, _ in beside) / min(without)
    rates = [frames / lasted for _, frames, lasted in beside]
    yield Row(
        figure=FIGURE,
        form="{:.2f} times",
        values=(ratio,),
        good=smallest or ratio <= MOST,
        details=(f"{min(without):.3f} s without; {min(rates):.0f} to {max(rates):.0f} frames per second",),
    )


if __name__ == "__main__":
    figures.run(rows)
