r"""Torque residual, collision and the mass that is really carried, from what the motors gave.

Equation of motion on the joint side, with the payload that LOAD declared in M and h:

    (M(q) + N^2 J) ddq + h(q, dq) + f(dq) + r = tau          f = N^2 B dq + |N| Tc sign(dq)

The residual r is what the model does not explain. Second differences of readings one cycle P apart are the true
acceleration weighted by a triangle, ``q(t+P) - 2 q(t) + q(t-P) = int a(s) (P - |s - t|) ds``, so the torque is averaged
with the same triangle over the same two cycles; a torque that is constant in each tick has the weights (j + 1/2) / m^2,
rising then falling, which sum to 1. No speed is differentiated and no filter has to be tuned. The idea of a residual
as an observer of unexpected torque: De Luca, Mattone, "Sensorless robot collision detection", ICRA 2005.

A payload that differs from the declared one by (dm, dh), mass and first moment in the flange frame, adds

    r = Y (dm, dh),    Y = J' R(v, a - g)

with J the Jacobian of the last joint and R the regressor of its body, columns of mass and first moment. Least squares
with a forgetting factor over the cycles in which the arm moves; row i weighs 1/sigma_i^2,

    sigma_i = torque_uncertainty tau_max + friction_uncertainty |f_i|    turning,    + |N| Tc    near rest,

because below ``TURNING`` the Coulomb friction may be anything between its two values. The errors are systematic and
do not average out, so the information is that of one mean cycle, not of their number: the quoted +- is one standard
deviation of that. Priors: the difference is of the order of the rated payload, and its centre of gravity
within ``COG`` of the declared one, which decides where the motion does not show it.

What is left of r after the best payload belongs to no payload: a contact, or a drive. Called once per cycle.
"""

import math

import numpy as np
import pinocchio as pin

from runtime.core.decompositions import inverse_of, solve
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul
from runtime.core.state import Stateful
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.load_rules import LoadMode
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData

TURNING = 0.05
"""Speed above which the sign of the friction is known, rad/s; of an axis that slides ``RobotSpec.bound`` of it."""
COG = 0.1
"""Standard deviation of the centre of gravity of what is carried but not declared, m."""
MEMORY = 12
"""Least-squares steps that the estimate remembers (one for every ``STRIDE`` residuals)."""
STRIDE = 2
FEWEST = 5
"""Least-squares steps before the estimate is believed."""


class LoadModel(ArmModel):
    """The arm with rotors and the declared payload, and the torque that a small further payload would add.

    ``rotors`` (n,) kg m2 at the joints and ``first_moments`` (n, 3) kg m are those of an identification, if any.
    """

    def __init__(self, spec: RobotSpec, rotors: Array | None = None, first_moments: Array | None = None) -> None:
        super().__init__(spec, rotors=spec_rotors(spec) if rotors is None else rotors, first_moments=first_moments)
        R, p = spec.X_last_flange[:3, :3], spec.X_last_flange[:3, 3]
        self._to_joint = np.zeros((4, 4))
        self._to_joint[0, 0], self._to_joint[1:, 0], self._to_joint[1:, 1:] = 1.0, p, R

    def regressor(self, q: Array) -> Array:
        """Return Y (n, 4), N m per kg and kg m of (m, m c), flange frame, for the motion last given to ``torque``."""
        # mass and first moment only: the other six columns are of the rotational inertia, which is not estimated
        body = pin.jointBodyRegressor(self._model, self._data, self.n)[:, :4]
        jacobian = pin.computeJointJacobian(self._model, self._data, q, self.n)
        return np.asarray(matmul(jacobian.T, body, self._to_joint))


