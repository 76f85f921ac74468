r"""Checks of every servo tick: following error, saturation, excursions and encoder readings.

    following error     |q_cmd - q_fb|  <=  e0 + (t_lag + (1 - Kf)/Kp) v,   v = max |dq_cmd|, decaying in 0.1 s
    saturation          |tau_cmd| <= tau_max, or not for longer than saturation_s
    excursion           |dq_fb| <= dq_max (1 + margin),  q_min - margin <= q_fb <= q_max + margin
    encoder             |dq_fb| <= 3 dq_max (else: it jumped);  a reading equal to the last one while the command turns
                        by 100 encoder steps per tick, and then one that catches up, is a lost sample (two in a
                        cycle count); 24 ms without a new reading a standing encoder

The speed that scales the following error is held and decays, because an axis follows its command late, by (1 - Kf)/Kp
where the servo has no full velocity feed-forward, and is still closing in when the command has stopped. The ticks of
a cycle are judged together at its end, from the rows that the recorder holds anyway; a finding names the first tick
that was over. Judging each tick by itself was rejected: it costs eight times as much, and no answer can begin before
the next set-point. Every comparison is written so that NaN fails it. Called once per cycle by ``Supervisor``.
"""

import numpy as np
from numpy import absolute, add, less_equal, logical_and, maximum, multiply, subtract

from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.core.state import Stateful
from runtime.robot.model.spec import RobotSpec
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData
from runtime.supervision.finding import Finding

JUMP = 3.0
"""Share of the joint's speed limit above which a reading is a jump, not a motion."""
STEPS = 100.0
"""Encoder steps per tick from which a reading that does not change is wrong."""
CATCH_UP = 1.4
"""Share of the commanded speed that the reading after a lost sample shows at least."""
STANDING_S = 0.024
"""Time with the same reading that makes an encoder stand still, s; a servo that lags gets its lag on top."""
_HOLD_S = 0.1


