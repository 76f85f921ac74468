"""What the documentation says of names, files, commands, keys and output is true of the code beside it.

``python -m tests.arch.test_docs`` writes docs/codes.md and docs/decisions/README.md anew.
"""

import ast
import importlib
import inspect
import io
import pkgutil
import re
import tomllib
from contextlib import redirect_stdout
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import robolang
import runtime
from robolang.analysis.checker import check
from robolang.cli.run_table import print_result
from robolang.cli.verdict import verdict
from robolang.core.diagnostics import has_errors
from robolang.core.source import Source
from robolang.syntax.parser import parse
from runtime.control.recorder import Recorder
from runtime.control.signals import Signals
from runtime.core.faults import all_codes
from runtime.robot.kinematics.chain import Chain
from tests.arch.parsed import nodes_of
from tests.robolang.helpers import cell_with
from tests.together import together

ROOT = Path(__file__).parents[2]
CODES = ROOT / "docs" / "codes.md"
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
TEMPLATES = sorted((ROOT / ".github").rglob("*.md"))
RECORDS = sorted((ROOT / "docs" / "decisions").glob("[0-9]*.md"))
DECISIONS = ROOT / "docs" / "decisions" / "README.md"
STATUS = re.compile(r"Status: (accepted|superseded by \d{4}), (\d{4}-\d{2}-\d{2})((?:; amended by .*)?)")
CODE = [path for folder in ("robolang", "runtime", "tests") for path in sorted((ROOT / folder).rglob("*.py"))]
PREAMBLE = """\
# Codes

Every diagnostic, fault and alarm has a code. `robolang explain RBL412` prints one, `robolang explain` lists them. 1xx
text, 2xx meaning, 3xx points, 4xx payload and motion, 5xx run, 6xx robot and cell files, 7xx command line and
configuration, 9xx internal. A code keeps its number and its meaning; what a message says may change.

This page is generated: `python -m tests.arch.test_docs`.

| code | name | meaning | what to do |
|---|---|---|---|
"""
DECISIONS_PREAMBLE = """\
# Decisions

Why the project is as it is. A record has at most 40 lines: what made a choice necessary, what was chosen and what was
rejected, and what follows. It is written with the change that it explains. A later record does not delete an earlier
one: the earlier one says by which record it is amended or superseded.

This page is generated: `python -m tests.arch.test_docs`.

| record | decision | status | date |
|---|---|---|---|
"""

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
DOTTED = re.compile(r"`((?:runtime|robolang)(?:\.\w+)+)`")
FILE = re.compile(
    r"(?<![\w/.-])((?:runtime|robolang|tests|programs|docs)/[\w./-]*\.(?:py|toml|rbl|md|lark))(?:::(\w+))?"
)
TEST = re.compile(r"`(test_\w+)`")
WORD = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"(?:\.ci|\.github|docs|programs|robolang|runtime|tests)/[\w./*-]*")
MODULE = re.compile(r"[a-z]\w*\.(?:py|lark)")
MEMBER = re.compile(r"([A-Z]\w+)\.([a-z]\w*)")
ELSEWHERE = {"lark.py", "typer.py", "ctypes.py"}
"""Modules of libraries, which docs/testing.md names."""
CITED = re.compile(r"docs/[\w/-]*\w(?:\.md)?")


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def fenced(page: Path, language: str) -> list[str]:
    return [text for kind, text in FENCE.findall(page.read_text("utf-8")) if kind == language]


def prose(page: Path) -> str:
    return FENCE.sub("", page.read_text("utf-8"))


@cache
def names_of_tests() -> frozenset[str]:
    found = (re.findall(r"^\s*def (test_\w+)", path.read_text("utf-8"), re.MULTILINE) for path in CODE)
    return frozenset(word for words in found for word in words)


def load_everything() -> None:
    """Import every module of both packages, so that every code is registered."""
    for package in (robolang, runtime):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.endswith("__main__"):
                importlib.import_module(module.name)


def codes_page() -> str:
    load_everything()
    rows = [f"| {code.code} | {code.name} | {code.meaning} | {code.remedy} |" for code in all_codes()]
    return PREAMBLE + "\n".join(rows) + "\n"


def decisions_page() -> str:
    rows = []
    for path in RECORDS:
        title, _, status = path.read_text("utf-8").splitlines()[:3]
        state, date, amended = STATUS.fullmatch(status).groups()
        rows.append(f"| [{path.name[:4]}]({path.name}) | {title[7:]} | {state}{amended} | {date} |")
    return DECISIONS_PREAMBLE + "\n".join(rows) + "\n"


def resolve(dotted: str) -> object:
    """Return what a dotted name means: a module, or something inside one."""
    parts = dotted.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            found = getattr(found, part)
        return found
    raise ModuleNotFoundError(dotted)


