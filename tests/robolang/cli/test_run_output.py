"""What ``robolang run`` prints: the table at 80 columns, progress on a terminal and elsewhere, and odd streams."""

import json
import os
import pty
import re
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from robolang.cli import run_table
from robolang.cli.main import app
from robolang.execution.speed_keys import NO_SPEED
from robolang.logs.files import read_log
from tests.campaign import some
from tests.messages import fields, heads
from tests.robolang.cli.commands import ROOT, dry, flat, robolang, shell
from tests.steps import HANG_S

LONG = "100 MOVE P1, SPEED 123.456789, ACCEL 12.345678901"


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "p.rbl"
    path.write_text("10 HAND ON\n20 LOAD (0, 0, 60), 0.8\n30 MOVE P5\n")
    return path


def test_progress_goes_to_stderr_and_the_table_to_stdout(program):
    result = dry("p.rbl")
    assert [line.split(None, 2)[2] for line in result.stderr.splitlines()[:3]] == [
        "line 1 (number 10) HAND ON",
        "line 2 (number 20) LOAD (0, 0, 60), 0.8",
        "line 3 (number 30) MOVE P5",
    ]
    rows = [line.split()[:2] for line in result.stdout.splitlines() if re.match(r" +\d+ ", line)]
    assert rows == [["1", "10"], ["2", "20"], ["3", "30"]]
    assert fields(result.stdout.splitlines()[0]) == {"p.rbl", "puma560"}
    assert [line for line in result.stdout.splitlines() if line.startswith("  line 1 (number 10): ")]


@pytest.mark.physics
def test_quiet_prints_nothing(program):
    for words in ([], ["--report", "r.json", "--log", "l.npz"]):
        result = robolang("run", "p.rbl", "--quiet", *words)
        assert (result.stdout, result.stderr) == ("", "")


def test_quiet_still_prints_errors(program):
    program.write_text("MOVE P9\n")
    assert "RBL301" in dry("p.rbl", "--quiet", code=1).stderr


def report(**changes):
    statement = {
        "line": 99_999,
        "number": None,
        "text": LONG[4:],
        "begun": True,
        "start_s": 3599.123,
        "duration_s": 3600.123,
        **NO_SPEED,
        "joint_error_deg": 123.4567,
        "tool_error_mm": 12.3456,
        "path_deviation_mm": 12.3456,
        "peak_torque_pct": 100.0,
        "notes": [],
    }
    return {
        "program": "p.rbl",
        "robot": "puma560",
        "robot_estimated": [],
        "sim_time_s": 0.0,
        "wall_time_s": 0.0,
        "realtime_factor": 0.0,
        "cycles": 0,
        "overruns": 0,
        "dynamics": {},
        "objects": {},
        "statements": [statement | changes] * 2,
    }


