"""``robolang config show``: every setting of the controller that is in force, with its unit and where it came from."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolang.cli import servo_options as o
from robolang.cli.errors import reported, say_warnings
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from runtime.robot.model.spec import RobotSpec
    from runtime.settings.layers import Settings

app = typer.Typer(no_args_is_help=True, help="The settings in force.")


@app.callback()
def config() -> None:
    """Keep ``show`` a sub-command."""


@app.command()
def show(
    program: Annotated[str | None, typer.Argument(metavar="[PROG]", help="Program, for the cell beside it.")] = None,
    cell: Annotated[str | None, typer.Option(help="Cell file (.toml).")] = None,
    robot: Annotated[str | None, typer.Option(help="Built-in robot or robot file, in place of the cell's.")] = None,
    profile: o.ProfileFile = None,
    servo: o.Servo = None,
    fixed_at: o.FixedAt = None,
    coupling: o.Coupling = None,
    feedforward: o.Feedforward = None,
    load_mode: o.LoadMode = None,
    servo_period: o.ServoPeriod = None,
    settings: o.Set = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Show every controller setting in force and where it came from."""
    options = o.controller_options(
        servo=servo,
        fixed_at=fixed_at,
        coupling=coupling,
        feedforward=feedforward,
        load_mode=load_mode,
        servo_period=servo_period,
        settings=settings,
    )
    if program is not None and not Path(program).exists():
        raise OptionValueError("PROG", f"there is no file '{program}'")
    with reported():
        from robolang.project.project import load_cell_and_settings

        found, in_force = load_cell_and_settings(
            None if program is None else Path(program), cell, robot, profile, options
        )
        say_warnings(found.robot.warnings)
        rows = _rows(found.robot, in_force)
        if as_json:
            typer.echo(json.dumps({"robot": found.robot.name, "settings": rows}, indent=2))
        else:
            _print(found.robot.name, rows)


def _rows(robot: "RobotSpec", settings: "Settings") -> list[dict[str, Any]]:
    from runtime.servo.axes import bandwidths
    from runtime.settings.layers import settings as declared

    in_force = dict(zip(("position", "velocity"), bandwidths(robot, settings.profile.servo), strict=True))
    rows = []
    for key, item in declared().items():
        given = settings[key]
        value, origin = given.value, given.origin
        if key.endswith("_bandwidth_rad_s"):
            value = in_force[key.removeprefix("servo.").partition("_")[0]].tolist()
            origin = f"robot {robot.name}" if origin == "default" else origin
        rows.append({"key": key, "value": value, "unit": item.unit, "from": origin})
    return rows


def _print(robot: str, rows: list[dict[str, Any]]) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    table = Table(title=safe(f"Controller of {robot}"), box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in ("key", "value", "unit", "from"):
        table.add_column(heading, overflow="fold")
    for row in rows:
        table.add_row(row["key"], _shown(row["value"]), row["unit"], safe(row["from"]))
    Console().print(table)


def _shown(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_shown, value))}]" if value else "as the robot file"
    if isinstance(value, list):
        return _shown(value[0]) if len(set(value)) == 1 else ", ".join(map(_shown, value))
    if value is None:
        return "as the servo"  # the only open setting: the friction that supervision expects
    if value == "":
        return "none"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)
