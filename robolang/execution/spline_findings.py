"""Where the curve of a SPLINE is not what its points look like, by the points as the program writes them.

    RBL236   points in a row that are at one pose, by two names: the curve passes it once
    RBL436   a curve that leaves the straight line between two points by more than half of their distance, or of the
             distance of the points beside them
    RBL437   a curve that doubles back at a point

Called for each planned spline (``plan_findings``).
"""

from collections.abc import Sequence

from robolang.execution.planned_move import Found, PlanFinding
from runtime.core.units import MM
from runtime.motion.spline_path import SplinePath

_FAR = 0.5
"""Share of the shortest distance of points about a piece of a curve from which on it swings out."""
_SMALL = 0.1 * MM
"""A curve that leaves the straight line by less does not swing, m."""


def spline_findings(path: SplinePath, names: Sequence[str]) -> Found:
    """Yield the findings of a curve, at most one of a code; ``names`` are those of the start and of all points."""
    yield from _left_out(path, names)
    yield from _swings(path, names)
    returns = path.returns()
    if returns:
        at = " and at ".join(names[number] for number in returns)
        message = f"the curve doubles back at {at}: the tool is slower there than its SPEED, and may come to rest"
        yield PlanFinding(code="RBL437", message=message)


def _left_out(path: SplinePath, names: Sequence[str]) -> Found:
    for number, same in path.pairs:
        # two of one name are found without planning, and many write where the arm is as the first point
        if same > 0 and names[number].upper() != names[same].upper():
            message = f"{names[number]} is where {names[same]} is: the curve passes it once"
            yield PlanFinding(code="RBL236", message=message, remedy="Remove one of the two, or teach it anew.")
            return


def _swings(path: SplinePath, names: Sequence[str]) -> Found:
    swings = path.swings()
    chords = [swing.chord for swing in swings]
    # the curve swings where spacing changes: a long piece is compared with the short ones beside it
    far = [
        (swing, path.numbers[k], min(chords[max(k - 1, 0) : k + 2]))
        for k, swing in enumerate(swings)
        if not swing.distance <= max(_FAR * min(chords[max(k - 1, 0) : k + 2]), _SMALL)
    ]
    if far:
        swing, before, nearest = max(far, key=lambda each: each[0].distance)
        first, second = names[before], names[swing.point]
        yield PlanFinding(
            code="RBL436",
            message=f"the curve goes {swing.distance / MM:.1f} mm off the straight line of {swing.chord / MM:.1f} mm "
            f"from {first} to {second}, where points are {nearest / MM:.1f} mm apart",
            remedy=f"Teach a point between {first} and {second}.",
        )
