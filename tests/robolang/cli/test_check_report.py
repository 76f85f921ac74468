"""What ``robolang check`` reports: selection, configuration, forms, exit codes, standard input."""

import importlib.util
import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robolang.cli.main import app
from tests.campaign import some
from tests.messages import fields, heads
from tests.robolang.cli.commands import ROOT, counted, flat, places, robolang, shell
from tests.steps import HANG_S


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    for name in ("GITHUB_WORKSPACE", "CI_PROJECT_DIR", "ROBOLANG_OUTPUT_FORMAT"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.rbl").write_text("20 MOVE P9\n10 LOAD (0, 0, 60), -1\n")
    return tmp_path


def codes(*words, code=1):
    return [found for _, _, found in places(robolang("check", *words, code=code).stdout)]


def piped(text, *words, code=0):
    raw = text if isinstance(text, bytes) else text.encode()
    result = CliRunner(env={"COLUMNS": "80", "TERM": "dumb"}).invoke(app, ["check", *words], input=raw)
    assert result.exit_code == code, result.output + result.stderr
    return result


# --- selection -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ((), ["RBL301", "RBL116", "RBL401"]),
        (("--select", "RBL3"), ["RBL301"]),
        (("--select", "RBL3,RBL4"), ["RBL301", "RBL401"]),
        (("--select", "RBL3", "--select", "line-number-order"), ["RBL301", "RBL116"]),
        (("--ignore", "RBL1"), ["RBL301", "RBL401"]),
        (("--ignore", "RBL1,RBL401"), ["RBL301"]),
        (("--select", "RBL3", "--extend-select", "RBL401"), ["RBL301", "RBL401"]),
        (("--ignore", "RBL4", "--extend-select", "RBL401"), ["RBL301", "RBL116", "RBL401"]),
    ],
)
def test_findings_are_selected(words, found):
    assert codes(*words) == found


def test_the_exit_code_is_that_of_what_is_selected():
    assert codes("--select", "RBL116", code=0) == ["RBL116"]
    assert codes("--ignore", "RBL301,RBL401", code=0) == ["RBL116"]


def test_an_error_of_syntax_is_not_ignored_by_a_beginning(folder):
    (folder / "bad.rbl").write_text("MOV P1\n")
    assert codes("--ignore", "RBL1") == ["RBL112"]
    assert codes("--select", "RBL4") == ["RBL112"]
    assert codes("--ignore", "RBL112", code=0) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--select", "RBL9999"), "RBL703 --select RBL9999"),
        (("--ignore", "pont-undefined"), "RBL703 --ignore pont-undefined"),
        (("--extend-select", "RBL19x"), "RBL190 RBL191"),
        (("--output-format", "xml"), "RBL703 --output-format xml"),
        (("--statistics", "--output-format", "sarif"), "RBL703 --statistics"),
        (("--json", "--output-format", "sarif"), "RBL703 --json --output-format"),
        (("--watch", "-"), "RBL703 --watch"),
    ],
)
def test_an_option_that_cannot_be_is_a_usage_error(words, said):
    assert set(said.split()) <= fields(flat(robolang("check", *words, code=2).stderr))


def test_a_configuration_file_selects(folder):
    (folder / "robolang.toml").write_text('[lint]\nselect = ["RBL3"]\n')
    assert codes() == ["RBL301"]
    assert codes("--extend-select", "RBL4") == ["RBL301", "RBL401"]
    assert codes("--select", "RBL4") == ["RBL401"]
    assert codes("--ignore", "RBL301", code=0) == []


def test_each_program_has_the_configuration_nearest_to_it(folder):
    (folder / "pyproject.toml").write_text('[tool.robolang.lint]\nignore = ["RBL4"]\n')
    (folder / "deep").mkdir()
    (folder / "deep" / "robolang.toml").write_text('[lint]\nselect = ["RBL4"]\n')
    (folder / "deep" / "bad.rbl").write_text((folder / "bad.rbl").read_text())
    assert codes() == ["RBL301", "RBL116", "RBL401"]


def test_a_wrong_configuration_is_exit_code_2_at_its_place(folder):
    (folder / "robolang.toml").write_text('[lint]\nignor = ["RBL3"]\n')
    result = robolang("check", code=2)
    assert result.stdout == ""
    assert [Path(head).name for head in heads(result.stderr)] == ["robolang.toml:2:1: error RBL707"]
    assert {"lint.ignor", "ignore"} <= fields(result.stderr)


# --- exit codes ------------------------------------------------------------------------------------------------------


def test_infos_and_warnings_are_no_errors(folder):
    (folder / "bad.rbl").write_text("20 MOVE P1\r\n10 MOVE P2\n")
    assert codes(code=0) == ["RBL116", "RBL110"]


