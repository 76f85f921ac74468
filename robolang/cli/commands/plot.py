"""``robolang plot RUN SIGNAL...``: signals of a log as curves over time, with the statements that ran.

``robolang plot RUN --along-path``: the speed of the tool over the length of its path.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import reported
from robolang.cli.options import Argument, Group, Option, Run
from robolang.cli.output import echo
from robolang.cli.outputs import check_outputs, output_beside
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.view.signal_plot import SignalPlot

_SUFFIXES = (".svg", ".png", ".html")

Selections = Annotated[
    list[str] | None,
    Argument("[SIGNAL...]", "Signals: q_fb, q_fb:2 for an axis, tool_cmd:z; q_cmd:2+q_fb:2 in one panel."),
]


class _PlotOptions(Group):
    """What is drawn, and where to."""

    PANEL: ClassVar[str] = "Output"
    out: Annotated[
        Path | None,
        Option("--out", "-o", metavar="FILE", help="File: .svg, .png or .html; default: RUN-SIGNAL.svg beside RUN."),
    ] = None
    begin: Annotated[float | None, Option("--from", metavar="S", help="Start of the plot, s.")] = None
    end: Annotated[float | None, Option("--to", metavar="S", help="End of the plot, s.")] = None
    along_path: Annotated[
        bool, Option("--along-path", help="Draw the tool's speed over the length of its path, without SIGNAL.")
    ] = False


def plot(run: Run, selections: Selections, output: _PlotOptions) -> None:
    """Draw signals of a log: a panel for each, one time axis, the running statements marked.

    Angles are drawn in deg, lengths in mm. With --along-path: the programmed and the commanded speed of the tool.

    Example: robolang plot run.npz q_fb:2 tool_error -o run.svg

    Exit codes: 0 done; 2 the log, a signal or an option cannot be used; 4 the file cannot be written.
    """
    names = selections or []
    path = output.out or _beside(run, names or ["path"])
    _check(output, names, path)
    with reported():
        from robolang.core.storage import write_atomic

        # before the log is read, which takes the time
        check_outputs({"--out": path}, [run])
        if path.suffix == ".png":
            from robolang.view.png import check_png

            check_png()
        data = _drawn(_plot(run, names, output), path.suffix)
        write_atomic(path, lambda stream: stream.write(data))
        echo(f"{path} written")


def _check(output: _PlotOptions, names: list[str], path: Path) -> None:
    """Refuse options that do not go together."""
    if output.begin is not None and output.end is not None and not output.begin <= output.end:
        raise OptionValueError("--from, --to", f"{output.begin:g} s is after {output.end:g} s")
    if output.along_path and names:
        raise OptionValueError("--along-path", "draws the speed alone, without SIGNAL")
    if not output.along_path and not names:
        raise OptionValueError("SIGNAL", "at least one is needed, or --along-path")
    if path.suffix not in _SUFFIXES:
        raise OptionValueError("--out", f"'{path}' must end in {', '.join(_SUFFIXES)}")


def _plot(run: Path, selections: list[str], output: _PlotOptions) -> "SignalPlot":
    from robolang.logs.files import read_log
    from robolang.view.log_plot import Window, plot_of
    from robolang.view.path_plot import path_plot

    log, window = read_log(run), Window(first=output.begin, last=output.end)
    # refused as an option: the log itself is as it should be
    try:
        return plot_of(log, selections, window) if selections else path_plot(log, window)
    except ValueError:
        times = log["t"]
        span = f"the log goes from {times[0]:g} to {times[-1]:g} s"
        raise OptionValueError("--from, --to", f"less than two rows are between these times; {span}") from None


def _drawn(found: "SignalPlot", suffix: str) -> bytes:
    drawing = found.as_svg()
    if suffix == ".png":
        from robolang.view.png import as_png

        return as_png(drawing)
    if suffix == ".html":
        from robolang.execution.plot import as_html

        return as_html(found.title, drawing).encode("utf-8")
    return drawing.encode("utf-8")


def _beside(run: Path, selections: list[str]) -> Path:
    # names of signals have a colon, which file systems do not all take
    name = "-".join(text.replace(" ", "").replace(":", "").replace("+", "-") for text in selections)
    return output_beside(run, f"-{name}.svg".replace("/", "_"))
