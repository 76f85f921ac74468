"""``robolang new NAME``: a folder with a program that runs, its points, cell and test, and what CI and editors need."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import reported
from robolang.cli.options import Argument, Option, RobotOptions
from robolang.cli.output import echo
from robolang.core.diagnostics import safe

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robolang.templates.writing import Written

_Name = Annotated[Path, Argument("NAME", "Folder to make; its last part is the name of the program.")]


def _templates() -> "Iterable[str]":
    from robolang.templates.template import NAMES

    return NAMES


class TemplateOptions(RobotOptions):
    """Which job, and on which robot."""

    PANEL: ClassVar[str] = "Project"
    # not as choices: what is no template gets the nearest one, and a code of its own
    template: Annotated[
        str,
        Option(
            "--template",
            metavar="JOB",
            help="Job: pick-place, palletise, tend, dispense or measure.",
            offers=_templates,
        ),
    ] = "pick-place"
    robot: str = "puma560"


def new(name: _Name, options: TemplateOptions) -> None:
    """Make a folder with a job that runs: program, points, cell, test, CI workflow, editor settings.

    The job is placed where the robot reaches it, and its motion is checked before anything is written.

    Example: robolang new cell1 --template palletise --robot irb2400

    Exit codes: 0 done; 2 the template, the robot or the name cannot be used, or the template does not fit the robot; 4
    the folder exists or cannot be written.
    """
    with reported():
        from robolang.templates.writing import new_project

        tell(new_project(name, options.template, options.robot))


def tell(written: "Written") -> None:
    """Print what was written, and the commands to go on with."""
    for file in written.files:
        echo(safe(f"wrote {written.folder / file}"))
    for file in written.kept:
        echo(safe(f"kept  {written.folder / file}, which was there"))
    for note in written.notes:
        echo(safe(f"note: {note}"), err=True)
    program = written.folder / f"{written.name}.rbl"
    echo(safe(f"go on with: robolang check --motion {program}"))
    echo(safe(f"            robolang run {'' if written.physics else '--no-physics '}{program}"))
    echo(safe(f"            robolang test {program}"))
