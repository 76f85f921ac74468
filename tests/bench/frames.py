"""``make view-bench``: what a frame of a page costs while it plays, for a short run and a long one."""

import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Page

from tests.bench import figures
from tests.bench.figures import Row
from tests.robolang.view import made_up
from tests.robolang.view.browser import Tab, chromium

LENGTHS_S = (5.0, 60.0)
"""Of the short and the long run."""
FEWEST = 5
"""Frames of a round; a busy machine draws few of them."""
MOST = 1.3
"""A frame of the long run may cost so many times that of the short one."""


def frame_ms(page: Page, plays_ms: int) -> float:
    """Play from the start and return the time of the page's script in a frame, with the picture of the robot, ms."""
    page.evaluate("robolang.pause(); robolang.seek(0); Object.assign(robolang.cost, { frames: 0, ms: 0, robot: 0 })")
    page.evaluate("robolang.play()")
    page.wait_for_timeout(plays_ms)
    while page.evaluate("robolang.cost.frames") < FEWEST:
        page.wait_for_timeout(50)
    return page.evaluate("(robolang.cost.ms + robolang.cost.robot) / robolang.cost.frames")


def costs(folder: Path, smallest: bool) -> list[float]:
    """Return the medians of both runs, ms; they take turns, so that a slow moment of the machine meets both.

    Smallest: shorter runs on a small page.
    """
    found: dict[float, list[float]] = {duration: [] for duration in ((0.5, 2.0) if smallest else LENGTHS_S)}
    rounds, plays_ms = (1, 20) if smallest else (7, 2500)
    size = (320, 240) if smallest else (1280, 800)
    with chromium() as browser:
        tabs = {}
        for duration in found:
            path = made_up.page(folder / f"{duration}.html", made_up.run(duration))
            tabs[duration] = Tab(browser, *size).open(path)
        for _ in range(rounds):
            for duration, page in tabs.items():
                page.bring_to_front()
                found[duration].append(frame_ms(page, plays_ms))
                page.evaluate("robolang.pause()")
    return [statistics.median(each) for each in found.values()]


def rows(smallest: bool) -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        short, long = costs(Path(folder), smallest)
    yield Row(
        figure="work of the page in a frame while a run of 5 s plays, with the robot",
        form="{:.2f} ms",
        values=(short,),
    )
    yield Row(
        figure="the same of a run of 60 s, against that of 5 s",
        form="{:.2f} times",
        values=(long / short,),
        good=smallest or long <= MOST * short,
    )


if __name__ == "__main__":
    figures.run(rows)
