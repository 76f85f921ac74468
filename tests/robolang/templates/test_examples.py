"""The example programs: each is listed, and a copy of it runs alone."""

import pytest

from robolang.templates import examples as module
from robolang.templates.examples import copy_example, examples
from runtime.core.faults import Fault
from tests.robolang.cli.commands import ROOT, robolang

MESHES = {"nuts": {"bracket.stl", "nut.stl"}}
NAMES = [each.name for each in examples()]


def test_every_program_is_an_example_under_a_name_of_its_own():
    programs = sorted(path.stem for path in (ROOT / "programs").rglob("*.rbl"))
    assert programs == NAMES == sorted(set(NAMES))
    assert all(each.title.endswith(".") for each in examples())


@pytest.mark.parametrize("name", NAMES)
def test_a_copy_has_all_that_the_program_needs(tmp_path, name):
    files = copy_example(name, tmp_path / "mine")
    assert sorted((tmp_path / "mine").iterdir()) == sorted(files)
    assert all(path.name.startswith(f"{name}.") for path in files if path.suffix != ".stl")
    assert {path.name for path in files if path.suffix == ".stl"} == MESHES.get(name, set())
    robolang("check", files[0])


@pytest.mark.physics
def test_copies_of_two_programs_that_share_a_cell_stand_side_by_side(tmp_path):
    for name in ("tend", "palletise"):
        copy_example(name, tmp_path)
    assert sorted(path.name for path in tmp_path.glob("*.cell.toml")) == ["palletise.cell.toml", "tend.cell.toml"]
    robolang("check", "--motion", tmp_path)


@pytest.mark.parametrize("there", ["tend.rbl", "tend.test.toml"])
def test_a_copy_overwrites_nothing(tmp_path, there):
    (tmp_path / there).write_text("mine")
    with pytest.raises(Fault, match="RBL841") as caught:
        copy_example("tend", tmp_path)
    assert there in caught.value.message
    assert [path.name for path in tmp_path.iterdir()] == [there]


def test_an_example_that_is_unknown_gets_the_nearest_one(tmp_path):
    with pytest.raises(Fault, match="RBL844") as caught:
        copy_example("palletize", tmp_path / "mine")
    assert "palletise?" in caught.value.hint
    assert list(tmp_path.iterdir()) == []


def test_an_installed_package_has_its_programs_inside(tmp_path, monkeypatch):
    """A folder `programs` beside the package is somebody else's."""
    (tmp_path / "programs").mkdir()
    (tmp_path / "programs" / "theirs.rbl").write_text("END\n")
    (tmp_path / "inside").mkdir()
    (tmp_path / "inside" / "ours.rbl").write_text("END\n")
    monkeypatch.setattr(module, "_CHECKOUT", tmp_path)
    monkeypatch.setattr(module, "_INSTALLED", tmp_path / "inside")
    assert [each.name for each in examples()] == ["ours"]
