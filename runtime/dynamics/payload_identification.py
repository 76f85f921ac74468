r"""The payload from the torques of a whole motion: mass, centre of gravity and their uncertainties.

The torque of the motors beyond that of the bare arm, over two cycles (the triangle of
``runtime.supervision.torque_observer``),

    r = tau - (M(q) + N^2 J) ddq - h(q, dq) - f(dq)  =  Y p + F s + V v + o + noise,        one row per axis that turns

is linear in p, the ten parameters of the body beyond the flange (mass, first moment, inertia about the last joint),
with Y = J' R(v, a - g) as in the observer, but all ten columns of R. The rest is nuisance, per axis: ``s`` and ``v``
are the shares by which Coulomb and viscous friction differ from the robot file, ``o`` is a torque that is always there.
Friction changes its sign with the motion and weight does not, so an exercise in both directions separates s and v from
p by itself; they are bound only loosely (``LOOSE``). An offset differs from weight only in that weight changes with
posture; it is bound by the uncertainties that the supervision has of the model,

    sigma_o = hypot(friction_uncertainty |N| Tc, torque_uncertainty tau_max).

Weighted least squares; an axis weighs 1/sigma^2, sigma the root mean square of its residuals, found in ``ROUNDS``
rounds. A row is the mean of ``BLOCK`` averages, one for each cycle: the equation holds for means as well, and the steps
of an encoder, which second differences make large, cancel in them but for the first and the last. Where an axis turns
slower than ``TURNING``, or reverses, dry friction is not determined: no such row is used.

Gear springs: readings are those of the motor, and the link lags by the twist t = (tau - f - N^2 J ddq) / Kc. For the
Manutec that is up to 1.5 mrad; without the acceleration of t its 13.5 kg came out 0.1 kg heavier. So posture, speed
and acceleration of the links are those of q - t, with differences of means of t. When an axis reverses, its dry
friction jumps and excites the springs; rows in which they still swing, or whose differences would reach there, are left
out on all axes.

Pure functions; called once, after the motion.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from runtime.core.decompositions import inverse_of
from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul
from runtime.robot.model.arm_model import spec_rotors
from runtime.robot.model.spec import RobotSpec
from runtime.supervision.torque_observer import TURNING, LoadModel

BODY = 10
"""Parameters of a rigid body: m, m c (3), inertia about the joint (6)."""
LOOSE = 0.3
"""Standard deviation of the share by which friction differs from the robot file."""
SPREAD = 0.3
"""Usual radius of gyration of a payload about the last joint, m; the prior of its inertia."""
VAGUE = 10.0
"""Standard deviation of the mass before anything is measured, in rated payloads; of the first moment, over 1 m."""
QUIETEST = 1e-4
"""Smallest noise of an axis, as a share of its torque limit: an axis without residuals would rule alone."""
ROUNDS = 4
"""Rounds of reweighting: the weights of the axes change the residuals, and these the weights."""
BLOCK = 5
"""Averages that make one row of the least squares."""
BASE = 5
"""Rows over which the twist of a gear is differentiated, and of which each value is the mean; odd."""
REACH = BASE + BASE // 2
"""Rows to either side that such a difference uses."""
DECAY_S = 0.1
"""Time in which the gear springs come to rest after an axis has reversed, s."""
FEWEST = 20
"""Rows of all axes together without which nothing is estimated."""
LIGHTEST = 3.0
"""Standard deviations of the mass below which there is no centre of gravity."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Knowledge:
    """The properties of the arm beside its model.

    ``torque`` (n,) N m: torque limits. ``friction``: share of the robot file's friction that the arm has.
    ``springs``: whether the gears yield as the robot file says. By ``friction_uncertainty``, a share of the Coulomb
    friction, and ``torque_uncertainty``, a share of the torque limit, a torque may be off all the time.
    """

    torque: Array
    friction: float = 1.0
    springs: bool = True
    friction_uncertainty: float = 0.03
    torque_uncertainty: float = 0.002


