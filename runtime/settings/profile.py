"""The controller profile: cycle, declared costs and servo options, with the defaults and their reasons.

A setting is taken from the first of these that gives it: an option of the command line, the profile file, the cell's
``[controller]``, the robot file (bandwidths only), the default. ``Settings`` keeps with every value where it came
from, so that a value that cannot be used is refused at its own place and ``robolang config show`` can say it.
A profile file has ``schema = 1`` and the same ``[controller]`` table as a cell. Times in whole microseconds. Sources:
docs/timing.md (costs) and docs/servo.md (Kf, Ka, K2, feed-forward source).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, NoReturn, cast

from runtime.core.faults import Fault, raise_all
from runtime.core.tomlfile import FileFault, Source, Table, inside, load_table, read_source
from runtime.core.units import DEG, MM
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.load_rules import LoadMode
from runtime.settings.supervision import Reaction, SupervisionLimits

ServoMode = Literal["scheduled", "fixed"]
FixedAt = Literal["min", "mid", "max"]
Coupling = Literal["diagonal", "full"]
FeedforwardSource = Literal["command", "measured"]
SpeedShape = Literal["jerk", "trapezoid"]
InertiaSource = Literal["pass", "recursion", "matrix"]
WristMode = Literal["auto", "keep"]
WristShape = Literal["smooth", "linear", "hermite"]
PostureLaw = Literal["axis", "rpy"]

SERVO_PERIODS_MS = (0.25, 0.5, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoOptions:
    """How the servo law is applied.

    ``fixed_at``: where in its range the inertia of each axis is held when ``mode`` is fixed. ``coupling`` full takes
    the whole row of the mass matrix in (6), (9) and (10), diagonal its own element; fixed gains have the element
    only. ``velocity_feedforward`` Kf, ``acceleration_feedforward`` Ka and ``spring_compensation`` K2 of eqs (8), (10)
    and (6); ``gravity_lead`` KG adds the wind-up under the weight to (6); ``gravity_compensation`` scales T in (11).
    With ``command`` as source Kf = Ka = 1 is exact; with ``measured``, the literal reading, they must stay below 1,
    and they and K2 default to 0. ``friction_compensation`` scales the published friction that is added to the current
    (not in the document; docs/decisions/0003). The bandwidths, 1/s, one for all axes or one each, replace those of
    the robot file; empty: the robot file's. ``rotors``: N^2 Jc of a compensation file, kg m2 at the joint, one each,
    in place of N^2 J (docs/identification.md); empty: the robot file's rotors. ``rotor_tables``: what the file says
    beyond ``rotors`` by posture, one each or None, kg m2 at the joint; it is published with D. Empty: nothing.
    ``first_moments``: what the links have beyond the model by that file, kg m in link frames, one each; it is in T.
    """

    mode: ServoMode = "scheduled"
    fixed_at: FixedAt = "mid"
    coupling: Coupling = "full"
    source: FeedforwardSource = "command"
    velocity_feedforward: float = 1.0
    acceleration_feedforward: float = 1.0
    spring_compensation: float = 1.0
    gravity_lead: float = 1.0
    gravity_compensation: float = 1.0
    friction_compensation: float = 1.0
    position_bandwidth: tuple[float, ...] = ()
    velocity_bandwidth: tuple[float, ...] = ()
    rotors: tuple[float, ...] = ()
    rotor_tables: tuple[JointTable | None, ...] = ()
    first_moments: tuple[tuple[float, ...], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class WristOptions:
    """When and how a straight move leaves its posture to change the wrist (``runtime.motion.wrist.switch``,
    docs/wrist.md).

    ``mode`` for moves that name none. C1 ``speed_condition``; C2 ``remaining_time`` s and ``remaining_distance`` m, 0
    for off; C3 ``range_condition``, ``look_ahead`` cycles; C4 ``deviation_condition``, ``deviation`` rad of J4 to
    J6; C6 ``guard``. ``speed`` theta_kd of the three, rad/s, empty: the robot's limits. ``shape`` of the wrist's way
    and ``width`` of its soft start. ``posture``: law of the orientation along the path. A path that ends as taught is
    slowed by up to ``posture_first`` rather than left; the tool turns at most ``most_deviation`` rad from its posture,
    and at most ``untaught_deviation`` where a pose is taught and no angles. ``remedies``: what else is tried where the
    document alone breaks a limit.
    """

    mode: WristMode = "auto"
    speed_condition: Literal["any", "all", "off"] = "any"
    remaining_time: float = 0.0
    remaining_distance: float = 0.0
    range_condition: bool = True
    look_ahead: int = 10
    deviation_condition: Literal["moving", "start", "end", "off"] = "moving"
    deviation: tuple[float, ...] = (90.0 * DEG, 180.0 * DEG, 90.0 * DEG)
    guard: bool = True
    speed: tuple[float, ...] = ()
    shape: WristShape = "smooth"
    width: float = 0.5
    posture: PostureLaw = "axis"
    posture_first: float = 2.0
    most_deviation: float = 180.0 * DEG
    untaught_deviation: float = 45.0 * DEG
    remedies: bool = True

    def only(self, *, range_condition: bool = False, guard: bool = False) -> "WristOptions":
        """Return the options with no condition but these."""
        return replace(
            self,
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """Cycle times, declared costs and options of a controller."""

    period_us: int = 8000
    tick_us: int = 1000
    interpolation_cost_us: int = 3000
    axis_cost_us: int = 1000
    load_mode: LoadMode = "add"
    inertia_source: InertiaSource = "pass"
    speed_shape: SpeedShape = "jerk"
    in_position: float = 0.05 * DEG
    settle_timeout_us: int = 400_000
    servo: ServoOptions = ServoOptions()
    wrist: WristOptions = WristOptions()
    supervision: SupervisionLimits = field(default_factory=SupervisionLimits)

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


# --- what can be set -------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """One key of ``[controller]``: how it is read, its unit in the file and its default there."""

    key: str
    unit: str
    default: Any
    read: Callable[[Table, str], Any]


def _number(key: str, unit: str, default: float, **limits: Any) -> Setting:
    return Setting(key=key, unit=unit, default=default, read=lambda table, name: table.number(name, **limits))


def _text(key: str, *choices: str) -> Setting:
    """Return a setting that is one of ``choices``, by default the first."""
    return Setting(key=key, unit="", default=choices[0], read=lambda table, name: table.text(name, choices=choices))


def _numbers(key: str, unit: str) -> Setting:
    return Setting(key=key, unit=unit, default=(), read=_one_or_each)


def _flag(key: str, default: bool) -> Setting:
    return Setting(key=key, unit="", default=default, read=lambda table, name: table.flag(name, default))


def _three(key: str, unit: str, default: tuple[float, ...]) -> Setting:
    """Return a setting of three positive numbers, for J4, J5 and J6 or whatever the wrist axes are."""
    return Setting(
        key=key, unit=unit, default=default, read=lambda table, name: table.numbers(name, 3, positive=True, high=1e5)
    )


def _one_or_each(table: Table, name: str) -> tuple[float, ...]:
    """Read a positive number for all axes, or a list with one for each."""
    limits: dict[str, Any] = {"positive": True, "high": 1e5}
    return table.numbers(name, None, **limits) if table.is_list(name) else (table.number(name, **limits),)


def _servo_period(table: Table, name: str) -> float:
    value = table.number(name, positive=True)
    if value not in SERVO_PERIODS_MS:
        table.fail("RBL605", f"'{name}' is {value:g}; it must be 0.25, 0.5 or 1", key=name)
    return value


CONTROLLER = (
    Setting(key="servo_period_ms", unit="ms", default=1.0, read=_servo_period),
    _number("interpolation_cost_ms", "ms", 3.0, low=0.0, high=80.0),
    _number("dynamics_cost_per_axis_ms", "ms", 1.0, low=0.001, high=1000.0),
    _text("load_mode", "add", "replace"),
    _text("inertia_source", "pass", "recursion", "matrix"),
    _text("speed_shape", "jerk", "trapezoid"),
    _number("in_position_deg", "deg", 0.05, positive=True, high=10.0),
    _number("settle_timeout_s", "s", 0.4, low=0.0, high=60.0),
)
SERVO = (
    _text("mode", "scheduled", "fixed"),
    Setting(
        key="fixed_at", unit="", default="mid", read=lambda table, name: table.text(name, choices=("min", "mid", "max"))
    ),
    _text("coupling", "full", "diagonal"),
    _text("feedforward", "command", "measured"),
    _number("velocity_feedforward", "", 1.0, low=0.0, high=1.0),
    _number("acceleration_feedforward", "", 1.0, low=0.0, high=1.0),
    _number("spring_compensation", "", 1.0, low=0.0, high=2.0),
    _number("gravity_lead", "", 1.0, low=0.0, high=2.0),
    _number("gravity_compensation", "", 1.0, low=0.0, high=2.0),
    _number("friction_compensation", "", 1.0, low=0.0, high=2.0),
    _numbers("position_bandwidth_rad_s", "1/s"),
    _numbers("velocity_bandwidth_rad_s", "1/s"),
    Setting(key="compensation", unit="", default="", read=lambda table, name: table.text(name)),
)
WRIST = (
    _text("mode", "auto", "keep"),
    _text("speed_condition", "any", "all", "off"),
    _number("remaining_time_s", "s", 0.0, low=0.0, high=600.0),
    _number("remaining_distance_mm", "mm", 0.0, low=0.0, high=20_000.0),
    _flag("range_condition", True),
    Setting(
        key="look_ahead_cycles",
        unit="cycles",
        default=10,
        read=lambda table, name: table.integer(name, low=0, high=1000),
    ),
    _text("deviation_condition", "moving", "start", "end", "off"),
    _three("deviation_deg", "deg", (90.0, 180.0, 90.0)),
    _flag("guard", True),
    _three("speed_deg_s", "deg/s", ()),
    _text("shape", "smooth", "linear", "hermite"),
    _number("soft_start", "", 0.5, positive=True, high=1.0),
    _text("posture", "axis", "rpy"),
    _number("posture_first", "", 2.0, low=1.0, high=20.0),
    _number("most_deviation_deg", "deg", 180.0, low=0.0, high=180.0),
    _number("untaught_deviation_deg", "deg", 45.0, low=0.0, high=180.0),
    _flag("remedies", True),
)
_LIMITS = SupervisionLimits()
SUPERVISION = (
    _flag("enabled", True),
    _number("following_error_deg", "deg", _LIMITS.following_error / DEG, positive=True, high=180.0),
    _number("following_lag_ms", "ms", _LIMITS.following_lag * 1e3, low=0.0, high=1000.0),
    _number("saturation_ms", "ms", _LIMITS.saturation_s * 1e3, low=0.0, high=60_000.0),
    _number("speed_margin", "", _LIMITS.speed_margin, low=0.0, high=10.0),
    _number("position_margin_deg", "deg", _LIMITS.position_margin / DEG, low=0.0, high=90.0),
    _number("collision", "", _LIMITS.collision, low=0.0, high=10.0),
    _number("stale_dynamics_ms", "ms", _LIMITS.stale_s * 1e3, positive=True, high=60_000.0),
    Setting(
        key="overruns",
        unit="",
        default=_LIMITS.overruns,
        read=lambda table, name: table.integer(name, low=1, high=1_000_000),
    ),
    _text("payload_mismatch", "stop", "warn", "off"),
    _number("payload_tolerance", "", _LIMITS.payload_tolerance, low=0.01, high=10.0),
    Setting(key="friction", unit="", default=None, read=lambda table, name: table.number(name, low=0.0, high=2.0)),
    _number("friction_uncertainty", "", _LIMITS.friction_uncertainty, low=0.0, high=1.0),
    _number("torque_uncertainty", "", _LIMITS.torque_uncertainty, low=1e-4, high=1.0),
)
_BY_KEY = {
    **{item.key: item for item in CONTROLLER},
    **{f"servo.{item.key}": item for item in SERVO},
    **{f"wrist.{item.key}": item for item in WRIST},
    **{f"supervision.{item.key}": item for item in SUPERVISION},
}
KEYS = tuple(_BY_KEY)
"""Every key of ``[controller]``, dotted, in the order of the documentation."""
UNITS = {key: item.unit for key, item in _BY_KEY.items()}
"""Unit of every key, as people write it; empty for a word or a share."""
_IDEAL_WHEN_MEASURED = ("servo.velocity_feedforward", "servo.acceleration_feedforward")
_FEEDS_BACK_WHEN_MEASURED = (*_IDEAL_WHEN_MEASURED, "servo.spring_compensation")


# --- where a value comes from ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """A value as its file writes it, and its place: ``origin`` for people; the table when there is one."""

    value: Any
    origin: str
    table: Table | None = None
    name: str = ""

    def fault(self, code: str, message: str, hint: str = "") -> Fault:
        """Return what refuses the value where it was given: ``FileFault`` in a file, else one that names the option."""
        if self.table is not None:
            return self.table.fault(code, message, hint, key=self.name)
        return Fault(code, f"{self.origin}: {message}", hint)

    def fail(self, code: str, message: str, hint: str = "") -> NoReturn:
        """Refuse the value: raise its ``fault``."""
        raise self.fault(code, message, hint)


Layer = Mapping[str, Given]
"""What one file or the command line gives, by dotted key."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """Every key with its effective value and origin, and the profile they make."""

    given: Layer
    profile: Profile = field(default_factory=Profile)

    def __getitem__(self, key: str) -> Given:
        return self.given[key]


def read_layer(table: Table | None) -> Layer:
    """Read ``[controller]`` of a file; ``FileFault`` RBL6xx at the key that is wrong. None gives nothing."""
    if table is None:
        return {}
    found = _read(table, CONTROLLER, "")
    table.ask(*(item.key for item in CONTROLLER))
    for name, settings in (("servo", SERVO), ("wrist", WRIST), ("supervision", SUPERVISION)):
        group = table.table(name, required=False)
        found |= _read(group, settings, f"{name}.")
        group.ask(*(item.key for item in settings))
        group.done()
    table.done()
    return found


def _read(table: Table, settings: Sequence[Setting], prefix: str) -> dict[str, Given]:
    return {
        prefix + item.key: Given(value=_value(table, item), origin=table.place(item.key), table=table, name=item.key)
        for item in settings
        if item.key in table
    }


def _value(table: Table, item: Setting) -> Any:
    """Return the value of a setting, None where it is wrong and everything that is wrong is gathered."""
    return table.attempt(lambda: item.read(table, item.key))


def load_profile_file(path: Path) -> Layer:
    """Read a profile file: ``schema = 1`` and ``[controller]`` as in a cell; ``FileFault`` at what is wrong."""
    table = load_table(read_source(path), gather=True)
    table.integer("schema", low=1, high=1)
    layer = table.table("controller").gather(read_layer)
    table.finish()
    return layer or {}


def read_options(values: Mapping[str, tuple[str, Any]]) -> Layer:
    """Return the layer of options: by dotted key the option's name and its value; ``Fault`` that names the option."""
    layer = {}
    for key, (option, value) in values.items():
        if key not in _BY_KEY:
            raise Fault(
                "RBL609", f"{option}: '{key}' is not a key of the controller profile", f"known: {', '.join(KEYS)}"
            )
        try:
            taken = _BY_KEY[key].read(Table(Source(option, ""), {key: value}, ()), key)
        except FileFault as fault:
            raise Fault(fault.code, f"{option}: {fault.message}", fault.hint) from None
        layer[key] = Given(value=taken, origin=option)
    return layer


