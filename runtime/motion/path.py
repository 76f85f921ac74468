"""The path of a straight move: position on a line, orientation about the rotation principal axis.

    T(s) = [ Rot(k, s Theta) R_start , p_start + s (p_end - p_start) ; 0 1 ],   s in [0, 1]

Source: JPH06190750A Fig 6, steps 200 to 208.
"""

from dataclasses import dataclass

import numpy as np

from runtime.frames import Array, frozen, pose, principal_axis, rotation_about


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePath:
    """A straight move between two poses of the same frame pair; ``length`` m, ``angle`` rad about ``axis`` (3,)."""

    X_start: Array
    X_end: Array
    axis: Array
    angle: float
    length: float

    @classmethod
    def between(cls, X_start: Array, X_end: Array) -> "LinePath":
        """Return the straight path from one pose (4, 4) to another."""
        axis, angle = principal_axis(X_start[:3, :3], X_end[:3, :3])
        length = float(np.linalg.norm(X_end[:3, 3] - X_start[:3, 3]))
        return cls(X_start=frozen(X_start), X_end=frozen(X_end), axis=frozen(axis), angle=angle, length=length)

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) at path parameters s (N,) in [0, 1]."""
        R = rotation_about(self.axis, s * self.angle) @ self.X_start[:3, :3]
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        return pose(start + s[:, None] * (end - start), R)

    def deviation(self, points: Array) -> Array:
        """Return the distance (N,) m of points (N, 3) from the straight segment."""
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        along = np.zeros(len(points))
        if self.length > 0.0:
            along = np.clip((points - start) @ (end - start) / self.length**2, 0.0, 1.0)
        return np.asarray(np.linalg.norm(points - (start + along[:, None] * (end - start)), axis=1))