@pytest.mark.parametrize("width", [60, 80, 100, 200])
def test_only_a_statement_is_ever_cut(width, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", str(width))
    run_table.print_result(report(), every=True)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= max(width, 74)
    if width >= 80:
        row = next(line for line in lines if "99999" in line)
        numbers = row.split("P1", 1)[1].split("…")[-1].split()
        assert numbers[-6:] == ["3599.123", "3600.123", "123.4567", "12.346", "12.346", "100"]
        assert row.count("…") == 1
        assert " 99999  MOVE P1, SP" in row
        heading = " ".join(lines[1:6])
        assert all(word in heading for word in ("statement", "start", "torque", "path", "deg", "mm", "%"))


def test_a_short_statement_is_not_cut_and_a_wide_terminal_shows_more(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    run_table.print_result(report(text="MOVE P1, SPEED 100", start_s=0.0, duration_s=1.0), every=True)
    assert "…" not in capsys.readouterr().out
    monkeypatch.setenv("COLUMNS", "120")
    run_table.print_result(report(text=LONG[4 : 4 + 40]), every=True)
    assert "…" not in capsys.readouterr().out


def test_speeds_have_columns_where_there_is_room_and_notes_where_a_limit_is_news(monkeypatch, capsys):
    slow = {"programmed_mm_s": 200.0, "reached_mm_s": 83.4, "limited_by": "J5 speed", "limited_why": "J5 takes 99 %"}

    def shown(width, **changes):
        monkeypatch.setenv("COLUMNS", str(width))
        run_table.print_result(report(text="MOVE P1", **changes), every=True)
        return capsys.readouterr().out

    wide = shown(120, **slow)
    assert {"83/200", "J5", "limited"} <= set(wide.split())
    assert slow["limited_why"] not in wide
    narrow = shown(80, **slow)
    assert "limited" not in narrow
    assert narrow.count(slow["limited_why"]) == 1
    assert "(83/200 mm/s" in narrow
    # most short moves do not reach their speed
    assert slow["limited_why"] not in shown(80, **(slow | {"limited_by": "length"}))
    kept = shown(120, programmed_pct=30.0, reached_pct=29.7)
    assert " 30 % " in kept
    assert "limited" not in kept


LOOP = "FOR k = 1 TO 3\nMOVEJ HERE + (0, 0, 10 * k)\nMOVEJ HERE + (0, 0, -10 * k)\nNEXT k\nMOVEJ HERE + (0, 0, 5)\n"


def table_rows(text):
    """The rows of a table as their fields, without the statement."""
    return [re.split(r"  +", line.strip()) for line in text.splitlines() if re.match(r" +\d+ +MOVEJ", line)]


def statements(report_of, line):
    return [each for each in report_of["statements"] if each["line"] == line]


def test_a_line_that_ran_several_times_has_one_row_with_its_first_start_its_sum_and_its_largest_errors(program):
    program.write_text(LOOP)
    rows = {int(row[0]): row for row in table_rows(dry("p.rbl", "--report", "r.json").stdout)}
    found = json.loads((program.parent / "r.json").read_text())
    assert sorted(rows) == [2, 3, 5]
    for line, row in rows.items():
        runs = statements(found, line)
        times, start, spent, joint, tool = map(float, row[2:7])
        assert times == len(runs) == (1 if line == 5 else 3)
        assert start == pytest.approx(runs[0]["start_s"], abs=1e-3)
        assert spent == pytest.approx(sum(each["duration_s"] for each in runs), abs=2e-3)
        assert joint == pytest.approx(max(each["joint_error_deg"] for each in runs), abs=1e-4)
        assert tool == pytest.approx(max(each["tool_error_mm"] for each in runs), abs=1e-3)


def test_all_prints_each_statement_and_worst_the_largest_tool_error_first(program):
    program.write_text(LOOP)
    assert [int(row[0]) for row in table_rows(dry("p.rbl", "--all").stdout)] == [2, 3, 2, 3, 2, 3, 5]
    errors = [float(row[6]) for row in table_rows(dry("p.rbl", "--worst").stdout)]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > errors[-1]


def test_the_report_is_printed_in_place_of_the_table(program):
    printed = json.loads(dry("p.rbl", "--json", "--report", "r.json").stdout)
    assert printed == json.loads((program.parent / "r.json").read_text())


def test_a_program_comes_from_the_standard_input(program):
    text = "10 MOVEJ P1\n20 PRINT 5\n"
    runner = CliRunner(env={"COLUMNS": "80"})
    found = runner.invoke(app, ["run", "-", "--no-physics", "--json", "--quiet"], input=text)
    assert found.exit_code == 0
    made = json.loads(found.stdout)
    assert [each["number"] for each in made["statements"]] == [10, 20]
    wrong = runner.invoke(app, ["run", "-", "--no-physics"], input="MOVV P1\n")
    assert (wrong.exit_code, heads(wrong.stderr)) == (1, ["<stdin>:1:1: error RBL112"])


def last_word(text):
    return text.split()[-1]


def test_the_last_word_is_how_it_came_out(program):
    assert last_word(dry("p.rbl").stdout) == "OK"
    program.write_text("MOVE P1 + (5000, 0, 0)\n")
    assert last_word(dry("p.rbl", code=3).stderr) == "FAILED"
    program.write_text("MOVE P1\nx = 1 / INT(DIST(HERE, HERE))\n")
    assert last_word(dry("p.rbl", code=3).stdout) == "FAILED"
    # a warning is none of the two, unless it is an error by request
    program.write_text("' nothing to do\n")
    assert last_word(dry("p.rbl").stdout) == "OK"
    assert last_word(dry("p.rbl", "--strict", code=1).stdout) == "FAILED"


def test_a_run_ends_before_a_line(program):
    program.write_text("10 MOVEJ P1\n20 *THERE\n30 MOVEJ P5\n40 END\n")
    for line in ("30", "20", "*THERE", "there"):
        result = dry("p.rbl", "--until-line", line, "--report", "r.json")
        found = json.loads((program.parent / "r.json").read_text())
        assert [each["number"] for each in found["statements"]] == [10]
        assert last_word(result.stdout) == "OK"
    whole = dry("p.rbl", "--until-line", "40", "--report", "r.json").stdout
    assert [each["number"] for each in json.loads((program.parent / "r.json").read_text())["statements"]][:2] == [
        10,
        30,
    ]
    assert "30" in fields(whole)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--until-line", "31"], "RBL803"),
        (["--until-line", "30", "--view"], "RBL703"),
    ],
)
def test_a_line_that_is_none_and_a_page_that_pauses_are_refused(program, words, code):
    assert code in dry("p.rbl", *words, code=2).stderr


