"""The options that set the controller, the same for every command that has a controller.

Each is a key of ``[controller]`` (docs/language.md); ``--set`` reaches those without an option of their own. What is
given here lies over the profile file, which lies over the cell. Only typer and the standard library are imported.
"""

import tomllib
from typing import Annotated, Any

import typer

from robolang.cli.values import OptionValueError

Servo = Annotated[
    str | None, typer.Option("--servo", help="Servo gains: 'scheduled' follow the inertia, 'fixed' do not.")
]
FixedAt = Annotated[
    str | None, typer.Option("--fixed-at", help="Fixed gains are those of the 'min', 'mid' or 'max' inertia.")
]
Coupling = Annotated[
    str | None, typer.Option("--coupling", help="Inertia of 'diagonal' elements, or 'full' rows in the servo.")
]
Feedforward = Annotated[
    str | None, typer.Option("--feedforward", help="Derivatives of the 'command', or the 'measured' ones.")
]
LoadMode = Annotated[
    str | None, typer.Option("--load-mode", help="LOAD is an 'add'ition to the last link, or a 'replace'ment.")
]
ServoPeriod = Annotated[str | None, typer.Option("--servo-period", help="Servo tick, ms: 0.25, 0.5 or 1.")]
ProfileFile = Annotated[str | None, typer.Option("--profile", help="Controller profile file (.toml).")]
Compensation = Annotated[
    str | None, typer.Option("--compensation", help="Compensation file of 'robolang identify', in place of the rotors.")
]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Any key of the controller profile, e.g. servo.gravity_compensation=0."
    ),
]

CHOICES = {
    "--servo": ("servo.mode", ("scheduled", "fixed")),
    "--fixed-at": ("servo.fixed_at", ("min", "mid", "max")),
    "--coupling": ("servo.coupling", ("diagonal", "full")),
    "--feedforward": ("servo.feedforward", ("command", "measured")),
    "--load-mode": ("load_mode", ("add", "replace")),
    "--servo-period": ("servo_period_ms", ("0.25", "0.5", "1")),
}

Options = dict[str, tuple[str, Any]]
"""Dotted key to (name of the option, value), as ``robolang.project.project.load_project`` takes it."""


def controller_options(
    *,
    servo: str | None = None,
    fixed_at: str | None = None,
    coupling: str | None = None,
    feedforward: str | None = None,
    load_mode: str | None = None,
    servo_period: str | None = None,
    settings: list[str] | None = None,
    compensation: str | None = None,
) -> Options:
    """Return the options that were given; ``OptionValueError`` for a value that is none of the choices.

    ``--fixed-at`` alone means fixed gains; beside ``--servo scheduled`` it would mean nothing and is refused.
    """
    if fixed_at is not None and servo == "scheduled":
        raise OptionValueError("--fixed-at", "scheduled gains are not fixed; leave out --servo scheduled")
    given = {
        "--servo": servo,
        "--fixed-at": fixed_at,
        "--coupling": coupling,
        "--feedforward": feedforward,
        "--load-mode": load_mode,
        "--servo-period": servo_period,
    }
    options: Options = {}
    for text in settings or []:
        key, value = _setting(text)
        options[key] = ("--set", value)
    if compensation is not None:
        options["servo.compensation"] = ("--compensation", compensation)
    if fixed_at is not None:
        options["servo.mode"] = ("--fixed-at", "fixed")
    for option, chosen in given.items():
        key, choices = CHOICES[option]
        if chosen is not None:
            if chosen not in choices:
                raise OptionValueError(option, f"'{chosen}' is not one of {', '.join(choices)}")
            options[key] = (option, float(chosen) if option == "--servo-period" else chosen)
    return options


def _setting(text: str) -> tuple[str, Any]:
    """Split ``KEY=VALUE``; the value as TOML writes it, or a bare word."""
    key, equals, value = text.partition("=")
    key, value = key.strip().removeprefix("controller."), value.strip()
    if not (key and equals and value) or "\n" in value:
        raise OptionValueError("--set", f"'{text[:60]}' is not KEY=VALUE")
    try:
        return key, tomllib.loads(f"value = {value}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return key, value
