"""Do ``check`` and a run judge alike? Made-up programs, cells and points files, valid and spoilt, put to both.

A case is a program of straight lines with a cell and a points file beside it; values are taken from valid ones, limits
and what lies beyond, names from those that are there and those that are not. Three verdicts:

    check    ``check_source``: faults of files, errors of the program; no numerics
    load     what a run reads and checks before it plans (``load_project``)
    carried  the program carried out without a check (``rehearse``): what it refuses a run would refuse

They disagree where check and load differ in a fault or an error, where check accepts what the rehearsal refuses for a
reason that was knowable, and where check refuses a program that the rehearsal carries out.
``python -m tests.robolang.verdicts [COUNT [SEED]]`` puts many to them.
"""

import random
import re
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

from robolang.core.diagnostics import Severity
from robolang.core.source import read_program
from robolang.execution.dry_run import rehearse
from robolang.lint.engine import check_source
from robolang.project.builtin import cell_text
from robolang.project.project import Project, load_project
from robolang.syntax.parser import parse
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from tests.robolang.cli.commands import BUILTIN

OF_NUMERICS = frozenset({"RBL606", "RBL615", "RBL616", "RBL617", "RBL618"})
"""Faults of files that need vectors or a model of the arm; ``check --motion`` and a run find them."""
OF_MOTION = ("RBL410", "RBL411", "RBL412", "RBL416", "RBL509")
"""Refusals of a plan that need the geometry of the arm."""

