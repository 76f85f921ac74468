import pytest

import robolang as package
from tests.robolang.cli.commands import robolang, shell


@pytest.mark.parametrize("command", ["run", "check", "explain", "kin", "robot"])
def test_every_command_has_help_at_80_columns(command):
    text = robolang(command, "--help").stdout
    assert "Usage" in text
    assert max(map(len, text.splitlines())) <= 80


def test_the_commands_are_listed():
    text = robolang("--help").stdout
    assert all(f"│ {command} " in text for command in ("run", "check", "explain", "kin", "robot"))


@pytest.mark.parametrize("words", [("frob",), ("--frob",), ("robot", "frob"), ("run",), ()])
def test_a_wrong_call_is_exit_code_2(words):
    result = robolang(*words, code=2)
    assert "Usage" in result.stdout + result.stderr


def test_a_near_command_is_suggested():
    assert "'check'" in robolang("chekc", code=2).stderr


def test_the_version_is_answered_as_a_module():
    result = shell("--version")
    assert (result.returncode, result.stdout) == (0, f"robolang {package.__version__}\n")
