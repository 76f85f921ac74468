"""One straight move as steps of every channel: document 004 from S01 to S07.

    S01 ends and length of the line    S02, S03 distance after each step (``steps``)    S04 points on the line
    S05 joint values, pulses           S06 lowest frequency (``emission``)              S07 next step

The line and its joint values are the machine's ``LineCurve``: for a robot arm that is the curve that a run takes, with
its wrist changes. Speed and ramp come from the same limits as a run's, T0 = V / a; where a joint's speed or
acceleration would be passed the whole profile is slowed, as the planner of a run does; an override is a share of every
speed there too. A move that needs more than a channel's highest frequency is not slowed but refused, with the speed
that fits, so that no program runs slower than it is written. Called by the export, once a move.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

import runtime.pulses.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul
from runtime.core.rounding import beside, down
from runtime.core.units import MM
from runtime.motion.commands import MAX, MoveLinear
from runtime.motion.velocity_profile import MAX_DURATION, SpeedLimits, check_duration
from runtime.pulses.channels import Channel
from runtime.pulses.emission import Emission, Pulses, emit, least_step
from runtime.pulses.machine import LineCurve, Machine, Stand
from runtime.pulses.steps import EqualTimeSteps

MOST_PULSES = 2**53
"""A position further from zero is no exact float any more."""
_ROUNDS = 12
"""Profiles at most. The factor is exact while the same limit rules at the same place of the curve."""
_MARGIN = 1.0 + 1e-6
"""Share by which a profile is slowed beyond what was measured, so that rounding does not ask for another round."""
_FITS = 0.995
"""Share of the speed that would just fit at which a speed is proposed: steps and pulses round to whole numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MovePulses:
    """A move in pulses: ``steps`` of the line, ``planned`` and ``emitted`` of each channel, ``count`` steps in all.

    ``q`` (N + 1, M) are the joint values of the line, ``start`` (M,) the positions of the channels before, pulses.
    ``points`` (N' + 1, 3) m: the tool point after each step as emitted, ``error`` (N' + 1,) m: its distance from the
    line; ``slowed`` is the factor of time that the joints needed.
    """

    curve: LineCurve
    steps: EqualTimeSteps | None
    q: Array
    start: Pulses
    planned: Pulses
    emitted: tuple[Emission, ...]
    count: int
    points: Array
    error: Array
    slowed: float
    notes: tuple[str, ...]

    @property
    def end(self) -> Pulses:
        """Positions of the channels afterwards (M,), pulses."""
        return self.start + np.array([each.steps.sum() for each in self.emitted], dtype=np.int64)

    def highest_hz(self, step_s: float) -> list[int]:
        """Return the highest frequency of each channel, Hz."""
        return [round(int(np.abs(each.steps).max(initial=0)) / step_s) for each in self.emitted]


def plan_move(
    machine: Machine, stand: Stand, command: MoveLinear, channels: tuple[Channel, ...], start: Pulses, step_s: float
) -> MovePulses:
    """Return a move of ``machine`` from ``stand``, whose channels are at ``start`` (M,) pulses; ``Fault`` RBL4xx."""
    command, notes = _with_ramp(command)
    curve = machine.curve(stand, command)
    if curve.limits is None:
        line = _TimedLine(curve=curve, steps=None, q=stand.q[None], notes=("already there",))
        nothing = np.zeros((0, len(channels)), dtype=np.int64)
        none = Emission(steps=nothing[:, 0], raised=0, debt=0, settled=0, rule="none")
        return _measured(machine, channels, line, start, nothing, (none,) * len(channels))
    override = command.override
    limits, of_time = _timed(curve.limits.overridden(override), command.duration and command.duration / override)
    notes += of_time
    steps, q, slowed, ruling = _within_limits(machine, curve, limits, step_s, override)
    if slowed > 1.0:
        notes += (f"slowed {slowed:.2f} times to {steps.seconds:.3f} s: limits of {ruling}",)
    pulses = _counted(q, channels)
    # from where the channels really are, not from row 0: what an earlier move rounded is made good in the first step
    planned = np.diff(np.vstack([start, pulses[1:]]), axis=0)
    if (excess := _beyond_channels(planned, channels, step_s)) is not None:
        raise _frequency_fault(machine, curve, limits.slowed(slowed), channels, excess, override)
    line = _TimedLine(curve=curve, steps=steps, q=q, slowed=slowed, notes=notes)
    emitted = tuple(
        emit(np.ascontiguousarray(planned[:, k]), least_step(channel.min_hz, step_s), most_pulses(channel, step_s))
        for k, channel in enumerate(channels)
    )
    return _measured(machine, channels, line, start, planned, emitted)


