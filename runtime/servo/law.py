r"""The servo law of Fig 8, eqs (6) to (11), for all axes at once.

    402  beta = d alpha/dt,  gamma = d beta/dt                  from differences of the detected angle
    (6)  theta_new = theta + gamma D K2 / Kc                    spring wind-up
    410  dtheta    = theta_new - alpha
    (7)  omega     = Kp dtheta
    (8)  omega_new = omega + beta Kf                            velocity feed-forward
    416  domega    = omega_new - beta
    (9)  I         = K D' domega                                first correction: gain follows inertia
    (10) I_new     = I + gamma Ka D' / Ktn                      acceleration feed-forward
    (11) I_nnew    = I_new + T KT                               second correction: gravity

Units (joint side): theta, alpha rad; omega, beta rad/s; gamma rad/s2; D, D' kg m2; Kc N m/rad; Kp 1/s; Ktn N m/A;
K A s/(kg m2 rad), from the velocity bandwidth Kv = K Ktn in 1/s; KT = 1/Ktn. ``D' = D + N^2 J`` (docs/servo.md).
With ``source = "command"`` the beta and gamma of (6), (8) and (10) are those of the command; with ``"measured"`` they
are the detected ones, as printed. Step 416 always takes the detected speed.

Because I is proportional to D', the closed loop ``gamma = Kv (Kp (theta - alpha) - beta)`` is the same at every
posture and payload: ``wn = sqrt(Kv Kp)``, ``zeta = sqrt(Kv / Kp) / 2``.

Everything in the law that does not depend on the detected angle is known when a cycle begins, for all of its ticks.
``command`` therefore gathers it once per cycle into ``omega_ff = Kp theta_new + Kf beta`` and ``I_ff = gamma Ka D' /
Ktn + T KT``, and the tick evaluates ``I = K D' (omega_ff - Kp alpha - beta) + I_ff``: the same sums in another order.

The off-diagonal variant takes the row of the mass matrix, rotor on its diagonal, for D' and D in (6), (9) and (10):

    (9)  I_i = sum_k D'_ik Kv_k domega_k / Ktn_i

which is K sum_k D'_ik domega_k where all axes have one Kv. With exact rows the accelerations of the axes are then
``gamma_k = Kv_k domega_k``: a motion of one axis no longer pushes the others (docs/servo.md).

Shapes: everything broadcasts over leading dimensions ``(..., n)``. The tick works in place, without allocation.
"""

from dataclasses import dataclass

import numpy as np
from numpy import add, copyto, multiply, subtract

from runtime.frames import Array
from runtime.profile import FeedforwardSource


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """Constants of the law, each (n,) or a scalar that broadcasts; see the module for names and units."""

    Kp: Array
    Kv: Array
    Ktn: Array
    rotor: Array
    Kf: float = 1.0
    Ka: float = 1.0
    K2: float = 0.0
    Kc: Array | float = np.inf
    KT_scale: float = 1.0
    source: FeedforwardSource = "command"


