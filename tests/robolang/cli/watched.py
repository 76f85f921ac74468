"""Runs under an audit hook: ``python -m tests.robolang.cli.watched PROGRAM [SEED ...]`` prints what Python is asked.

CPython announces every file that is opened, every socket, process and text that is compiled, and a hook cannot be taken
out again (PEP 578). What a program asks for on the ideal arm is printed as JSON, by seed, each ``[event, first
argument]``. With a ``SEED`` the number that PRINT shows is made by code that breaks the promise, so that one sees the
hook notice it. ``PROGRAM`` is a file, or with ``-`` the arguments behind it are a whole command line of ``robolang``.
"""

import json
import os
import socket
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress

FORBIDDEN = (
    "open",
    "exec",
    "compile",
    "import",
    "ctypes.",
    "fcntl.",
    "ftplib.",
    "http.",
    "marshal.",
    "mmap.",
    "os.",
    "pickle.",
    "pty.",
    "shutil.",
    "smtplib.",
    "socket.",
    "subprocess.",
    "tempfile.",
    "urllib.",
    "code.__new__",
    "cpython.run",
    "glob.",
    "sqlite3.",
    "webbrowser.",
)
LEAVING = (
    "socket.",
    "subprocess.",
    "os.system",
    "os.exec",
    "os.posix_spawn",
    "os.fork",
    "os.remove",
    "os.rename",
    "os.mkdir",
    "os.rmdir",
    "shutil.",
)
SEEDS: dict[str, Callable[[], object]] = {
    "open": lambda: open("/dev/null").close(),  # noqa: PTH123
    "os.open": lambda: os.close(os.open("/dev/null", os.O_WRONLY)),
    "os.remove": lambda: _in_vain(os.remove),
    "os.mkdir": lambda: _in_vain(os.mkdir),
    "socket.socket": lambda: socket.socket().close(),
    "subprocess.Popen": lambda: subprocess.run(["true"], check=True),
    "os.system": lambda: os.system("true"),
    "eval": lambda: eval("1 + 1"),
    "exec": lambda: exec("x = 1"),
    "import": lambda: __import__("colorsys"),  # a module that nothing else needs
}


def _in_vain(call: Callable[[str], object]) -> None:
    with suppress(OSError):
        call("/nowhere/at/all")


class Watch:
    """The events since ``on`` was set."""

    def __init__(self) -> None:
        self.on = False
        self.seen: list[tuple[str, str]] = []
        sys.addaudithook(self._hook)

    def _hook(self, event: str, arguments: tuple[object, ...]) -> None:
        if self.on and event.startswith(FORBIDDEN):
            self.seen.append((event, "" if not arguments else str(arguments[0])[:200]))


def watched(program: str, seed: str) -> list[tuple[str, str]]:
    """Return the events of one run of a program, from the first statement to the last."""
    from robolang.evaluation import evaluator
    from robolang.execution.dry_run import motion_check
    from robolang.execution.observer import Observer
    from robolang.execution.session import Session
    from robolang.project.project import load_project

    project = load_project(program)
    assert project.ok, project.diagnostics
    assert motion_check(project) == ()
    printed: list[str] = []

    class Printed(Observer):
        def printed(self, text: str) -> None:
            printed.append(text)

    # as robolang run without --log: a log that is kept would go into a temporary file
    session = Session(project, physics=False, observer=Printed(), log=False)
    shown_by = vars(evaluator)
    plain = shown_by["shown"]
    if seed:
        violate = SEEDS[seed]

        def shown(value: float) -> str:
            violate()
            return plain(value)

        shown_by["shown"] = shown
    watch = Watch()
    watch.on = True
    result = session.run()
    watch.on = False
    shown_by["shown"] = plain
    assert result.ok, result.report["alarms"]
    assert printed
    return watch.seen


def command(words: list[str]) -> list[tuple[str, str]]:
    """Return the events of a whole command line that leave the process or write, from its start to its end."""
    from robolang.__main__ import main

    seen: list[tuple[str, str]] = []

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        if event == "open" and isinstance(arguments[0], int):
            return  # what was opened by name before
        if event == "open" and isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR):
            seen.append(("write", str(arguments[0])))
        elif event.startswith(LEAVING):
            seen.append((event, str(arguments[0])))

    sys.addaudithook(hook)
    sys.argv[1:] = words
    try:
        main()
    except SystemExit as left:
        assert not left.code, left.code
    return seen


if __name__ == "__main__":
    words = sys.argv[1:]
    if words[0] == "-":
        found = {"": command(words[1:])}
    else:
        found = {seed: watched(words[0], seed) for seed in words[1:] or ("",)}
    sys.stderr.write(json.dumps(found) + "\n")
