"""What ``robolang check`` does once its options are known: read, check, correct, print, judge.

The report goes to stdout or a file; what concerns the work itself goes to stderr: files that cannot be used, what was
fixed. With ``--fix`` a program from stdin goes to stdout, corrected, and its report to stderr.
"""

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from robolang.cli.builtin_cell import note_builtin_cell
from robolang.cli.check_options import FixOptions, ReportOptions
from robolang.cli.errors import DIAGNOSTICS, say, say_all, say_warnings
from robolang.cli.output import echo, show_finding
from robolang.cli.outputs import check_outputs
from robolang.cli.rewrite import Loaded, load, store, unified
from robolang.cli.usage import OptionValueError
from robolang.core.diagnostics import Diagnostic, Severity, has_errors, in_order, safe
from robolang.core.source import Source
from robolang.lint.apply import fix_all
from robolang.lint.engine import Checked, check_points, check_source
from robolang.lint.files import STANDARD_INPUT, programs
from robolang.lint.reporters import FOR_PEOPLE, render
from robolang.lint.selection import Layer, Selection
from robolang.lint.settings import Settings
from robolang.lint.suppress import add_later
from robolang.lint.watch import watch
from robolang.project.discovery import CellFiles
from runtime.core.faults import Fault, lookup
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault

if TYPE_CHECKING:
    from robolang.cli.check_motion import Planned

# set by GitHub Actions and GitLab CI: both match a report with files by their path inside the checkout
_ROOTS = ("GITHUB_WORKSPACE", "CI_PROJECT_DIR")


class Job(Record):
    """The options of ``robolang check``, checked."""

    paths: tuple[str, ...]
    layer: Layer
    fixes: FixOptions
    report: ReportOptions
    stdin_name: str
    allow_empty: bool = False
    motion: bool = False
    max_cycle_s: float | None = None
    times: Path | None = None
    html: Path | None = None

    @property
    def output(self) -> Path | None:
        """The file that the report is written to."""
        return None if self.report.output_file is None else Path(self.report.output_file)


class _Outcome(Record):
    """A program as it was read, the findings after its fixes and in its points, how often each code was fixed.

    ``warnings`` are about the files of its robot, ``table`` and ``times`` are the times of its lines, ``plan`` is its
    motion; ``whole`` is False for a program that could not be read, and for one whose cell or points could not.
    """

    checked: Checked
    before: Loaded
    whole: bool = True
    points: Checked | None = None
    fixed: Mapping[str, int] = MappingProxyType({})
    table: str = ""
    times: dict[str, object] | None = None
    plan: "Planned | None" = None
    warnings: tuple[FileFault, ...] = ()

    @property
    def results(self) -> tuple[Checked, ...]:
        """What was found file by file: in the program, then in its points."""
        return (self.checked,) if self.points is None else (self.checked, self.points)

    @property
    def findings(self) -> Iterator[Diagnostic]:
        """All findings in the program and its points, those of the points with the text that they are in."""
        yield from self.checked.diagnostics
        if self.points is not None:
            yield from (item.replaced(source=self.points.source) for item in self.points.diagnostics)

    @property
    def doubts(self) -> tuple[FileFault, ...]:
        """What is unlikely about the cell and the files of the robot."""
        return (*self.checked.warnings, *self.warnings)

    def failing(self, *faults: Fault) -> "_Outcome":
        """Return the outcome with faults more."""
        return self.replaced(checked=self.checked.replaced(faults=(*self.checked.faults, *faults)))


def watched(job: Job) -> int:
    """Check now and whenever something changes, until Ctrl-C; return the last exit code."""

    def again() -> int:
        try:
            code = run_once(job)
        except Fault as fault:  # a configuration that is being edited is no reason to stop watching
            code = say_all(fault)
        echo("watching; Ctrl-C ends", err=True)
        return code

    return watch(job.paths, again)


def run_once(job: Job) -> int:
    """Check everything once, print the report and return the exit code; ``Fault`` for a wrong configuration."""
    settings = Settings()
    names = programs(job.paths, excludes=settings.excludes)
    _check_outputs(job, names)
    if not names and not job.allow_empty:
        raise Fault("RBL713", f"there is no program (*.rbl) in {safe(', '.join(job.paths))}")
    if job.html is not None and len(names) > 1:
        raise OptionValueError("--html", f"shows one program; {len(names)} were found")
    outcomes = _once(_examined_all(names, job, settings))
    if job.times is not None:
        _write_times(job.times, outcomes)
    if job.html is not None:
        _write_page(job.html, outcomes)
    _print(job, outcomes)
    # not `or`: --exit-zero makes findings 0, and a file that cannot be used stays 2
    return max(_say_rest(job, outcomes), _judged(job, outcomes))


