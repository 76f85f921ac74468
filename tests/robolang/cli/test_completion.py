"""Completion in shells: the scripts, and what the command answers when a script asks."""

import shutil
import subprocess
import sys

import pytest

from robolang.cli.command_table import TABLE
from robolang.cli.shells import SHELLS, VARIABLE
from tests.robolang.cli.commands import flat, robolang

NAMES = {entry.name for entry in TABLE}


def completed(shell, environment, *words):
    """What the command prints when the script of a shell asks for completions."""
    return subprocess.run(
        [sys.executable, "-m", "robolang"],
        env={**environment, VARIABLE: f"complete_{shell}"},
        capture_output=True,
        text=True,
        check=False,
    ).stdout


def in_bash(*words):
    asked = {"COMP_WORDS": " ".join(["robolang", *words]), "COMP_CWORD": str(len(words))}
    return completed("bash", asked).split()


def script(shell):
    return subprocess.run(
        [sys.executable, "-m", "robolang", "completion", shell], capture_output=True, text=True, check=True
    ).stdout


def test_commands_options_and_choices_are_completed():
    assert set(in_bash("")) == NAMES
    assert in_bash("rob") == ["robot"]
    assert set(in_bash("robot", "")) == {"list", "show", "import"}
    assert "--servo" in in_bash("run", "--ser")
    assert in_bash("run", "--servo", "s") == ["scheduled"]
    assert in_bash("run", "--servo", "x") == []


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (("new", "x", "--template", "p"), {"pick-place", "palletise"}),
        (("run", "--robot", "ur"), {"ur5e", "ur10e"}),
        (("robot", "show", "puma"), {"puma560"}),
        (("examples", "get", "palle"), {"palletise"}),
        (("help", "ru"), {"run", "rules"}),
        (("explain", "RBL41"), {"RBL410", "RBL411", "RBL412", "RBL413"}),
        (("completion", "z"), {"zsh"}),
    ],
)
def test_values_that_are_known_are_completed(words, found):
    assert set(in_bash(*words)) >= found
    assert all(value.startswith(words[-1]) for value in in_bash(*words))


@pytest.mark.parametrize("shell", ["zsh", "fish", "powershell"])
def test_each_shell_is_answered(shell):
    asked = {
        "_TYPER_COMPLETE_ARGS": "robolang rob",
        "_TYPER_COMPLETE_WORD_TO_COMPLETE": "rob",
        "_TYPER_COMPLETE_FISH_ACTION": "get-args",
    }
    shown = completed(shell, asked)
    assert "robot" in shown
    assert "Usage" not in shown


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_names_the_command_and_its_variable(shell):
    text = script(shell)
    assert "robolang" in text
    assert VARIABLE in text


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_reads_its_script(shell):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not there")
    assert subprocess.run([shell, "-n"], input=script(shell), text=True, check=False).returncode == 0


def test_another_shell_is_refused():
    shown = flat(robolang("completion", "csh", code=2).stderr)
    assert "RBL703" in shown
    assert all(shell in shown for shell in SHELLS)
