"""The rows of a record: of an effect that begins, and of what is left of one that was interrupted on its path."""

from dataclasses import replace

import numpy as np

from robolang.execution import lowering
from robolang.execution.result import StatementRun
from robolang.interpreter.effects import Effect, MoveTo
from robolang.project.points import Point, PointStore
from robolang.syntax.unparse import describe
from robolang.values.poses import Place
from runtime.core.frames import Array
from runtime.core.units import MM
from runtime.motion.path import Path

_SAMPLES = 1001
_SHORT = 1.0 * MM
"""An arc shorter than this is a line."""


def row_of(effect: Effect, tick: int, points: PointStore) -> StatementRun:
    """Return the row of an effect that begins at a tick, with the taught points that it names."""
    return StatementRun(
        origin=effect.origin,
        text=describe(effect.node),
        first_tick=tick,
        effect=effect,
        points=_named_by(effect, points),
    )


def _named_by(effect: Effect, points: PointStore) -> tuple[Point, ...]:
    if not isinstance(effect, MoveTo):
        return ()
    names = (place.point for place in (effect.target, effect.via) if place is not None and place.point)
    return tuple(point for point in map(points.get, names) if point is not None)


def copied(run: StatementRun) -> StatementRun:
    """Return a row apart from one that is still written to."""
    # notes are added to while a statement runs: a list that is shared would change the snapshot
    return replace(run, notes=list(run.notes))


def rest_of(effect: Effect | None, path: Path | None, p_now: Array) -> Effect | None:
    """Return the move from the tool point p_now (3,) m on a path to its end; other effects as they are.

    A DEPART is measured from where it began, and the point via which an arc leads may have been passed: they become a
    move to a pose in the world, and an arc through the middle of what is left.
    """
    if not isinstance(effect, MoveTo) or path is None:
        return effect
    if effect.target.last:
        # in the world, since a pose has no other frame of its own
        return replace(effect, target=_place(path, 1.0))
    return _arc_between(effect, path, _parameter(path, p_now), 1.0)


def begin_of(effect: Effect | None, path: Path | None, p_now: Array) -> Effect | None:
    """Return the part of a move up to the tool point p_now (3,) m, but for its target, which is where the arm rests."""
    if not isinstance(effect, MoveTo) or path is None:
        return effect
    return _arc_between(effect, path, 0.0, _parameter(path, p_now))


def _arc_between(effect: MoveTo, path: Path, low: float, high: float) -> MoveTo:
    """Return the part of an arc between two path parameters; of another path the whole."""
    if effect.via is None:
        return effect
    # three points so near to one another may lie in line, which is no arc
    if (high - low) * path.length < _SHORT:
        return replace(effect, path="line", via=None)
    return replace(effect, via=_place(path, (low + high) / 2.0))


def _parameter(path: Path, p: Array) -> float:
    """Return the parameter at which a path is nearest to a point (3,)."""
    s = np.linspace(0.0, 1.0, _SAMPLES)
    return float(s[np.argmin(np.linalg.norm(path.points(s) - p, axis=1))])


def _place(path: Path, s: float) -> Place:
    return Place(pose=lowering.six_of(path.poses(np.array([s]))[0]))
