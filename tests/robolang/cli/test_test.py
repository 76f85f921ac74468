"""``robolang test``: programs with expectations, the report, and golden logs that name where a run differs."""

import json
import shutil
import xml.etree.ElementTree as ET
from dataclasses import fields

import pytest
from typer.testing import CliRunner

from robolang.cli.main import app
from robolang.testing import verdict
from robolang.testing.expectation import Expectation, load_expectation
from runtime.core.tomlfile import FileFault
from tests import messages
from tests.campaign import WHOLE
from tests.robolang.cli.commands import ROOT, places, robolang

PICK = ROOT / "programs/pick_and_place.rbl"


def copied(tmp_path, expect, text=None):
    for end in (".rbl", ".points.toml", ".cell.toml"):
        shutil.copy(PICK.with_suffix(end), tmp_path / f"job{end}")
    if text is not None:
        (tmp_path / "job.rbl").write_text(text, "utf-8")
    (tmp_path / "job.test.toml").write_text(f"schema = 1\nphysics = false\n[expect]\n{expect}\n", "utf-8")
    return tmp_path / "job.rbl"


@pytest.mark.physics
def test_the_programs_do_what_they_are_expected_to():
    chosen = [ROOT / "programs"] if WHOLE else [PICK, ROOT / "programs/shop/recover.rbl"]
    result = robolang("test", *chosen)
    assert "FAIL" not in result.stdout
    assert messages.numbers(result.stdout.splitlines()[-1]) == ([7, 7] if WHOLE else [2, 2])


def test_an_alarm_and_a_warning_are_placed_in_the_program_also_in_the_report(tmp_path):
    report = tmp_path / "r.xml"
    text = "10 LOAD (0, 0, 60), 0.8\n20 X = 0\n30 IF X = 0 THEN PRINT 1 / X\n"
    result = robolang("test", copied(tmp_path, "", text), "--junit", report, code=1)
    place = f"{tmp_path / 'job.rbl'}:3:18: RBL501 1 / 0"
    assert place in result.stdout
    (failure,) = ET.parse(report).getroot().iter("failure")
    assert place in failure.get("message")
    program = copied(tmp_path, "warnings = []", "2 MOVE P1\n3 MOVE P5\n")
    assert f"{program}:1:3: RBL517 " in robolang("test", program, code=1).stdout


def test_outcomes_are_printed_as_json(tmp_path):
    program = copied(tmp_path, "cycle_s = [1, 2]", "DELAY 3\n")
    result = robolang("test", program, "--json", code=1)
    found = json.loads(result.stdout)
    assert not found["ok"]
    (job,) = found["programs"]
    assert (job["program"], job["ok"], job["seconds"]) == (str(program), False, 3.0)
    assert {each["name"]: each["ok"] for each in job["verdicts"]}["cycle"] is False
    (tmp_path / "job.test.toml").write_text("schema = 2\n")
    broken = json.loads(robolang("test", program, "--json", code=2).stdout)
    assert [each["name"] for each in broken["programs"][0]["verdicts"]] == ["files"]


def test_what_is_not_as_expected_is_named(tmp_path):
    expected = {
        "cycle_s = [1, 2]": "cycle: 5.",
        "path_error_mm = 0.0": "path deviation: 0.",
        "tool_error_mm = 0.0": "tool error: 0.",
        "torque_pct = 1": "peak torque: ",
        "end_pose = [480, -220, 800, 180, 0, 150]": "end: 40.0",
        "end_deg = 29.9": "end turn: turned by 30.0",
        'warnings = ["RBL523"]': "warnings: none, expected RBL523",
        'alarms = ["RBL516"]': "alarms: none, expected RBL516",
        'printed = ["a"]': "printed: 0 lines, expected 1",
        "[expect.parts]\nghost = [0, 0, 0]": "part ghost: the cell has no such part",
    }
    result = robolang("test", copied(tmp_path, "\n".join(expected)), code=1)
    lines = result.stdout.splitlines()
    rows = [4, 5, 6, 7, 8, 8, 10, 11, 12, 14]  # of their keys
    assert len(lines) == len(expected) + 2
    for row, says in zip(rows, expected.values(), strict=True):
        assert [line for line in lines if f"job.test.toml:{row}:1: {says}" in line]
    assert messages.numbers(lines[-1]) == [0, 1]


