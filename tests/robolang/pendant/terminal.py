"""A prompt in a pseudo-terminal with a model of its screen: what somebody sees and types."""

import fcntl
import os
import re
import select
import subprocess
import termios
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pexpect
import pyte
from pexpect.fdpexpect import fdspawn

from tests.ready import COMMAND, Ready

WAIT_S = 120
"""The longest wait for something new on the screen; it ends a hang and measures nothing."""

_TYPING_S = 0.05

MOST_READS = 1000
"""The most that is read for one answer: the keys of a jog paint the screen twice a second as long as they are open."""

_ESCAPES = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07]*\x07|[@-Z\\-_])")


def _plain(raw: bytes) -> str:
    """Return what is painted, without colours and places."""
    return _ESCAPES.sub(b"", raw).decode("utf-8", "replace")


def _in_order(shown: str, texts: tuple[str, ...]) -> bool:
    at = 0
    for text in texts:
        at = shown.find(text, at)
        if at < 0:
            return False
        at += len(text)
    return True


def _fresh(
    words: Sequence[object], streams: Sequence[int], *, cwd: object, env: Mapping[str, str], terminal: bool
) -> "subprocess.Popen[bytes]":
    """Start a command as ``Ready`` does, in a Python of its own."""

    def take() -> None:
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    return subprocess.Popen(
        [COMMAND, *map(str, words)],
        cwd=str(cwd),
        env=dict(env),
        start_new_session=terminal,
        preexec_fn=take if terminal else None,
        stdin=streams[0],
        stdout=streams[1],
        stderr=streams[2],
    )


class Terminal:
    """``robolang repl``, or another ``command``, with a screen; ``raw`` are the bytes that it has sent.

    ``fresh``: in a Python that has yet to start.
    """

    def __init__(
        self,
        folder: Path,
        *arguments: str,
        columns: int = 100,
        rows: int = 30,
        physics: bool = False,
        command: str = "repl",
        fresh: bool = False,
        **environment: str,
    ) -> None:
        env = dict(os.environ, TERM="xterm-256color", XDG_STATE_HOME=str(folder / "state"))
        # a size in the environment, which workers of the tests have, would hide that of this terminal
        for name in ("NO_COLOR", "COLUMNS", "LINES"):
            env.pop(name, None)
        ours, theirs = os.openpty()
        termios.tcsetwinsize(theirs, (rows, columns))
        words = [command, *([] if physics else ["--no-physics"]), *arguments]
        start = _fresh if fresh else Ready
        self.process = start(words, [theirs] * 3, cwd=folder, env=env | environment, terminal=True)
        os.close(theirs)
        self._line = fdspawn(ours, timeout=WAIT_S)
        self.screen = pyte.Screen(columns, rows)
        # answers of the terminal, as to where the cursor is
        self.screen.write_process_input = self.send
        self._stream = pyte.ByteStream(self.screen)
        self.raw = b""

    def send(self, keys: str) -> None:
        # nobody types faster; what follows Esc at once would belong to it
        select.select([], [], [], _TYPING_S)
        self._line.send(keys.encode())

    def hang_up(self) -> None:
        """Take the terminal away."""
        self._line.close()

    def close(self) -> None:
        """Take the terminal away, and end the command if that does not."""
        self.hang_up()
        self.process.kill()
        self.process.wait()

    @property
    def lines(self) -> list[str]:
        return [line.rstrip() for line in self.screen.display]

    def shows(self, *texts: str) -> bool:
        lines = self.lines
        return all(any(text in line for line in lines) for text in texts)

    def until(self, *texts: str) -> list[str]:
        """Read until every text is on the screen, each within one line; return the lines."""
        return self._until(lambda: self.shows(*texts), f"{texts} not on the screen")

    def _until(self, holds: Callable[[], bool], why: str) -> list[str]:
        """Read until a condition holds, ``MOST_READS`` times at most: a screen that is painted again is no progress."""
        for _ in range(MOST_READS):
            if holds():
                return self.lines
            self.read(why)
        raise AssertionError("\n".join([f"{why}: too late", *self.lines]))

    def enter(self, line: str, *texts: str, then: str = "armed") -> None:
        """Type a line, and read until its answers are there, in their order, and what comes ``then``: the status."""
        self.send(line)
        self.until(line)
        start = len(self.raw)
        self.send("\r")
        self.until_new(start, *texts, then)

    def until_new(self, start: int, *texts: str) -> None:
        """Read until what was sent from a byte on has the texts, in their order."""
        self._until(lambda: _in_order(_plain(self.raw[start:]), texts), f"{texts} not shown")

    def until_gone(self, text: str) -> None:
        self._until(lambda: not self.shows(text), f"{text} stays on the screen")

    def ended(self) -> int:
        """Read until the process ends; return its exit code."""
        for _ in range(MOST_READS):
            try:
                data = self._line.read_nonblocking(65536, timeout=WAIT_S)
            except pexpect.EOF:
                break
            self.raw += data
            self._stream.feed(data)
        else:
            raise AssertionError("\n".join(["it does not end", *self.lines]))
        return self.process.wait()

    def read(self, why: str = "nothing new on the screen") -> None:
        try:
            data = self._line.read_nonblocking(65536, timeout=WAIT_S)
        except (pexpect.TIMEOUT, pexpect.EOF) as error:
            raise AssertionError("\n".join([f"{why}: {type(error).__name__}", *self.lines])) from None
        self.raw += data
        self._stream.feed(data)