# --- links, names, files ---------------------------------------------------------------------------------------------


@together("page", PAGES, ids=name)
def test_links_lead_to_something(page):
    missing = []
    for target in LINK.findall(prose(page)):
        if re.match(r"[a-z]+:", target):
            continue
        path = page.parent / target.partition("#")[0] if not target.startswith("#") else page
        if not path.exists():
            missing.append(target)
    assert missing == []


def headings(page: Path) -> set[str]:
    """Return the anchors of a page: its headings in small letters, blanks as hyphens, other signs left out."""
    titles = re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


def lost(page: Path, text: str) -> list[str]:
    """Return the links of a text to headings that the linked page does not have."""
    links = [target.partition("#") for target in LINK.findall(text) if "#" in target and ":" not in target]
    pages = [(path, (page.parent / path) if path else page, anchor) for path, _, anchor in links]
    return [f"{path}#{anchor}" for path, linked, anchor in pages if anchor not in headings(linked)]


@together("page", PAGES, ids=name)
def test_links_lead_to_headings(page):
    assert lost(page, prose(page)) == []


def test_a_link_to_a_heading_that_is_gone_is_noticed():
    page = ROOT / "docs" / "servo.md"
    assert lost(page, "[a](#gravity) [b](timing.md#the-pipeline)") == []
    assert lost(page, "[a](#weight) [b](timing.md#pipeline)") == ["#weight", "timing.md#pipeline"]


def test_every_page_is_reached_from_the_readme():
    reached, todo = set(), [ROOT / "README.md"]
    while todo:
        page = todo.pop()
        if page in reached:
            continue
        reached.add(page)
        for target in LINK.findall(prose(page)):
            path = (page.parent / target.partition("#")[0]).resolve()
            todo += sorted(path.glob("*.md")) if path.is_dir() else [path] if path.suffix == ".md" else []
    assert [name(page) for page in PAGES if page not in reached] == []


@together("page", PAGES, ids=name)
def test_names_of_the_code_exist(page):
    wrong = []
    for dotted in DOTTED.findall(prose(page)):
        try:
            resolve(dotted)
        except (ModuleNotFoundError, AttributeError) as error:
            wrong.append(f"{dotted}: {error}")
    assert wrong == []


def test_a_name_that_does_not_exist_is_noticed():
    assert inspect.isfunction(resolve("runtime.motion.cartesian_planner.CartesianPlanner.plan"))
    for wrong in ("runtime.motion.plan", "runtime.motion.cartesian_planner.CartesianPlanner.plans", "robolang.nothing"):
        with pytest.raises((ModuleNotFoundError, AttributeError)):
            resolve(wrong)


@cache
def members() -> dict[str, set[str]]:
    """Return the classes of both packages, each with every name that its body defines, assigns or reads on self."""
    found: dict[str, set[str]] = {}
    for path in (path for path in CODE if "tests" not in path.relative_to(ROOT).parts):
        for item in nodes_of(path):
            if isinstance(item, ast.ClassDef):
                inner = list(ast.walk(item))
                names = {node.name for node in inner if isinstance(node, ast.FunctionDef)}
                names |= {node.attr for node in inner if isinstance(node, ast.Attribute)}
                names |= {node.id for node in inner if isinstance(node, ast.Name)}
                found[item.name] = found.get(item.name, set()) | names
    return found


def gone(text: str) -> list[str]:
    """Return the paths, modules and members of classes that a text names in backquotes and that are not there."""
    modules = {path.name for path in CODE} | {path.name for path in ROOT.glob("robolang/**/*.lark")} | ELSEWHERE
    words = [word.partition("::")[0].strip(",.;:()") for quoted in WORD.findall(text) for word in quoted.split()]
    missing = [word for word in words if PATH.fullmatch(word) and not any(ROOT.glob(word.rstrip("/")))]
    missing += [word for word in words if MODULE.fullmatch(word) and word not in modules]
    pairs = [(word, MEMBER.fullmatch(word.partition("(")[0])) for word in words]
    return missing + [word for word, pair in pairs if pair and pair[2] not in members().get(pair[1], {pair[2]})]


@together("page", [*PAGES, *TEMPLATES], ids=name)
def test_paths_modules_and_members_exist(page):
    """The history alone may name what is gone: what CHANGELOG.md says of an edition was true of that edition."""
    if page.name != "CHANGELOG.md":
        assert gone(prose(page)) == []


def test_a_path_a_module_and_a_member_that_are_gone_are_noticed():
    old = "`runtime/areas.py`, `robolang/syntax/nodes.py::Node`, `printer.py`, `Controller.step_back(1)`, `tests/lang/`"
    now = "`runtime/control`, `tests/*/test_api.py`, `unparse.py`, `Controller.rehearse`, `Areas.sda`, `NAME.rbl`"
    assert len(gone(old)) == 5
    assert gone(now) == []


