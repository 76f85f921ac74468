"""Every value that a run needs and the file of an arm does not state, estimated from mass, reach and torque.

``Known`` is what a file gives, in SI; ``estimate`` returns the rest by the keys and in the units of a sidecar, each
value with its rule (``estimate_rules``). Gravity torques and inertias are those of the arm with its rated payload at
random postures within its ranges. Deterministic; some 10 ms, once for an import.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.units import DEG, MM
from runtime.robot.files import estimate_rules as rules
from runtime.robot.files.corrections import TOKEN_MASS
from runtime.robot.files.estimate_bodies import cylinder, link_lengths, link_radii, masses, postures, reach_of
from runtime.robot.kinematics.chain import Chain
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE, AxisKind
from runtime.robot.model.drives import Bandwidths, Limits, Motor, PathLimits
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import AxisSpec, Body, RobotSpec

_POSTURES = 300
_HOLDING = 0.4
"""Share of its torque with which the weakest axis holds the arm, where masses follow from torques."""

_SPEED_RULES = {REVOLUTE: "3 m/s at the reach, wrist 250 deg/s", PRISMATIC: "1 m/s"}

Value = float | int | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A value in the unit of its key in a sidecar, and the rule that gave it."""

    value: Value
    rule: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """What is known of an arm: frames, bodies (None: not known), ranges, speeds and torques (n,), NaN where not known.

    ``mended`` (n,): bodies that are not those of the file. ``endless`` (n,): joints without end stops. ``armature``
    kg m2, ``damping`` N m s/rad and ``friction`` N m (n,) at the joint, 0 where not known. ``payload`` kg, NaN where
    not known. An axis that slides has m for rad, and its range is known: no rule gives one.
    """

    chain: Chain
    bodies: tuple[Body | None, ...]
    mended: Sequence[bool]
    lower: Array
    upper: Array
    endless: Sequence[bool]
    speed: Array
    torque: Array
    armature: Array
    damping: Array
    friction: Array
    payload: float

    @property
    def kinds(self) -> tuple[AxisKind, ...]:
        """The kind of each axis (n,)."""
        return tuple(PRISMATIC if axis in self.chain.sliding else REVOLUTE for axis in range(len(self.bodies)))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Filled:
    """The arm with everything that the drives are estimated from; ``gravity`` and ``inertia`` (m, n) at postures."""

    reach: float
    kinds: tuple[AxisKind, ...]
    bodies: tuple[Body, ...]
    payload: float
    speed: Array
    torque: Array
    gravity: Array
    inertia: Array


def estimate(known: Known) -> dict[str, Estimate]:
    """Return what is missing by its dotted name in a sidecar, axes counted from 1."""
    # postures need ranges: a joint without any turns once
    open_ended = ~np.isfinite(known.lower + known.upper)
    turn = np.where(known.endless, 360.0, 180.0) * DEG
    known = replace(
        known,
        lower=np.where(open_ended, -turn, known.lower),
        upper=np.where(open_ended, turn, known.upper),
    )
    filled = _filled(known)
    found = dict(_whole(known, filled))
    for axis in range(len(known.bodies)):
        one = {**dict(_geometry(known, filled, axis, bool(open_ended[axis]))), **dict(_drive(known, filled, axis))}
        found |= {f"axes.{axis + 1}.{key}": value for key, value in one.items()}
    return found


def _filled(known: Known) -> _Filled:
    reach = max(rules.SMALLEST_ARM, reach_of(known.chain, known.lower, known.upper))
    bodies = _bodies(known, reach)
    payload = known.payload
    if not np.isfinite(payload):
        payload = _round(rules.rated_payload(sum(body.mass for body in bodies)), 2)
    # rounded before it is used further: the sidecar has the rounded value, and its other values follow from that one
    kinds = known.kinds
    guessed = [_round(rules.speed(axis, len(bodies), reach, kind.slides)) for axis, kind in enumerate(kinds)]
    speed = np.where(np.isfinite(known.speed), known.speed, guessed)
    gravity, inertia = _loads(known, bodies, payload)
    filled = _Filled(
        reach=reach,
        kinds=kinds,
        bodies=bodies,
        payload=payload,
        speed=speed,
        torque=known.torque,
        gravity=gravity,
        inertia=inertia,
    )
    return replace(filled, torque=_torques(filled))


