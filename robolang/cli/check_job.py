"""What ``robolang check`` does once its options are known: read, check, correct, print, judge.

The report goes to stdout or a file; what concerns the work itself goes to stderr: files that cannot be used, what was
fixed. With ``--fix`` a program from stdin goes to stdout, corrected, and its report to stderr.
"""

import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import typer

from robolang.cli.errors import DIAGNOSTICS, reader_may_leave, say, say_all, say_warnings
from robolang.cli.rewrite import Loaded, load, store, unified
from robolang.core.diagnostics import Diagnostic, Severity, has_errors, in_order, safe
from robolang.core.source import Source
from robolang.lint.apply import fix_all
from robolang.lint.engine import Checked, check_points, check_source
from robolang.lint.files import STANDARD_INPUT, programs
from robolang.lint.reporters import render
from robolang.lint.selection import Layer, Selection
from robolang.lint.settings import Settings
from robolang.lint.suppress import add_later
from robolang.lint.watch import watch
from robolang.project.discovery import CellFiles
from runtime.core.faults import Fault, lookup
from runtime.core.tomlfile import FileFault

_ROOTS = ("GITHUB_WORKSPACE", "CI_PROJECT_DIR")


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """The options of ``robolang check``, checked."""

    paths: tuple[str, ...]
    layer: Layer
    form: str
    output: Path | None
    stdin_name: str
    fix: bool
    diff: bool
    statistics: bool
    strict: bool
    exit_zero: bool
    motion: bool = False
    max_cycle_s: float | None = None
    times: Path | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Outcome:
    """A program as it was read, what was found after its fixes and in its points, how often each code was fixed.

    ``warnings`` are about the files of its robot.
    """

    checked: Checked
    before: Loaded
    points: Checked | None = None
    fixed: dict[str, int] = field(default_factory=dict)
    table: str = ""
    times: dict[str, object] | None = None
    warnings: tuple[FileFault, ...] = ()


def watched(job: Job) -> int:
    """Check now and whenever something changes, until Ctrl-C; return the last exit code."""

    def again() -> int:
        try:
            code = run_once(job)
        except Fault as fault:
            code = say_all(fault)
        typer.echo("watching; Ctrl-C ends", err=True)
        return code

    return watch(job.paths, again)


def run_once(job: Job) -> int:
    """Check everything once, print the report and return the exit code; ``Fault`` for a wrong configuration."""
    for path in (job.output, job.times):
        if path is not None:
            from robolang.core.storage import check_writable

            check_writable(path)
    settings = Settings()
    names = programs(job.paths, excludes=settings.excludes)
    if not names:
        typer.echo(f"no programs (*.rbl) in {safe(', '.join(job.paths))}", err=True)
    files = CellFiles()
    outcomes = [_examined(name, job, settings, files) for name in names]
    if job.fix and not job.diff:
        outcomes = [_written(outcome) for outcome in outcomes]
    outcomes = [replace(outcome, points=_points(outcome, job, settings)) for outcome in outcomes]
    if job.motion:
        from robolang.cli.check_motion import told

        with told(len(outcomes)) as tell:
            for number, outcome in enumerate(outcomes):
                tell(number, outcome.checked.source.path)
                outcomes[number] = _planned(outcome, job, settings)
    if job.times is not None:
        _write_times(job.times, outcomes)
    outcomes = _once(outcomes)
    _print(job, outcomes)
    say_warnings(warning for outcome in outcomes for warning in (*outcome.checked.warnings, *outcome.warnings))
    worst = max([0, *(say(fault) for outcome in outcomes for fault in outcome.checked.faults)])
    return max(worst, _judged(job, outcomes))


def _once(outcomes: Sequence[_Outcome]) -> list[_Outcome]:
    """Return the outcomes with each fault once: many programs may run in one cell."""
    seen: set[tuple[str, ...]] = set()
    found = []
    for outcome in outcomes:
        new = {(fault.code, str(fault)): fault for fault in outcome.checked.faults}
        kept = tuple(fault for key, fault in new.items() if key not in seen)
        seen.update(new)
        found.append(replace(outcome, checked=replace(outcome.checked, faults=kept)))
    return found


def _examined(name: str, job: Job, settings: Settings, files: CellFiles) -> _Outcome:
    """Return what was found in one program and what its fixes make of it; nothing is written."""
    shown = job.stdin_name if name == STANDARD_INPUT else name
    try:
        loaded = load(name, shown)
    except Fault as fault:
        nothing = Source(shown, "")
        return _Outcome(
            checked=Checked(source=nothing, faults=(fault,)), before=Loaded(name=name, mark=b"", source=nothing)
        )
    selection = _selection(shown, job, settings)
    checked = check_source(loaded.source, selection, files)
    if not (job.fix or job.diff) or not any(item.fix is not None and item.fix.safe for item in checked.diagnostics):
        return _Outcome(checked=checked, before=loaded)
    seen = {loaded.source.text: checked}

    def found(source: Source) -> tuple[Diagnostic, ...]:
        if source.text not in seen:
            seen[source.text] = check_source(source, selection, files)
        return seen[source.text].diagnostics

    fixed = fix_all(loaded.source, found)
    found(fixed.source)
    return _Outcome(checked=seen[fixed.source.text], before=loaded, fixed=dict(fixed.counts))


