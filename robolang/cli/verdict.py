"""The last line of a run: how it ended, after how long, and OK or FAILED as the last word."""

from typing import TYPE_CHECKING

from robolang.cli.run_table import counted

if TYPE_CHECKING:
    from robolang.execution.result import RunResult

OK, FAILED = "OK", "FAILED"
REFUSED = f"nothing has moved: {FAILED}"
"""The last line for a program that is not run."""


def verdict(result: "RunResult", ended: str, code: int) -> str:
    """Return the last line of a run that ``ended`` so, with the exit code of the command."""
    warnings = counted(len(result.warnings), "warning")
    seconds = result.report["sim_time_s"]
    with_them = f" with {warnings}" if result.warnings else ""
    return f"{ended} after {seconds:.3f} s{with_them}: {FAILED if code else OK}"
