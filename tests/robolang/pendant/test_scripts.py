"""Scripts of the prompt: what a session without a terminal carries out, shows, and ends with."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from robolang.pendant.failure import Failure
from tests.robolang.pendant.prompting import Requests, played, prompt

PICK = Path("programs/pick_and_place.rbl")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Work in an empty folder; programs of the repository by their absolute path."""
    root = Path.cwd()
    monkeypatch.chdir(tmp_path)
    return root


def test_statements_move_the_live_arm_and_expressions_show_values(folder):
    codes, results, problems = played("LOAD (0, 0, 60), 0.8\nMOVE P2\nHERE.Z\nx = 2\nx * 3\n", folder / PICK)
    assert (codes, problems) == ((), "")
    assert results.splitlines()[-3:] == ["> x = 2", "> x * 3", "6"]
    assert "840" in results.splitlines()


@pytest.mark.parametrize(
    "line, code, column",
    [
        ("MOVE P99", "RBL301", 6),
        ("MOV P1", "RBL112", 1),
        ("GOTO 999", "RBL202", 6),
        ("CALL nothing(1)", "RBL213", 6),
        ("PRINT nobody", "RBL215", 7),
        ("SPEED -5", "RBL404", 7),
        ("MOVE P1 + (0, 0, 9000)", "RBL410", 1),
        ("1 / 0", "RBL501", 1),
    ],
)
def test_a_statement_with_an_error_is_placed_and_changes_nothing(folder, line, code, column):
    codes, results, problems = played(f"{line}\npos\n", folder / PICK)
    assert codes == (code,)
    assert f"prompt:1:{column}: error {code}" in problems
    assert "joint" not in results  # the script ends at the first error


def test_a_script_goes_on_where_it_shall_and_keeps_the_first_code(folder):
    codes, results, _ = played("MOVE P99\nSPEED -5\n2 + 3\n", folder / PICK, keep_going=True)
    assert codes == ("RBL301",)
    assert results.splitlines()[-1] == "5"


def test_names_of_the_prompt_are_known_to_the_check(folder):
    codes, _, problems = played('x = 3\ns$ = "a"\np = HERE\nDIM a(3)\na(2) = x\nMOVE p\ns$ ; a(2)\n', folder / PICK)
    assert (codes, "error" in problems) == ((), False)


def test_a_constant_of_the_prompt_stays(folder):
    assert played("CONST k = 3\nk = 4\n", folder / PICK)[0] == ("RBL216",)


@pytest.mark.parametrize(
    "line, code",
    [
        ("pos 3", "RBL802"),
        ("list 61", "RBL803"),
        ("list 10 20 30", "RBL802"),
        ("in 1 on", "RBL534"),
        ("in 1 maybe", "RBL802"),
        ("help nowhere", "RBL801"),
        ("teach", "RBL802"),
        ("teach MOVE", "RBL303"),
        ("touchup P99", "RBL301"),
        ("touchup P1", "RBL807"),
        ("go P99", "RBL301"),
        ("copy P1 P2", "RBL808"),
        ("rename P1", "RBL802"),
        ("undo", "RBL715"),
        ("redo", "RBL715"),
        ("edit 60", "RBL802"),
        ("insert nowhere: MOVE P1", "RBL803"),
        ("65", "RBL717"),
        ("open nowhere.rbl", "RBL701"),
        ("save as", "RBL802"),
    ],
)
def test_a_command_that_cannot_be_carried_out_has_a_code(folder, line, code):
    codes, _, problems = played(f"{line}\n", folder / PICK)
    assert codes == (code,)
    assert code in problems and "help:" in problems


def test_an_unknown_command_names_the_one_that_was_meant(folder):
    codes, _, problems = played("tech P7\n", folder / PICK)
    assert codes == ("RBL112",) and "teach" in problems


def test_the_program_is_written_at_the_prompt(folder, tmp_path):
    codes, results, problems = played(
        "10 load (0,0,60), 0.8\n30 MOVE P2\n20 move P1\n25 DELAY 1\n25\nlist\nsave as mine\n"
    )
    assert (codes, problems) == ((), "")
    assert (tmp_path / "mine.rbl").read_text() == "10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n30 MOVE P2\n"
    assert "mine.rbl" in results


