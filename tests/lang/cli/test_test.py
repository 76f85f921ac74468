"""``robolang test``: programs with expectations, the report, and golden logs that name where a run differs."""

import shutil
import xml.etree.ElementTree as ET

import pytest

from robolang.expectation import load_expectation
from runtime.tomlfile import FileFault
from tests.lang.cli.commands import ROOT, robolang

PICK = ROOT / "programs/pick_and_place.rbl"


def copied(tmp_path, expect, text=None):
    for end in (".rbl", ".points.toml", ".cell.toml"):
        shutil.copy(PICK.with_suffix(end), tmp_path / f"job{end}")
    if text is not None:
        (tmp_path / "job.rbl").write_text(text, "utf-8")
    (tmp_path / "job.test.toml").write_text(f"schema = 1\nphysics = false\n[expect]\n{expect}\n", "utf-8")
    return tmp_path / "job.rbl"


def test_the_programs_do_what_they_are_expected_to():
    result = robolang("test", ROOT / "programs")
    assert "FAIL" not in result.stdout
    assert "7 of 7 programs as expected" in result.stdout


@pytest.mark.parametrize(
    ("expect", "says"),
    [
        ("cycle_s = [1, 2]", "cycle: 5."),
        ("path_error_mm = 0.0", "path deviation: 0."),
        ("tool_error_mm = 0.0", "tool error: 0."),
        ("torque_pct = 1", "peak torque: "),
        ("end_pose = [480, -220, 800, 180, 0, 180]", "end: 40.0"),
        ('alarms = ["RBL516"]', "alarms: none"),
        ('printed = ["a"]', "printed: 0 lines, expected 1"),
        ("[expect.parts]\nghost = [0, 0, 0]", "part ghost: the cell has no such part"),
    ],
)
def test_what_is_not_as_expected_is_named(tmp_path, expect, says):
    result = robolang("test", copied(tmp_path, expect), code=1)
    assert says in result.stdout
    assert "0 of 1 programs as expected" in result.stdout


def test_a_golden_log_names_the_first_line_and_tick_that_differ(tmp_path):
    program = copied(tmp_path, "golden_deg = 0.001")
    assert "RBL600" in robolang("test", program, code=2).stderr  # not written yet
    robolang("test", program, "--update")
    assert "1 of 1" in robolang("test", program).stdout
    text = program.read_text("utf-8")
    program.write_text(text.replace("70  MOVE P3", "70  MOVE P3, SPEED 200"), "utf-8")
    result = robolang("test", program, code=1)
    assert "golden: " in result.stdout
    assert "line 70" in result.stdout
    assert "first at tick 2" in result.stdout


def test_a_program_that_cannot_run_is_named(tmp_path):
    result = robolang("test", copied(tmp_path, "", "10 MOVE P9\n"), code=1)
    assert "RBL301" in result.stdout
    result = robolang("test", copied(tmp_path, "", "10 MOVE P1 + (5000, 0, 0)\n"), code=1)
    assert "RBL410" in result.stdout


def test_the_report_is_junit(tmp_path):
    report = tmp_path / "report.xml"
    robolang("test", copied(tmp_path, "cycle_s = [1, 2]"), "--junit", report, code=1)
    (suite,) = ET.parse(report).getroot()
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    assert [case.find("failure") is None for case in suite] == [True, False]
    assert set(suite.keys()) == {"name", "tests", "failures", "errors", "time"}  # those that its schema asks for
    assert {name for case in suite for name in case.keys()} == {"classname", "name"}  # noqa: SIM118


def test_the_report_is_xml_whatever_is_printed(tmp_path):
    report = tmp_path / "report.xml"
    wanted = r'printed = ["b \u001b\ufffe <&"]'
    robolang("test", copied(tmp_path, wanted, 'PRINT "a"\n'), "--junit", report, code=1)
    (failure,) = ET.parse(report).getroot().iter("failure")
    assert "line 1 is 'a', expected 'b \ufffd\ufffd <&'" in failure.get("message")


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("RBL410", "MOVE P1 + (9000, 0, 0)\n"),
        ("RBL301", "MOVE P99\n"),
        ("RBL503", 'PRINT "a"\nWAIT 1 = 2, TIMEOUT 0.2\n'),
        ("RBL501", 'PRINT "a"\nx = 0\nPRINT 1 / x\n'),
    ],
)
def test_errors_of_planning_and_of_the_program_can_be_expected(tmp_path, code, text):
    said = robolang("test", copied(tmp_path, f'alarms = ["{code}"]', text)).stdout
    assert said.startswith("ok")
    said = robolang("test", copied(tmp_path, "alarms = []", text), code=1).stdout
    assert code in said
    assert "\ufffd" not in said


def test_what_a_program_printed_before_its_error_is_there(tmp_path):
    text = 'PRINT "a"\nWAIT 1 = 2, TIMEOUT 0.2\nPRINT "b"\n'
    robolang("test", copied(tmp_path, 'alarms = ["RBL503"]\nprinted = ["a"]\ncycle_s = [0.2, 0.21]', text))


def test_a_file_that_is_not_there_is_refused(tmp_path):
    assert "RBL701" in robolang("test", tmp_path / "no.rbl", code=2).stderr


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [
        ("schema = 2", "RBL605", 1),
        ("schema = 1\n[expect]\ncycle_s = [2, 1]", "RBL607", 3),
        ("schema = 1\n[expect]\ncycle = 2", "RBL609", 3),
        ("schema = 1\n[expect]\nprinted = [1]", "RBL613", 3),
        ("schema = 1\n[expect]\ntorque_pct = nan", "RBL604", 3),
        ("schema = 1\n[expect.parts]\npart = [1, 2]", "RBL613", 3),
    ],
)
def test_a_test_file_is_refused_at_its_line(tmp_path, text, code, line):
    path = tmp_path / "a.test.toml"
    path.write_text(text + "\n", "utf-8")
    with pytest.raises(FileFault) as caught:
        load_expectation(path)
    assert (caught.value.code, caught.value.line) == (code, line)
