"""What ``robolang run`` shows while a program runs: what it prints, and where it is.

On a terminal the progress is one live line, elsewhere one line for each statement. It goes to stderr.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from robolang.cli.output import echo
from robolang.core.diagnostics import safe
from robolang.execution.observer import Observer
from robolang.execution.result import StatementRun
from runtime.core.program_line import named

_CYCLES = 25
"""Cycles between two updates of the progress: 0.2 s of the robot."""

Tell = Callable[[StatementRun, int], None]
"""Shows the running statement and the simulated time in us."""


class RunProgress(Observer):
    """Shows a run to people."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._cycle = tell, 0
        self._run: StatementRun | None = None

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Show the statement that begins."""
        self._run = run
        self._tell(run, time_us)

    def cycle_done(self, time_us: int) -> None:
        """Show the time every few cycles."""
        self._cycle += 1
        if self._run is not None and self._cycle % _CYCLES == 0:
            self._tell(self._run, time_us)

    def printed(self, text: str) -> None:
        """Show what the program prints, as it prints it."""
        echo(safe(text))


@contextmanager
def shown(quiet: bool) -> Iterator[RunProgress]:
    """Yield what shows a run: what it prints, and unless ``quiet`` its progress."""
    if quiet:  # what the program itself prints is its result, and is printed all the same
        yield RunProgress(lambda statement, time_us: None)
    elif sys.stderr is not None and sys.stderr.isatty():
        with _live_line() as tell:
            yield RunProgress(tell)
    else:
        yield RunProgress(_line_printer())


@contextmanager
def _live_line() -> Iterator[Tell]:
    from rich.text import Text

    from robolang.cli.console import Console

    with Console(stderr=True).status("starting") as status:
        yield lambda statement, time_us: status.update(
            Text(_status(statement, time_us), no_wrap=True, overflow="ellipsis")
        )


def _line_printer() -> Tell:
    shown: list[tuple[StatementRun, str]] = []

    def tell(statement: StatementRun, time_us: int) -> None:
        if not shown or shown[-1][0] is not statement or (statement.lamp and statement.lamp != shown[-1][1]):
            shown[:] = [(statement, statement.lamp)]
            echo(_status(statement, time_us), err=True)

    return tell


def _status(statement: StatementRun, time_us: int) -> str:
    where = named(statement.origin.line, statement.origin.number)
    lamp = f"[{statement.lamp}]  " if statement.lamp else ""
    return f"{time_us / 1e6:9.3f} s  {where:<9} {lamp}{statement.text}"
