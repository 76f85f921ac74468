r"""The servo law of Fig 8, eqs (6) to (11), for all axes at once.

    402  beta = d alpha/dt,  gamma = d beta/dt                  from differences of the detected angle
    (6)  theta_new = theta + gamma D K2 / Kc + T KG / Kc        spring wind-up; the last term is ours
    410  dtheta    = theta_new - alpha
    (7)  omega     = Kp dtheta
    (8)  omega_new = omega + beta Kf                            velocity feed-forward
    416  domega    = omega_new - beta
    (9)  I         = K D' domega                                first correction: gain follows inertia
    (10) I_new     = I + gamma Ka D' / Ktn                      acceleration feed-forward
    (11) I_nnew    = I_new + T KT                               second correction: gravity

Units (joint side): theta, alpha rad; omega, beta rad/s; gamma rad/s2; D, D' kg m2; Kc N m/rad; Kp 1/s; Ktn N m/A;
K A s/(kg m2 rad), from the velocity bandwidth Kv = K Ktn in 1/s; KT = 1/Ktn. ``D' = D + N^2 J`` (docs/servo.md).
KG, the gravity lead, is not in the document, whose (6) knows of acceleration only: the weight winds the spring up as
well (docs/decisions/0017). T jumps when a LOAD reaches the servo, so its lead follows with ``LEAD_S``.
With ``source = "command"`` the beta and gamma of (6), (8) and (10) are those of the command; with ``"measured"`` they
are the detected ones, as printed. Step 416 always takes the detected speed.

Because I is proportional to D', the closed loop ``gamma = Kv (Kp (theta - alpha) - beta)`` is the same at every
posture and payload: ``wn = sqrt(Kv Kp)``, ``zeta = sqrt(Kv / Kp) / 2``.

Everything in the law that does not depend on the detected angle is known when a cycle begins, for all of its ticks.
``command`` therefore gathers it once per cycle into ``omega_ff = Kp theta_new + Kf beta`` and ``I_ff = gamma Ka D' /
Ktn + T KT``, and the tick evaluates ``I = K D' (omega_ff - Kp alpha - beta) + I_ff``: the same sums in another order.

The off-diagonal variant, which is the default, takes the row of the mass matrix, rotor on its diagonal, for D' and D
in (6), (9) and (10):

    (9)  I_i = sum_k D'_ik Kv_k domega_k / Ktn_i

which is K sum_k D'_ik domega_k where all axes have one Kv. With exact rows the accelerations of the axes are then
``gamma_k = Kv_k domega_k``: a motion of one axis no longer pushes the others (docs/servo.md).

Shapes: everything broadcasts over leading dimensions ``(..., n)``. The tick works in place, without allocation.
"""

from dataclasses import dataclass

import numpy as np
from numpy import add, copyto, multiply, subtract

from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.state import Stateful
from runtime.settings.profile import FeedforwardSource

LEAD_S = 0.02
"""Time constant with which the lead for the weight follows T, s."""


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
    KG: float = 0.0
    Kc: Array | float = np.inf
    KT_scale: float = 1.0
    source: FeedforwardSource = "command"


