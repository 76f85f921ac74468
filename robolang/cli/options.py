"""The options of the command line as data: each is declared once, in a group, and every command names its groups.

A group is a record whose fields are options. ``command`` turns the groups of a command into parameters of typer and
shows each group in a panel of ``--help``; ``quick`` reads those of ``check`` without typer. So nothing but the standard
library is imported here.
"""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any, ClassVar

from runtime.core.record import Record

Offers = Callable[[], Iterable[str]]


def robots() -> Iterable[str]:
    """Return the built-in robots."""
    from runtime.robot.files.robot_file import library

    return library()


class Option:
    """An option: its names, its help text and what values it takes.

    Args:
        names: The long name, and a short one for a few.
        help: What it does, with the unit of a value.
        metavar: How ``--help`` shows the value; None: by its type.
        choices: The values it takes; None: any. Other values are refused before the command starts.
        key: The key of ``[controller]`` that it sets; None: none.
        envvar: The variable of the environment that it is read from where it is not given.
        low, high: The range of a number, inclusive. NaN passes: a command refuses it.
        offers: What a shell completes a value to, where others are taken too; called when it asks.
    """

    __slots__ = ("choices", "envvar", "help", "high", "key", "low", "metavar", "names", "offers")

    def __init__(
        self,
        *names: str,
        help: str,
        **rest: Any,
    ) -> None:
        self.names, self.help = names, help
        self.metavar: str | None = rest.pop("metavar", None)
        self.choices: tuple[str, ...] | None = rest.pop("choices", None)
        self.key: str | None = rest.pop("key", None)
        self.envvar: str | None = rest.pop("envvar", None)
        self.low: float | None = rest.pop("low", None)
        self.high: float | None = rest.pop("high", None)
        self.offers: Offers | None = rest.pop("offers", None)
        if rest:  # a misspelt keyword would be an option without its range
            raise TypeError(f"{names[0]}: unknown: {', '.join(rest)}")


class Argument:
    """An argument of a command: how ``--help`` names it, its help text, and what a shell completes it to."""

    __slots__ = ("help", "metavar", "offers")

    def __init__(self, metavar: str, help: str, offers: Offers | None = None) -> None:
        self.metavar, self.help, self.offers = metavar, help, offers


class Group(Record):
    """Options that belong together; ``PANEL`` is their heading in ``--help``."""

    PANEL: ClassVar[str] = "Options"

    @classmethod
    def options(cls) -> Iterator[tuple[str, Any, Option, str]]:
        """Yield field, type, option and panel of all options, those of the base first.

        A group that declares a field of its base again with a type only gives it another default.
        """
        declared = {
            # the panel of the group that declares it: a derived one may have another for its own
            name: (hint, base.PANEL)
            for base in reversed(cls.__mro__)  # the base first, so that a declaration of its own replaces that of it
            if issubclass(base, Group)
            for name, hint in base.__annotations__.items()
            if hasattr(hint, "__metadata__")  # a field that only has another default is declared by its base
        }
        for name in cls.FIELDS:
            hint, panel = declared[name]
            yield name, hint.__origin__, hint.__metadata__[0], panel


Program = Annotated[str, Argument("PROG", "Program file (.rbl).")]
RunProgram = Annotated[str, Argument("PROG", "Program file (.rbl), or - for stdin.")]
OptionalProgram = Annotated[
    str | None, Argument("[PROG]", "Program file (.rbl), for its cell; default: the built-in cell.")
]

Run = Annotated[Path, Argument("RUN", "Log of a run, from robolang run --log.")]


ROBOT = "Built-in robot (see robolang robot list), or a .toml, .urdf or .xml file."


Strict = Annotated[bool, Option("--strict", help="Exit code 1 for warnings too.")]
AllowEmpty = Annotated[bool, Option("--allow-empty", help="Accept folders without programs or tests.")]


class CellOptions(Group):
    """Which cell a program runs in, and which robot stands in it."""

    PANEL: ClassVar[str] = "Files"
    cell: Annotated[
        str | None, Option("--cell", metavar="FILE", help="Cell file (.toml); default: the one beside the program.")
    ] = None
    robot: Annotated[
        str | None,
        Option(
            "--robot",
            metavar="ROBOT",
            help="Built-in robot or robot file, instead of the robot of the cell.",
            offers=robots,
        ),
    ] = None


class RobotOptions(Group):
    """Which robot, for the commands that need no cell."""

    PANEL: ClassVar[str] = "Robot"
    robot: Annotated[str, Option("--robot", metavar="ROBOT", help=ROBOT, offers=robots)]


