"""One straight move as steps of every channel: document 004 from S01 to S07.

    S01 ends and length of the line    S02, S03 distance after each step (``steps``)    S04 points on the line
    S05 joint values, pulses           S06 lowest frequency (``emission``)              S07 next step

The line and its joint values are the machine's ``Way``: for a robot arm that is the curve that a run takes, wrist and
all. Speed and ramp come from the same limits as a run's, T0 = V / a; where a joint's speed or acceleration would be
passed the whole profile is slowed, as the planner of a run does; an override is a share of every speed there too. A
channel's highest frequency is not slowed for: it is refused with the speed that fits, so that nobody finds a program
slower than he wrote it.
"""

import math
from dataclasses import dataclass

import numpy as np

import runtime.pulses.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul
from runtime.core.rounding import beside, down
from runtime.core.units import MM
from runtime.motion.commands import MoveLinear
from runtime.motion.velocity_profile import MAX_DURATION, SpeedLimits, check_duration
from runtime.pulses.channels import Channel
from runtime.pulses.emission import Emission, Pulses, emit, least_step
from runtime.pulses.machine import Machine, Stand, Way
from runtime.pulses.steps import EqualTimeSteps

MOST_PULSES = 2**53
_ROUNDS = 12
_MARGIN = 1.0 + 1e-6
_FITS = 0.995
"""By how much a speed that is proposed stays under what would just fit, for the rounding of steps and pulses."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MovePulses:
    """A move in pulses: ``steps`` of the line, ``wanted`` and ``emitted`` of each channel, ``count`` steps in all.

    ``q`` (N + 1, M) are the joint values of the line, ``start`` (M,) pulses where the channels stand before. ``points``
    (N' + 1, 3) m is where what is emitted puts the tool after each step, ``error`` (N' + 1,) m how far off the line.
    """

    way: Way
    steps: EqualTimeSteps | None
    q: Array
    start: Pulses
    wanted: Pulses
    emitted: tuple[Emission, ...]
    count: int
    points: Array
    error: Array
    slowed: float
    notes: tuple[str, ...]

    @property
    def end(self) -> Pulses:
        """Where the channels stand afterwards (M,)."""
        return self.start + np.array([each.steps.sum() for each in self.emitted], dtype=np.int64)

    def highest_hz(self, step_s: float) -> list[int]:
        """Return the highest frequency of each channel, Hz."""
        return [round(int(np.abs(each.steps).max(initial=0)) / step_s) for each in self.emitted]


def plan_move(
    machine: Machine, stand: Stand, command: MoveLinear, channels: tuple[Channel, ...], start: Pulses, step_s: float
) -> MovePulses:
    """Return a move of ``machine`` from ``stand``, whose channels are at ``start`` (M,) pulses; ``Fault`` RBL4xx."""
    way = machine.way(stand, command)
    if way.limits is None:
        nothing = np.zeros((0, len(channels)), dtype=np.int64)
        none = Emission(steps=nothing[:, 0], raised=0, debt=0, settled=0, rule="none")
        return _measured(
            machine,
            way,
            None,
            stand.q[None],
            start,
            nothing,
            (none,) * len(channels),
            1.0,
            ("already there",),
            channels,
        )
    override = command.override
    limits, notes = _timed(way.limits.overridden(override), command.duration and command.duration / override)
    steps, q, slowed, ruling = _within_limits(machine, way, limits, step_s, override)
    if slowed > 1.0:
        notes += (f"slowed {slowed:.2f} times to {steps.seconds:.3f} s: limits of {ruling}",)
    pulses = _counted(q, channels)
    wanted = np.diff(np.vstack([start, pulses[1:]]), axis=0)
    _check_frequency(machine, way, limits.slowed(slowed), channels, wanted, steps, override)
    emitted = tuple(
        emit(np.ascontiguousarray(wanted[:, k]), least_step(channel.min_hz, step_s), most_pulses(channel, step_s))
        for k, channel in enumerate(channels)
    )
    return _measured(machine, way, steps, q, start, wanted, emitted, slowed, notes, channels)


def counted(q: Array, channels: tuple[Channel, ...]) -> Pulses:
    """Return the pulses (M,) nearest to joint values q (M,), a half upward; ``Fault`` RBL432."""
    found: Pulses = _counted(q[None], channels)[0]
    return found


def most_pulses(channel: Channel, step_s: float) -> int:
    """Return the most pulses of one step of a channel."""
    return math.floor(channel.max_hz * step_s + 1e-9)


def _counted(q: Array, channels: tuple[Channel, ...]) -> Pulses:
    found = np.floor(q / [channel.pulse for channel in channels] + 0.5)
    if not np.abs(found).max() < MOST_PULSES:
        k = int(np.argmax(np.abs(found).max(axis=0)))
        raise Fault("RBL432", f"{channels[k].joint.name} would stand at {np.abs(found[:, k]).max():.4g} pulses from 0")
    return np.array(found, dtype=np.int64)


def _timed(limits: SpeedLimits, duration: float | None) -> tuple[SpeedLimits, tuple[str, ...]]:
    """Return limits with the speed that makes 1 / V + V / a the duration asked for, and a note where none can."""
    if duration is None:
        return limits, ()
    V, a = limits.speed, limits.acceleration
    root = (a * duration) ** 2 - 4.0 * a
    wanted = 0.5 * (a * duration - math.sqrt(root)) if root >= 0.0 else math.inf
    if wanted > V:
        shortest = 1.0 / V + V / a if a >= V * V else 2.0 / math.sqrt(a)
        return limits, (f"TIME {duration:g} s is too short, the move takes {shortest:.3f} s",)
    return SpeedLimits(speed=wanted, acceleration=a, jerk=limits.jerk), ()


def _steps(limits: SpeedLimits, step_s: float) -> EqualTimeSteps:
    speed = min(limits.speed, math.sqrt(limits.acceleration))  # over a whole path of 1 no triangle is faster
    seconds = 1.0 / speed + speed / limits.acceleration
    check_duration(seconds)
    return EqualTimeSteps.of(1.0, speed, speed / limits.acceleration, step_s)


def _within_limits(
    machine: Machine, way: Way, limits: SpeedLimits, step_s: float, override: float
) -> tuple[EqualTimeSteps, Array, float, str]:
    """Return the steps, their joint values, the factor of time that the joints needed, and which of them ruled."""
    slowed, ruling = 1.0, ""
    for _ in range(_ROUNDS):
        steps = _steps(limits.slowed(slowed), step_s)
        q = way.joints(steps.distances())
        factor, name = _excess(machine, q, step_s, override)
        if factor <= 1.0:
            return steps, q, slowed, ruling
        slowed, ruling = slowed * factor * _MARGIN, name
        if not slowed <= MAX_DURATION / step_s:
            break
    raise Fault("RBL412", f"no speed keeps the limits of {ruling} on this straight path: it passes a singularity")


def _excess(machine: Machine, q: Array, step_s: float, override: float) -> tuple[float, str]:
    """Return by which factor of time the steps are too fast for the joints (1 and less: not at all), and for which."""
    dq = np.diff(q, axis=0)
    ddq = np.diff(dq, axis=0, prepend=0.0, append=0.0)
    speed = np.abs(dq).max(axis=0) / step_s / [joint.speed * override for joint in machine.joints]
    acceleration = np.abs(ddq).max(axis=0) / step_s**2 / [joint.acceleration for joint in machine.joints]
    ratios = np.stack([speed, np.sqrt(acceleration)])
    kind, k = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
    return float(ratios[kind, k]), f"{machine.joints[int(k)].name} {('speed', 'acceleration')[kind]}"


def _check_frequency(
    machine: Machine,
    way: Way,
    limits: SpeedLimits,
    channels: tuple[Channel, ...],
    wanted: Pulses,
    steps: EqualTimeSteps,
    override: float,
) -> None:
    """Refuse a step that wants more pulses than its channel can give, with a SPEED or TIME at which none does."""
    most = np.array([most_pulses(channel, steps.step_s) for channel in channels])
    ratios = np.abs(wanted) / most
    if ratios.max() <= 1.0:
        return
    row, k = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
    needed, channel = int(abs(wanted[row, k])) / steps.step_s, channels[int(k)]
    share = 100.0 * float(steps.distances()[row])
    fits = _fitting(way, limits, channels, most, steps.step_s, float(ratios.max()))
    speed = fits.speed * way.length / MM
    what = f"SPEED {down(speed / override):g}" if speed > 0.0 else f"TIME {fits.seconds * override:.3f}"
    needs, gives = beside(needed, channel.max_hz, form=".0f")
    raise Fault(
        "RBL430",
        f"{channel.joint.name} of the {machine.name} needs {needs} Hz at {share:.1f} % of the path, "
        f"its channel gives {gives} Hz at most",
        f"{what} would fit",
    )


def _fitting(
    way: Way, limits: SpeedLimits, channels: tuple[Channel, ...], most: Pulses, step_s: float, ratio: float
) -> EqualTimeSteps:
    """Return the steps of the move at a speed whose frequencies fit."""
    speed = min(limits.speed, math.sqrt(limits.acceleration))
    while True:
        speed *= _FITS / max(ratio, 1.0)
        steps = _steps(SpeedLimits(speed=speed, acceleration=limits.acceleration, jerk=limits.jerk), step_s)
        wanted = np.abs(np.diff(_counted(way.joints(steps.distances()), channels), axis=0))
        ratio = float((wanted / most).max())
        if ratio <= 1.0:
            return steps


def _measured(
    machine: Machine,
    way: Way,
    steps: EqualTimeSteps | None,
    q: Array,
    start: Pulses,
    wanted: Pulses,
    emitted: tuple[Emission, ...],
    slowed: float,
    notes: tuple[str, ...],
    channels: tuple[Channel, ...],
) -> MovePulses:
    """Put together a move and where its pulses take the tool."""
    count = max((len(each.steps) for each in emitted), default=0)
    positions = np.zeros((count + 1, len(channels)), dtype=np.int64)
    for k, each in enumerate(emitted):
        positions[1 : len(each.steps) + 1, k] = each.steps
    positions = start + np.cumsum(positions, axis=0)
    for k, each in enumerate(emitted):
        positions[len(each.steps) :, k] = positions[len(each.steps), k]
    points = machine.points(positions * [channel.pulse for channel in channels])
    return MovePulses(
        way=way,
        steps=steps,
        q=q,
        start=start,
        wanted=wanted,
        emitted=emitted,
        count=count,
        points=points,
        error=off_line(points, *way.ends),
        slowed=slowed,
        notes=notes,
    )


def off_line(points: Array, start: Array, end: Array) -> Array:
    """Return the distance (K,) m of points (K, 3) from the segment between two points (3,)."""
    way = end - start
    length2 = dot(way, way)
    along = np.clip(matmul(points - start, way) / length2, 0.0, 1.0) if length2 > 0.0 else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - (start + along[:, None] * way), axis=1))
