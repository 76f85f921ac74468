"""Random chains of moves on five robots, and what must be true of every one: ``make blend-campaign``.

What is judged, and how, is in ``tests.runtime.motion.chains``.
"""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from tests.bench import figures
from tests.bench.figures import Row
from tests.runtime.motion.chains import KINDS, ROBOTS, examine, random_chain
from tests.runtime.motion.motions import bench

CHAINS, MOVES = 400, 5
CHUNK = 50
"""Chains between two lines of progress."""


def campaign(robot: str, chains: int, seed: int = 5, moves: int = MOVES) -> tuple[Counter[str], float]:
    """Return what was counted on a robot, and the mean share of time that blending saves."""
    arm, random = bench(robot), np.random.default_rng(seed)
    count: Counter[str] = Counter(dict.fromkeys(KINDS, 0))
    saved = []
    for k in range(1, chains + 1):
        found, share = examine(arm, random_chain(arm, random, moves))
        count.update(found)
        saved.append(share)
        if k % CHUNK == 0:
            print(f"    {robot}: {k} of {chains}, broken {count.total()}", flush=True)
    return count, float(np.mean(saved))


def rows(smallest: bool) -> Iterator[Row]:
    """Count on every robot."""
    robots, chains, moves = (ROBOTS[:1], 1, 2) if smallest else (ROBOTS, CHAINS, MOVES)
    found = {robot: campaign(robot, chains, moves=moves) for robot in robots}
    broken = [count.total() for count, _ in found.values()]
    yield Row(
        figure="random chains of five moves with zones, 400 on each of five robots: errors, limits, ranges or zones "
        "passed, wrong stops, chains longer than with stops",
        form=", ".join(["{}"] * len(found)),
        values=tuple(broken),
        good=not any(broken),
        details=tuple(f"{robot}: broken {dict(count)}" for robot, (count, _) in found.items()),
    )
    yield Row(
        figure="time that blending saves on them",
        form=", ".join(["{:.1f}"] * len(found)) + " %",
        values=tuple(100 * saved for _, saved in found.values()),
    )


if __name__ == "__main__":
    figures.run(rows)
