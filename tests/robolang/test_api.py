"""What ``import robolang`` offers, and the examples of the page about it."""

import ast
import json
import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import robolang
from robolang import api
from robolang.execution.run_report import report_of
from robolang.execution.speed_keys import KEYS
from tests.programs.runs import ROOT
from tests.robolang.cli.commands import robolang as robolang_command

PAGE = ROOT.parent / "docs" / "python.md"
TYPED = ROOT.parent / "tests" / "robolang" / "page_examples.py"
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


def test_the_package_offers_what_its_api_does():
    assert set(robolang.__all__) == {*api.__all__, "__version__"}
    assert all(getattr(robolang, name) is getattr(api, name) for name in api.__all__)
    assert set(robolang.__all__) <= set(dir(robolang))  # a prompt completes them
    with pytest.raises(AttributeError):
        _ = robolang.nothing_of_this_name


def test_nothing_is_imported_before_a_name_is_used():
    code = "import sys; before = set(sys.modules); import robolang; print(sorted(set(sys.modules) - before))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown == "['robolang']\n"


@pytest.mark.physics
@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_the_examples_of_the_page_do_what_they_say(monkeypatch, number):
    monkeypatch.chdir(ROOT.parent)
    exec(compile(EXAMPLES[number], f"{PAGE.name}, example {number + 1}", "exec"), {})


def test_the_page_has_examples():
    assert len(EXAMPLES) == 8


def typed():
    """The examples as the type checker reads them: each in a function of its own."""
    functions = [f"def example_{k}() -> None:\n{textwrap.indent(text, '    ')}" for k, text in enumerate(EXAMPLES, 1)]
    return "\n\n".join(
        [f'"""The examples of docs/{PAGE.name}, for the type checker; written by this test."""', *functions]
    )


def test_the_type_checker_reads_the_examples_of_the_page():
    # compared as trees: the formatter has laid the file out
    assert ast.dump(ast.parse(TYPED.read_text("utf-8"))) == ast.dump(ast.parse(typed()))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


POINTS = {"A": (480, -220, 640, 180, 0, 180), "B": (480, 0, 840, 180, 0, -135)}


def test_a_project_of_texts_is_that_of_files(folder):
    text = "10 MOVE A\n20 MOVE B\n"
    (folder / "p.rbl").write_text(text)
    lines = [f"[points.{name}]\npose = {list(pose)}\n" for name, pose in POINTS.items()]
    (folder / "p.points.toml").write_text("schema = 1\n" + "".join(lines))
    of_text = robolang.run(robolang.Project.from_text(text, points=POINTS), physics=False)
    of_files = robolang.run("p.rbl", physics=False)
    assert np.array_equal(of_text.log["q_cmd"], of_files.log["q_cmd"])
    assert of_text.report.statements == of_files.report.statements


def test_a_project_of_texts_takes_nothing_of_the_folder(folder):
    (folder / "program.points.toml").write_text("broken")
    (folder / "program.cell.toml").write_text("broken")
    (folder / "cell.toml").write_text("broken")
    assert robolang.plan(robolang.Project.from_text("MOVE P1\n")).ok
    assert not robolang.Project.from_text("MOVE P1\n", points={}).ok


def test_the_text_of_a_cell_is_that_of_its_file(folder):
    cell = (ROOT / "shop" / "cell.toml").read_text("utf-8")
    assert robolang.Project.from_text("HAND ON\n", cell=cell).cell.robot.name == "puma560"
    with pytest.raises(robolang.FileFault, match="RBL60"):
        robolang.Project.from_text("HAND ON\n", cell="schema")


def test_options_of_the_command_are_arguments(folder):
    text = "10 MOVE P1\n20 MOVE P5\n30 DELAY 1\n"
    (folder / "p.rbl").write_text(text)
    fixed = robolang.run("p.rbl", physics=False, servo="fixed")
    by_key = robolang.run("p.rbl", physics=False, settings={"servo.mode": "fixed"})
    assert fixed.report["servo"] == by_key.report["servo"] == "fixed"
    with pytest.raises(robolang.Fault, match=r"RBL709.*irb2400"):
        robolang.run("p.rbl", physics=False, robot="irb2400")
    short = robolang.run("p.rbl", physics=False, until_line=20)
    assert [each.number for each in short.report.statements] == [10]
    assert not short.log["line"][-1] > 1
    cut = robolang.run("p.rbl", physics=False, max_time_s=0.5)
    assert not cut.ok
    assert [item.code for item in cut.alarms] == ["RBL509"]
    assert cut.report.sim_time_s >= 0.5
    assert [item.code for item in robolang.plan("p.rbl", max_time_s=0.5).refused] == ["RBL509"]


