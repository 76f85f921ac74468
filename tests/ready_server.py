"""The process from which ``tests.ready`` forks commands: it has imported all of robolang, and carries nothing out.

What a fork of it carries out is ``robolang.__main__.main``, with streams, folder, environment and signals as a start of
Python sets them up. Run as ``python -m tests.ready_server SOCKET``.
"""

import contextlib
import fcntl
import gc
import importlib
import io
import json
import os
import pkgutil
import select
import signal
import socket
import sys
import termios
from typing import Any

MOST_BYTES = 1 << 20
_DEFAULTS = {
    signal.SIGINT: signal.default_int_handler,
    **dict.fromkeys((signal.SIGQUIT, signal.SIGHUP, signal.SIGTERM, signal.SIGCHLD), signal.SIG_DFL),
}


def import_all() -> None:
    """Import every module, and leave none of it to be looked through for garbage."""
    for root in map(importlib.import_module, ("runtime", "robolang")):
        for found in pkgutil.walk_packages(root.__path__, f"{root.__name__}."):
            if not found.name.endswith("__main__"):
                importlib.import_module(found.name)
    gc.collect()
    gc.freeze()


class Server:
    """Forks where it is told to over ``link``, and tells over a socket of each fork how that has ended."""

    def __init__(self, link: socket.socket) -> None:
        self._link = link
        self._ends: dict[int, socket.socket] = {}
        self._awake, wake = os.pipe()
        os.set_blocking(wake, False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)

    def request(self) -> tuple[dict[str, Any], list[int]] | None:
        """Wait for what is asked next, and fork; return it in the fork, and None at the end of the tests."""
        while True:
            ready, _, _ = select.select([self._link.fileno(), self._awake], [], [])
            if self._awake in ready:
                os.read(self._awake, 4096)
                self._reap()
            if self._link.fileno() not in ready:
                continue
            data, fds, _, _ = socket.recv_fds(self._link, MOST_BYTES, 4)
            if not data:
                return None
            pid = os.fork()
            end = socket.socket(fileno=fds.pop())
            if not pid:
                signal.set_wakeup_fd(-1)
                return json.loads(data), fds
            for fd in fds:
                os.close(fd)
            end.sendall(pid.to_bytes(4, "little"))
            self._ends[pid] = end

    def _reap(self) -> None:
        with contextlib.suppress(ChildProcessError):
            while True:
                pid, status, usage = os.wait4(-1, os.WNOHANG)
                if not pid:
                    return
                end = self._ends.pop(pid)
                with contextlib.suppress(OSError):
                    end.sendall(
                        json.dumps([os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime]).encode()
                    )
                end.close()


def become(how: dict[str, Any], fds: list[int]) -> None:
    """Take over the streams and all else of a command that begins."""
    for number, action in _DEFAULTS.items():
        signal.signal(number, action)
    if how["terminal"]:
        os.setsid()
        fcntl.ioctl(fds[0], termios.TIOCSCTTY, 0)
    for target, fd in enumerate(fds):
        os.dup2(fd, target)
    os.closerange(3, 256)
    os.chdir(how["cwd"])
    os.environ.clear()
    os.environ.update(how["env"])
    sys.argv = how["argv"]
    sys.stdin = _stream(0, "r", "strict")
    sys.stdout = _stream(1, "w", "strict")
    sys.stderr = _stream(2, "w", "backslashreplace")


def _stream(fd: int, mode: str, errors: str) -> io.TextIOWrapper:
    lines = fd == 2 or (fd == 1 and os.isatty(fd))
    return io.TextIOWrapper(open(fd, f"{mode}b", closefd=False), "utf-8", errors, line_buffering=lines)


def main() -> None:
    """Serve until the tests end; in a fork, be the command."""
    import_all()
    asked = Server(socket.socket(fileno=int(sys.argv[1]))).request()
    if asked is None:
        return
    become(*asked)
    from robolang.__main__ import main as command

    command()


if __name__ == "__main__":
    main()
