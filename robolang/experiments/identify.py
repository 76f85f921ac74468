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
the error of the identification. D_ii depends on the axes beyond, and so does Jc when the model is wrong: with a table,
axis 1 passes one place at each posture of a grid over J2 and J3 as well, axis 2 over J3. Everything is planned and
checked before anything moves (``trial_motion``).

What the two passes have in common is the torque at no acceleration, weight and friction; over three places or more
they part, and the weight gives the first moments that the links have beyond the model (``first_moments``).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robolang.execution.rig import Rig, plant_of
from robolang.experiments.excitation import Grid, Request, Test, bench, plan, plan_table, quintic
from runtime.cell.cell import CellSpec
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import dot
from runtime.core.units import DEG
from runtime.dynamics.compensation import AxisCompensation, Compensation
from runtime.dynamics.equations import axis_inertia
from runtime.dynamics.first_moments import Weight, gravity_columns, weigh_links
from runtime.plant.hand import hand_body
from runtime.plant.plant import Plant
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.motor import torque_limit

WINDOW = 0.15
"""Half width of the weights, as a share of the duration: the axis moves forward all through them."""
HOLD_S = 0.2
"""Rest before each pass, s."""
PLACES = 3
"""Fewest places of an axis from which its weight can be separated from its friction."""
Progress = Callable[[int, int, float], None]
"""Called before each position with the axis (0-based), the position's number from 1 and the position, rad; those of a
table come last."""


class RubbingPlant(RigidPlant):
    """The ideal arm with the friction of the robot file: viscous, and Coulomb friction by direction."""

    # the speed of the tick before is part of a snapshot of the arm
    VALUES = (*RigidPlant.VALUES, "_dq_before")
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
class Passage:
    """Weighted means of one pass: torque N m, acceleration rad/s2, speed rad/s, at the joint."""

    tau: float
    alpha: float
    speed: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TableResult:
    """The result of an axis' table: ``grid`` rad of each of ``joints`` (0-based); inertias at the motor, row-major."""

    joints: tuple[int, ...]
    grid: tuple[tuple[float, ...], ...]
    identified: Array
    model: Array
    true: Array

    @property
    def compensation(self) -> JointTable:
        """Jc over the grid."""
        values = tuple((self.identified - self.model).tolist())
        return JointTable(joints=self.joints, grid=self.grid, values=values)


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisResult:
    """The result of one axis; inertias kg m2 at the motor, one per position (P,) where they are arrays.

    ``true`` is what the plant really has in that posture, rotor included: a simulation knows. ``held`` (K,) N m at the
    joint are the torques without acceleration, weight and friction, in ``postures`` (K, n) rad: those of the positions,
    then those of the table.
    """

    axis: int
    positions: Array
    alpha: Array
    speed: Array
    identified: Array
    model: float
    true: float
    postures: Array
    held: Array
    table: TableResult | None = None

    @property
    def means(self) -> tuple[float, float, float]:
        """Means over the table, without one over the positions: identified, of the model, true."""
        found = self if self.table is None else self.table
        return float(np.mean(found.identified)), float(np.mean(found.model)), float(np.mean(found.true))

    @property
    def compensation(self) -> float:
        """Mean of Jc over the table, without one over the positions."""
        identified, model, _ = self.means
        return identified - model

    @property
    def spread(self) -> float:
        """Largest minus smallest Jc over the positions."""
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
    # all of them first: what cannot be identified is refused before anything moves
    tests = [plan(request, carried, axis) for axis in request.axes]
    grids = [plan_table(request, carried, test) for test in tests]
    return [_identify_axis(request, carried, *both, progress) for both in zip(tests, grids, strict=True)]


def weight_of(request: Request, results: list[AxisResult]) -> Weight | None:
    """Return what the torques without acceleration say of weight and friction; None with too few places of any axis."""
    found = [result for result in results if len(result.held) >= PLACES]
    if not found:
        return None
    axes, postures, held = (
        np.concatenate(rows)
        for rows in zip(*((np.full(len(r.held), r.axis), r.postures, r.held) for r in found), strict=True)
    )
    return weigh_links(request.robot, _carried(request), axes, postures, held, torque_limit(request.robot))


