"""Which programs a list of paths means."""

import os

import pytest

from robolang.lint.files import programs


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in (
        "b.rbl",
        "a.rbl",
        "OLD.RBL",
        "a.txt",
        "a.rbl.bak",
        ".hidden.rbl",
        "z/deep/c.rbl",
        "y/d.rbl",
        ".git/e.rbl",
        "z/.venv/f.rbl",
        "folder.rbl/g.rbl",
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("MOVE P1\n")
    return tmp_path


def test_a_folder_means_the_programs_below_it_in_order():
    assert programs(["."]) == ["OLD.RBL", "a.rbl", "b.rbl", "folder.rbl/g.rbl", "y/d.rbl", "z/deep/c.rbl"]


def test_names_keep_the_form_in_which_the_folder_was_named(folder):
    assert programs(["z"]) == programs(["z/"]) == programs(["./z"]) == ["z/deep/c.rbl"]
    assert programs([str(folder / "z")]) == [str(folder / "z" / "deep" / "c.rbl")]


def test_a_file_is_taken_whatever_its_name():
    assert programs(["a.txt", ".hidden.rbl", "none.rbl"]) == ["a.txt", ".hidden.rbl", "none.rbl"]


def test_a_hidden_folder_that_is_named_is_not_left_out():
    assert programs([".git"]) == [".git/e.rbl"]


def test_a_file_is_there_once(folder):
    assert programs(["b.rbl", "./b.rbl", str(folder / "b.rbl"), "y", "y/d.rbl"]) == ["b.rbl", "y/d.rbl"]
    (folder / "link.rbl").symlink_to("b.rbl")
    assert programs(["b.rbl", "link.rbl"]) == ["b.rbl"]


def test_links_to_folders_are_not_followed(folder):
    (folder / "y" / "loop").symlink_to(folder, target_is_directory=True)
    assert programs(["y"]) == ["y/d.rbl"]


def test_a_link_that_leads_nowhere_is_a_program_that_is_missing(folder):
    (folder / "y" / "lost.rbl").symlink_to("nowhere")
    assert programs(["y"]) == ["y/d.rbl", "y/lost.rbl"]


def test_the_standard_input_and_impossible_names_stand_for_themselves():
    assert programs(["-", "a\0b.rbl", "-"]) == ["-", "a\0b.rbl"]


def test_a_folder_that_cannot_be_listed_is_not_left_out(monkeypatch):
    real = os.scandir

    def scandir(path):
        if str(path).endswith("deep"):
            raise PermissionError(13, "Permission denied", path)
        return real(path)

    monkeypatch.setattr(os, "scandir", scandir)
    assert programs(["z", "y"]) == ["z/deep", "y/d.rbl"]


def test_an_empty_folder_means_nothing(folder):
    (folder / "empty").mkdir()
    assert programs(["empty"]) == []
