"""Identification of the motor-side inertia by accelerating and braking through one place (document 003, EFORT, 3.5).

An axis passes position p twice, in the same direction and with the same speed v, once with acceleration +a, once with
-a. Gravity, Coulomb and viscous friction are the same in both passes and drop out of the difference:

    J_id = ( tau_acc - tau_brake ) / ( alpha_acc - alpha_brake )          at the joint; / N^2 at the motor end
    Jc   = J_id / N^2 - D_ii / N^2                                        D_ii of the model's links, without the rotor

Test motion: the quintic ``stroke * (10 s^3 - 15 s^4 + 6 s^5)``, whose acceleration is largest at s = 0.2113 (p of the
first pass) and least at 1 - 0.2113 (p of the second). The second pass is the first one seen in a mirror at p and
backwards in time, so speeds agree and places differ with opposite signs at equal distance in time from p.

Estimator: what a drive has, the motor current (torque Ktn i, tick k) and the encoder. With bell weights
w_k = (1 - u^2)^3 over ``WINDOW`` of the motion to each side, sum w = 1,

    tau = sum w_k Ktn i_k        alpha = sum w_k (q_{k+1} - 2 q_k + q_{k-1}) / h^2  =  sum q_k w''_k

The second form shows why no reading is differentiated: the differences fall on the weights, and a reading that is off
by a share of an encoder step counts with w'' only. Torque and acceleration are averaged alike, so neither has to be
constant. The window is centred where ``sum w_k q_k`` = p (between two ticks, linearly): then the mean places agree,
the mean speeds too by the mirror, and what gravity adds in first and second order cancels.

The whole controller runs: set-points in INA, fine interpolation, servo of all axes, plant. The other axes are held at
``posture``, where the model's D_ii is near its mean over the joint ranges: there a constant fits all postures best.
D_ii does not depend on the axis' own angle, so the compensations of all positions are one number, and their spread is
the error of the identification. Everything is planned and checked before anything moves.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from robolang.project import builtin_cell
from runtime.controller import Controller
from runtime.dynamics.compensation import AxisCompensation, Compensation
from runtime.dynamics.equations import axis_inertia
from runtime.faults import Fault
from runtime.frames import Array
from runtime.motion.fine import FineInterpolator
from runtime.plant.cell import CellSpec
from runtime.plant.hand import hand_body
from runtime.plant.plant import Plant
from runtime.plant.rigid_plant import RigidPlant
from runtime.profile import Profile
from runtime.robot.model import ArmModel, spec_rotors
from runtime.robot.payload import NO_PAYLOAD, Payload
from runtime.robot.spec import RobotSpec
from runtime.servo.motor import torque_limit
from runtime.units import DEG

STROKE = 0.5
"""Way of a test motion, rad, where the range has room for it."""
LEAST_STROKE = 0.1
"""Shorter than this an axis is not identified, rad."""
MARGIN = 2.0 * DEG
"""Distance that test motions keep from the ends of the range, rad."""
SHARE = 0.5
"""Share of the speed and acceleration limits that test motions use."""
TORQUE_SHARE = 0.75
"""Share of the torque limit that they use by the model, which may be wrong by 20 %."""
PEAK = 0.5 - np.sqrt(3.0) / 6.0
"""Share of the duration at which the quintic accelerates most."""
WINDOW = 0.15
"""Half width of the weights, as a share of the duration: the axis moves forward all through them."""
HOLD_S = 0.2
"""Rest before each pass, s."""
LIGHTEST = 0.01
"""Mass of the hand that MuJoCo is given where nothing is carried, kg; it is declared as well."""
CLEARANCE = 0.2
"""Least height of every joint and the flange over the ground in a safe posture, m."""
LONGEST = 3.0
"""A test motion that needs longer than this times its shortest for want of torque is refused."""
NEAR = 0.05
"""How near the mean inertia a posture is near enough."""

PlantName = Literal["rigid", "mujoco"]
Progress = Callable[[int, int, float], None]
"""Told of the axis (0-based), the position's number from 1 and the position, rad, before each position."""


