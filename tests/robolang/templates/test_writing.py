"""All files of a project or none, and none that was there is touched."""

import json
import os
import re

import pytest

from robolang.templates.template import NAMES
from robolang.templates.writing import init_project, new_project
from runtime.core.faults import Fault
from tests.robolang.core.test_storage import small_files
from tests.robolang.lint.schemas import problems, validator
from tests.robolang.lint.test_hooks import parse, read

# a place is checked with the shapes of MuJoCo
pytestmark = pytest.mark.physics

FILES = [
    ".editorconfig",
    ".github/workflows/robolang.yml",
    ".vscode/settings.json",
    "README.md",
    "cell1.cell.toml",
    "cell1.points.toml",
    "cell1.rbl",
    "cell1.test.toml",
]


def contents(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()
    }


def refused(code, call, *given):
    with pytest.raises(Fault) as caught:
        call(*given)
    assert caught.value.code == code
    return caught.value.message


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return new_project(tmp_path_factory.mktemp("new") / "cell1", "pick-place", "puma560").folder


def test_a_project_has_all_files(project):
    assert list(contents(project)) == FILES


def test_the_workflow_is_one_and_its_steps_are_commands(project):
    workflow = read((project / FILES[1]).read_text("utf-8"))
    assert problems(validator("GitHub Workflow"), workflow) == []
    steps = [step.get("run", "") for step in workflow["jobs"]["check"]["steps"]]
    ours = [step for step in steps if step.startswith("robolang ")]
    assert [step.split()[1] for step in ours] == ["fmt", "check", "test"]
    for step in ours:
        parse(step.split())


def test_the_editor_knows_the_programs(project):
    text = re.sub(r"(?m)^ *//.*$", "", (project / FILES[2]).read_text("utf-8"))
    assert list(json.loads(text)["files.associations"]) == ["*.rbl"]
    assert "[*.{rbl,toml,yml,json}]" in (project / FILES[0]).read_text("utf-8")


def test_the_readme_is_five_lines_and_names_the_program_and_its_robot(project):
    lines = [line for line in (project / "README.md").read_text("utf-8").splitlines() if line]
    assert len(lines) == 5
    assert lines[0] == "# cell1"
    assert "puma560" in lines[1]
    assert "@" not in "".join(lines)


@pytest.mark.parametrize("name", ["1st", "a b", "a.b", "-x", "", "é", "x" * 65, "."])
def test_a_name_that_is_none_is_refused(tmp_path, name):
    refused("RBL842", init_project, tmp_path, name, "tend", "puma560")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("there", ["folder", "file", "link"])
def test_a_folder_that_exists_is_left_alone(tmp_path, there):
    target = tmp_path / "cell1"
    if there == "folder":
        target.mkdir()
    elif there == "file":
        target.write_text("mine")
    else:
        target.symlink_to("nowhere")
    assert str(target) in refused("RBL841", new_project, target, "tend", "puma560")
    assert [path.name for path in tmp_path.iterdir()] == ["cell1"]
    assert not target.is_file() or target.read_text() == "mine"


def test_a_template_that_is_unknown_gets_the_nearest_one(tmp_path):
    with pytest.raises(Fault, match="RBL840") as caught:
        new_project(tmp_path / "cell1", "palletize", "puma560")
    assert "palletise?" in caught.value.hint
    assert all(name in caught.value.hint for name in NAMES)


@pytest.mark.parametrize("kept", FILES[:4])
def test_init_keeps_what_a_folder_has(tmp_path, kept):
    path = tmp_path / kept
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"mine")
    written = init_project(tmp_path, "cell1", "pick-place", "puma560")
    assert written.kept == (kept,)
    assert list(contents(tmp_path)) == FILES
    assert path.read_bytes() == b"mine"


@pytest.mark.parametrize("there", FILES[4:])
def test_init_writes_nothing_where_a_file_of_the_job_is_there(tmp_path, there):
    (tmp_path / there).write_bytes(b"mine")
    assert there in refused("RBL841", init_project, tmp_path, "cell1", "pick-place", "puma560")
    assert contents(tmp_path) == {there: b"mine"}


@pytest.mark.parametrize("size", [0, 300, 1000])
@pytest.mark.parametrize("call", ["new", "init"])
def test_nothing_is_left_where_the_disk_is_full(tmp_path, call, size):
    (tmp_path / "mine").write_bytes(b"mine")
    with small_files(size):
        if call == "new":
            refused("RBL706", new_project, tmp_path / "cell1", "pick-place", "puma560")
        else:
            refused("RBL706", init_project, tmp_path, "cell1", "pick-place", "puma560")
    assert os.listdir(tmp_path) == ["mine"]


def test_folders_above_a_new_one_are_made_with_it(tmp_path):
    new_project(tmp_path / "jobs" / "line1" / "cell1", "pick-place", "puma560")
    assert (tmp_path / "jobs" / "line1" / "cell1" / "cell1.rbl").is_file()


def test_folders_above_a_new_one_that_cannot_be_written_are_removed(tmp_path):
    with small_files(300):
        refused("RBL706", new_project, tmp_path / "jobs" / "line1" / "cell1", "pick-place", "puma560")
    (tmp_path / "file").write_bytes(b"mine")
    refused("RBL706", new_project, tmp_path / "file" / "line1" / "cell1", "pick-place", "puma560")
    assert os.listdir(tmp_path) == ["file"]
