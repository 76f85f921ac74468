"""``robolang report RUN [RUN2]``: a page of a run, or of two side by side, from their logs alone.

Imports nothing heavy: numpy and the page come in inside the command.
"""

from pathlib import Path
from typing import Annotated, ClassVar

from robolang.cli.errors import reported
from robolang.cli.options import Argument, Group, Option
from robolang.cli.output import echo
from robolang.cli.outputs import check_outputs, output_beside
from robolang.cli.usage import OptionValueError

Run = Annotated[str, Argument("RUN", "Log of a run (.npz or .mcap).")]
OtherRun = Annotated[str | None, Argument("[RUN2]", "Log of another run, to be shown beside it.")]


class PageOptions(Group):
    """The page, and what its runs are called."""

    PANEL: ClassVar[str] = "Output"
    out: Annotated[
        Path | None, Option("--out", "-o", metavar="FILE.html", help="Write the page to this file; default: RUN.html.")
    ] = None
    label: Annotated[
        list[str] | None,
        Option("--label", metavar="TEXT", help="Name of a run in the page; once for each. Default: its file name."),
    ] = None


def report(run: Run, other: OtherRun, page: PageOptions) -> None:
    """Write a page of a run that a browser shows without a network: robot, program, charts, notes.

    Example: robolang report run.npz -o run.html

    Exit codes: 0 done; 2 a log or an option cannot be used; 4 the page cannot be written.
    """
    with reported():
        paths = [Path(path) for path in (run, other) if path is not None]
        out = page.out if page.out is not None else output_beside(paths[0], ".html")
        labels = _labels(paths, page.label)
        _check_output(out, paths)
        from robolang.view.page import Bundle, write_page
        from robolang.view.run_page import check_comparable, open_run, pack_run

        logs = [open_run(path) for path in paths]
        check_comparable(logs)
        runs = [pack_run(log, label) for log, label in zip(logs, labels, strict=True)]
        write_page(out, runs, Bundle.installed())
        echo(f"{out}: {out.stat().st_size / 1e6:.2f} MB")


def _labels(paths: list[Path], given: list[str] | None) -> list[str]:
    """Return the name of each run: what is given, else the name of its file."""
    if given is not None and len(given) != len(paths):
        raise OptionValueError("--label", f"is needed once for each run: {len(paths)}, but {len(given)} are given")
    return given if given is not None else [path.stem for path in paths]


def _check_output(out: Path, paths: list[Path]) -> None:
    # a slip in the order of the words must not cost a log
    if out.suffix != ".html":
        raise OptionValueError("--out", f"'{out}' must end in .html")
    check_outputs({"--out": out}, paths)
