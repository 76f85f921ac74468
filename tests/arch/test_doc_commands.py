"""Commands, options and make targets that the pages name exist, and their arguments can be parsed."""

import importlib
import re
import shlex
from typing import Any

from typer.main import get_command

from robolang.cli.main import app
from tests.arch.test_docs import PAGES, ROOT, fenced, name, prose

COMMAND = re.compile(r"`(robolang(?: [^`]*)?)`")
OPTION = re.compile(r"`(--[a-z-]+)(?!:)\b")
"""What begins as an option; ``--eg:`` is a remark of FANUC TP."""
MAKE = re.compile(r"`(make [\w-]+)`")


def test_commands_exist():
    lines = [(page, line) for page in PAGES for block in fenced(page, "sh") for line in block.splitlines() if line]
    assert len(lines) > 10
    # both sides of a pipe: a script of the prompt is piped into it
    parts = [(page, part) for page, line in lines for part in line.split(" | ")]
    for page, line in parts:
        words = shlex.split(line)
        command = words[0].removeprefix(".venv/bin/")
        if command == "robolang":
            parse_command(words[1:])
        elif command == "make":
            assert set(words[1:]) <= make_targets(), line
        elif words[1:3] == ["-m", "pytest"]:
            assert all((ROOT / target).exists() for target in words[3:]), line
        elif words[1:2] == ["-m"]:
            importlib.import_module(words[2])
        elif words[1:2] == ["-c"]:
            compile(words[2], line, "exec")
        else:
            assert command in ("mkdir", "printf", "rm", "sed"), (name(page), line)


def test_commands_named_in_prose_exist():
    names = {word for page in PAGES for word in COMMAND.findall(prose(page))}
    assert len(names) > 5
    for words in map(str.split, names):
        command = get_command(app)
        for word in words[1:]:
            if not hasattr(command, "commands") or not word.islower() or word.startswith("-"):
                break
            assert word in command.commands, words
            command = command.commands[word]
        options = {name for parameter in command.params for name in parameter.opts}
        assert {word for word in words if word.startswith("--")} <= options | {"--help"}, words
    options = {name for command in commands(get_command(app)) for item in command.params for name in item.opts}
    assert {word for page in PAGES for word in OPTION.findall(prose(page))} <= options | {"--help"}
    targets = {word.split()[1] for page in PAGES for word in MAKE.findall(prose(page))}
    assert targets
    assert targets <= make_targets()


def commands(command: object) -> list:
    return [command, *(found for inner in getattr(command, "commands", {}).values() for found in commands(inner))]


def parse_command(words: list[str]) -> None:
    """Let the command line parse its arguments without doing anything; raises a usage error for wrong ones."""
    command: Any = get_command(app)
    while words and words[0] in getattr(command, "commands", {}):
        command, words = command.commands[words[0]], words[1:]
    assert not hasattr(command, "commands") or command.invoke_without_command, words
    command.make_context("robolang", list(words))


def make_targets() -> set[str]:
    return set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
