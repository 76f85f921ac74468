"""An export played as a PLC plays it, and the distance of the tool point from the straight lines of its moves.

Frequency times time is integrated row by row, the joints go through forward kinematics of this module's own, so that
the check shares no code with the exporter, and the path error is measured at the row ends and between them:

    pulses(t) = pulses(row start) +- frequency (t - row start)        until the row's target is reached
    joint     = pulses x pulse equivalent
    tool      = prod_i( placement_i Rz(q_i) ) X_last_flange X_flange_tool          of an arm; of others, their equations

An axis of an arm that slides has Tz(q_i), m.

Nothing is checked here: what ``runtime.pulses.folder.read_export`` returns can be played. Called by
'robolang replay-pulses'.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul, norm
from runtime.core.units import MM, badness
from runtime.pulses.exported import Export, Mechanism, Move, Table


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveReplay:
    """A move played by its tables: S steps, M channels, K = S x samples + 1 times.

    ``times`` (K,) s from the start of the move; ``pulses`` (K, M); ``frequency`` (S, M) Hz, negative when counting
    down, in each step; ``points`` (K, 3) m of the tool point; ``error_mm`` (K,), its distance from the straight segment
    of the move. The largest of them: ``rows_mm`` at the row ends, ``between_mm`` between them; ``end_mm``: distance of
    the last point from the end of the segment. ``counts`` (M,): pulses that each channel sends, up and down.
    """

    move: Move
    duration_s: float
    times: Array
    pulses: Array
    frequency: Array
    points: Array
    error_mm: Array
    rows_mm: float
    between_mm: float
    end_mm: float
    counts: tuple[int, ...]

    @property
    def worst_mm(self) -> float:
        """Largest of the errors, mm."""
        return max(self.rows_mm, self.between_mm, self.end_mm, key=badness)

    @property
    def fastest(self) -> tuple[float, int]:
        """Highest frequency, Hz, and its channel, from 0."""
        if not len(self.frequency):
            return 0.0, 0
        highest = np.abs(self.frequency).max(axis=0)
        return float(highest.max()), int(np.argmax(highest))


def positions(move: Move, t: Array) -> Array:
    """Return the positions (K, M) of all channels, pulses, at times t (K,) s from the start of the move.

    Before the start and after the end they stand still.
    """
    # a constant frequency within a row makes the position linear there, so interpolation is exact at any time
    columns = [
        np.full(np.shape(t), at) if table is None else np.interp(t, table.ends, table.pulses)
        for at, table in zip(move.first, move.tables, strict=True)
    ]
    return np.stack(columns, axis=-1)


def frequencies(move: Move) -> Array:
    """Return the frequency (steps, M) Hz of every channel in each time step, negative when counting down."""
    columns = [
        np.zeros(move.steps) if table is None else np.repeat(table.frequency, table.steps.astype(np.int64))
        for table in move.tables
    ]
    return np.stack(columns, axis=-1)


def joint_values(export: Export, pulses: Array) -> Array:
    """Return the joint values (..., M), rad or m, at positions (..., M) in pulses."""
    return np.asarray(pulses * np.array([channel.si_per_pulse for channel in export.channels]))


def tool_points(export: Export, pulses: Array) -> Array:
    """Return the tool points (K, 3) m in the world at positions (K, M) in pulses."""
    mechanism, values = export.mechanism, joint_values(export, pulses)
    if mechanism.kind == "arm":
        return _arm_points(mechanism, values)
    joints = dict(zip(mechanism.axes, values.T, strict=True))
    x, y, z = (joints.get(axis, np.full(len(values), at)) for axis, at in zip("xyz", mechanism.constant, strict=True))
    if mechanism.kind == "cylindrical":
        x, y = joints["r"] * np.cos(joints["theta"]), joints["r"] * np.sin(joints["theta"])
    if mechanism.kind == "scara":
        l1, l2 = mechanism.lengths
        first, both = joints["theta1"], joints["theta1"] + joints["theta2"]
        x, y = l1 * np.cos(first) + l2 * np.cos(both), l1 * np.sin(first) + l2 * np.sin(both)
    return np.stack([x, y, z], axis=-1)


def _arm_points(mechanism: Mechanism, q: Array) -> Array:
    """Take the tool point from the last frame to the world, joint by joint: q (K, n) rad or m -> (K, 3) m."""
    tool = matmul(mechanism.X_last_flange, mechanism.X_flange_tool)[:3, 3]
    points = np.tile(tool, (len(q), 1))
    # from the tool inwards: one vector a joint to turn instead of a matrix to multiply
    for axis in reversed(range(len(mechanism.placements))):
        placement, at = mechanism.placements[axis], q[:, axis]
        x, y, z = points.T
        if axis in mechanism.sliding:
            moved = np.stack([x, y, z + at], axis=-1)
        else:
            c, s = np.cos(at), np.sin(at)
            moved = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
        points = matmul(moved, placement[:3, :3].T) + placement[:3, 3]
    return points


def distances(points: Array, start: Array, end: Array) -> Array:
    """Return the distance (K,) of points (K, 3) from the straight segment between two points (3,), all in m."""
    segment = end - start
    length = norm(segment)
    # a move that only turns the tool has a segment of one point
    along = np.zeros(len(points)) if length < 1e-12 else np.clip(matmul(points - start, segment) / length**2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - start - along[:, None] * segment, axis=1))


def replay(export: Export, samples_per_step: int = 4) -> list[MoveReplay]:
    """Return every move played by its tables, ``samples_per_step`` times in each time step (at least 2)."""
    if samples_per_step < 2:
        raise ValueError(f"{samples_per_step} samples in a step: at least 2 are needed to see between the rows")
    return [_replay(export, move, samples_per_step) for move in export.moves]


def _replay(export: Export, move: Move, samples: int) -> MoveReplay:
    times = np.arange(move.steps * samples + 1) / samples * export.step_s
    pulses = positions(move, times)
    points = tool_points(export, pulses)
    error = distances(points, move.start, move.end) / MM
    # row ends are every ``samples``-th time, since every row lasts whole steps
    between = np.arange(len(times)) % samples != 0
    return MoveReplay(
        move=move,
        duration_s=move.steps * export.step_s,
        times=frozen(times),
        pulses=frozen(pulses),
        frequency=frozen(frequencies(move)),
        points=frozen(points),
        error_mm=frozen(error),
        # a chord between two row ends may be off the line although both of them are on it: measured apart
        rows_mm=float(error[~between].max()),
        between_mm=float(error[between].max(initial=0.0)),
        end_mm=norm(points[-1] - move.end) / MM,
        counts=tuple(_count(table) for table in move.tables),
    )


def _count(table: Table | None) -> int:
    return 0 if table is None else round(sum(abs(after - before) for before, after in pairwise(table.pulses.tolist())))