def test_lines_without_numbers_are_edited_by_their_place(folder, tmp_path):
    lines = "insert end: MOVE P1\ninsert end: MOVE P3\ninsert 2: MOVE P2\nedit 1: MOVE P5\nedit 3:\nsave as mine\n"
    assert played(lines)[0] == ()
    assert (tmp_path / "mine.rbl").read_text() == "MOVE P5\nMOVE P2\n"


def test_errors_of_an_edit_are_shown_at_once_and_keep_the_program_from_running(folder):
    codes, _, problems = played("10 MOVE P7\nrun\n")
    assert codes == ("RBL301",)
    assert problems.count("RBL301") == 2


def test_a_script_that_ends_with_unsaved_changes_fails(folder):
    assert played("10 MOVE P1\n")[0] == ("RBL805",)
    assert played("10 MOVE P1\nquit\n")[0] == ("RBL805",)
    assert played("10 MOVE P1\nundo\n")[0] == ()


def test_points_are_taught_and_saved_beside_the_program(folder, tmp_path):
    codes, _, _ = played(
        "insert end: MOVE P7\ninsert end: MOVE P1\nMOVE P2\nteach P7\ncopy P7 P8 + (0, 0, 50)\nsave as mine\n"
    )
    assert codes == ()
    codes, results, _ = played("P8.Z - P7.Z\nrename P7 ABOVE\nlist\ndel P8\nundo\nsave\n", tmp_path / "mine.rbl")
    assert codes == ()
    # joints of three decimals: some micrometres
    assert abs(float(results.splitlines()[1]) - 50.0) < 0.01
    assert (tmp_path / "mine.rbl").read_text().startswith("MOVE ABOVE\n")


def test_a_touch_up_shows_the_change_and_replaces_the_point(folder, tmp_path):
    played("insert end: MOVE P1\nteach P7\nsave as mine\n")
    session = prompt(tmp_path / "mine.rbl")
    session.do("MOVE P7 + (0, 0, -40)")
    shown = session.do("touchup P7 --yes")
    assert "40.000 mm, 0.000 deg" in shown and "-40.000" in shown
    assert session.pendant.desk.unsaved


def test_a_program_runs_on_from_the_state_of_the_prompt(folder):
    codes, results, _ = played("run\nrun\n", folder / PICK)
    assert codes == ("RBL806",)
    assert "AUTO" in results


def test_a_stop_is_continued_from_its_path(folder):
    session = prompt(folder / PICK)
    session.do("run")
    whole = session.pendant.live.session.result(0.0).log
    held = prompt(folder / PICK)
    held.do("run for 1")
    assert "on its path" in held.do("hold")
    held.do("MOVE HERE + (0, 0, 5)")
    with pytest.raises(Failure, match="RBL540"):
        held.do("run")
    assert "5.0 mm" in held.do("where")
    held.do("continue")
    assert np.array_equal(held.pendant.live.session.result(0.0).log["q_cmd"][-1], whole["q_cmd"][-1])


def test_an_arm_that_is_far_from_its_path_is_not_brought_back_by_itself(folder):
    session = prompt(folder / PICK)
    session.do("run for 1", "MOVE P5 + (0, 50, 0)")
    before = session.do("pos")
    with pytest.raises(Failure, match="RBL541"):
        session.do("continue")
    assert session.do("pos") == before


def test_an_interrupted_statement_begins_again_after_an_alarm(folder):
    session = prompt(folder / PICK, interrupts=Requests(halt=100))
    with pytest.raises(Failure, match="RBL530"):
        session.do("run")
    with pytest.raises(Failure, match="RBL804"):
        session.do("continue")
    with pytest.raises(Failure, match="RBL804"):
        session.do("MOVE P1")
    session.do("reset", "continue")
    assert "ended" in session.do("where")


def test_statements_and_lines_are_taken_back(folder):
    session = prompt(folder / PICK)
    start = session.do("pos")
    session.do("MOVE P2", "x = 3", "run")
    assert "110 MOVE P5" in session.do("back")
    assert "90  LOAD" in session.do("back 2")
    with pytest.raises(Failure, match="RBL545"):
        session.do("back 1000")
    session.do("back 10")
    assert session.do("pos") == start
    assert session.do("vars") == "no name has a value\n"
    for wrong in ("back 0", "back x", "back -1"):
        with pytest.raises(Failure, match="RBL802"):
            session.do(wrong)