@pytest.mark.parametrize("words", [["--port", "0"], ["--no-browser"]])
def test_an_option_of_a_page_that_is_not_there_is_refused(program, words):
    result = dry("p.rbl", *words, code=2)
    assert {"RBL703", words[0], "--view"} <= fields(flat(result.stderr))
    assert result.stdout == ""


def test_a_run_of_nothing_has_no_column_of_axes_that_slide():
    shown = robolang("run", "-", "--no-physics", typed="").stdout
    assert "joint" in shown
    assert "slide" not in shown


def test_what_a_program_prints_is_not_in_the_json(program):
    program.write_text('PRINT "hello"\nDELAY 0.1\n')
    for words in ([], ["--quiet"]):
        result = dry("p.rbl", "--json", *words)
        assert json.loads(result.stdout)["printed"][0]["text"] == "hello"
        assert "hello\n" in result.stderr
    assert "hello\n" in dry("p.rbl").stdout


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf", "x"])
def test_a_time_that_is_none_is_refused(program, seconds):
    assert "RBL703" in dry("p.rbl", "--max-time", seconds, code=2).stderr


def test_a_run_has_at_most_its_time(program, monkeypatch):
    monkeypatch.setattr("robolang.execution.run_bounds.MAX_RUN_US", 400_000)
    program.write_text("DELAY 0.5\n")
    assert "RBL509" in dry("p.rbl", code=3).stderr
    assert last_word(dry("p.rbl", "--max-time", "0.6").stdout) == "OK"


@pytest.mark.parametrize("text", ["10 MOVE P1\n20 MOVE P5\n", "WHILE TRUE\nDELAY 0.2\nWEND\n"])
def test_a_run_with_a_time_ends_then_and_is_recorded(program, text):
    program.write_text(text.replace("TRUE", "1 = 1"))
    ran = dry("p.rbl", "--max-time", "0.3", "--log", "p.npz", "--report", "p.json", code=3)
    assert "RBL509" in ran.stderr
    assert last_word(ran.stdout) == "FAILED"
    report = json.loads((program.parent / "p.json").read_text())
    assert [alarm["code"] for alarm in report["alarms"]] == ["RBL509"]
    log = read_log(program.parent / "p.npz")
    # it ends on the path, so the last cycles come after that time
    assert report["sim_time_s"] >= 0.3
    assert log["t"][-1] + 0.001 == pytest.approx(report["sim_time_s"])


def test_words_of_other_people_are_printed_and_not_obeyed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = "[red]x[bold] :smile: \x1b[2J.rbl"
    (tmp_path / name).write_text("MOVE P1\n")
    result = dry(name)
    assert "[red]x[bold] :smile: \ufffd[2J.rbl" in result.stdout
    assert "\x1b" not in result.stdout + result.stderr


def test_an_alarm_is_located_at_its_statement(program, monkeypatch):
    from robolang.execution.session import Session

    run = Session.run

    def stopped(self):
        self.request_stop()
        return run(self)

    monkeypatch.setattr(Session, "run", stopped)
    result = dry("p.rbl", "--report", "r.json", code=3)
    assert heads(result.stderr) == ["p.rbl:1:4: error RBL530"]
    assert "0.000 s" in result.stderr
    assert "\n   1 | 10 HAND ON" in result.stderr
    assert '"code": "RBL530"' in (program.parent / "r.json").read_text()