@dataclass(frozen=True, slots=True, kw_only=True)
class WeighedPayload:
    """The payload beyond the flange, with standard uncertainties.

    ``mass`` kg, ``cog`` (3,) m in the flange frame (None: the mass does not differ from zero), ``mass_sd`` kg,
    ``cog_sd`` (3,) m. ``friction`` (n,): share by which the Coulomb friction of an axis differs from the robot file.
    ``left`` (n,) N m: root mean square of the residual torque, ``peak`` (n,) its largest value; 0 for an axis that
    did not turn. ``rows`` (n,): how many torques of an axis were used.
    """

    mass: float
    mass_sd: float
    cog: Array | None
    cog_sd: Array | None
    friction: Array
    left: Array
    peak: Array
    rows: Array


class BodyModel(LoadModel):
    """The bare arm with rotors, and the torque of any rigid body that is fixed to its last link."""

    def body_regressor(self, q: Array) -> Array:
        """Return Y (n, 10) for the motion last given to ``torque``: parameters about the last joint, in its frame.

        Order of Pinocchio: m, m c, Ixx, Ixy, Iyy, Ixz, Iyz, Izz.
        """
        body = pin.jointBodyRegressor(self._model, self._data, self.n)
        jacobian = pin.computeJointJacobian(self._model, self._data, q, self.n)
        return np.asarray(matmul(jacobian.T, body))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Rows:
    """Averages over two cycles, one for each cycle: angles, speeds, accelerations, torques (N, n); which axes turn."""

    q: Array
    dq: Array
    ddq: Array
    tau: Array
    turning: NDArray[np.bool_]
    step_s: float


def identify_payload(
    spec: RobotSpec, tau: Array, q: Array, *, ticks: int, tick_s: float, known: Knowledge
) -> WeighedPayload:
    """Return the payload that explains torques tau (N, n) N m and readings q (N, n) rad, one row per servo tick.

    Row k of ``tau`` acts in the tick that begins with row k of ``q``. Half the window over which is averaged has
    ``ticks`` of ``tick_s`` s. ``ValueError`` when too little of it is motion.
    """
    # the order matters: averages, then what the bare arm needs, then blocks of rows in which an axis turned throughout
    rows = _averages(spec, tau, q, (ticks, tick_s))
    if int(rows.turning.sum()) < FEWEST:
        raise ValueError("the arm does not move enough to be weighed")
    friction, columns = _nuisances(spec, rows, known.friction)
    model = BodyModel(spec)
    residual, Y = _beyond_the_bare_arm(spec, model, rows, friction, known.springs)
    usable = np.asarray(rows.turning & ~_shaken(spec, rows, known.springs)[:, None])
    A, r, turning = _blocks(np.concatenate([Y, columns], axis=2), residual, usable)
    axis = np.nonzero(turning)[1]  # of each row that is left: its weight is that of its axis
    found, covariance, left = _weighted(A[turning], r[turning], axis, spec, known)
    return _in_flange(spec, found, covariance, _per_axis(left, axis, spec.n))


def _averages(spec: RobotSpec, tau: Array, q: Array, cycle: tuple[int, float]) -> _Rows:
    """Return the averages over 2 cycles around every cycle (ticks, seconds of one); the same weights for both sides.

    The triangle is the weight under which the mean of ddq is the second difference of q, exactly.
    """
    m, h = cycle[0], cycle[0] * cycle[1]
    at = np.arange(m, len(q) - m, m)
    before, now, after = q[at - m], q[at], q[at + m]
    ramp = (np.arange(m) + 0.5) / m**2
    triangle = np.concatenate([ramp, ramp[::-1]])
    first, second = (now - before) / h, (after - now) / h
    # an axis that changes its direction within the window is counted as not turning
    slowest = np.where(first * second > 0.0, np.minimum(np.abs(first), np.abs(second)), 0.0)
    return _Rows(
        q=now,
        dq=(after - before) / (2.0 * h),
        ddq=(after - 2.0 * now + before) / h**2,
        tau=np.array([matmul(triangle, tau[k - m : k + m]) for k in at]).reshape(now.shape),
        turning=slowest > spec.bound(TURNING),
        step_s=h,
    )


