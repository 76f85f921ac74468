"""The figures of CN103429397A (Kobe Steel): straight moves through a change of the wrist, computed by this controller.

A *trial* is one of the moves E1 to E3 under one condition, a *run* its result, and a *figure* the runs that are
drawn together. The document gives its moves by J5 alone (+65 -> -65, -10 -> +10, +10 -> -10 deg); their joint angles,
the robot (IRB 2400), the tool (200 mm along the flange axis), 4 s at constant speed and 10 ms are those of this
project's acceptance experiments.

Figures 17 to 22 are reconstructions: the document's text on them, on suppression, is lost. They show the experiments
that the project put in its place, with frame, candidates and choice of ``runtime.motion.wrist.hold``, a switch at 2.2
s (E2) or 1.8 s (E3), 20 ms, limits of 180, 180 and 225 deg/s. The seam of figure 11 is made up too.

Nothing is planned here, so nothing is slowed, smoothed or refused; ``CartesianPlanner`` would make some of these
moves differently. They show what the document's rule alone does, good or bad. Angles rad, lengths m,
times s.
"""

from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen, inverse, pose, rotation_angles
from runtime.core.linear import matmul
from runtime.core.units import DEG, MM
from runtime.motion.commands import Component
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path import LinePath
from runtime.motion.path_ik import Arm, LineSolver, WristSolver
from runtime.motion.seam import CalculatedMove, SeamLimits, SeamMove, SeamTracker, superposed
from runtime.motion.wrist.hold import (
    COMPONENTS,
    PathAhead,
    Suppression,
    WristTable,
    posture_components,
    weld_line_frame,
)
from runtime.motion.wrist.switch import PathTiming, WristLaw, WristLimits, first_trigger, law_from
from runtime.robot.kinematics.frozen_wrist import MAIN_AXES, WRIST_AXES
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import WristOptions

DURATION_S = 4.0
X_FLANGE_TOOL = pose((0.0, 0.0, 200.0 * MM), np.eye(3))
RANGE = 180.0 * DEG
"""The wrist axes end here in the document's figures 6 and 7, whatever the robot can do."""

MOVES = {
    "E1": ((-20.0, 10.0, 30.0, 10.0, 65.0, -15.0), (0.0, -10.0, 45.0, -55.0, -65.0, 85.0)),
    "E2": ((15.0, 20.0, 10.0, -70.0, -10.0, 5.0), (25.0, 15.0, 0.0, -45.0, 10.0, 35.0)),
    "E3": ((0.0, -10.0, -20.0, 55.0, 10.0, 85.0), (-15.0, -10.0, 0.0, 30.0, -10.0, 50.0)),
}
"""Taught joint angles of start and end, deg, J3 as ABB counts it."""

