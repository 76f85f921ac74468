"""The test motions of an identification, planned and checked before anything moves (``identify``, document 003).

They keep the arm over the ground and, on a plant with contacts, out of itself, by the shapes that such a plant has.

``plan`` is for one axis: the posture in which the others are held, the places that it passes, and the quintic motion
past them. ``plan_table`` is for the grid of postures over the joints beyond the axis; at each it passes one place.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Literal

import numpy as np

from robolang.project.project import builtin_cell
from runtime.cell.cell import CellSpec
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.rounding import beside
from runtime.core.units import DEG
from runtime.dynamics.equations import axis_inertia
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.motor import torque_limit
from runtime.settings.profile import Profile

STROKE = 0.5
"""Length of a test motion, rad, where the range has room for it."""
LEAST_STROKE = 0.1
"""Shorter than this an axis is not identified, rad."""
MARGIN = 2.0 * DEG
"""Distance that test motions keep from the ends of the range, rad."""
SHARE = 0.5
"""Share of the speed and acceleration limits that test motions use."""
TORQUE_SHARE = 0.75
"""Share of the torque limit that they use by the model, which may be wrong by 20 %."""
PEAK = 0.5 - np.sqrt(3.0) / 6.0
"""Share of the duration at which the quintic accelerates most."""
CLEARANCE = 0.2
"""Least height of every joint and the flange over the ground in a safe posture, m."""
LONGEST = 3.0
"""A test motion that needs longer than this times its shortest for want of torque is refused."""
NEAR = 0.05
"""How near the mean inertia a posture is near enough."""
TABLE_JOINTS = (1, 2)
"""Joints over which a table is made, where they are beyond its axis: the inertia depends most on them."""
RASTER = 25
"""Angles of each joint at which it is checked where a table may reach."""

LIGHTEST = 0.01
"""Mass of the hand that MuJoCo is given where nothing is carried, kg; it is declared as well."""

PlantName = Literal["rigid", "mujoco"]
Folds = Callable[[Array], bool]
"""Whether the arm would be in itself at joint angles (n,) rad."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What to identify: ``axes`` 0-based, each at ``positions`` places; ``payload`` is carried and declared.

    ``robot`` is the controller's model; the plant is ``real``, by default the same. ``table`` angles of each joint make
    the grid of postures of a table; 0: none.
    """

    robot: RobotSpec
    axes: tuple[int, ...]
    positions: int = 5
    plant: PlantName = "mujoco"
    real: RobotSpec | None = None
    payload: Payload = field(default=NO_PAYLOAD)
    profile: Profile = field(default_factory=Profile)
    table: int = 0

    def places(self, axis: int) -> int:
        """Return how many places axis ``axis`` (0-based) passes, those of its table among them."""
        joints = _table_joints(self, axis)
        return self.positions + (self.table ** len(joints) if joints else 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Test:
    """The test motions of one axis: home ``q`` (n,) rad, ``positions`` (P,) rad, ``stroke`` rad, ``rows`` (K + 1,).

    ``rows`` goes from 0 to ``stroke``, a set-point every cycle.
    """

    axis: int
    q: Array
    positions: Array
    stroke: float
    rows: Array

    def starts(self, position: float) -> tuple[float, float]:
        """Return where the accelerating and the braking pass of a position start, rad."""
        before = self.stroke * float(quintic(np.array(PEAK)))
        return position - before, position - (self.stroke - before)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """The postures of a table: ``angles`` (K,) rad of each of ``joints`` (0-based), one test each, row-major."""

    joints: tuple[int, ...]
    angles: tuple[Array, ...]
    tests: tuple[Test, ...]


def plan(request: Request, payload: Payload, axis: int) -> Test:
    """Return the test motions of an axis; ``Fault`` RBL420 when they would leave a limit of the robot."""
    spec = request.robot
    _refuse_slides(spec)
    if not 0 <= axis < spec.n:
        raise Fault("RBL420", f"{spec.name} has the axes 1 to {spec.n}, no J{axis + 1}")
    model = _loaded(spec, payload)
    return _planned(request, model, axis, *posture(spec, model, axis, folds(request)), request.positions)


def _refuse_slides(spec: RobotSpec) -> None:
    """Refuse an arm with an axis that slides; ``Fault`` RBL703."""
    for number, axis in enumerate(spec.axes, 1):
        if axis.kind.slides:
            message = f"J{number} of {spec.name} slides, and an identification is for arms whose axes all turn"
            why = "its test motions and its file are in deg and kg m2"
            raise Fault("RBL703", f"{message}: {why}", "Take an arm whose axes all turn.")


def bench(request: Request) -> CellSpec:
    """Return the cell of an identification: empty, with a hand of the mass and the centre of the payload."""
    cell, payload = builtin_cell(), request.payload
    mass = max(payload.mass, LIGHTEST if request.plant == "mujoco" else 0.0)
    hand = replace(cell.hand, mass=mass, cog=payload.cog, X_flange_tool=np.eye(4))
    return replace(cell, robot=request.robot, hand=hand, parts=(), obstacles=())


def folds(request: Request) -> Folds:
    """Return what knows where the arm of a request would be in itself: nowhere on a plant without contacts."""
    spec = request.robot
    if request.plant != "mujoco" or not spec.link_radii:
        return lambda q: False
    # only here: it imports MuJoCo, which the ideal arm does not need
    from runtime.plant.shapes import Shapes

    # the home of the built-in cell is that of another robot, which may have another number of axes
    shapes = Shapes(spec, replace(bench(request), home=0.5 * (spec.lower + spec.upper)))
    return lambda q: shapes.folded(q) is not None


def plan_table(request: Request, payload: Payload, test: Test) -> Grid | None:
    """Return the tests of an axis' table, None when it has none; ``Fault`` RBL420 when there is no room for one.

    The grid spans the largest rectangle of a raster of ``RASTER`` angles of each joint, ``MARGIN`` off the ends of its
    range, in all of whose postures the axis has room for the least test motion with all of the arm over the ground and
    out of itself. As long as a point of the grid itself has none, the rectangle is shrunk by a raster step on every
    side.
    """
    joints = _table_joints(request, test.axis)
    if not joints:
        return None
    postures = _Postures(request=request, test=test, joints=joints, folded=folds(request))
    grid = _grid(postures)
    model = _loaded(request.robot, payload)
    tests = tuple(_table_test(postures, model, angles) for angles in product(*grid))
    return Grid(joints=joints, angles=grid, tests=tests)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Postures:
    """The postures of a table: those of a test with other angles (rad) of ``joints`` (0-based), and their room."""

    request: Request
    test: Test
    joints: tuple[int, ...]
    folded: Folds

    def at(self, angles: tuple[float, ...]) -> Array:
        """Return the posture (n,) rad."""
        q = np.array(self.test.q)
        q[list(self.joints)] = angles
        return q

    def room(self, angles: tuple[float, ...], within: float = np.inf) -> tuple[float, float]:
        """Return the ends of the free range of the axis, rad, at most ``within`` rad from its middle."""
        spec, axis, q = self.request.robot, self.test.axis, self.at(angles)
        low, high = _room(spec, q, axis)
        middle = 0.5 * (spec.lower[axis] + spec.upper[axis])
        return _unfolded(spec, q, axis, (max(low, middle - within), min(high, middle + within)), self.folded)

    def safe(self, angles: tuple[float, ...]) -> bool:
        """Return whether the axis has room for the least test motion."""
        spec, axis = self.request.robot, self.test.axis
        step = (spec.upper[axis] - spec.lower[axis]) / (2 * _SCAN)
        # folding costs a collision check each; past twice the least stroke and one scan step the answer is known
        low, high = _usable(spec, axis, self.room(angles, 2.0 * LEAST_STROKE + step))
        return high - low >= 2.0 * LEAST_STROKE


def _rectangle(postures: _Postures) -> tuple[list[Array], list[float]]:
    """Return the ends (2,) rad of each joint in the largest rectangle of safe postures, and the steps of the raster."""
    spec, joints = postures.request.robot, postures.joints
    raster = [np.linspace(spec.lower[joint] + MARGIN, spec.upper[joint] - MARGIN, RASTER) for joint in joints]
    fits = np.array([postures.safe(angles) for angles in product(*raster)]).reshape([RASTER] * len(joints))
    ends = [values[list(span)] for values, span in zip(raster, _largest(fits), strict=True)]
    return ends, [float(values[1] - values[0]) for values in raster]


def _grid(postures: _Postures) -> tuple[Array, ...]:
    """Return the angles (K,) rad of each joint of a table; ``Fault`` RBL420 when there is no room for one."""
    ends, steps = _rectangle(postures)
    while all(high - low >= LEAST_STROKE for low, high in ends):
        # whole hundredths of a degree: the sidecar file shows the angles in degrees
        grid = tuple(np.round(np.linspace(low, high, postures.request.table) / DEG, 2) * DEG for low, high in ends)
        if all(postures.safe(angles) for angles in product(*grid)):
            return grid
        ends = [values + [step, -step] for values, step in zip(ends, steps, strict=True)]
    over = " and ".join(f"J{joint + 1}" for joint in postures.joints)
    raise Fault(
        "RBL420",
        f"J{postures.test.axis + 1} has no room for a table over {over}: too few postures have all of the "
        "arm over the ground and out of itself",
    )


def _table_test(postures: _Postures, model: ArmModel, angles: tuple[float, ...]) -> Test:
    """Return the test of one posture of a table; a ``Fault`` names the posture."""
    try:
        return _planned(postures.request, model, postures.test.axis, postures.at(angles), postures.room(angles), 1)
    except Fault as fault:
        named = zip(postures.joints, angles, strict=True)
        where = ", ".join(f"J{joint + 1} {angle / DEG:.1f}" for joint, angle in named)
        raise Fault(fault.code, f"{fault.message}, in the posture {where} deg of its table", fault.hint) from None


def _table_joints(request: Request, axis: int) -> tuple[int, ...]:
    # the inertia about an axis depends on the joints beyond it alone
    return tuple(j for j in TABLE_JOINTS if axis < j < request.robot.n) if request.table else ()


def _largest(fits: Array) -> list[tuple[int, int]]:
    """Return first and last index of each dimension of the largest block of a (R,) or (R, R) raster that fits."""
    plane = fits.reshape(len(fits), -1)
    best, found = 0, [(0, 0)] * 2
    for first in range(len(plane)):
        row = np.ones(plane.shape[1], dtype=bool)
        for last in range(first, len(plane)):
            row = row & plane[last]
            edges = np.flatnonzero(np.diff(np.concatenate([[False], row, [False]])))
            for start, end in edges.reshape(-1, 2).tolist():
                if (last - first + 1) * (end - start) > best:
                    best, found = (last - first + 1) * (end - start), [(first, last), (start, end - 1)]
    # of one joint the plane has a single column, whose span is not needed
    return found[: fits.ndim]


def _loaded(spec: RobotSpec, payload: Payload) -> ArmModel:
    model = ArmModel(spec)
    model.set_payload(payload)
    return model


def _usable(spec: RobotSpec, axis: int, room: tuple[float, float]) -> tuple[float, float]:
    limits = spec.axes[axis].limits
    return max(limits.lower + MARGIN, room[0]), min(limits.upper - MARGIN, room[1])


def _planned(request: Request, model: ArmModel, axis: int, q: Array, room: tuple[float, float], places: int) -> Test:
    """Return the test motions at ``places`` places within ``room`` rad, the other axes held at q (n,) rad."""
    spec, profile = request.robot, request.profile
    limits = spec.axes[axis].limits
    low, high = _usable(spec, axis, room)
    before = float(quintic(np.array(PEAK)))
    # the two passes of a place reach nearly a whole stroke to either side of it (``reach`` below)
    stroke = min(STROKE, (high - low) / 2.0)
    if not stroke >= LEAST_STROKE:
        there, least = beside(max(0.0, high - low) / DEG, round(2.0 * LEAST_STROKE / DEG, 1), form=".1f")
        raise Fault(
            "RBL420",
            f"J{axis + 1} has {there} deg over the ground, free of the arm itself and "
            f"{MARGIN / DEG:g} deg off the ends of its range, {limits.lower / DEG:.1f} to "
            f"{limits.upper / DEG:.1f} deg; the test motions need {least}",
        )
    reach = stroke * (1.0 - before)
    positions = np.linspace(low + reach, high - reach, places) if places > 1 else np.array([0.5 * (low + high)])
    shortest = np.maximum(
        np.sqrt(_PEAK_ACCELERATION * stroke / (SHARE * limits.acceleration)),
        _PEAK_SPEED * stroke / (SHARE * limits.speed),
    )
    # slower needs less torque, and gives less acceleration to identify from: the fastest that fits is taken
    for slower in np.geomspace(1.0, LONGEST, 8):
        cycles = int(np.ceil(slower * shortest / profile.period_s))
        test = Test(
            axis=axis, q=q, positions=positions, stroke=stroke, rows=stroke * quintic(np.arange(cycles + 1) / cycles)
        )
        refusal = _refusal(spec, profile, model, test)
        if not refusal:
            return test
    raise Fault("RBL420", refusal)


def _refusal(spec: RobotSpec, profile: Profile, model: ArmModel, test: Test) -> str:
    """Return which limit a test motion would leave, where and by what; empty: none."""
    torque = TORQUE_SHARE * torque_limit(spec)
    lower, upper = spec.lower, spec.upper
    rotor, friction = spec_rotors(spec), _friction(spec)
    for position in test.positions:
        for start in test.starts(float(position)):
            rows = np.tile(test.q, (len(test.rows), 1))
            rows[:, test.axis] = start + test.rows
            q, dq, ddq = FineInterpolator(profile.ticks_per_cycle, profile.period_s, rows[0]).expand(rows)
            tau = np.array([model.torque(*motion) for motion in zip(q, dq, ddq, strict=True)])
            # the model has links only; the motor turns its rotor and works against friction as well
            tau += rotor * ddq + friction * np.sign(dq) + spec.per_axis("motor", "joint_viscous_friction") * dq
            for what, unit, values, least, most in (
                ("angle", "deg", q, lower, upper),
                ("speed", "deg/s", dq, *_both(spec.per_axis("limits", "speed"))),
                ("acceleration", "deg/s2", ddq, *_both(spec.per_axis("limits", "acceleration"))),
                ("torque", "N m", tau, *_both(torque)),
            ):
                beyond = np.maximum(least - values, values - most).max(axis=0)
                axis = int(np.argmax(beyond))
                if not beyond[axis] <= 1e-9:
                    worst = values[np.argmax(np.abs(values[:, axis])), axis]
                    scale = 1.0 if unit == "N m" else DEG
                    return (
                        f"J{test.axis + 1} at {position / DEG:.1f} deg: the test motion takes the {what} of "
                        f"J{axis + 1} to {worst / scale:.1f} {unit}, beyond {least[axis] / scale:.1f} to "
                        f"{most[axis] / scale:.1f}"
                    )
    return ""


def _both(limit: Array) -> tuple[Array, Array]:
    return -limit, limit


def _friction(spec: RobotSpec) -> Array:
    return np.array([max(axis.motor.joint_coulomb_friction) for axis in spec.axes])


def posture(spec: RobotSpec, model: ArmModel, axis: int, folded: Folds) -> tuple[Array, tuple[float, float]]:
    """Return q (n,) rad at which the other axes are held, and the range of the axis that is free, rad.

    Free is what is over the ground and where the arm is not in itself.

    The posture is one near the middle of the ranges with the model's D_ii near its mean over the ranges, preferably
    such that the axis can go through its whole range.
    """
    rng = np.random.default_rng(560)  # a seed of its own: the same robot gets the same test motions in every run
    middle, width = 0.5 * (spec.lower + spec.upper), spec.upper - spec.lower
    mean = np.mean([axis_inertia(model, q, axis) for q in rng.uniform(spec.lower, spec.upper, (200, spec.n))])
    offsets = rng.uniform(-1.0 / 3.0, 1.0 / 3.0, (300, spec.n))
    offsets[:, : axis + 1] = 0.0  # D_ii does not depend on these
    offsets = np.concatenate([np.zeros((1, spec.n)), offsets[np.argsort((offsets**2).sum(axis=1), kind="stable")]])
    best, room, least = middle, (float(middle[axis]), float(middle[axis])), float("inf")
    for q in middle + offsets * width:
        free, off = _room(spec, q, axis), float(abs(axis_inertia(model, q, axis) / mean - 1.0))
        if off + _lacks(free, width[axis]) < least:  # the shapes take longer
            free = _unfolded(spec, q, axis, free, folded)
        if off + _lacks(free, width[axis]) < least:
            best, room, least = q, free, off + _lacks(free, width[axis])
        if least <= NEAR:
            break
    return np.asarray(best), room


def _room(spec: RobotSpec, q: Array, axis: int) -> tuple[float, float]:
    """Return the angles around the middle of an axis' range, rad, where joints and flange keep ``CLEARANCE``."""
    X, points = np.eye(4), []
    for index, joint in enumerate(spec.axes):
        X = matmul(X, joint.placement)
        if index == axis:
            up, X = X[2], np.eye(4)  # from here on in the frame of the axis, before it turns
        elif index > axis:
            points.append(X[:, 3])
        if index != axis:
            c, s = np.cos(q[index]), np.sin(q[index])
            turn = np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
            X = matmul(X, turn)
    x, y, z, _ = np.array([*points, matmul(X, spec.X_last_flange)[:, 3]]).T
    own = np.linspace(spec.lower[axis], spec.upper[axis], 2 * _SCAN + 1)[:, None]
    c, s = np.cos(own), np.sin(own)
    # the third row of every point's pose in the world, for all angles of the axis at once
    height = up[0] * (c * x - s * y) + up[1] * (s * x + c * y) + up[2] * z + up[3]
    low_places = np.flatnonzero(height.min(axis=1) < CLEARANCE)
    # a middle that is low itself is in both: ``first`` is then over ``last``, and there is no room
    before, after = low_places[low_places <= _SCAN], low_places[low_places >= _SCAN]
    first = int(before.max()) + 1 if len(before) else 0
    last = int(after.min()) - 1 if len(after) else 2 * _SCAN
    return (float(own[first, 0]), float(own[last, 0])) if first <= last else (float(own[_SCAN, 0]),) * 2


