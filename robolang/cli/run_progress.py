"""What ``robolang run`` shows while a program runs: what it prints, and where it is.

On a terminal the progress is a panel (``run_panel``), elsewhere one line for each statement. It goes to stderr.
"""

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from robolang.cli.output import echo
from robolang.cli.run_output import RunOutput
from robolang.execution.outlook import PlannedStep
from robolang.execution.result import StatementRun
from runtime.core.program_line import named

_CYCLES = 25
"""Cycles between two readings of the lamp of a statement: 0.2 s of the robot."""


class LineProgress(RunOutput):
    """Shows each statement in a line when it begins, and again when its lamp changes."""

    def __init__(self) -> None:
        self._run: StatementRun | None = None
        self._lamp, self._cycle = "", 0

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Print the statement that begins."""
        self._run = run
        self._print(run, time_us)

    def cycle_done(self, time_us: int) -> None:
        """Print a lamp that has come on since."""
        self._cycle += 1
        if self._cycle % _CYCLES == 0 and self._run is not None and self._run.lamp not in ("", self._lamp):
            self._print(self._run, time_us)

    def _print(self, run: StatementRun, time_us: int) -> None:
        self._lamp = run.lamp
        where = named(run.origin.line, run.origin.number)
        lamp = f"[{run.lamp}]  " if run.lamp else ""
        echo(f"{time_us / 1e6:9.3f} s  {where:<9} {lamp}{run.text}", err=True)


@contextmanager
def shown(quiet: bool, steps: Sequence[PlannedStep]) -> Iterator[RunOutput]:
    """Yield what shows a run: what it prints, and unless ``quiet`` its progress along the ``steps`` rehearsed."""
    if quiet:  # what the program itself prints is its result, and is printed all the same
        yield RunOutput()
    elif _is_screen():
        from robolang.cli.run_panel import panel

        with panel(steps) as progress:
            yield progress
    else:
        yield LineProgress()


def _is_screen() -> bool:
    """Return whether what stands on stderr can be replaced, which neither a file nor a terminal of lines allows."""
    # rich takes these two names for terminals without control
    return sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM", "") not in ("dumb", "unknown")