class RubbingPlant(RigidPlant):
    """The ideal arm with the friction of the robot file: viscous, and Coulomb friction by direction."""

    REST = 0.05
    """Speed over which Coulomb friction changes its sign, rad/s: below the speed of every test."""

    def __init__(self, spec: RobotSpec, cell: CellSpec, tick_s: float) -> None:
        super().__init__(spec, cell, tick_s)
        self._coulomb = np.array([axis.motor.joint_coulomb_friction for axis in spec.axes])
        self._viscous = spec.per_axis("motor", "joint_viscous_friction")
        self._dq_before = np.zeros(spec.n)

    def step(self, tau: Array) -> bool:
        """Advance one tick under joint torques tau (n,) less the friction at the speed of the tick's middle."""
        dq = 1.5 * self.dq - 0.5 * self._dq_before
        self._dq_before = np.array(self.dq)
        forward, backward = self._coulomb.T
        coulomb = np.where(dq > 0.0, forward, backward) * np.tanh(dq / self.REST)
        return super().step(tau - coulomb - self._viscous * dq)


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What to identify: ``axes`` 0-based, each at ``positions`` places; ``payload`` is carried and declared.

    ``robot`` is the controller's model; the plant is ``real``, by default the same.
    """

    robot: RobotSpec
    axes: tuple[int, ...]
    positions: int = 5
    plant: PlantName = "mujoco"
    real: RobotSpec | None = None
    payload: Payload = field(default=NO_PAYLOAD)
    profile: Profile = field(default_factory=Profile)


@dataclass(frozen=True, slots=True, kw_only=True)
class Test:
    """The test motions of one axis: home ``q`` (n,) rad, ``positions`` (P,) rad, ``stroke`` rad, ``rows`` (K + 1,).

    ``rows`` is the way from 0 to ``stroke``, a set-point every cycle.
    """

    axis: int
    q: Array
    positions: Array
    stroke: float
    rows: Array

    def starts(self, position: float) -> tuple[float, float]:
        """Return where the accelerating and the braking pass of a position start, rad."""
        before = self.stroke * float(_quintic(np.array(PEAK)))
        return position - before, position - (self.stroke - before)


@dataclass(frozen=True, slots=True, kw_only=True)
class Passage:
    """Weighted means of one pass: torque N m, acceleration rad/s2, speed rad/s, at the joint."""

    tau: float
    alpha: float
    speed: float


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisResult:
    """What came of one axis; inertias kg m2 at the motor, one per position (P,) where they are arrays.

    ``true`` is what the plant really has in that posture, rotor included: a simulation knows.
    """

    axis: int
    positions: Array
    alpha: Array
    speed: Array
    identified: Array
    model: float
    true: float

    @property
    def compensation(self) -> float:
        """Mean of Jc over the positions."""
        return float(self.identified.mean()) - self.model

    @property
    def spread(self) -> float:
        """Largest minus smallest Jc."""
        return float(np.ptp(self.identified))


def with_errors(spec: RobotSpec, seed: int, low: float = 0.05, high: float = 0.2, mixed: bool = False) -> RobotSpec:
    """Return the robot as it really is where its model leaves out ``low`` to ``high`` of every body.

    Mass and inertia of each body are larger by independent random shares: cables, covers, reducers and screws are what
    CAD data lack. ``mixed`` makes each error larger or smaller at random. Centres of gravity stay, and an inertia about
    one that is scaled as a whole stays a body's.
    """
    rng = np.random.default_rng(seed)
    axes = []
    for axis in spec.axes:
        shares = rng.uniform(low, high, 2) * (rng.choice([-1.0, 1.0], 2) if mixed else 1.0)
        mass, inertia = axis.body.mass * (1.0 + shares[0]), axis.body.inertia * (1.0 + shares[1])
        axes.append(replace(axis, body=replace(axis.body, mass=float(mass), inertia=inertia)))
    return replace(spec, axes=tuple(axes))


def identify(request: Request, progress: Progress = lambda axis, number, q: None) -> list[AxisResult]:
    """Identify the axes one after the other; ``Fault`` RBL420 before anything moves, RBL5xx where a motion failed."""
    carried = _carried(request)
    tests = [plan(request, carried, axis) for axis in request.axes]
    return [_identify_axis(request, carried, test, progress) for test in tests]


def compensation_of(request: Request, results: list[AxisResult], date: str = "") -> Compensation:
    """Return what the file says: the mean of each axis, the rotor of the robot file where one was not identified."""
    axes = [AxisCompensation(compensation=axis.motor.rotor_inertia) for axis in request.robot.axes]
    for found in results:
        axes[found.axis] = AxisCompensation(
            compensation=found.compensation, spread=found.spread, model=found.model,
            identified=float(found.identified.mean()),
        )  # fmt: skip
    carried = _carried(request)
    return Compensation(robot=request.robot.name, date=date, positions=request.positions, axes=tuple(axes),
                        payload=replace(carried, inertia=np.zeros((3, 3))))  # fmt: skip


# --- planning --------------------------------------------------------------------------------------------------------


def plan(request: Request, payload: Payload, axis: int) -> Test:
    """Return the test motions of an axis; ``Fault`` RBL420 when they would leave a limit of the robot."""
    spec, profile = request.robot, request.profile
    if not 0 <= axis < spec.n:
        raise Fault("RBL420", f"{spec.name} has the axes 1 to {spec.n}, no J{axis + 1}")
    model = ArmModel(spec)
    model.set_payload(payload)
    limits = spec.axes[axis].limits
    q, room = posture(spec, model, axis)
    low, high = max(limits.lower + MARGIN, room[0]), min(limits.upper - MARGIN, room[1])
    before = float(_quintic(np.array(PEAK)))
    stroke = min(STROKE, (high - low) / 2.0)
    if stroke < LEAST_STROKE:
        raise Fault("RBL420", f"J{axis + 1} has {max(0.0, high - low) / DEG:.1f} deg that are over the ground and "
                    f"{MARGIN / DEG:g} deg off the ends of its range, {limits.lower / DEG:.1f} to "
                    f"{limits.upper / DEG:.1f} deg; the test motions need {2.0 * LEAST_STROKE / DEG:.1f}")  # fmt: skip
    reach = stroke * (1.0 - before)
    positions = np.linspace(low + reach, high - reach, request.positions) if request.positions > 1 else np.array(
        [0.5 * (low + high)])  # fmt: skip
    shortest = max(np.sqrt(_PEAK_ACCELERATION * stroke / (SHARE * limits.acceleration)),
                   _PEAK_SPEED * stroke / (SHARE * limits.speed))  # fmt: skip
    for slower in np.geomspace(1.0, LONGEST, 8):
        cycles = int(np.ceil(slower * shortest / profile.period_s))
        test = Test(axis=axis, q=q, positions=positions, stroke=stroke,
                    rows=stroke * _quintic(np.arange(cycles + 1) / cycles))  # fmt: skip
        refusal = _refusal(spec, profile, model, test)
        if not refusal:
            return test
    raise Fault("RBL420", refusal)


def _refusal(spec: RobotSpec, profile: Profile, model: ArmModel, test: Test) -> str:
    """Return which limit a test motion would leave, where and by what; empty: none."""
    torque = TORQUE_SHARE * torque_limit(spec)
    lower, upper = spec.lower, spec.upper
    rotor, friction = spec_rotors(spec), _friction(spec)
    for position in test.positions:
        for start in test.starts(float(position)):
            rows = np.tile(test.q, (len(test.rows), 1))
            rows[:, test.axis] = start + test.rows
            q, dq, ddq = FineInterpolator(profile.ticks_per_cycle, profile.period_s, rows[0]).expand(rows)
            tau = np.array([model.torque(*motion) for motion in zip(q, dq, ddq, strict=True)])
            tau += rotor * ddq + friction * np.sign(dq) + spec.per_axis("motor", "joint_viscous_friction") * dq
            for what, unit, values, least, most in (
                ("angle", "deg", q, lower, upper),
                ("speed", "deg/s", dq, *_both(spec.per_axis("limits", "speed"))),
                ("acceleration", "deg/s2", ddq, *_both(spec.per_axis("limits", "acceleration"))),
                ("torque", "N m", tau, *_both(torque)),
            ):
                beyond = np.maximum(least - values, values - most).max(axis=0)
                axis = int(np.argmax(beyond))
                if not beyond[axis] <= 1e-9:
                    worst = values[np.argmax(np.abs(values[:, axis])), axis]
                    scale = 1.0 if unit == "N m" else DEG
                    return (f"J{test.axis + 1} at {position / DEG:.1f} deg: the test motion takes the {what} of "
                            f"J{axis + 1} to {worst / scale:.1f} {unit}, beyond {least[axis] / scale:.1f} to "
                            f"{most[axis] / scale:.1f}")  # fmt: skip
    return ""


def _both(limit: Array) -> tuple[Array, Array]:
    return -limit, limit


def _friction(spec: RobotSpec) -> Array:
    return np.array([max(axis.motor.joint_coulomb_friction) for axis in spec.axes])


def posture(spec: RobotSpec, model: ArmModel, axis: int) -> tuple[Array, tuple[float, float]]:
    """Return q (n,) rad at which the other axes are held, and the range of the axis that is over the ground, rad.

    The posture is one near the middle of the ranges with the model's D_ii near its mean over the ranges, preferably
    such that the axis can go through its whole range.
    """
    rng = np.random.default_rng(560)
    middle, width = 0.5 * (spec.lower + spec.upper), spec.upper - spec.lower
    mean = np.mean([axis_inertia(model, q, axis) for q in rng.uniform(spec.lower, spec.upper, (200, spec.n))])
    offsets = rng.uniform(-1.0 / 3.0, 1.0 / 3.0, (300, spec.n))
    offsets[:, : axis + 1] = 0.0  # D_ii does not depend on these
    offsets = np.concatenate([np.zeros((1, spec.n)), offsets[np.argsort((offsets**2).sum(axis=1), kind="stable")]])
    best, room, least = middle, (float(middle[axis]), float(middle[axis])), np.inf
    for q in middle + offsets * width:
        low, high = _room(spec, q, axis)
        away = abs(axis_inertia(model, q, axis) / mean - 1.0) + 0.5 * (1.0 - (high - low) / width[axis])
        if away < least:
            best, room, least = q, (low, high), away
        if least <= NEAR:
            break
    return np.asarray(best), room


def _room(spec: RobotSpec, q: Array, axis: int) -> tuple[float, float]:
    """Return the angles around the middle of an axis' range, rad, where joints and flange keep ``CLEARANCE``."""
    X, points = np.eye(4), []
    for index, joint in enumerate(spec.axes):
        X = X @ joint.placement
        if index == axis:
            up, X = X[2], np.eye(4)  # from here on in the frame of the axis, before it turns
        elif index > axis:
            points.append(X[:, 3])
        if index != axis:
            c, s = np.cos(q[index]), np.sin(q[index])
            X = X @ np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    x, y, z, _ = np.array([*points, (X @ spec.X_last_flange)[:, 3]]).T
    own = np.linspace(spec.lower[axis], spec.upper[axis], 2 * _SCAN + 1)[:, None]
    c, s = np.cos(own), np.sin(own)
    height = up[0] * (c * x - s * y) + up[1] * (s * x + c * y) + up[2] * z + up[3]
    low_places = np.flatnonzero(height.min(axis=1) < CLEARANCE)
    before, after = low_places[low_places <= _SCAN], low_places[low_places >= _SCAN]
    first = int(before.max()) + 1 if len(before) else 0
    last = int(after.min()) - 1 if len(after) else 2 * _SCAN
    return (float(own[first, 0]), float(own[last, 0])) if first <= last else (float(own[_SCAN, 0]),) * 2