@pytest.mark.parametrize(
    ("expect", "code"),
    [("", 0), ('["RBL523", "RBL517"]', 0), ("[]", 1), ('["RBL523"]', 1), ('["RBL516", "RBL517", "RBL523"]', 1)],
)
def test_warnings_can_be_demanded_and_forbidden(tmp_path, expect, code):
    program = copied(tmp_path, f"warnings = {expect}" if expect else "", "MOVE P1\nMOVE P2\n")  # without LOAD
    with program.with_name("job.cell.toml").open("a") as cell:
        cell.write("\n[controller]\nin_position_deg = 1e-12\nsettle_timeout_s = 0\n")
    said = robolang("test", program, code=code).stdout
    assert ("job.test.toml:4:1: warnings: RBL517, RBL523 (2 times), expected " in said) == bool(code)
    assert ("forbidden" in said) == (not expect)


def test_a_golden_log_names_the_first_line_and_tick_that_differ(tmp_path):
    program = copied(tmp_path, "golden_deg = 0.001")
    assert "RBL600" in robolang("test", program, code=2).stderr  # not written yet
    robolang("test", program, "--update")
    assert "1 of 1" in robolang("test", program).stdout
    text = program.read_text("utf-8")
    program.write_text(text.replace("70  MOVE P3", "70  MOVE P3, SPEED 200"), "utf-8")
    result = robolang("test", program, code=1)
    assert "golden: " in result.stdout
    assert "line 10 (number 70)" in result.stdout
    assert "tick 2" in result.stdout


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
    assert "job.test.toml:4:1: cycle: 5." in suite[1].find("failure").get("message")
    assert set(suite.keys()) == {"name", "tests", "failures", "errors", "time"}  # those that its schema asks for
    assert {name for case in suite for name in case.keys()} == {"classname", "name"}  # noqa: SIM118


def test_the_report_is_xml_whatever_is_printed(tmp_path):
    report = tmp_path / "report.xml"
    wanted = r'printed = ["b \u001b\ufffe <&"]'
    robolang("test", copied(tmp_path, wanted, 'PRINT "a"\n'), "--junit", report, code=1)
    (failure,) = ET.parse(report).getroot().iter("failure")
    assert {"a", "b \ufffd\ufffd <&"} <= messages.fields(failure.get("message"))


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
    said = robolang(
        "test", copied(tmp_path, 'alarms = ["RBL503"]\nprinted = ["a"]\ncycle_s = [0.2, 0.21]', text)
    ).stdout
    assert said.startswith("ok")


def test_a_program_that_does_not_start_meets_no_other_expectation(tmp_path):
    expect = 'alarms = ["RBL301"]\nwarnings = []\nprinted = []\n'
    robolang("test", copied(tmp_path, expect, "MOVE P99\n"))
    keys = (
        "cycle_s = [0, 9]",
        "path_error_mm = 9",
        "end_pose = [480, -220, 840, 180, 0, 180]",
        "golden_deg = 9",
        "[expect.parts]\npart = [480, 220, 640]",
    )
    for key in keys:
        assert "start" in robolang("test", copied(tmp_path, expect + key, "MOVE P99\n"), code=1).stdout


@pytest.mark.parametrize("key", ["path_error_mm", "tool_error_mm", "torque_pct"])
def test_a_limit_of_what_never_moved_is_not_met(tmp_path, key):
    said = robolang("test", copied(tmp_path, f"{key} = 1000", 'PRINT "a"\n'), code=1).stdout
    assert "compare" in said


def test_a_run_without_a_cycle_is_compared_too(tmp_path):
    home = "end_pose = [400, 0, 840, 180, 0, 180]\nend_mm = 100000\nend_deg = 180\n"
    program = copied(tmp_path, home + "golden_deg = 0\n", 'PRINT "a"\n')
    assert "1 of 1" in robolang("test", program, "--update").stdout
    robolang("test", program)
    program.write_text('PRINT "a"\nMOVE P1\n', "utf-8")
    (golden,) = (line for line in robolang("test", program, code=1).stdout.splitlines() if "golden" in line)
    assert "0" in messages.fields(golden)


# --- a path without a test, a test that cannot be used ---------------------------------------------------------------


def test_a_path_without_a_test_is_no_success(tmp_path):
    (tmp_path / ".hidden").mkdir()
    copied(tmp_path / ".hidden", "")
    assert "error RBL712" in robolang("test", tmp_path, code=2).stderr
    assert robolang("test", tmp_path, "--allow-empty").stdout
    (tmp_path / "with").mkdir()
    program = copied(tmp_path / "with", "")
    result = robolang("test", tmp_path / "with", tmp_path / ".hidden" / "none.rbl", program, code=2)
    assert "error RBL701" in result.stderr
    assert messages.numbers(result.stdout.splitlines()[-1]) == [1, 2]