def refusals():
    program = robolang.Project.from_text("MOVE P1\n")
    return {
        "settings": lambda: robolang.plan("programs/pick_and_place.rbl", settings={"servo.mode": "x"}),
        "servo": lambda: robolang.run(program, servo="fixed"),
        "max_time_s": lambda: robolang.run(program, max_time_s=math.nan),
        "joints": lambda: robolang.forward("puma560", [0.0, 0.0]),
        "tool": lambda: robolang.inverse("puma560", [0] * 6, tool=[math.inf] * 6),
        "pose": lambda: robolang.inverse("puma560", [math.nan] * 6),
        "payload": lambda: robolang.step("puma560", 1, payload=(-1.0,)),
        "load": lambda: robolang.step("puma560", 1, load=(1.0, 2.0)),
        "axis": lambda: robolang.step("puma560", 7),
        "axes": lambda: robolang.identify("puma560", axes=[0]),
        "only": lambda: robolang.compare("programs/pick_and_place.rbl", only=["x"]),
        "points": lambda: robolang.Project.from_text("MOVE P1\n", points={"A b": (0,) * 6}),
        "select": lambda: robolang.check(select=["RBL9x"]),
        "physics": lambda: robolang.run(program, physics="no"),
        "realtime": lambda: robolang.run(program, realtime=1),
        "cell": lambda: robolang.Project.from_text("MOVE P1\n", cell="cell.toml"),
        "text": lambda: robolang.Project.from_text(5),
        "program": lambda: robolang.run(5),
        "plant": lambda: robolang.identify("puma560", plant="steel"),
        "positions": lambda: robolang.identify("puma560", positions=1.5),
        "size_deg": lambda: robolang.step("puma560", 1, size_deg="a"),
        "path": lambda: robolang.read_log(5),
    }


@pytest.mark.parametrize("argument", refusals())
def test_a_wrong_argument_is_named_and_no_option(monkeypatch, argument):
    monkeypatch.chdir(ROOT.parent)
    with pytest.raises(robolang.Fault) as caught:
        refusals()[argument]()
    assert caught.value.code in ("RBL703", "RBL610")
    assert caught.value.message.startswith(argument)
    assert "--" not in str(caught.value)


WORDS: Any = ["a"] * 6
FORWARD: Any = robolang.forward
PROGRAM = "programs/pick_and_place.rbl"
WRONG_KINDS: dict[str, Any] = {
    "joints": lambda: robolang.forward("puma560", WORDS),
    "max_time_s": lambda: robolang.run(PROGRAM, max_time_s="a"),
    "pose": lambda: robolang.inverse("puma560", None),
    "points": lambda: robolang.Project.from_text("MOVE P1\n", points=5),
    "axis": lambda: robolang.step("puma560", "J7"),
    "settings": lambda: robolang.plan(PROGRAM, settings=["servo.mode"]),
    "robot": lambda: robolang.forward(np.zeros(6), np.zeros(6)),
    "payload": lambda: robolang.step("puma560", 1, payload="5"),
}


@pytest.mark.parametrize("argument", WRONG_KINDS)
def test_an_argument_of_another_kind_is_refused(monkeypatch, argument):
    monkeypatch.chdir(ROOT.parent)
    with pytest.raises(robolang.Fault) as caught:
        WRONG_KINDS[argument]()
    assert (caught.value.code, caught.value.message.partition(":")[0]) == ("RBL703", argument)
    assert "--" not in caught.value.hint


MISSPELT = {
    "run": ("phsyics", "physics", lambda **given: robolang.run(PROGRAM, **given)),
    "plan": ("max_time", "max_time_s", lambda **given: robolang.plan(PROGRAM, **given)),
    "compare": ("phisics", "physics", lambda **given: robolang.compare(PROGRAM, **given)),
    "identify": ("position", "positions", lambda **given: robolang.identify("puma560", **given)),
    "weigh": ("robt", "robot", lambda **given: robolang.weigh(PROGRAM, **given)),
    "step": ("sizedeg", "size_deg", lambda **given: robolang.step("puma560", 1, **given)),
    "load": ("robt", "robot", lambda **given: robolang.Project.load(PROGRAM, **given)),
    "from_text": ("pionts", "points", lambda **given: robolang.Project.from_text("MOVE P1\n", **given)),
    "check": ("ignored", "ignore", lambda **given: robolang.check(PROGRAM, **given)),
    "check_text": ("nam", "name", lambda **given: robolang.check_text("MOVE P1\n", **given)),
    "forward": ("tol", "tool", lambda **given: robolang.forward("puma560", [0] * 6, **given)),
    "inverse": ("tol", "tool", lambda **given: robolang.inverse("puma560", [0] * 6, **given)),
    "read_log": ("pth", "path", lambda **given: robolang.read_log(**given)),
}