def _bodies(known: Known, reach: float) -> tuple[Body, ...]:
    """Return the bodies (n,), cylinders where none is known; their mass from the torques, where these are."""
    if all(body is not None for body in known.bodies):
        return tuple(body for body in known.bodies if body is not None)
    mass = masses(link_lengths(known.chain, known.lower, known.upper), reach, known.bodies)
    bodies = _cylinders(known, reach, mass)
    if any(body is not None for body in known.bodies) or not np.isfinite(known.torque).all():
        return bodies
    gravity, _ = _loads(known, bodies, 0.0)
    share = float((gravity.max(axis=0) / known.torque).max())
    # within a factor of three of what the reach says: a torque may be a placeholder
    factor = float(np.clip(_HOLDING / max(share, 1e-9), 1.0 / 3.0, 3.0))
    return _cylinders(known, reach, mass * factor)


def _cylinders(known: Known, reach: float, mass: Array) -> tuple[Body, ...]:
    ends = [X[:3, 3] for X in (*known.chain.placements[1:], known.chain.X_last_flange)]
    rows = zip(known.bodies, ends, mass, link_radii(known.chain, reach), strict=True)
    # thicker than the capsule: a link is no solid rod, and its mass is nearer to its skin
    return tuple(
        cylinder(end, _round(float(kg)), 1.5 * float(radius)) if body is None else body
        for body, end, kg, radius in rows
    )


def _torques(filled: _Filled) -> Array:
    """Return the torque limits (n,) N m, or N: those that are known, and estimates."""
    gravity, inertia = filled.gravity.max(axis=0), filled.inertia.max(axis=0)
    n, slides = len(filled.bodies), [kind.slides for kind in filled.kinds]
    rises = [rules.rise(axis, n, float(w), slides[axis]) for axis, w in enumerate(filled.speed)]
    rows = zip(gravity, inertia, filled.speed, rises, strict=True)
    own = np.array([rules.torque(float(G), float(H), float(w), rise) for G, H, w, rise in rows])
    # motors come in a few sizes: those of an arm and those of a wrist are of one or two; N and N m do not compare
    arm = np.arange(n) < rules.arm_axes(n)
    for part, floor in ((arm, rules.ARM_FLOOR), (~arm, rules.WRIST_FLOOR)):
        turning = part & ~np.array(slides)
        own[turning] = np.maximum(own[turning], floor * own[turning].max(initial=0.0))
    rounded = [_round(float(T)) for T in own]
    return np.where(np.isfinite(filled.torque), filled.torque, rounded)


def _loads(known: Known, bodies: Sequence[Body], payload: float) -> tuple[Array, Array]:
    """Return |gravity torque| and inertia (m, n) of every axis at random postures, payload included, SI."""
    # the model of the controller, so that what is estimated here holds for what runs there
    model = ArmModel(_provisional(known, bodies))
    inertia = payload * rules.GYRATION**2 * np.eye(3)
    model.set_payload(Payload(mass=payload, cog=frozen([0.0, 0.0, rules.TOOL_LEVER]), inertia=frozen(inertia)))
    q = postures(known.lower, known.upper, _POSTURES)
    gravity = np.abs([model.gravity(each) for each in q])
    return gravity, np.array([np.diag(model.mass_matrix(each)) for each in q])


def _provisional(known: Known, bodies: Sequence[Body]) -> RobotSpec:
    """Return the arm as far as its rigid bodies go: drives and limits of it mean nothing."""
    motor = Motor(
        gear_ratio=1.0,
        rotor_inertia=0.0,
        torque_constant=1.0,
        max_current=1.0,
        viscous_friction=0.0,
        coulomb_friction=(0.0, 0.0),
        encoder_counts=4,
        current_bandwidth=1.0,
    )
    limits = [
        Limits(lower=float(low), upper=float(high), speed=1.0, acceleration=1.0, jerk=1.0, torque=1.0, kind=kind)
        for low, high, kind in zip(known.lower, known.upper, known.kinds, strict=True)
    ]
    axes = tuple(
        AxisSpec(
            name=f"J{k}",
            placement=placement,
            body=body,
            motor=motor,
            limits=own,
            bandwidths=Bandwidths(position=1.0, velocity=1.0),
        )
        for k, (placement, body, own) in enumerate(zip(known.chain.placements, bodies, limits, strict=True), start=1)
    )
    return RobotSpec(
        name="",
        title="",
        sources=(),
        rated_payload=0.0,
        axes=axes,
        X_last_flange=known.chain.X_last_flange,
        path=PathLimits(
            default_speed=1.0,
            max_speed=1.0,
            acceleration=1.0,
            jerk=1.0,
            rotation_speed=1.0,
            rotation_acceleration=1.0,
            rotation_jerk=1.0,
        ),
        opw=None,
        corrections=(),
        published=(),
        notes=(),
    )


