"""Every rule has a page whose example is true."""

import pytest

from robolang.core.diagnostics import Severity, has_errors
from robolang.core.source import Source, read_program
from robolang.execution.dry_run import rehearse
from robolang.lint.apply import fix_all
from robolang.lint.engine import check_points, check_source, lint
from robolang.lint.registry import codes, rule, rules
from robolang.lint.rules import meaning as meaning_rules
from robolang.lint.rules import motion as motion_rules
from robolang.lint.rules import planning as planning_rules
from robolang.lint.rules import point as point_rules
from robolang.lint.rules import run as run_rules
from robolang.lint.rules import text as text_rules
from robolang.planning.motion_findings import findings
from robolang.project.project import load_project
from runtime.core.faults import lookup
from runtime.core.tomlfile import FileFault
from tests.robolang.helpers import cell_with
from tests.robolang.lint.helpers import POINTS
from tests.together import together

OF_THE_MOTION = {
    *("RBL410", "RBL411", "RBL412", "RBL414", "RBL416", "RBL417", "RBL419", "RBL421", "RBL422", "RBL423", "RBL424"),
    *("RBL425", "RBL426", "RBL427", "RBL428", "RBL429", "RBL434", "RBL435", "RBL436", "RBL437", "RBL440", "RBL441"),
}
"""Codes that only planning the motion finds."""
OF_THE_RUN = {
    *("RBL307", "RBL309", "RBL401", "RBL402", "RBL403", "RBL404", "RBL405", "RBL415", "RBL507", "RBL534"),
}
"""Codes of values, which a run may compute; checking finds those of numbers alone."""
RULES = list(rules().values())
EXAMPLES = [pytest.param(item, marks=pytest.mark.physics) if item.motion else item for item in RULES]
WITH_FIX = [item for item in RULES if item.fix]


def name(item):
    return item.code


def points_fault(text, item, folder):
    """``(code, line)`` of what is wrong with the points file of an example; None when nothing is."""
    (folder / "pick.rbl").write_text("MOVE P1\n")
    if text == item.bad and not item.line:
        (folder / "pick.points.toml").symlink_to("none.points.toml")
    else:
        (folder / "pick.points.toml").write_bytes(text.encode("utf-8", "surrogateescape"))
    result = check_source(read_program(folder / "pick.rbl"))
    assert result.diagnostics == ()
    if (in_points := check_points(result)) is not None:
        (only,) = in_points.diagnostics
        return only.code, in_points.source.place(only.span.start).line
    return next(((fault.code, getattr(fault, "line", 0)) for fault in result.faults), None)


def examine(text, item, folder):
    """``(code, line, severity)`` of everything found in a program of an example."""
    source = Source("pick.rbl", text)
    if item.motion:
        (folder / "pick.rbl").write_text(text)
        project = load_project(folder / "pick.rbl")
        assert not has_errors(project.diagnostics)
        found = (*project.diagnostics, *findings(project, rehearse(project), 3.0 if item.code == "RBL423" else None))
    else:
        found = lint(source, cell_with(points=POINTS, rated_payload_kg=2.5, sensors=["LASER"], tools=["GRIPPER"]))
    return [(one.code, source.place(one.span.start).line, one.severity) for one in found]


def test_every_code_that_checking_can_find_has_a_page():
    missing = {entry.code for entry in codes() if rule(entry.code) is None}
    assert missing == set(), "write a Rule in robolang/lint, then: python -m robolang.lint.pages"


def test_every_page_is_of_a_code_that_checking_can_find():
    assert set(rules()) <= {entry.code for entry in codes()}


def test_what_a_run_or_the_motion_finds_is_no_unused_suppression():
    assert {item.code for item in RULES if item.motion} == OF_THE_MOTION
    assert {item.code for item in RULES if item.entry.computed} == OF_THE_RUN
    assert not any(lookup(code).is_certain for code in OF_THE_RUN | OF_THE_MOTION)
    assert lookup("RBL301").is_certain


@pytest.mark.parametrize("item", EXAMPLES, ids=name)
def test_an_example_yields_its_code_at_its_line_and_nowhere_else(item, tmp_path):
    if item.code == "RBL104":
        (tmp_path / "pick.rbl").write_bytes(item.bad.encode("utf-8", "surrogateescape"))
        with pytest.raises(FileFault) as caught:
            read_program(tmp_path / "pick.rbl")
        assert (caught.value.code, caught.value.line) == ("RBL104", item.line)
        return
    if item.points:
        assert points_fault(item.bad, item, tmp_path) == (item.code, item.line or 1)
        return
    found = examine(item.bad, item, tmp_path)
    beside = {"RBL426"} if item.code == "RBL425" else set()  # what is far from the flange is both
    assert {code for code, line, _ in found if line == item.line} - beside == {item.code}
    assert {line for code, line, _ in found if code == item.code} == {item.line}
    assert {severity for code, _, severity in found if code == item.code} == {item.severity}


@pytest.mark.parametrize("item", EXAMPLES, ids=name)
def test_the_corrected_example_has_no_finding(item, tmp_path):
    if item.points:
        assert points_fault(item.good, item, tmp_path) is None
    else:
        assert examine(item.good, item, tmp_path) == []


@pytest.mark.parametrize("item", WITH_FIX, ids=name)
def test_a_fix_that_is_promised_makes_the_correction_of_the_example(item):
    fixed = fix_all(Source("pick.rbl", item.bad), lambda source: lint(source, cell_with(points=POINTS)))
    assert fixed.counts == {item.code: 1}
    assert fixed.source.text == item.good


@together("item", [item for item in RULES if not item.fix], ids=name)
def test_a_rule_without_a_fix_has_none(item):
    if item.code != "RBL104" and not item.points:
        assert all(found.fix is None for found in lint(Source("pick.rbl", item.bad), cell_with(points=POINTS)))


@together("item", RULES, ids=name)
def test_the_texts_are_sentences(item):
    for text in filter(None, (item.why, item.fix)):
        assert text[0].isupper()
        assert text.endswith(".")
    assert len(item.why) > 60
    assert isinstance(item.severity, Severity)
    assert item.entry == lookup(item.code)
    assert item.bad != item.good
    assert max(map(len, (item.shown or item.bad).splitlines())) <= 76


def test_rules_stand_in_the_module_of_their_group():
    for module, first in (
        (text_rules, "1"),
        (meaning_rules, "2"),
        (point_rules, "3"),
        (motion_rules, "4"),
        (planning_rules, "4"),
        (run_rules, "5"),
    ):
        assert [item.code for item in module.RULES] == sorted(item.code for item in module.RULES)
        assert {item.code[3] for item in module.RULES} == {first}
    assert list(rules()) == sorted(rules())


def test_an_example_that_is_a_file_is_checked_like_any_other(tmp_path):
    path = tmp_path / "pick.rbl"
    path.write_text(rules()["RBL301"].bad)
    result = check_source(read_program(path))
    assert [item.code for item in result.diagnostics] == ["RBL301"]