def _nuisances(spec: RobotSpec, rows: _Rows, share: float) -> tuple[Array, Array]:
    """Return the friction (N, n) of the robot file, and the columns (N, n, 3 n) of s, v and o."""
    coulomb = share * np.array([axis.motor.joint_coulomb_friction for axis in spec.axes])
    dry = np.where(rows.dq > 0.0, coulomb[:, 0], -coulomb[:, 1])
    viscous = share * spec.per_axis("motor", "joint_viscous_friction") * rows.dq
    E = np.eye(spec.n)
    return dry + viscous, np.concatenate(
        [dry[..., None] * E, viscous[..., None] * E, np.broadcast_to(E, (*dry.shape, spec.n))], axis=2
    )


def _beyond_the_bare_arm(
    spec: RobotSpec, model: BodyModel, rows: _Rows, friction: Array, springs: bool
) -> tuple[Array, Array]:
    """Return r (N, n) N m and Y (N, n, 10), at the posture of the links where the gears are springs."""
    rotors = spec_rotors(spec)
    # friction of an axis at rest is whatever holds it, so none is taken off there
    through_gear = rows.tau - np.where(rows.turning, friction, 0.0) - rotors * rows.ddq
    twist = through_gear / spec.per_axis("motor", "stiffness") if springs else np.zeros_like(through_gear)
    speed, acceleration = _differences(twist, rows.step_s)
    q, dq, ddq = rows.q - twist, rows.dq - speed, rows.ddq - acceleration
    residual, Y = np.empty_like(q), np.empty((*q.shape, BODY))
    for k in range(len(q)):
        links = model.torque(q[k], dq[k], ddq[k]) - rotors * ddq[k]
        residual[k] = rows.tau[k] - friction[k] - rotors * rows.ddq[k] - links
        Y[k] = model.body_regressor(q[k])
    return residual, Y


def _differences(x: Array, step_s: float) -> tuple[Array, Array]:
    """Return speed and acceleration of x (N, n), a mean of ``BASE`` rows each, by differences over ``BASE`` rows."""
    padded = np.pad(x, ((REACH, REACH), (0, 0)), mode="edge")
    mean = np.lib.stride_tricks.sliding_window_view(padded, BASE, axis=0).mean(axis=-1)  # (N + 2 BASE, n)
    before, now, after, h = mean[: -2 * BASE], mean[BASE:-BASE], mean[2 * BASE :], BASE * step_s
    return (after - before) / (2.0 * h), (after - 2.0 * now + before) / h**2


def _shaken(spec: RobotSpec, rows: _Rows, springs: bool) -> NDArray[np.bool_]:
    """Return the rows (N,) in which an axis with a gear spring is about to reverse or has just reversed."""
    # an axis that is not turning now may just have reversed; rows around it are shaken on all axes, since links are
    # coupled
    elastic = np.isfinite(spec.per_axis("motor", "stiffness")) & rows.turning.any(axis=0) & springs
    sticks = np.asarray((~rows.turning & elastic).any(axis=1))
    decay = max(REACH, round(DECAY_S / rows.step_s))
    return np.convolve(sticks, np.ones(REACH + 1 + decay), "full")[REACH : REACH + len(sticks)] > 0.5


