"""``check`` and ``repl`` read their options without typer, and read the same as typer does."""

import inspect
import random

import pytest
import typer
from typer.testing import CliRunner

from robolang.cli import quick
from robolang.cli.command import command
from tests.campaign import some

CHECK, REPL = quick.check(), quick.repl()
VALUES = ["a.rbl", "-", "RBL3", "12.5s", "", "x=y", "junit", "--", "-x", "--fix", "--no-such", "--help", "--watch=1"]


def parsed(words, of=CHECK):
    return quick.parsed(words, of)


def by_typer(words, of=CHECK):
    """The parameters of a command as typer reads them; None where it calls nothing."""
    calls = []

    def probe(**given):
        calls.append(given)

    probe.__signature__ = inspect.signature(of.function)  # type: ignore[attr-defined]
    app = typer.Typer()
    app.command()(command(probe))
    CliRunner().invoke(app, words)
    return calls[0] if calls else None


def drawn(seed, of=CHECK):
    draw = random.Random(seed)
    names = [name for _, _, option in quick.options_of(of) for name in option.names]
    return [
        draw.choice((draw.choice(names), draw.choice(VALUES), f"{draw.choice(names)}={draw.choice(VALUES)}"))
        for _ in range(draw.randint(0, 5))
    ]


@pytest.mark.parametrize("of", [CHECK, REPL], ids=["check", "repl"])
@pytest.mark.parametrize("seed", some(range(200), *range(20)))
def test_options_are_read_as_typer_reads_them(seed, of):
    words = drawn(seed, of)
    found = parsed(words, of)
    if found is not None:
        assert found == by_typer(words, of)


@pytest.mark.parametrize("variable", ["", "github"])
def test_a_variable_gives_the_format_and_an_option_overrides_it(variable, monkeypatch):
    monkeypatch.setenv("ROBOLANG_OUTPUT_FORMAT", variable)
    for words in ([], ["--output-format", "json"], ["--output-format=sarif", "a.rbl"]):
        assert parsed(words) == by_typer(words)
    assert parsed([])["report"].output_format == (variable or "full")


@pytest.mark.parametrize("words", [["--help"], ["--"], ["--no-such"], ["--select"], ["--fix=1"], ["--select", "-x"]])
def test_what_is_not_plain_is_left_to_typer(words):
    assert parsed(words) is None


@pytest.mark.parametrize("words", [["a.rbl", "b.rbl"], ["--record"], ["--realtime=1"], ["--help"]])
def test_what_a_prompt_does_not_take_is_left_to_typer(words):
    assert parsed(words, REPL) is None


@pytest.mark.parametrize("of", [CHECK, REPL], ids=["check", "repl"])
def test_most_of_what_is_drawn_is_compared(of):
    assert sum(parsed(drawn(seed, of), of) is not None for seed in range(200)) > 40