@pytest.mark.parametrize("function", MISSPELT)
def test_an_argument_that_is_misspelt_is_refused_with_the_nearest_one(monkeypatch, function):
    monkeypatch.chdir(ROOT.parent)
    word, nearest, call = MISSPELT[function]
    with pytest.raises(robolang.Fault) as caught:
        call(**{word: None})
    assert caught.value.code == "RBL703"
    assert caught.value.message.startswith(f"{word}: {function} ")
    assert nearest in caught.value.hint


def test_an_argument_that_is_missing_or_too_many_is_refused():
    for given in (("puma560",), ("puma560", [0] * 6, [0] * 6)):
        with pytest.raises(robolang.Fault, match="RBL703") as caught:
            FORWARD(*given)
        assert caught.value.message.startswith("forward: ")


def test_numbers_of_numpy_and_paths_are_arguments_too(monkeypatch):
    monkeypatch.chdir(ROOT.parent)
    plain = robolang.step("puma560", 2, payload=(2.5,), seconds=0.5)
    other = robolang.step("puma560", "J2", payload=2.5, seconds=np.float64(0.5), ideal_drives=np.False_)
    assert (plain.inertia, plain.peak_torque) == (other.inertia, other.peak_torque)
    assert robolang.forward("puma560", np.zeros(6)) == robolang.forward("puma560", [0] * 6)
    assert robolang.plan(ROOT / "pick_and_place.rbl", robot=Path("puma560")).ok


def test_a_program_that_is_not_there_is_refused(folder):
    for call in (robolang.check, robolang.weigh, robolang.plan):
        with pytest.raises(robolang.FileFault, match="RBL701"):
            call("nix")


def test_a_signal_that_is_none_is_refused_with_those_that_are(ran):
    for log in (ran.log, ran.log.at_line(60)):
        with pytest.raises(KeyError, match=r"nix.*q_cmd"):
            log["nix"]


def test_kinematics_lead_back(folder):
    joints = [10.0, 45.0, -170.0, 20.0, 45.0, 30.0]
    tool = (10.0, 20.0, 100.0, 10.0, 0.0, 30.0)
    pose = robolang.forward("puma560", joints, tool=tool)
    found = robolang.inverse("puma560", pose, tool=tool)
    assert min(max(abs(a - b) for a, b in zip(each.joints, joints, strict=True)) for each in found) < 1e-6
    assert [each.margin_deg for each in found] == sorted((each.margin_deg for each in found), reverse=True)
    assert robolang.inverse("puma560", (5000, 0, 0, 0, 0, 0)) == []


STEP = ("--size", "0.4", "--seconds", "0.5", "--json")


def printed(*words):
    return json.loads(robolang_command(*words).stdout)


def test_experiments_give_what_their_commands_print(monkeypatch):
    monkeypatch.chdir(ROOT.parent)
    response = robolang.step("puma560", 2, payload=(2.5, 0, 0, 100), size_deg=0.4, seconds=0.5)
    shown = printed("step", "--robot", "puma560", "--axis", "2", "--payload", "2.5,0,0,100", *STEP)
    assert (response.inertia, response.peak_torque) == (shown["inertia_kg_m2"], shown["peak_torque_nm"])
    assert np.rad2deg(response.droop) == pytest.approx(shown["droop_deg"], rel=1e-12)
    program = "programs/pick_and_place.rbl"
    rows = robolang.compare(program, only=["scheduled", "fixed-mid"], physics=False)
    assert rows == printed("compare", program, "--only", "scheduled,fixed-mid", "--no-physics", "--json")["variants"]
    found = robolang.weigh(program, payload=(1.5, 30, -20, 113.7), plant="rigid").found
    weighed = printed("weigh", program, "--payload", "1.5,30,-20,113.7", "--plant", "rigid", "--json")
    assert found.mass == weighed["estimated"]["mass_kg"]
    (axis,) = robolang.identify("puma560", axes=[6], positions=1, plant="rigid")
    (row,) = printed(*["identify", "puma560", "--axis", "6", "--positions", "1", "--plant", "rigid", "--json"])["axes"]
    assert axis.identified == row["identified_kg_m2"]


def test_check_says_of_each_file_what_is_found(folder):
    (folder / "a.rbl").write_text("MOVE P1\n")
    (folder / "b.rbl").write_text("MOVV P1\nMOVE P9\n")
    (folder / "c.rbl").write_bytes(b"MOVE \xff\n")
    found = robolang.check()
    assert [each.source.path for each in found] == ["a.rbl", "b.rbl", "c.rbl"]
    assert [[item.code for item in each.diagnostics] for each in found] == [[], ["RBL112", "RBL301"], []]
    assert [fault.code for fault in found[2].faults] == ["RBL104"]
    assert [item.code for item in robolang.check("b.rbl", ignore=["RBL301"])[0].diagnostics] == ["RBL112"]


