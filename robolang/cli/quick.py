"""``robolang check`` without the other commands, whose modules would cost it a fifth of its time.

It is what editors and hooks call, often and for one file. Usage, help and errors are those of the whole command line.
"""

import typer

from robolang.cli.commands.check import check
from robolang.cli.errors import escape_what_a_terminal_lacks

app = typer.Typer(name="robolang", no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
app.command("check")(check)


@app.callback()
def options() -> None:
    """Keep ``check`` a sub-command."""


def run_app() -> None:
    """Run the command line and leave the process."""
    escape_what_a_terminal_lacks()
    app()
