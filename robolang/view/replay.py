"""A run as postures over time: what its log says of arm, fingers and parts, for a picture at any time."""

import numpy as np

from robolang.logs.log import Log
from runtime.appearance.scene import Scene
from runtime.appearance.stance import Stance
from runtime.core.faults import Fault
from runtime.core.frames import Array

SAMPLES = 24
"""Postures of a run by which a view is framed."""


class Replay:
    """The scene of a run and where all of it is at a time."""

    def __init__(self, log: Log) -> None:
        """``Fault`` RBL820 for a log without a scene, RBL833 where that is none."""
        self._log = log
        self.scene = Scene.from_json(log.needed_meta().get("scene"))
        self._tick_s = log.rows.tick_us * 1e-6
        if not log.count("t"):
            raise Fault("RBL832", f"{log.source} is of a run without motion: there is nothing to show")

    @property
    def end(self) -> float:
        """The time of the last row, s."""
        return (self._log.count("t") - 1) * self._tick_s

    def at(self, time: float) -> Stance:
        """Return the posture at a time, s; ``Fault`` RBL832 where the log has no numbers there."""
        tick = min(round(time / self._tick_s), self._log.count("t") - 1)
        q = self._log.span("q_link", tick, tick + 1)[0]
        fingers, parts = (self._between(name, tick * self._tick_s) for name in ("fingers", "parts"))
        if not all(np.isfinite(values).all() for values in (q, fingers, parts)):
            raise Fault("RBL832", f"{self._log.source} has no numbers at {time:.3f} s")
        return Stance(axes=q, fingers=fingers, parts=parts.reshape(-1, 7))

    def samples(self) -> list[Stance]:
        """Return postures from start to end."""
        return [self.at(time) for time in np.linspace(0.0, self.end, SAMPLES).tolist()]

    def _between(self, name: str, time: float) -> Array:
        """Return the values (k,) of the frames at a time: between two frames those in between.

        The arm is drawn at its tick: a part at the frame before would lag by millimetres, and stand in the fingers.
        """
        frames = self._log.count(name)
        if not frames:
            return np.empty(0)
        frame_s = float(np.diff(self._log.span("frame_t", 0, 2))[0]) if frames > 1 else 1.0
        at = min(time / frame_s, frames - 1.0)
        first = min(int(at), max(frames - 2, 0))
        rows = self._log.span(name, first, min(first + 2, frames)).astype(np.float64)
        before, after = rows[0].ravel(), rows[-1].ravel()
        if name == "parts":
            after = _same_side(before, after)
        return np.asarray(before + (at - first) * (after - before))


def _same_side(before: Array, after: Array) -> Array:
    """Return poses (7 p,) with quaternions on the side of those before: q and -q are one rotation."""
    one, other = before.reshape(-1, 7), after.reshape(-1, 7).copy()
    opposite = (one[:, 3:] * other[:, 3:]).sum(axis=1) < 0.0
    other[opposite, 3:] *= -1.0
    return other.reshape(before.shape)