@together("page", PAGES, ids=name)
def test_files_and_tests_exist(page):
    text = page.read_text("utf-8")
    missing = []
    for path, test in FILE.findall(text):
        there = (ROOT / path).is_file()
        if not there or (test and f"def {test}(" not in (ROOT / path).read_text("utf-8")):
            missing.append(f"{path}::{test}" if test else path)
    missing += [test for test in TEST.findall(text) if test not in names_of_tests()]
    assert missing == []


def test_folders_to_contribute_to_exist():
    folders = re.findall(r"`((?:robolang|runtime|tests|docs)/[\w/]*)`", (ROOT / "CONTRIBUTING.md").read_text("utf-8"))
    assert len(folders) > 15
    assert [folder for folder in folders if not (ROOT / folder).is_dir()] == []


def test_pages_and_tests_cited_in_the_code_exist():
    missing = []
    for path in CODE:
        if path == Path(__file__):
            continue
        text = path.read_text("utf-8")
        cited = [target for target in CITED.findall(text) if not any(ROOT.glob(f"{target}*"))]
        files = [target for target, _ in FILE.findall(text) if target.startswith("tests")]
        cited += [target for target in files if not (ROOT / target).is_file()]
        missing += [f"{name(path)}: {target}" for target in cited]
    assert missing == []


def test_decisions_are_numbered_dated_and_short():
    numbers = [path.name[:4] for path in RECORDS]
    assert numbers == sorted(set(numbers))  # each once; a number that was given out and not used is a gap
    for path in RECORDS:
        lines = path.read_text("utf-8").splitlines()
        assert lines[0].startswith(f"# {path.name[:4]} "), path.name
        assert STATUS.fullmatch(lines[2]), f"{path.name}:3: write 'Status: accepted, YYYY-MM-DD'"
        assert [line for line in lines if line.startswith("## ")] == ["## Context", "## Decision", "## Consequences"]
        assert len(lines) <= 40, path.name


# --- generated and mirrored ------------------------------------------------------------------------------------------


def test_the_table_of_codes_is_current():
    assert CODES.read_text("utf-8") == codes_page(), "run: python -m tests.arch.test_docs"


def test_the_list_of_decisions_is_current():
    assert DECISIONS.read_text("utf-8") == decisions_page(), "run: python -m tests.arch.test_docs"


def test_every_term_of_the_glossary_says_where_it_is_defined():
    rows = re.findall(r"^\| (.+?) \| (.+?) \| (.+) \|$", (ROOT / "docs/glossary.md").read_text("utf-8"), re.MULTILINE)
    terms = [term.lower() for term, _, _ in rows[1:]]
    assert len(terms) > 50
    assert terms == sorted(set(terms))
    for term, meaning, where in rows[1:]:
        assert len(meaning) > 15, term
        assert LINK.findall(where) or DOTTED.findall(where), term  # that they exist is tested for every page


def test_codes_in_prose_are_registered():
    load_everything()
    known = {code.code for code in all_codes()}
    found = {code for page in PAGES for code in re.findall(r"RBL\d{3}", page.read_text("utf-8"))}
    assert found - known == set()


def test_the_layers_are_those_that_are_checked():
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    layers = {item["containers"][0]: item["layers"] for item in contracts if item["type"] == "layers"}
    (drawn,) = [text for text in fenced(ROOT / "docs/architecture.md", "text") if "never imports" in text]
    columns = [re.split(r"\s{3,}", line.strip()) for line in drawn.splitlines()[2:]]
    assert [cells[0] for cells in columns] == layers["robolang"]
    assert [cells[2] for cells in columns if len(cells) == 4] == layers["runtime"]


def test_every_signal_is_in_the_table_with_its_shape():
    recorder = Recorder(7, 8, 1000, parts=3)  # seven axes: a deviation has six entries on any arm
    zeros = np.zeros(7)
    recorder.begin_cycle((zeros, zeros, zeros, zeros, np.zeros(6)), np.zeros((3, 8, 7)), (0.0, 0, 0, 0))
    recorder.record((zeros, zeros, zeros, zeros, zeros))
    chain = Chain(placements=(np.eye(4),) * 7, X_last_flange=np.eye(4))
    signals = Signals(recorder.recorded(), chain)
    names = {7: "n", 3: "m"}
    shapes = {
        key: ", ".join(["(N" if signals.base(key) == "tick" else "(K", *(names.get(k, str(k)) for k in rest)]) + ")"
        for key, rest in ((key, values.shape[1:]) for key, values in signals.items())
    }
    shapes |= {"tool_cmd": "(N, 3)", "parts": "(K, m, 7)"}  # 3 axes of space, and 7 numbers of a pose
    rows = re.findall(r"^\| `(\w+)` \| (\([NK][^|]*\)) \|", (ROOT / "docs/signals.md").read_text("utf-8"), re.MULTILINE)
    assert dict(rows) == {key: re.sub(r"^\((.)\)$", r"(\1,)", shape) for key, shape in shapes.items()}