def _say_rest(job: Job, outcomes: Sequence[_Outcome]) -> int:
    """Print to stderr what is no finding, and return the exit code of the files that cannot be used."""
    if any(map(os.path.isdir, job.paths)):  # the count says that a folder held what the user thinks it holds
        count = sum(outcome.whole for outcome in outcomes)
        echo(f"{_programs(count)} checked", err=True)
        if count < len(outcomes):
            echo(f"{_programs(len(outcomes) - count)} not checked completely; the errors below say why", err=True)
    for outcome in outcomes:
        note_builtin_cell(outcome.checked.analysis, outcome.checked.diagnostics)
    say_warnings(doubt for outcome in outcomes for doubt in outcome.doubts)
    return max([0, *(say(fault) for outcome in outcomes for fault in outcome.checked.faults)])


def _programs(count: int) -> str:
    return f"{count} program{'' if count == 1 else 's'}"


def _check_outputs(job: Job, names: Sequence[str]) -> None:
    """Refuse files that cannot be written before anything is checked; ``Fault`` RBL706, ``OptionValueError``."""
    outputs = {"--output-file": job.output, "--times": job.times, "--html": job.html}
    if any(path is not None for path in outputs.values()):
        check_outputs(outputs, names)


def _examined_all(names: Sequence[str], job: Job, settings: Settings) -> list[_Outcome]:
    """Check all programs and write their fixes.

    Points and motion come last: they depend on the text that the fixes leave.
    """
    files = CellFiles()
    outcomes = [_examined(name, job, settings, files) for name in names]
    # all are read before the first is written: Ctrl-C while programs are checked leaves every file as it was
    if job.fixes.fix and not job.fixes.diff:
        outcomes = [_written(outcome) for outcome in outcomes]
    outcomes = [outcome.replaced(points=_points(outcome, job, settings)) for outcome in outcomes]
    return _planned_all(outcomes, job, settings) if job.motion else outcomes


def _planned_all(outcomes: Sequence[_Outcome], job: Job, settings: Settings) -> list[_Outcome]:
    """Add what the motion of each program shows, with progress on a terminal."""
    from robolang.cli.planning_progress import planning

    found = []
    with planning(len(outcomes)) as progress:
        for number, outcome in enumerate(outcomes):
            progress.begin(number, outcome.checked.source.path)
            found.append(_planned(outcome, job, settings, progress.planned))
    return found


def _once(outcomes: Sequence[_Outcome]) -> list[_Outcome]:
    """Return the outcomes with each fault once: many programs may run in one cell."""
    seen: set[tuple[str, ...]] = set()
    found = []
    for outcome in outcomes:
        new = {(fault.code, str(fault)): fault for fault in outcome.checked.faults}
        kept = tuple(fault for key, fault in new.items() if key not in seen)
        seen.update(new)
        found.append(outcome.replaced(checked=outcome.checked.replaced(faults=kept)))
    return found


def _examined(name: str, job: Job, settings: Settings, files: CellFiles) -> _Outcome:
    """Return the findings in one program and the text that its fixes make; nothing is written."""
    shown = job.stdin_name if name == STANDARD_INPUT else name
    try:
        loaded = load(name, shown)
    except Fault as fault:
        before = Loaded(name=name, mark=b"", source=Source(shown, ""))
        return _Outcome(checked=Checked(source=before.source, faults=(fault,)), before=before, whole=False)
    selection = _selection(shown, job, settings)
    checked = check_source(loaded.source, selection, files)
    fixable = any(item.fix is not None and item.fix.safe for item in checked.diagnostics)
    if not (fixable and (job.fixes.fix or job.fixes.diff)):
        return _Outcome(checked=checked, before=loaded, whole=not checked.faults)
    seen = {loaded.source.text: checked}  # the text as it was read, and the one that is left, are judged once

    def found(source: Source) -> tuple[Diagnostic, ...]:
        if source.text not in seen:
            seen[source.text] = check_source(source, selection, files)
        return seen[source.text].diagnostics

    fixed = fix_all(loaded.source, found)
    found(fixed.source)  # of the text after the last round, which is not examined where rounds run out
    left = seen[fixed.source.text]
    return _Outcome(checked=left, before=loaded, whole=not left.faults, fixed=dict(fixed.counts))


def _points(outcome: _Outcome, job: Job, settings: Settings) -> Checked | None:
    """Return the findings in the points file of a program."""
    if outcome.before.name == STANDARD_INPUT:
        return None
    return check_points(outcome.checked, _selection(outcome.checked.source.path, job, settings))


def _selection(program: str, job: Job, settings: Settings) -> Selection:
    """Return what is reported of a program: by the settings of its folder, then by the options."""
    return Selection(layers=(settings.layer(Path(program).parent), job.layer))


def _planned(outcome: _Outcome, job: Job, settings: Settings, tell: Callable[[int], None]) -> _Outcome:
    """Add what the motion of a program shows, and the table of what its lines take."""
    checked = outcome.checked
    if checked.analysis is None or checked.faults or outcome.before.name == STANDARD_INPUT:
        return outcome
    from robolang.cli.check_motion import planned

    selection = _selection(checked.source.path, job, settings)
    try:
        bounds = settings.bounds(Path(checked.source.path).parent)
        plan = planned(checked.analysis, job.max_cycle_s, bounds, tell)
    except Fault as fault:
        return outcome.failing(*fault.all)
    return outcome.replaced(
        checked=checked.replaced(diagnostics=_with_plan(checked, plan, selection)),
        table=plan.table,
        times=plan.times,
        plan=plan,
        warnings=plan.warnings,
    )


