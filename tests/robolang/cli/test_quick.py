"""``check`` reads its options without typer, and reads the same as typer does."""

import inspect
import random

import pytest
import typer
from typer.testing import CliRunner

from robolang.cli.command import command
from robolang.cli.commands.check import check
from robolang.cli.quick import _options, parsed
from tests.campaign import some

NAMES = [name for _, _, option in _options() for name in option.names]
VALUES = ["a.rbl", "-", "RBL3", "12.5s", "", "x=y", "junit", "--", "-x", "--fix", "--no-such", "--help", "--watch=1"]


def by_typer(words):
    """The parameters of ``check`` as typer reads them; None where it calls nothing."""
    calls = []

    def probe(**given):
        calls.append(given)

    probe.__signature__ = inspect.signature(check)  # type: ignore[attr-defined]
    app = typer.Typer()
    app.command()(command(probe))
    CliRunner().invoke(app, words)
    return calls[0] if calls else None


def drawn(seed):
    draw = random.Random(seed)
    return [
        draw.choice((draw.choice(NAMES), draw.choice(VALUES), f"{draw.choice(NAMES)}={draw.choice(VALUES)}"))
        for _ in range(draw.randint(0, 5))
    ]


@pytest.mark.parametrize("seed", some(range(200), *range(20)))
def test_options_are_read_as_typer_reads_them(seed):
    words = drawn(seed)
    found = parsed(words)
    if found is not None:
        assert found == by_typer(words)


@pytest.mark.parametrize("variable", ["", "github"])
def test_a_variable_gives_the_format_and_an_option_overrides_it(variable, monkeypatch):
    monkeypatch.setenv("ROBOLANG_OUTPUT_FORMAT", variable)
    for words in ([], ["--output-format", "json"], ["--output-format=sarif", "a.rbl"]):
        assert parsed(words) == by_typer(words)
    assert parsed([])["report"].output_format == (variable or "full")


@pytest.mark.parametrize("words", [["--help"], ["--"], ["--no-such"], ["--select"], ["--fix=1"], ["--select", "-x"]])
def test_what_is_not_plain_is_left_to_typer(words):
    assert parsed(words) is None


def test_most_of_what_is_drawn_is_compared():
    assert sum(parsed(drawn(seed)) is not None for seed in range(200)) > 40
