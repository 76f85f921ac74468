"""Keys of a terminal: arrows are not taken for Esc, whatever comes between."""

import os
import pty

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.pendant.foreground import Foreground
from robolang.pendant.interrupts import Interrupt
from robolang.pendant.keyboard import Keyboard, keys_in


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("x1+", ["x", "1", "+"]),
        ("\x1b", ["escape"]),
        ("\x1b\x1b", ["escape", "escape"]),
        ("\x1b ", ["escape", "space"]),
        ("\x1b[D\x1b[C", ["left", "right"]),
        ("\x1bOD\x1bOC", ["left", "right"]),
        ("\x1b[1;5D", [""]),
        ("\x1b[", [""]),
        ("\x1bO", [""]),
        ("\x1bx", [""]),
        ("\x1b[D\x1b", ["left", "escape"]),
        (" \r\n", ["space", "enter", "enter"]),
        ("\x1b[200~a \x1b[D\x1b[201~q", ["", "q"]),
        ("\x1b[200~never closed \x1b", [""]),
        ("\x00\x01\t", ["", "", ""]),
    ],
)
def test_keys_in_what_a_terminal_sends(text, expected):
    assert keys_in(text) == expected


@given(st.text(alphabet=st.sampled_from("\x1b[O~;1 AD q\x00\u0436")))
def test_any_text_has_keys(text):
    keys = keys_in(text)
    assert len(keys) <= len(text)
    assert "\x1b" in text or "escape" not in keys


@given(st.lists(st.sampled_from(["\x1b[D", "\x1b[C", "\x1bOA", "\x1b[1;2B", "\x1b[15~", "a"])))
def test_sequences_in_a_row_hold_no_escape(pieces):
    assert "escape" not in keys_in("".join(pieces))


@pytest.fixture
def ends():
    master, slave = pty.openpty()
    yield master, slave
    for end in (master, slave):
        try:
            os.close(end)
        except OSError:
            continue


def test_keys_are_read_at_once_and_without_echo(ends):
    master, slave = ends
    keyboard = Keyboard(slave)
    with keyboard.direct():
        assert keyboard.pressed() == []
        os.write(master, b"x\x1b[D")
        keyboard.wait(60.0)
        found = keyboard.pressed()
        while len(found) < 2:
            found += keyboard.pressed()
        assert found == ["x", "left"]
        os.set_blocking(master, False)
        with pytest.raises(BlockingIOError):
            os.read(master, 1)


@pytest.mark.parametrize(("keys", "expected"), [(b" ", Interrupt.STOP), (b"\x1b", Interrupt.STOP), (b"a\x1b[D", None)])
def test_esc_and_space_stop(ends, keys, expected):
    master, slave = ends
    foreground = Foreground(Keyboard(slave))
    with foreground.watched():
        assert foreground.take() is None
        os.write(master, keys)
        foreground.keyboard.wait(60.0)
        assert foreground.take() is expected
        assert foreground.stopped is (expected is not None)
        assert foreground.take() is None


def test_keys_that_repeat_do_not_halt(ends):
    master, slave = ends
    foreground = Foreground(Keyboard(slave))
    with foreground.watched():
        for _ in range(3):
            os.write(master, b" ")
            foreground.keyboard.wait(60.0)
            assert foreground.take() is Interrupt.STOP


def test_a_terminal_that_has_gone_stops_once_and_ends(ends):
    master, slave = ends
    foreground = Foreground(Keyboard(slave))
    with foreground.watched():
        os.close(master)
        foreground.keyboard.wait(60.0)
        assert foreground.take() is Interrupt.STOP
        assert foreground.lost
        assert foreground.signal == 1
        assert foreground.take() is None


def test_what_is_no_terminal_has_no_keys(tmp_path):
    with (tmp_path / "file").open("w+") as file:
        keyboard = Keyboard(file.fileno())
        with keyboard.direct():
            assert keyboard.pressed() == []
        assert keyboard.closed