def settle(*layers: Layer) -> Settings:
    """Put the layers together, later ones over earlier ones, and check what can be checked without a robot."""
    given = {key: Given(value=item.default, origin="default") for key, item in _BY_KEY.items()}
    asked = {key: value for layer in layers for key, value in layer.items()}
    given.update(asked)
    faults: list[Fault] = []
    if given["servo.feedforward"].value == "measured":
        for key in _FEEDS_BACK_WHEN_MEASURED:
            if key not in asked:
                given[key] = Given(value=0.0, origin="default")
            elif key in _IDEAL_WHEN_MEASURED and not given[key].value < 1.0:
                faults.append(
                    given[key].fault(
                        "RBL616",
                        f"'controller.{key}' must be below 1 when the feed-forward is measured",
                        'give a value such as 0.9, or write feedforward = "command"',
                    )
                )
    if given["servo.mode"].value == "fixed":
        if "servo.coupling" not in asked:
            given["servo.coupling"] = Given(value="diagonal", origin="default")
        elif given["servo.coupling"].value == "full":
            faults.append(
                given["servo.coupling"].fault(
                    "RBL605",
                    "'controller.servo.coupling' must be \"diagonal\" when the gains are fixed",
                    "fixed gains hold the inertia of each axis alone",
                )
            )
    raise_all(faults)
    return Settings(given=given, profile=_profile({key: item.value for key, item in given.items()}))