def _quintic(s: Array) -> Array:
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s * s))


_SCAN = 90
_PEAK_SPEED = 1.875
_PEAK_ACCELERATION = 10.0 / np.sqrt(3.0)


# --- the experiment --------------------------------------------------------------------------------------------------


def _identify_axis(request: Request, carried: Payload, test: Test, progress: Progress) -> AxisResult:
    spec, axis = request.robot, test.axis
    bench = _Bench(request, carried, test)
    found = []
    for number, position in enumerate(test.positions, start=1):
        progress(axis, number, float(position))
        found.append(tuple(bench.passage(start, float(position)) for start in test.starts(float(position))))
    J = np.array([(up.tau - down.tau) / (up.alpha - down.alpha) for up, down in found])
    squared = spec.axes[axis].motor.gear_ratio ** 2
    real = request.real or spec
    return AxisResult(
        axis=axis,
        positions=test.positions,
        alpha=np.array([0.5 * (up.alpha - down.alpha) for up, down in found]),
        speed=np.array([0.5 * (up.speed + down.speed) for up, down in found]),
        identified=J / squared,
        model=_inertia(spec, carried, test.q, axis) / squared,
        true=_inertia(real, carried, test.q, axis) / squared + real.axes[axis].motor.rotor_inertia,
    )


