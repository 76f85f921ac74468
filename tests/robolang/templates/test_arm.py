"""The robot of a project: a name, or a file that the project has or gets."""

import re

import pytest

from robolang.project.project import load_project
from robolang.templates.arm import choose
from robolang.templates.writing import init_project, new_project
from runtime.appearance.own_meshes import own_meshes
from runtime.core.faults import Fault
from tests.robolang.cli.commands import PUMA, robolang
from tests.runtime.meshes import binary_stl, box_mesh
from tests.runtime.robot.models import SIX

# a place is checked with the shapes of MuJoCo
pytestmark = pytest.mark.physics


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "arms" / "mine.toml"
    path.parent.mkdir()
    path.write_text(PUMA.read_text("utf-8").replace('name = "puma560"', 'name = "mine"', 1), "utf-8")
    return path


def cell(folder):
    return (folder / "cell1.cell.toml").read_text("utf-8")


def test_a_built_in_robot_is_named_and_nothing_is_copied(tmp_path):
    arm = choose("irb2400", tmp_path)
    assert (arm.name, arm.reference, dict(arm.files)) == ("irb2400", "irb2400", {})


def test_a_file_from_elsewhere_is_copied_and_the_project_runs_without_it(tmp_path, mine):
    folder = new_project(tmp_path / "cell1", "pick-place", str(mine)).folder
    assert (folder / "mine.toml").read_bytes() == mine.read_bytes()
    assert 'robot = "mine.toml"' in cell(folder)
    mine.unlink()
    robolang("check", "--strict", "--motion", folder)


def test_a_file_in_the_folder_is_named_from_there(tmp_path, mine):
    written = init_project(tmp_path, "cell1", "pick-place", str(mine))
    assert 'robot = "arms/mine.toml"' in cell(tmp_path)
    assert not any("mine" in name for name in written.files)
    robolang("check", "--strict", "--motion", tmp_path)


@pytest.mark.parametrize(
    ("robot", "code"), [("pumma560", "RBL708"), ("none.toml", "RBL600"), ("bad.toml", "RBL608"), ("bad.urdf", "RBL621")]
)
def test_what_is_no_robot_is_refused_before_anything_is_written(tmp_path, monkeypatch, robot, code):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.toml").write_text("schema = 1\n")
    (tmp_path / "bad.urdf").write_text("<html/>")
    with pytest.raises(Fault) as caught:
        new_project(tmp_path / "cell1", "pick-place", robot)
    assert caught.value.code == code
    assert not (tmp_path / "cell1").exists()


def test_a_model_without_drives_gets_a_project_for_the_ideal_arm(tmp_path):
    path = tmp_path / "six.urdf"
    path.write_text(SIX)
    written = new_project(tmp_path / "cell1", "pick-place", str(path))
    assert [name for name in written.files if "six" in name] == ["six.urdf"]
    assert not written.physics
    robolang("check", "--strict", "--motion", written.folder)
    robolang("test", written.folder)
    robolang("run", "--no-physics", written.folder / "cell1.rbl")


def test_meshes_of_a_model_are_copied_with_it(tmp_path):
    folder = tmp_path / "model"
    (folder / "meshes").mkdir(parents=True)
    box = binary_stl(box_mesh((0.1, 0.1, 0.1)))
    (folder / "meshes" / "box.stl").write_bytes(box)
    shown = '<visual><geometry><mesh filename="package://mine/meshes/box.stl"/></geometry></visual>'
    (folder / "six.urdf").write_text(re.sub(r'(<link name="[^"]+">)', rf"\1{shown}", SIX))
    project = new_project(tmp_path / "cell1", "pick-place", str(folder / "six.urdf")).folder
    assert (project / "meshes" / "box.stl").read_bytes() == box
    assert own_meshes(load_project(project / "cell1.rbl").cell.robot.meshes).notes == ()
