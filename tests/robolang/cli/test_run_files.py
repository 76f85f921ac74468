"""The files of a run: a place that cannot be written is refused before the run, a disk that fills up after it."""

import errno
import json
import os

import numpy as np
import pytest

from robolang.execution.session import Session
from tests.messages import fields
from tests.robolang.cli.commands import dry


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.rbl").write_text("10 MOVE P1\n")
    return tmp_path


@pytest.mark.parametrize("option", ["--report", "--log"])
@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none/l.npz", "none/l.npz"),
        ("folder.npz", "folder.npz"),
        ("pipe.npz", "pipe.npz"),
        ("p.rbl/l.npz", "p.rbl/l.npz"),
        ("a" * 300 + ".npz", ""),
    ],
)
def test_a_place_that_cannot_be_written_is_refused_before_the_run(folder, monkeypatch, option, name, said):
    (folder / "folder.npz").mkdir()
    os.mkfifo(folder / "pipe.npz")
    before = sorted(os.listdir())

    def run(self):
        raise AssertionError("the run was started")

    monkeypatch.setattr(Session, "run", run)
    result = dry("p.rbl", option, name, code=4)
    assert set(said.split()) <= fields(result.stderr)
    assert result.stderr.startswith("error RBL706 ")
    assert result.stdout == ""
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("name", ["l.npz", "l.mcap"])
def test_a_disk_that_fills_up_leaves_old_files_and_is_said(folder, monkeypatch, name):
    for old in ("r.json", name):
        (folder / old).write_bytes(b"old bytes")

    def full(handle):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    result = dry("p.rbl", "--report", "r.json", "--log", name, code=4)
    for old in ("r.json", name):
        assert [old in line for line in result.stderr.splitlines() if "error RBL706" in line].count(True) == 1
        assert (folder / old).read_bytes() == b"old bytes"
    assert sorted(os.listdir()) == sorted(["p.rbl", "r.json", name])
    assert "MOVE P1" in result.stdout  # what the run found out is shown all the same


def test_one_file_that_fails_does_not_cost_the_other(folder, monkeypatch):
    from robolang.logs import files

    def full(stream, signals):
        stream.write(b"half")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setitem(files._WRITERS, ".npz", full)
    dry("p.rbl", "--report", "r.json", "--log", "l.npz", code=4)
    assert json.loads((folder / "r.json").read_text())["ok"] is True
    assert sorted(os.listdir()) == ["p.rbl", "r.json"]


def test_old_files_are_replaced_whole(folder):
    for old in ("r.json", "l.npz"):
        (folder / old).write_bytes(b"x" * 10_000_000)
    dry("p.rbl", "--report", "r.json", "--log", "l.npz", "--quiet")
    assert json.loads((folder / "r.json").read_text())["statements"][0]["text"] == "MOVE P1"
    assert len(np.load(folder / "l.npz")["t"]) > 500
    assert (folder / "r.json").stat().st_size < 10_000
