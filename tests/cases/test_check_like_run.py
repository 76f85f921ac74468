"""What ``check`` finds in the files beside a program is what a run refuses, with code and place."""

import re
import shutil
from pathlib import Path

import pytest

from robolang.project.discovery import read_beside
from robolang.project.project import load_project
from runtime.cell.cell_file import read_cell_file
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from runtime.settings.layers import load_profile_file
from tests.robolang.cli.commands import robolang

CASES = Path(__file__).parent
CELL = "attack_09_check_reads_no_cell"


@pytest.fixture
def case(tmp_path):
    def copied(name):
        return Path(shutil.copytree(CASES / name, tmp_path / name)) / "p.rbl"

    return copied


def places(faults):
    return [(fault.code, Path(fault.path).name, fault.line, fault.column) for fault in faults]


def of_run(program):
    with pytest.raises(Fault) as caught:
        load_project(program)
    return places(caught.value.all)


@pytest.mark.parametrize("command", ["check", "run"])
def test_joints_outside_their_range_are_found_in_the_points_file(case, command):
    program = case("attack_08_joints_outside_limits_misnamed")
    assert "p.points.toml:3:1: error RBL309" in robolang(command, program, code=2).stderr
    assert places(read_beside(program).faults) == of_run(program) == [("RBL309", "p.points.toml", 3, 1)]


WRONG = """
[inputs.2]
follow = 1
[[obstacle]]
[frames.WORLD]
[controller]
servo_period_ms = 2
dynamics_cost = 3
[controller.servo]
mode = "fix"
gravity_compensation = nan
[controller.supervision]
enabled = "false"
"""
FOUND = [
    ("RBL608", 1),
    ("RBL609", 3),
    ("RBL609", 4),
    ("RBL610", 5),
    ("RBL605", 7),
    ("RBL609", 8),
    ("RBL610", 10),
    ("RBL604", 11),
    ("RBL613", 13),
]


def test_settings_names_and_inputs_that_are_wrong_are_found_at_once(case):
    program = case("attack_08_joints_outside_limits_misnamed")
    cell = program.with_name("cell.toml")
    text = (CASES / CELL / "cell.toml").read_text("utf-8").replace("mass_kg = nan", "mass_kg = 1.5")
    cell.write_text(text.replace('robot = "puma560"\n', "") + WRONG, "utf-8")
    begin = len(text.splitlines()) - 1
    found = [(fault.code, fault.line) for fault in of_file(cell)]
    assert found == [(code, 1 if line == 1 else begin + line) for code, line in FOUND]


@pytest.mark.parametrize(
    ("servo", "found"),
    [
        (
            'feedforward = "measured"\nvelocity_feedforward = 1\nacceleration_feedforward = 1\nmode = "fixed"\n'
            'coupling = "full"',
            [("RBL616", 3), ("RBL616", 4), ("RBL605", 6)],
        ),
        ("position_bandwidth_rad_s = [1, 2]\nvelocity_bandwidth_rad_s = [1, 2, 3]", [("RBL613", 2), ("RBL613", 3)]),
    ],
)
def test_settings_that_do_not_go_together_are_found_at_once(case, servo, found):
    program = case(CELL)
    program.with_name("p.points.toml").unlink(missing_ok=True)
    cell = program.with_name("cell.toml")
    text = cell.read_text("utf-8").replace("mass_kg = nan", "mass_kg = 1.5")
    cell.write_text(f"{text}[controller.servo]\n{servo}\n", "utf-8")
    begin = len(text.splitlines())
    expected = [(code, "cell.toml", begin + line, 1) for code, line in found]
    assert places(read_beside(program).faults) == of_run(program) == expected


def of_file(cell):
    with pytest.raises(FileFault) as caught:
        read_cell_file(cell)
    return caught.value.all


def test_everything_that_is_wrong_with_a_profile_is_found_at_once(tmp_path):
    profile = tmp_path / "prof.toml"
    profile.write_text("schema = 1\n" + WRONG[WRONG.index("[controller]") :], "utf-8")
    with pytest.raises(FileFault) as caught:
        load_profile_file(profile)
    assert [fault.code for fault in caught.value.all] == [code for code, _ in FOUND[4:]]


@pytest.mark.parametrize("command", ["check", "run"])
def test_check_reads_the_cell(case, command):
    assert "cell.toml:30:1: error RBL604" in robolang(command, case(CELL), code=2).stderr


@pytest.mark.parametrize(
    ("old", "new", "code", "line"),
    [
        ("mass_kg = nan", "mass_kg = 1.5\nmas = 1", "RBL609", 31),
        ("schema = 1", "x = [[[[", "RBL601", 4),
        ('robot = "puma560"', 'robot = "puma"', "RBL610", 4),
        ('robot = "puma560"', 'robot = "none.toml"', "RBL600", 1),
        ('robot = "puma560"', 'robot = "../puma.toml"', "RBL602", 4),
        ("[hand]", "[controller]\nservo_period_ms = 3\n[hand]", "RBL605", 12),
        ("[hand]", "[controller.servo]\nvelocity_bandwidth_rad_s = [1, 2]\n[hand]", "RBL613", 12),
        ("[hand]", '[controller.servo]\ncompensation = "none.toml"\n[hand]', "RBL600", 1),
        ("77.024753749", "777.0", "RBL605", 8),
    ],
)
def test_check_and_run_refuse_a_cell_for_one_reason_at_one_place(case, old, new, code, line):
    program = case(CELL)
    text = program.with_name("cell.toml").read_text().replace("nan", "1.5") if "nan" not in old else ""
    text = text or program.with_name("cell.toml").read_text()
    program.with_name("cell.toml").write_text(text.replace(old, new, 1))
    found = places(read_beside(program).faults)
    assert found == of_run(program)
    assert [(one[0], one[2]) for one in found] == [(code, line)]