def check_axes(settings: Settings, axes: int, robot: str) -> None:
    """Refuse a setting for each axis that has another number of entries than the robot axes (RBL613)."""
    faults: list[Fault] = []
    for name in ("position", "velocity"):
        given = settings[f"servo.{name}_bandwidth_rad_s"]
        if len(given.value) not in (0, 1, axes):
            message = f"'servo.{name}_bandwidth_rad_s' has {len(given.value)} entries; {robot} has {axes} axes"
            faults.append(given.fault("RBL613", message, "give one number for all axes or one for each"))
    raise_all(faults)


def compensation_file(settings: Settings) -> Path | None:
    """Return the compensation file that is named, None for none; ``FileFault`` RBL602.

    A file names one inside of its own folder only, an option any.
    """
    given = settings["servo.compensation"]
    if not given.value:
        return None
    if given.table is None:
        return Path(given.value)
    return inside(given.table, given.value, Path(given.table.source.path).parent, given.name)


def parse_profile(table: Table | None) -> Profile:
    """Return the profile of one ``[controller]`` table; ``FileFault`` RBL6xx. None gives the defaults."""
    return settle(read_layer(table)).profile


def _supervision(value: Mapping[str, Any]) -> SupervisionLimits:
    return SupervisionLimits(
        enabled=value["enabled"],
        following_error=value["following_error_deg"] * DEG,
        following_lag=value["following_lag_ms"] * 1e-3,
        saturation_s=value["saturation_ms"] * 1e-3,
        speed_margin=value["speed_margin"],
        position_margin=value["position_margin_deg"] * DEG,
        collision=value["collision"] or math.inf,  # 0 switches it off
        stale_s=value["stale_dynamics_ms"] * 1e-3,
        overruns=value["overruns"],
        payload_mismatch=cast(Reaction, value["payload_mismatch"]),
        payload_tolerance=value["payload_tolerance"],
        friction=value["friction"],
        friction_uncertainty=value["friction_uncertainty"],
        torque_uncertainty=value["torque_uncertainty"],
    )