def _blocks(A: Array, r: Array, turning: NDArray[np.bool_]) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return means of A (N, n, k) and r (N, n) over ``BLOCK`` rows each, and which axes turned in all of them."""
    count = len(r) // BLOCK

    def blocks(x: NDArray[Any]) -> NDArray[Any]:
        return x[: count * BLOCK].reshape(count, BLOCK, *x.shape[1:])

    return blocks(A).mean(axis=1), blocks(r).mean(axis=1), np.asarray(blocks(turning).all(axis=1))


def _weighted(
    A: Array, r: Array, axis: NDArray[np.intp], spec: RobotSpec, known: Knowledge
) -> tuple[Array, Array, Array]:
    """Return parameters (10 + 3 n,), their covariance and the residuals (rows,), after reweighting the axes."""
    # a prior on every parameter keeps the system regular: without an exercise of an axis nothing determines its own
    prior = np.diag(1.0 / _before(spec, known) ** 2)
    quietest = QUIETEST * known.torque
    sigma = known.torque_uncertainty * known.torque
    for _ in range(ROUNDS):
        weight = 1.0 / sigma[axis] ** 2
        covariance = inverse_of(matmul(A.T * weight, A) + prior)
        found = matmul(covariance, matmul(A.T, weight * r))
        left = r - matmul(A, found)
        square = np.bincount(axis, left**2, spec.n) / np.maximum(np.bincount(axis, minlength=spec.n), 1)
        sigma = np.maximum(np.sqrt(square), quietest)
    return found, np.asarray(covariance, dtype=np.float64), left


def _before(spec: RobotSpec, known: Knowledge) -> Array:
    """Return the standard deviations (10 + 3 n,) of all parameters before anything is measured."""
    rated = spec.rated_payload
    coulomb = known.friction * np.array([max(axis.motor.joint_coulomb_friction) for axis in spec.axes])
    offset = np.hypot(known.friction_uncertainty * coulomb, known.torque_uncertainty * known.torque)
    body = [np.full(4, VAGUE * rated), np.full(6, rated * SPREAD**2)]
    return np.concatenate([*body, np.full(2 * spec.n, LOOSE), offset])


def _per_axis(left: Array, axis: NDArray[np.intp], n: int) -> tuple[Array, Array, Array]:
    """Return root mean square and peak of the residuals of each axis (n,), and its number of rows."""
    rows = np.bincount(axis, minlength=n).astype(np.float64)
    peak: Array = np.zeros(n)
    np.maximum.at(peak, axis, np.abs(left))
    rms = np.sqrt(np.bincount(axis, left**2, n) / np.maximum(rows, 1))
    return np.asarray(rms, dtype=np.float64), peak, rows


def _in_flange(spec: RobotSpec, found: Array, covariance: Array, left: tuple[Array, Array, Array]) -> WeighedPayload:
    """Move mass and first moment to the flange frame, h_F = R' (h - m p), and divide: c = h_F / m."""
    R, p = spec.X_last_flange[:3, :3], spec.X_last_flange[:3, 3]
    to_flange = np.zeros((4, 4))
    to_flange[0, 0], to_flange[1:, 0], to_flange[1:, 1:] = 1.0, matmul(-R.T, p), R.T
    mass, *moment = matmul(to_flange, found[:4])
    spread = matmul(to_flange, covariance[:4, :4], to_flange.T)
    mass_sd = float(np.sqrt(spread[0, 0]))
    # c = h / m is no estimate where m may be zero; its spread by the first derivatives of the quotient
    cog = cog_sd = None
    if mass > LIGHTEST * mass_sd:
        cog = np.array(moment) / mass
        slope = np.concatenate([-cog[:, None], np.eye(3)], axis=1) / mass
        cog, cog_sd = frozen(cog), frozen(np.sqrt(np.diag(matmul(slope, spread, slope.T))))
    rms, peak, rows = left
    return WeighedPayload(
        mass=float(mass),
        mass_sd=mass_sd,
        cog=cog,
        cog_sd=cog_sd,
        friction=frozen(found[BODY : BODY + spec.n].copy()),
        left=frozen(rms),
        peak=frozen(peak),
        rows=frozen(rows),
    )