def test_all_that_is_wrong_with_a_cell_and_its_points_is_said_at_once(case):
    program = case(CELL)
    cell = program.with_name("cell.toml")
    text = cell.read_text().replace("stroke_mm = 80\n", "").replace("grip_force_n", "grip_farce_n")
    cell.write_text(text.replace("size_mm = [600, 1100, 50]", "size_mm = [600]"))
    program.with_name("p.points.toml").write_text(
        "schema = 1\n[points.A]\npose = [1, 2]\n[points.B]\njoints = [1]\nfram = 1\n[points.C]\nnothing = nan\n"
    )
    found = places(read_beside(program).faults)
    assert found == of_run(program)
    assert [(one[0], one[2]) for one in found] == [
        ("RBL608", 11),
        ("RBL613", 22),
        ("RBL604", 29),  # one fault for both keys that [hand] lacks
        ("RBL307", 3),
        ("RBL307", 5),
        ("RBL308", 6),
        ("RBL308", 8),
    ]


def test_a_damaged_cell_does_not_hide_what_its_arm_shows_of_points_and_program(case):
    """The robot is known: its ranges, its number of axes and what it may carry."""
    program = case(CELL)
    program.write_text("LOAD (0, 0, 60), 9\nMOVEJ JOINT(0, 500, 0, 0, 0, 0)\nTOOL unknown\n")
    program.with_name("p.points.toml").write_text("schema = 1\n[points.A]\njoints = [0, 500, 0, 0, 0, 0]\n")
    found = read_beside(program)
    assert [one[0] for one in places(found.faults)] == ["RBL604", "RBL309"]
    assert places(found.faults) == of_run(program)
    shown = robolang("check", "--output-format", "concise", program, code=2).stdout
    assert re.findall(r"RBL\d+", shown) == ["RBL402", "RBL309"]


def test_every_input_that_is_wrong_is_said(case):
    program = case(CELL)
    cell = program.with_name("cell.toml")
    cell.write_text(cell.read_text().replace("nan", "1.5") + "[inputs.0]\nfollows = 1\n[inputs.2]\nfollows = nan\n")
    assert [one[0] for one in places(read_beside(program).faults)] == ["RBL605", "RBL604"]


def test_a_cell_of_many_programs_is_reported_once(case):
    program = case(CELL)
    for name in ("a", "b"):
        shutil.copy(program, program.with_name(f"{name}.rbl"))
    assert robolang("check", program.parent, code=2).stderr.count("RBL604") == 1


def test_names_of_the_cell_are_checked(case):
    program = case(CELL)
    cell = program.with_name("cell.toml")
    cell.write_text(cell.read_text().replace("nan", "1.5"))
    program.write_text(
        "LOAD none\nTOOL none\nFRAME none\nSEAM ON, none\nx = IN(7)\nLOAD heavy\nMOVEJ JOINT(0, 500)\n"
        "MOVEJ JOINT(0, 500, 0, 0, 0, 0)\n"
    )
    cell.write_text(cell.read_text() + "\n[loads.heavy]\nmass_kg = 900\ncog_mm = [0, 0, 0]\n")
    output = robolang("check", "--output-format", "concise", program, code=1).stdout
    found = [line.split(":", 2)[1:] for line in output.splitlines()]
    lines = [(int(line), rest.split()[2]) for line, rest in found]
    assert [one for one in lines if not one[1].startswith("RBL22")] == [
        (1, "RBL305"),
        (2, "RBL305"),
        (3, "RBL305"),
        (4, "RBL306"),
        (5, "RBL534"),
        (6, "RBL402"),
        (7, "RBL307"),
        (8, "RBL309"),
    ]


def test_a_file_fault_is_a_fault_with_a_place(case):
    with pytest.raises(FileFault) as caught:
        load_project(case(CELL))
    assert caught.value.others == ()


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_part_that_lies_in_the_table_is_doubted(case, command):
    program = case("attack_08_joints_outside_limits_misnamed")
    program.write_text("PRINT 1\n", "utf-8")
    program.with_name("p.points.toml").unlink()
    text = (CASES / CELL / "cell.toml").read_text("utf-8").replace("mass_kg = nan", "mass_kg = 1.5")
    program.with_name("cell.toml").write_text(text.replace("-220, 640,", "-220, 600,"), "utf-8")
    options = [] if command == "check" else ["--no-physics"]
    assert "cell.toml:31:1: warning RBL640" in robolang(command, program, *options).stderr
    robolang(command, program, "--strict", *options, code=1)
    program.with_name("cell.toml").write_text(text, "utf-8")
    assert "RBL640" not in robolang(command, program, "--strict", *options).stderr