def _wrist(value: Mapping[str, Any]) -> WristOptions:
    return WristOptions(
        mode=cast(WristMode, value["mode"]),
        speed_condition=value["speed_condition"],
        remaining_time=value["remaining_time_s"],
        remaining_distance=value["remaining_distance_mm"] * MM,
        range_condition=value["range_condition"],
        look_ahead=value["look_ahead_cycles"],
        deviation_condition=value["deviation_condition"],
        deviation=tuple(angle * DEG for angle in value["deviation_deg"]),
        guard=value["guard"],
        speed=tuple(speed * DEG for speed in value["speed_deg_s"]),
        shape=cast(WristShape, value["shape"]),
        width=value["soft_start"],
        posture=cast(PostureLaw, value["posture"]),
        posture_first=value["posture_first"],
        most_deviation=value["most_deviation_deg"] * DEG,
        untaught_deviation=value["untaught_deviation_deg"] * DEG,
        remedies=value["remedies"],
    )


def _group(value: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return the values of one group by the keys of its own table."""
    return {key.removeprefix(f"{name}."): item for key, item in value.items() if key.startswith(f"{name}.")}


def _profile(value: Mapping[str, Any]) -> Profile:
    return Profile(
        tick_us=round(value["servo_period_ms"] * 1000),
        interpolation_cost_us=round(value["interpolation_cost_ms"] * 1000),
        axis_cost_us=round(value["dynamics_cost_per_axis_ms"] * 1000),
        load_mode=cast(LoadMode, value["load_mode"]),
        inertia_source=cast(InertiaSource, value["inertia_source"]),
        speed_shape=cast(SpeedShape, value["speed_shape"]),
        in_position=value["in_position_deg"] * DEG,
        settle_timeout_us=round(value["settle_timeout_s"] * 1e6),
        servo=ServoOptions(
            mode=cast(ServoMode, value["servo.mode"]),
            fixed_at=cast(FixedAt, value["servo.fixed_at"]),
            coupling=cast(Coupling, value["servo.coupling"]),
            source=cast(FeedforwardSource, value["servo.feedforward"]),
            velocity_feedforward=value["servo.velocity_feedforward"],
            acceleration_feedforward=value["servo.acceleration_feedforward"],
            spring_compensation=value["servo.spring_compensation"],
            gravity_lead=value["servo.gravity_lead"],
            gravity_compensation=value["servo.gravity_compensation"],
            friction_compensation=value["servo.friction_compensation"],
            position_bandwidth=value["servo.position_bandwidth_rad_s"],
            velocity_bandwidth=value["servo.velocity_bandwidth_rad_s"],
        ),
        wrist=_wrist(_group(value, "wrist")),
        supervision=_supervision(_group(value, "supervision")),
    )