def _inertia(spec: RobotSpec, payload: Payload, q: Array, axis: int) -> float:
    model = ArmModel(spec)
    model.set_payload(payload)
    return axis_inertia(model, q, axis)


class _Bench:
    """One axis on its plant: brought to a start, then past a position, with the current and the encoder read."""

    def __init__(self, request: Request, carried: Payload, test: Test) -> None:
        spec, profile = request.robot, request.profile
        first = np.array(test.q)
        first[test.axis] = test.starts(float(test.positions[0]))[0]
        servo, watched = profile.servo, replace(profile.supervision, collision=np.inf, payload_mismatch="off")
        if request.plant == "rigid":  # no gear springs there
            servo = replace(servo, spring_compensation=0.0, gravity_lead=0.0)
        # a model that is wrong is what is looked for here: no collision and no payload can be told from it
        profile = replace(profile, servo=servo, supervision=watched)
        cell = replace(_cell(request), robot=request.real or spec, home=first)
        self._plant = _plant(request.plant, cell, profile.tick_s)
        self._controller = Controller(spec, self._plant, profile, np.eye(4))
        self._controller.load(carried)
        self._test, self._tick_s = test, profile.tick_s

    def passage(self, start: float, position: float) -> Passage:
        """Go to ``start`` and on past ``position``, rad; ``Fault`` RBL5xx when something stops the arm."""
        controller, test = self._controller, self._test
        here = float(controller.areas.ina[test.axis])
        steps = max(1, round(abs(start - here) / test.stroke * len(test.rows)))
        self._play(here + (start - here) * _quintic(np.arange(1, steps + 1) / steps), position)
        self._play(np.full(round(HOLD_S / controller.profile.period_s), start), position)
        first = controller.recorder.tick
        self._play(start + np.concatenate([test.rows[1:], test.rows[-1:], test.rows[-1:]]), position)
        rows = controller.recorder.recent(controller.recorder.tick - first)
        n = controller.spec.n
        half = round(WINDOW * len(test.rows) * controller.profile.ticks_per_cycle)
        return passage(rows[:, 2 * n + test.axis], rows[:, n + test.axis], position, half, self._tick_s)

    def _play(self, way: Array, position: float) -> None:
        controller, axis = self._controller, self._test.axis
        for q in way:
            row = np.array(controller.areas.ina)
            row[axis] = q
            controller.areas.ina = row
            controller.cycle()
            where = f"J{axis + 1} at {position / DEG:.1f} deg"
            for touch in _contacts(self._plant):  # before the alarms: it may be the cause
                raise Fault("RBL516", f"{where}: {touch[0]} touches {touch[1]}")
            if controller.alarms:
                raise Fault(controller.alarms[0].code, f"{where}: {controller.alarms[0].message}")


