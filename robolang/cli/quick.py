"""``robolang check`` without typer and without the other commands, which cost it half of its time.

It is what editors and hooks call, often and for one file. What is read here are options and arguments as they are
meant to be; anything else, ``--help`` and usage errors included, is left to the whole command line.
"""

import os
import sys
from collections.abc import Iterator
from typing import Any

import robolang.cli.check_job  # noqa: F401 - what `check` imports when it starts
from robolang.cli.check_options import FileOptions, FixOptions, MotionOptions, ReportOptions, SelectionOptions
from robolang.cli.commands.check import check
from robolang.cli.errors import escape_what_a_terminal_lacks
from robolang.cli.options import Group, Option
from robolang.cli.usage import OptionValueError

# by the name of the parameter of `check`
_GROUPS: dict[str, type[Group]] = {
    "files": FileOptions,
    "selection": SelectionOptions,
    "fixes": FixOptions,
    "report": ReportOptions,
    "motion": MotionOptions,
}


def run_app() -> None:
    """Run ``robolang check`` and leave the process."""
    given = parsed(sys.argv[2:])
    if given is not None:
        escape_what_a_terminal_lacks()
        try:
            check(**given)
        except OptionValueError:  # options are refused before the work starts, so it can be done again
            pass
        else:
            sys.exit(0)
    from robolang.cli.main import run_app as run_whole

    run_whole()


def parsed(words: list[str]) -> dict[str, Any] | None:
    """Return the parameters of ``check``; None for words that are not plainly options and arguments."""
    known = {name: (field, kind) for field, kind, option in _options() for name in option.names}
    paths: list[str] = []
    values = _environment()  # first: an option that is given replaces it
    rest = iter(words)
    for word in rest:
        if word == "-" or not word.startswith("-"):
            paths.append(word)
        elif not _took(word, rest, known, values):
            return None
    return {"paths": paths or None, **{name: _made(group, values) for name, group in _GROUPS.items()}}


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
    values[field] = [*values.get(field, []), text] if kind == list[str] | None else text
    # "--ignore --fix" may be a value or a slip
    return not text.startswith("-")


def _options() -> Iterator[tuple[str, Any, Option]]:
    for group in _GROUPS.values():
        for field, kind, option, _ in group.options():
            yield field, kind, option


def _made(group: type[Group], values: dict[str, Any]) -> Group:
    return group(**{field: values[field] for field in group.FIELDS if field in values})


def _environment() -> dict[str, Any]:
    """Return the options that variables of the environment give; an empty variable gives none."""
    found = {field: os.environ.get(option.envvar) for field, _, option in _options() if option.envvar is not None}
    return {field: text for field, text in found.items() if text}