def compensation_of(request: Request, results: list[AxisResult], date: str = "") -> Compensation:
    """Return what the file says: the mean of each axis, the rotor of the robot file where one was not identified."""
    axes = [AxisCompensation(compensation=axis.motor.rotor_inertia) for axis in request.robot.axes]
    weight = weight_of(request, results)
    for found in results:
        axes[found.axis] = AxisCompensation(
            compensation=found.compensation,
            spread=found.spread,
            model=found.means[1],
            identified=found.means[0],
            table=None if found.table is None else found.table.compensation,
        )
    if weight is not None:
        moments = weight.first_moments.tolist()
        axes = [replace(axis, first_moment=tuple(moment)) for axis, moment in zip(axes, moments, strict=True)]
    carried = _carried(request)
    return Compensation(
        robot=request.robot.name,
        date=date,
        positions=request.positions,
        axes=tuple(axes),
        payload=replace(carried, inertia=np.zeros((3, 3))),  # the file has mass and centre only
    )


# --- the experiment --------------------------------------------------------------------------------------------------


def _identify_axis(request: Request, carried: Payload, test: Test, grid: Grid | None, progress: Progress) -> AxisResult:
    found = _at_posture(request, carried, test, progress, 1)
    if grid is None:
        return found
    first = request.positions + 1
    each = [_at_posture(request, carried, one, progress, number) for number, one in enumerate(grid.tests, start=first)]
    table = TableResult(
        joints=grid.joints,
        grid=tuple(tuple(angles.tolist()) for angles in grid.angles),
        identified=np.array([one.identified[0] for one in each]),
        model=np.array([one.model for one in each]),
        true=np.array([one.true for one in each]),
    )
    postures, held = ([getattr(one, name) for one in (found, *each)] for name in ("postures", "held"))
    return replace(found, table=table, postures=np.concatenate(postures), held=np.concatenate(held))