def _points(outcome: _Outcome, job: Job, settings: Settings) -> Checked | None:
    """Return what was found in the points file of a program."""
    if outcome.before.name == STANDARD_INPUT:
        return None
    return check_points(outcome.checked, _selection(outcome.checked.source.path, job, settings))


def _selection(program: str, job: Job, settings: Settings) -> Selection:
    """Return what is reported of a program: by the settings of its folder, then by the options."""
    return Selection(layers=(settings.layer(Path(program).parent), job.layer))


def _planned(outcome: _Outcome, job: Job, settings: Settings) -> _Outcome:
    """Add what the motion of a program shows, and the table of what its lines take.

    With an error there is no motion, but what the cell makes an error is added; and an error that is not reported,
    since it is ignored or has a ``noqa``, is reported all the same: nothing was planned, and that is no pass.
    """
    checked = outcome.checked
    if checked.analysis is None or checked.faults or outcome.before.name == STANDARD_INPUT:
        return outcome
    from robolang.cli.check_motion import planned

    selection = _selection(checked.source.path, job, settings)
    try:
        plan = planned(checked.analysis, job.max_cycle_s, settings.bounds(Path(checked.source.path).parent))
    except Fault as fault:
        return replace(outcome, checked=replace(checked, faults=(*checked.faults, *fault.all)))
    known = {(item.code, item.span) for item in checked.diagnostics}
    later = [item for item in plan.diagnostics if (item.code, item.span) not in known]
    diagnostics = in_order(filter(selection.keeps, add_later(checked.source, checked.diagnostics, later)))
    if plan.times is None and not has_errors(diagnostics):
        diagnostics = in_order((*diagnostics, *(item for item in later if item.severity is Severity.ERROR)))
    return replace(
        outcome,
        checked=replace(checked, diagnostics=diagnostics),
        table=plan.table,
        times=plan.times,
        warnings=plan.warnings,
    )


def _write_times(path: Path, outcomes: Sequence[_Outcome]) -> None:
    """Write the times of the programs that were planned, as one JSON array."""
    from robolang.core.storage import write_atomic

    text = json.dumps([outcome.times for outcome in outcomes if outcome.times is not None], indent=2) + "\n"
    write_atomic(path, lambda stream: stream.write(text.encode()))


def _written(outcome: _Outcome) -> _Outcome:
    """Write a corrected program back, and say what was fixed; a file that cannot be written is a fault more."""
    before, after = outcome.before, outcome.checked.source
    try:
        if outcome.fixed or before.name == STANDARD_INPUT:
            store(before, after.text)
    except Fault as fault:
        checked = replace(outcome.checked, faults=(*outcome.checked.faults, fault))
        return replace(outcome, checked=checked, fixed={})
    if outcome.fixed:
        said = ", ".join(f"{count} x {code} {lookup(code).name}" for code, count in outcome.fixed.items())
        typer.echo(f"{safe(after.path)}: fixed {said}", err=True)
    return outcome


def _print(job: Job, outcomes: Sequence[_Outcome]) -> None:
    """Print the report, or with ``--diff`` the changes."""
    results = list(_results(outcomes))
    if job.diff:
        text = "".join(line for outcome in outcomes for line in _change(outcome))
    elif job.statistics:
        from robolang.lint.reporters import statistics

        text = statistics.render(results, as_json=job.form == "json")
    else:
        text = render(job.form, results, _root())
        if job.form in ("full", "concise"):
            text += "".join(f"\n{outcome.table}" for outcome in outcomes if outcome.table)
    if job.output is not None:
        from robolang.core.storage import write_atomic

        write_atomic(job.output, lambda stream: stream.write(text.encode("utf-8", "backslashreplace")))
        return
    with reader_may_leave():
        typer.echo(text, nl=False, err=job.fix and not job.diff and STANDARD_INPUT in job.paths)


def _results(outcomes: Sequence[_Outcome]) -> Iterator[Checked]:
    """Yield what was found file by file, a program's points behind it."""
    for outcome in outcomes:
        yield outcome.checked
        if outcome.points is not None:
            yield outcome.points


def _change(outcome: _Outcome) -> Iterator[str]:
    before, after = outcome.before.source, outcome.checked.source
    return unified(before.path, before.text, after.text)


def _root() -> Path:
    """Return the folder that files are named from: the checkout of the CI service around us, else the working one."""
    here = Path.cwd()
    for variable in _ROOTS:
        checkout = os.environ.get(variable)
        if checkout and here.is_relative_to(checkout):
            return Path(checkout)
    return here


def _judged(job: Job, outcomes: Sequence[_Outcome]) -> int:
    """Return the exit code for what was found."""
    if job.exit_zero:
        return 0
    if job.diff:
        return DIAGNOSTICS if any(outcome.fixed for outcome in outcomes) else 0
    found = [item for result in _results(outcomes) for item in result.diagnostics]
    warned = job.strict and (
        any(item.severity is Severity.WARNING for item in found)
        or any(outcome.checked.warnings or outcome.warnings for outcome in outcomes)
    )
    return DIAGNOSTICS if warned or has_errors(found) else 0