class PostureOptions(RobotOptions):
    """Which robot, in which posture, with what in its hand."""

    joints: Annotated[
        str | None,
        Option("--joints", metavar="J1,J2,...", help="Posture, deg; default: 0, or the nearest angle in range."),
    ] = None
    payload: Annotated[
        str,
        Option("--payload", metavar="M,X,Y,Z", help="Carried payload: mass, kg, and centre of gravity, mm."),
    ] = "0,0,0,0"


class SettingsOptions(Group):
    """Settings of the controller (docs/servo.md). They override the profile file, which overrides the cell."""

    PANEL: ClassVar[str] = "Controller"
    profile: Annotated[str | None, Option("--profile", metavar="FILE", help="Controller profile file (.toml).")] = None
    settings: Annotated[
        list[str] | None,
        Option(
            "--set",
            metavar="KEY=VALUE",
            help="Set a key of the profile, such as servo.gravity_compensation=0. May be repeated.",
        ),
    ] = None
    feedforward: Annotated[
        str | None,
        Option(
            "--feedforward",
            help="Source of the speed and acceleration that the servo feeds forward.",
            key="servo.feedforward",
            choices=("command", "measured"),
        ),
    ] = None
    load_mode: Annotated[
        str | None,
        Option(
            "--load-mode",
            help="add: LOAD is added to the last link; replace: it takes its place.",
            key="load_mode",
            choices=("add", "replace"),
        ),
    ] = None
    servo_period: Annotated[
        str | None,
        Option(
            "--servo-period",
            metavar="MS",
            help="Servo period, ms: 0.25, 0.5 or 1.",
            key="servo_period_ms",
            choices=("0.25", "0.5", "1"),
        ),
    ] = None


class ControllerOptions(SettingsOptions):
    """The settings of the controller with those of the servo gains, which ``compare`` varies itself."""

    servo: Annotated[
        str | None,
        Option(
            "--servo",
            help="scheduled: the servo gains follow the inertia; fixed: they do not.",
            key="servo.mode",
            choices=("scheduled", "fixed"),
        ),
    ] = None
    fixed_at: Annotated[
        str | None,
        Option(
            "--fixed-at",
            help="Inertia that fixed gains are made for: smallest, middle or largest.",
            key="servo.fixed_at",
            choices=("min", "mid", "max"),
        ),
    ] = None
    coupling: Annotated[
        str | None,
        Option(
            "--coupling",
            help="Inertia in the servo: diagonal of the mass matrix, or full rows.",
            key="servo.coupling",
            choices=("diagonal", "full"),
        ),
    ] = None


class RunControllerOptions(ControllerOptions):
    """All settings of the controller that have an option."""

    compensation: Annotated[
        str | None,
        Option(
            "--compensation",
            metavar="FILE",
            help="Compensation file of 'robolang identify'; replaces the rotor inertia.",
            key="servo.compensation",
        ),
    ] = None


class PlantOptions(Group):
    """Which arm an experiment moves."""

    PANEL: ClassVar[str] = "Simulation"
    plant: Annotated[
        str,
        Option(
            "--plant", help="Simulated arm: MuJoCo, or the rigid ideal arm with friction.", choices=("mujoco", "rigid")
        ),
    ] = "mujoco"


class PhysicsOptions(Group):
    """Whether a program moves the arm of MuJoCo or the ideal one."""

    PANEL: ClassVar[str] = "Simulation"
    no_physics: Annotated[bool, Option("--no-physics", help="Move an ideal arm instead of the arm of MuJoCo.")] = False


class SimulationOptions(PhysicsOptions):
    """Which arm moves, and how fast."""

    realtime: Annotated[bool, Option("--realtime", help="Run no faster than real time.")] = False


class JsonOptions(Group):
    """How a command prints its result."""

    PANEL: ClassVar[str] = "Output"
    as_json: Annotated[bool, Option("--json", help="Print one JSON object in full precision.")] = False


class PlotOptions(JsonOptions):
    """How a command prints and draws its result."""

    plot: Annotated[Path | None, Option("--plot", metavar="FILE", help="Draw the result: .svg or .html.")] = None


class RewriteOptions(Group):
    """What a command that rewrites program files writes."""

    PANEL: ClassVar[str] = "Output"
    check: Annotated[bool, Option("--check", help="Write nothing; exit code 1 if a file would change.")] = False
    diff: Annotated[bool, Option("--diff", help="Write nothing; print what would change.")] = False