NUMBERS = (
    "0",
    "1",
    "-1",
    "2.5",
    "100",
    "100.5",
    "600",
    "601",
    "2000",
    "2001",
    "86400",
    "86401",
    "1024",
    "1025",
    "100001",
    "NAN",
    "INF",
    "0 - 5",
    "1 / 0",
    "2 * 50",
    "99999",
    "100000",
)
GOOD = (
    "SPEED 200",
    "SPEEDJ 50",
    "ACCEL 80",
    "OVERRIDE 50",
    "ZONE 0",
    "LOAD empty",
    "LOAD (0, 0, 60), 0.8",
    "TOOL grip",
    "MOVE P2",
    "MOVEJ P3",
    "x = IN(1)",
    "OUT(1) = 1",
    "DIM a(10)",
    "CONST k = 3",
    "MOVEJ H",
    "DELAY 0.1",
    "MOVE P2 + (0, 0, 10)",
    "HAND OFF, 0.1",
    "APPROACH P2, 20",
    "x = P2.X",
)
SPOILT = (
    "SPEED {}",
    "SPEEDJ {}",
    "ACCEL {}",
    "OVERRIDE {}",
    "ZONE {}",
    "MOVE P2, SPEED {}",
    "MOVEJ P2, SPEED {}",
    "MOVE P2, ACCEL {}",
    "MOVE P3, TIME {}",
    "MOVE P2, ZONE {}",
    "DELAY {}",
    "PULSE 1, {}",
    "HAND OFF, {}",
    "OUT({}) = 1",
    "OUT(1) = {}",
    "x = IN({})",
    "DIM b({})",
    "LOAD (0, 0, {}), 0.5",
    "LOAD (0, 0, 9000), 0",
    "LOAD (0, 0, 60), {}",
    "LOAD (0, 0, 60), 0.5, ({}, 1, 1, 0, 0, 0)",
    "APPROACH P2, {}",
    "DEPART {}",
    "MOVE P2 + (0, 0, {})",
    "MOVEJ JOINT(0, {}, -190, 0, 30, 0)",
    "MOVEJ JOINT(0, 60, {})",
    "x = SQR({})",
    "MOVEJ JOINT(0, 60, -190, 0, 30, {})",
    "WAIT 1, TIMEOUT {}",
    "LOAD none",
    "LOAD heavy",
    "TOOL none",
    "FRAME none\nMOVE P2 + (0, 0, 1)",
    "MOVE none",
    "x = none + 1",
    "x = P2 + 1",
    "MOVE POSE({}, 0, 840, 180, 0, 0)",
    "LOAD (0, 0, 60), 0.5, (0.1, 0.1, 0.2000000001, 0, 0, 0)",
    "FRAME POSE({}, 0, 0, 0, 0, 0)",
)
VALUES = ("nan", "inf", "-1", "0", "1e12", '"x"', "true", "[1]", "[]", "5000", "0.5", '"RIGHTY"', '"nowhere"', "-0.0")
EXTRA = (
    "[frames.bench]\npose_mm_deg = [0, 0, 0, 0, 0, 0]\n",
    "[loads.heavy]\nmass_kg = 9\ncog_mm = [0, 0, 0]\n",
    "[loads.far]\nmass_kg = 1\ncog_mm = [0, 0, 2500]\n",
    "[inputs.1]\nchanges = [[0, 1]]\n",
    "[inputs.0]\nfollows = 1\n",
    "[tools.GRIP]\npose_mm_deg = [0, 0, 0, 0, 0, 0]\n",
    "[nothing]\n",
    "[controller]\nservo_period_ms = 0.5\n",
    '[controller.servo]\nfeedforward = "measured"\n',
    '[controller.servo]\nfeedforward = "measured"\nvelocity_feedforward = 1\n',
    "[controller]\ncycle = 4\n",
    "[controller.servo]\nvelocity_bandwidth_rad_s = [1, 2]\n",
    '[controller.servo]\ncompensation = "none"\n',
    '[sensors.torch]\nkind = "ramp"\ndeviation_mm_deg = [0, 0, 0, 0, 0, 0]\nover_mm = 10\n',
    "x = [[[[\n",
)
POINTS = BUILTIN.joinpath("points.toml").read_text() + "\n[points.H]\njoints = [0, 60, -190, 0, 30, 0]\n"
MORE_POINTS = (
    '[points.K]\npose = [450, 0, 800, 180, 0, 0]\nframe = "nowhere"\n',
    "[points.K]\njoints = [0, 500, 0, 0, 0, 0]\n",
    "[points.p2]\n",
)
_LINE = re.compile(r"^(\w+) = .*$", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A program and the files beside it."""

    program: str
    cell: str
    points: str


def case(seed: int) -> Case:
    """Return a made-up case; a third of them has nothing wrong, others one or two things."""
    pick = random.Random(seed)
    cell, points = cell_text() + EXTRA[3], POINTS
    lines = pick.sample(GOOD, pick.randint(1, 4))
    for _ in range(pick.choice((0, 1, 1, 2))):
        where = pick.choice(("program", "program", "program", "cell", "points"))
        if where == "program":
            lines.insert(pick.randint(0, len(lines)), pick.choice(SPOILT).format(pick.choice(NUMBERS)))
        elif where == "cell":
            cell = _spoilt(cell, pick, EXTRA)
        else:
            points = _spoilt(points, pick, MORE_POINTS)
    return Case(program="\n".join((*lines, "MOVE P2")) + "\n", cell=cell, points=points)


def _spoilt(text: str, pick: random.Random, extra: tuple[str, ...]) -> str:
    """Return a TOML text with one thing changed: a value, a key, a line gone, a table more, the end cut off."""
    kind = pick.choice(("value", "value", "value", "key", "gone", "extra", "extra", "cut"))
    if kind == "extra":
        return text + pick.choice(extra)
    line = pick.choice(list(_LINE.finditer(text)))
    if kind == "cut":
        return text[: pick.randint(line.start(), line.end())]
    new = {"value": f"{line[1]} = {pick.choice(VALUES)}", "key": f"{line[1]}x" + line[0][len(line[1]) :], "gone": ""}
    return text[: line.start()] + new[kind] + text[line.end() :]


def disagreement(made: Case, folder: Path) -> str:
    """Return how the verdicts on a case differ, an empty text where they agree."""
    path = folder / "p.rbl"
    for name, text in (("p.rbl", made.program), ("p.cell.toml", made.cell), ("p.points.toml", made.points)):
        (folder / name).write_text(text)
    checked = check_source(read_program(path))
    faults = sorted(map(_place, checked.faults))
    errors = {(item.code, item.span.start) for item in checked.diagnostics if item.severity is Severity.ERROR}
    try:
        project = load_project(path)
    except Fault as fault:
        found = sorted(map(_place, fault.all))
        numerics = {code for code, *_ in found} <= OF_NUMERICS and not faults
        return "" if found == faults or numerics else f"check: {faults}; run: {found}"
    wrong = {(item.code, item.span.start) for item in project.diagnostics if item.severity is Severity.ERROR}
    if faults or wrong != errors:
        return f"check: {faults} {sorted(errors)}; run: {sorted(wrong)}"
    return _carried_out(project, errors)


def _carried_out(project: Project, errors: set[tuple[str, int]]) -> str:
    """Return where the program does when it is carried out what check did not say, or does not do what it said."""
    parsed = parse(project.source)
    if any(item.severity is Severity.ERROR for item in parsed.diagnostics):
        return ""
    refused = [(item.code, item.span.start) for item in rehearse(replace(project, diagnostics=())).refused]
    if not errors and refused and not refused[0][0].startswith(OF_MOTION):
        return f"check accepts, the run refuses: {refused}"
    if errors and not refused:
        return f"check refuses {sorted(errors)}, the run carries it out"
    return ""


def _place(fault: Fault) -> tuple[str, str, int, int]:
    if isinstance(fault, FileFault):
        return fault.code, Path(fault.path).name, fault.line, fault.column
    return fault.code, "", 0, 0


def main(count: int, seed: int) -> int:
    """Put cases to the verdicts and print where they differ; return how many do."""
    differ = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(seed, seed + count):
            found = disagreement(case(number), Path(folder))
            if found:
                differ += 1
                print(f"{number}: {found}")
    print(f"{count} cases from {seed}: the verdicts on {differ} differ")
    return differ


if __name__ == "__main__":
    arguments = [int(word) for word in sys.argv[1:]]
    sys.exit(bool(main(*[*arguments, *(500, 0)[len(arguments) :]])))
