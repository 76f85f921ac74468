"""``robolang check [PATHS|-]``: find what is wrong with programs without running them, and correct what is certain.

Text, cell and taught points; with ``--motion`` also the motion, planned as a run plans it (``check_motion``). A file
that cannot be read does not keep the others from being checked. Without ``--motion`` no numpy, pinocchio, mujoco, rich,
and no typer either: ``quick`` calls the function with the options that it has read.
"""

import re
from pathlib import Path
from typing import TYPE_CHECKING

from robolang.cli.check_options import (
    FileOptions,
    FixOptions,
    MotionOptions,
    Paths,
    ReportOptions,
    SelectionOptions,
)
from robolang.cli.errors import reported
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.lint.selection import Layer


def check(
    paths: Paths,
    files: FileOptions,
    selection: SelectionOptions,
    fixes: FixOptions,
    report: ReportOptions,
    motion: MotionOptions,
) -> None:
    """Find errors in programs without running them, and correct those that have one correction.

    Example: robolang check --motion programs

    Exit codes: 0 no errors; 1 errors, with --strict also warnings, with --diff something to correct; 2 a file or an
    option cannot be used; 4 a file cannot be written. The largest counts.
    """
    with reported():
        from robolang.cli.check_job import Job, run_once, watched

        given = tuple(paths or ["."])
        _refuse(given, files, report, motion)
        job = Job(
            paths=given,
            layer=_layer(selection),
            fixes=fixes,
            report=report,
            allow_empty=files.allow_empty,
            stdin_name=files.stdin_filename or "<stdin>",
            motion=motion.motion,
            max_cycle_s=_seconds(motion),
            times=None if motion.times is None else Path(motion.times),
            html=None if motion.html is None else Path(motion.html),
        )
        worst = watched(job) if files.watch else run_once(job)
    if worst:
        raise SystemExit(worst)


def _refuse(paths: tuple[str, ...], files: FileOptions, report: ReportOptions, motion: MotionOptions) -> None:
    """Raise ``OptionValueError`` for options that cannot be, alone or together."""
    from robolang.lint.reporters import FORMS

    # not as choices of the option: `quick` takes any text that stands after a name
    form = report.form
    if form not in FORMS:
        raise OptionValueError("--output-format", f"'{form}' is not a form of report; known: {', '.join(FORMS)}")
    if report.as_json and report.output_format not in ("full", "json"):
        raise OptionValueError("--json", f"cannot be combined with --output-format {report.output_format}")
    if report.statistics and form not in ("full", "concise", "json"):
        raise OptionValueError("--statistics", f"cannot be printed as {form}; use full, concise or json")
    if motion.times is not None and not motion.motion:
        raise OptionValueError("--times", "needs --motion")
    if motion.html is not None:
        _refuse_page(motion)
    if files.watch and "-" in paths:
        raise OptionValueError("--watch", "cannot be used with -: the standard input does not change")


def _refuse_page(motion: MotionOptions) -> None:
    if not motion.motion:
        raise OptionValueError("--html", "needs --motion")
    # a slip in the order of the words must not cost a program
    if not str(motion.html).endswith(".html"):
        raise OptionValueError("--html", f"'{motion.html}' must end in .html")


def _seconds(motion: MotionOptions) -> float | None:
    """Return the time of ``--max-cycle``, s."""
    if motion.max_cycle is None:
        return None
    if not motion.motion:
        raise OptionValueError("--max-cycle", "needs --motion")
    # not float(): it takes "nan", "inf" and digits of other scripts
    found = re.fullmatch(r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+) *(ms|s)?", motion.max_cycle.strip().lower())
    if found is None:
        raise OptionValueError("--max-cycle", f"'{motion.max_cycle[:20]}' is not a time such as 12.5s")
    return float(found[1]) * (1e-3 if found[2] == "ms" else 1.0)


def _layer(selection: SelectionOptions) -> "Layer":
    from robolang.lint.selection import Layer

    return Layer(
        select=None if selection.select is None else _selectors("--select", selection.select),
        extend=_selectors("--extend-select", selection.extend_select or []),
        ignore=_selectors("--ignore", selection.ignore or []),
    )


def _selectors(option: str, given: list[str]) -> tuple[str, ...]:
    from robolang.lint.selection import guess, selector

    found = []
    for word in (word for text in given for word in text.split(",") if word.strip()):
        chosen = selector(word)
        if chosen is None:
            near = guess(word)
            raise OptionValueError(option, f"'{word}' is not a rule; {near or 'robolang rules lists them'}")
        found.append(chosen)
    return tuple(found)
