"""``--help`` of every command: each option once, with its help text, in the panel of its group, at 80 columns."""

import re
import shlex
import signal
import subprocess
import sys
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from robolang.cli.command import command
from robolang.cli.command_table import TABLE
from robolang.cli.errors import DIAGNOSTICS, INTERNAL, INTERRUPTED, MOTION, STORAGE, USAGE
from robolang.cli.main import app
from robolang.cli.options import Group, Option
from tests.robolang.cli.commands import flat, robolang


def commands(found=None, words=(), depth=9):
    """Every command, or group at a depth, with the words that call it."""
    found = typer.main.get_command(app) if found is None else found
    if not hasattr(found, "commands") or len(words) == depth:
        return [(words, found)]
    return [each for name, inner in found.commands.items() for each in commands(inner, (*words, name), depth)]


COMMANDS = commands()
EXIT_CODES = {0, DIAGNOSTICS, USAGE, MOTION, STORAGE, INTERNAL, INTERRUPTED, 128 + signal.SIGTERM}


@pytest.mark.parametrize(("words", "found"), COMMANDS, ids=[" ".join(words) for words, _ in COMMANDS])
def test_every_option_is_in_the_help_with_its_text(words, found):
    text = robolang(*words, "--help").stdout
    assert all(len(line) <= 80 for line in text.splitlines())
    for parameter in found.params:
        assert parameter.help, parameter.name
        assert parameter.help.endswith("."), parameter.help
        if isinstance(parameter, typer.core.TyperOption) and parameter.name != "help":
            (name, *_) = parameter.opts
            assert len(re.findall(rf"(?m)^│ (?:\*? +)?(?:-\w,? +)?{name} ", text)) == 1, name
            assert f" {parameter.rich_help_panel} " in text


@pytest.mark.parametrize(("words", "found"), COMMANDS, ids=[" ".join(words) for words, _ in COMMANDS])
def test_the_help_is_for_people_who_know_no_python_and_names_the_exit_codes(words, found):
    text = robolang(*words, "--help").stdout
    assert not re.search(r"[<{](?!=)", text), "the type of an option, or an argument in braces"
    paragraph = flat(re.split(r"\n *\n", text.partition("Exit codes: ")[2])[0])
    codes = [int(code) for code in re.findall(r"(?:^|; |or )(\d+)", paragraph)]
    assert codes == sorted(codes)
    assert codes[0] == 0
    assert set(codes) <= EXIT_CODES
    assert "\n " not in found.help.partition("Exit codes")[2]  # wrapped where the terminal ends, not the source


@pytest.mark.parametrize(("words", "found"), COMMANDS, ids=[" ".join(words) for words, _ in COMMANDS])
def test_the_help_has_an_example_that_the_command_accepts(words, found):
    (example,) = re.findall(r"(?m)^Example: robolang (.+)$", found.help.replace(r"\[", "["))
    given = shlex.split(example)
    assert given[: len(words)] == list(words)
    found.make_context(words[-1], given[len(words) :])
    assert flat(f"Example: robolang {example}") in flat(robolang(*words, "--help").stdout)


@pytest.mark.parametrize(("words", "found"), COMMANDS, ids=[" ".join(words) for words, _ in COMMANDS])
def test_no_word_of_a_help_text_is_lost(words, found):
    """What stands in brackets is taken for a style."""
    for parameter in found.params:
        assert not re.search(r"\[[a-z]", parameter.help or ""), parameter.name
    shown = flat(robolang(*words, "--help").stdout)
    assert all(word in shown for word in re.findall(r"\[\w+\]", found.help))


@pytest.mark.parametrize("entry", TABLE, ids=lambda entry: entry.name)
def test_the_list_of_commands_says_what_the_command_says(entry):
    (found,) = (each for words, each in commands(depth=1) if words == (entry.name,))
    assert found.help.replace(r"\[", "[").partition("\n\n")[0] == entry.help
    assert f" {entry.panel} " in robolang("--help").stdout


@pytest.mark.parametrize("words", [("run",), ("robot", "import")], ids=" ".join)
def test_help_is_asked_for_in_three_forms(words):
    shown = {flat(robolang(*typed).stdout) for typed in (("help", *words), (*words, "-h"), (*words, "--help"))}
    assert len(shown) == 1
    assert f"robolang {' '.join(words)} [OPTIONS]" in shown.pop()


def test_help_of_what_is_no_command_explains_it_or_says_that_it_is_unknown():
    assert robolang("help", "rbl412").stdout == robolang("explain", "RBL412").stdout
    assert "RBL703" in robolang("help", "zzzzzz", code=2).stderr
    assert {"RBL703", "run"} <= set(re.findall(r"[\w-]+", flat(robolang("help", "runn", code=2).stderr)))
    assert robolang("help").stdout == robolang("--help").stdout


def test_the_list_of_commands_imports_none_of_them():
    code = (
        "import sys; from typer.testing import CliRunner; from robolang.cli.main import app;"
        "assert CliRunner().invoke(app, ['--help']).exit_code == 0;"
        "print([name for name in sys.modules if name.startswith('robolang.cli.commands.')])"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown.strip() == "[]"


def test_all_exit_codes_are_in_the_help_of_the_program():
    paragraph = flat(robolang("--help").stdout.partition("Exit codes: ")[2])
    assert {int(code) for code in re.findall(r"(?:^|[;,] )(\d+)", paragraph)} == EXIT_CODES


def test_a_number_has_its_unit_in_its_help():
    units = re.compile(r"\b(deg|mm|ms|s|Hz|kg|from 1|from one number|[Nn]umber|angles|a time)\b")
    numbers = ("integer", "float", "integer range", "float range")
    for words, found in COMMANDS:
        for parameter in found.params:
            if parameter.type.name in numbers and parameter.name != "error":  # the seed of a random generator
                assert units.search(parameter.help), (words, parameter.name, parameter.help)


def groups(base=Group):
    """Every group of options of the commands."""
    return [
        each for group in base.__subclasses__() for each in (group, *groups(group)) if "robolang" in each.__module__
    ]


def test_an_option_of_one_meaning_is_declared_once():
    declared = {(option.names[0], option.help): set() for group in groups() for _, _, option, _ in group.options()}
    for group in groups():
        for _, _, option, _ in group.options():
            declared[option.names[0], option.help].add(id(option))
    assert {name: ids for name, ids in declared.items() if len(ids) > 1} == {}
    flags = [option for group in groups() for _, kind, option, _ in group.options() if kind is bool]
    same = {option.names[0]: {other.help for other in flags if other.names == option.names} for option in flags}
    # two options of one name with two meanings: what they print is another thing
    assert {name for name, helps in same.items() if len(helps) > 1} == {"--diff", "--json"}


def test_a_value_that_is_no_choice_is_refused_before_the_command_starts():
    result = flat(robolang("step", "--robot", "no-such", "--axis", "1", "--plant", "wood", code=2).stderr)
    assert "RBL703 --plant: 'wood' is not one of mujoco, rigid" in result


def test_a_command_has_the_options_of_its_groups():
    class Sizes(Group):
        PANEL = "Sizes"
        width: Annotated[float, Option("--width", help="Width, mm.")] = 1.0

    calls = []

    @command
    def build(sizes: Sizes) -> None:
        calls.append(sizes)

    probe = typer.Typer()
    probe.command()(build)
    result = CliRunner().invoke(probe, ["--width", "2.5"])
    assert result.exit_code == 0
    assert calls == [Sizes(width=2.5)]


def test_no_command_has_options_of_the_library():
    for entry in TABLE:
        assert "completion" not in robolang(entry.name, "--help").stdout or entry.name == "completion"