class Observer(Stateful):
    """Residual of each cycle and the running estimate of the payload; ``model``: by default that of the robot file."""

    VALUES = (
        "_declared",
        "residual",
        "sigma",
        "unexplained",
        "steps",
        "_q",
        "_information",
        "_moment",
        "_leftover",
        "_prior",
    )
    PARTS = ("_model",)

    def __init__(
        self, spec: RobotSpec, limits: SupervisionLimits, drives: DriveData, model: LoadModel | None = None
    ) -> None:
        ticks = drives.ticks
        # by default as much as the servo compensates: the rigid plant has no friction, and its servo compensates none
        friction = limits.friction if limits.friction is not None else drives.friction
        self._model = model or LoadModel(spec)
        self._ticks, self._period_s = ticks, ticks * drives.tick_s
        ramp = (np.arange(ticks) + 0.5) / ticks**2
        self._triangle = np.concatenate([ramp, ramp[::-1]])
        coulomb = friction * np.array([axis.motor.joint_coulomb_friction for axis in spec.axes])
        self._forward, self._backward = coulomb[:, 0].copy(), coulomb[:, 1].copy()
        self._coulomb = coulomb.max(axis=1)
        self._viscous = friction * spec.per_axis("motor", "joint_viscous_friction")
        self._base = limits.torque_uncertainty * drives.torque
        self._share = limits.friction_uncertainty
        self._turning, self._smooth = spec.bound(TURNING), spec.bound(0.01)
        self._rated = spec.rated_payload
        self._declared = Payload(mass=0.0, cog=np.zeros(3))
        self.residual = np.zeros(spec.n)
        """Torque that the model does not explain (n,), N m."""
        self.sigma = self._base.copy()
        """How well the model is known at this motion (n,), N m."""
        self.unexplained = np.zeros(spec.n)
        """What is left of the residual after the best payload, at the last step of the estimate (n,), N m."""
        self._q = np.zeros(spec.n)
        self.restart()

    @property
    def rows(self) -> int:
        """Ticks of the past that ``update`` needs."""
        return 2 * self._ticks + 1

    def declare(self, payload: Payload, mode: LoadMode) -> None:
        """Take the payload of a LOAD: estimates start anew."""
        self._model.set_payload(payload, mode)
        self._declared = payload
        self.restart()

    def restart(self) -> None:
        """Forget what was carried: the hand has opened or closed, or another LOAD holds."""
        self._information, self._moment, self.steps = np.zeros((4, 4)), np.zeros(4), 0
        self._leftover = np.zeros(len(self._base))
        prior = np.zeros((4, 4))
        prior[0, 0] = 1.0 / self._rated**2
        for k in range(3):
            row = np.zeros(4)
            # m c - m c_declared: the first moment about the declared centre is what is small
            row[0], row[1 + k] = -self._declared.cog[k], 1.0
            prior += np.outer(row, row) / (COG * self._rated) ** 2
        self._prior = prior

    def update(self, tau: Array, q: Array) -> None:
        """Take torques and readings (2 ticks + 1, n) of the last two cycles; sets ``residual`` and ``sigma``."""
        m = self._ticks
        before, now, after = q[0], q[m], q[2 * m]
        speed = (after - before) / (2.0 * self._period_s)
        acceleration = (after - 2.0 * now + before) / self._period_s**2
        # smoothed over the same 0.01 rad/s as the compensation of the servo (runtime.servo.axes.SMOOTH)
        dry = np.where(speed > 0.0, self._forward, self._backward) * np.tanh(speed / self._smooth)
        friction = dry + self._viscous * speed
        # a row has the reading at the start of its tick: the torques of 2 m ticks act between the outer readings
        self.residual = matmul(self._triangle, tau[: 2 * m]) - friction - self._model.torque(now, speed, acceleration)
        resting = np.abs(speed) < self._turning
        self.sigma = self._base + np.where(resting, self._coulomb, self._share * np.abs(friction))
        self._q = now

    def learn(self) -> None:
        """Take the last residual into the estimate of the payload."""
        Y = self._model.regressor(self._q)
        weighted = Y / (self.sigma**2)[:, None]
        self.steps += 1
        # a plain mean at first, so that the first steps do not weigh more than their number
        share = 1.0 / min(self.steps, MEMORY)
        self._information += share * (matmul(weighted.T, Y) - self._information)
        self._moment += share * (matmul(weighted.T, self.residual) - self._moment)
        if self.steps >= FEWEST:
            difference = solve(self._information + self._prior, self._moment)
            self.unexplained = self.residual - matmul(Y, difference)
            self._leftover += share * (self.unexplained / self.sigma - self._leftover)

    def estimate(self) -> tuple[float, float]:
        """Return (mass really carried, its standard deviation), kg."""
        covariance = inverse_of(self._information + self._prior)
        return self._declared.mass + dot(covariance[0], self._moment), math.sqrt(float(covariance[0, 0]))

    @property
    def leftover(self) -> Array:
        """Mean of what no payload explains, in standard deviations (n,)."""
        return self._leftover