def test_strict_counts_warnings_but_no_infos(folder):
    (folder / "bad.rbl").write_text("20 MOVE P1\n10 MOVE P2\n")
    assert codes("--strict") == ["RBL116"]
    (folder / "bad.rbl").write_text("MOVE P1\r\nMOVE P2\n")
    assert codes("--strict", code=0) == ["RBL110"]


def test_exit_zero_covers_findings_and_nothing_else():
    assert codes("--exit-zero", code=0) == ["RBL301", "RBL116", "RBL401"]
    assert codes("--exit-zero", "none.rbl", code=2) == []


# --- forms -----------------------------------------------------------------------------------------------------------


def test_the_form_is_an_option_or_a_variable(monkeypatch):
    assert robolang("check", "--output-format", "concise", code=1).stdout.count("\n") == 3
    monkeypatch.setenv("ROBOLANG_OUTPUT_FORMAT", "json")
    assert len(json.loads(robolang("check", code=1).stdout)) == 3
    assert robolang("check", "--output-format", "concise", code=1).stdout.count("\n") == 3
    monkeypatch.setenv("ROBOLANG_OUTPUT_FORMAT", "yaml")
    assert "yaml" in fields(robolang("check", code=2).stderr)
    monkeypatch.setenv("ROBOLANG_OUTPUT_FORMAT", "")
    assert "help: " in robolang("check", code=1).stdout


@pytest.mark.parametrize("form", ["json", "json-lines", "github", "gitlab", "junit", "sarif"])
def test_forms_for_machines_hold_faults_of_files_too(form):
    result = robolang("check", "none.rbl", "--output-format", form, code=2)
    assert "RBL701" in result.stdout or "file-missing" in result.stdout
    assert "none.rbl:1:1: error RBL701" in result.stderr


def test_a_report_goes_to_a_file(folder):
    result = robolang("check", "--output-format", "junit", "--output-file", "out.xml", code=1)
    assert (result.stdout, counted(result.stderr)) == ("", 1)
    assert len(ET.parse(folder / "out.xml").findall("testsuite/testcase")) == 3


def test_a_report_that_cannot_be_written_is_exit_code_4():
    result = robolang("check", "--output-file", "none/out.txt", code=4)
    assert "RBL706" in result.stderr
    assert result.stdout == ""


def test_statistics_count(folder):
    (folder / "more.rbl").write_text("MOVE P7\n")
    assert robolang("check", "--statistics", code=1).stdout == (
        "2  RBL301  point-undefined\n1  RBL116  line-number-order\n1  RBL401  payload-not-a-mass\n"
    )
    text = robolang("check", "--statistics", "--output-format", "json", code=1).stdout
    assert robolang("check", "--statistics", "--json", code=1).stdout == text
    counts = json.loads(text)
    assert [(row["code"], row["count"]) for row in counts] == [("RBL301", 2), ("RBL116", 1), ("RBL401", 1)]


@pytest.mark.parametrize("variable", ["GITHUB_WORKSPACE", "CI_PROJECT_DIR"])
def test_a_service_names_files_from_its_checkout(variable, folder, monkeypatch):
    (folder / "deep").mkdir()
    (folder / "bad.rbl").rename(folder / "deep" / "bad.rbl")
    monkeypatch.chdir(folder / "deep")
    path = json.loads(robolang("check", "--output-format", "gitlab", code=1).stdout)[0]["location"]["path"]
    assert path == "bad.rbl"
    monkeypatch.setenv(variable, str(folder))
    path = json.loads(robolang("check", "--output-format", "gitlab", code=1).stdout)[0]["location"]["path"]
    assert path == "deep/bad.rbl"
    monkeypatch.setenv(variable, "/somewhere/else")
    path = json.loads(robolang("check", "--output-format", "gitlab", code=1).stdout)[0]["location"]["path"]
    assert path == "bad.rbl"


# --- standard input --------------------------------------------------------------------------------------------------


def test_a_program_comes_from_the_standard_input():
    assert piped("MOVE P1\n", "-").stdout == ""
    assert piped("MOVE P9\n", "-", code=1).stdout.startswith("<stdin>:1:6: error RBL301 ")


def test_its_name_leads_to_its_points_and_its_configuration(folder):
    (folder / "deep").mkdir()
    (folder / "deep" / "pick.points.toml").write_text("schema = 1\n[points.Q]\npose = [1, 2, 3, 4, 5, 6]\n")
    (folder / "deep" / "robolang.toml").write_text('[lint]\nignore = ["RBL116"]\n')
    result = piped("20 MOVE Q\n10 MOVE P1\n", "-", "--stdin-filename", "deep/pick.rbl", code=1)
    assert places(result.stdout) == [(2, 9, "RBL301")]
    assert result.stdout.startswith("deep/pick.rbl:2:9: ")


