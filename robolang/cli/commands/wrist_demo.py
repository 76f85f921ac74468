"""``robolang wrist-demo [FIGURE...]``: the figures of CN103429397A, calculated; a table, plots with ``--out``."""

import json
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import Argument, JsonOptions, Option, RobotOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from runtime.core.units import badness

if TYPE_CHECKING:
    from rich.table import Table

    from robolang.execution.plot import Mark
    from robolang.experiments.wrist_figures import Figure, Run
    from runtime.robot.model.spec import RobotSpec

    Shown = tuple[Figure, list[Run]]

SILENT_S = 1.0
"""The figure at work is named on stderr after this long."""
_LEAD_S = 0.2
"""A plot of posture components begins this long before the switch: until then there is nothing to see."""
_STYLE = "body{font-family:sans-serif;max-width:46rem;margin:2em auto;padding:0 1em}img{width:100%}figure{margin:2em 0}"


_Figures = Annotated[list[str] | None, Argument("[FIGURE...]", "Numbers of figures of the document; default: all.")]


class _DemoRobot(RobotOptions):
    """The robot of the figures."""

    robot: str = "irb2400"


class _OutputOptions(JsonOptions):
    """Where the figures are drawn."""

    out: Annotated[
        Path | None, Option("--out", metavar="DIR", help="Write wrist-figNN.svg and index.html to this folder.")
    ] = None


def wrist_demo(figures: _Figures, options: _DemoRobot, output: _OutputOptions) -> None:
    """Calculate the figures of CN103429397A: straight moves through a change of the wrist.

    Example: robolang wrist-demo --out out

    Exit codes: 0 done; 2 a figure or a robot cannot be used; 3 a move was refused; 4 a file cannot be written.
    """
    out = output.out
    with reported():
        from robolang.experiments.wrist_figures import FIGURES, unusable
        from robolang.project.project import load_any_robot

        chosen = _chosen(figures or [], FIGURES)
        spec = load_any_robot(options.robot)
        say_warnings(spec.warnings)
        why = unusable(spec)
        if why:
            raise OptionValueError("--robot", why)
        if out is not None:
            _check_folder(out, chosen)
        shown = list(_computed(spec, chosen))
        if out is not None:
            _write(out, spec.name, shown)
        if output.as_json:
            found = [_figure(figure, runs, out) for figure, runs in shown]
            echo(json.dumps({"robot": spec.name, "figures": found}, indent=2))
        else:
            _print(spec.name, shown, out)


def _computed(spec: "RobotSpec", figures: Sequence["Figure"]) -> Iterator["Shown"]:
    """Yield each figure with its runs; ``Fault`` names the figure. Progress goes to stderr after ``SILENT_S``."""
    from robolang.experiments.wrist_figures import run
    from runtime.core.faults import Fault

    since = time.monotonic()
    for count, figure in enumerate(figures, start=1):
        if time.monotonic() - since > SILENT_S:
            echo(f"{count}/{len(figures)} figure {figure.number}", err=True)
        try:
            yield figure, [run(spec, trial) for trial in figure.trials]
        except Fault as fault:
            # twelve figures are computed: without its number nobody knows which was refused
            raise Fault(fault.code, f"figure {figure.number}: {fault.message}", fault.hint) from None


def _figure(figure: "Figure", runs: Sequence["Run"], out: Path | None) -> dict[str, Any]:
    """Return a figure in plain types, with the name of its plot where one was drawn."""
    return {
        "figure": figure.number,
        "title": figure.title,
        "sentence": figure.sentence,
        "file": None if out is None else str(out / _file(figure)),
        "runs": [_plain(each) for each in runs],
    }


def _chosen(words: Sequence[str], known: Sequence["Figure"]) -> list["Figure"]:
    """Return the chosen figures in the order of the document; ``OptionValueError``."""
    numbers = {str(figure.number): figure for figure in known}
    for position, word in enumerate(words, start=1):
        if word not in numbers:
            message = f"'{word}' is not a figure of the demo; known: {', '.join(numbers)}"
            raise OptionValueError("FIGURE", message, position if len(words) > 1 else None)
    return [figure for number, figure in numbers.items() if not words or number in words]


def _plain(run: "Run") -> dict[str, Any]:
    """Return the figures of a run in plain types, in deg, s and mm; axes from 1."""
    import numpy as np

    from runtime.core.units import DEG, MM

    trial = run.trial
    components = np.abs(run.components).max(axis=0) / DEG
    return {
        "move": trial.move,
        "condition": trial.condition,
        "posture": trial.options.posture,
        "period_ms": trial.period_s * 1e3,
        "switch_s": None if run.switch_s is None else round(run.switch_s, 9),
        "axis": None if run.axis is None else run.axis + 1,
        "speed_deg_s": (run.speed / DEG).tolist(),
        "whole_move_speed_deg_s": (run.peak / DEG).tolist(),
        "lowest_deg": (run.q.min(axis=0) / DEG).tolist(),
        "highest_deg": (run.q.max(axis=0) / DEG).tolist(),
        "end_deg": (run.q[-1] / DEG).tolist(),
        "end_error_deg": run.end_error / DEG,
        "posture_deviation_deg": float(run.posture.max()) / DEG,
        "component_deviation_deg": dict(zip(("tilt", "advance", "rotation"), components.tolist(), strict=True)),
        "off_path_mm": float(run.off_path.max()) / MM,
    }