def _with_ramp(command: MoveLinear) -> tuple[MoveLinear, tuple[str, ...]]:
    """Return a move with an acceleration along its line, and a note where it has none: S02 needs T0 = V / a."""
    if command.acceleration != MAX:
        return command, ()
    return replace(command, acceleration=1.0), ("ACCEL MAX is ACCEL 100: the ramps of a table need one acceleration",)


@dataclass(frozen=True, slots=True, kw_only=True)
class _TimedLine:
    """The line of a move with its steps, None where it is of no length, and the joint values (N + 1, M) of them."""

    curve: LineCurve
    steps: EqualTimeSteps | None
    q: Array
    slowed: float = 1.0
    notes: tuple[str, ...] = ()


def counted(q: Array, channels: tuple[Channel, ...]) -> Pulses:
    """Return the pulses (M,) nearest to joint values q (M,), a half upward; ``Fault`` RBL432."""
    found: Pulses = _counted(q[None], channels)[0]
    return found


def most_pulses(channel: Channel, step_s: float) -> int:
    """Return the most pulses of one step of a channel."""
    # 1e-9 for rounding: 100 kHz in 10 ms are 1000 pulses, not 999
    return math.floor(channel.max_hz * step_s + 1e-9)


def _counted(q: Array, channels: tuple[Channel, ...]) -> Pulses:
    # rounded from the joint value itself in every step, never summed up: errors do not grow along the line (S05)
    found = np.floor(q / [channel.pulse for channel in channels] + 0.5)
    if not np.abs(found).max() < MOST_PULSES:
        k = int(np.argmax(np.abs(found).max(axis=0)))
        raise Fault("RBL432", f"{channels[k].joint.name} would be {np.abs(found[:, k]).max():.4g} pulses from 0")
    return np.array(found, dtype=np.int64)


def _timed(limits: SpeedLimits, duration: float | None) -> tuple[SpeedLimits, tuple[str, ...]]:
    """Return limits with the speed that makes 1 / V + V / a the TIME, ``duration`` s, and a note where none does."""
    if duration is None:
        return limits, ()
    V, a = limits.speed, limits.acceleration
    # the smaller root of V^2 - a T V + a = 0: the larger one would be all ramp
    root = (a * duration) ** 2 - 4.0 * a
    needed = 0.5 * (a * duration - math.sqrt(root)) if root >= 0.0 else math.inf
    if needed > V:
        shortest = 1.0 / V + V / a if a >= V * V else 2.0 / math.sqrt(a)
        return limits, (f"TIME {duration:g} s is too short, the move takes {shortest:.3f} s",)
    return SpeedLimits(speed=needed, acceleration=a, jerk=limits.jerk), ()


def _steps(limits: SpeedLimits, step_s: float) -> EqualTimeSteps:
    """Return the steps over a path parameter from 0 to 1 within limits; ``Fault`` RBL404 for too long a move."""
    speed = min(limits.speed, math.sqrt(limits.acceleration))  # over a whole path of 1 no triangle is faster
    seconds = 1.0 / speed + speed / limits.acceleration
    check_duration(seconds)
    return EqualTimeSteps.of(1.0, speed, speed / limits.acceleration, step_s)


def _within_limits(
    machine: Machine, curve: LineCurve, limits: SpeedLimits, step_s: float, override: float
) -> tuple[EqualTimeSteps, Array, float, str]:
    """Return the steps, their joint values, the factor of time that the joints needed, and which of them ruled."""
    slowed, ruling = 1.0, ""
    for _ in range(_ROUNDS):
        steps = _steps(limits.slowed(slowed), step_s)
        q = curve.joints(steps.distances())
        factor, name = _excess(machine, q, step_s, override)
        if factor <= 1.0:
            return steps, q, slowed, ruling
        slowed, ruling = slowed * factor * _MARGIN, name
        if not slowed <= MAX_DURATION / step_s:
            break
    raise Fault("RBL412", f"no speed keeps the limits of {ruling} on this straight path: it passes a singularity")


