"""The lines of earlier sessions: kept, bounded, and never a reason to fail."""

import json
from pathlib import Path

import pytest

from robolang.pendant import history
from robolang.pendant.history import KeptHistory, history_file


@pytest.fixture
def path(tmp_path):
    return tmp_path / "state" / "robolang" / "history.jsonl"


def loaded(path):
    return list(KeptHistory(path).load_history_strings())


def test_entries_are_there_next_time_the_newest_first(path):
    for entry in ("MOVE P1", "FOR i = 1 TO 3\n  PRINT i\nNEXT", "\u0436\ud800".encode("utf-8", "replace").decode()):
        KeptHistory(path).store_string(entry)
    assert loaded(path)[1:] == ["FOR i = 1 TO 3\n  PRINT i\nNEXT", "MOVE P1"]


def test_two_prompts_keep_the_lines_of_both(path):
    one, other = KeptHistory(path), KeptHistory(path)
    one.store_string("1")
    other.store_string("2")
    one.store_string("3")
    assert loaded(path) == ["3", "2", "1"]


def test_it_is_bounded(path, monkeypatch):
    monkeypatch.setattr(history, "MOST", 5)
    for number in range(12):
        KeptHistory(path).store_string(str(number))
    KeptHistory(path).store_string("x" * 5000)
    assert loaded(path) == ["11", "10", "9", "8", "7"]
    assert len(path.read_text().splitlines()) == 5


@pytest.mark.parametrize("text", ["", "no json\n", '{"a": 1}\n["b"]\n', "\x00\xff", '"whole"\n"cut'])
def test_what_others_wrote_costs_only_itself(path, text):
    path.parent.mkdir(parents=True)
    path.write_bytes(text.encode("latin-1"))
    found = loaded(path)
    assert found == (["whole"] if "whole" in text else [])
    KeptHistory(path).store_string("new")
    assert loaded(path) == ["new", *found]


def test_a_folder_that_cannot_be_written_is_no_error(tmp_path):
    (tmp_path / "file").write_text("")
    kept = KeptHistory(tmp_path / "file" / "history.jsonl")
    kept.append_string("MOVE P1")
    assert kept.get_strings() == ["MOVE P1"]
    assert list(kept.load_history_strings()) == []


def test_without_a_file_it_lasts_as_long_as_the_prompt():
    kept = KeptHistory(None)
    kept.append_string("x")
    assert kept.get_strings() == ["x"]
    assert list(kept.load_history_strings()) == []


def test_the_file_is_in_the_state_folder_of_the_user(monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", "/somewhere")
    assert history_file() == Path("/somewhere/robolang/history.jsonl")
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setenv("HOME", "/home/who")
    assert history_file() == Path("/home/who/.local/state/robolang/history.jsonl")


def test_entries_are_lines_of_json(path):
    KeptHistory(path).store_string("a\nb")
    assert [json.loads(line) for line in path.read_text().splitlines()] == ["a\nb"]
