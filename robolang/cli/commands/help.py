"""``robolang help [WORD]...``: the help of a command, or what ``explain`` says of a word."""

import difflib
from typing import Annotated

from robolang.cli.errors import reported
from robolang.cli.options import Argument, JsonOptions
from robolang.cli.usage import OptionValueError


def _commands() -> list[str]:
    from robolang.cli.command_table import TABLE

    return [entry.name for entry in TABLE]


_Words = Annotated[
    list[str] | None, Argument("[WORD]...", "A command, a code or a word; default: list all commands.", _commands)
]


def help(words: _Words) -> None:
    """Show the help of a command, or explain a code or a word.

    Example: robolang help run

    Exit codes: 0 done; 2 there is no such command, code or word.
    """
    from robolang.cli.command_table import TABLE
    from robolang.cli.commands.explain import explain, means

    names = [entry.name for entry in TABLE]
    if words and words[0] not in names:
        near = difflib.get_close_matches(words[0], names, n=1, cutoff=0.7)
        if near and not means(" ".join(words)):
            raise OptionValueError("WORD", f"there is no command '{words[0]}'; did you mean {near[0]}?")
        explain(" ".join(words), JsonOptions())
        return
    with reported():
        from robolang.cli.main import app

        app([*(words or ()), "--help"], prog_name="robolang")
