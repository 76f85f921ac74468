"""The ``robolang`` command: its sub-commands are put together here.

Nothing heavy is imported: a command is imported when it is called, and numpy, pinocchio and mujoco inside the commands
that need them.
"""

import os
from typing import Annotated

import typer

from robolang.cli.colour import CHOICES
from robolang.cli.lazy_group import LazyGroup
from robolang.cli.output import escape_what_a_terminal_lacks
from robolang.cli.shells import VARIABLE

app = typer.Typer(
    name="robolang",
    cls=LazyGroup,
    no_args_is_help=True,
    # it adds two options to the help, which say less than `robolang completion` does
    add_completion=VARIABLE in os.environ,
    pretty_exceptions_enable=False,  # errors.reported answers every exception
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Check, run and test programs of an industrial robot language on a simulated robot controller.",
    epilog="Exit codes: 0 done; 1 the program has errors, or what was to be checked does not hold; 2 a file or an "
    "option cannot be used; 3 a move was refused or ended with an alarm; 4 a file cannot be written; "
    "70 a defect of robolang; 130, 143 stopped by a signal. Each command lists its own.",
)


@app.callback()
def options(
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
    color: Annotated[
        str | None,
        typer.Option("--color", metavar="|".join(CHOICES), help="Colours, also after a command; NO_COLOR=1 has none."),
    ] = None,
) -> None:
    """Take the options that stand before a command."""
    # ``__main__`` has obeyed --color and taken it away
    del color
    if version:  # pragma: no cover - ``__main__`` answers before this module is imported
        raise SystemExit


def run_app() -> None:
    """Run the command line and leave the process."""
    escape_what_a_terminal_lacks()
    if os.environ.get("NO_COLOR"):
        from typer import rich_utils

        # rich takes away colours alone, and help would be in bold
        rich_utils.COLOR_SYSTEM = None
    # the name also of `python -m robolang`: shells and messages know no other
    app(prog_name="robolang")
