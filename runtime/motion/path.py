"""The path of a straight move: position on a line, orientation by one of two laws.

    T(s) = [ R(s) , p_start + s (p_end - p_start) ; 0 1 ],   s in [0, 1]
    axis   R(s) = Rot(k, s Theta) R_start          about the rotation principal axis: JPH06190750A Fig 6, 200 to 208
    rpy    R(s) = Rz Ry Rx of (rx, ry, rz)(s)      the three angles of a taught pose, each linear over its shorter way:
                                                   CN103429397A, S1

``axis`` turns about one fixed axis at a constant rate, whatever frame the angles are counted in; ``rpy`` depends on the
frame and may swing far where RY is near 90 deg. Both end exactly as taught.
"""

from dataclasses import dataclass

import numpy as np

from runtime.frames import Array, frozen, pose, principal_axis, rotation_about, rotation_from_rpy, rpy_from_rotation
from runtime.profile import PostureLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePath:
    """A straight move between two poses of the same frame pair; ``length`` m, ``angle`` rad about ``axis`` (3,).

    ``rpy`` (2, 3) rad holds the angles at the start and the way of each, for the posture law of that name, else None.
    """

    X_start: Array
    X_end: Array
    axis: Array
    angle: float
    length: float
    rpy: Array | None = None

    @classmethod
    def between(cls, X_start: Array, X_end: Array, posture: PostureLaw = "axis") -> "LinePath":
        """Return the straight path from one pose (4, 4) to another."""
        axis, angle = principal_axis(X_start[:3, :3], X_end[:3, :3])
        length = float(np.linalg.norm(X_end[:3, 3] - X_start[:3, 3]))
        rpy = None
        if posture == "rpy":
            start, end = rpy_from_rotation(X_start[:3, :3]), rpy_from_rotation(X_end[:3, :3])
            way = end - start
            rpy = frozen([start, way - 2.0 * np.pi * np.round(way / (2.0 * np.pi))])
            angle = max(angle, float(np.abs(rpy[1]).sum()))  # no turning rate is above this over the way
        return cls(X_start=frozen(X_start), X_end=frozen(X_end), axis=frozen(axis), angle=angle, length=length, rpy=rpy)

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) at path parameters s (N,) in [0, 1]."""
        if self.rpy is None:
            R = rotation_about(self.axis, s * self.angle) @ self.X_start[:3, :3]
        else:
            R = rotation_from_rpy(self.rpy[0] + s[:, None] * self.rpy[1])
        return pose(self.points(s), R)

    def points(self, s: Array) -> Array:
        """Return the places (N, 3) m of the tool point at path parameters s (N,)."""
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        return np.asarray(start + s[:, None] * (end - start))

    def deviation(self, points: Array) -> Array:
        """Return the distance (N,) m of points (N, 3) from the straight segment."""
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        along = np.zeros(len(points))
        if self.length > 0.0:
            along = np.clip((points - start) @ (end - start) / self.length**2, 0.0, 1.0)
        return np.asarray(np.linalg.norm(points - (start + along[:, None] * (end - start)), axis=1))