@pytest.mark.physics
def test_every_key_of_the_report_is_explained(run_result):
    explained = set(re.findall(r"`(\w+)", (ROOT / "docs/signals.md").read_text("utf-8")))
    keys = "code name severity message hint file line column end_line end_column related number axis time_s category"
    alarm = set(keys.split())
    assert keys_of({key: value for key, value in run_result.report.items() if key != "objects"}) | alarm <= explained


def keys_of(value: object) -> set[str]:
    if isinstance(value, dict):
        return set(value) | {key for item in value.values() for key in keys_of(item)}
    return {key for item in value for key in keys_of(item)} if isinstance(value, list) else set()


@pytest.mark.parametrize(
    "module",
    [
        "runtime/cell/cell_file.py",
        "runtime/cell/sensor_file.py",
        "runtime/settings/profile.py",
        "robolang/project/points.py",
    ],
)
def test_every_key_of_the_files_is_explained(module):
    getters = r"(?:numbers?|integer|text|flag|tables?|named_tables|raw_list|_pose|_point|_size|_named)"
    source = (ROOT / module).read_text("utf-8")
    keys = set(re.findall(getters + r'\((?:\w+, )?"(\w+)"', source)) - {"schema", "points"}
    assert len(keys) >= 7
    explained = set(re.findall(r"[`\[.](\w+)", (ROOT / "docs/language.md").read_text("utf-8")))
    assert keys - explained == set()


# --- what can be run -------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def run_result():
    return robolang.run(ROOT / "programs" / "pick_and_place.rbl")


def test_programs_in_the_pages_have_no_errors():
    programs = [(page, text) for page in PAGES for text in fenced(page, "rbl")]
    assert len(programs) >= 2
    for page, text in programs:
        parsed = parse(Source(name(page), text))
        symbols = cell_with(points=["P1", "P2", "P3", "P5"], rated_payload_kg=2.5)
        found = (*parsed.diagnostics, *check(parsed.program, symbols))
        assert not has_errors(found), (name(page), [item.message for item in found])


@pytest.mark.physics
def test_the_python_of_the_readme_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    (block,) = fenced(ROOT / "README.md", "python")
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(compile(block, "README.md", "exec"), {})
    assert "s simulated" in printed.getvalue()


@pytest.mark.physics
def test_the_transcript_of_the_readme_is_what_a_run_gives(run_result):
    """Times exactly; errors roughly, since another processor may round otherwise."""
    transcript = next(text for text in fenced(ROOT / "README.md", "text") if "pick_and_place" in text)
    rows = [line for line in transcript.splitlines() if re.match(r" +\d+ +\d+  \w", line)]
    statements = run_result.report["statements"]
    assert len(rows) == len(statements)
    for row, statement in zip(rows, statements, strict=True):
        line, number, text, rest = re.fullmatch(r" +(\d+) +(\d+)  (.*?)  +(\d+\.\d{3} .*)", row).groups()
        start, time, *shown = (float(value) for value in rest.split())
        assert (int(line), int(number), text) == (statement["line"], statement["number"], statement["text"])
        assert (start, time) == pytest.approx((statement["start_s"], statement["duration_s"]), abs=5e-4)
        keys = {"joint_error_deg": 2e-3, "tool_error_mm": 0.02, "path_deviation_mm": 0.02, "peak_torque_pct": 0.6}
        keys = {key: tolerance for key, tolerance in keys.items() if statement[key] is not None}
        assert len(shown) == len(keys), text
        for value, (key, tolerance) in zip(shown, keys.items(), strict=True):
            assert value == pytest.approx(statement[key], rel=0.05, abs=tolerance), (text, key)


@pytest.mark.physics
def test_the_transcript_has_the_headings_and_notes_of_a_run(run_result):
    """Line by line what is printed today, numbers apart: a column that is new or gone shows."""
    transcript = next(text for text in fenced(ROOT / "README.md", "text") if "pick_and_place" in text)
    shown = io.StringIO()
    with redirect_stdout(shown):
        print_result({**run_result.report, "program": "programs/pick_and_place.rbl"})
        print(verdict(run_result, "ran to its end", code=0))
    printed = [line.rstrip() for line in shown.getvalue().splitlines() if line.strip()]
    words = [
        [re.sub(r"\d+(\.\d+)?", "0", line).split() for line in lines if line.strip()]
        for lines in (transcript.splitlines(), printed)
    ]
    assert words[0] == words[1]


if __name__ == "__main__":
    CODES.write_text(codes_page(), "utf-8")
    DECISIONS.write_text(decisions_page(), "utf-8")