def _at_posture(request: Request, carried: Payload, test: Test, progress: Progress, first: int) -> AxisResult:
    """Pass all places of a test; ``first`` is the number of the first of them."""
    spec, axis = request.robot, test.axis
    bench = _Bench(request, carried, test)
    found = []
    for number, position in enumerate(test.positions, start=first):
        progress(axis, number, float(position))
        found.append(tuple(bench.passage(start, float(position)) for start in test.starts(float(position))))
    J = np.array([(up.tau - down.tau) / (up.alpha - down.alpha) for up, down in found])
    # the line through both passes at alpha = 0: what they have in common
    held = [(up.tau * down.alpha - down.tau * up.alpha) / (down.alpha - up.alpha) for up, down in found]
    postures = np.tile(test.q, (len(found), 1))
    postures[:, axis] = test.positions
    squared = spec.axes[axis].motor.gear_ratio ** 2
    real = request.real or spec
    return AxisResult(
        axis=axis,
        positions=test.positions,
        alpha=np.array([0.5 * (up.alpha - down.alpha) for up, down in found]),
        speed=np.array([0.5 * (up.speed + down.speed) for up, down in found]),
        identified=J / squared,
        model=_inertia(spec, carried, test.q, axis) / squared,
        # the rotor as well: it is in what is identified at the motor
        true=_inertia(real, carried, test.q, axis) / squared + real.axes[axis].motor.rotor_inertia,
        postures=postures,
        held=np.array(held),
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
        # the model is wrong by what is to be identified: torques off it are neither a collision nor a payload
        profile = replace(profile, servo=servo, supervision=watched)
        known = replace(bench(request), home=first)
        real = replace(known, robot=request.real or spec)
        self._plant = plant_of(real, profile.tick_s, request.plant == "mujoco", RubbingPlant)
        self._controller = Rig.over(self._plant, known, profile).controller
        self._controller.load(carried)
        self._test, self._tick_s = test, profile.tick_s

    def passage(self, start: float, position: float) -> Passage:
        """Go to ``start`` and on past ``position``, rad; ``Fault`` RBL5xx when something stops the arm."""
        controller, test = self._controller, self._test
        here = float(controller.areas.ina[test.axis])
        steps = max(1, round(abs(start - here) / test.stroke * len(test.rows)))
        approach = here + (start - here) * quintic(np.arange(1, steps + 1) / steps)
        rest = np.full(round(HOLD_S / controller.profile.period_s), start)
        # unchecked: off the command that holds an elastic arm the approach may take one cycle, too fast for a plan
        self._play(np.concatenate([approach, rest]), position, checked=False)
        first = controller.recorder.tick
        # the last one twice more: the fine interpolator needs two cycles to play what it has and come to rest
        self._play(start + np.concatenate([test.rows[1:], test.rows[-1:], test.rows[-1:]]), position)
        rows = controller.recorder.recent(controller.recorder.tick - first)
        n = controller.spec.n
        half = round(WINDOW * len(test.rows) * controller.profile.ticks_per_cycle)
        return passage(rows[:, 2 * n + test.axis], rows[:, n + test.axis], position, half, self._tick_s)

    def _play(self, angles: Array, position: float, checked: bool = True) -> None:
        controller, axis = self._controller, self._test.axis
        rows = np.tile(controller.areas.ina, (len(angles), 1))
        rows[:, axis] = angles
        controller.play(rows, checked)
        for _ in rows:
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
    # the weights are symmetric, so that this is the weighted mean; without the ends, which have no second difference
    place = np.convolve(q[1:-1], w, "valid")
    at = int(np.argmax(place > position))
    if at == 0:
        raise ValueError("the pass does not reach the position from below after a whole window")
    share = (position - place[at - 1]) / (place[at] - place[at - 1])

    def mean(values: Array) -> float:
        before, after = (dot(w, values[k : k + len(w)]) for k in (at - 1, at))
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
    body = hand_body(bench(request).hand, bench(request).hand.stroke)
    return Payload(mass=body.mass, cog=body.cog, inertia=body.inertia)


def _contacts(plant: Plant) -> Iterator[tuple[str, str]]:
    """Yield the names of what touches on a plant that has contacts."""
    # the ideal arm has no contacts
    contacts: Any = getattr(plant, "contacts", None)
    for touch in contacts() if contacts is not None else ():
        yield touch.names


def as_json(request: Request, results: list[AxisResult]) -> dict[str, Any]:
    """Return the figures of an identification in plain types; inertias kg m2 at the motor, angles deg.

    Where an axis had the places for it: its friction at the speed of the test, N m at the joint, and the most that its
    weight was off the model's; of all links the first moments beyond the model, kg m.
    """
    weight = weight_of(request, results)
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
                "identified_kg_m2": found.means[0],
                "model_kg_m2": found.means[1],
                "compensation_kg_m2": found.compensation,
                "spread_kg_m2": found.spread,
                "rotor_kg_m2": request.robot.axes[found.axis].motor.rotor_inertia,
                "true_kg_m2": found.means[2],
                **({} if weight is None or len(found.held) < PLACES else _weight(request, found, weight)),
                **({} if found.table is None else {"table": _plain(found.table.compensation)}),
            }
            for found in results
        ],
        **({} if weight is None else {"first_moments_kg_m": weight.first_moments.tolist()}),
    }


def _weight(request: Request, found: AxisResult, weight: Weight) -> dict[str, float]:
    columns = np.array([gravity_columns(request.robot, q)[found.axis] for q in found.postures])
    beyond = np.einsum("kjx,jx->k", columns, weight.first_moments)
    return {"friction_nm": float(weight.friction[found.axis]), "weight_beyond_nm": float(np.abs(beyond).max())}


def _plain(table: JointTable) -> dict[str, Any]:
    return {
        "joints": [joint + 1 for joint in table.joints],
        "deg": [[round(angle / DEG, 9) for angle in angles] for angles in table.grid],
        "compensation_kg_m2": list(table.values),
    }
