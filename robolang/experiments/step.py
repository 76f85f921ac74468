"""The step experiment: one axis of a robot, held at a posture with a payload, is commanded to another angle at once.

The whole controller runs: cycle, dynamics task, servo of all axes, plant. Only fine interpolation is left out, so that
the servo sees a true step (its commanded speed and acceleration stay zero), as in the experiments of docs/servo.md.
The arm first rests ``HOLD_S`` under servo; what is left of its position error then is the droop. The response is
measured from that rest position: overshoot and settling against the value it settles at, rise from 10 to 90 %.

The payload that is carried and the one that LOAD declares are given apart: declaring too little is an experiment too,
and so is more than the arm is rated for.
"""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal

import numpy as np

from robolang.execution.rig import IdealArm, Rig, plant_of
from robolang.project.project import builtin_cell
from runtime.cell.cell import CellSpec
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.dynamics.equations import axis_inertia
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.axes import rotors
from runtime.servo.ideal import ideal_drives
from runtime.settings.profile import Profile

HOLD_S = 0.5
"""Time under servo before the step, s."""
BAND = 0.02
"""Settled: within this share of the step."""
SUBSTEPS = 8
"""Integration steps of the ideal arm in one tick."""
LIGHTEST = 0.01
"""Mass of the hand that MuJoCo is given where nothing is carried, kg: it has no bodies without any."""
_LOST = 10.0
"""Times the size of the step beyond which a response has left for good."""

PlantName = Literal["rigid", "mujoco"]


class _Substepped(RigidPlant):
    """The ideal arm in ``SUBSTEPS`` of a tick under one torque.

    Its Euler step is half a step ahead of the motion under constant torque; a whole tick of that takes so much from
    the delay of the sampled loop that a badly damped axis would swing visibly less than it does.
    """

    def __init__(self, spec: RobotSpec, cell: CellSpec, tick_s: float) -> None:
        super().__init__(spec, cell, tick_s / SUBSTEPS)

    def step(self, tau: Array) -> bool:
        """Advance one tick under joint torques tau (n,)."""
        return all(super(_Substepped, self).step(tau) for _ in range(SUBSTEPS))


class _Locked(_Substepped):
    """The ideal arm of which only one axis moves: the one axis of the document's equations, D' ddq = tau - T.

    One axis alone makes no centrifugal torque on itself.
    """

    def __init__(self, spec: RobotSpec, cell: CellSpec, tick_s: float, axis: int) -> None:
        super().__init__(spec, cell, tick_s)
        self._axis = axis

    def step(self, tau: Array) -> bool:
        """Advance one tick under the torque of the free axis in tau (n,)."""
        axis = self._axis
        for _ in range(SUBSTEPS):
            inertia = self._model.mass_matrix(self.q)[axis, axis]
            self.dq[axis] += self.tick_s * (tau[axis] - self._model.gravity(self.q)[axis]) / inertia
            self.q[axis] += self.tick_s * self.dq[axis]
        return bool(np.isfinite(self.q[axis]))


@dataclass(frozen=True, slots=True, kw_only=True)
class StepRequest:
    """One experiment: ``axis`` 0-based, posture ``q`` (n,) rad, ``size`` rad, ``carried`` and ``declared`` payloads.

    Of an axis that slides they are m, here and in the result, forces N and inertias kg.

    ``ideal`` gives the drives no limits, ``locked`` holds the other axes fast (rigid arm only). ``tool`` is the tool
    point in the flange frame (3,) m, where the rated payload sits for fixed gains.
    """

    robot: RobotSpec
    axis: int
    q: Array
    size: float
    carried: Payload = NO_PAYLOAD
    declared: Payload = NO_PAYLOAD
    profile: Profile = field(default_factory=Profile)
    plant: PlantName = "rigid"
    ideal: bool = True
    locked: bool = False
    seconds: float = 1.5
    tool: Array | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StepResult:
    """The response of a step: angles in rad, times in s; None where it was never reached.

    ``t`` (N,) from the step on, ``response`` (N,) from the rest position. ``inertia`` is the true D' with the rotor,
    ``gain_inertia`` the D' in the velocity loop, kg m2.
    """

    t: Array
    response: Array
    overshoot: float | None
    settling: float | None
    rise: float | None
    droop: float
    inertia: float
    gain_inertia: float
    peak_torque: float
    stable: bool


def step(request: StepRequest) -> StepResult:
    """Run one step experiment; ``ValueError`` for an axis or a posture that the robot has not.

    ``Fault`` RBL516 where the arm touched itself or the floor: its response is not that of the servo then.
    """
    _check(request)
    robot = ideal_drives(request.robot) if request.ideal else request.robot
    # a step is a following error of its whole size, which supervision would stop (RBL511)
    profile = replace(request.profile, supervision=replace(request.profile.supervision, enabled=False))
    if request.plant == "rigid":  # no friction there, so there is none to compensate
        profile = replace(profile, servo=replace(profile.servo, friction_compensation=0.0))
    cell = _cell(robot, request)
    X_flange_tool = pose(np.zeros(3) if request.tool is None else request.tool, np.eye(3))
    plant = plant_of(cell, profile.tick_s, request.plant == "mujoco", _ideal_arm(request))
    known = replace(cell, hand=replace(cell.hand, X_flange_tool=X_flange_tool))
    controller = Rig.over(plant, known, profile).controller
    controller.load(request.declared)
    controller.jump(controller.areas.ina)
    _run(controller, HOLD_S)
    first = controller.recorder.tick
    controller.jump(request.q + request.size * np.eye(robot.n)[request.axis])
    # position errors count a mm as a deg
    counted = abs(request.size) / robot.bound(1.0)[request.axis]
    _run(controller, request.seconds, lost=float(np.maximum(_LOST * counted, np.pi)))
    _refuse_touch(request, controller)
    return _measure(request, controller, first)


