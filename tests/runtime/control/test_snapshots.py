"""A controller that is taken back goes on as it did the first time, to the last byte; so does a new one."""

import dataclasses
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest

from runtime.cell.seam_sensor import SeamSensor
from runtime.control.controller import Controller
from runtime.core.state import State, Stateful
from runtime.motion.seam import SeamTracker
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload
from tests.campaign import size, some
from tests.runtime.control.script import PLANTS, SENSOR, STEPS, Script, controller, log_of, outcome

AHEAD = 50
"""Cycles that are run before the controller is taken back."""
STOPS = size(200, 16)


@cache
def uninterrupted(plant: str) -> tuple[int, dict[str, bytes], tuple[object, ...]]:
    script = Script(controller(plant))
    script.finish()
    return script.robot.recorder.cycle, log_of(script.robot), outcome(script.robot)


@pytest.mark.physics
@pytest.mark.parametrize("plant", PLANTS)
def test_a_run_that_is_taken_back_again_and_again_is_the_run_that_never_was(plant):
    cycles, log, rest = uninterrupted(plant)
    script = Script(controller(plant))
    robot, seen = script.robot, set()
    for stop in sorted(np.random.default_rng(14).choice(cycles, STOPS, replace=False)):
        while robot.recorder.cycle < stop:
            script.cycle()
        seen.add(script.state[0])
        kept, state = robot.snapshot(), script.state
        futures = []
        for _ in range(2):
            script.run(AHEAD)
            futures.append((log_of(robot), outcome(robot)))
            robot.restore(kept)
            script.state = state
        assert futures[0] == futures[1], (stop, state)
    script.finish()
    assert log_of(robot) == log
    assert outcome(robot) == rest
    assert len(seen) > len(STEPS) / 3