def test_a_program_is_stepped_over_into_and_out_of_calls(folder, tmp_path):
    (tmp_path / "p.rbl").write_text("x = 1\nCALL two(x)\nx = 5\nSUB two(n)\nn = n + 1\nn = n + 1\nENDSUB\n")
    session = prompt(tmp_path / "p.rbl")
    assert "CALL two" in session.do("step")
    assert "next: x = 5" in session.do("step")
    assert "CALL two" in session.do("back 4")
    assert "n = n + 1" in session.do("step into", "step into")
    assert "called from line 2: CALL two(x)" in session.do("where")
    assert session.do("n") == "2\n"
    assert "next: x = 5" in session.do("step out")
    assert "ended" in session.do("run")


def test_breakpoints_stop_the_program(folder):
    session = prompt(folder / PICK)
    session.do("break 60", "break 100 if HERE.Z < 700", "break 110 if 1 / 0 > 3")
    assert len(session.do("breaks").splitlines()) == 5
    assert "next: 60" in session.do("run")
    assert "->*60" in session.do("list")
    session.do("break 60 off")
    assert "RBL501" in session.problems.getvalue() or "next: 100" in session.do("run")
    assert "next: 110" in session.do("run")
    assert "RBL501" in session.problems.getvalue()
    session.do("breaks off")
    assert "ended" in session.do("run")
    for wrong, code in (
        ("break 61", "RBL803"),
        ("break", "RBL802"),
        ("break 60 if", "RBL802"),
        ("break 60 off", "RBL803"),
    ):
        with pytest.raises(Failure, match=code):
            session.do(wrong)
    with pytest.raises(Failure, match="RBL1"):
        session.do("break 60 if (")


def test_a_standing_program_is_edited(folder, tmp_path):
    (tmp_path / "p.rbl").write_text("10 MOVE P1\n20 MOVE P2\n30 MOVE P3\n")
    session = prompt(tmp_path / "p.rbl")
    session.do("break 30", "step", "15 DELAY 1", "10")
    assert session.do("list").splitlines() == ["   15 DELAY 1", "-> 20 MOVE P2", "  *30 MOVE P3"]
    assert "30 MOVE P3" in session.do("run")
    session.do("25 PRINT 1", "25 PRINT 1")  # the same again changes nothing
    assert "30 MOVE P3" in session.do("where")
    session.do("undo")
    assert "  *30" in session.do("list").replace("->", "  ")
    session.do("30")
    assert session.do("breaks") == "no breakpoints\n"
    assert session.do("run for 1").count("30") == 0
    assert "ended" in session.do("where")


def test_an_edit_of_what_runs_is_refused_and_nothing_is_left_of_it(folder, tmp_path):
    (tmp_path / "p.rbl").write_text("CALL two()\nEND\nSUB two()\nx = 1\nMOVE P2\nENDSUB\n")
    session = prompt(tmp_path / "p.rbl")
    session.do("step into", "step into")
    with pytest.raises(Failure, match="RBL543"):
        session.do("edit 1:")
    assert session.do("diff") == "nothing is unsaved\n"
    with pytest.raises(Failure, match="RBL715"):
        session.do("redo")
    assert "next: MOVE P2" in session.do("where")


def test_a_forced_input_is_taken_back(folder):
    session = prompt(folder / "programs/shop/tend.rbl")
    number = min(session.pendant.project.cell.inputs)
    before = session.do(f"IN({number})")
    session.do(f"in {number} on", f"in {number} off", f"in {number} on")
    session.do("back 3")
    assert session.do(f"IN({number})") == before


def test_a_program_runs_to_a_line(folder):
    session = prompt(folder / PICK)
    assert "next: 80" in session.do("runto 80")
    assert "ended" in session.do("runto 60")


def test_values_are_watched(folder):
    session = prompt(folder / PICK)
    assert session.do("watch HERE.Z, MAX(1, 2), nobody").splitlines()[:2] == ["  HERE.Z = 840", "  MAX(1, 2) = 2"]
    assert "  HERE.Z = 640" in session.do("runto 40")
    with pytest.raises(Failure, match="RBL1"):
        session.do("watch HERE.")
    assert "HERE.Z" not in session.do("watch off", "step")


def test_again_brings_the_start_state_back(folder):
    session = prompt(folder / PICK)
    start = session.do("pos")
    session.do("MOVE P1", "again")
    assert session.do("pos") == start


