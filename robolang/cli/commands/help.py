"""``robolang help [WORD]...``: the help of a command, or what ``explain`` says of a word."""

from typing import Annotated

from robolang.cli.errors import reported
from robolang.cli.options import Argument

_Words = Annotated[
    list[str] | None, Argument("[WORD]...", "A command, a code or its name; default: list all commands.")
]


def help(words: _Words) -> None:
    """Show the help of a command, or explain a code.

    Example: robolang help run

    Exit codes: 0 done; 2 there is no such command and no such code.
    """
    from robolang.cli.command_table import TABLE
    from robolang.cli.commands.explain import explain

    if words and words[0] not in {entry.name for entry in TABLE}:
        explain(" ".join(words))
        return
    with reported():
        from robolang.cli.main import app

        app([*(words or ()), "--help"], prog_name="robolang")
