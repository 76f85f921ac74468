import errno

import pytest

import robolang.project.project  # noqa: F401 - registers its codes
from robolang.cli import errors
from robolang.cli.errors import exit_code, reported, say
from robolang.cli.usage import OptionValueError
from robolang.core.diagnostics import safe
from runtime.core.faults import Fault, all_codes
from runtime.core.tomlfile import Source
from tests.messages import heads
from tests.together import together


def left_with(error):
    with pytest.raises(SystemExit) as caught, reported():
        raise error
    return caught.value.code


EXPECTED = {"1": 1, "2": 1, "3": 2, "40": 1, "4": 3, "5": 3, "6": 2, "7": 2, "8": 2, "9": 70}


@together("code", [entry.code for entry in all_codes()])
def test_every_registered_code_has_the_exit_code_of_its_group(code):
    special = {
        "RBL301": 1,
        "RBL312": 4,
        "RBL706": 4,
        "RBL804": 3,
        "RBL805": 1,
        "RBL806": 3,
        "RBL809": 3,
        "RBL810": 4,
        "RBL811": 3,
        "RBL841": 4,
    }
    assert exit_code(code) == special.get(code, EXPECTED.get(code[3:5], EXPECTED[code[3]]))


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("RBL112", 1),
        ("RBL201", 1),
        ("RBL301", 1),
        ("RBL303", 2),
        ("RBL401", 1),
        ("RBL404", 1),
        ("RBL410", 3),
        ("RBL412", 3),
        ("RBL510", 3),
        ("RBL606", 2),
        ("RBL701", 2),
        ("RBL706", 4),
        ("RBL708", 2),
        ("RBL900", 70),
    ],
)
def test_exit_codes_by_name(code, expected, capsys):
    assert exit_code(code) == expected
    assert left_with(Fault(code, "wrong")) == expected
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"error {code} wrong\n  help: ")


def test_a_fault_of_a_file_is_said_with_its_place_and_its_line(capsys):
    with pytest.raises(Fault) as caught:
        Source("a.toml", "x = 1\ny = \x1b2\n").fail("RBL605", "large", "shrink", ["y"])
    assert say(caught.value) == 2
    assert capsys.readouterr().err == ("a.toml:2:1: error RBL605 large\n   2 | y = \ufffd2\n     | ^\n  help: shrink\n")


@pytest.mark.parametrize("error", [ValueError("x"), RecursionError("deep"), OSError(errno.EPERM, "no"), MemoryError()])
def test_anything_else_is_an_internal_error_without_a_trace(error, capsys, monkeypatch):
    monkeypatch.delenv("ROBOLANG_DEBUG", raising=False)
    assert left_with(error) == 70
    said = capsys.readouterr().err
    assert said.startswith("error RBL900 ")
    assert type(error).__name__ in said
    assert "ROBOLANG_DEBUG=1" in said
    assert "Traceback" not in said


class UnprintableError(Exception):
    def __str__(self):
        raise RuntimeError("no text")


@pytest.mark.parametrize("error", [UnprintableError(), Fault("RBL510", None), OSError(errno.EPERM, "no")])
def test_a_fault_that_cannot_be_shown_is_an_internal_error(error, capsys, monkeypatch):
    """Showing it raises: a text that fails, a message that is none, and a printer that fails the first time."""
    monkeypatch.delenv("ROBOLANG_DEBUG", raising=False)
    if isinstance(error, OSError):
        shown = iter([safe])
        monkeypatch.setattr(errors, "safe", lambda text: safe(text) if next(shown, None) is None else 1 / 0)
    assert left_with(error) == 70
    said = capsys.readouterr().err
    assert heads(said) == ["error RBL900"]
    assert "Traceback" not in said


@pytest.mark.parametrize("error", [Fault("RBL510", "x"), ValueError("x")])
def test_where_nothing_can_be_shown_the_exit_code_is_left(error, monkeypatch):
    monkeypatch.delenv("ROBOLANG_DEBUG", raising=False)
    monkeypatch.setattr(errors, "show_finding", lambda *_, **__: 1 / 0)
    assert left_with(error) == 70


def test_robolang_debug_shows_where_it_happened(monkeypatch):
    monkeypatch.setenv("ROBOLANG_DEBUG", "1")
    with pytest.raises(ValueError, match="here"), reported():
        raise ValueError("here")


def test_a_keyboard_interrupt_is_exit_code_130(capsys):
    assert left_with(KeyboardInterrupt()) == 130
    assert capsys.readouterr().err == ""


def test_a_full_output_is_a_storage_fault(capsys):
    assert left_with(OSError(errno.ENOSPC, "full")) == 4
    said = capsys.readouterr().err
    assert heads(said) == ["error RBL706"]
    assert "full" in said


@pytest.mark.parametrize("error", [SystemExit(7), OptionValueError("--axis", "no")])
def test_what_ends_a_command_on_purpose_passes(error):
    with pytest.raises(type(error)) as caught, reported():
        raise error
    assert caught.value is error