def _with_plan(checked: Checked, plan: "Planned", selection: Selection) -> tuple[Diagnostic, ...]:
    """Return the findings in the text and in the motion, by place, each once."""
    # of a text with errors the planner returns what the check of the text has found
    known = {(item.code, item.span) for item in checked.diagnostics}
    later = [item for item in plan.diagnostics if (item.code, item.span) not in known]
    found = in_order(filter(selection.keeps, add_later(checked.source, checked.diagnostics, later)))
    if plan.times is not None or has_errors(found):
        return found
    # Nothing was planned, for an error that is ignored or has a noqa. It is reported all the same: exit code 0 would
    # say that the motion is right.
    return in_order((*found, *(item for item in later if item.severity is Severity.ERROR)))


def _write_times(path: Path, outcomes: Sequence[_Outcome]) -> None:
    """Write the times of the programs that were planned, as one JSON array."""
    from robolang.core.storage import write_atomic

    text = json.dumps([outcome.times for outcome in outcomes if outcome.times is not None], indent=2) + "\n"
    write_atomic(path, lambda stream: stream.write(text.encode()))


def _write_page(path: Path, outcomes: Sequence[_Outcome]) -> None:
    """Write the page of the program whose motion was planned; say that there is none where it was not."""
    for outcome in outcomes:
        if outcome.plan is None or outcome.plan.rehearsal is None:
            echo(f"{safe(str(path))} is not written: the motion was not planned", err=True)
            continue
        from robolang.cli.check_motion import write_page

        write_page(path, outcome.plan, tuple(outcome.findings))


def _written(outcome: _Outcome) -> _Outcome:
    """Write a corrected program back, and say what was fixed; a file that cannot be written is a fault more."""
    before, after = outcome.before, outcome.checked.source
    try:
        if outcome.fixed or before.name == STANDARD_INPUT:
            store(before, after.text)
    except Fault as fault:
        return outcome.failing(fault).replaced(fixed={})  # nothing was fixed: the file is as it was
    if outcome.fixed:
        listed = ", ".join(f"{count} x {code} {lookup(code).name}" for code, count in outcome.fixed.items())
        echo(f"{safe(after.path)}: fixed {listed}", err=True)
    return outcome


def _print(job: Job, outcomes: Sequence[_Outcome]) -> None:
    """Print the report, or with ``--diff`` the changes."""
    text = _report(job, outcomes)
    if job.output is not None:
        from robolang.core.storage import write_atomic

        # names of files that are not UTF-8 are in the report, and must not keep it from being written
        write_atomic(job.output, lambda stream: stream.write(text.encode("utf-8", "backslashreplace")))
        return
    # a corrected program from the standard input goes to the standard output, so its report cannot
    corrected = job.fixes.fix and not job.fixes.diff and STANDARD_INPUT in job.paths
    # what other programs read has no colours
    plain = job.report.form not in FOR_PEOPLE or job.fixes.diff
    (echo if plain else show_finding)(text, nl=False, err=corrected)


def _report(job: Job, outcomes: Sequence[_Outcome]) -> str:
    """Return the text of the report."""
    if job.fixes.diff:
        return "".join(line for outcome in outcomes for line in _change(outcome))
    results, form = [result for outcome in outcomes for result in outcome.results], job.report.form
    if job.report.statistics:
        from robolang.lint.reporters import statistics

        return statistics.render(results, as_json=form == "json")
    text = render(form, results, _root())
    if form in FOR_PEOPLE:  # other programs read the rest, and the times from --times
        text += "".join(f"\n{outcome.table}" for outcome in outcomes if outcome.table)
    return text


def _change(outcome: _Outcome) -> Iterator[str]:
    before, after = outcome.before.source, outcome.checked.source
    return unified(before.path, before.text, after.text)


def _root() -> Path:
    """Return the folder that files are named from: the checkout of the CI service around us, else the working one."""
    here = Path.cwd()
    for variable in _ROOTS:
        checkout = os.environ.get(variable)
        # a job may work outside the checkout; then its variable says nothing about these files
        if checkout and here.is_relative_to(checkout):
            return Path(checkout)
    return here


def _judged(job: Job, outcomes: Sequence[_Outcome]) -> int:
    """Return the exit code of the findings."""
    if job.report.exit_zero:
        return 0
    if job.fixes.diff:
        return DIAGNOSTICS if any(outcome.fixed for outcome in outcomes) else 0
    found = [item for outcome in outcomes for item in outcome.findings]
    warned = job.report.strict and _has_warnings(outcomes, found)
    return DIAGNOSTICS if warned or has_errors(found) else 0


def _has_warnings(outcomes: Sequence[_Outcome], found: Sequence[Diagnostic]) -> bool:
    return any(item.severity is Severity.WARNING for item in found) or any(outcome.doubts for outcome in outcomes)
