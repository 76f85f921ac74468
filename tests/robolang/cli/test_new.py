"""``robolang new``, ``init`` and ``examples`` as one types them."""

import json

import pytest

from tests.robolang.cli.commands import robolang

# a place is checked with the shapes of MuJoCo
pytestmark = pytest.mark.physics


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_four_commands_from_nothing_to_a_passing_test():
    commands = ("new cell1", "check --strict --motion cell1", "run --strict cell1/cell1.rbl", "test cell1")
    assert [robolang(*command.split()).exit_code for command in commands] == [0, 0, 0, 0]


def test_new_names_every_file_and_the_commands_to_go_on_with(folder):
    said = robolang("new", "cell1", "--template", "measure", "--robot", "manutec_r3").stdout
    for file in (path for path in (folder / "cell1").rglob("*") if path.is_file()):
        assert f"wrote {file.relative_to(folder)}\n" in said
    for command in ("check --motion", "run", "test"):
        assert f"robolang {command} cell1/cell1.rbl" in said


def test_init_takes_the_name_of_the_folder_or_the_one_that_is_given(folder):
    robolang("init", "--name", "press2")
    assert (folder / "press2.rbl").is_file()
    (folder / "line3").mkdir()
    assert "kept" not in robolang("init", "line3").stdout
    assert (folder / "line3" / "line3.rbl").is_file()
    assert robolang("init", "--name", "second").stdout.count("kept ") == 4


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["new", "1x"], 2, "RBL842"),
        (["new", "cell1", "--template", "weld"], 2, "RBL840"),
        (["new", "cell1", "--robot", "pumma560"], 2, "RBL708"),
        (["new", "there"], 4, "RBL841"),
        (["init", "none"], 2, "RBL703"),
        (["init", "there", "--name", "a b"], 2, "RBL842"),
        (["examples", "get", "none"], 2, "RBL844"),
        (["examples", "get", "tend", "-o", "there"], 4, "RBL841"),
    ],
)
def test_what_cannot_be_done_has_a_code_and_writes_nothing(folder, words, code, says):
    (folder / "there").mkdir()
    (folder / "there" / "tend.rbl").write_text("mine")
    before = sorted(folder.rglob("*"))
    assert says in robolang(*words, code=code).stderr
    assert sorted(folder.rglob("*")) == before
    assert (folder / "there" / "tend.rbl").read_text() == "mine"


def test_examples_are_listed_with_robot_and_planned_time(monkeypatch):
    found = json.loads(robolang("examples", "list", "--json").stdout)
    (demo,) = (each for each in found if each["name"] == "pick_and_place")
    assert (demo["robot"], demo["planned_s"]) == ("puma560", 5.296)
    # the table has the same rows, which need not be planned again
    rows = {each["name"]: each for each in found}
    monkeypatch.setattr("robolang.cli.commands.examples._row", lambda example: rows[example.name])
    shown = robolang("examples").stdout
    assert all(each["name"] in shown and f"{each['planned_s']:.1f}" in shown for each in found)


def test_an_example_is_copied_and_can_be_checked(folder):
    assert "palletise.rbl" in robolang("examples", "get", "palletise").stdout
    assert robolang("check", "--motion", folder).exit_code == 0
