"""Checking again whenever something changes, without waiting for it."""

import os

import pytest

from robolang.lint.watch import PERIOD_S, stamps, watch


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pick.rbl").write_text("MOVE P1\n")
    return tmp_path


def looks(*changes):
    """A sleep that makes one change each time it is called; None: nothing."""
    steps = iter(changes)

    def sleep(seconds):
        assert seconds == PERIOD_S
        change = next(steps, None)
        if change is not None:
            change()

    return sleep


def test_without_a_change_it_is_checked_once():
    checks = []
    assert watch(["."], lambda: checks.append(1) or 0, rounds=5, sleep=looks()) == 0
    assert len(checks) == 1


@pytest.mark.parametrize(
    "name",
    [
        "pick.rbl",
        "new.rbl",
        "deep/new.rbl",
        "pick.points.toml",
        "pick.cell.toml",
        "cell.toml",
        "robolang.toml",
        "pyproject.toml",
    ],
)
def test_a_change_of_what_a_check_reads_is_noticed(name, folder):
    def change():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("changed it\n")

    checks = []
    watch(["."], lambda: checks.append(1) or 0, rounds=4, sleep=looks(None, change))
    assert len(checks) == 2


def test_a_file_that_goes_and_comes_back_is_noticed(folder):
    path, checks = folder / "pick.rbl", []
    steps = looks(path.unlink, None, lambda: path.write_text("MOVE P2\n"))
    watch(["pick.rbl"], lambda: checks.append(path.exists()) or 0, rounds=5, sleep=steps)
    assert checks == [True, False, True]


def test_other_files_are_not_looked_at(folder):
    checks = []
    watch(["."], lambda: checks.append(1) or 0, rounds=3, sleep=looks((folder / "notes.txt").touch))
    assert len(checks) == 1


def test_a_change_during_a_check_is_not_lost(folder):
    checks = []

    def check():
        checks.append(1)
        if len(checks) == 1:
            os.utime(folder / "pick.rbl", ns=(1, 1))
        return 0

    watch(["."], check, rounds=3, sleep=looks())
    assert len(checks) == 2


def test_the_last_state_is_the_answer(folder):
    answers = iter([1, 0])
    change = looks(lambda: (folder / "pick.rbl").write_text("MOVE P2\n"))
    assert watch(["."], lambda: next(answers), rounds=2, sleep=change) == 0


@pytest.mark.parametrize("code", [0, 1, 2])
def test_ctrl_c_ends_with_the_last_state(code):
    def interrupt(seconds):
        raise KeyboardInterrupt

    assert watch(["."], lambda: code, sleep=interrupt) == code


def test_a_stamp_says_what_is_there(folder):
    found = stamps(["pick.rbl", "none.rbl", "-"])
    assert found["pick.rbl"] is not None
    assert found["none.rbl"] is None
    assert "-" not in found
    assert str(folder / "robolang.toml") in found
