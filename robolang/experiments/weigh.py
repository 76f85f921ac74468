"""Weighing: the arm makes a short exercise about the home of its cell, and its torques show what it carries.

The whole controller runs, with no LOAD declared: cycle, dynamics task, servo, motors, plant. Only planning is left out:
the exercise is a sum of sines, written into INA set-point by set-point. Axis i swings by

    A_i w(t) sin(2 pi k_i t / T)          k_i whole swings, no two axes alike; w rises and falls smoothly

so that every axis passes every angle in both directions, at many combinations of the others. The wrist axes swing by
the whole amplitude, the last one by twice of it, since it turns the centre of gravity round in the torque of the one
before; the main axes by a fifth, which shows their dry friction and leaves the tool near its place.
An axis that feels no weight anywhere, such as an upright waist, stands still, and so does one that slides: the weight
along it does not depend on where the centre of gravity is.

Range, speed and acceleration of every axis are checked over all servo ticks before anything moves. Supervision runs,
except for its checks of payload and collision: there is no LOAD that could be wrong. What the torques of the
exercise leave unexplained by any payload is judged afterwards instead (RBL516).
"""

import math
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from robolang.execution.rig import Rig, fitted, plant_of
from runtime.cell.cell import CellSpec
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM
from runtime.dynamics.payload_identification import BodyModel, Knowledge, WeighedPayload, identify_payload
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.robot.model.load_rules import MAX_COG_DISTANCE
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.motor import torque_limit
from runtime.settings.profile import Profile

PlantName = Literal["rigid", "mujoco"]