def _excess(machine: Machine, q: Array, step_s: float, override: float) -> tuple[float, str]:
    """Return by which factor of time the steps are too fast for the joints (1 and less: not at all), and for which."""
    # the PLC's steps are constant speeds with jumps between them, from rest and to rest at the ends
    dq = np.diff(q, axis=0)
    ddq = np.diff(dq, axis=0, prepend=0.0, append=0.0)
    speed = np.abs(dq).max(axis=0) / step_s / [joint.speed * override for joint in machine.joints]
    acceleration = np.abs(ddq).max(axis=0) / step_s**2 / [joint.acceleration for joint in machine.joints]
    ratios = np.stack([speed, np.sqrt(acceleration)])
    kind, k = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
    return float(ratios[kind, k]), f"{machine.joints[int(k)].name} {('speed', 'acceleration')[kind]}"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Excess:
    """The step that exceeds its ``channel`` (0-based) most, with the ``ratio`` to the most pulses of a step."""

    channel: int
    row: int
    needed_hz: float
    ratio: float
    step_s: float


def _beyond_channels(planned: Pulses, channels: tuple[Channel, ...], step_s: float) -> _Excess | None:
    """Return the step that exceeds the highest frequency of its channel most, None where none does."""
    ratios = np.abs(planned) / [most_pulses(channel, step_s) for channel in channels]
    if ratios.max() <= 1.0:
        return None
    row, k = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
    needed_hz = int(abs(planned[row, k])) / step_s
    return _Excess(channel=int(k), row=int(row), needed_hz=needed_hz, ratio=float(ratios.max()), step_s=step_s)


def _frequency_fault(
    machine: Machine,
    curve: LineCurve,
    limits: SpeedLimits,
    channels: tuple[Channel, ...],
    excess: _Excess,
    override: float,
) -> Fault:
    """Return the refusal of a step beyond its channel, RBL430, with a SPEED or TIME at which none is."""
    channel = channels[excess.channel]
    share = 100.0 * float(_steps(limits, excess.step_s).distances()[excess.row])
    fits = _fitting(curve, limits, channels, excess)
    speed = fits.speed * curve.length / MM
    # a tool that only turns has no speed to lower, so a TIME is proposed
    what = f"SPEED {down(speed / override):g}" if speed > 0.0 else f"TIME {fits.seconds * override:.3f}"
    needs, gives = beside(excess.needed_hz, channel.max_hz, form=".0f")
    return Fault(
        "RBL430",
        f"{channel.joint.name} of the {machine.name} needs {needs} Hz at {share:.1f} % of the path, "
        f"its channel gives {gives} Hz at most",
        f"{what} would fit",
    )


def _fitting(curve: LineCurve, limits: SpeedLimits, channels: tuple[Channel, ...], excess: _Excess) -> EqualTimeSteps:
    """Return the steps of the move at a speed whose frequencies fit."""
    most = np.array([most_pulses(channel, excess.step_s) for channel in channels])
    speed, ratio = min(limits.speed, math.sqrt(limits.acceleration)), excess.ratio
    while True:
        speed *= _FITS / max(ratio, 1.0)
        steps = _steps(SpeedLimits(speed=speed, acceleration=limits.acceleration, jerk=limits.jerk), excess.step_s)
        planned = np.abs(np.diff(_counted(curve.joints(steps.distances()), channels), axis=0))
        ratio = float((planned / most).max())
        if ratio <= 1.0:
            return steps


def _measured(
    machine: Machine,
    channels: tuple[Channel, ...],
    line: _TimedLine,
    start: Pulses,
    planned: Pulses,
    emitted: tuple[Emission, ...],
) -> MovePulses:
    """Return a move with the path on which its pulses put the tool."""
    count = max((len(each.steps) for each in emitted), default=0)
    positions = np.zeros((count + 1, len(channels)), dtype=np.int64)
    for k, each in enumerate(emitted):
        positions[1 : len(each.steps) + 1, k] = each.steps
    positions = start + np.cumsum(positions, axis=0)
    # a channel whose steps end earlier stands still until the last one has ended
    for k, each in enumerate(emitted):
        positions[len(each.steps) :, k] = positions[len(each.steps), k]
    points = machine.points(positions * [channel.pulse for channel in channels])
    return MovePulses(
        curve=line.curve,
        steps=line.steps,
        q=line.q,
        start=start,
        planned=planned,
        emitted=emitted,
        count=count,
        points=points,
        error=off_line(points, *line.curve.ends),
        slowed=line.slowed,
        notes=line.notes,
    )


def off_line(points: Array, start: Array, end: Array) -> Array:
    """Return the distance (K,) m of points (K, 3) from the segment between two points (3,)."""
    segment = end - start
    length2 = dot(segment, segment)
    along = np.clip(matmul(points - start, segment) / length2, 0.0, 1.0) if length2 > 0.0 else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - (start + along[:, None] * segment), axis=1))