_NONE = replace(WristOptions(posture="rpy", shape="linear", look_ahead=0).only(), remedies=False)
_C1 = replace(_NONE, speed_condition="any", speed=(120.0 * DEG,) * WRIST_AXES)
_C3 = replace(_NONE, range_condition=True)
_C4 = replace(_NONE, deviation_condition="moving")
_SPEEDS = replace(_NONE, speed=(180.0 * DEG, 180.0 * DEG, 225.0 * DEG))


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """One move under one condition; ``condition`` is its short name, of suppression that of what is held.

    ``switch_s``: the wrist leaves the path then, whatever the conditions; ``held`` posture components are suppressed
    from there. ``seam`` (6,): deviation in m and rad that a sensor sees at the end, growing from none at the start.
    """

    move: str
    condition: str
    options: WristOptions = _NONE
    period_s: float = 0.01
    switch_s: float | None = None
    held: tuple[Component, ...] = ()
    seam: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A figure of the document: its number, what was done in words, what is to be seen in a sentence, its trials.

    ``drawn`` is the trial whose posture components are plotted; None: J4 to J6 of all are, those of the second under
    the name ``variant``. ``switch`` is the document's name of the switch.
    """

    number: int
    title: str
    sentence: str
    trials: tuple[Trial, ...]
    switch: str = ""
    variant: str = ""
    drawn: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """The result of a trial: joint angles ``q`` (N + 1, n) at times ``t`` (N + 1,); ``q_end`` (n,) where it should end.

    ``switch`` is the sample from which the wrist follows a joint curve of its own (None: it never does), ``axis``
    (0-based) the one that met the condition (None: no single one). ``posture`` (N + 1,): angle between the tool and its
    posture on the path; ``components`` (N + 1, 3): the same as tilt, advance and rotation, with sign; ``off_path``
    (N + 1,) m.
    """

    trial: Trial
    t: Array
    q: Array
    q_end: Array
    switch: int | None
    axis: int | None
    posture: Array
    components: Array
    off_path: Array

    @property
    def speed(self) -> Array:
        """Largest speed of each axis (n,) from the switch on, rad/s; of the whole move where there is none."""
        return self._fastest(self.switch or 0)

    @property
    def peak(self) -> Array:
        """Largest speed of each axis (n,) in the whole move, rad/s."""
        return self._fastest(0)

    @property
    def end_error(self) -> float:
        """Largest distance of a joint from its taught end angle, rad."""
        return float(np.abs(self.q[-1] - self.q_end).max())

    @property
    def switch_s(self) -> float | None:
        """Time of the switch, s."""
        return None if self.switch is None else float(self.t[self.switch])

    def _fastest(self, first: int) -> Array:
        return np.asarray(np.abs(np.diff(self.q[first:], axis=0)).max(axis=0) / self.trial.period_s)


def _suppression(move: str, switch_s: float) -> tuple[Trial, ...]:
    """Return the five trials of suppression: nothing held, each component, tilt and advance together."""
    sets: tuple[tuple[Component, ...], ...] = ((), *((each,) for each in COMPONENTS), ("TILT", "ADVANCE"))
    return tuple(
        Trial(
            move=move,
            condition=" + ".join(held) or "nothing",
            options=_SPEEDS,
            period_s=0.02,
            switch_s=switch_s,
            held=held,
        )
        for held in sets
    )


_E1, _E2 = (Trial(move=move, condition="J5 kept") for move in ("E1", "E2"))
_E1_C1 = Trial(move="E1", condition="C1 any 120", options=_C1)
_E2_C3 = Trial(move="E2", condition="C3 180", options=_C3)
_E2_HERMITE = Trial(move="E2", condition="C3 180 Hermite", options=replace(_C3, shape="hermite", look_ahead=10))
_E2_SEAM = replace(_E2_C3, condition="C3 180 seam", seam=(0.0, 5.0 * MM, -3.0 * MM, 0.0, 0.0, 2.0 * DEG))
_E3_C4 = Trial(move="E3", condition="C4 90/180/90", options=replace(_C4, posture="axis"))
_E2_HELD, _E3_HELD = _suppression("E2", 2.2), _suppression("E3", 1.8)
_WORDS = ("nothing", "tilt", "advance", "rotation", "tilt and advance")

FIGURES = (
    Figure(
        number=4,
        title="conventional",
        trials=(_E1,),
        sentence="J5 keeps its sign over the whole move; the dots are the angles taught for the end.",
    ),
    Figure(
        number=5,
        title="C1 at 120 deg/s",
        switch="L1",
        trials=(_E1_C1,),
        sentence="From L1 on, just before one of J4 to J6 would need more than 120 deg/s to get to its taught angle "
        "in time, all three go straight there.",
    ),
    Figure(
        number=6,
        title="conventional",
        trials=(_E2,),
        sentence="J5 keeps its sign over the whole move; +-180 deg is what J4 to J6 are to stay within.",
    ),
    Figure(
        number=7,
        title="C3 at +-180 deg",
        switch="L2",
        variant="Hermite",
        trials=(_E2_C3, _E2_HERMITE),
        sentence="The wrist leaves the path before an axis leaves +-180 deg. Solid: straight to the end angles. "
        "Dashed: from the speed it has to rest, with the range checked 10 cycles ahead.",
    ),
    Figure(
        number=10,
        title="C4 at 90, 180, 90 deg",
        switch="L3",
        trials=(_E3_C4,),
        sentence="With the posture turning about one axis, the wrist leaves the path where J4, J5 or J6 is too far "
        "from the straight line between its taught angles. Nothing bounds its speed before.",
    ),
    Figure(
        number=11,
        title="on a seam, C3 at +-180 deg",
        switch="L2",
        variant="seam",
        trials=(_E2_C3, _E2_SEAM),
        sentence="The seam drifts to (0, 5, -3) mm and 2 deg about the upright. Dashed: the end point follows it, "
        "and so do the angles at which the wrist ends.",
    ),
    *(
        Figure(
            number=17 + k,
            title=f"{held} held",
            switch="switch",
            trials=(_E2_HELD[k],),
            drawn=0,
            sentence=f"By how much the tool leaves its posture with {held} held. Reconstruction.",
        )
        for k, held in enumerate(_WORDS)
    ),
    Figure(
        number=22,
        title="tilt and advance held",
        switch="switch",
        trials=_E3_HELD,
        drawn=4,
        sentence="As figure 21, for E3; of the other four only the numbers are given. Reconstruction.",
    ),
)


def unusable(robot: RobotSpec) -> str:
    """Return why a robot cannot make these moves; empty when it can."""
    if robot.n != MAIN_AXES + WRIST_AXES:
        return f"{robot.name} has {robot.n} axes, not {MAIN_AXES + WRIST_AXES}"
    for name, ends in MOVES.items():
        for q in np.array(ends) * DEG:
            outside = ~((robot.lower <= q) & (q <= robot.upper))
            if outside.any():
                axis = int(np.argmax(outside))
                return f"J{axis + 1} of {robot.name} does not get to the {q[axis] / DEG:g} deg of {name}"
    return ""


def run(robot: RobotSpec, trial: Trial) -> Run:
    """Return what a trial gives on a robot; ``Fault`` RBL412 where it has no joint angles, RBL526 off the seam."""
    line, q_end = _line(robot, trial)
    s = np.linspace(0.0, 1.0, round(DURATION_S / trial.period_s) + 1)
    planned = line.path.poses(s)
    if trial.seam:
        q, switch, axis = *_tracked(line, q_end, s, trial), None
        seam = np.array(trial.seam)
        planned = np.stack([superposed(X, share * seam) for X, share in zip(planned, s, strict=True)])
        # the end moves with the seam (figure 11), so the angles to end at are others of the same branch
        flange = matmul(superposed(line.path.X_end, seam), inverse(X_FLANGE_TOOL))
        q_end = line.arm.kinematics.inverse_branch(flange, line.arm.kinematics.branch_of(q_end), q_end)
    else:
        q, switch, axis = _processed(line, q_end, s, trial)
    if not np.isfinite(q).all():
        place = 100 * s[int(np.argmin(np.isfinite(q).all(axis=1)))]
        raise Fault("RBL412", f"{robot.name} has no joint angles at {place:.1f} % of {trial.move}, {trial.condition}")
    taken, path = matmul(line.arm.kinematics.forward(q), X_FLANGE_TOOL), line.path
    assert isinstance(path, LinePath)
    return Run(
        trial=trial,
        t=frozen(s * DURATION_S),
        q=frozen(q),
        q_end=frozen(q_end),
        switch=switch,
        axis=axis,
        posture=frozen(rotation_angles(planned[:, :3, :3], taken[:, :3, :3])),
        components=frozen(_components(path, planned, taken)),
        off_path=frozen(np.linalg.norm(taken[:, :3, 3] - planned[:, :3, 3], axis=1)),
    )


def _line(robot: RobotSpec, trial: Trial) -> tuple[LineSolver, Array]:
    """Return the path of a move with the sign of J5 kept, and its taught end (n,)."""
    start, end = np.array(MOVES[trial.move]) * DEG
    arm = Arm(
        spec=_ranged(robot),
        kinematics=Kinematics(robot),
        X_flange_tool=X_FLANGE_TOOL,
        fine=FineInterpolator(1, trial.period_s, start),
    )
    X_start, X_end = (matmul(arm.kinematics.forward(q), X_FLANGE_TOOL) for q in (start, end))
    return LineSolver(arm, LinePath.between(X_start, X_end, trial.options.posture), start), end


def _ranged(robot: RobotSpec) -> RobotSpec:
    """Return the robot with wrist axes that end at ``RANGE``, where they do not end before."""
    axes = list(robot.axes)
    for k in range(MAIN_AXES, robot.n):
        limits = axes[k].limits
        limits = replace(limits, lower=max(limits.lower, -RANGE), upper=min(limits.upper, RANGE))
        axes[k] = replace(axes[k], limits=limits)
    return replace(robot, axes=tuple(axes))


def _processed(line: LineSolver, q_end: Array, s: Array, trial: Trial) -> tuple[Array, int | None, int | None]:
    """Return the joint angles (N + 1, n) of the document's rule, the sample of the switch, the axis that caused it.

    The condition is met by the point after the switch (S61), from which the wrist is held back (S63).
    """
    q, options, axis = line.rows(s), trial.options, None
    if trial.switch_s is None:
        timing = PathTiming(s=s, period_s=trial.period_s, length=line.path.length)
        trigger = first_trigger(q, q_end, timing, WristLimits.of(line.arm.spec, options), options)
        if trigger is None:
            return q, None, None
        index, axis = trigger.index - 1, trigger.axis
    else:
        index = round(trial.switch_s / trial.period_s)
    law: WristLaw | WristTable = law_from(q, s, index, q_end[-WRIST_AXES:], options.shape, options.width)
    if trial.held:
        law = _held(line, q[index], q_end, s[index:], trial)
    return WristSolver(line, law, q[index], q_end).rows(s), index, axis


def _held(line: LineSolver, q_switch: Array, q_end: Array, s: Array, trial: Trial) -> WristTable:
    """Return what suppression chooses at the samples s from the switch on, as it chose it: steps and all."""
    arm, path, end = line.arm, line.path, q_end[-WRIST_AXES:]
    speed = WristLimits.of(arm.spec, trial.options).speed
    suppression = Suppression(arm.kinematics, arm.X_flange_tool, trial.held, speed)
    chosen = suppression.choose(q_switch, end, PathAhead.of(path, s, trial.period_s))
    return WristTable(s_switch=float(s[0]), values=frozen([q_switch[-WRIST_AXES:], *chosen]))


def _tracked(line: LineSolver, q_end: Array, s: Array, trial: Trial) -> tuple[Array, int | None]:
    """Return the joint angles (N + 1, n) of a move on a seam seen without error, and the sample of its switch."""
    seam = np.array(trial.seam)

    def read(distance: float, travel: Array) -> Array:
        return np.asarray(seam * (distance / line.path.length))

    # not filtered: this sensor shows the seam without delay
    tracker = SeamTracker("demo", SeamLimits(filter_s=0.0), trial.period_s, read)
    calculated = CalculatedMove(line=line, s=s, period_s=trial.period_s, q_end=q_end, switch=None)
    move = SeamMove(calculated, line.q_start, tracker, trial.options)
    rows = [line.q_start]
    for n in range(1, len(s)):
        q, fault = move.next(n)
        if fault is not None:
            raise fault
        rows.append(q)
    return np.stack(rows), None if move.law is None else int(np.searchsorted(s, move.law.s_switch))


def _components(path: LinePath, planned: Array, taken: Array) -> Array:
    """Return tilt, advance and rotation (N, 3) of the postures taken less those planned, rad, within half a turn."""
    frame = weld_line_frame(path.X_end[:3, 3] - path.X_start[:3, 3])
    off = posture_components(frame, taken[:, :3, :3]) - posture_components(frame, planned[:, :3, :3])
    return np.asarray(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)))