def test_an_alarm_is_acknowledged_before_anything_moves(folder, tmp_path):
    (tmp_path / "bad.rbl").write_text("x = 1\nFOR i = 0 TO 3\nx = x / (3 - i)\nNEXT\n")
    codes, results, problems = played("run\nMOVE P1\nreset\nMOVE P1\n", tmp_path / "bad.rbl", keep_going=True)
    assert codes == ("RBL501",)
    assert problems.count("RBL804") == 1
    assert "RBL501 is acknowledged" in results
    assert "X 480.000" in results.splitlines()[-1]


def test_manual_is_slow_and_auto_has_the_programmed_speed(folder):
    seconds = {}
    for mode in ("manual", "auto"):
        session = prompt(folder / PICK)
        session.do(mode, "MOVE P1 + (0, 0, 50), SPEED 900")
        seconds[mode] = session.pendant.live.seconds
        q, period = session.pendant.live.session.result(0.0).log["q_cmd"], session.pendant.project.profile.tick_s
        poses = session.pendant.live.controller.tool_poses(q)
        fastest = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).max() / period
        assert bool(fastest <= 0.25) is (mode == "manual")
    assert seconds["manual"] > seconds["auto"]


def joints(session) -> np.ndarray:
    return np.array([float(line.split()[1]) for line in session.do("pos").splitlines() if re.match(r"J\d", line)])


def test_joints_and_tool_are_jogged(folder):
    session = prompt(folder / PICK)
    start = joints(session)
    session.do("jog J3 +5")
    assert np.abs(joints(session) - start - [0, 0, 5, 0, 0, 0]).max() < 1e-3
    session.do("jog J3 -5", "jog X -10")
    assert abs(float(session.do("HERE.X")) - 470.0) < 1e-3
    session.do("jogframe tool", "jog Z 20")  # the tool looks down
    assert abs(float(session.do("HERE.Z")) - 820.0) < 1e-3
    session.do("FRAME POSE(0, 0, 0, 0, 0, 90)", "jogframe user", "jog X 10")
    session.do("FRAME WORLD")
    assert abs(float(session.do("HERE.Y")) + 210.0) < 1e-3


@pytest.mark.parametrize(
    "line, code",
    [
        ("jog", "RBL802"),
        ("jog J9 5", "RBL720"),
        ("jog X", "RBL720"),
        ("jog X nan", "RBL720"),
        ("jog X 1e9", "RBL404"),
        ("jog J3 -60", "RBL411"),
        ("jog X 900", "RBL41"),
        ("jogframe nowhere", "RBL720"),
        ("jogspeed 0", "RBL404"),
        ("jogspeed nan", "RBL802"),
    ],
)
def test_a_jog_that_cannot_be_does_not_start(folder, line, code):
    session = prompt(folder / PICK)
    start = session.do("pos")
    with pytest.raises(Failure, match=code):
        session.do(line)
    assert session.do("pos") == start


def test_a_jog_is_stopped_and_its_rest_dropped(folder):
    session = prompt(folder / PICK, interrupts=Requests(stop=20))
    start = joints(session)
    session.do("jog J1 30")
    turned = (joints(session) - start)[0]
    assert 0.0 < turned < 29.0
    session.do("jog J1 1")
    assert abs((joints(session) - start)[0] - turned - 1.0) < 1e-3


def test_a_jog_within_a_held_move_leaves_its_path(folder):
    session = prompt(folder / PICK)
    session.do("run for 1", "jog Z 8")
    assert "8.0 mm" in session.do("hold")
    assert "ended" in session.do("continue")


def test_after_a_jog_between_two_statements_continue_returns_and_step_goes_on_from_there(folder):
    session = prompt(folder / PICK)
    session.do("step", "step", "step")
    stood = joints(session)
    session.do("jog Z 8", "jog J6 2")
    assert "where the program stood" in session.do("where")
    here = session.do("hold")
    assert "8.0 mm" in here and "2.0 deg" in here
    jogged = joints(session)
    session.do("step")
    assert (joints(session) == jogged).all()
    session.do("back", "break 50")
    assert "2.0 deg" in session.do("hold")
    session.do("continue")
    assert "next: 50" in session.do("where")
    assert (joints(session) == stood).all()