# --- the table -------------------------------------------------------------------------------------------------------


_HEADINGS = (
    "fig",
    "of",
    "condition,\nor what is\nheld",
    "switch\ns, by",
    "J4, J5, J6\nfastest*\ndeg/s",
    "tool\nturn\ndeg",
    "end\nerror\ndeg",
)


def _print(robot: str, shown: list["Shown"], out: Path | None) -> None:
    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    console = Console()
    console.print(_table(safe(f"Figures of CN103429397A on {robot}"), shown, files=out is not None))
    console.print("* from the switch on; of the whole move where there is none", style="italic")
    _print_components(console, shown)
    worst = max((float(run.off_path.max()) for _, runs in shown for run in runs), key=badness)
    # one digit: the rest of a rounding error differs from machine to machine
    console.print(f"tool point at most {worst * 1e3:.0e} mm off its path at any control point")
    if out is not None:
        console.print(safe(f"all plots: {out / 'index.html'}"), soft_wrap=True)


def _table(title: str, shown: list["Shown"], *, files: bool) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for k, heading in enumerate((*_HEADINGS, *(["file"] if files else []))):
        table.add_column(heading, justify="right" if k in (4, 5, 6) else "left", no_wrap=k != 2)
    for figure, runs in shown:
        for k, row in enumerate(map(_plain, runs)):
            number, file = (str(figure.number), _file(figure)) if k == 0 else ("", "")
            table.add_row(number, *_cells(row), *([file] if files else []))
    return table


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    """Return the cells of a run, after the number of its figure."""
    return (
        row["move"],
        row["condition"],
        "-" if row["switch_s"] is None else f"{row['switch_s']:.2f} {_axis(row)}",
        " ".join(f"{speed:5.1f}" for speed in row["speed_deg_s"][-3:]),
        f"{row['posture_deviation_deg']:.1f}",
        _small(row["end_error_deg"]),
    )


def _print_components(console: Any, shown: list["Shown"]) -> None:
    from rich import box
    from rich.table import Table

    rows = [(figure, row) for figure, runs in shown if figure.drawn is not None for row in map(_plain, runs)]
    if not rows:
        return
    table = Table(
        title="Largest change of the posture components, deg", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False
    )
    for heading in ("fig", "of", "held", "tilt", "advance", "rotation"):
        table.add_column(heading, justify="right" if heading in ("tilt", "advance", "rotation") else "left")
    for figure, row in rows:
        values = (f"{value:.2f}" for value in row["component_deviation_deg"].values())
        table.add_row(str(figure.number), row["move"], row["condition"], *values)
    console.print(table)


def _axis(row: dict[str, Any]) -> str:
    return "" if row["axis"] is None else f"J{row['axis']}"


def _small(value: float) -> str:
    """Return an error in five characters; one of rounding as its power of ten."""
    return f"{value:.1f}" if value >= 0.05 or value == 0.0 else f"{value:.0e}"


# --- the plots -------------------------------------------------------------------------------------------------------


def _file(figure: "Figure") -> str:
    return f"wrist-fig{figure.number:02}.svg"


def _check_folder(out: Path, figures: Sequence["Figure"]) -> None:
    """Make the folder where there is none; ``Fault`` RBL706 where a file could not be written into it."""
    from robolang.core.storage import check_writable

    with suppress(OSError):  # check_writable reports it, at the first file
        out.mkdir(exist_ok=True)
    # each file and not the folder alone: one of them may be there and read-only
    for name in (*map(_file, figures), "index.html"):
        check_writable(out / name)


def _write(out: Path, robot: str, shown: list["Shown"]) -> None:
    for figure, runs in shown:
        _save(out / _file(figure), _svg(figure, runs, robot))
    _save(out / "index.html", _index(robot, shown))


def _save(path: Path, text: str) -> None:
    from robolang.core.storage import write_atomic

    write_atomic(path, lambda stream: stream.write(text.encode("utf-8")))


def _title(figure: "Figure") -> str:
    """Return a title that says which move it is, as the document does: by J5."""
    from robolang.experiments.wrist_figures import MOVES

    move = figure.trials[0].move
    first, last = (ends[4] for ends in MOVES[move])
    return f"Fig {figure.number}, {move} (J5 {first:+g} to {last:+g} deg): {figure.title}"


def _svg(figure: "Figure", runs: list["Run"], robot: str) -> str:
    title = f"{_title(figure)}, {robot}"
    if figure.drawn is not None:
        return _components_svg(title, figure, runs[figure.drawn])
    return _joints_svg(title, figure, runs)


