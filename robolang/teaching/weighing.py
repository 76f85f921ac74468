"""Weighing what the arm of a live controller carries: a short motion about where it stands, and the LOAD to write.

The motion, and what its torques show, are those of ``robolang weigh`` (``robolang.experiments.weigh``), about the
present posture instead of home. Tool point and flange keep to the reduced speed of MANUAL: where the swings would be
faster, they are made smaller. ``Controller.weighing`` must be set while it runs, since the
LOAD in force may be wrong; collisions are found all the same.

    plan = weigh_plan(controller)
    begun, controller.weighing = controller.recorder.tick, True
    executor.play(plan.rows, None, "weigh")        to its end
    result = weigh_result(plan, controller.recorder.recent(controller.recorder.tick - begun), physics=...)
"""

from dataclasses import dataclass

import numpy as np

from robolang.experiments.weigh import (
    SETTLE_S,
    WRIST,
    Declaration,
    Exercise,
    exercise_about,
    load_statement,
    main_axes,
    weighed,
)
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.units import MM
from runtime.dynamics.payload_identification import WeighedPayload
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.speed_cap import MANUAL_SPEED, SpeedCap
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile
from runtime.supervision.torque_observer import TURNING

_MAIN = 0.7
"""Share of the speed that the main axes may take."""
_HALVINGS = 7
"""Halvings by which a share is found, to less than 1 %."""
_FAST_ENOUGH = 2.0 * TURNING
"""Least peak speed of an axis that swings, rad/s: below ``TURNING`` its friction is not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WeighPlan:
    """Set-points ``rows`` (K, n) rad, one a cycle, from rest to rest at one posture; ``exercise`` begins with cycle
    ``settling``. ``robot`` and ``profile`` are those of the controller."""

    robot: RobotSpec
    profile: Profile
    rows: Array
    settling: int
    exercise: Exercise

    @property
    def seconds(self) -> float:
        """How long the motion takes."""
        return len(self.rows) * self.profile.period_s


@dataclass(frozen=True, slots=True, kw_only=True)
class WeighResult:
    """What was weighed, and the LOAD that declares it."""

    found: WeighedPayload
    load: Declaration


def weigh_plan(controller: Controller, most_speed: float = MANUAL_SPEED) -> WeighPlan:
    """Return the motion about the commanded posture; ``most_speed`` m/s of tool point and flange.

    ``Fault`` RBL411 where the joint ranges, or the speed, leave no axis enough to swing. Nothing has moved.
    """
    robot, profile, start = controller.spec, controller.profile, np.array(controller.areas.ina)
    exercise = exercise_about(robot, start, profile)
    cap = SpeedCap(
        most=most_speed,
        kinematics=controller.kinematics,
        fine=FineInterpolator(profile.ticks_per_cycle, profile.period_s, start),
        X_flange_tool=controller.X_flange_tool,
    )
    exercise = _slowed(exercise, start, cap, robot)
    # the arm first finds its rest, as the experiment lets it
    settling = round(SETTLE_S / profile.period_s)
    offsets = np.concatenate([np.zeros((settling, robot.n)), exercise.offsets])
    return WeighPlan(robot=robot, profile=profile, rows=frozen(start + offsets), settling=settling, exercise=exercise)


def _slowed(exercise: Exercise, start: Array, cap: SpeedCap, robot: RobotSpec) -> Exercise:
    """Return an exercise that keeps to a cap; ``Fault`` RBL411 where the axes cannot turn fast enough under it.

    The main axes, whose torques tell the mass, get ``_MAIN`` of the speed at most, and the wrist what they leave. An
    axis that is then too slow to show its friction would spoil the rows of all others: of the main axes the one that is
    nearest to the base, which moves the tool most, stands still instead.
    """
    main = main_axes(robot)
    for still in range(WRIST + 1):
        used = np.cumsum(~robot.slides) > still
        share = np.where(main, _largest(exercise.offsets * (main & used), start, cap, _MAIN), 0.0)
        wrist = _largest(exercise.offsets * ~main, start, cap, 1.0, exercise.offsets * share * used)
        share = np.where(main, share * used, wrist)
        speeds = cap.fine.peaks(exercise.offsets * share)[0]
        moving = share * exercise.amplitudes > 0.0
        if moving.any() and (speeds[moving] >= _FAST_ENOUGH).all():
            return Exercise(offsets=frozen(exercise.offsets * share), amplitudes=frozen(exercise.amplitudes * share))
    raise Fault(
        "RBL411",
        f"at {cap.most / MM:g} mm/s no axis of {robot.name} turns fast enough in this posture to be weighed by",
        "bring the arm to a posture in which the tool is nearer to the wrist",
    )


def _largest(offsets: Array, start: Array, cap: SpeedCap, most: float, others: Array | float = 0.0) -> float:
    """Return the largest share, up to 1, of offsets (K, n) rad that keeps to ``most`` of a cap together with others."""

    def keeps(share: float) -> bool:
        return cap.ratio(np.array(cap.fine.expand(start + share * offsets + others))) <= most

    if keeps(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if keeps(middle) else (low, middle)
    return low


def weigh_result(plan: WeighPlan, rows: Array, *, physics: bool) -> WeighResult:
    """Return what the motion of a plan shows; ``Fault`` RBL516 where no payload explains its torques.

    ``rows`` (N, 4 n): (tau_cmd, tau_sat, q_fb, dq_fb) of all servo ticks since the motion began, as the recorder has
    them. ``physics``: whether the plant is MuJoCo; the ideal arm has no friction. ``ValueError`` for fewer rows than
    the motion has.
    """
    n, m = plan.robot.n, plan.profile.ticks_per_cycle
    if not len(rows) >= len(plan.rows) * m:
        raise ValueError(f"{len(rows)} rows are not the whole motion of {len(plan.rows) * m}")
    exercise = rows[plan.settling * m :]
    tau, q = exercise[:, n : 2 * n], exercise[:, 2 * n : 3 * n]
    found = weighed(plan.robot, plan.profile, tau, q, physics=physics)
    return WeighResult(found=found, load=load_statement(found, plan.robot.rated_payload))