@pytest.mark.parametrize("jog", ["jog Z 60", "jog J1 -12"])
def test_continue_does_not_return_from_too_far_between_two_statements(folder, jog):
    session = prompt(folder / PICK)
    session.do("step", "step", "step", jog)
    with pytest.raises(Failure) as refused:
        session.do("continue")
    assert refused.value.codes == ("RBL541",)
    session.do("PRINT 1")
    with pytest.raises(Failure):
        session.do("continue")
    # a typed move is meant to leave the place
    session.do("break 50", "MOVE HERE + (0, 0, 1)", "continue")
    assert "next: 50" in session.do("where")


def test_jogs_are_taken_back(folder):
    session = prompt(folder / PICK)
    start = session.do("pos")
    session.do("jog J1 5", "jog X 5")
    assert "jog X +5" in session.do("back")
    assert "jog J1 +5" in session.do("back")
    assert session.do("pos") == start


def test_an_input_is_forced_and_given_back(folder, tmp_path):
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    session = prompt(tmp_path / "p.rbl", cell=folder / "programs/shop/cell.toml")
    number = min(session.pendant.project.cell.inputs)
    before = session.do(f"IN({number})")
    session.do(f"in {number} on")
    assert session.do(f"IN({number})") == "1\n"
    session.do(f"in {number} off")
    assert session.do(f"IN({number})") == "0\n"
    session.do(f"in {number} auto")
    assert session.do(f"IN({number})") == before


def test_every_command_is_explained(folder):
    session = prompt()
    listed = session.do("help")
    for command in session.pendant.commands:
        assert command.form in listed and command.help in listed
        assert command.help in session.do(f"help {command.word}")


TAUGHT = """
MOVE P2
teach A
MOVE P2 + (100, 0, 0)
teach B
MOVE P2 + (20, 50, 0)
teach C
"""


def test_a_frame_is_measured_and_at_once_in_use(folder):
    session = prompt()
    session.do(*TAUGHT.split("\n"))
    shown = session.do("teachframe pallet A B C")
    numbers = [float(each) for each in re.findall(r"-?\d+\.\d+", shown)]
    # points taught as joints have three decimals of a degree
    assert np.abs(np.array(numbers) - [480.0, 0.0, 840.0, 0.0, 0.0, 0.0]).max() < 0.02
    session.do("FRAME pallet", "MOVE POSE(10, 20, 0, 180, 0, -135)")
    session.do("FRAME WORLD")
    assert abs(float(session.do("HERE.X")) - 490.0) < 0.02
    codes, _, _ = played(TAUGHT + "teachframe pallet A B B\n")
    assert codes == ("RBL313",)
    codes, _, _ = played(TAUGHT + "teachframe pallet A B C\nteachframe pallet B A C\n")
    assert codes == ("RBL807",)


def test_a_tool_is_measured_by_touches_of_one_tip(folder, tmp_path):
    turns = [(180, 0, -135), (150, 0, -135), (180, 30, -135), (180, 0, -90)]
    lines = [f"MOVE POSE(480, 0, 700, {rx}, {ry}, {rz})\nteach T{i} joints" for i, (rx, ry, rz) in enumerate(turns)]
    codes, _results, _problems = played("\n".join(lines) + "\nteachtool probe T0 T1 T2 T3\nsave as mine\n")
    assert codes == ()
    cell = tomllib.loads((tmp_path / "mine.cell.toml").read_text())
    hand = prompt().pendant.project.cell.hand.X_flange_tool[:3, 3] * 1000.0
    assert np.abs(np.array(cell["tools"]["probe"]["pose_mm_deg"][:3]) - hand).max() < 0.05


@pytest.mark.physics
def test_the_payload_is_weighed_and_declared(folder, tmp_path):
    session = prompt(physics=True)
    session.do("LOAD (0, 0, 60), 0.8", "MOVE P1", "HAND ON", "LOAD (0, 0, 95), 2.3", "MOVE P2")
    shown = session.do("weigh carried")
    mass = float(re.search(r"^LOAD \(.*\), ([0-9.]+)", shown, re.MULTILINE)[1])
    assert abs(mass - 2.3) < 0.15  # the hand of 0.8 kg and the part of 1.5 kg
    session.do("LOAD carried")
    assert abs(session.pendant.live.controller.areas.sda.mass - mass) < 0.01
    stopped = prompt(physics=True, interrupts=Requests(stop=40))
    with pytest.raises(Failure, match="RBL809"):
        stopped.do("weigh")
    for wrong in ("weigh a b", "weigh 3"):
        with pytest.raises(Failure):
            stopped.do(wrong)