def test_it_is_read_like_a_file():
    assert piped(b"\xef\xbb\xbfMOVE P1\r\n", "-").stdout == ""
    assert "<stdin>:1:6: error RBL104" in piped(b"MOVE \xff", "-", code=1).stderr
    assert "<stdin>:1:1: error RBL106" in piped(b"'" * 1_000_001, "-", code=1).stderr


def test_files_may_stand_beside_it():
    result = piped("MOV P1\n", "bad.rbl", "-", "bad.rbl", "-", code=1)
    assert [found for *_, found in places(result.stdout)] == ["RBL301", "RBL116", "RBL401", "RBL112"]


def test_a_pipe_of_the_shell_is_read(folder):
    result = shell("check", "-", "--output-format", "concise", cwd=folder, input="MOVE P9\n")
    assert result.returncode == 1
    assert heads(result.stdout) == ["<stdin>:1:6: error RBL301"]
    assert result.stdout.count("\n") == 1


def test_a_reader_that_leaves_changes_no_exit_code(folder):
    (folder / "bad.rbl").write_text("MOVE P9\n" * 900)
    read, write = os.pipe()
    os.close(read)
    result = shell("check", cwd=folder, capture_output=False, stdout=write, stderr=-3)
    os.close(write)
    assert result.returncode == 1


# --- the short way into it -------------------------------------------------------------------------------------------


def python(code, *words, cwd):
    """Run a line of Python as a process."""
    return subprocess.run(
        [sys.executable, "-c", f"import sys; {code}", *words],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=HANG_S,
        env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80"},
    )


@pytest.mark.parametrize(
    "words", some([("--help",), ("--no-such-option",), ("--output-format", "x"), ("bad.rbl",), ()], 0, 1, 3)
)
def test_the_short_way_into_it_is_the_same_command(words, folder):
    code = "sys.argv[0] = 'robolang'; from robolang.cli import quick, main; {}"
    calls = ("quick.run_app(quick.check())", "main.run_app()")
    short, whole = (python(code.format(call), "check", *words, cwd=folder) for call in calls)
    assert short.returncode == whole.returncode
    assert (short.stdout, short.stderr) == (whole.stdout, whole.stderr)
    assert short.stdout + short.stderr


def test_a_program_without_errors_is_checked_without_what_is_slow_to_import(folder):
    (folder / "good.rbl").write_text("10 PRINT 1\n")
    code = "import atexit; atexit.register(lambda: print('loaded', sorted(sys.modules)))"
    done = python(f"{code}; from robolang.__main__ import main; main()", "check", "good.rbl", cwd=folder)
    assert done.returncode == 0
    for name in ("dataclasses", "importlib.resources", "zipfile", "difflib", "lark", "typer"):
        assert f"'{name}'" not in done.stdout
    assert "'robolang.cli.check_job'" in done.stdout


def test_other_commands_are_not_imported(folder):
    code = "import atexit; atexit.register(lambda: print(sorted(sys.modules), file=sys.stderr))"
    done = python(f"{code}; from robolang.__main__ import main; main()", "check", "bad.rbl", cwd=folder)
    assert done.returncode == 1
    assert "'robolang.cli.check_job'" in done.stderr
    for name in (
        "cli.main",
        "cli.commands.run",
        "cli.commands.identify",
        "lint.rules.text",
        "lint.reporters.sarif",
        "core.storage",
    ):
        assert importlib.util.find_spec(f"robolang.{name}")
        assert f"'robolang.{name}'" not in done.stderr
    for name in ("rich", "numpy"):
        assert f"'{name}'" not in done.stderr


# --- points that nothing names ---------------------------------------------------------------------------------------


POINTS = """schema = 1
[points.P1]
pose = [450, -150, 200, 180, 0, 90]
[points.Old]
joints = [0, 45, -180, 0, 45, 0]
"""


def test_a_point_that_the_program_does_not_name_is_found_in_the_points_file(folder):
    (folder / "bad.rbl").write_text("MOVE P1\n")
    (folder / "bad.points.toml").write_text(POINTS)
    said = robolang("check").stdout
    assert heads(said) == ["bad.points.toml:4:1: warning RBL224"]
    assert "Old" in said
    assert codes("--strict") == ["RBL224"]
    assert codes("--ignore", "RBL224", code=0) == []
    (item,) = json.loads(robolang("check", "--output-format", "json").stdout)
    assert (item["file"], item["line"], item["code"]) == ("bad.points.toml", 4, "RBL224")


def test_points_are_not_counted_while_the_program_cannot_be_read_whole(folder):
    (folder / "bad.rbl").write_text("MOVE P1\nMOV OLD\n")
    (folder / "bad.points.toml").write_text(POINTS)
    assert codes() == ["RBL112"]