def test_a_test_that_cannot_be_used_fails_alone_and_is_in_the_report(tmp_path):
    report = tmp_path / "report.xml"
    for name in "abcdef":
        (tmp_path / name).mkdir()
        copied(tmp_path / name, "golden_deg = 0.1" if name in "cd" else "", 'PRINT "a"\n')
    (tmp_path / "a" / "job.test.toml").write_text("schema = 1\n[expct]\n", "utf-8")
    (tmp_path / "b" / "job.rbl").unlink()
    (tmp_path / "c" / "job.golden.npz").write_bytes(b"PK")
    (tmp_path / "e" / "job.cell.toml").write_text("schema = [", "utf-8")
    result = robolang("test", tmp_path, "--junit", report, code=2)
    assert [line[:4] for line in result.stdout.splitlines()] == ["FAIL"] * 5 + ["ok  ", "1 of"]
    assert [code for _, _, code in places(result.stderr)] == ["RBL609", "RBL701", "RBL711", "RBL600", "RBL601"]
    suites = ET.parse(report).getroot()
    assert [(suite.get("failures"), suite.get("errors")) for suite in suites] == [("0", "1")] * 5 + [("0", "0")]
    assert [error.get("type") for error in suites.iter("error")][2] == "RBL711"


def test_a_defect_in_one_test_is_reported_and_the_others_run(tmp_path, monkeypatch):
    for name in "ab":
        (tmp_path / name).mkdir()
        copied(tmp_path / name, "", f'PRINT "{name}"\n')

    def judge(expected, session, report, log, update):
        return [] if report["printed"][0]["text"] == "b" else 1 / 0

    monkeypatch.setattr(verdict, "judge", judge)
    result = CliRunner().invoke(app, ["test", str(tmp_path), "--junit", str(tmp_path / "report.xml")])
    assert result.exit_code == 70
    assert "error RBL900" in result.stderr
    errors = [suite.get("errors") for suite in ET.parse(tmp_path / "report.xml").getroot()]
    assert errors == ["1", "0"]


def test_a_golden_log_is_written_of_a_run_that_meets_the_rest_only(tmp_path):
    program = copied(tmp_path, "golden_deg = 0.1\ncycle_s = [1, 2]")
    robolang("test", program, "--update", code=1)
    assert not program.with_name("job.golden.npz").exists()


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
        ("schema = 1\n[expct]", "RBL609", 2),
        ("schema = 1\nphysic = false", "RBL609", 2),
        ("schema = 1\n[expect]\ncycle_s = [nan, 1]", "RBL604", 3),
        ("schema = 1\n[expect]\nend_pose = [0, 0, 0, inf, 0, 0]", "RBL604", 3),
        ("schema = 1\n[expect]\ngolden_deg = -0.1", "RBL605", 3),
        ("schema = 1\n[expect]\ngolden_deg = true", "RBL613", 3),
        ('schema = 1\n[expect]\nalarms = "RBL516"', "RBL613", 3),
        ('schema = 1\n[expect]\nalarms = ["RBL999"]', "RBL610", 3),
        ('schema = 1\n[expect]\nwarnings = ["rbl523"]', "RBL610", 3),
        ("schema = 1\n[expect]\nend_deg = 1", "RBL608", 3),
        ("schema = 1\n[expect]\nend_mm = 1", "RBL608", 3),
        ("schema = 1\n[expect.parts]\npart_mm = 1", "RBL608", 3),
    ],
)
def test_a_test_file_is_refused_at_its_line(tmp_path, text, code, line):
    path = tmp_path / "a.test.toml"
    path.write_text(text + "\n", "utf-8")
    with pytest.raises(FileFault) as caught:
        load_expectation(path)
    assert (caught.value.code, caught.value.line) == (code, line)


def test_everything_that_is_wrong_with_a_test_file_is_found(tmp_path):
    path = tmp_path / "a.test.toml"
    path.write_text(
        "schema = 2\n[expect]\nalarm = []\nprinted = 1\ncycle_s = [2, 1]\n"
        "[expect.parts]\npart_ml = 3\npart = [1, nan, 2]\n",
        "utf-8",
    )
    with pytest.raises(FileFault) as caught:
        load_expectation(path)
    found = [(fault.code, fault.line) for fault in caught.value.all if isinstance(fault, FileFault)]
    assert found == [("RBL605", 1), ("RBL609", 3), ("RBL613", 4), ("RBL607", 5), ("RBL613", 7), ("RBL604", 8)]
    assert ["alarms" in fault.hint for fault in caught.value.all][1]
    assert ["'part_mm'" in fault.hint for fault in caught.value.all][4]
    (tmp_path / "a.rbl").write_text("PRINT 1\n", "utf-8")
    assert robolang("test", path, code=2).stderr.count("error RBL") == len(found)


def test_every_key_of_a_test_file_is_explained():
    explained = (ROOT / "docs" / "testing.md").read_text("utf-8")
    keys = {each.name for each in fields(Expectation)} - {"source", "parts"}
    assert {key for key in keys if f"\n{key} = " not in explained} == set()