def _lacks(room: tuple[float, float], width: float) -> float:
    """Return half the share of a range of ``width`` rad that is not free."""
    return 0.5 * (1.0 - (room[1] - room[0]) / width)


def _unfolded(spec: RobotSpec, q: Array, axis: int, room: tuple[float, float], folded: Folds) -> tuple[float, float]:
    """Return the angles of a room around the middle of an axis' range, rad, where the arm is a step off itself."""
    own = np.linspace(spec.lower[axis], spec.upper[axis], 2 * _SCAN + 1)
    inside = np.flatnonzero((own >= room[0]) & (own <= room[1]))
    row, ends = np.array(q), []
    for step, end in ((-1, int(inside[0])), (1, int(inside[-1]))):
        ends.append(end)
        for index in range(_SCAN, end + step, step):
            row[axis] = own[index]
            if folded(row):
                ends[-1] = index - 2 * step  # a step off the last free angle: the touch begins between two of them
                break
    first, last = (float(own[index]) for index in ends)
    return (first, last) if first <= last else (float(own[_SCAN]),) * 2


def quintic(s: Array) -> Array:
    """Return the share of its stroke that a test motion has gone at the share s of its duration."""
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s * s))


# steps from the middle of a range to each of its ends
_SCAN = 90
# of the quintic over a stroke and a duration of 1: its speed at s = 1/2, its acceleration at s = ``PEAK``
_PEAK_SPEED = 1.875
_PEAK_ACCELERATION = 10.0 / np.sqrt(3.0)
