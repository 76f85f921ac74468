"""robolang.toml and pyproject.toml above a program."""

import os
from pathlib import Path

import pytest

from robolang.core.bounds import BOUNDS, ELBOW, RANGE_MARGIN, SHOULDER, WRIST, Bounds
from robolang.lint.files import programs
from robolang.lint.selection import Layer
from robolang.lint.settings import Settings, files_above
from runtime.core.tomlfile import FileFault
from tests.messages import fields, heads
from tests.robolang.cli.commands import robolang
from tests.robolang.lint.helpers import layer


def put(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def fails(folder):
    with pytest.raises(FileFault) as caught:
        Settings().layer(folder)
    return caught.value.code, caught.value.line, caught.value.column


def test_without_a_file_nothing_is_said(tmp_path):
    assert Settings().layer(tmp_path) == Layer()


def test_every_key_is_read(tmp_path):
    text = '[lint]\nselect = ["rbl2"]\nextend-select = ["point-undefined"]\nignore = ["RBL116"]\n'
    put(tmp_path / "robolang.toml", text)
    assert Settings().layer(tmp_path) == layer(select=["RBL2"], extend=["RBL301"], ignore=["RBL116"])


@pytest.mark.parametrize("text", ["", "schema = 1\n", "[lint]\n", "lint = {}\n"])
def test_every_part_is_optional(tmp_path, text):
    put(tmp_path / "robolang.toml", text)
    assert Settings().layer(tmp_path) == Layer()


def test_selecting_nothing_is_not_the_same_as_not_selecting(tmp_path):
    put(tmp_path / "robolang.toml", "[lint]\nselect = []\n")
    assert Settings().layer(tmp_path).select == ()


def test_the_nearest_file_counts_and_they_are_not_merged(tmp_path):
    put(tmp_path / "robolang.toml", '[lint]\nignore = ["RBL1"]\n')
    put(tmp_path / "a" / "b" / "robolang.toml", '[lint]\nselect = ["RBL3"]\n')
    settings = Settings()
    assert settings.layer(tmp_path / "a") == layer(ignore=["RBL1"])
    assert settings.layer(tmp_path / "a" / "b" / "c") == layer(select=["RBL3"])
    assert settings.layer(tmp_path / "a" / "b") == layer(select=["RBL3"])
    assert settings.layer(tmp_path) == layer(ignore=["RBL1"])


def test_pyproject_counts_when_it_speaks_of_robolang(tmp_path):
    put(tmp_path / "pyproject.toml", '[tool.robolang.lint]\nignore = ["RBL3"]\n')
    put(tmp_path / "a" / "pyproject.toml", "[tool.ruff]\nline-length = 120\n[project]\nname = 'not robolang'\n")
    put(tmp_path / "b" / "pyproject.toml", "[tool.robolang]\n")
    assert Settings().layer(tmp_path / "a") == layer(ignore=["RBL3"])
    assert Settings().layer(tmp_path / "b") == Layer()


def test_of_two_files_in_one_folder_the_own_one_counts(tmp_path):
    put(tmp_path / "pyproject.toml", '[tool.robolang.lint]\nignore = ["RBL3"]\n')
    put(tmp_path / "robolang.toml", '[lint]\nignore = ["RBL4"]\n')
    assert Settings().layer(tmp_path) == layer(ignore=["RBL4"])


def test_a_pyproject_that_is_no_toml_matters_only_when_it_speaks_of_robolang(tmp_path):
    put(tmp_path / "pyproject.toml", "[[[\n")
    assert Settings().layer(tmp_path) == Layer()
    put(tmp_path / "pyproject.toml", "[[[\n# robolang\n")
    assert fails(tmp_path)[:2] == ("RBL601", 1)


def test_a_folder_is_named_relative_to_the_working_folder(tmp_path, monkeypatch):
    put(tmp_path / "robolang.toml", '[lint]\nignore = ["RBL4"]\n')
    (tmp_path / "deep").mkdir()
    monkeypatch.chdir(tmp_path / "deep")
    assert Settings().layer(type(tmp_path)("")) == layer(ignore=["RBL4"])


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("[lint]\nselct = []\n", ("RBL707", 2, 1)),
        ("[lints]\nselect = []\n", ("RBL707", 1, 1)),
        ("[lint]\n  ignore = []\n  ignore = []\n", ("RBL707", 3, 3)),
        ("[lint]\nignore = []\n[other]\n[lint]\n", ("RBL707", 4, 1)),
        ('[lint]\nignore = ["RBL301", "RBL999"]\n', ("RBL710", 2, 1)),
        ('[lint]\nselect = ["pont-undefined"]\n', ("RBL710", 2, 1)),
        ('[lint]\nselect = "RBL3"\n', ("RBL613", 2, 1)),
        ("[lint]\nselect = [3]\n", ("RBL613", 2, 1)),
        ("schema = 2\n", ("RBL605", 1, 1)),
        ("lint = 3\n", ("RBL613", 1, 1)),
        ("[lint\n", ("RBL601", 1, 6)),
    ],
)
def test_a_wrong_file_is_a_fault_at_its_place(tmp_path, text, place):
    put(tmp_path / "robolang.toml", text)
    assert fails(tmp_path) == place


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("[tool.robolang.lint]\nselct = []\n", ("RBL707", 2, 1)),
        ("[tool.robolang]\nlinter = 1\n", ("RBL707", 2, 1)),
        ("[project]\nname = 'x'\n[tool.robolang.lint]\nignore = []\nignore = []\n", ("RBL707", 5, 1)),
        ("[tool]\nrobolang = 3\n", ("RBL613", 2, 1)),
    ],
)
def test_a_wrong_pyproject_is_a_fault_at_its_place(tmp_path, text, place):
    put(tmp_path / "pyproject.toml", text)
    assert fails(tmp_path) == place