def _check(request: StepRequest) -> None:
    robot = request.robot
    if request.locked and request.plant == "mujoco":
        raise ValueError("only the rigid arm can hold the other axes fast")
    if not 0 <= request.axis < robot.n:
        raise ValueError(f"{robot.name} has the axes 1 to {robot.n}")
    end = request.q[request.axis] + request.size
    for axis, value in [*enumerate(request.q), (request.axis, end)]:
        low, high = robot.lower[axis], robot.upper[axis]
        if not low <= value <= high:
            size, unit = robot.axes[axis].kind.size, robot.axes[axis].kind.unit
            shown, ends = f"{value / size:g} {unit}", f"{low / size:g} to {high / size:g} {unit}"
            raise ValueError(f"J{axis + 1} at {shown} is outside {ends}")


def _cell(robot: RobotSpec, request: StepRequest) -> CellSpec:
    """Return an empty cell whose hand has the mass and the centre of the carried payload."""
    cell = builtin_cell()
    mass = max(request.carried.mass, LIGHTEST if request.plant == "mujoco" else 0.0)
    hand = replace(cell.hand, mass=mass, cog=request.carried.cog)
    # without obstacles, since the posture may be anywhere in the joint ranges
    return replace(cell, robot=robot, home=request.q, hand=hand, parts=(), obstacles=())


def _ideal_arm(request: StepRequest) -> IdealArm:
    return partial(_Locked, axis=request.axis) if request.locked else _Substepped


def _run(controller: Controller, seconds: float, lost: float = np.inf) -> None:
    """Run for a time, or until an alarm or an error that nothing comes back from."""
    for _ in range(round(seconds / controller.profile.period_s)):
        if not controller.cycle() or not controller.position_error < lost:
            return


def _refuse_touch(request: StepRequest, controller: Controller) -> None:
    for touch in [] if controller.touches is None else controller.touches.records:
        raise Fault(
            "RBL516",
            f"in the step of J{request.axis + 1}, {touch.message}",
            "choose a smaller step, or a posture with more space around it",
        )


def _measure(request: StepRequest, controller: Controller, first: int) -> StepResult:
    axis, size, tick_s = request.axis, request.size, controller.profile.tick_s
    log = controller.signals()
    q, rest = log["q_link"][:, axis], log["q_link"][first - 1, axis]
    response = q[first:] - rest
    t = np.arange(len(response)) * tick_s
    last = response[-round(0.1 / tick_s) :]  # the last 0.1 s are taken as settled
    stable = not controller.alarms and len(response) * tick_s > 0.9 * request.seconds
    # at least 1e-4 rad, since a step of size 0 has no band
    least = float(request.robot.bound(1e-4)[axis])
    stable = stable and bool(np.ptp(last) <= max(BAND * abs(size), least))  # the run was cut short, or still moves
    model = ArmModel(request.robot)
    model.set_payload(request.carried)
    rotor = float(spec_rotors(request.robot)[axis])
    held = controller.servo.held_inertia
    # None: the gains follow the posture, and use D of the tick before the step
    used = log["D"][first - 1, axis] if held is None else held[axis]
    overshoot = settling = rise = None
    if size and stable:
        share = response / float(last.mean())
        # not max(), which returns 0 for NaN
        overshoot = float(np.maximum(0.0, share.max() - 1.0))
        outside = np.flatnonzero(~(np.abs(share - 1.0) <= BAND))
        settling = float(outside[-1] + 1) * tick_s if len(outside) else 0.0
        rise = float(np.argmax(share >= 0.9) - np.argmax(share >= 0.1)) * tick_s
    return StepResult(
        t=np.asarray(t, dtype=np.float64),
        response=response,
        overshoot=overshoot,
        settling=settling,
        rise=rise,
        droop=float(request.q[axis] + size - q[-1]),
        inertia=axis_inertia(model, request.q, axis) + rotor,
        gain_inertia=float(used) + float(rotors(request.robot, request.profile.servo)[axis]),
        peak_torque=float(np.abs(log["tau_sat"][first - 1 :, axis]).max()),
        stable=stable,
    )


def as_json(request: StepRequest, result: StepResult) -> dict[str, Any]:
    """Return the figures of an experiment in plain types, in deg, s and %, of an axis that slides mm, N and kg.

    The key of a figure names its unit; ``joints`` of an arm with such an axis are each in their own.
    """
    robot, kind = request.robot, request.robot.axes[request.axis].kind
    inertia = kind.inertia.replace(" ", "_")
    percent = None if result.overshoot is None else result.overshoot * 100.0
    return {
        "robot": robot.name,
        "axis": request.axis + 1,
        robot.joints_key: [float(x) for x in request.q / robot.units],
        f"size_{kind.unit}": request.size / kind.size,
        "plant": request.plant,
        "ideal_drives": request.ideal,
        "others_locked": request.locked,
        "servo": request.profile.servo.mode,
        f"inertia_{inertia}": result.inertia,
        f"gain_inertia_{inertia}": result.gain_inertia,
        "overshoot_pct": percent,
        "settling_s": result.settling,
        "rise_s": result.rise,
        f"droop_{kind.unit}": result.droop / kind.size,
        kind.force_key.replace("max", "peak"): result.peak_torque,
        "stable": result.stable,
    }
