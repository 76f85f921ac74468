"""The commands of ``robolang`` for typer: listed from the table, imported when one of them is called."""

from collections.abc import Iterator, MutableMapping
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from robolang.cli.command import CodedGroup, PlainCommand, command
from robolang.cli.command_table import TABLE, Entry

_ENTRIES = {entry.name: entry for entry in TABLE}


class LazyGroup(CodedGroup):
    """The group of all commands of the table."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands = _Commands()

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return what the list of commands shows of one, None for an unknown name."""
        entry = _ENTRIES.get(cmd_name)
        return None if entry is None else _shown(entry)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands, in the order of ``--help``."""
        # the names alone: typer's own asks for each command
        return list(_ENTRIES)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return name, command and the words after it; a usage error with the nearest name for an unknown one."""
        name, found, rest = super().resolve_command(ctx, args)
        return name, None if found is None else self.commands[args[0]], rest


class _Commands(MutableMapping[str, Any]):
    """Commands by their names; each is imported when it is asked for."""

    def __getitem__(self, name: str) -> Any:
        return _made(_ENTRIES[name])

    def __iter__(self) -> Iterator[str]:
        return iter(_ENTRIES)

    def __len__(self) -> int:
        return len(_ENTRIES)

    def __setitem__(self, name: str, value: Any) -> None:
        raise TypeError("commands are in the table")

    def __delitem__(self, name: str) -> None:
        raise TypeError("commands are in the table")


def _shown(entry: Entry) -> TyperCommand:
    # typer takes a word in brackets for a style
    return TyperCommand(entry.name, help=entry.help.replace("[", r"\["), rich_help_panel=entry.panel)


def _made(entry: Entry) -> TyperCommand | TyperGroup:
    """Return the command itself."""
    # by name, so that no import of this file says what a command needs
    module = import_module(entry.module)
    if entry.group:
        app: typer.Typer = module.app
    else:
        app = typer.Typer(add_completion=False)
        settings = None if entry.settings is None else dict(entry.settings)
        app.command(entry.name, cls=PlainCommand, context_settings=settings)(command(getattr(module, entry.word)))
    made = typer.main.get_command(app)
    made.name = entry.name
    assert isinstance(made, TyperCommand | TyperGroup)
    return made
