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
K A s/(kg m2 rad), from the velocity bandwidth Kv = K Ktn in 1/s; KT = 1/Ktn. ``D' = D + N^2 J`` (spec/controller.md
1.8). With ``source = "command"`` the beta and gamma of (6), (8) and (10) are those of the command; with
``"measured"`` they are the detected ones, as printed. Step 416 always takes the detected speed.

Because I is proportional to D', the closed loop ``gamma = Kv (Kp (theta - alpha) - beta)`` is the same at every
posture and payload: ``wn = sqrt(Kv Kp)``, ``zeta = sqrt(Kv / Kp) / 2``.

Shapes: everything broadcasts over leading dimensions ``(..., n)``. The tick works in place, without allocation.
"""

from dataclasses import dataclass

import numpy as np
from numpy import add, multiply, subtract

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
    Kc: float = np.inf
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
        self._springs = gains.K2 != 0.0
        self._alpha = np.array(alpha, dtype=np.float64)
        self.beta = np.zeros(shape)
        """Detected speed of the last tick, rad/s."""
        self._beta_before = np.zeros(shape)
        self._gamma = np.zeros(shape)
        self._work = np.zeros(shape)
        self._current = np.zeros(shape)
        self._extra = np.zeros(shape)
        self._velocity_gain = np.zeros(shape)
        self._acceleration_gain = np.zeros(shape)
        self._windup = np.zeros(shape)
        self._gravity = np.zeros(shape)

    def update(self, D: Array, T: Array, D_control: Array | None = None) -> None:
        """Take new loads (step 404): D kg m2 and T N m, (..., n). Once per 8 ms, when ITA is sent.

        ``D_control`` replaces D where gains are held fixed; the spring term keeps the true D.
        """
        g = self.gains
        D_total = (D if D_control is None else D_control) + g.rotor
        self._velocity_gain[...] = g.Kv / g.Ktn * D_total
        self._acceleration_gain[...] = g.Ka / g.Ktn * D_total
        self._windup[...] = D * g.K2 / g.Kc
        self._gravity[...] = T * g.KT_scale / g.Ktn

    def current(self, theta: Array, beta_cmd: Array, gamma_cmd: Array, alpha: Array) -> Array:
        """Return the current command I_nnew (..., n) A of this tick: a live buffer, overwritten by the next.

        theta (..., n) rad commanded, beta_cmd rad/s and gamma_cmd rad/s2 its derivatives, alpha rad detected.
        """
        beta, work, current, extra = self.beta, self._work, self._current, self._extra
        subtract(alpha, self._alpha, beta)
        multiply(beta, self._per_tick, beta)
        self._alpha[...] = alpha
        if self._measured:
            gamma = self._gamma
            subtract(beta, self._beta_before, gamma)
            multiply(gamma, self._per_tick, gamma)
            self._beta_before[...] = beta
            beta_ff = beta
        else:
            gamma, beta_ff = gamma_cmd, beta_cmd
        subtract(theta, alpha, work)  # 410, with the wind-up of (6) added where there is a spring
        if self._springs:
            multiply(gamma, self._windup, extra)
            add(work, extra, work)
        multiply(work, self._Kp, work)  # (7)
        multiply(beta_ff, self.gains.Kf, extra)  # (8)
        add(work, extra, work)
        subtract(work, beta, work)  # 416
        multiply(work, self._velocity_gain, current)  # (9)
        multiply(gamma, self._acceleration_gain, extra)  # (10)
        add(current, extra, current)
        return add(current, self._gravity, current)  # (11)