# --- values with their rules -----------------------------------------------------------------------------------------


def _whole(known: Known, filled: _Filled) -> Iterator[tuple[str, Estimate]]:
    """Yield rated payload and path limits."""
    if not np.isfinite(known.payload):
        yield "rated_payload_kg", _value(filled.payload, f"{rules.PAYLOAD_SHARE:.0%} of the mass that moves")
    # the slowest axis of either kind: the tool may move along any direction
    arm = range(rules.arm_axes(len(filled.bodies)))
    slowest = float(np.min([_at_tip(filled, k, float(filled.speed[k])) for k in arm]))
    tip = _round(rules.TIP_SHARE * slowest / MM, 2)
    yield "path.default_speed_mm_s", _value(_round(rules.DEFAULT_SHARE * tip, 2), "0.4 of the path speed")
    yield "path.max_speed_mm_s", _value(tip, "0.7 of the slowest arm axis at the reach")
    fastest = float(np.min([_at_tip(filled, k, _acceleration(filled, k)) for k in arm]))
    acceleration = _round(rules.TIP_ACCELERATION_SHARE * fastest / MM, 2)
    yield "path.acceleration_mm_s2", _value(acceleration, "half of the slowest arm axis at the reach")
    yield "path.jerk_mm_s3", _value(rules.RISE_OF_JERK * acceleration, "full acceleration after 0.1 s")
    turning = _round(rules.TIP_SHARE * _slowest_turn(filled) / DEG, 2)
    yield "path.rotation_speed_deg_s", _value(turning, "0.7 of the slowest wrist axis")
    yield "path.rotation_acceleration_deg_s2", _value(rules.ROTATION_RISE * turning, "full speed after 0.25 s")
    jerk = rules.RISE_OF_JERK * rules.ROTATION_RISE * turning
    yield "path.rotation_jerk_deg_s3", _value(jerk, "full acceleration after 0.1 s")


def _at_tip(filled: _Filled, axis: int, rate: float) -> float:
    """Return what a speed or an acceleration of an axis (0-based) is at the reach, m/s or m/s2."""
    return rate if filled.kinds[axis].slides else rate * filled.reach


def _slowest_turn(filled: _Filled) -> float:
    """Return the speed of the slowest wrist axis, or arm axis where none is a wrist's, rad/s."""
    turning = [axis for axis, kind in enumerate(filled.kinds) if not kind.slides]
    wrist = [axis for axis in turning if axis >= rules.arm_axes(len(filled.kinds))]
    # an arm whose axes all slide never turns its tool: any speed serves
    return float(np.min(filled.speed[wrist or turning])) if turning else rules.WRIST_SPEED


def _geometry(known: Known, filled: _Filled, axis: int, open_ended: bool) -> Iterator[tuple[str, Estimate]]:
    """Yield range, body and link radius of an axis (0-based)."""
    if open_ended:
        ends = (round(float(known.lower[axis]) / DEG, 6), round(float(known.upper[axis]) / DEG, 6))
        rule = "no end stops: a turn to either side" if known.endless[axis] else "not stated: half a turn"
        yield "range_deg", Estimate(value=ends, rule=rule)
    if known.bodies[axis] is None or known.mended[axis]:
        body, own = filled.bodies[axis], known.bodies[axis] is not None
        I_body = body.inertia
        products = (I_body[0, 0], I_body[1, 1], I_body[2, 2], I_body[0, 1], I_body[0, 2], I_body[1, 2])
        own_mass = "that of the file" if body.mass > TOKEN_MASS else "next to none: one body has two joints"
        rule = own_mass if own else "its share of 50 kg (reach / m)^2.5, or of what the torques hold"
        yield "mass_kg", _value(body.mass, rule, 9)
        rule = "that of the file" if own else "half of the distance to the next joint"
        yield "cog_m", Estimate(value=_rounded(body.cog, 9), rule=rule)
        rule = "that of the file with the least change that is possible" if own else "a cylinder to the next joint"
        yield "inertia_kg_m2", Estimate(value=_rounded(products, 9), rule=rule)
    radius = float(link_radii(known.chain, filled.reach)[axis])
    yield "link_radius_mm", _value(radius / MM, "60 mm, wrist 40 mm, less below 1 m or beside a short wrist")


