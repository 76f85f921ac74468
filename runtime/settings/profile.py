"""The controller profile: cycle, declared costs and options, each setting declared once (``setting``).

To add a setting, add a field: its declaration gives key, unit, range and default, and its docstring the reason. Which
file or option a value is taken from is in ``layers``. Times in whole microseconds. Sources: docs/timing.md (costs) and
docs/servo.md (Kf, Ka, K2, feed-forward source).
"""

import math
from typing import Literal

from runtime.core.record import Record
from runtime.core.tomlfile import Table
from runtime.core.units import PERCENT
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.load_rules import LoadMode
from runtime.settings.setting import choice, custom, each_axis, flag, group, number, text, three, whole
from runtime.settings.supervision import SupervisionLimits

ServoMode = Literal["scheduled", "fixed"]
FixedAt = Literal["min", "mid", "max"]
Coupling = Literal["diagonal", "full"]
FeedforwardSource = Literal["command", "measured"]
SpeedShape = Literal["jerk", "trapezoid"]
InertiaSource = Literal["pass", "recursion", "matrix"]
WristMode = Literal["auto", "keep"]
WristShape = Literal["smooth", "linear", "hermite"]
PostureLaw = Literal["axis", "rpy"]

# each divides the cycle of 8 ms, which must have a whole number of ticks (docs/timing.md)
SERVO_PERIODS_MS = (0.25, 0.5, 1.0)


def _servo_period(table: Table, name: str) -> float:
    value = table.number(name, positive=True)
    if value not in SERVO_PERIODS_MS:
        table.fail("RBL605", f"'{name}' is {value:g}; it must be 0.25, 0.5 or 1", key=name)
    return value


def _acceleration(table: Table, name: str) -> float | str:
    if not table.holds(name, str):
        return table.number(name, positive=True, high=100.0)
    if (word := table.text(name)) != "max":
        hint = 'give a number above 0 to 100, per cent, or "max"'
        table.fail("RBL610", f"'{name}' is '{word}', neither a number nor \"max\"", hint, key=name)
    return word


def _share(value: float | str) -> float:
    return math.inf if isinstance(value, str) else value * PERCENT  # ``runtime.motion.commands.MAX``


def _us(milliseconds: float) -> int:
    return round(milliseconds * 1000)  # whole: no float accumulates time (docs/timing.md)


def _seconds_us(seconds: float) -> int:
    return round(seconds * 1e6)


class ServoOptions(Record):
    """How the servo law is applied.

    ``fixed_at``: where in its range the inertia of each axis is held when ``mode`` is fixed. ``coupling`` full takes
    the whole row of the mass matrix in (6), (9) and (10), diagonal its own element; fixed gains have the element
    only. ``velocity_feedforward`` Kf, ``acceleration_feedforward`` Ka and ``spring_compensation`` K2 of eqs (8), (10)
    and (6); ``gravity_lead`` KG adds the wind-up under the weight to (6); ``gravity_compensation`` scales T in (11).
    With ``command`` as source Kf = Ka = 1 is exact; with ``measured``, the literal reading, they must stay below 1,
    and they and K2 default to 0. ``friction_compensation`` scales the published friction that is added to the current
    (not in the document; docs/decisions/0003). The bandwidths, 1/s, one for all axes or one each, replace those of
    the robot file; empty: the robot file's.
    ``compensation``: file of an identification, whose contents are in the next three.
    ``rotors``: N^2 Jc of a compensation file, kg m2 at the joint, one each,
    in place of N^2 J (docs/identification.md); empty: the robot file's rotors. ``rotor_tables``: what the file says
    beyond ``rotors`` by posture, one each or None, kg m2 at the joint; it is published with D. Empty: nothing.
    ``first_moments``: what the links have beyond the model by that file, kg m in link frames, one each; it is in T.
    """

    mode: ServoMode = choice("mode", "scheduled", "fixed")
    fixed_at: FixedAt = choice("fixed_at", "mid", "min", "max")
    coupling: Coupling = choice("coupling", "full", "diagonal")
    source: FeedforwardSource = choice("feedforward", "command", "measured")
    velocity_feedforward: float = number("velocity_feedforward", 1.0, low=0.0, high=1.0)
    acceleration_feedforward: float = number("acceleration_feedforward", 1.0, low=0.0, high=1.0)
    spring_compensation: float = number("spring_compensation", 1.0, low=0.0, high=2.0)
    gravity_lead: float = number("gravity_lead", 1.0, low=0.0, high=2.0)
    gravity_compensation: float = number("gravity_compensation", 1.0, low=0.0, high=2.0)
    friction_compensation: float = number("friction_compensation", 1.0, low=0.0, high=2.0)
    position_bandwidth: tuple[float, ...] = each_axis("position_bandwidth_rad_s", "1/s")
    velocity_bandwidth: tuple[float, ...] = each_axis("velocity_bandwidth_rad_s", "1/s")
    compensation: str = text("compensation")
    # no keys: read from the file that ``compensation`` names
    rotors: tuple[float, ...] = ()
    rotor_tables: tuple[JointTable | None, ...] = ()
    first_moments: tuple[tuple[float, ...], ...] = ()