def passage(q: Array, tau: Array, position: float, half: int, tick_s: float) -> Passage:
    """Return the weighted means of a forward pass with ``half`` ticks to each side of ``position`` rad.

    q (T,) rad are detected angles, tau (T,) N m torques Ktn i of the same ticks; see the module for the estimator.
    """
    u = np.arange(-half, half + 1) / (half + 1.0)
    w = (1.0 - u * u) ** 3
    w /= w.sum()
    place = np.convolve(q[1:-1], w, "valid")
    at = int(np.argmax(place > position))
    if at == 0:
        raise ValueError("the pass does not go by the position from below with a whole window before it")
    share = (position - place[at - 1]) / (place[at] - place[at - 1])

    def mean(values: Array) -> float:
        before, after = (float(w @ values[k : k + len(w)]) for k in (at - 1, at))
        return before + float(share) * (after - before)

    return Passage(
        tau=mean(tau[1:-1]),
        alpha=mean((q[2:] - 2.0 * q[1:-1] + q[:-2]) / tick_s**2),
        speed=mean((q[2:] - q[:-2]) / (2.0 * tick_s)),
    )


def _carried(request: Request) -> Payload:
    """Return what the arm carries: the payload, on MuJoCo as the hand of that mass really is."""
    if request.plant == "rigid":
        return request.payload
    body = hand_body(_cell(request).hand, _cell(request).hand.stroke)
    return Payload(mass=body.mass, cog=body.cog, inertia=body.inertia)


