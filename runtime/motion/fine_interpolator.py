"""Fine interpolation: a set-point at every servo tick from one every 8 ms.

Between two set-points the servo follows the quintic whose speed and acceleration at both ends are the central
differences ``v_k = (q_{k+1} - q_{k-1}) / 2h`` and ``a_k = (q_{k+1} - 2 q_k + q_{k-1}) / h^2``. It passes through
every set-point and is continuous to the acceleration. A segment needs the set-point after its end, so it is played
one cycle after its end arrived (docs/timing.md); one more segment leaves rest and one enters it. A tick plays the
value of its own start, so commands and readings of a tick belong to the same instant. Everything is linear in
the four set-points around the segment, so one constant matrix holds positions, speeds and accelerations of all
ticks (docs/decisions/0009). rad; called once a cycle by the controller, and over whole moves by the planners.
"""

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.state import Stateful


def _quintic(u: Array) -> Array:
    """Return rows that map (q0, v0, a0, q1, v1, a1), in units of the segment, to the position at u in [0, 1]."""
    # the six Hermite polynomials of degree 5: each is 1 in one of its six conditions at u = 0 and 1, and 0 in the rest
    u2, u3, u4, u5 = u**2, u**3, u**4, u**5
    return np.stack(
        [
            1 - 10 * u3 + 15 * u4 - 6 * u5,
            u - 6 * u3 + 8 * u4 - 3 * u5,
            0.5 * u2 - 1.5 * u3 + 1.5 * u4 - 0.5 * u5,
            10 * u3 - 15 * u4 + 6 * u5,
            -4 * u3 + 7 * u4 - 3 * u5,
            0.5 * u3 - u4 + 0.5 * u5,
        ],
        axis=-1,
    )


def _quintic_speed(u: Array) -> Array:
    """Return the derivatives d/du of the rows of ``_quintic``."""
    u2, u3, u4 = u**2, u**3, u**4
    return np.stack(
        [
            -30 * u2 + 60 * u3 - 30 * u4,
            1 - 18 * u2 + 32 * u3 - 15 * u4,
            u - 4.5 * u2 + 6 * u3 - 2.5 * u4,
            30 * u2 - 60 * u3 + 30 * u4,
            -12 * u2 + 28 * u3 - 15 * u4,
            1.5 * u2 - 4 * u3 + 2.5 * u4,
        ],
        axis=-1,
    )


def _quintic_acceleration(u: Array) -> Array:
    """Return the second derivatives of the rows of ``_quintic``."""
    u2, u3 = u**2, u**3
    return np.stack(
        [
            -60 * u + 180 * u2 - 120 * u3,
            -36 * u + 96 * u2 - 60 * u3,
            1 - 9 * u + 18 * u2 - 10 * u3,
            60 * u - 180 * u2 + 120 * u3,
            -24 * u + 84 * u2 - 60 * u3,
            3 * u - 12 * u2 + 10 * u3,
        ],
        axis=-1,
    )


# (q0, v0, a0, q1, v1, a1) from the set-points (q_{-1}, q_0, q_1, q_2), in units of the segment
_DIFFERENCES = np.array(
    [[0, 1, 0, 0], [-0.5, 0, 0.5, 0], [1, -2, 1, 0], [0, 0, 1, 0], [0, -0.5, 0, 0.5], [0, 1, -2, 1]], dtype=float
)


