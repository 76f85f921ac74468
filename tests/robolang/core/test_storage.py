import errno
import json
import math
import os
import resource
import stat
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from robolang.core.storage import add_files, check_writable, write_atomic, write_json
from robolang.logs.files import write_log
from runtime.core.faults import Fault
from tests.robolang.logs.made import log


@contextmanager
def small_files(size):
    """Let the kernel refuse to make a file larger than ``size`` bytes, as a full disk would."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def ordinary_user():
    """Give up the rights of root, to whom no folder is read-only, if this is root."""
    if os.geteuid():
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


def refused(call, *args):
    with pytest.raises(Fault) as caught:
        call(*args)
    assert caught.value.code == "RBL706"
    return f"{caught.value.message} | {caught.value.hint}"


def test_a_file_is_written_and_the_old_one_replaced(tmp_path):
    path = tmp_path / "r.json"
    for value in ({"a": [1.5, None, "é"]}, {"b": 1}):
        write_json(path, value)
        assert json.loads(path.read_text("utf-8")) == value
        assert path.read_bytes().endswith(b"\n")
    assert os.listdir(tmp_path) == ["r.json"]


def test_the_mode_is_that_of_an_ordinary_new_file(tmp_path):
    before = os.umask(0o027)
    try:
        write_json(tmp_path / "r.json", {})
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "r.json").stat().st_mode) == 0o640


@pytest.mark.parametrize("suffix", [".npz", ".mcap", ".json"])
@pytest.mark.parametrize("size", [0, 100, 20_000])
def test_a_full_disk_while_writing_leaves_the_old_file_as_it_was(tmp_path, suffix, size):
    path = tmp_path / f"l{suffix}"
    path.write_bytes(b"old bytes")
    with small_files(size):
        if suffix == ".json":
            said = refused(write_json, path, {"x": list(range(20_000))})
        else:
            said = refused(write_log, path, log(4000))
    assert os.strerror(errno.EFBIG) in said
    assert path.read_bytes() == b"old bytes"
    assert os.listdir(tmp_path) == [path.name]


def test_what_a_writer_raises_passes_and_leaves_nothing(tmp_path):
    path = tmp_path / "r.json"
    path.write_bytes(b"old bytes")

    def write(stream):
        stream.write(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_atomic(path, write)
    assert path.read_bytes() == b"old bytes"
    assert os.listdir(tmp_path) == ["r.json"]


def test_a_disk_that_is_full_is_noticed_before_the_run(tmp_path):
    check_writable(tmp_path / "r.json")
    with small_files(100):
        assert os.strerror(errno.EFBIG) in refused(check_writable, tmp_path / "r.json")
    assert os.listdir(tmp_path) == []


BOTH = pytest.mark.parametrize("call", [check_writable, lambda path: write_json(path, {})], ids=["check", "write"])


@BOTH
def test_a_missing_folder(tmp_path, call):
    said = refused(call, tmp_path / "none" / "r.json")
    assert os.strerror(errno.ENOENT) in said
    assert str(tmp_path / "none") in said.partition(" | ")[2]


@BOTH
def test_a_file_in_the_place_of_the_folder(tmp_path, call):
    (tmp_path / "file").touch()
    assert os.strerror(errno.ENOTDIR) in refused(call, tmp_path / "file" / "r.json")


@BOTH
def test_a_folder_in_the_place_of_the_file(tmp_path, call):
    for folder in (tmp_path, Path()):
        assert "folder" in refused(call, folder)


@BOTH
def test_a_pipe_or_a_device_is_never_replaced(tmp_path, call):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "null").symlink_to("/dev/null")
    for name in ("pipe", "null"):
        assert "ordinary" in refused(call, tmp_path / name)
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)
    assert (tmp_path / "null").is_symlink()


@BOTH
def test_a_name_that_no_file_can_have(tmp_path, call):
    assert os.strerror(errno.ENAMETOOLONG) in refused(call, tmp_path / ("a" * 256))
    (tmp_path / "ring").symlink_to("ring")
    refused(call, tmp_path / "ring")


@BOTH
def test_a_read_only_folder_or_file(call):
    with tempfile.TemporaryDirectory() as name:  # not tmp_path: another user cannot enter that
        folder = Path(name)
        (folder / "old.json").write_text("old")
        (folder / "old.json").chmod(0o444)
        folder.chmod(0o555)
        with ordinary_user():
            assert os.strerror(errno.EACCES) in refused(call, folder / "r.json")
            assert "read-only" in refused(call, folder / "old.json")
        assert (folder / "old.json").read_text() == "old"
        folder.chmod(0o755)


def test_a_name_as_long_as_names_can_be_is_written(tmp_path):
    path = tmp_path / ("a" * 255)
    check_writable(path)
    write_json(path, {})
    assert os.listdir(tmp_path) == [path.name]


def test_a_link_keeps_pointing_and_its_file_is_replaced(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "latest").symlink_to("folder/r.json")
    check_writable(tmp_path / "latest")
    write_json(tmp_path / "latest", {"a": 1})
    assert (tmp_path / "latest").is_symlink()
    assert json.loads((tmp_path / "folder" / "r.json").read_text()) == {"a": 1}


def test_json_is_strict_whatever_it_is_given(tmp_path):
    value = {"a": math.nan, "b": [math.inf, (-math.inf, 1.0)], "c": np.float64("nan"), "d": "NaN", "e": 0.1 + 0.2}
    write_json(tmp_path / "r.json", value)
    text = (tmp_path / "r.json").read_text()
    assert json.loads(text) == {"a": None, "b": [None, [None, 1.0]], "c": None, "d": "NaN", "e": 0.1 + 0.2}
    write_json(tmp_path / "r.json", {"name": "p\udcff.rbl"})
    assert json.loads((tmp_path / "r.json").read_bytes().decode("utf-8")) == {"name": "p\udcff.rbl"}


def test_files_are_added_with_the_folders_that_they_are_in(tmp_path):
    add_files(tmp_path, {"a": b"1", "x/y/b": b"2", "x/c": b"3"})
    assert [(tmp_path / name).read_bytes() for name in ("a", "x/y/b", "x/c")] == [b"1", b"2", b"3"]


def test_of_files_that_cannot_all_be_added_none_is_left(tmp_path):
    (tmp_path / "x").mkdir()
    (tmp_path / "mine").write_bytes(b"mine")
    with small_files(100):
        refused(add_files, tmp_path, {"a": b"1", "x/y/b": b"2", "z/c": bytes(200)})
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["mine", "x"]


def test_a_folder_that_is_a_file_keeps_files_from_being_added(tmp_path):
    (tmp_path / "x").write_bytes(b"mine")
    refused(add_files, tmp_path, {"a": b"1", "x/b": b"2"})
    assert [path.name for path in tmp_path.iterdir()] == ["x"]