def _cell(request: Request) -> CellSpec:
    """Return an empty cell whose hand has the mass and the centre of the payload."""
    cell, payload = builtin_cell(), request.payload
    mass = max(payload.mass, LIGHTEST if request.plant == "mujoco" else 0.0)
    hand = replace(cell.hand, mass=mass, cog=payload.cog, X_flange_tool=np.eye(4))
    return replace(cell, robot=request.robot, hand=hand, parts=(), obstacles=())


def _plant(name: PlantName, cell: CellSpec, tick_s: float) -> Plant:
    if name == "mujoco":
        from runtime.plant.mujoco_plant import MujocoPlant

        return MujocoPlant(cell.robot, cell, tick_s)
    return RubbingPlant(cell.robot, cell, tick_s)


def _contacts(plant: Plant) -> Iterator[tuple[str, str]]:
    """Yield the names of what touches on a plant that has contacts."""
    contacts: Any = getattr(plant, "contacts", None)
    for touch in contacts() if contacts is not None else ():
        yield touch.names


def as_json(request: Request, results: list[AxisResult]) -> dict[str, Any]:
    """Return the figures of an identification in plain types; inertias kg m2 at the motor, angles deg."""
    return {
        "robot": request.robot.name,
        "plant": request.plant,
        "model_errors": request.real is not None,
        "payload_kg": request.payload.mass,
        "axes": [
            {
                "axis": found.axis + 1,
                "positions_deg": (found.positions / DEG).tolist(),
                "acceleration_rad_s2": float(found.alpha.mean()),
                "speed_rad_s": float(found.speed.mean()),
                "identified_by_position_kg_m2": found.identified.tolist(),
                "identified_kg_m2": float(found.identified.mean()),
                "model_kg_m2": found.model,
                "compensation_kg_m2": found.compensation,
                "spread_kg_m2": found.spread,
                "rotor_kg_m2": request.robot.axes[found.axis].motor.rotor_inertia,
                "true_kg_m2": found.true,
            }
            for found in results
        ],
    }
