"""The warnings of what was touched and should not have been; an arm that meets itself often is one of them."""

from collections import Counter
from collections.abc import Iterable, Iterator

from runtime.core.program_line import ProgramLine
from runtime.plant.touches import Touch
from runtime.supervision.finding import Finding

_ITSELF = (
    "Take another posture or a via point. The shapes of links are capsules (link_radius_mm of the robot file): where "
    "the real arm is free there, make them thinner."
)


def touch_warnings(touches: Iterable[Touch]) -> Iterator[tuple[Finding, ProgramLine | None, str]]:
    """Yield finding, statement and hint, "" for that of the code, of touches that are findings, in their order."""
    noticed = [touch for touch in touches if touch.noticed]
    counts = Counter(map(_own_pair, noticed))
    shown: set[frozenset[str] | None] = set()
    for touch in noticed:
        pair, message = _own_pair(touch), touch.message
        if pair is not None and pair in shown:
            continue
        if pair is not None:
            message += _repeated(counts[pair] - 1)
        shown.add(pair)
        code = "RBL537" if touch.fixed else "RBL535"
        finding = Finding(code=code, message=message, tick=touch.tick, warning=True)
        yield finding, touch.place, "" if pair is None else _ITSELF


def _repeated(more: int) -> str:
    return {0: "", 1: ", and once more"}.get(more, f", and {more} more times")


def _own_pair(touch: Touch) -> frozenset[str] | None:
    """Return the two shapes of an arm that meets itself; None for another touch."""
    return frozenset((touch.by[0], touch.what)) if touch.what.startswith("link") and not touch.by_part else None