def _drive(known: Known, filled: _Filled, axis: int) -> Iterator[tuple[str, Estimate]]:
    """Yield limits, motor and servo of an axis (0-based)."""
    w, T, kind = float(filled.speed[axis]), float(filled.torque[axis]), filled.kinds[axis]
    if not np.isfinite(known.speed[axis]):
        yield kind.speed_key, _value(w / kind.size, _SPEED_RULES[kind])
    rate = _acceleration(filled, axis) / kind.size
    yield kind.acceleration_key, _value(rate, f"70 % of free {kind.effort}, bad posture", 2)
    if not np.isfinite(known.torque[axis]):
        yield kind.force_key, _value(T, "holds and accelerates arm and payload")
    # positive: the sign of a gear changes nothing but the sign of the motor's turns
    transmission = _round(kind.transmission(rules.gear_ratio(w)))
    N = kind.motor_ratio(transmission)
    yield f"motor.{kind.transmission_key}", _value(transmission, "motor at 315 rad/s")
    armature, damping, friction = (float(values[axis]) for values in (known.armature, known.damping, known.friction))
    yield (
        "motor.rotor_inertia_kg_m2",
        (
            _value(armature / N**2, "armature of the model over N^2")
            if armature > 0.0
            else _value(rules.rotor_inertia(T, N), "1.1e-4 kg m2 per N m of the motor")
        ),
    )
    # the current only scales what is reported as torque: any limit of the right size serves
    current = _round(rules.max_current(T, N), 2)
    yield "motor.torque_constant_nm_a", _value(T / N / current, "motor torque over current limit", 4)
    yield "motor.max_current_a", _value(current, "8 A (T / 2 N m)^0.25 of the motor")
    yield (
        "motor.viscous_friction_nm_s",
        (
            _value(damping / N**2, "damping of the model over N^2")
            if damping > 0.0
            else _value(rules.viscous_friction(T, N, w), "6 % of the torque at full speed")
        ),
    )
    coulomb = _round(friction / N if friction > 0.0 else rules.coulomb_friction(T, N))
    rule = "friction of the model over N" if friction > 0.0 else "6.5 % of the torque"
    yield "motor.coulomb_friction_nm", Estimate(value=(coulomb, coulomb), rule=rule)
    yield "motor.encoder_counts", Estimate(value=rules.ENCODER_COUNTS, rule="17 bit")
    yield "motor.current_bandwidth_hz", _value(rules.CURRENT_BANDWIDTH, "usual for servo drives")
    # the same for all axes: loops of different speed bend a straight path
    Kp = _round(rules.position_bandwidth(_lowest_resonance(filled)), 2)
    yield "servo.position_bandwidth_rad_s", _value(Kp, "a quarter of the lowest resonance")
    yield "servo.velocity_bandwidth_rad_s", _value(rules.LOOP_RATIO * Kp, "four times Kp")


def _acceleration(filled: _Filled, axis: int) -> float:
    """Return the acceleration limit of an axis (0-based), rad/s2 or m/s2, that all but the worst postures allow."""
    T, w = float(filled.torque[axis]), float(filled.speed[axis])
    N = rules.gear_ratio(w)
    rotor = rules.rotor_inertia(T, N) * N**2
    loads = zip(filled.gravity[:, axis], filled.inertia[:, axis], strict=True)
    # posture by posture: where gravity is worst the inertia is, too, so two separate extremes would be one posture
    found = [rules.acceleration(T, float(gravity), float(inertia) + rotor) for gravity, inertia in loads]
    return float(np.quantile(found, rules.BAD_POSTURE))


def _lowest_resonance(filled: _Filled) -> float:
    # not the worst: the stretched arm with its payload is rare, and it would halve the bandwidth of every posture
    inertia = np.median(filled.inertia, axis=0)
    rows = zip(filled.torque, inertia, filled.kinds, strict=True)
    found = [rules.resonance(float(T), float(own), kind.slides) for T, own, kind in rows]
    return float(np.min(found))


def _value(value: float, rule: str, digits: int = 3) -> Estimate:
    return Estimate(value=_round(value, digits), rule=rule)


def _rounded(values: Sequence[float] | Array, digits: int) -> tuple[float, ...]:
    return tuple(_round(float(value), digits) for value in values)


def _round(value: float, digits: int = 3) -> float:
    """Return a number with as many digits as an estimate deserves; 0 for rounding."""
    return float(f"{value:.{digits}g}") if abs(value) > 1e-12 else 0.0
