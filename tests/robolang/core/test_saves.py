"""Saves that are cut off (attack_11): the process is killed before and after each system call, or the call fails.

Every call that ``robolang.core.storage`` makes of ``os``, ``fcntl`` and ``tempfile`` while it saves is a step. In
each crash state the file is the old or the new text, as private as it was, and the next save leaves nothing else in
the folder.
"""

import errno
import fcntl
import os
import signal
import stat
import tempfile
import warnings
from pathlib import Path

import pytest

from robolang.core import storage
from robolang.core.storage import write_atomic, write_folder
from runtime.core.faults import Fault
from tests.campaign import some
from tests.robolang.cli.commands import robolang

OLD = "10  move P1  ' noqa: RBL119\n20 DELAY 1\n"
COMMANDS = {
    "fmt": ("fmt", "P.rbl"),
    "renumber": ("renumber", "--start", "100", "P.rbl"),
    "fix": ("check", "--fix", "--exit-zero", "P.rbl"),
}
FULL = (errno.ENOSPC, errno.EIO, errno.EROFS)
STEPS = {
    os: ("open", "close", "fsync", "fstat", "fchmod", "fchown", "replace", "unlink", "scandir", "fdopen"),
    fcntl: ("flock",),
    tempfile: ("mkstemp",),
}