def read_terminal(master):
    """Return what was written to a terminal until its writer has gone."""
    text = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # EIO: the other end is closed
            part = b""
        if not part:
            return text.decode()
        text += part


def test_on_a_terminal_progress_is_painted_in_place(program):
    program.write_text("10 MOVE P1\n20 MOVE P5\n")
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "robolang", "run", "--no-physics", "--realtime", "p.rbl"],
        stdout=subprocess.PIPE,
        stderr=slave,
        text=True,
        cwd=program.parent,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm", "COLUMNS": "80"},
    )
    os.close(slave)
    shown = read_terminal(master)
    os.close(master)
    table, _ = process.communicate(timeout=HANG_S)
    assert process.returncode == 0
    assert re.search(r"^ +2 +20 +MOVE P5 ", table, re.M)
    plain = re.sub(r"\x1b\[[0-9;]*m", "", shown)
    assert "line 1 (number 10)  MOVE P1" in plain
    assert "line 2 (number 20)  MOVE P5" in plain
    assert "\x1b[2K" in shown or "\x1b[K" in shown
    assert shown.rstrip().endswith("\x1b[?25h") or "\x1b[?25h" in shown  # the cursor is given back


def test_a_reader_that_leaves_changes_nothing(program):
    """``robolang run ... | true``: no trace, the exit code of the run, the files written."""
    commands = (
        (["run", "--no-physics", "p.rbl", "--report", "r.json"], 0),
        (["explain"], 0),
        (["robot", "show", "puma560"], 0),
        (["robot", "list"], 0),
        (["check", "bad.rbl"], 1),
    )
    for words, code in some(commands, 0, 1, 4):
        (program.parent / "bad.rbl").write_text("MOV P1\n")
        reading, writing = os.pipe()
        os.close(reading)
        result = shell(*words, cwd=program.parent, capture_output=False, stdout=writing, stderr=subprocess.PIPE)
        os.close(writing)
        assert result.returncode == code, words
        assert "Error" not in result.stderr, words
        assert "error" not in result.stderr, words
    assert (program.parent / "r.json").exists()


def test_a_standard_output_that_is_full_is_a_storage_fault(program):
    with open("/dev/full", "w") as full:  # noqa: PTH123
        result = shell(
            "run",
            "--no-physics",
            "p.rbl",
            cwd=program.parent,
            capture_output=False,
            stdout=full,
            stderr=subprocess.PIPE,
        )
    assert result.returncode == 4
    assert "RBL706" in fields(result.stderr)
    assert "Exception ignored" not in result.stderr


def test_closed_streams_and_a_plain_encoding_do_not_stop_a_run(program):
    run = (
        "import os, sys; os.closerange({}, {}); "
        "os.execv(sys.executable, [sys.executable, '-m', 'robolang', *sys.argv[1:]])"
    )
    for first, last in some(((1, 2), (2, 3), (1, 3)), 2):
        words = [sys.executable, "-c", run.format(first, last), "run", "--no-physics", "p.rbl", "--report", "r.json"]
        env = {**os.environ, "PYTHONPATH": str(ROOT)}
        assert subprocess.run(words, cwd=program.parent, env=env, timeout=HANG_S).returncode == 0
        (program.parent / "r.json").unlink()
    program.write_text("MOVE P9 ' \u03a9\n", encoding="utf-8")
    result = shell("check", "p.rbl", cwd=program.parent, env={"PYTHONIOENCODING": "latin-1"})
    assert result.returncode == 1
    assert "\\u03a9" in result.stdout


def test_the_same_table_comes_out_whatever_the_wall_clock_does(program):
    first, second = (re.sub(r"in [\d.]+ s \([\d.]+ x", "", dry("p.rbl").stdout) for _ in range(2))
    assert first == second


def test_python_m_robolang_and_a_program_named_like_an_option(program):
    (program.parent / "-x.rbl").write_text("LOAD (0, 0, 60), 0.8\n")
    result = shell("run", "--no-physics", "--", "-x.rbl", cwd=program.parent)
    assert result.returncode == 0, result.stderr
    assert {"-x.rbl", "puma560"} <= fields(result.stdout)
    robolang("run", "--no-physics", "--quiet", "--", "-x.rbl")