class WristOptions(Record):
    """When and how a straight move leaves its posture to change the wrist (``runtime.motion.wrist.switch``,
    docs/wrist.md).

    ``mode`` for moves that name none. C1 ``speed_condition``; C2 ``remaining_time`` s and ``remaining_distance`` m, 0
    for off; C3 ``range_condition``, ``look_ahead`` cycles; C4 ``deviation_condition``, ``deviation`` rad of J4 to
    J6; C6 ``guard``. ``speed`` theta_kd of the three, rad/s, empty: the robot's limits. ``shape`` of the wrist's curve
    and ``width`` of its soft start. ``posture``: law of the orientation along the path. A path that ends as taught is
    slowed by up to ``posture_first`` rather than left; the tool turns at most ``most_deviation`` rad from its posture,
    and at most ``untaught_deviation`` where a pose is taught and no angles. ``remedies``: whether other curves are
    planned where that of the document breaks a limit.
    """

    mode: WristMode = choice("mode", "auto", "keep")
    speed_condition: Literal["any", "all", "off"] = choice("speed_condition", "any", "all", "off")
    remaining_time: float = number("remaining_time_s", 0.0, "s", low=0.0, high=600.0)
    remaining_distance: float = number("remaining_distance_mm", 0.0, "mm", low=0.0, high=20_000.0)
    range_condition: bool = flag("range_condition", True)
    look_ahead: int = whole("look_ahead_cycles", 10, "cycles", low=0, high=1000)
    deviation_condition: Literal["moving", "start", "end", "off"] = choice(
        "deviation_condition", "moving", "start", "end", "off"
    )
    deviation: tuple[float, ...] = three("deviation_deg", (90.0, 180.0, 90.0), "deg")
    guard: bool = flag("guard", True)
    speed: tuple[float, ...] = three("speed_deg_s", (), "deg/s")
    shape: WristShape = choice("shape", "smooth", "linear", "hermite")
    width: float = number("soft_start", 0.5, positive=True, high=1.0)
    posture: PostureLaw = choice("posture", "axis", "rpy")
    posture_first: float = number("posture_first", 2.0, low=1.0, high=20.0)
    most_deviation: float = number("most_deviation_deg", 180.0, "deg", low=0.0, high=180.0)
    untaught_deviation: float = number("untaught_deviation_deg", 45.0, "deg", low=0.0, high=180.0)
    remedies: bool = flag("remedies", True)

    def only(self, *, range_condition: bool = False, guard: bool = False) -> "WristOptions":
        """Return the options with no condition but these."""
        return self.replaced(
            speed_condition="off",
            remaining_time=0.0,
            remaining_distance=0.0,
            range_condition=range_condition,
            deviation_condition="off",
            guard=guard,
        )

    @property
    def peak(self) -> float:
        """Largest wrist speed of a shape over that of the linear one, started from rest."""
        return {"linear": 1.0, "hermite": 1.6, "smooth": 1.0 / (1.0 - self.width / 2.0)}[self.shape]


class Profile(Record):
    """Cycle times, declared costs and options of a controller."""

    period_us: int = 8000  # no key: the cycle of JPH06190750A
    tick_us: int = custom("servo_period_ms", 1.0, "ms", _servo_period, _us)
    # 3 ms and 1 ms are declared, and no claim about a processor (docs/decisions/0006)
    interpolation_cost_us: int = number("interpolation_cost_ms", 3.0, "ms", si=_us, low=0.0, high=80.0)
    # above 0: a dynamics task that costs nothing would never use up the idle time
    axis_cost_us: int = number("dynamics_cost_per_axis_ms", 1.0, "ms", si=_us, low=0.001, high=1000.0)
    load_mode: LoadMode = choice("load_mode", "add", "replace")
    inertia_source: InertiaSource = choice("inertia_source", "pass", "recursion", "matrix")
    speed_shape: SpeedShape = choice("speed_shape", "jerk", "trapezoid")
    # of moves without ACCEL, a share of the robot's; infinite: the joints alone decide
    acceleration: float = custom("acceleration", 100.0, "%", _acceleration, _share)
    in_position: float = number("in_position_deg", 0.05, "deg", positive=True, high=10.0)
    settle_timeout_us: int = number("settle_timeout_s", 0.4, "s", si=_seconds_us, low=0.0, high=60.0)
    servo: ServoOptions = group("servo", ServoOptions)
    wrist: WristOptions = group("wrist", WristOptions)
    supervision: SupervisionLimits = group("supervision", SupervisionLimits)

    @property
    def ticks_per_cycle(self) -> int:
        """Servo ticks in an interpolation cycle."""
        return self.period_us // self.tick_us

    @property
    def tick_s(self) -> float:
        """Servo period, s."""
        return self.tick_us * 1e-6

    @property
    def period_s(self) -> float:
        """Interpolation period, s."""
        return self.period_us * 1e-6