def _joints_svg(title: str, figure: "Figure", runs: list["Run"]) -> str:
    """Draw J4 to J6 of the runs over time, the second one dashed, with the switches and the taught end angles."""
    import numpy as np

    from robolang.execution.plot import Curve, Dots, Labels, as_svg
    from runtime.core.units import DEG

    curves = [
        Curve(
            name=f"J{axis + 1} {figure.variant}" if k else f"J{axis + 1}",
            x=run.t,
            y=run.q[:, axis] / DEG,
            dashed=k > 0,
            colour=axis - 3,
        )
        for k, run in enumerate(runs)
        for axis in (3, 4, 5)
    ]
    # only a seam moves the end of a run; otherwise the runs of a figure share theirs, and one set of dots is drawn
    moved = any(run.trial.seam for run in runs)
    ends = np.concatenate([run.q_end[3:] for run in (runs if moved else runs[:1])]) / DEG
    dots = Dots(name="taught and moved end" if moved else "taught end", x=np.full(len(ends), runs[0].t[-1]), y=ends)
    labels = Labels(title=title, x="time, s", y="angle, deg")
    return as_svg(labels, curves, corner="above", marks=_marks(figure, runs), dots=dots)


def _marks(figure: "Figure", runs: list["Run"]) -> list["Mark"]:
    """Return the switches, and the ends of the range where a run depends on them."""
    from robolang.execution.plot import Mark
    from robolang.experiments.wrist_figures import RANGE
    from runtime.core.units import DEG

    marks = list(_switches(figure, [run.switch_s for run in runs]))
    if any(run.trial.options.range_condition or abs(run.q[:, 3:]).max() > RANGE for run in runs):
        marks += [Mark(name=f"{bound / DEG:g} deg", y=bound / DEG) for bound in (RANGE, -RANGE)]
    return marks


def _switches(figure: "Figure", times: list[float | None]) -> Iterator["Mark"]:
    """Yield a mark for each time of a switch, s; two runs that switch at the same time have one."""
    from robolang.execution.plot import Mark

    earliest = min((time for time in times if time is not None), default=None)
    for k, switch in enumerate(times):
        if switch is None or switch in times[:k]:
            continue
        name = f"{figure.variant if k else figure.switch} {switch:.2f} s"
        # the name of the earliest stands on its left, so that two names close together do not overlap
        yield Mark(name=name, x=switch, side="left" if switch == earliest and len(times) > 1 else "right")


def _components_svg(title: str, figure: "Figure", run: "Run") -> str:
    """Draw the change of tilt, advance and rotation over time."""
    from robolang.execution.plot import Curve, Labels, Mark, as_svg
    from runtime.core.units import DEG

    switch = run.switch_s or 0.0
    shown = run.t >= switch - _LEAD_S - 1e-9  # a sample on the bound is shown, whichever side rounding puts it on
    curves = [
        Curve(name=name, x=run.t[shown], y=run.components[shown, k] / DEG)
        for k, name in enumerate(("tilt", "advance", "rotation"))
    ]
    mark = Mark(name=f"{figure.switch} {switch:.2f} s", x=switch)
    labels = Labels(title=title, x="time, s", y="change of the posture, deg")
    return as_svg(labels, curves, level=0.0, corner="above", marks=[mark])


def _index(robot: str, shown: list["Shown"]) -> str:
    """Return a page that shows all plots, each with its sentence and what came of its runs."""
    title = f"Figures of CN103429397A on {robot}"
    parts = [
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>',
        f"<style>{_STYLE}</style></head><body><h1>{escape(title)}</h1>",
    ]
    for figure, runs in shown:
        facts = "<br>".join(escape(_facts(_plain(run), components=figure.drawn is not None)) for run in runs)
        parts.append(
            f'<figure id="fig{figure.number}"><img src="{_file(figure)}" alt="{escape(_title(figure))}">'
            f"<figcaption><p>{escape(figure.sentence)}</p><p>{facts}</p>"
            "</figcaption></figure>"
        )
    return "\n".join([*parts, "</body></html>", ""])


def _facts(row: dict[str, Any], *, components: bool) -> str:
    """Return what came of a run, in a sentence, with the posture components where the figure is about them."""
    switch = "no switch;"
    if row["switch_s"] is not None:
        switch = f"switch at {row['switch_s']:.2f} s{' by ' if row['axis'] else ''}{_axis(row)}, from there on"
    speeds = ", ".join(f"{speed:.1f}" for speed in row["speed_deg_s"][-3:])
    turned = f"tool turned by up to {row['posture_deviation_deg']:.1f} deg"
    if components:
        values = row["component_deviation_deg"].values()
        turned += f" (tilt, advance, rotation {', '.join(f'{value:.2f}' for value in values)})"
    return (
        f"{row['move']}, {row['condition']}: {switch} J4, J5, J6 at most {speeds} deg/s; {turned}; end error "
        f"{_small(row['end_error_deg'])} deg."
    )
