import pytest

from robolang.project.discovery import cell_beside, taught_points
from robolang.project.project import builtin_cell, load_any_robot, load_project
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from runtime.robot.files.loader import load_builtin
from tests.messages import fields
from tests.robolang.cli.commands import BUILTIN, PUMA

CELL = (BUILTIN / "cell.toml").read_text()


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "pick.rbl"
    path.write_text("10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n")
    return path


def marked(name):
    """A cell file whose only part has a name to know it by."""
    return CELL.replace('name = "part"', f'name = "{name}"')


def part(project):
    return project.cell.parts[0].name


def refused(code, *args, **options):
    with pytest.raises(Fault) as caught:
        load_project(*args, **options)
    assert caught.value.code == code
    return caught.value


def test_a_program_alone_runs_in_the_built_in_cell(program):
    project = load_project(program)
    assert project.ok
    assert project.diagnostics == ()
    assert project.cell.robot.name == builtin_cell().robot.name == "puma560"
    assert project.points.names == {"P1", "P2", "P3", "P4", "P5"}
    assert len(project.program.statements) == 2


def test_the_nearest_cell_is_taken(program):
    (program.parent / "cell.toml").write_text(marked("of_the_folder"))
    assert part(load_project(program)) == "of_the_folder"
    (program.parent / "pick.cell.toml").write_text(marked("of_the_program"))
    assert part(load_project(program)) == "of_the_program"
    (program.parent / "third.toml").write_text(marked("given"))
    assert part(load_project(program, cell=program.parent / "third.toml")) == "given"
    assert part(load_project(str(program), cell=str(program.parent / "third.toml"))) == "given"


def test_a_cell_brings_no_points_of_its_own(program):
    (program.parent / "cell.toml").write_text(CELL)
    project = load_project(program)
    assert project.points.names == frozenset()
    assert [item.code for item in project.diagnostics] == ["RBL301"]
    assert not project.ok


def test_points_beside_the_program_replace_the_built_in_ones(program):
    (program.parent / "pick.points.toml").write_text("schema = 1\n[points.P1]\npose = [1, 2, 3, 4, 5, 6]\n")
    assert load_project(program).points.names == {"P1"}


@pytest.mark.parametrize("name", ["cell.toml", "pick.cell.toml", "pick.points.toml"])
def test_a_link_that_leads_nowhere_is_not_left_out(program, name):
    (program.parent / name).symlink_to("none.toml")
    found = refused("RBL302" if "points" in name else "RBL600", program)
    assert isinstance(found, FileFault)
    assert found.path == str(program.parent / name)


def test_points_of_another_robot_are_refused(program):
    (program.parent / "pick.points.toml").write_text("schema = 1\nrobot = 'kr6'\n")
    assert refused("RBL310", program).line == 2


def test_the_robot_and_the_servo_mode_can_be_replaced(program):
    robot = program.parent / "mine.toml"
    robot.write_text(PUMA.read_text().replace("rated_payload_kg = 2.5", "rated_payload_kg = 0.5"))
    project = load_project(program, robot=str(robot), servo="fixed")
    assert project.cell.robot.rated_payload == 0.5
    assert project.profile.servo.mode == "fixed"
    assert [item.code for item in project.diagnostics] == ["RBL402"]
    assert load_project(program).profile.servo.mode == "scheduled"


def test_the_profile_is_that_of_the_cell(program):
    (program.parent / "cell.toml").write_text(CELL + "\n[controller]\nservo_period_ms = 0.5\n")
    assert load_project(program).profile.ticks_per_cycle == 16
    (program.parent / "cell.toml").write_text(CELL + "\n[controller]\nservo_period_ms = 3\n")
    refused("RBL605", program)


def test_a_robot_that_cannot_stand_at_home_does_not_fit_the_cell(program):
    robot = program.parent / "mine.toml"
    robot.write_text(PUMA.read_text().replace("range_deg = [-225, 45]", "range_deg = [-90, 45]"))
    assert {"J3", "puma560"} <= fields(refused("RBL709", program, robot=str(robot)).message)
    start, end = PUMA.read_text().index("[kinematics.opw]"), PUMA.read_text().index("[path]")
    text = PUMA.read_text()[:start] + PUMA.read_text()[end:]
    robot.write_text(text[: text.rindex("[[axes]]")])
    assert "5" in fields(refused("RBL709", program, robot=str(robot)).message)


@pytest.mark.parametrize(
    ("loop", "value", "ok"),
    [
        ("velocity", 1999.9, True),
        ("velocity", 2000, False),
        ("position", 1999.9, True),
        ("position", 2000, False),
    ],
)
def test_gains_that_no_sampled_loop_can_have(program, loop, value, ok):
    robot = program.parent / "mine.toml"
    old = {"velocity": "velocity_bandwidth_rad_s = 120", "position": "position_bandwidth_rad_s = 30"}[loop]
    robot.write_text(PUMA.read_text().replace(old, f"{old.split(' = ')[0]} = {value}", 1))
    if ok:
        assert load_project(program, robot=str(robot)).ok
    else:
        found = refused("RBL616", program, robot=str(robot))
        assert f"{loop}_bandwidth_rad_s = 2000 of J1" in found.message
        (program.parent / "cell.toml").write_text(CELL + "\n[controller]\nservo_period_ms = 0.5\n")
        load_project(program, robot=str(robot))  # twice as often is fast enough


def test_a_robot_by_name_or_by_path():
    assert load_any_robot("puma560") is load_builtin("puma560")
    assert load_any_robot(str(PUMA)).name == "puma560"
    for name in ("", "puma", "PUMA560", "../puma560"):
        with pytest.raises(Fault) as caught:
            load_any_robot(name)
        assert caught.value.code == "RBL708"
        assert {"irb2400", "manutec_r3", "puma560"} <= fields(caught.value.hint)


def test_faults_come_before_diagnostics_and_nothing_is_half_read(program):
    program.write_text("MOV P1\n")
    assert [item.code for item in load_project(program).diagnostics] == ["RBL112"]
    (program.parent / "cell.toml").write_text("schema = 1\n")
    refused("RBL608", program)
    refused("RBL701", program.parent / "none.rbl")


def test_the_files_beside_a_program_are_found_by_name(tmp_path):
    assert cell_beside(tmp_path / "a.rbl") is None
    assert taught_points(tmp_path / "a.rbl", builtin=True).names == {"P1", "P2", "P3", "P4", "P5"}
    assert taught_points(tmp_path / "a.rbl", builtin=False).names == frozenset()
    (tmp_path / "a.b.cell.toml").touch()
    assert cell_beside(tmp_path / "a.b.rbl") == tmp_path / "a.b.cell.toml"
    assert cell_beside(tmp_path / "a.rbl") is None
    assert cell_beside(tmp_path / ("a" * 250 + ".rbl")) is None
    assert taught_points(tmp_path / ("a" * 250 + ".rbl"), builtin=False).names == frozenset()