@pytest.fixture(scope="module")
def ran():
    return robolang.run(ROOT / "pick_and_place.rbl", physics=False)


def test_a_report_has_attributes_for_its_keys(ran):
    report = ran.report
    assert json.loads(json.dumps(report)) == report
    for name in ("program", "robot", "ok", "physics", "sim_time_s", "wall_time_s", "printed", "objects", "alarms"):
        assert getattr(report, name) == report[name]
        assert getattr(type(report), name).__doc__
    for each in report.statements:
        names = ("line", "number", "text", "begun", "start_s", "duration_s", "planned_s", "tool_error_mm", "notes")
        for name in (*names, *KEYS):
            assert getattr(each, name) == each[name]
    with pytest.raises(AttributeError):
        report.ok = False
    assert report.tool_error_mm == max(each.tool_error_mm for each in report.statements if each.tool_error_mm)
    assert [each.text for each in report.at_line(60)] == ["MOVE P2"]
    assert len(repr(report).splitlines()) == 1
    assert "MOVE P2" in report._repr_html_()


def test_a_report_without_motion_has_no_largest_error():
    report = robolang.run(robolang.Project.from_text("x = 1\n"), physics=False).report
    assert math.isnan(report.tool_error_mm)
    assert math.isnan(report.peak_torque_pct)


def test_an_error_that_is_no_number_is_no_small_one(ran):
    broken = report_of(json.loads(json.dumps(ran.report)))
    broken.statements[2]["tool_error_mm"] = math.nan
    assert math.isnan(broken.tool_error_mm)


def test_texts_of_programs_are_shown_and_not_obeyed_in_a_notebook():
    project = robolang.Project.from_text('PRINT "<script>1</script>"\n', name="<b>.rbl")
    shown = robolang.run(project, physics=False).report._repr_html_()
    assert "<script>" not in shown
    assert "<b>.rbl" not in shown


def test_the_ticks_of_a_line_are_those_in_which_it_ran(ran):
    (statement,) = ran.report.at_line(60)
    part = ran.log.at_line(60)
    first = round(statement.start_s * 1000)
    assert np.array_equal(part.ticks, np.arange(first, first + round(statement.duration_s * 1000)))
    assert part.tool_error_mm.max() == pytest.approx(statement.tool_error_mm)
    assert np.abs(part.joint_error).max() == pytest.approx(statement.joint_error_deg)
    assert np.array_equal(part["q_fb"], ran.log["q_fb"][part.ticks])
    assert "parts" not in part
    with pytest.raises(KeyError):
        part["parts"]
    with pytest.raises(robolang.Fault, match="RBL838") as caught:
        ran.log.at_line(61)
    assert "60" in caught.value.hint


def test_units_of_people_are_signals_of_the_log(ran):
    log = ran.log
    assert np.allclose(log.tool_error_mm, 1000 * log["tool_error"])
    assert np.allclose(np.deg2rad(log.joints), log["q_link"])
    assert np.allclose(log.joints_cmd - log.joints, log.joint_error)
    assert np.allclose(log.tool_mm, 1000 * log["X_world_tool"][:, :3, 3])
    assert np.allclose(log.tool_cmd_mm / 1000, log["tool_cmd"])
    assert np.allclose(log.tool_speed_mm_s, 1000 * log["tool_speed"])
    assert log.torque_nm.shape == log["tau_sat"].shape
    assert len(repr(log).splitlines()) == 1


class Frames:
    """What stands for pandas and polars, which are not installed everywhere."""

    @staticmethod
    def DataFrame(columns):
        assert len({len(values) for values in columns.values()}) == 1
        return columns


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_data_frames_have_a_row_for_each_statement_line_and_tick(ran, monkeypatch, library):
    monkeypatch.setitem(sys.modules, library, Frames)
    made = getattr(ran.report, f"to_{library}")()
    assert made["text"] == [each.text for each in ran.report.statements]
    plan = robolang.plan(ROOT / "pick_and_place.rbl")
    assert getattr(plan, f"to_{library}")()["seconds"] == [line.seconds for line in plan.lines]
    ticks = getattr(ran.log.at_line(60), f"to_{library}")("q_fb:2", "tool_error")
    assert list(ticks) == ["t", "q_fb:2", "tool_error"]
    assert np.array_equal(ticks["q_fb:2"], ran.log.at_line(60)["q_fb"][:, 1])
    assert len(getattr(ran.log, f"to_{library}")("tool_cmd:z")["t"]) == ran.log.count("t")


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_a_data_frame_names_the_library_that_it_needs(ran, monkeypatch, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match=library):
        getattr(ran.report, f"to_{library}")()


if __name__ == "__main__":
    TYPED.write_text(typed(), "utf-8")
