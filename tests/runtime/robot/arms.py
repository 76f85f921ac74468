"""Arms for the tests, drawn independently of the code under test."""

import numpy as np

from runtime.core.frames import frozen, pose, rotation_about
from runtime.robot.model.spec import OpwParameters

DEG = np.pi / 180.0
X, Y, Z = np.eye(3)


class Irb2400:
    """ABB IRB 2400/10 drawn from its data sheet: a point on and the direction of each axis, at all zeros."""

    points = np.array(
        [[0, 0, 0], [0.1, 0, 0.615], [0.1, 0, 1.32], [0.358, 0, 1.455], [0.855, 0, 1.455], [0.855, 0, 1.455]],
        dtype=float,
    )
    directions = np.array([Z, Y, Y, X, Y, X])
    X_base_flange_zero = pose([0.94, 0.0, 1.455], rotation_about(Y, np.pi / 2))
    range_deg = ((-180, 180), (-100, 110), (-60, 65), (-200, 200), (-120, 120), (-400, 400))

    @classmethod
    def forward(cls, q):
        """The flange carried by one turn about each line after the other, outermost first."""
        at = cls.X_base_flange_zero
        for point, direction, angle in reversed(list(zip(cls.points, cls.directions, q, strict=True))):
            R = rotation_about(direction, angle)
            at = pose(point - R @ point, R) @ at
        return at


def opw_parameters(lengths, offsets_deg=(0,) * 6, signs=(1,) * 6) -> OpwParameters:
    names = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
    return OpwParameters(
        **dict(zip(names, lengths, strict=True)),
        offsets=frozen(np.array(offsets_deg) * DEG),
        signs=frozen(np.array(signs)),
    )