class FineInterpolator(Stateful):
    """Plays the segments between set-points tick by tick, ``ticks`` in a cycle of ``period_s``, from rest at q (n,)."""

    BUFFERS = ("_points",)
    VALUES = ("_jumped",)

    def __init__(self, ticks: int, period_s: float, q: Array) -> None:
        # u = 0 is included and u = 1 is not: a tick plays the value of its own start, the end belongs to the next cycle
        u = np.arange(ticks) / ticks
        self.ticks = ticks
        self._weights = np.concatenate(
            [
                matmul(_quintic(u), _DIFFERENCES),
                matmul(_quintic_speed(u), _DIFFERENCES) / period_s,
                matmul(_quintic_acceleration(u), _DIFFERENCES) / period_s**2,
            ]
        )
        self._points = np.tile(np.asarray(q, dtype=np.float64), (4, 1))
        self._jumped = False

    def push(self, setpoint: Array) -> Array:
        """Take the set-point (n,) of this cycle; return (3, ticks, n): positions, speeds, accelerations."""
        points = self._points
        points[:3] = points[1:]
        points[3] = setpoint
        if self._jumped:
            if (points == setpoint).all():
                motion = np.zeros((3, self.ticks, len(setpoint)))
                motion[0] = setpoint  # exactly: the weights of a segment add up to 1 only to rounding
                return motion
            self._jumped = False
        return matmul(self._weights, points).reshape(3, self.ticks, -1)

    def hold(self, q: Array) -> None:
        """Stand still at joint angles q (n,): the set-points in the pipeline are dropped."""
        self._points[:] = q
        self._jumped = False

    def jump(self, q: Array) -> None:
        """Command joint angles q (n,) at once and exactly, without speed, until another set-point comes."""
        self._points[:] = q
        self._jumped = True

    @staticmethod
    def weights(u: Array) -> Array:
        """Return (..., 4): the share of the set-points (q_-1, q_0, q_1, q_2) in the position at u in [0, 1]."""
        return np.asarray(matmul(_quintic(u), _DIFFERENCES))

    @property
    def settled(self) -> bool:
        """Whether the output stands still at the last set-point."""
        # equal to the bit: at rest the same row is pushed again, nothing is computed anew
        return bool((self._points[1:] == self._points[0]).all())

    def expand(self, setpoints: Array) -> Array:
        """Return (3, (N + 2) * ticks, n) for a whole sequence (N + 1, n) that starts and ends at rest.

        The same numbers as pushing the set-points after the first one by one and then the last one twice more: what
        the servo sees of a move, with the segments in which it leaves and enters rest. Used by the planner.
        """
        return self.continue_(np.concatenate([setpoints[:1], setpoints[:1], setpoints]))

    def after(self, setpoints: Array) -> Array:
        """Return (3, (K + 2) * ticks, n) of set-points (K, n) that follow those in the pipeline; the last is held."""
        return self.continue_(np.concatenate([self._points[1:], setpoints]))

    def peaks(self, setpoints: Array) -> tuple[Array, Array]:
        """Return the largest speed and acceleration (n,) of a whole sequence (N + 1, n), as ``expand`` has them."""
        # not by ``expand``: positions are not needed here, and this is called in every round of ``within_limits``
        padded = np.concatenate([setpoints[:1], setpoints[:1], setpoints, setpoints[-1:], setpoints[-1:]])
        windows = np.lib.stride_tricks.sliding_window_view(padded, 4, axis=0)  # (segments, n, 4)
        ticks = self.ticks
        moving = np.abs(matmul(windows, self._weights[ticks:].T))  # (segments, n, 2 ticks)
        return moving[..., :ticks].max(axis=(0, 2)), moving[..., ticks:].max(axis=(0, 2))

    def extremes(self, setpoints: Array) -> tuple[Array, Array, Array, Array]:
        """Return lowest and highest position, largest speed and acceleration, each (n,), within a continued motion.

        Measured at the ticks from the second of the set-points (N, n), N at least 4, to the last but one.
        """
        windows = np.lib.stride_tricks.sliding_window_view(setpoints, 4, axis=0)  # (segments, n, 4)
        found, ticks = matmul(windows, self._weights.T), self.ticks  # (segments, n, 3 ticks)
        q, moving = found[..., :ticks], np.abs(found[..., ticks:])
        speed, acceleration = moving[..., :ticks].max(axis=(0, 2)), moving[..., ticks:].max(axis=(0, 2))
        return q.min(axis=(0, 2)), q.max(axis=(0, 2)), speed, acceleration

    def continue_(self, setpoints: Array) -> Array:
        """Return (3, (N - 1) * ticks, n) for set-points (N, n) of which the first three are already in the pipeline.

        The last one is held until the command stands there. As ``expand``, but continuing a motion.
        """
        return self.within(np.concatenate([setpoints, setpoints[-1:], setpoints[-1:]]))

    def within(self, setpoints: Array) -> Array:
        """Return (3, (N - 3) * ticks, n) from the second of set-points (N, n) to the last but one, within a motion."""
        segments = len(setpoints) - 3
        windows = np.stack([setpoints[k : k + segments] for k in range(4)], axis=1)
        out = matmul(self._weights, windows).reshape(segments, 3, self.ticks, -1)
        return np.asarray(np.moveaxis(out, 1, 0).reshape(3, segments * self.ticks, -1))
