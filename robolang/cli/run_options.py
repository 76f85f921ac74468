"""Options of ``robolang run`` alone: how far it runs, what it prints and writes."""

import math
from pathlib import Path
from typing import Annotated, ClassVar

from robolang.cli.options import Group, Option, SimulationOptions, Strict
from robolang.cli.usage import OptionValueError


class RunOptions(SimulationOptions):
    """Which arm moves, how fast and how far."""

    max_time: Annotated[
        float | None,
        Option("--max-time", metavar="S", help="End the run with RBL509 after S s of simulated time; default: 1800 s."),
    ] = None
    until_line: Annotated[
        str | None,
        Option("--until-line", metavar="LINE", help="End the run before this line: its number, or a label as *NAME."),
    ] = None

    @property
    def most_us(self) -> int | None:
        """Longest simulated time, us, None: as usual; ``OptionValueError`` for a time that is none."""
        if self.max_time is None:
            return None
        most = self.max_time * 1e6
        if not 1.0 <= most < math.inf:
            raise OptionValueError("--max-time", f"{self.max_time:g} s is no time that a run can take")
        return round(most)


class OutputOptions(Group):
    """What a run prints and writes."""

    PANEL: ClassVar[str] = "Output and exit code"
    report: Annotated[Path | None, Option("--report", metavar="FILE", help="Write the report to this file (JSON).")] = (
        None
    )
    log: Annotated[
        Path | None,
        Option("--log", metavar="FILE", help="Write all signals: .npz (numpy) or .mcap (log viewers)."),
    ] = None
    html: Annotated[
        Path | None, Option("--html", metavar="FILE.html", help="Write a page that shows the run in a browser.")
    ] = None
    every: Annotated[
        bool, Option("--all", help="Print a row for each statement carried out; default: one for each line.")
    ] = False
    worst: Annotated[bool, Option("--worst", help="Print the row with the largest tool error first.")] = False
    as_json: Annotated[bool, Option("--json", help="Print the report (JSON), no table; PRINT to stderr.")] = False
    strict: Strict = False
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print errors only; with --strict warnings too.")] = False

    @property
    def warnings(self) -> bool:
        """Whether warnings are printed."""
        return self.strict or not self.quiet
