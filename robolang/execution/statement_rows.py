"""The rows of a record: of an effect that begins, and of what is left of one that was interrupted on its path."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.execution.planned_move import PlannedChain
from robolang.execution.result import StatementRun
from robolang.interpreter.effects import Effect, MoveTo, SetPayload
from robolang.project.points import Point, PointStore
from robolang.syntax.unparse import describe
from robolang.values.poses import Place
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.units import MM
from runtime.motion.path import LinePath, Path
from runtime.motion.spline_path import SplinePath
from runtime.robot.model.payload import Payload

_SAMPLES = 1001
_SHORT = 1.0 * MM
"""An arc or a spline shorter than this is a line."""
_TOGETHER = 1e-9
"""Joints that turn together are off the straight line in joint space by less, rad."""
_ON_LINE, _ON_TURN = 1e-5, 1e-4
"""Set-points are on a line by less, m and rad."""


def row_of(effect: Effect, tick: int, points: PointStore) -> StatementRun:
    """Return the row of an effect that begins at a tick, with the taught points that it names."""
    return StatementRun(
        origin=effect.origin,
        text=describe(effect.node),
        first_tick=tick,
        effect=effect,
        points=_named_by(effect, points),
    )


def note_plan(runs: Sequence[StatementRun], planned: PlannedChain, skipped: int, new: int) -> None:
    """Note in the rows of moves what is planned of them: of all times and speeds, of the ``new`` last ones the rest.

    The chain has ``skipped`` moves more, before the first of them.
    """
    parts = planned.plan.parts[skipped:]
    for at, (run, part) in enumerate(zip(runs, parts, strict=True), start=skipped):
        run.planned_s, run.speeds, run.at = part.planned_s, planned.speeds, at
    for run, part in zip(runs[-new:], parts[-new:], strict=True):
        run.path, run.wrist, run.notes = part.path, part.wrist, [*run.notes, *part.notes]


def stopped(run: StatementRun) -> None:
    """Note that a move stops at its end: nothing follows into which it could blend."""
    if isinstance(run.effect, MoveTo):
        run.effect = replace(run.effect, zone_mm=0.0)


def payload_row(effect: SetPayload, payload: Payload, time_s: float) -> dict[str, object]:
    """Return what a record keeps of a LOAD."""
    return {
        "time_s": time_s,
        # 0: a statement that was fed, which is in no line of the file
        "line": effect.line or None,
        "number": effect.number,
        "mass_kg": payload.mass,
        # rounded: 15.7 mm, stored in m, comes back as 15.699999999999998
        "cog_mm": [float(x) for x in np.round(payload.cog / MM, 9)],
    }


def _named_by(effect: Effect, points: PointStore) -> tuple[Point, ...]:
    if not isinstance(effect, MoveTo):
        return ()
    names = dict.fromkeys(place.point for place in (effect.target, *effect.via) if place.point)
    return tuple(point for point in map(points.get, names) if point is not None)


def straight_path(q: Array, X: Array) -> LinePath | None:
    """Return the line that set-points q (K, n) rad with tool poses X (K, 4, 4) follow; None: all joints turn together,
    or the tool leaves the line."""
    turned = q - q[0]
    far = turned[-1]
    size = float(np.sum(far * far))
    if not size > 0.0 or np.abs(turned - (turned * far).sum(axis=1)[:, None] / size * far).max() < _TOGETHER:
        return None
    path = LinePath.between(X[0], X[-1])
    # a turn of more than half a turn ends where a shorter one in the other direction does
    traces = (X[0, :3, :3] * X[:, :3, :3]).sum(axis=(1, 2))
    turns = np.arccos(np.clip((traces - 1.0) / 2.0, -1.0, 1.0))
    follows = path.deviation(X[:, :3, 3]).max() < _ON_LINE and turns.max() < abs(path.angle) + _ON_TURN
    return path if follows else None


def copied(run: StatementRun) -> StatementRun:
    """Return a row apart from one that is still written to."""
    # notes are added to while a statement runs: a list that is shared would change the snapshot
    return replace(run, notes=list(run.notes))


def rest_of(run: StatementRun, q: Array, around: Surroundings) -> Effect | None:
    """Return the move from joints q (n,) rad on the path of a row to its end; other effects as they are.

    A DEPART is measured from where it began, and the point via which an arc leads may have been passed: they become a
    move to a pose in the world, and an arc through the middle of what is left. So may points of a spline: what is left
    goes through places of the curve.
    """
    effect, path = run.effect, run.path
    if not isinstance(effect, MoveTo) or path is None:
        return effect
    if effect.target.last:
        # in the world, since a pose has no other frame of its own
        return replace(effect, target=_place(path, 1.0))
    return _between(effect, path, _parameter(path, _tool(q, around)), 1.0)


def note_rest(run: StatementRun, q: Array, around: Surroundings) -> None:
    """Note that the arm came to rest at joints q (n,) rad, short of the end of a move: its effect is the part up to
    there, but for its target."""
    run.rest = tuple(float(angle) for angle in q / around.cell.robot.units)
    if isinstance(run.effect, MoveTo) and run.path is not None:
        run.effect = _between(run.effect, run.path, 0.0, _parameter(run.path, _tool(q, around)))


def _tool(q: Array, around: Surroundings) -> Array:
    return np.asarray(matmul(around.kinematics.forward(q), around.X_flange_tool))[:3, 3]


def _between(effect: MoveTo, path: Path, low: float, high: float) -> MoveTo:
    """Return the part of an arc or a spline between two path parameters; of another path the whole."""
    if not effect.via:
        return effect
    # three points so near to one another may lie in line, which is no arc
    if (high - low) * path.length < _SHORT:
        return replace(effect, path="line", via=())
    if not isinstance(path, SplinePath):
        return replace(effect, via=(_place(path, (low + high) / 2.0),))
    return replace(effect, via=tuple(_place(path, s) for s in path.places_within(low, high)))


def _parameter(path: Path, p: Array) -> float:
    """Return the parameter at which a path is nearest to a point (3,)."""
    s = np.linspace(0.0, 1.0, _SAMPLES)
    return float(s[np.argmin(np.linalg.norm(path.points(s) - p, axis=1))])


def _place(path: Path, s: float) -> Place:
    return Place(pose=lowering.six_of(path.poses(np.array([s]))[0]))
