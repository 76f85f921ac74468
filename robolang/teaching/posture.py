"""How near a posture is to the ends of the ranges and to the singular postures: for a status line and a table.

Distances from singular postures are angles for wrist and elbow, and a length for the wrist centre over axis 1. To say
which of them is nearest, each is divided by the bound below which ``check --motion`` reports it (RBL427: 2 deg, 2 deg,
20 mm by default): a posture of ``closeness`` below 1 would be reported. An arm without a closed form has no such
distances (``runtime.robot.kinematics.singularity``).
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from robolang.core.bounds import ELBOW, SHOULDER, WRIST
from runtime.core.frames import Array
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.singularity import singularities

Singular: TypeAlias = Literal["wrist", "elbow", "overhead"]

_MEASURES: tuple[tuple[Singular, str, float, float], ...] = (
    ("wrist", "deg", DEG, WRIST.default),
    ("elbow", "deg", DEG, ELBOW.default),
    ("overhead", "mm", MM, SHOULDER.default),
)
"""Name, unit, size of the unit in SI, and distance that counts as 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NearLimit:
    """The joint (0-based) that is nearest to an end of its range, which end, and how far from it, deg; negative beyond
    it."""

    joint: int
    side: Literal["lower", "upper"]
    margin: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NearSingular:
    """The singular posture that is nearest, how far it is in its ``unit`` (deg or mm), and the ``closeness``.

    ``wrist``: J5 is straight; ``elbow``: the arm is stretched or folded, which is the boundary of its reach;
    ``overhead``: the wrist centre is over axis 1.
    """

    name: Singular
    distance: float
    unit: str
    closeness: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Posture:
    """What is near joint angles; ``singular`` None for an arm whose singular postures are not known."""

    limit: NearLimit
    singular: NearSingular | None


def posture(q: Array, kinematics: Kinematics) -> Posture:
    """Return what is near joint angles q (n,) rad."""
    return postures(q[None], kinematics)[0]


def postures(q: Array, kinematics: Kinematics) -> list[Posture]:
    """Return what is near each row of joint angles (N, n) rad."""
    singular = _singular(q, kinematics)
    return [Posture(limit=limit, singular=near) for limit, near in zip(_limits(q, kinematics), singular, strict=True)]


def _limits(q: Array, kinematics: Kinematics) -> list[NearLimit]:
    below, above = q - kinematics.spec.lower, kinematics.spec.upper - q
    # NaN first: an angle that is not known has no margin that could be shown
    joints = np.argmin(np.minimum(below, above) / kinematics.units, axis=1).tolist()
    return [
        NearLimit(
            joint=joint,
            side="upper" if above[row, joint] < below[row, joint] else "lower",
            margin=float(min(below[row, joint], above[row, joint]) / kinematics.units[joint]),
        )
        for row, joint in enumerate(joints)
    ]


def _singular(q: Array, kinematics: Kinematics) -> list[NearSingular | None]:
    # without a closed form there is no angle or length that says how near a singularity is
    if kinematics.opw is None:
        return [None] * len(q)
    found = singularities(kinematics.opw, q)
    distances = [
        values / size
        for values, (_, _, size, _) in zip((found.wrist, found.elbow, found.shoulder), _MEASURES, strict=True)
    ]
    closeness = np.stack([each / most for each, (_, _, _, most) in zip(distances, _MEASURES, strict=True)])
    nearest = np.argmin(closeness, axis=0).tolist()
    return [
        NearSingular(
            name=_MEASURES[which][0],
            unit=_MEASURES[which][1],
            distance=float(distances[which][row]),
            closeness=float(closeness[which, row]),
        )
        for row, which in enumerate(nearest)
    ]
