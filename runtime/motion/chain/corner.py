r"""A corner between two moves: a curve that leaves the first before its end and joins the second after its start.

Both are run at once, the first slower and slower, the second faster and faster. With u from 0 to 1 over the corner, d
m its half, and f the function with f(0) = f'(0) = f''(0) = 0, f'(1) = 1 and f''(1) = 0 whose f'' rises over a third of
the corner, stays, and falls,

    rest of the first    2 d f(1 - u)          passed of the second    2 d f(u)

    place        p(u) = p_first + p_second - p_corner            orientation    R(u) = R_first R_corner^T R_second

So place, direction and curvature are continuous where it leaves the first and joins the second; two pieces of one line
stay that line, run evenly; and on lines the tool is within d of the corner. Where a move is a joint move, or goes
through its wrist, the joints are added in place of poses: q(u) = q_first + q_second - q_corner. d is the zone, where it
is not more than half of either move, and less where the tool would leave the zone or a joint its range.

Moves in a row that turn little stand for a curve: there d is the zone also where that is more than half of a move, the
corners overlap, and what runs bends evenly (``woven``). Called by ``joined``; m, rad.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul, norm
from runtime.core.units import DEG
from runtime.motion.chain.course import Course
from runtime.motion.chain.overlap import Flags, ordered
from runtime.motion.chain.piece import Piece
from runtime.motion.path_ik import RANGE_TOLERANCE, Arm, LineSolver

_CHECKED = np.linspace(0.0, 1.0, 17)
_SMALLER, _TRIES = 0.75, 12
_LEAST = 1e-7
"""A corner of less, m, is none."""
_SAME = 1e-7
"""By how much the joints of a corner may differ from those of its moves where they meet, rad: rounding."""
GENTLE = 30.0 * DEG
"""Moves that turn by less stand for a curve."""
_TANGENT = 1e-3
"""Share of a path over which its direction at an end is taken."""
_WEAVINGS = 4
_BETWEEN = 6
"""Places of a move at which corners that overlap are checked."""
_WITHIN = 1.0 + 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Corner:
    """A corner as planned: its ``radius``, m, as programmed, and ``cycles`` in which both moves run (0: it stops).

    ``reach`` m: how far from the corner the tool leaves or joins the paths, at most; ``deviation`` m: by how much it
    misses the corner.
    """

    radius: float
    cycles: int = 0
    reach: float = 0.0
    deviation: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rounding:
    """The curve at a corner of programmed ``zone`` m: ``half`` d m, 0: the arm stops; ``by_pose``: poses are added."""

    zone: float
    half: float = 0.0
    by_pose: bool = True


def roundings(pieces: Sequence[Piece], zones: Sequence[float], arm: Arm) -> list[Rounding]:
    """Return the roundings (K - 1,) between pieces (K,) with zones (K - 1,) m at their ends."""
    pairs = list(zip(pieces, pieces[1:], zones, strict=False))
    room = np.array([_room_between(*pair, arm) for pair in pairs])
    found = [Rounding(zone=zone) for zone in zones]
    easy = _hold_by_pose(pieces, np.asarray(zones, dtype=np.float64), room, arm)
    for k, (first, second, zone) in enumerate(pairs):
        if easy[k]:
            found[k] = Rounding(zone=zone, half=float(room[k]))
        elif room[k] > _LEAST:
            found[k] = _fitted(first, second, zone, float(room[k]), arm)
    return found


def _hold_by_pose(pieces: Sequence[Piece], zones: Array, halves: Array, arm: Arm) -> Flags:
    """Return whether (K - 1,) corners of ``halves`` hold with poses added; all are solved in one call."""
    closed = arm.kinematics.closed_form
    same = [closed and _one_posture(first, second) for first, second in itertools.pairwise(pieces)]
    found = np.array(same, dtype=bool) & (halves > _LEAST)
    rows = np.flatnonzero(found)
    if not len(rows):
        return found
    course = Course(arm, pieces, np.where(found, halves, 0.0), np.ones(len(halves), dtype=bool))
    x = (course.ends[rows + 1][:, None] + halves[rows][:, None] * (2.0 * _CHECKED - 1.0)).ravel()
    q = course.joints(x, np.repeat(course.starts[rows + 1], len(_CHECKED), axis=0))
    off = course.points(x, q) - np.repeat(course.corners[rows], len(_CHECKED), axis=0)
    far = np.sqrt((off**2).sum(axis=1)) / np.repeat(zones[rows], len(_CHECKED))
    fits = _in_ranges(q, arm) & (far <= _WITHIN)
    found[rows] = fits.reshape(len(rows), -1).all(axis=1)
    return found


def _one_posture(first: Piece, second: Piece) -> bool:
    """Return whether two moves keep their postures, in one configuration."""
    a, b = first.curve, second.curve
    return isinstance(a, LineSolver) and isinstance(b, LineSolver) and str(a.branch) == str(b.branch)


def _fitted(first: Piece, second: Piece, zone: float, half: float, arm: Arm) -> Rounding:
    """Return the largest rounding found between two pieces, from ``half`` m downwards; its half is 0 for none."""
    by_pose = first.keeps_posture and second.keeps_posture
    for _ in range(_TRIES):
        if not half > _LEAST:
            break
        for each in (by_pose, False) if by_pose else (False,):
            if _holds(Course(arm, (first, second), np.array([half]), np.array([each])), zone):
                return Rounding(zone=zone, half=half, by_pose=each)
        half *= _SMALLER
    return Rounding(zone=zone, by_pose=by_pose)


def _holds(course: Course, zone: float) -> bool:
    """Return whether the corner of two pieces stays in its zone and the ranges, and meets its moves."""
    (first, second), corner = course.pieces, course.starts[1]
    half, middle = course.overlap.halves[1], course.ends[1]
    near = np.broadcast_to(corner, (len(_CHECKED), len(corner)))
    # just within the ends: at them one move runs alone
    inside = np.clip(2.0 * _CHECKED - 1.0, -1.0 + 1e-12, 1.0 - 1e-12)
    q = course.joints(middle + half * inside, near)
    if not _in_ranges(q, course.arm).all():
        return False
    meets = first.joints(np.array([1.0 - half / first.extent]), near[:1])[0]
    joins = second.joints(np.array([half / second.extent]), near[:1])[0]
    if not np.maximum(np.abs(q[0] - meets).max(), np.abs(q[-1] - joins).max()) <= _SAME:
        return False
    return bool((_distances(course.arm, np.concatenate([corner[None], q])) <= zone * _WITHIN).all())


def _in_ranges(q: Array, arm: Arm) -> Flags:
    """Return whether (N,) joints (N, n) are within their ranges; NaN is not."""
    return np.asarray(((q >= arm.spec.lower - RANGE_TOLERANCE) & (q <= arm.spec.upper + RANGE_TOLERANCE)).all(axis=1))


def woven(
    pieces: Sequence[Piece], found: Sequence[Rounding], arm: Arm, *, stay: int = 0, after: float = 0.0
) -> list[Rounding]:
    """Return roundings with corners of their whole zones where moves turn little, and where that fits.

    The first ``stay`` of them stay as they are, and the others begin ``after`` a place of the path, m. ``Fault`` RBL404
    where there are none.
    """
    if not found:
        return []
    ends = np.concatenate([[0.0], np.cumsum([piece.extent for piece in pieces])])
    most = np.concatenate([[each.half for each in found[:stay]], ends[1 + stay : -1] - after])
    if not (most > 0.0).all():
        raise Fault("RBL404", "the motion is too near to its end")
    found = [replace(each, half=min(each.half, room)) for each, room in zip(found, most.tolist(), strict=True)]
    gentle = np.array([_gentle(*pair, each) for pair, each in zip(itertools.pairwise(pieces), found, strict=True)])
    halves, zones, by_pose = (np.array([getattr(each, name) for each in found]) for name in ("half", "zone", "by_pose"))
    # a corner that does not fit keeps to half of its moves, and its neighbours are tried again without it
    for _ in range(_WEAVINGS):
        fits = np.minimum(_apart(ends, halves, by_pose), most)
        wide = _widened(ends, np.minimum(np.where(gentle, np.maximum(zones, halves), halves), fits), stay)
        if not (~(wide <= halves)).any():
            break
        bad = _outside(Course(arm, pieces, wide, by_pose), zones, ~(wide <= halves))
        if not bad.any():
            return [replace(each, half=half) for each, half in zip(found, wide.tolist(), strict=True)]
        gentle &= ~bad
    return found


def _widened(ends: Array, halves: Array, stay: int) -> Array:
    """Return halves (K - 1,), in order after the first ``stay``; ``Fault`` RBL404 where these are not in order."""
    last = float(halves[stay - 1]) if stay else 0.0
    found = np.concatenate([halves[:stay], ordered(ends[stay:], halves[stay:], last)])
    # what is being passed cannot become smaller
    if stay < len(found) and not last - found[stay] <= ends[stay + 1] - ends[stay] + _LEAST:
        raise Fault("RBL404", "the corners that are being passed leave no room for the next ones")
    return found


def _gentle(first: Piece, second: Piece, found: Rounding) -> bool:
    """Return whether two moves turn so little that they stand for a curve."""
    if not (found.half > 0.0 and found.by_pose and first.path is not None and second.path is not None):
        return False
    if not (first.path.length > 0.0 and second.path.length > 0.0):
        return False
    before = first.path.points(np.array([1.0 - _TANGENT, 1.0]))
    after = second.path.points(np.array([0.0, _TANGENT]))
    a, b = before[1] - before[0], after[1] - after[0]
    return math.atan2(norm(np.cross(a, b)), dot(a, b)) < GENTLE


def _apart(ends: Array, halves: Array, by_pose: Flags) -> Array:
    """Return the largest halves (K - 1,) that do not overlap a corner at which joints are added."""
    room = np.full(len(halves), np.inf)
    extents = np.diff(ends)
    for k in np.flatnonzero(~by_pose).tolist():
        room[k] = halves[k]
        for beside, extent in ((k - 1, extents[k]), (k + 1, extents[k + 1])):
            if 0 <= beside < len(halves):
                room[beside] = min(room[beside], max(extent - halves[k], halves[beside]))
    return room


def _outside(course: Course, zones: Array, wide: Flags) -> Flags:
    """Return which (K - 1,) of the ``wide`` corners are in the neighbourhood of a place that does not fit.

    Where the tool is off the programmed path it has to be in the zone of one of the corners there, in the ranges.
    """
    ends, halves = course.ends, course.overlap.halves[1:-1]
    x = np.unique(np.concatenate([ends[:-1] + share * np.diff(ends) for share in np.linspace(0.0, 1.0, _BETWEEN + 1)]))
    q = course.joints(x, course.near(x))
    points = course.points(x, q)
    first, last = course.overlap.running(x)
    nearest = np.where(first == last, 0.0, np.inf)
    for step in range(int((last - first).max(initial=0))):
        rows = np.flatnonzero(first + step < last)
        corner = first[rows] + step
        off = np.sqrt(((points[rows] - course.corners[corner]) ** 2).sum(axis=1)) / zones[corner]
        nearest[rows] = np.minimum(nearest[rows], off)
    misfit = x[~(_in_ranges(q, course.arm) & (nearest <= _WITHIN))]
    near = np.searchsorted(misfit, ends[1:-1] + halves, side="right") > np.searchsorted(misfit, ends[1:-1] - halves)
    return np.asarray(near & wide)


def _room_between(first: Piece, second: Piece, zone: float, arm: Arm) -> float:
    """Return how far from the corner between two pieces lies in its zone on both, m of their extents."""
    if not zone > 0.0:
        return 0.0
    return min(_room(first, zone, arm, at_end=True), _room(second, zone, arm, at_end=False))


def _room(piece: Piece, zone: float, arm: Arm, *, at_end: bool) -> float:
    """Return how far of a piece, m of its extent, lies in the zone at one of its ends; half of it at most."""
    most = 0.5 * piece.extent
    path = piece.path
    if piece.keeps_posture and path is not None:
        # on an arc the chord is shorter than the arc, so this is less than there is
        return most if path.length <= 0.0 else float(np.minimum(most, zone * piece.extent / path.length))
    shares = np.linspace(0.0, 0.5, 65)
    s = 1.0 - shares[::-1] if at_end else shares
    q = piece.joints(s, np.broadcast_to(piece.q_end if at_end else piece.q_start, (len(s), len(piece.q_start))))
    distance = _distances(arm, q[::-1] if at_end else q)
    out = np.flatnonzero(~(distance <= zone))
    if not len(out):
        return most
    k = int(out[0])
    part = (zone - distance[k - 1]) / (distance[k] - distance[k - 1]) if distance[k] > distance[k - 1] else 0.0
    return float(shares[k - 1] + part * (shares[k] - shares[k - 1])) * piece.extent


def _distances(arm: Arm, q: Array) -> Array:
    """Return how far the tool at q (N, n) is from where it is at the first of them, m."""
    points = matmul(arm.kinematics.forward(q), arm.X_flange_tool)[:, :3, 3]
    return np.asarray(np.linalg.norm(points - points[0], axis=1))
