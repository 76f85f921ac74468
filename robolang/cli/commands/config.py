"""``robolang config show``: every setting of the controller that is in force, with its unit and where it came from."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.controller_settings import settings_of
from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import CellOptions, ControllerOptions, JsonOptions, OptionalProgram
from robolang.cli.output import echo

if TYPE_CHECKING:
    from runtime.robot.model.spec import RobotSpec
    from runtime.settings.layers import Settings

app = typer.Typer(no_args_is_help=True, add_completion=False, help="Show the settings of the controller.")


@app.callback()
def config() -> None:
    """Keep ``show`` a sub-command."""


@app.command(cls=PlainCommand)
@command
def show(program: OptionalProgram, files: CellOptions, controller: ControllerOptions, output: JsonOptions) -> None:
    """Show every controller setting in force, and the file or option that it comes from.

    Example: robolang config show pick_and_place.rbl

    Exit codes: 0 done; 2 a file or an option cannot be used.
    """
    settings = settings_of(controller)
    with reported():
        # a name that is misspelt, or no program, would show the settings of the built-in cell
        if program is not None:
            from robolang.core.source import read_program

            read_program(program)
        from robolang.project.project import load_cell_and_settings

        found, in_force = load_cell_and_settings(
            None if program is None else Path(program), files.cell, files.robot, controller.profile, settings
        )
        say_warnings(found.robot.warnings)
        rows = _rows(found.robot, in_force)
        if output.as_json:
            echo(json.dumps({"robot": found.robot.name, "settings": rows}, indent=2))
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
        if key.endswith("_bandwidth_rad_s"):  # empty means that of the robot file: what is in force is shown
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
    if isinstance(value, list):  # one number for all axes where they agree
        return _shown(value[0]) if len(set(value)) == 1 else ", ".join(map(_shown, value))
    if value is None:
        return "as the servo"  # the only open setting: the friction that supervision expects
    if value == "":
        return "none"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)
