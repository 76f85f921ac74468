"""The ``robolang`` command: its sub-commands are put together here.

Nothing heavy is imported: numpy, pinocchio and mujoco come in inside the commands that need them.
"""

from typing import Annotated

import typer

from robolang.cli.commands import (
    check,
    compare,
    config,
    explain,
    export,
    fmt,
    identify,
    inertia,
    kin,
    renumber,
    replay_pulses,
    robot,
    rules,
    run,
    step,
    test,
    weigh,
    wrist_demo,
)
from robolang.cli.errors import escape_what_a_terminal_lacks
from robolang.cli.usage import CodedGroup

app = typer.Typer(
    name="robolang",
    cls=CodedGroup,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="A robot controller in a package: run a program in an industrial robot language on a true controller.",
)
app.command("run")(run.run)
app.command("compare")(compare.compare)
app.command("step")(step.step)
app.command("inertia")(inertia.inertia)
app.command("identify")(identify.identify)
app.command("weigh")(weigh.weigh)
app.command("wrist-demo")(wrist_demo.wrist_demo)
app.command("replay-pulses")(replay_pulses.replay_pulses)
app.command("test")(test.test)
app.command("check")(check.check)
app.command("fmt")(fmt.fmt)
app.command("renumber")(renumber.renumber)
app.command("rules")(rules.rules)
app.command("explain")(explain.explain)
app.add_typer(config.app, name="config")
app.add_typer(export.app, name="export")
app.add_typer(kin.app, name="kin")
app.add_typer(robot.app, name="robot")


@app.callback()
def options(
    version: Annotated[bool, typer.Option("--version", help="Print the version and leave.")] = False,
) -> None:
    """Take the options that stand before a command."""
    if version:  # pragma: no cover - ``__main__`` answers before this module is imported
        raise typer.Exit


def run_app() -> None:
    """Run the command line and leave the process."""
    escape_what_a_terminal_lacks()
    app()
