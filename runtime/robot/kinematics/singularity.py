"""How near joint angles are to the singular postures of an arm with a closed form (``runtime.robot.kinematics.opw``).

With the angles of the closed form, theta = sign q + offset, k = hypot(a2, c3) and g = t3 + atan2(a2, c3):

    wrist      t5 from 0 or half a turn: J4 and J6 turn about one line
    elbow      g from 0 or half a turn: the arm is stretched or folded
    shoulder   |a1 + c2 sin t2 + k sin(t2 + g)|: how far the wrist centre is from the plane in which it meets axis 1

The range of validity is that of the closed form: six axes, a spherical wrist. Called by the findings
on motion and the table of cycle times.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from runtime.core.frames import Array
from runtime.robot.model.spec import OpwParameters


@dataclass(frozen=True, slots=True, kw_only=True)
class Singularities:
    """Distances from the singular postures, 0 or more: ``wrist`` and ``elbow`` (...,) rad, ``shoulder`` (...,) m."""

    wrist: Array
    elbow: Array
    shoulder: Array


def singularities(params: OpwParameters, q: ArrayLike) -> Singularities:
    """Return how far joint angles q (..., 6) rad are from the singular postures."""
    # the angles g and r of ``opw``, without its branches: distances need no sides
    theta = params.signs * np.asarray(q, dtype=np.float64) + params.offsets
    k = math.hypot(params.a2, params.c3)
    g = theta[..., 2] + math.atan2(params.a2, params.c3)
    r = params.a1 + params.c2 * np.sin(theta[..., 1]) + k * np.sin(theta[..., 1] + g)
    return Singularities(wrist=_from_half_turns(theta[..., 4]), elbow=_from_half_turns(g), shoulder=np.abs(r))


def _from_half_turns(angle: Array) -> Array:
    """Return the distance of angles from the nearest multiple of half a turn, rad."""
    return np.abs(angle - np.pi * np.round(angle / np.pi))
