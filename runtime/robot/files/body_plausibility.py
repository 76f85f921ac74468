"""Lengths, bodies and torques of a robot file that are possible and unlikely; see ``plausibility``.

    RBL628   a reach above ``LONGEST`` or below ``SHORTEST``; a centre of gravity further off than the whole arm
    RBL629   bodies heavier than ``HEAVIEST`` times the cube of the reach, denser than ``DENSEST``, or with a radius of
             gyration above the reach; a torque above ``STRONGEST`` times the arm's own weight

Reach is the sum of the distances from joint to joint and to the flange; an axis that slides adds its travel.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import norm
from runtime.core.tomlfile import FileFault
from runtime.core.units import GRAVITY, MM
from runtime.robot.files.plausibility import Place
from runtime.robot.kinematics.chain import Placed
from runtime.robot.model.drives import Limits
from runtime.robot.model.spec import Body

LONGEST, SHORTEST = 8.0, 0.02
"""Reach of an arm, m: the longest built reach about 5 m."""
HEAVIEST = 1000.0
"""Mass of an arm over the cube of its reach, kg/m3; built arms have 5 to 250."""
SMALLEST = 0.5
"""Reach below which the mass is judged as at this one, m."""
DENSEST = 20_000.0
"""Density of tungsten and gold, kg/m3."""
STRONGEST = 50.0
"""Torque of an axis over weight times reach of the arm; built arms have up to 2."""


def doubt_bodies(
    labels: Sequence[str], bodies: Sequence[Body | None], offsets: Array, travels: Array, place: Place
) -> list[FileFault]:
    """Return the doubts about lengths (RBL628) and bodies (RBL629).

    ``bodies`` in their axis frames, None for one that is corrected; ``offsets`` (n + 1, 3) m from each joint to the
    next, from the base first and to the flange last; ``travels`` (n,) m.
    """
    lengths = np.linalg.norm(offsets, axis=1)
    # a corrected body (None) or one without mass is left out: neither says anything about the units of the file
    size = float(np.maximum(lengths.sum() + travels.sum(), SMALLEST))
    known = {axis: body for axis, body in enumerate(bodies) if body is not None and body.mass > 0.0}
    return [
        *_doubt_reach(lengths[1:], float(travels.sum()), place),
        *_doubt_each(labels, known, size, place),
        *_doubt_mass(known, size, place),
    ]


def _doubt_reach(lengths: Array, travel: float, place: Place) -> Iterator[FileFault]:
    """Yield the doubt about a reach, the sum of ``lengths`` (n,) m from the first joint on, and ``travel`` m."""
    reach = float(lengths.sum())
    # a rail may be longer than any arm: travel keeps a reach from being too short, and makes none too long
    if not reach <= LONGEST or not reach + travel >= SHORTEST:
        looks = "its joints are all in one place" if reach < SHORTEST else "it looks like mm"
        message = f"the arm is {reach / MM:.4g} mm from its first joint to the flange: {looks}"
        yield place("length", int(np.argmax(lengths)))("RBL628", message, "lengths are in m")


def _doubt_each(labels: Sequence[str], bodies: Mapping[int, Body], size: float, place: Place) -> Iterator[FileFault]:
    """Yield one doubt a rule, at the first of the axes (0-based) whose body breaks it."""
    for code, unlikely, tail, hint in _BODY_RULES:
        axes = [axis for axis, body in bodies.items() if unlikely(body, size)]
        if axes:
            listed = ", ".join(f"{labels[axis]} {_figures(bodies[axis], code)}" for axis in axes)
            yield place("body", axes[0])(code, f"{tail}: {listed}", hint)


def _doubt_mass(bodies: Mapping[int, Body], size: float, place: Place) -> Iterator[FileFault]:
    """Yield the doubt about the mass of a whole arm of ``size`` m, at its heaviest axis."""
    mass = sum(body.mass for body in bodies.values())
    if not mass <= HEAVIEST * size**3:
        message = f"masses look like grams: {mass:g} kg in all, and the arm is {size / MM:.4g} mm long"
        yield place("body", max(bodies, key=lambda axis: bodies[axis].mass))("RBL629", message, _KG)


def doubt_torques(labels: Sequence[str], torques: Sequence[float], weight: float, place: Place) -> list[FileFault]:
    """Return the doubts about torques, N m, NaN where none is known (RBL629); ``weight`` N m: ``weight_moment``."""
    # against the weight and not against a fixed number: a torque of 1000 N m is right for a large arm; NaN is no doubt
    strong = [axis for axis, torque in enumerate(torques) if torque > STRONGEST * weight > 0.0]
    if not strong:
        return []
    listed = ", ".join(f"{labels[axis]} {torques[axis]:g} N m" for axis in strong)
    message = f"torques look like N mm: {listed}; to hold the whole arm takes less than {weight:.3g} N m"
    return [place("torque", strong[0])("RBL629", message, "torques are in N m")]


def offsets(placements: Sequence[Array], X_last_flange: Array) -> Array:
    """Return the offset of each joint from the one before (n + 1, 3) m, from the base first and to the flange last."""
    return np.array([X[:3, 3] for X in (*placements, X_last_flange)])


def travels(axes: Sequence[Placed], lower: Array, upper: Array) -> Array:
    """Return how far each axis slides to one side (n,) m; 0 of one that turns, or of which that is not known."""
    furthest = np.nan_to_num(np.maximum(np.abs(lower), np.abs(upper)))
    return np.where([axis.kind.slides for axis in axes], furthest, 0.0)


def turning_torques(limits: Sequence[Limits]) -> list[float]:
    """Return the torques, N m, NaN of an axis that slides: a force says nothing about N mm."""
    return [math.nan if own.kind.slides else own.torque for own in limits]


def weight_moment(bodies: Sequence[Body], offsets: Array, travels: Array) -> float:
    """Return the largest moment that the weight of an arm could have about one of its joints, N m.

    All of its mass at the end of the stretched arm: too large by far, which is what a bound for units may be.
    """
    length = float(np.linalg.norm(offsets, axis=1).sum() + travels.sum())
    return float(sum(body.mass for body in bodies)) * GRAVITY * length


def _far(body: Body, size: float) -> bool:
    """Return whether the centre of gravity of a body is further from its joint than the arm of ``size`` m is long."""
    return not norm(body.cog) <= size


def _spread(body: Body, size: float) -> bool:
    """Return whether the largest radius of gyration of a body exceeds the size of the arm, m."""
    return not math.sqrt(float(np.maximum(0.0, np.linalg.eigvalsh(body.inertia)[2])) / body.mass) <= size


def _dense(body: Body, size: float) -> bool:
    """Return whether a body is smaller than a ball of ``DENSEST``: a ball has the least inertia of all its mass."""
    # compared by the trace, which does not depend on the axes: three times 2/5 m r^2 for a ball
    radius = (0.75 * body.mass / (math.pi * DENSEST)) ** (1.0 / 3.0)
    return not float(np.trace(body.inertia)) >= 3.0 * 0.4 * body.mass * radius**2


_KG = "masses are in kg, inertias in kg m2"
_BODY_RULES = (
    ("RBL628", _far, "centres of gravity are further off than the arm is long", "positions are in m"),
    ("RBL629", _spread, "inertias are too large for the mass and look like kg mm2 or g mm2", _KG),
    ("RBL629", _dense, "inertias are too small for the mass, as of a body denser than gold", _KG),
)


def _figures(body: Body, code: str) -> str:
    """Return the figures of a body that a rule of this code judges."""
    if code == "RBL628":
        return f"{norm(body.cog) / MM:.4g} mm"
    return f"{body.mass:g} kg with {float(np.linalg.eigvalsh(body.inertia)[2]):.3g} kg m2"