AMPLITUDE = 25.0 * DEG
"""Swing of the wrist axes where none is given, rad."""
LEAST = 2.0 * DEG
"""An axis that has less room stands still where no amplitude is given, rad."""
MAIN, LAST = 0.2, 2.0
"""Share of the amplitude by which the main axes and the last one swing."""
WRIST = 3
"""Axes that turn before the first that counts as wrist."""
SECONDS = 12.0
RAMP_S = 1.5
"""Time in which the swing grows and dies away."""
SETTLE_S = 0.4
"""Time in which the arm finds its rest under the unknown load before it swings."""
SWINGS = (5, 3, 2, 7, 4, 1, 6)
"""Whole swings of each axis, in the order of the axes."""
SHARE = 0.9
"""Share of a limit that is used where no amplitude is given."""
MARGIN = 1.0 * DEG
"""Distance from the ends of the range: what the unknown load may push the arm beyond its command, rad."""
FEELS = 1e-3
"""Torque by weight, N m per kg at 1 m, below which an axis does not feel it."""
BELIEVED = 3.0
"""Standard uncertainties within which a mass may still be the rated one."""
UNEXPLAINED = 0.05
"""Share of the torque limit that no payload may leave unexplained."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WeighRequest:
    """What is weighed where: ``added`` is a body beside the hand of the cell; ``amplitude`` rad (None: what fits)."""

    cell: CellSpec
    added: Payload | None = None
    profile: Profile = field(default_factory=Profile)
    plant: PlantName = "mujoco"
    amplitude: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Exercise:
    """Set-points from rest to rest (N, n) rad beside the home posture, and the swing of each axis (n,) rad."""

    offsets: Array
    amplitudes: Array

    @property
    def axes(self) -> list[int]:
        """Axes that swing, 0-based."""
        return [int(axis) for axis in np.flatnonzero(self.amplitudes)]


@dataclass(frozen=True, slots=True, kw_only=True)
class WeighResult:
    """What was found and what is true."""

    found: WeighedPayload
    true: Payload
    exercise: Exercise
    seconds: float


def carried(request: WeighRequest) -> Payload:
    """Return what the plant really carries: the hand of the cell and the added body."""
    hand, added = request.cell.hand, request.added
    if added is None or added.mass == 0.0:
        return Payload(mass=hand.mass, cog=frozen(hand.cog))
    mass = hand.mass + added.mass
    return Payload(mass=mass, cog=frozen((hand.mass * np.asarray(hand.cog) + added.mass * added.cog) / mass))


# --- the exercise ----------------------------------------------------------------------------------------------------


def plan_exercise(request: WeighRequest) -> Exercise:
    """Return the exercise about home; ``Fault`` as ``exercise_about``."""
    return exercise_about(request.cell.robot, request.cell.home, request.profile, request.amplitude)


def exercise_about(robot: RobotSpec, q: Array, profile: Profile, amplitude: float | None = None) -> Exercise:
    """Return the exercise about joint angles q (n,) rad; ``Fault`` before anything moves.

    RBL411 where an axis would leave its range, RBL404 where one would be too fast. Without an ``amplitude``, rad, each
    axis swings by what its limits leave; RBL411 when they leave nothing.
    """
    unit = _shape(robot, profile.period_s)
    swings = _share(robot) * (AMPLITUDE if amplitude is None else amplitude)
    if not swings.any():
        raise _nothing_felt(robot)
    fine = FineInterpolator(profile.ticks_per_cycle, profile.period_s, np.zeros(robot.n))
    limits = robot.per_axis("limits", "speed"), robot.per_axis("limits", "acceleration")
    most = np.min([limit / peak for limit, peak in zip(limits, fine.peaks(unit), strict=True)], axis=0)
    room = np.minimum(robot.upper - q, q - robot.lower) - MARGIN
    if amplitude is None:
        fitting = np.minimum(swings, np.minimum(SHARE * most, room))
        swings = np.where(fitting >= np.minimum(LEAST, swings), fitting, 0.0)
        if not swings.any():
            raise Fault(
                "RBL411",
                f"this posture leaves no axis of {robot.name} {LEAST / DEG:g} deg to either side to swing",
                "weigh in a posture, or from a home, that is further inside the joint ranges",
            )
    else:
        _refuse(robot, q, swings, room, most, amplitude)
    return Exercise(offsets=frozen(unit * swings), amplitudes=frozen(swings))


def _nothing_felt(robot: RobotSpec) -> Fault:
    if not robot.slides.any():
        return Fault("RBL411", f"no axis of {robot.name} feels the weight of what it carries")
    message = f"no axis of {robot.name} that turns feels the weight of what it carries, which shows a centre of gravity"
    return Fault("RBL411", message, "weigh it on a scale, and take the centre of gravity from its drawing")


def _refuse(robot: RobotSpec, q: Array, swings: Array, room: Array, most: Array, amplitude: float) -> None:
    """Raise the fault of the first axis whose swing passes a limit; the hint says which amplitude would not."""
    moving = swings > 0.0
    best = amplitude * float(np.min(np.minimum(room, most)[moving] / swings[moving])) / DEG
    hint = "the posture is too near to the end of a joint range"
    # below a tenth the amplitude of the hint, rounded down so that it fits itself, would be 0
    if best >= 0.1:
        hint = f"an amplitude of {math.floor(10.0 * best) / 10.0:g} deg fits; without one each axis does what it can"
    for axis in np.flatnonzero(moving):
        low, high, by = robot.lower[axis], robot.upper[axis], float(swings[axis])
        if not by <= room[axis]:
            end = q[axis] + by if high - q[axis] < q[axis] - low else q[axis] - by
            raise Fault(
                "RBL411",
                f"J{axis + 1} would swing to {end / DEG:.1f} deg; its range is {low / DEG:g} to "
                f"{high / DEG:g} deg, with {MARGIN / DEG:g} deg kept free at its ends",
                hint,
            )
        if not by <= most[axis]:
            raise Fault(
                "RBL404",
                f"J{axis + 1} would swing by {by / DEG:.1f} deg and can by {most[axis] / DEG:.1f} "
                "deg in this time without passing its speed or acceleration",
                hint,
            )


def main_axes(robot: RobotSpec) -> NDArray[np.bool_]:
    """Return which axes (n,) are main axes: the first ``WRIST`` that turn, and slides before or between them."""
    return np.asarray(np.cumsum(~robot.slides) <= WRIST)


def _share(robot: RobotSpec) -> Array:
    """Return by which share of the amplitude each axis swings (n,); 0 for one that never feels weight."""
    model = BodyModel(robot)
    felt = np.zeros(robot.n)
    zero = np.zeros(robot.n)
    # a seed of its own: the same axes of a robot swing every time
    for q in np.random.default_rng(560).uniform(robot.lower, robot.upper, (16, robot.n)):
        model.torque(q, zero, zero)
        felt = np.maximum(felt, np.abs(model.regressor(q)).max(axis=1))
    share = np.where(main_axes(robot), MAIN, 1.0)
    if robot.n > WRIST:
        share[-1] = LAST
    return np.where((felt > FEELS) & ~robot.slides, share, 0.0)


def _shape(robot: RobotSpec, period_s: float) -> Array:
    """Return the swings of all axes with amplitude 1, from rest to rest, one row for each cycle (N, n)."""
    t = np.arange(round(SECONDS / period_s) + 1) * period_s
    end = np.clip(np.minimum(t, t[-1] - t) / RAMP_S, 0.0, 1.0)
    # the quintic again: speed and acceleration are 0 at both ends of a ramp
    w = end**3 * (10.0 - 15.0 * end + 6.0 * end**2)
    k = np.resize(SWINGS, robot.n)  # no two of seven axes alike: each meets many combinations of the others
    return np.asarray(w[:, None] * np.sin(2.0 * math.pi * k * t[:, None] / t[-1]))


# --- the run ---------------------------------------------------------------------------------------------------------


def weigh(request: WeighRequest) -> WeighResult:
    """Plan, move and weigh; ``Fault`` when the exercise is refused or the arm does not get through it."""
    exercise = plan_exercise(request)
    profile, rigid = _profile(request), request.plant == "rigid"
    robot, true = request.cell.robot, carried(request)
    plant = plant_of(_loaded(request.cell, true), profile.tick_s, physics=not rigid)
    controller = Rig.over(plant, request.cell, profile).controller
    start = controller.areas.ina  # the command that holds the arm against its springs, not its home angles
    _play(controller, np.zeros((round(SETTLE_S / profile.period_s), robot.n)) + start)
    first = controller.recorder.tick
    _play(controller, start + exercise.offsets)
    log = controller.signals()
    found = weighed(robot, profile, log["tau_sat"][first:], log["q_fb"][first:], physics=not rigid)
    return WeighResult(found=found, true=true, exercise=exercise, seconds=controller.time_us / 1e6)


def weighed(robot: RobotSpec, profile: Profile, tau: Array, q: Array, *, physics: bool) -> WeighedPayload:
    """Return what the torques tau (N, n) N m and readings q (N, n) rad of an exercise show, one row a servo tick.

    ``physics`` False: the ideal arm, without friction and gear springs. ``Fault`` RBL516 where no payload explains the
    torques.
    """
    watched = profile.supervision
    known = Knowledge(
        torque=torque_limit(robot),
        friction=0.0 if not physics else 1.0 if watched.friction is None else watched.friction,
        springs=physics,
        friction_uncertainty=watched.friction_uncertainty,
        torque_uncertainty=watched.torque_uncertainty,
    )
    found = identify_payload(robot, tau, q, ticks=profile.ticks_per_cycle, tick_s=profile.tick_s, known=known)
    _explained(found, known.torque)
    return found


def _profile(request: WeighRequest) -> Profile:
    """Return the profile without the checks of a payload that nobody has declared, and as the plant needs it."""
    profile = request.profile
    watched = replace(profile.supervision, payload_mismatch="off", collision=math.inf)
    if request.plant == "mujoco":
        return replace(profile, supervision=watched)
    return fitted(replace(profile, supervision=watched), physics=False)


def _loaded(cell: CellSpec, true: Payload) -> CellSpec:
    """Return the cell as it is: the hand has the mass and the centre of gravity of all that it carries."""
    return replace(cell, hand=replace(cell.hand, mass=true.mass, cog=true.cog))


def _play(controller: Controller, rows: Array) -> None:
    """Send set-points (N, n), one in each cycle; ``Fault`` with the code of the alarm that ends it."""
    controller.play(rows)
    for _ in rows:
        if not controller.cycle() or controller.alarms:
            alarm = controller.alarms[0]
            at = alarm.tick * controller.profile.tick_s
            raise Fault(alarm.code, f"while weighing, at {at:.3f} s: {alarm.message}", alarm.hint)


def _explained(found: WeighedPayload, torque: Array) -> None:
    share = found.peak / torque
    axis = int(np.argmax(share))
    if not share[axis] <= UNEXPLAINED:
        raise Fault(
            "RBL516",
            f"up to {found.peak[axis]:.1f} N m of J{axis + 1} in the exercise belong to no payload",
            "clear the space about the arm; then check the drive, brake and friction of the axis",
        )


# --- what is shown ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """A LOAD that a program may declare, and what it states otherwise than it was weighed; empty: nothing.

    Without ``text`` no program may declare what was weighed: ``code`` and ``note`` are the finding.
    """

    text: str | None
    note: str = ""
    code: str = ""


def load_statement(found: WeighedPayload, rated: float) -> Declaration:
    """Return the LOAD to paste: kg and mm with the digits that their uncertainty leaves, at most 3 and 1 decimals.

    A mass over the rated one by no more than its uncertainty explains is written as the rated one. What no program may
    declare (``runtime.robot.model.payload.declared``) has no LOAD but the code of that rule.
    """
    if found.cog is None or found.cog_sd is None:
        less = not found.mass >= -BELIEVED * found.mass_sd
        note = f"{found.mass:.3g} kg was weighed: the masses of the robot file are too large"
        return Declaration(text="LOAD (0, 0, 0), 0", note=note if less else "")
    # no nearest LOAD: whoever pastes one that is wrong runs with the feed-forward of another payload
    if not found.mass - rated < BELIEVED * found.mass_sd:
        weighed, most = beside(found.mass, rated, form=".4g")
        note = f"{weighed} kg was weighed and at most the rated {most} kg may be declared"
        return Declaration(text=None, note=note, code="RBL402")
    mass_text = _rounded(min(found.mass, rated), found.mass_sd, 3)
    if not float(mass_text) <= rated:  # rounded up
        mass_text = f"{rated:g}"
    distance = float(np.linalg.norm(found.cog))
    if not distance <= MAX_COG_DISTANCE:
        shown, most = beside(distance / MM, MAX_COG_DISTANCE / MM)
        note = f"the centre of gravity is {shown} mm from the flange and may be declared within {most} mm"
        return Declaration(text=None, note=note, code="RBL403")
    values = ", ".join(_rounded(c / MM, sd / MM, 1) for c, sd in zip(found.cog, found.cog_sd, strict=True))
    return Declaration(text=f"LOAD ({values}), {mass_text}")


def _rounded(value: float, sd: float, most: int) -> str:
    # 0 has no logarithm: where nothing is uncertain all digits stay
    digits = min(most, max(0, -math.floor(math.log10(sd)))) if sd > 0.0 else most
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if digits else text
    return "0" if text == "-0" else text  # of a value a little below 0


def as_json(request: WeighRequest, result: WeighResult) -> dict[str, Any]:
    """Return the figures in plain types, in kg, mm, deg and N m; a centre of gravity that is not known is None.

    Of an arm with an axis that slides ``home`` stands in place of ``home_deg``; the axis itself stands still.
    """
    robot = request.cell.robot
    found, true = result.found, result.true
    load = load_statement(found, robot.rated_payload)
    cog, sd = (None if x is None else (x / MM).tolist() for x in (found.cog, found.cog_sd))
    return {
        "robot": robot.name,
        "plant": request.plant,
        robot.joints_key.replace("joints", "home"): [float(x) for x in request.cell.home / robot.units],
        "seconds": result.seconds,
        "amplitudes_deg": [float(x) for x in result.exercise.amplitudes / DEG],
        "estimated": {"mass_kg": found.mass, "mass_sd_kg": found.mass_sd, "cog_mm": cog, "cog_sd_mm": sd},
        "true": {"mass_kg": true.mass, "cog_mm": [float(x) / MM for x in true.cog]},
        "friction_off_pct": [float(x) * 100.0 for x in found.friction],
        "left_rms_nm": [float(x) for x in found.left],
        "left_peak_nm": [float(x) for x in found.peak],
        "load": load.text,
        "load_note": load.note,
        "load_code": load.code or None,
    }