class ServoLaw:
    """Eqs (6) to (11) with their difference estimators; one instance for all axes of a robot (or of many)."""

    def __init__(self, gains: Gains, alpha: Array, tick_s: float) -> None:
        self.gains = gains
        shape = np.shape(alpha)
        self._Kp = np.broadcast_to(gains.Kp, shape).copy()
        self._per_tick = 1.0 / tick_s
        self._measured = gains.source == "measured"
        self.beta = np.zeros(shape)
        """Detected speed of the last tick, rad/s."""
        self._alpha = np.array(alpha, dtype=np.float64)
        self._beta_before = np.zeros(shape)
        self._gamma = np.zeros(shape)
        self._work = np.zeros(shape)
        self._extra = np.zeros(shape)
        self._velocity_gain = np.zeros(shape)
        self._acceleration_gain = np.zeros(shape)
        self._windup = np.zeros(shape)
        self._gravity = np.zeros(shape)
        self._rows: Array | None = None
        self._coupled = self._velocity_rows = self._windup_rows = np.zeros(0)
        self._plan: list[tuple[Array, Array]] = []

    def update(self, D: Array, T: Array, D_control: Array | None = None, rows: Array | None = None) -> None:
        """Take new loads (step 404): D kg m2 and T N m, (..., n). Once per cycle, when ITA is sent.

        ``D_control`` replaces D where gains are held fixed; the spring term keeps the true D. ``rows`` (..., n, n)
        is the mass matrix of the off-diagonal variant, without rotors; its diagonal is D.
        """
        g = self.gains
        D_total = (D if D_control is None else D_control) + g.rotor
        self._velocity_gain[...] = g.Kv / g.Ktn * D_total
        self._acceleration_gain[...] = g.Ka / g.Ktn * D_total
        self._windup[...] = D * (g.K2 / g.Kc)
        self._gravity[...] = T * g.KT_scale / g.Ktn
        if rows is not None:
            self._rows = rows
            self._coupled = (rows + _diagonal(np.broadcast_to(g.rotor, D.shape))) / _column(g.Ktn, D)
            self._velocity_rows = self._coupled * np.broadcast_to(g.Kv, D.shape)[..., None, :]
            self._windup_rows = rows * _column(g.K2 / g.Kc, D)

    def command(self, theta: Array, beta: Array, gamma: Array, current: Array | float = 0.0) -> None:
        """Take the commanded motion of the ticks to come, after ``update``; each (ticks, ..., n).

        theta rad, beta rad/s, gamma rad/s2, ``current`` A added to every command (friction).
        """
        omega_ff = self._Kp * theta
        current_ff = self._gravity + np.asarray(current) + np.zeros_like(theta)
        if not self._measured:
            omega_ff += self._Kp * self._wound_up(gamma) + self.gains.Kf * beta
            current_ff += self._accelerating(gamma)
        self._plan = list(zip(omega_ff, current_ff, strict=True))

    def current(self, k: int, alpha: Array) -> Array:
        """Return the current command I_nnew (..., n) A of tick k: a live buffer, overwritten by the next.

        alpha (..., n) rad is the detected angle.
        """
        omega_ff, current_ff = self._plan[k]
        beta, work = self.beta, self._work
        subtract(alpha, self._alpha, beta)
        multiply(beta, self._per_tick, beta)
        copyto(self._alpha, alpha)
        multiply(alpha, self._Kp, work)
        subtract(omega_ff, work, work)
        subtract(work, beta, work)
        if self._measured:
            return self._current_measured(current_ff)
        if self._rows is not None:
            copyto(work, np.matmul(self._velocity_rows, work[..., None])[..., 0])
        else:
            multiply(work, self._velocity_gain, work)
        return add(work, current_ff, work)

    def _wound_up(self, gamma: Array) -> Array:
        """Return D gamma K2 / Kc of (6), rad."""
        if self._rows is None:
            return self._windup * gamma
        return np.asarray(np.matmul(self._windup_rows, gamma[..., None])[..., 0])

    def _accelerating(self, gamma: Array) -> Array:
        """Return gamma Ka D' / Ktn of (10), A."""
        if self._rows is None:
            return self._acceleration_gain * gamma
        return np.asarray(self.gains.Ka * np.matmul(self._coupled, gamma[..., None])[..., 0])

    def _current_measured(self, current_ff: Array) -> Array:
        """Finish the tick with the detected derivatives in (6), (8) and (10), as the document prints them."""
        beta, gamma, work, extra = self.beta, self._gamma, self._work, self._extra
        subtract(beta, self._beta_before, gamma)
        multiply(gamma, self._per_tick, gamma)
        copyto(self._beta_before, beta)
        multiply(beta, self.gains.Kf, extra)
        add(work, extra, work)
        if self._rows is not None:
            work += self._Kp * self._wound_up(gamma)
            copyto(work, np.matmul(self._velocity_rows, work[..., None])[..., 0])
            work += self._accelerating(gamma)
            return add(work, current_ff, work)
        multiply(gamma, self._windup, extra)
        multiply(extra, self._Kp, extra)
        add(work, extra, work)
        multiply(work, self._velocity_gain, work)
        multiply(gamma, self._acceleration_gain, extra)
        add(work, extra, work)
        return add(work, current_ff, work)


def _diagonal(values: Array) -> Array:
    """Return matrices (..., n, n) with ``values`` (..., n) on their diagonals."""
    return np.asarray(values[..., None] * np.eye(values.shape[-1]))


def _column(values: Array | float, like: Array) -> Array:
    """Return ``values`` as columns (..., n, 1) of matrices that belong to ``like`` (..., n)."""
    return np.asarray(np.broadcast_to(values, like.shape)[..., None])
