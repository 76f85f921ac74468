"""``robolang check`` and ``robolang repl`` without typer and without the other commands.

These cost a check half of its time, and editors and hooks call it often and for one file; a prompt is to be there at
once. What is read here are options and arguments as they are meant to be; anything else, ``--help`` and usage errors
included, is left to the whole command line.
"""

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, get_args

from robolang.cli.options import CellOptions, Group, Option
from robolang.cli.output import escape_what_a_terminal_lacks
from robolang.cli.usage import OptionValueError


class Quick(NamedTuple):
    """A command: its function, its groups by the names of their parameters, and the parameter of its arguments.

    ``many``: it takes any number of arguments, as a list; else one at most.
    """

    function: Callable[..., None]
    groups: Mapping[str, type[Group]]
    argument: str
    many: bool


def check() -> Quick:
    """Return ``robolang check``."""
    import robolang.cli.check_job  # noqa: F401 - what `check` imports when it starts
    from robolang.cli.check_options import FileOptions, FixOptions, MotionOptions, ReportOptions, SelectionOptions
    from robolang.cli.commands.check import check as function

    groups: dict[str, type[Group]] = {
        "files": FileOptions,
        "selection": SelectionOptions,
        "fixes": FixOptions,
        "report": ReportOptions,
        "motion": MotionOptions,
    }
    return Quick(function, groups, "paths", many=True)


def repl() -> Quick:
    """Return ``robolang repl``."""
    from robolang.cli.commands.repl import PromptOptions
    from robolang.cli.commands.repl import repl as function

    return Quick(function, {"files": CellOptions, "options": PromptOptions}, "program", many=False)


COMMANDS = {"check": check, "repl": repl}


def run_app(command: Quick) -> None:
    """Run the command that is named first, and leave the process."""
    given = parsed(sys.argv[2:], command)
    if given is not None:
        escape_what_a_terminal_lacks()
        try:
            command.function(**given)
        except OptionValueError:  # options are refused before the work starts, so it can be done again
            pass
        else:
            sys.exit(0)
    from robolang.cli.main import run_app as run_whole

    run_whole()


def parsed(words: list[str], command: Quick) -> dict[str, Any] | None:
    """Return the parameters of a command; None for words that are not plainly options and arguments."""
    known = {name: (field, kind) for field, kind, option in options_of(command) for name in option.names}
    arguments: list[str] = []
    values = _environment(command)  # first: an option that is given replaces it
    rest = iter(words)
    for word in rest:
        if word == "-" or not word.startswith("-"):
            arguments.append(word)
        elif not _took(word, rest, known, values):
            return None
    if len(arguments) > 1 and not command.many:
        return None
    given = (arguments if command.many else arguments[0]) if arguments else None
    return {command.argument: given, **{name: _made(group, values) for name, group in command.groups.items()}}


def _took(word: str, rest: Iterator[str], known: dict[str, tuple[str, Any]], values: dict[str, Any]) -> bool:
    """Add an option to the values; False for one that is unknown or has no plain value."""
    name, equals, value = word.partition("=")
    # --help as well: it is an option of typer, and answered there
    if name not in known:
        return False
    field, kind = known[name]
    if kind is bool:
        values[field] = True
        return not equals  # --fix=yes is an error, and typer says so
    text = value if equals else next(rest, "-")  # a value that is missing looks like one that is not plain
    plain = Path(text) if Path in get_args(kind) else text
    values[field] = [*values.get(field, []), text] if kind == list[str] | None else plain
    # "--ignore --fix" may be a value or a slip
    return not text.startswith("-")


def options_of(command: Quick) -> Iterator[tuple[str, Any, Option]]:
    """Yield field, type and option of every option of a command."""
    for group in command.groups.values():
        for field, kind, option, _ in group.options():
            yield field, kind, option


def _made(group: type[Group], values: dict[str, Any]) -> Group:
    return group(**{field: values[field] for field in group.FIELDS if field in values})


def _environment(command: Quick) -> dict[str, Any]:
    """Return the options that variables of the environment give; an empty variable gives none."""
    found = {
        field: os.environ.get(option.envvar) for field, _, option in options_of(command) if option.envvar is not None
    }
    return {field: text for field, text in found.items() if text}
