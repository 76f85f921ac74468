"""Commands of robolang as processes that are there at once: forks of one that has imported everything.

To start Python, numpy, Pinocchio and MuJoCo takes more than half a second of processor time, most of what a test of the
prompt or of a page costs. From ``main`` on a fork does what a process does, to its exit code. What comes before, and
that a command imports what it needs, is seen by the tests that start processes of their own
(``tests.robolang.cli.commands.shell``).
"""

import json
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from tests.steps import HANG_S

ROOT = Path(__file__).parents[1]
COMMAND = str(Path(sys.executable).with_name("robolang"))
_spent = [0.0]


class _Server:
    """The process of ``tests.ready_server``, one for each process of the tests that needs it."""

    def __init__(self) -> None:
        self.link, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        env = {**os.environ, "MUJOCO_GL": "disable", "PYTHONSAFEPATH": "", "PYTHONPATH": str(ROOT)}
        words = [sys.executable, "-m", "tests.ready_server", str(theirs.fileno())]
        self.process = subprocess.Popen(words, cwd=ROOT, env=env, pass_fds=[theirs.fileno()])
        theirs.close()

    def close(self) -> None:
        self.link.close()
        self.process.wait(HANG_S)


_servers: list[_Server] = []


def close() -> None:
    """End the process that commands are forked from; its time counts as that of a child from here on."""
    while _servers:
        _servers.pop().close()
    _spent[0] = 0.0


def spent_s() -> float:
    """Return the processor time of the commands that have ended, s."""
    return _spent[0]


class Ready:
    """A command that runs; ``streams`` are the file descriptors of its input, output and errors.

    With ``terminal`` they are those of a terminal, which becomes that of the command.
    """

    def __init__(
        self, words: Sequence[object], streams: Sequence[int], *, cwd: object, env: Mapping[str, str], terminal: bool
    ) -> None:
        if not _servers:
            _servers.append(_Server())
        how = {"argv": [COMMAND, *map(str, words)], "cwd": str(cwd), "env": dict(env), "terminal": terminal}
        self._end, theirs = socket.socketpair()
        socket.send_fds(_servers[0].link, [json.dumps(how).encode()], [*streams, theirs.fileno()])
        theirs.close()
        self.pid = int.from_bytes(self._end.recv(4), "little")
        self.returncode: int | None = None
        """As that of ``subprocess.Popen``."""

    def poll(self) -> int | None:
        """Return the exit code, None while it runs."""
        if self.returncode is None and select.select([self._end], [], [], 0.0)[0]:
            self._ended()
        return self.returncode

    def wait(self, timeout: float = HANG_S) -> int:
        """Return the exit code once it has ended."""
        if self.returncode is None:
            assert select.select([self._end], [], [], timeout)[0], "it does not end"
            self._ended()
        assert self.returncode is not None
        return self.returncode

    def _ended(self) -> None:
        self.returncode, spent = json.loads(self._end.recv(256))
        self._end.close()
        _spent[0] += spent

    def send_signal(self, number: int) -> None:
        """Send a signal, unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        """End it, unless it has ended."""
        self.send_signal(signal.SIGKILL)


class Piped(Ready):
    """A command that reads a few lines and whose ``stdout`` and ``stderr`` are read here, as text."""

    def __init__(self, words: Sequence[object], *, cwd: Path | None = None, typed: str = "") -> None:
        (theirs_in, typing), (out, theirs_out), (err, theirs_err) = os.pipe(), os.pipe(), os.pipe()
        os.write(typing, typed.encode())
        os.close(typing)
        theirs = (theirs_in, theirs_out, theirs_err)
        super().__init__(words, theirs, cwd=cwd or Path.cwd(), env=os.environ, terminal=False)
        for fd in theirs:
            os.close(fd)
        self.stdout, self.stderr = (os.fdopen(fd, encoding="utf-8") for fd in (out, err))

    def communicate(self) -> tuple[str, str]:
        """Return what is left to read, once it has ended; nothing the second time."""
        found = "", ""
        if not self.stdout.closed:
            with self.stdout, self.stderr:
                found = self.stdout.read(), self.stderr.read()
        self.wait()
        return found
