"""The hooks for pre-commit name commands and options that exist."""

import re
from pathlib import Path

from typer.main import get_command

from robolang.cli.main import app

ROOT = Path(__file__).parents[2]


def hooks():
    """The hooks as dictionaries: a reader of the few forms of YAML that the file uses."""
    text = (ROOT / ".pre-commit-hooks.yaml").read_text("utf-8")
    blocks = re.split(r"^- ", text, flags=re.MULTILINE)[1:]
    return [dict(re.findall(r"^\s*(\w+): (.+)$", block, re.MULTILINE)) for block in blocks]


def test_hooks_are_whole():
    assert [hook["id"] for hook in hooks()] == ["robolang-check", "robolang-format"]
    for hook in hooks():
        plain = [value for key, value in hook.items() if key != "args"]
        assert not any(re.search(r":\s|\s#|^[\[\]{}&*!|>'\"%@`]", value) for value in plain)
        assert {"id", "name", "description", "entry", "language", "files"} <= hook.keys()
        assert hook["language"] == "python"
        assert re.search(hook["files"], "cell/pick.rbl")
        assert not re.search(hook["files"], "cell/pick.points.toml")


def test_hooks_run_commands_that_exist():
    for hook in hooks():
        program, name = hook["entry"].split()
        command = get_command(app).commands[name]
        assert program == "robolang"
        options = {form for parameter in command.params for form in parameter.opts}
        assert set(re.findall(r"--[\w-]+", hook.get("args", ""))) <= options