class Steps:
    """Stands for a module: its calls are counted, and at one of them something happens before or after."""

    def __init__(self, module, count, act):
        self._module, self._count, self._act = module, count, act

    def __getattr__(self, name):
        value = getattr(self._module, name)
        if name not in STEPS[self._module]:
            return value

        def step(*args, **kwargs):
            self._count.append(name)
            self._act(len(self._count), "before")
            result = value(*args, **kwargs)
            self._act(len(self._count), "after")
            return Stream(result, self) if name == "fdopen" else result

        return step

    def wrote(self, stream, data):
        self._count.append("write")
        self._act(len(self._count), "before")
        stream.write(data[: len(data) // 2])
        stream.flush()
        self._act(len(self._count), "after")
        return stream.write(data[len(data) // 2 :])


class Stream:
    """A stream whose ``write`` is a step: the first half of the data is on the disk when it is cut off."""

    def __init__(self, stream, steps):
        self._stream, self._steps = stream, steps

    def write(self, data):
        return self._steps.wrote(self._stream, data)

    def __enter__(self):
        return self

    def __exit__(self, *problem):
        return self._stream.__exit__(*problem)


def stepped(monkeypatch, act):
    """Count the steps of all saves from here on; returns their names as they come."""
    count = []
    for module in STEPS:
        monkeypatch.setattr(storage, module.__name__, Steps(module, count, act))
    return count


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "P.rbl"
    path.write_text(OLD)
    path.chmod(0o600)
    return path


def saved(command, program):
    """The text that a command gives, and the steps of its save."""
    with pytest.MonkeyPatch.context() as patch:
        names = stepped(patch, lambda number, when: None)
        robolang(*COMMANDS[command])
    text = program.read_text()
    assert text != OLD
    return text, names


def killed(words, step, moment):
    """Run a command in a process of its own, killed at a step."""

    def kill(number, when):
        if (number, when) == (step, moment):
            os.kill(os.getpid(), signal.SIGKILL)

    def command():
        with pytest.MonkeyPatch.context() as patch:
            stepped(patch, kill)
            robolang(*words)

    in_a_child(command)


def in_a_child(call):
    """Call a function in a process of its own, which must be killed before the function returns."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of other libraries; the child runs none of them
        child = os.fork()
    if not child:
        try:
            call()
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL


@pytest.mark.parametrize("command", some(list(COMMANDS), 0))
def test_a_save_that_is_killed_leaves_the_old_file_or_the_new_one(command, program):
    new, names = saved(command, program)
    assert {"mkstemp", "write", "fchmod", "fsync", "replace"} <= set(names)
    assert names.index("fchmod") < names.index("fsync") < names.index("replace")
    assert "fsync" in names[names.index("replace") :]  # of the folder
    texts = set()
    states = [(step, "after") for step in range(1, len(names) + 1)]  # after a step is before the next one
    for step, moment in [(1, "before"), *states, (names.index("write") + 2, "before")]:
        program.write_text(OLD)
        killed(COMMANDS[command], step, moment)
        texts.add(program.read_text())
        for path in program.parent.iterdir():
            assert stat.S_IMODE(path.stat().st_mode) == 0o600, (path, step, moment)
        program.write_text(OLD)
        write_atomic(program, lambda stream: stream.write(new.encode()))
        assert [path.name for path in program.parent.iterdir()] == ["P.rbl"]
        assert program.read_text() == new
    assert texts == {OLD, new}


@pytest.mark.parametrize(("command", "number"), list(zip(COMMANDS, FULL, strict=True)))
def test_a_save_in_which_a_call_fails_leaves_the_old_file(command, program, number):
    new, names = saved(command, program)
    after = names.index("replace") + 1
    for step in range(1, len(names) + 1):
        program.write_text(OLD)

        def fail(count, when, step=step):
            if count == step and when == "before":
                raise OSError(number, os.strerror(number))

        tolerated = names[step - 1] in ("scandir", "flock")  # what is not cleared, or not locked, is left as it is
        with pytest.MonkeyPatch.context() as patch:
            stepped(patch, fail)
            result = robolang(*COMMANDS[command], code=0 if tolerated else 4)
        assert tolerated or "RBL706" in result.stderr
        assert program.read_text() == (new if tolerated or step > after else OLD), names[step - 1]
        assert stat.S_IMODE(program.stat().st_mode) == 0o600
        assert [path.name for path in program.parent.iterdir()] == ["P.rbl"], names[step - 1]


def test_a_save_that_the_disk_does_not_confirm_says_so(program, monkeypatch):
    def fail(number, when):
        if when == "before" and steps[-1] == "fsync" and "replace" in steps:
            raise OSError(errno.EIO, os.strerror(errno.EIO))

    steps = stepped(monkeypatch, fail)
    with pytest.raises(Fault, match="confirmed") as caught:
        write_atomic(program, lambda stream: stream.write(b"new"))
    assert caught.value.code == "RBL706"


def test_a_temporary_file_that_another_process_writes_is_left_alone(program):
    with storage._temporary(program.parent) as (_, name):
        write_atomic(program, lambda stream: stream.write(b"new"))
        assert sorted(path.name for path in program.parent.iterdir()) == sorted(["P.rbl", Path(name).name])
        (program.parent / ".robolang-notes").write_text("mine")
        (program.parent / ".robolang-config.tmp").write_text("mine")
    os.utime(name)  # it is still there: nobody renamed it
    write_atomic(program, lambda stream: stream.write(b"new"))
    assert sorted(path.name for path in program.parent.iterdir()) == [
        ".robolang-config.tmp",
        ".robolang-notes",
        "P.rbl",
    ]


def test_a_new_temporary_file_that_was_taken_for_a_rest_is_made_anew(program, monkeypatch):
    real, made = tempfile.mkstemp, []

    def mkstemp(**options):
        handle, name = real(**options)
        made.append(name)
        if len(made) == 1:
            Path(name).unlink()
        return handle, name

    monkeypatch.setattr(tempfile, "mkstemp", mkstemp)
    write_atomic(program, lambda stream: stream.write(b"new"))
    assert len(made) == 2
    assert program.read_text() == "new"


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o604, 0o755])
def test_a_file_keeps_its_mode(program, mode):
    program.chmod(mode)
    robolang("fmt", "P.rbl")
    assert stat.S_IMODE(program.stat().st_mode) == mode


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files away")
def test_a_file_keeps_its_owner_where_this_user_may_give_files_away(program, monkeypatch):
    os.chown(program, 4321, 8765)
    program.chmod(0o660)
    robolang("fmt", "P.rbl")
    assert (program.stat().st_uid, program.stat().st_gid) == (4321, 8765)
    assert stat.S_IMODE(program.stat().st_mode) == 0o660

    def fchown(handle, uid, gid):
        raise PermissionError(errno.EPERM, "no")

    monkeypatch.setattr(os, "fchown", fchown)
    write_atomic(program, lambda stream: stream.write(b"new"))
    assert program.stat().st_gid == os.getegid()
    assert stat.S_IMODE(program.stat().st_mode) == 0o600  # this group was not one that might read it


@pytest.mark.parametrize("command", COMMANDS)
def test_a_link_stays_and_a_further_name_keeps_the_old_text(command, program):
    new, _ = saved(command, program)
    program.write_text(OLD)
    (program.parent / "folder").mkdir()
    os.link(program, "other.rbl")
    program.rename("folder/real.rbl")
    program.symlink_to("folder/real.rbl")
    robolang(*COMMANDS[command])
    assert program.is_symlink()
    assert Path("folder/real.rbl").read_text() == new
    assert Path("other.rbl").read_text() == OLD
    assert sorted(os.listdir()) == ["P.rbl", "folder", "other.rbl"]
    assert os.listdir("folder") == ["real.rbl"]


def test_a_program_that_somebody_else_writes_is_left_alone(program, monkeypatch):
    from robolang.syntax import formatter, renumber

    for module, name, command in ((formatter, "format_source", "fmt"), (renumber, "renumber", "renumber")):
        real = getattr(module, name)

        def meanwhile(source, real=real, **options):
            program.write_text("MOVE P2\n")
            return real(source, **options)

        program.write_text(OLD)
        with monkeypatch.context() as patch:
            patch.setattr(module, name, meanwhile)
            assert "RBL706" in robolang(*COMMANDS[command], code=4).stderr
        assert program.read_text() == "MOVE P2\n"


def test_what_a_killed_process_left_of_a_folder_is_removed(tmp_path):
    left = tmp_path / ".robolang-abcdefgh.tmp"
    left.mkdir()
    (left / "manifest.json").write_text("half")
    write_folder(tmp_path / "x", {"manifest.json": b"new"}, lambda name: True)
    assert [path.name for path in tmp_path.iterdir()] == ["x"]


@pytest.mark.parametrize("moment", ["before", "after"])
def test_a_folder_that_is_killed_is_the_old_one_or_the_new_one(tmp_path, moment):
    folder, real = tmp_path / "x", storage._exchange
    write_folder(folder, {"manifest.json": b"old"}, lambda name: True)

    def exchange(one, other):
        if moment == "after":
            real(one, other)
        os.kill(os.getpid(), signal.SIGKILL)

    def replaced():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(storage, "_exchange", exchange)
            write_folder(folder, {"manifest.json": b"new"}, lambda name: True)

    in_a_child(replaced)
    assert (folder / "manifest.json").read_bytes() == (b"old" if moment == "before" else b"new")
    write_folder(folder, {"manifest.json": b"newer"}, lambda name: True)
    assert [path.name for path in tmp_path.iterdir()] == ["x"]