class ServoLaw(Stateful):
    """Eqs (6) to (11) with their difference estimators; one instance for all axes of a robot (or of many).

    Its state is that between two cycles: what ``update`` and ``command`` set for the ticks to come is no part of it.
    """

    BUFFERS = ("beta", "_alpha", "_beta_before")
    VALUES = ("_lead",)

    def __init__(self, gains: Gains, alpha: Array, tick_s: float) -> None:
        self.gains = gains
        shape = np.shape(alpha)
        self._Kp = np.broadcast_to(gains.Kp, shape).copy()
        self._per_tick = 1.0 / tick_s
        self._tick_s = tick_s
        self._measured = gains.source == "measured"
        self.beta = np.zeros(shape)
        """Detected speed of the last tick, rad/s."""
        self._alpha = np.array(alpha, dtype=np.float64)
        self._beta_before = np.zeros(shape)
        self._gamma = np.zeros(shape)
        self._work = np.zeros(shape)
        self._extra = np.zeros(shape)
        self._terms = np.zeros((*shape, shape[-1]))
        self._velocity_gain = np.zeros(shape)
        self._acceleration_gain = np.zeros(shape)
        self._windup = np.zeros(shape)
        self._gravity = np.zeros(shape)
        # on rigid gears Kc is infinite and both terms of (6) are 0: they are left out of every cycle
        self._sags = bool(np.any(gains.KG / np.broadcast_to(gains.Kc, shape) > 0.0))
        self._sag = np.zeros(shape)
        self._lead: Array | None = None
        self.reference = np.zeros((1, *shape))
        """Where (6) leads the motors (ticks, ..., n) in the ticks to come, rad, but for detected accelerations."""
        self._winds = bool(np.any(gains.K2 / np.broadcast_to(gains.Kc, shape) > 0.0))
        self._rotor_rows = _diagonal(np.broadcast_to(gains.rotor, shape))
        self._Ktn_column = _column(gains.Ktn, self._work)
        self._Kv_row = np.broadcast_to(gains.Kv, shape)[..., None, :]
        self._windup_column = _column(gains.K2 / gains.Kc, self._work)
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
        self._sag[...] = self.sag(T)
        # the first T is that of power-up, and the command already shows its lead: nothing to follow
        if self._lead is None:
            self._lead = self._sag.copy()
        if rows is not None:
            # the row is constant in a cycle: a tick is left with one product and one sum
            self._rows = rows
            self._coupled = (rows + self._rotor_rows) / self._Ktn_column
            self._velocity_rows = self._coupled * self._Kv_row
            if self._winds:
                self._windup_rows = rows * self._windup_column

    def command(self, theta: Array, beta: Array, gamma: Array, current: Array | float = 0.0) -> None:
        """Take the commanded motion of the ticks to come, after ``update``; each (ticks, ..., n).

        theta rad, beta rad/s, gamma rad/s2, ``current`` A added to every command (friction).
        """
        if self._sags:
            theta = theta + self._leads(len(theta))
        # accelerations that are measured are known in the tick only (``_current_measured``)
        if self._winds and not self._measured:
            theta = theta + self._wound_up(gamma)
        self.reference = theta
        omega_ff = self._Kp * theta
        # zeros: one row for each tick, where gravity and friction give one for the cycle
        current_ff = self._gravity + np.asarray(current) + np.zeros_like(theta)
        if not self._measured:
            omega_ff += self.gains.Kf * beta
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
        copyto(self._alpha, alpha)  # a copy: the encoders write the next reading into the same array
        multiply(alpha, self._Kp, work)
        subtract(omega_ff, work, work)
        subtract(work, beta, work)
        if self._measured:
            return self._current_measured(current_ff)
        if self._rows is not None:
            work = self._through_rows(work)
        else:
            multiply(work, self._velocity_gain, work)
        return add(work, current_ff, work)

    def sag(self, T: Array) -> Array:
        """Return T KG / Kc (..., n) rad: by how much the motors lead links that weigh T N m at rest."""
        return np.asarray(T * (self.gains.KG / self.gains.Kc))

    def _leads(self, ticks: int) -> Array:
        """Return the lead for the weight at each tick of a cycle (ticks, ..., n), and follow T by one cycle."""
        assert self._lead is not None  # update comes before command
        step = (self._sag - self._lead) * -np.expm1(-ticks * self._tick_s / LEAD_S)
        share = (np.arange(ticks) / ticks).reshape((ticks,) + (1,) * step.ndim)
        leads = self._lead + share * step
        self._lead += step
        return np.asarray(leads)

    def _through_rows(self, domega: Array) -> Array:
        """Return sum_k D'_ik Kv_k domega_k / Ktn_i of (9) for the coupled axes, in place of the second buffer."""
        # not np.matmul: OpenBLAS adds in an order that depends on the processor (docs/decisions/0033)
        multiply(self._velocity_rows, domega[..., None, :], self._terms)
        return add.reduce(self._terms, axis=-1, out=self._extra)

    def _wound_up(self, gamma: Array) -> Array:
        """Return D gamma K2 / Kc of (6), rad."""
        if self._rows is None:
            return self._windup * gamma
        return np.asarray(matmul(self._windup_rows, gamma[..., None])[..., 0])

    def _accelerating(self, gamma: Array) -> Array:
        """Return gamma Ka D' / Ktn of (10), A."""
        if self._rows is None:
            return self._acceleration_gain * gamma
        return np.asarray(self.gains.Ka * matmul(self._coupled, gamma[..., None])[..., 0])

    def _current_measured(self, current_ff: Array) -> Array:
        """Finish the tick with the detected derivatives in (6), (8) and (10), as the document prints them."""
        beta, gamma, work, extra = self.beta, self._gamma, self._work, self._extra
        subtract(beta, self._beta_before, gamma)
        multiply(gamma, self._per_tick, gamma)
        copyto(self._beta_before, beta)
        multiply(beta, self.gains.Kf, extra)
        add(work, extra, work)
        if self._rows is not None:
            if self._winds:
                work += self._Kp * self._wound_up(gamma)
            work = self._through_rows(work)
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
