"""Which estimates of an arm matter most: a run is repeated with each kind of estimate halved and doubled.

The run is one joint move with physics, from the posture nearest to zero and at 0.4 of the accelerations: all joints at
once, so that inertia, gravity and coupling count. Arm and controller both get the changed value, as they would if the
estimate had come out so. What changes most of tracking error, torque share and cycle time is the weight of an
estimate, as a factor.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from robolang.analysis.analysis import Analysis
from robolang.core.source import Source
from robolang.execution.session import ProgramError, Session
from robolang.project.discovery import Typed
from robolang.project.project import builtin_cell, load_project
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.units import DEG
from runtime.robot.model.drives import Bandwidths, Limits, Motor
from runtime.robot.model.spec import AxisSpec, Body, RobotSpec

FACTORS = (0.5, 2.0)
_STROKE, _MARGIN = 40.0 * DEG, 2.0 * DEG
"""As many mm of an axis that slides."""
_SHARE = 0.4
"""Share of its accelerations with which the arm moves."""
_HAND = 0.01
"""Mass of the hand, kg: the physics engine has no bodies without any, and an estimated arm has no hand yet."""

_RESULTS = {"error_mm": ("tool error", "mm"), "torque_pct": ("peak torque", "%"), "time_s": ("cycle time", "s")}

Change = Callable[[AxisSpec, float], AxisSpec]


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """What a run comes to: largest tool error mm, largest share of a torque limit %, time s."""

    error_mm: float
    torque_pct: float
    time_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Weight:
    """How much results change with the estimates of a key: ``what`` becomes ``factor`` times itself or one over that.

    ``scale`` is the change of the estimate that does it, ``before`` and ``after`` are in the unit of ``what``; an
    ``after`` of infinity: the run ended with an alarm.
    """

    key: str
    scale: float
    what: str
    before: float
    after: float

    @property
    def text(self) -> str:
        """The change of the result in words."""
        name, unit = _RESULTS[self.what]
        after = "an alarm" if math.isinf(self.after) else f"{self.after:.3g} {unit}"
        return f"{name} {self.before:.3g} {unit} becomes {after}"

    @property
    def factor(self) -> float:
        """The change of the result, 1 or more."""
        ratio = self.after / self.before
        return max(ratio, 1.0 / ratio) if ratio > 0.0 else math.inf


def weights(spec: RobotSpec) -> list[Weight]:
    """Return the weight of each kind of value that is estimated on some axis, the largest first.

    Empty where the move cannot be made with the estimates as they are.
    """
    # an arm at its limits would end in an alarm as soon as anything is worse, and nothing could be compared
    spec = replace(spec, axes=tuple(_ACCELERATION(axis, _SHARE) for axis in spec.axes))
    base = _figures(spec)
    if base is None:
        return []
    kinds = {name.split(".", 2)[-1] for name in spec.estimated if name.startswith("axes.")}
    found = [_weight(spec, base, key, _CHANGES[key]) for key in _CHANGES if key in kinds]
    return sorted(found, key=lambda weight: -weight.factor)


def _weight(spec: RobotSpec, base: Figures, key: str, change: Change) -> Weight:
    tried = [each for scale in FACTORS for each in _weighed(spec, base, key, change, scale)]
    return max(tried, key=lambda weight: weight.factor)


def _weighed(spec: RobotSpec, base: Figures, key: str, change: Change, scale: float) -> Iterable[Weight]:
    """Yield what a change of the estimated values of a key by a factor does to each result."""
    axes = [
        change(axis, scale) if f"axes.{number}.{key}" in spec.estimated else axis
        for number, axis in enumerate(spec.axes, start=1)
    ]
    after = _figures(replace(spec, axes=tuple(axes)))
    for what in _RESULTS:
        value = math.inf if after is None else getattr(after, what)
        yield Weight(key=key, scale=scale, what=what, before=getattr(base, what), after=value)


def _figures(spec: RobotSpec) -> Figures | None:
    """Return the figures of the move; None where it ends with an alarm or cannot be made."""
    margin, stroke = spec.bound(_MARGIN), spec.bound(_STROKE)
    lower, upper = spec.lower + margin, spec.upper - margin
    start = np.clip(np.zeros(spec.n), lower, upper)
    # to the side with more room, so that a joint at the end of its range moves too
    side = np.where(upper - start >= start - lower, 1.0, -1.0)
    end = np.clip(start + side * stroke, lower, upper)
    text = f"MOVEJ JOINT({_typed(end / spec.units)})\n"
    cell = builtin_cell()
    # without shapes: links that are estimated too thick must not stop the move
    cell = replace(
        cell,
        robot=replace(spec, link_radii=(), meshes=()),
        home=frozen(start),
        hand=replace(cell.hand, mass=_HAND),
        parts=(),
        obstacles=(),
    )
    project = load_project(Typed(analysis=Analysis(source=Source("estimates/move.rbl", text))))
    try:
        result = Session(replace(project, cell=cell, diagnostics=()), log=False).run()
    except (Fault, ProgramError):
        return None
    rows = result.report["statements"]
    if not result.ok or not all(row["begun"] for row in rows):
        return None
    return Figures(
        error_mm=float(np.max([row["tool_error_mm"] for row in rows])),
        torque_pct=float(np.max([row["peak_torque_pct"] for row in rows])),
        time_s=float(result.report["sim_time_s"]),
    )


def _typed(joints: Array) -> str:
    return ", ".join(f"{joint:.6f}" for joint in joints)


# --- what a key changes ----------------------------------------------------------------------------------------------


def _motor(change: Callable[[Motor, float], Motor]) -> Change:
    return lambda axis, scale: replace(axis, motor=change(axis.motor, scale))


def _limits(change: Callable[[Limits, float], Limits]) -> Change:
    return lambda axis, scale: replace(axis, limits=change(axis.limits, scale))


def _loops(change: Callable[[Bandwidths, float], Bandwidths]) -> Change:
    return lambda axis, scale: replace(axis, bandwidths=change(axis.bandwidths, scale))


def _body(axis: AxisSpec, scale: float) -> AxisSpec:
    # a denser body of the same shape: inertia goes with mass
    body = axis.body
    return replace(axis, body=Body(mass=body.mass * scale, cog=body.cog, inertia=frozen(body.inertia * scale)))


def _torque(axis: AxisSpec, scale: float) -> AxisSpec:
    # with the current that gives it: the lower of the two would hide the other
    limits = axis.limits.replaced(torque=axis.limits.torque * scale)
    return replace(axis, limits=limits, motor=axis.motor.replaced(max_current=axis.motor.max_current * scale))


def _coulomb(motor: Motor, scale: float) -> Motor:
    forward, backward = motor.coulomb_friction
    return motor.replaced(coulomb_friction=(forward * scale, backward * scale))


_SPEED = _limits(lambda own, scale: own.replaced(speed=own.speed * scale))
# the time in which an acceleration builds up stays
_ACCELERATION = _limits(lambda own, scale: own.replaced(acceleration=own.acceleration * scale, jerk=own.jerk * scale))
_JERK = _limits(lambda own, scale: own.replaced(jerk=own.jerk * scale))
_CHANGES: Mapping[str, Change] = {
    "mass_kg": _body,
    "max_speed_deg_s": _SPEED,
    "max_speed_mm_s": _SPEED,
    "max_acceleration_deg_s2": _ACCELERATION,
    "max_acceleration_mm_s2": _ACCELERATION,
    "max_jerk_deg_s3": _JERK,
    "max_jerk_mm_s3": _JERK,
    "max_torque_nm": _torque,
    "max_force_n": _torque,
    "motor.gear_ratio": _motor(lambda own, scale: own.replaced(gear_ratio=own.gear_ratio * scale)),
    # a travel that is twice as long turns the motor half as far
    "motor.travel_mm_per_turn": _motor(lambda own, scale: own.replaced(gear_ratio=own.gear_ratio / scale)),
    "motor.rotor_inertia_kg_m2": _motor(lambda own, scale: own.replaced(rotor_inertia=own.rotor_inertia * scale)),
    "motor.viscous_friction_nm_s": _motor(
        lambda own, scale: own.replaced(viscous_friction=own.viscous_friction * scale)
    ),
    "motor.coulomb_friction_nm": _motor(_coulomb),
    "motor.encoder_counts": _motor(lambda own, scale: own.replaced(encoder_counts=int(own.encoder_counts * scale))),
    "motor.current_bandwidth_hz": _motor(
        lambda own, scale: own.replaced(current_bandwidth=own.current_bandwidth * scale)
    ),
    "servo.position_bandwidth_rad_s": _loops(lambda own, scale: own.replaced(position=own.position * scale)),
    "servo.velocity_bandwidth_rad_s": _loops(lambda own, scale: own.replaced(velocity=own.velocity * scale)),
}
"""By key of a sidecar. What is not here changes where an arm can go (ranges, radii) or straight moves only (path
limits), or is one value with another (current limit and torque constant with the torque)."""