class Watch(Stateful):
    """Judges the ticks of one cycle. Rows are those of the recorder: (tau_cmd, tau_sat, q_fb, dq_fb), each (n,)."""

    BUFFERS = ("speed",)
    VALUES = ("_saturated", "_standing", "_lost", "_dirty")

    def __init__(self, spec: RobotSpec, limits: SupervisionLimits, drives: DriveData) -> None:
        torque, lag, ticks, tick_s = drives.torque, drives.lag, drives.ticks, drives.tick_s
        self._n, self._limits, self._ticks, self._tick_s = spec.n, limits, ticks, tick_s
        n = spec.n
        # a range is checked as a distance from its middle: all six checks are then |x| <= bound, one comparison
        self._centre = np.concatenate([np.zeros(2 * n), (spec.lower + spec.upper) / 2.0, np.zeros(n)])
        self._speed = spec.per_axis("limits", "speed")
        self._kinds = [axis.kind for axis in spec.axes]
        half = (spec.upper - spec.lower) / 2.0 + spec.bound(limits.position_margin)
        most = self._speed * (1.0 + limits.speed_margin)
        slack = 1.0 + 1e-9  # a current at its limit gives a torque that may exceed the limit by rounding
        self._fast = drives.resolution * STEPS / tick_s
        self._first_limit = spec.bound(limits.following_error)
        self._bound = np.concatenate([torque * slack, torque * slack, half, most, self._first_limit, self._fast])
        self._away = np.zeros((ticks, 6 * n))
        """Per tick: tau_cmd, tau_sat, q_fb, dq_fb, following error, and what shows a repeated reading."""
        self._inside = np.zeros((ticks, 6 * n), dtype=bool)
        self._rows, self._error = self._away[:, : 4 * n], self._away[:, 4 * n : 5 * n]
        self._repeated, self._detected = self._away[:, 5 * n :], self._away[:, 3 * n : 4 * n]
        self._signed = self._away[:, : 5 * n]
        self._command = np.zeros((ticks, n))
        self._moved = -JUMP * STEPS * self._speed / self._fast
        self._hold = float(np.exp(-ticks * tick_s / _HOLD_S))
        # a servo that lags does not move yet while its command already does
        self._longest_stand = round((STANDING_S + float(lag.max())) / tick_s)
        self._lag = limits.following_lag + lag
        self._most_saturated = limits.saturation_s / tick_s
        self.speed = np.zeros(n)
        """Held commanded speed of each axis (n,), rad/s."""
        self.peak = np.zeros(n)
        """Largest commanded speed of each axis in this cycle (n,), rad/s."""
        self.limit = self._bound[4 * n : 5 * n]
        """Following-error limit of each axis in this cycle (n,), rad."""
        self._saturated = np.zeros(n)
        self._standing = np.zeros(n)
        self._lost = np.zeros(n)
        self._dirty = False

    def cycle(self, rows: Array, q_cmd: Array, dq_cmd: Array, first_tick: int) -> Finding | None:
        """Judge rows (ticks, 4 n) against commands (ticks, n); return the first finding of the cycle, or None."""
        absolute(dq_cmd, self._command)
        maximum.reduce(self._command, out=self.peak)
        multiply(self.speed, self._hold, self.speed)
        maximum(self.speed, self.peak, out=self.speed)
        multiply(self.speed, self._lag, self.limit)
        self.limit += self._first_limit
        subtract(q_cmd, rows[:, 2 * self._n : 3 * self._n], self._error)
        subtract(rows, self._centre, self._rows)
        absolute(self._signed, self._signed)
        multiply(self._detected, self._moved, self._repeated)  # one encoder step outweighs any commanded speed
        add(self._repeated, self._command, self._repeated)
        less_equal(self._away, self._bound, self._inside)
        if logical_and.reduce(self._inside, axis=None):
            # one cycle in which everything is inside ends what was counted; nothing is written in all the others
            if self._dirty:
                self._saturated, self._standing, self._lost = np.zeros((3, self._n))
                self._dirty = False
            return None
        self._dirty = True
        return self._first(first_tick)

    def _first(self, first_tick: int) -> Finding | None:
        """Go through the ticks one by one: the earliest finding, encoder before what follows from it."""
        n = self._n
        inside = self._inside.reshape(self._ticks, 6, n)
        away = self._away.reshape(self._ticks, 6, n)
        for k in range(self._ticks):
            self._saturated = np.where(inside[k, 0], 0.0, self._saturated + 1.0)
            frozen, command = ~inside[k, 5], self._command[k]
            # a reading that stood and then catches up at once: the encoder gave the old sample again
            paused = (self._standing > 0.0) & (self._standing < self._longest_stand) & ~frozen
            lost = paused & (command > self._fast) & (away[k, 3] > CATCH_UP * command)
            self._lost += lost
            self._standing = np.where(frozen, self._standing + 1.0, 0.0)
            found = (
                self._encoder(away[k, 3])
                or self._excursion(inside[k], k)
                or self._following(inside[k, 4], k)
                or self._saturation(away[k, 0])
            )
            if found is not None:
                code, axis, message = found
                return Finding(code=code, message=message, tick=first_tick + k, axis=axis)
        return None

    def _encoder(self, speed: Array) -> tuple[str, int, str] | None:
        for bad, what in (
            (~(speed <= JUMP * self._speed), "jumped"),
            (
                self._standing >= self._longest_stand,
                f"has not changed for {self._longest_stand} ticks of motion: "
                "encoder or brake stuck, or the axis blocked",
            ),
            (self._lost >= 2.0, "repeats readings while the axis moves: samples are lost"),
        ):
            if bad.any():
                axis = int(np.argmax(bad))
                by = self._kinds[axis].text(speed[axis] * self._tick_s, ".3f")
                extra = f" by {by} in one tick" if what == "jumped" else ""
                return "RBL515", axis, f"the encoder of J{axis + 1} {what}{extra}"
        return None

    def _excursion(self, inside: Array, k: int) -> tuple[str, int, str] | None:
        for row, code, what, unit in ((3, "RBL513", "{} at", "/s"), (2, "RBL514", "is", " from mid-range")):
            if not inside[row].all():
                axis = int(np.argmin(inside[row]))
                kind = self._kinds[axis]
                away, bound = self._away[k, row * self._n + axis], self._bound[row * self._n + axis]
                at, most = beside(away / kind.size, bound / kind.size, form=".2f")
                unit = kind.unit + unit
                return code, axis, f"J{axis + 1} {what.format(kind.moves)} {at} {unit}, more than {most} {unit}"
        return None

    def _following(self, follows: Array, k: int) -> tuple[str, int, str] | None:
        if follows.all():
            return None
        axis = int(np.argmax(self._error[k] / self.limit))
        kind = self._kinds[axis]
        error, most = beside(self._error[k, axis] / kind.size, self.limit[axis] / kind.size, form=".3f")
        return (
            "RBL511",
            axis,
            (
                f"J{axis + 1} is {error} {kind.unit} from its command, "
                f"more than {most} {kind.unit} at {kind.text(self.speed[axis], '.1f')}/s"
            ),
        )

    def _saturation(self, commanded: Array) -> tuple[str, int, str] | None:
        if (self._saturated <= self._most_saturated).all():
            return None
        axis = int(np.argmax(self._saturated))
        kind = self._kinds[axis]
        last, most = beside(commanded[axis], self._bound[axis], form=".1f")
        return (
            "RBL512",
            axis,
            (
                f"the {kind.effort} command of J{axis + 1} was above {most} {kind.force}, at last {last} {kind.force}, "
                f"for {1e3 * self._limits.saturation_s:g} ms"
            ),
        )

    def lost_track(self, factor: float) -> int | None:
        """Return the axis (0-based) whose error is beyond ``factor`` times its limit in the last tick, or None."""
        bad = ~(self._error[-1] <= factor * self.limit)
        return int(np.argmax(bad)) if bad.any() else None
