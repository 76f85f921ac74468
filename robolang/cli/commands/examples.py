"""``robolang examples``: the example programs, and copies of them."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import reported
from robolang.cli.options import Argument, Group, JsonOptions, Option
from robolang.cli.output import echo
from robolang.core.diagnostics import safe

if TYPE_CHECKING:
    from robolang.templates.examples import Example

app = typer.Typer(
    add_completion=False, invoke_without_command=True, help="List the example programs, and copy one with its files."
)


@app.callback()
def examples(context: typer.Context) -> None:
    """List the examples where no sub-command is named."""
    if context.invoked_subcommand is None:
        _list(as_json=False)


def _names() -> list[str]:
    from robolang.templates.examples import examples as known

    return [each.name for each in known()]


_Name = Annotated[str, Argument("NAME", "Name of an example, as 'robolang examples' lists them.", _names)]


class _TargetOptions(Group):
    """Where the copy goes."""

    PANEL: ClassVar[str] = "Copy"
    output: Annotated[
        Path | None,
        Option(
            "--output", "-o", metavar="DIR", help="Folder for the files, made where it is not there; default: this."
        ),
    ] = None


@app.command("list", cls=PlainCommand)
@command
def list_examples(output: JsonOptions) -> None:
    """List the example programs with their robot, their planned time and what they do.

    Example: robolang examples list

    Exit codes: 0 done.
    """
    _list(output.as_json)


@app.command(cls=PlainCommand)
@command
def get(name: _Name, target: _TargetOptions) -> None:
    """Copy an example with its cell, points and test; a file that is there is not overwritten.

    Example: robolang examples get palletise -o palletising

    Exit codes: 0 done; 2 there is no such example; 4 a file exists or cannot be written.
    """
    with reported():
        from robolang.templates.examples import copy_example

        files = copy_example(name, Path() if target.output is None else target.output)
        for file in files:
            echo(safe(f"wrote {file}"))
        echo(safe(f"go on with: robolang run {files[0]}"))


def _list(as_json: bool) -> None:
    with reported():
        from robolang.templates.examples import examples as known

        rows = [_row(each) for each in known()]
        if as_json:
            echo(json.dumps(rows, indent=2))
        else:
            _print(rows)


def _row(example: "Example") -> dict[str, str | float]:
    from robolang.execution.dry_run import rehearse
    from robolang.project.project import load_project

    project = load_project(example.program)
    seconds = rehearse(project).total_us / 1e6
    return {"name": example.name, "robot": project.cell.robot.name, "planned_s": seconds, "does": example.title}


def _print(rows: list[dict[str, str | float]]) -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column("name", no_wrap=True)
    table.add_column("robot", no_wrap=True)
    table.add_column("time\ns", justify="right")
    table.add_column("does", overflow="fold")
    for row in rows:
        table.add_row(str(row["name"]), str(row["robot"]), f"{row['planned_s']:.1f}", safe(str(row["does"])))
    Console().print(table)