@pytest.mark.physics
@pytest.mark.parametrize("plant", PLANTS)
def test_a_new_controller_takes_a_run_over_with_its_log(plant):
    cycles, log, rest = uninterrupted(plant)
    first = Script(controller(plant))
    for stop in sorted(np.random.default_rng(15).choice(cycles, size(20, 3), replace=False)):
        while first.robot.recorder.cycle < stop:
            first.cycle()
        second = Script(controller(plant))
        second.robot.restore(first.robot.snapshot())
        second.state = first.state
        second.run(AHEAD)
        first.run(AHEAD // 2)  # the two run apart
        second.finish()
        assert log_of(second.robot) == log, stop
        assert outcome(second.robot) == rest
    first.finish()
    assert log_of(first.robot) == log


def test_two_futures_of_one_snapshot_do_not_mix_in_the_log():
    """Back to an early snapshot, on to another future, and to a later snapshot of the first: its log is the first."""
    script = Script(controller("rigid"))
    script.run(140)
    early, state = script.robot.snapshot(), script.state
    script.run(150)
    late, log = script.robot.snapshot(), log_of(script.robot)
    script.robot.restore(early)
    script.state = state
    script.robot.override = 0.5
    script.run(250)
    assert log_of(script.robot)["q_fb"][: len(log["q_fb"])] != log["q_fb"]
    script.robot.restore(late)
    assert log_of(script.robot) == log


@pytest.mark.physics
@pytest.mark.parametrize("plant", PLANTS)
def test_a_snapshot_outlives_what_happens_after_it(plant):
    """No array and no container of a snapshot is one that a running controller writes."""
    script = Script(controller(plant))
    for _ in range(8):
        script.run(100)
        kept, state = script.robot.snapshot(), script.state
        before = flat(kept)
        for _ in range(2):
            script.run(60)
            script.robot.restore(kept)
            script.state = state
        assert flat(kept) == before


def flat(value: Any) -> object:
    """Return a state as plain values that compare by content; rows of the log left out."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        state: Any = value
        if type(value).__name__ == "Block":
            return state.tick
        fields = [field.name for field in dataclasses.fields(value)]
        return type(value).__name__, [flat(getattr(value, name)) for name in fields]
    if isinstance(value, np.ndarray):
        return value.tobytes()
    if isinstance(value, np.random.Generator):
        return repr(value.bit_generator.state)
    if isinstance(value, SeamTracker | SeamSensor):
        return flat(vars(value))
    if isinstance(value, dict):
        return sorted((str(key), repr(flat(each))) for key, each in value.items())
    if isinstance(value, list | tuple):
        return [flat(each) for each in value]
    return value if isinstance(value, int | float | str | bool | frozenset | set | None) else type(value).__name__


@pytest.mark.physics
def test_an_invalid_plant_can_be_taken_back():
    robot = controller("mujoco")
    for _ in range(5):
        robot.cycle()
    kept = robot.snapshot()
    log = futures(robot, 20)
    robot.restore(kept)
    plant: Any = robot.plant
    plant._qvel[2] = np.nan
    assert not robot.cycle()
    assert robot.alarms[0].code == "RBL510"
    robot.restore(kept)
    assert not robot.alarms
    assert not robot.halted
    assert futures(robot, 20) == log


def futures(robot: Controller, cycles: int) -> dict[str, bytes]:
    for _ in range(cycles):
        assert robot.cycle()
    return log_of(robot)


@pytest.mark.physics
def test_a_held_part_is_held_after_going_back():
    """The contacts in mjData are not part of MuJoCo's state; what the hand holds is read from them."""
    script = Script(controller("mujoco"))
    while script.robot.plant.hand().holding is None:
        script.cycle()
    kept, held = script.robot.snapshot(), script.robot.plant.hand()
    new = controller("mujoco")
    new.restore(kept)
    assert new.plant.hand() == held
    assert new.plant.gripped() == script.robot.plant.gripped() == ("part",)
    assert new.plant.bodies.p.tobytes() == script.robot.plant.bodies.p.tobytes()


@pytest.mark.physics
def test_a_snapshot_of_another_rig_is_refused_and_changes_nothing():
    robot = controller("rigid")
    other = Script(controller("mujoco"))
    other.run(30)
    before = flat(robot.snapshot())
    with pytest.raises(ValueError, match="MujocoPlant does not fit a RigidPlant"):
        robot.restore(other.robot.snapshot())
    with pytest.raises(ValueError, match="of the robot irb2400"):
        robot.restore(dataclasses.replace(robot.snapshot(), robot="irb2400"))
    assert flat(robot.snapshot()) == before


@pytest.mark.physics
@pytest.mark.parametrize("plant", PLANTS)
def test_a_snapshot_is_small_and_does_not_grow_with_the_log(plant):
    script, sizes = Script(controller(plant)), []
    while script.cycle():
        if script.robot.recorder.cycle % 50 == 0:
            sizes.append(copied_bytes(script.robot.snapshot()))
    assert max(sizes) < 50_000
    assert sizes[-1] < sizes[0] + 5_000


def copied_bytes(value: object) -> int:
    """Return the bytes of the arrays that a state has to itself; read-only ones and the log are shared."""
    if isinstance(value, np.ndarray):
        return value.nbytes if value.flags.writeable else 0
    if isinstance(value, State):
        return sum(copied_bytes(each) for each in (*value.buffers, *value.values, *value.parts))
    if isinstance(value, list | tuple):
        return sum(copied_bytes(each) for each in value)
    if dataclasses.is_dataclass(value) and type(value).__name__ == "ControllerSnapshot":
        return sum(copied_bytes(getattr(value, field.name)) for field in dataclasses.fields(value))
    return 0


# --- every attribute is one or the other -----------------------------------------------------------------------------

CONSTANT = {
    "ArmModel": "n _X_last_flange _model _weightless _data _moments _weightless_data _bare_last _zero _units _upper",
    "LoadModel": "n _X_last_flange _model _weightless _data _moments _weightless_data _bare_last _zero _units _upper "
    "_to_joint",
    "InertiaRows": "_spec _source _tables _bare row",
    "DynamicsTask": "_areas _model _read_angles _load_mode _inertia_row _steps",
    "IdleProcessor": "",
    "Areas": "",
    "FineInterpolator": "ticks period_s _weights",
    "Interpolator": "",
    "RequestQueue": "planner _spec _areas _fine _limits",
    "StopLogic": "_requests _drives _period_us",
    "DriveTrain": "_spec _profile _task _held_inertia",
    "ServoAxes": "_smooth options coupled held_inertia encoders beta _Ktn _forward _backward _viscous",
    "Motors": "Ktn max_current _min_current _share",
    "ServoLaw": "gains _Kp _per_tick _tick_s _measured _sags _winds _rotor_rows _Ktn_column _Kv_row _windup_column",
    "Supervisor": "_kinds _limits _ticks _rated _collision _top _stale_us",
    "Watch": "_n _limits _ticks _tick_s _centre _speed _fast _moved _hold _longest_stand _lag _most_saturated"
    " _kinds _first_limit",
    "Observer": "_turning _smooth _ticks _period_s _triangle _forward _backward _coulomb _viscous _base _share _rated",
    "RigidPlant": "tick_s q_link _spec _cell",
}
"""Attributes that are set once and never written, or that are another name of a part or a buffer."""

ANEW = {
    "Motors": "_limited",
    "ServoLaw": "_gamma _work _extra _terms _velocity_gain _acceleration_gain _windup _gravity _sag reference _rows "
    "_coupled _velocity_rows _windup_rows _plan",
    "Watch": "_bound _away _inside _rows _error _repeated _detected _signed _command peak limit",
}
"""Attributes that are written in every cycle or tick before they are read."""

APART = {"Recorder", "Touches", "MujocoPlant"}
"""Classes that keep their state in another form; the byte tests above hold them."""
BY_HAND = {"RequestQueue": {"tracker"}, "Interpolator": {"seam"}}
"""Attributes that the queue copies itself."""


def parts_of(owner: Any) -> list[Any]:
    """Return an object and all its parts, and theirs."""
    if type(owner).__name__ in APART or owner is None:
        return []
    return [owner, *(part for name in owner.PARTS for part in parts_of(getattr(owner, name)))]


@pytest.mark.parametrize("source", ["pass", "recursion"])
def test_every_attribute_is_state_or_known_to_be_none(source):
    """A new attribute belongs to one of the lists of its class, or to those above with a reason."""
    robot = controller("rigid", inertia_source=source)
    parts = [part for part in (robot.requests, robot.drives, robot.stops) for part in parts_of(part)]
    assert {type(part).__name__ for part in parts} >= CONSTANT.keys() - {"InertiaRows" if source == "pass" else ""}
    for part in parts:
        name = type(part).__name__
        known = {*part.BUFFERS, *part.VALUES, *part.PARTS}
        other = {*CONSTANT[name].split(), *ANEW.get(name, "").split(), *BY_HAND.get(name, ())}
        assert set(vars(part)) - known - other == set(), name
        assert known | other <= set(vars(part)) | {"bodies"}, name


def test_the_controller_itself_has_no_state_but_late_cycles():
    robot = controller("rigid")
    kept = {field.name for field in dataclasses.fields(robot.snapshot())}
    assert set(vars(robot)) == (kept - {"robot", "time_us"}) | {
        "spec",
        "profile",
        "kinematics",
        "_clock",
        "paced",
        "_no_deviation",
    }


# --- every attribute comes back --------------------------------------------------------------------------------------

OWN_FORM = {
    "Recorder": "tick cycle _block",
    "Touches": "records _before _pairs _seen _closed _closing _held _lost _free _open _place _statement",
    "MujocoPlant": "_closed _touched _ncon _valid _last_qpos _last_qvel",
}
"""Attributes of the classes of ``APART`` on which the future depends."""
IN_DATA = (
    "qpos qvel ctrl qfrc_applied qacc_warmstart xpos xquat xmat xipos ximat geom_xpos geom_xmat site_xpos site_xmat"
)


def every_part(owner: Any) -> list[Any]:
    """Return an object and all its parts, and theirs, also where its class does not name them."""
    name = type(owner).__name__
    if name in APART or owner is None:
        return []
    return [owner, *(part for each in PART_NAMES.get(name, ()) for part in every_part(getattr(owner, each)))]


def attributes(robot: Controller) -> list[tuple[Any, str]]:
    """Return (owner, name) of all that the future depends on, of whatever the classes themselves name as state."""
    found: list[tuple[Any, str]] = [(robot, "late_cycles")]
    drives = robot.drives
    for part in [part for root in (robot.requests, drives, robot.stops) for part in every_part(root)]:
        name = type(part).__name__
        other = {*CONSTANT.get(name, "").split(), *ANEW.get(name, "").split(), *BY_HAND.get(name, ())}
        found += [(part, each) for each in sorted({*vars(part)} - other - {*PART_NAMES.get(name, ())})]
    for part in (robot.recorder, robot.plant, robot.touches):
        found += [(part, each) for each in OWN_FORM.get(type(part).__name__, "").split()]
    if type(robot.plant).__name__ == "MujocoPlant":
        plant: Any = robot.plant
        found += [(plant._data, each) for each in IN_DATA.split()]
    return found


PART_NAMES = {
    "IdleProcessor": ("_task",),
    "DynamicsTask": ("_loaded",),
    "InertiaRows": ("_model",),
    "RequestQueue": ("interpolator",),
    "DriveTrain": ("plant", "areas", "fine", "servo", "processor", "recorder", "supervisor", "touches"),
    "ServoAxes": ("law", "motors"),
    "Supervisor": ("watch", "observer"),
    "Observer": ("_model",),
    "RigidPlant": ("_model",),
}
"""Attributes that are objects with a state of their own."""


def contents(robot: Controller) -> dict[tuple[str, str, int], object]:
    """Return all that the future depends on, by content; trackers and the carried inertia as well."""
    seam = robot.requests.interpolator.seam
    values = {
        (type(owner).__name__, name, k): flat(getattr(owner, name)) for k, (owner, name) in enumerate(attributes(robot))
    }
    values["RequestQueue", "tracker", 0] = flat(robot.requests.tracker)
    values["Interpolator", "seam", 0] = None if seam is None else flat(vars(seam))
    for k, arm in enumerate(arms(robot)):
        values["ArmModel", "inertia", k] = arm._model.inertias[arm.n].toDynamicParameters().tobytes()
    return values


def arms(robot: Controller) -> list[Any]:
    every = [part for root in (robot.requests, robot.drives) for part in every_part(root)]
    return [part for part in every if isinstance(part, ArmModel)]


def damage(robot: Controller) -> None:
    """Give every attribute on which the future depends another value, in place where it is written in place."""
    for owner, name in attributes(robot):
        value = getattr(owner, name)
        if isinstance(value, np.ndarray) and name != "_X_tool_part" and value.flags.writeable and live(owner, name):
            value[...] = value + 1.0
        elif isinstance(value, list | set | dict):
            setattr(owner, name, type(value)())
            if not value:
                setattr(owner, name, {list: [0], set: {0}, dict: {0: 0}}[type(value)])
        elif (type(owner).__name__, name) not in LEFT_ALONE:
            setattr(owner, name, other_than(value))
    for arm in arms(robot):
        arm.set_payload(Payload(mass=0.7, cog=np.array([0.01, 0.02, 0.03])))
    queue: Any = robot.requests
    for moving in (queue.tracker, queue.interpolator.seam):
        if moving is not None:
            for name, value in vars(moving).items():
                if isinstance(value, np.ndarray | int | float | None):
                    setattr(moving, name, other_than(value))
    if queue.tracker is None:
        queue.tracker = SeamTracker("torch", SENSOR.limits, 8e-3, SeamSensor(SENSOR).read)
    else:
        queue.tracker._read(0.0, np.array([0.0, 1.0, 0.0]))


LEFT_ALONE = {("Touches", "_before")}
"""Poses of the touches that are written in place, damaged by ``live`` arrays of their own."""


def live(owner: Any, name: str) -> bool:
    """Return whether other objects hold views of an array, so that it must stay the same object."""
    return type(owner).__name__ in ("MujocoPlant", "MjData") or name in BUFFERS.get(type(owner).__name__, ())


BUFFERS = {
    "Areas": ("ang",),
    "FineInterpolator": ("_points",),
    "ServoAxes": ("alpha", "tau_cmd", "tau"),
    "ServoLaw": ("beta", "_alpha", "_beta_before"),
    "Motors": ("i",),
    "Watch": ("speed",),
    "RigidPlant": ("q", "dq"),
}
"""Arrays that are written in place."""


def other_than(value: Any) -> Any:
    """Return another value than this one, of the same type where that is plain."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, np.ndarray | int | float):
        return value + 1
    return (value, "damaged") if not isinstance(value, str) else value + "x"


STAGES = (30, 150, 420, 640)
"""Cycles with an empty hand, a blend, a seam, and what comes after it."""


@pytest.mark.physics
@pytest.mark.parametrize(("plant", "source"), some(list(product(PLANTS, ["pass", "recursion"])), 0, 3))
def test_every_attribute_on_which_the_future_depends_comes_back(plant, source):
    """Whatever has become of the controller: what is not restored is still damaged."""
    script = Script(controller(plant, inertia_source=source))
    robot = script.robot
    for stage in STAGES:
        script.run(stage - robot.recorder.cycle)
        kept, state, before = robot.snapshot(), script.state, contents(robot)
        damage(robot)
        robot.restore(kept)
        after = contents(robot)
        assert [name for name in before if before[name] != after.get(name)] == [], stage
        script.run(AHEAD)
        robot.restore(kept)
        script.state = state
        assert contents(robot) == before, stage


class Counter(Stateful):
    BUFFERS = ("row",)
    VALUES = ("names", "count")

    def __init__(self) -> None:
        self.row, self.names, self.count = np.zeros(2), ["a"], 0


def test_a_state_shares_nothing_that_can_be_written():
    counter = Counter()
    row = counter.row
    state = counter.snapshot()
    counter.row[0], counter.count = 5.0, 3
    counter.names.append("b")
    counter.restore(state)
    assert counter.row is row
    assert (counter.row.tolist(), counter.names, counter.count) == ([0.0, 0.0], ["a"], 0)
    counter.names.append("c")
    counter.restore(state)
    assert counter.names == ["a"]


def test_a_state_fits_its_class_alone():
    class Other(Counter):
        pass

    with pytest.raises(ValueError, match="the state of a Counter does not fit a Other"):
        Other().restore(Counter().snapshot())
    assert isinstance(Counter().snapshot(), State)
