"""Single keys of a terminal, read at once and without echo, while no line is being typed.

A terminal sends an arrow key as several characters that begin with the one of Esc. They arrive together, so the Esc key
is one that nothing follows.
"""

import os
import select
import termios
from collections.abc import Iterator
from contextlib import contextmanager, suppress

_ESC = "\x1b"
_SEQUENCES = {
    "[D": "left",
    "OD": "left",
    "[C": "right",
    "OC": "right",
    "[A": "up",
    "OA": "up",
    "[B": "down",
    "OB": "down",
    "OP": "f1",
    "[11~": "f1",
}
_NAMED = {"\r": "enter", "\n": "enter", " ": "space", "\x03": "c-c", "\x04": "c-d", "\x7f": "backspace"}
_FOLLOWS_S = 0.004
"""What belongs to an Esc that ends a read arrives within this time, less than a cycle of 8 ms."""
_MOST = 4096


def keys_in(text: str) -> list[str]:
    """Return the names of the keys in what a terminal has sent; keys that are not used here have the name ``""``.

    A letter is itself; an arrow is ``left`` or ``right``; a key with Alt has no use. A pasted text is no key at all.
    """
    keys: list[str] = []
    at = 0
    while at < len(text):
        if text[at] != _ESC:
            keys.append(_NAMED.get(text[at], text[at] if text[at].isprintable() else ""))
            at += 1
            continue
        length = _sequence(text[at + 1 :])
        if text.startswith("[200~", at + 1):
            end = text.find(f"{_ESC}[201~", at)
            at = len(text) if end < 0 else end + len("[201~") + 1
            keys.append("")
        elif length == 0:
            keys.append("escape")
            at += 1
        else:
            keys.append(_SEQUENCES.get(text[at + 1 : at + 1 + length], ""))
            at += 1 + length
    return keys


def _sequence(text: str) -> int:
    """Return how many characters after an Esc belong to it; 0: it is the key."""
    if not text or text[0] in (_ESC, " "):  # Esc pressed twice, or with the other key that stops
        return 0
    if text[0] == "O":
        return min(2, len(text))
    if text[0] != "[":
        return 1
    # parameters and intermediates end with a character from @ on (ECMA-48)
    return next((at + 1 for at in range(1, len(text)) if "@" <= text[at] <= "~"), len(text))


class Keyboard:
    """The keys of the terminal with file descriptor ``fd``. ``closed``: it has gone."""

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self.closed = False

    @contextmanager
    def direct(self) -> Iterator[None]:
        """Read single keys without echo until the end; Ctrl-C stays a signal."""
        try:
            before = termios.tcgetattr(self._fd)
        except termios.error:  # it has gone, or is no terminal
            yield
            return
        now = termios.tcgetattr(self._fd)
        now[3] &= ~(termios.ICANON | termios.ECHO)
        now[6][termios.VMIN], now[6][termios.VTIME] = 0, 0
        # at once and without discarding: what was typed just before counts
        termios.tcsetattr(self._fd, termios.TCSANOW, now)
        try:
            yield
        finally:
            with suppress(termios.error):
                termios.tcsetattr(self._fd, termios.TCSANOW, before)

    def pressed(self) -> list[str]:
        """Return the keys that were pressed since the last call; never waits for one."""
        raw = self._read()
        if raw.endswith(_ESC.encode()) and self._is_ready(_FOLLOWS_S):
            raw += self._read()
        return keys_in(raw.decode("utf-8", "replace"))

    def wait(self, seconds: float) -> None:
        """Wait until a key is pressed, at most so long."""
        self._is_ready(seconds)

    def _read(self) -> bytes:
        raw = b""
        while not self.closed and len(raw) < _MOST and self._is_ready(0.0):
            try:
                part = os.read(self._fd, 1024)
            except OSError:  # the other side of the terminal was closed
                part = b""
            # ready, and nothing there: the end of the input
            self.closed = not part
            raw += part
        return raw

    def _is_ready(self, seconds: float) -> bool:
        try:
            return bool(select.select([self._fd], [], [], seconds)[0])
        except (OSError, ValueError):
            self.closed = True
            return False