def test_messages_name_the_key_and_the_nearest(tmp_path):
    put(tmp_path / "robolang.toml", "[lint]\nselct = []\n")
    with pytest.raises(FileFault) as caught:
        Settings().layer(tmp_path)
    assert "lint.selct" in fields(caught.value.message)
    assert "select" in fields(caught.value.hint)
    put(tmp_path / "robolang.toml", "[lint]\nignore = []\nignore = []\n")
    with pytest.raises(FileFault) as caught:
        Settings().layer(tmp_path)
    assert {"ignore", "2"} <= fields(caught.value.message)
    assert caught.value.excerpt == "ignore = []"


def test_a_file_that_cannot_be_read_is_a_fault(tmp_path):
    os.mkfifo(tmp_path / "robolang.toml")
    assert fails(tmp_path)[0] == "RBL600"


def test_files_above_are_those_that_are_looked_for(tmp_path):
    names = files_above(tmp_path)
    assert names[:2] == [tmp_path / "robolang.toml", tmp_path / "pyproject.toml"]
    assert names[2].parent == tmp_path.parent
    assert len(names) == 2 * len([tmp_path, *tmp_path.parents])


@pytest.mark.parametrize(
    ("pattern", "path", "excluded"),
    [
        ("bad", "bad", True),
        ("bad/", "bad", True),
        ("bad", "good/bad", False),
        ("*/bad", "good/bad", True),
        ("bad/*.rbl", "bad/a.rbl", True),
        ("bad/*.rbl", "bad/a.txt", False),
    ],
)
def test_paths_are_excluded_from_the_folder_of_the_file(tmp_path, pattern, path, excluded):
    put(tmp_path / "robolang.toml", f'exclude = ["{pattern}"]\n')
    assert Settings().excludes(str(tmp_path / path)) is excluded


def test_what_is_excluded_is_not_searched_and_what_is_named_is_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    put(tmp_path / "robolang.toml", 'exclude = ["bad", "*_old.rbl"]\n')
    for name in ("a.rbl", "a_old.rbl", "bad/b.rbl", "good/bad/c.rbl"):
        put(tmp_path / name, "MOVE P1\n")
    assert programs(["."], excludes=Settings().excludes) == ["a.rbl", "good/bad/c.rbl"]
    assert programs(["bad/b.rbl"], excludes=Settings().excludes) == ["bad/b.rbl"]


def test_a_pattern_that_is_no_text_is_a_fault(tmp_path):
    put(tmp_path / "robolang.toml", "exclude = [3]\n")
    assert fails(tmp_path)[0] == "RBL613"


def test_the_commands_of_the_documentation_find_nothing_at_the_root_of_this_repository(monkeypatch):
    """As docs/ci.md shows them: what is wrong on purpose, for the tests, is excluded."""
    monkeypatch.chdir(Path(__file__).parents[3])
    names = programs(["."], excludes=Settings().excludes)
    # out/ has what the commands of docs/new.md have written
    ours = ("programs/", "robolang/templates/library/", "out/")
    assert {name for name in ours[:2] if any(each.startswith(name) for each in names)} == set(ours[:2])
    assert all(name.startswith(ours) for name in names)


# --- bounds of rules -------------------------------------------------------------------------------------------------


def test_a_bound_of_a_rule_is_read_and_the_others_keep_their_defaults(tmp_path):
    put(tmp_path / "robolang.toml", "[lint.near-joint-limit]\nmargin_deg = 5\n[lint.near-singularity]\nelbow_deg = 3\n")
    found = Settings().bounds(tmp_path / "deep")
    assert (found[RANGE_MARGIN], found[ELBOW], found[WRIST], found[SHOULDER]) == (5.0, 3.0, 2.0, 20.0)
    assert found != Bounds()
    assert Settings().bounds(tmp_path.parent) == Bounds()


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("[lint.near-joint-limit]\nmargin_deg = 91\n", ("RBL605", 2, 1)),
        ("[lint.near-joint-limit]\nmargin_deg = nan\n", ("RBL604", 2, 1)),
        ("[lint.near-joint-limit]\nmargin_deg = '5'\n", ("RBL613", 2, 1)),
        ("[lint.near-joint-limit]\nmargin = 5\n", ("RBL707", 2, 1)),
        ("[lint.near-joint-limits]\nmargin_deg = 5\n", ("RBL707", 1, 1)),
        ("[lint]\nnear-joint-limit = 5\n", ("RBL707", 2, 1)),
    ],
)
def test_a_bound_that_cannot_be_is_refused_at_its_place(tmp_path, text, place):
    put(tmp_path / "robolang.toml", text)
    assert fails(tmp_path) == place


@pytest.mark.physics
def test_a_bound_decides_what_check_finds(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    put(tmp_path / "p.rbl", "MOVEJ JOINT(0, 60, -190, 0, 60, 260)\n")  # J6 ends at 266
    assert heads(robolang("check", "--motion").stdout) == []
    put(tmp_path / "robolang.toml", "[lint.near-joint-limit]\nmargin_deg = 10\n")
    assert heads(robolang("check", "--motion").stdout) == ["p.rbl:1:1: warning RBL422"]


def test_bounds_are_shown(tmp_path):
    for bound in BOUNDS:
        explained = " ".join(robolang("explain", bound.code).stdout.split())
        assert f"[lint.{bound.rule}]" in explained
        assert f"{bound.key} = {bound.default:g} {bound.unit}" in explained
        assert bound.key in robolang("rules").stdout
