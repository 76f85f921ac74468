"""The controller profile: cycle, declared costs and servo options, with the defaults and their reasons.

Read from ``[controller]`` of a cell file. Times in whole microseconds. Sources: docs/timing.md (costs) and
docs/servo.md (Kf, Ka, K2, feed-forward source).
"""

from dataclasses import dataclass
from typing import Literal, cast

from runtime.robot.model import LoadMode
from runtime.tomlfile import Table
from runtime.units import DEG

ServoMode = Literal["scheduled", "fixed"]
FeedforwardSource = Literal["command", "measured"]
SpeedShape = Literal["jerk", "trapezoid"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoOptions:
    """How the servo law is applied.

    ``velocity_feedforward`` Kf, ``acceleration_feedforward`` Ka and ``spring_compensation`` K2 of eqs (8), (10)
    and (6); ``gravity_compensation`` scales T in eq (11). With ``command`` as source Kf = Ka = 1 is exact; with
    ``measured``, the literal reading, they must stay below 1. ``friction_compensation`` scales the published
    friction that is added to the current (not in the document; docs/decisions/0003).
    """

    mode: ServoMode = "scheduled"
    source: FeedforwardSource = "command"
    velocity_feedforward: float = 1.0
    acceleration_feedforward: float = 1.0
    spring_compensation: float = 0.0
    gravity_compensation: float = 1.0
    friction_compensation: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """Cycle times, declared costs and options of a controller."""

    period_us: int = 8000
    tick_us: int = 1000
    interpolation_cost_us: int = 3000
    axis_cost_us: int = 1000
    load_mode: LoadMode = "add"
    speed_shape: SpeedShape = "jerk"
    in_position: float = 0.05 * DEG
    settle_timeout_us: int = 400_000
    servo: ServoOptions = ServoOptions()

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


def parse_profile(table: Table | None) -> Profile:
    """Read ``[controller]``; ``FileFault`` RBL6xx at the key that is wrong. None gives the defaults."""
    if table is None:
        return Profile()
    default = Profile()
    tick_ms = table.number("servo_period_ms", 1.0, positive=True)
    if tick_ms not in (0.25, 0.5, 1.0):
        table.fail("RBL605", f"'servo_period_ms' is {tick_ms:g}; it must be 0.25, 0.5 or 1", key="servo_period_ms")
    profile = Profile(
        tick_us=round(tick_ms * 1000),
        interpolation_cost_us=round(table.number("interpolation_cost_ms", 3.0, low=0.0, high=80.0) * 1000),
        axis_cost_us=round(table.number("dynamics_cost_per_axis_ms", 1.0, low=0.001, high=1000.0) * 1000),
        load_mode=cast(LoadMode, table.text("load_mode", "add", choices=("add", "replace"))),
        speed_shape=cast(SpeedShape, table.text("speed_shape", "jerk", choices=("jerk", "trapezoid"))),
        in_position=table.number("in_position_deg", 0.05, positive=True, high=10.0) * DEG,
        settle_timeout_us=round(
            table.number("settle_timeout_s", default.settle_timeout_us * 1e-6, low=0.0, high=60.0) * 1e6
        ),
        servo=_parse_servo(table.table("servo", required=False)),
    )
    table.done()
    return profile


def _parse_servo(table: Table) -> ServoOptions:
    source = cast(FeedforwardSource, table.text("feedforward", "command", choices=("command", "measured")))
    ideal = 1.0 if source == "command" else 0.0
    options = ServoOptions(
        mode=cast(ServoMode, table.text("mode", "scheduled", choices=("scheduled", "fixed"))),
        source=source,
        velocity_feedforward=table.number("velocity_feedforward", ideal, low=0.0, high=1.0),
        acceleration_feedforward=table.number("acceleration_feedforward", ideal, low=0.0, high=1.0),
        spring_compensation=table.number("spring_compensation", 0.0, low=0.0, high=2.0),
        gravity_compensation=table.number("gravity_compensation", 1.0, low=0.0, high=2.0),
        friction_compensation=table.number("friction_compensation", 1.0, low=0.0, high=2.0),
    )
    for key in ("velocity_feedforward", "acceleration_feedforward"):
        if source == "measured" and not getattr(options, key) < 1.0:
            table.fail(
                "RBL616",
                f"'{table.name(key)}' must be below 1 when the feed-forward is measured",
                'give a value such as 0.9, or write feedforward = "command"',
                key=key,
            )
    table.done()
    return options
