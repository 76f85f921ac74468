"""The ``robolang`` command: its sub-commands are put together here.

Nothing heavy is imported: numpy, pinocchio and mujoco come in inside the commands that need them.
"""

from collections.abc import Callable
from typing import Annotated

import typer

from robolang.cli.command import CodedGroup, PlainCommand, command
from robolang.cli.commands import (
    check,
    compare,
    config,
    explain,
    export,
    fmt,
    identify,
    inertia,
    jog,
    kin,
    log,
    plot,
    render,
    renumber,
    repl,
    replay_pulses,
    report,
    robot,
    rules,
    run,
    step,
    teach,
    test,
    view,
    weigh,
    wrist_demo,
)
from robolang.cli.errors import escape_what_a_terminal_lacks

app = typer.Typer(
    name="robolang",
    cls=CodedGroup,
    no_args_is_help=True,
    add_completion=False,  # it would add two options to the help of a program that is run from scripts and CI
    pretty_exceptions_enable=False,  # errors.reported answers every exception
    help="Check, run and test programs of an industrial robot language on a simulated robot controller.",
    epilog="Exit codes: 0 done; 1 the program has errors, or what was to be checked does not hold; 2 a file or an "
    "option cannot be used; 3 a move was refused or ended with an alarm; 4 a file cannot be written; "
    "70 a defect of robolang; 130, 143 stopped by a signal. Each command lists its own.",
)
_COMMANDS: dict[str, Callable[..., None]] = {
    "run": run.run,
    "view": view.view,
    "plot": plot.plot,
    "render": render.render,
    "repl": repl.repl,
    "jog": jog.jog,
    "teach": teach.teach,
    "compare": compare.compare,
    "step": step.step,
    "inertia": inertia.inertia,
    "identify": identify.identify,
    "weigh": weigh.weigh,
    "wrist-demo": wrist_demo.wrist_demo,
    "replay-pulses": replay_pulses.replay_pulses,
    "report": report.report,
    "test": test.test,
    "check": check.check,
    "fmt": fmt.fmt,
    "renumber": renumber.renumber,
    "rules": rules.rules,
    "explain": explain.explain,
}
# an amount such as -10 is no option
_PARSED = {"jog": {"ignore_unknown_options": True}}
# in the order of the table, which is that of --help; `check` is here for its help and for what `quick` cannot read
for name, function in _COMMANDS.items():
    app.command(name, cls=PlainCommand, context_settings=_PARSED.get(name))(command(function))
app.add_typer(config.app, name="config")
app.add_typer(export.app, name="export")
app.add_typer(kin.app, name="kin")
app.add_typer(log.app, name="log")
app.add_typer(robot.app, name="robot")


@app.callback()
def options(
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    """Take the options that stand before a command."""
    if version:  # pragma: no cover - ``__main__`` answers before this module is imported
        raise SystemExit


def run_app() -> None:
    """Run the command line and leave the process."""
    escape_what_a_terminal_lacks()
    app()
