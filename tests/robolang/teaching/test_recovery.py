import fcntl
import hashlib
import json
import os
import signal
import stat

import pytest

from robolang.core.claim import claim, is_claimed
from robolang.project.points import load_points
from robolang.teaching.recovery import Recovery, RecoveryFault, discard, pending_recovery, recover
from robolang.teaching.saving import ConflictFault
from tests.robolang.core.test_saves import in_a_child, stepped
from tests.robolang.teaching.desks import POINTS, PROGRAM, desk, put, refused, teach


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "P.rbl"
    path.write_text(PROGRAM)
    path.with_suffix(".points.toml").write_text(POINTS)
    return path


def names(program):
    return sorted(path.name for path in program.parent.iterdir())


def changed(program, name="A1"):
    one = desk(program)
    teach(one, name)
    put(one, f"30 MOVE {name}")
    return one


def killed(program, work=lambda kept, one: None, name="A1"):
    """Keep changes in a process of its own, which is then killed."""

    def prompt():
        kept, one = Recovery(), changed(program, name)
        kept.keep(one)
        work(kept, one)
        os.kill(os.getpid(), signal.SIGKILL)

    in_a_child(prompt)


def test_changes_of_a_prompt_that_was_killed_are_offered_and_recovered(program):
    killed(program)
    assert names(program) == [".P.rbl.lock", ".P.rbl.recover", "P.points.toml", "P.rbl"]
    assert stat.S_IMODE((program.parent / ".P.rbl.recover").stat().st_mode) == 0o600
    pending = pending_recovery(program)
    assert [path.name for path in pending.paths] == ["P.points.toml", "P.rbl"]
    assert pending.diff() == changed(program).diff()
    assert pending.documents == changed(program).documents
    one = recover(pending)
    kept = Recovery(pending)
    one.save()
    kept.keep(one)
    assert names(program) == ["P.points.toml", "P.rbl"]
    assert load_points(program.with_suffix(".points.toml")).names == {"P1", "P2", "A1"}
    assert program.read_text() == PROGRAM + "30 MOVE A1\n"
    assert pending_recovery(program) is None


def test_changes_are_recovered_from_another_folder(program, monkeypatch, tmp_path_factory):
    (program.parent / "cell.toml").write_text("# mine\n")
    killed("P.rbl" and program)
    monkeypatch.chdir(tmp_path_factory.mktemp("other"))
    pending = pending_recovery(program)
    assert pending.documents.cell_path == program.with_name("cell.toml")
    assert len(recover(pending).unsaved) == 2


def test_a_desk_without_unsaved_changes_leaves_no_file(program):
    one, kept = desk(program), Recovery()
    kept.keep(one)
    teach(one, "A1")
    kept.keep(one)
    assert kept.file.name == ".P.rbl.recover"
    one.undo()
    kept.keep(one)
    teach(one, "A1")
    kept.keep(one)
    one.save()
    kept.keep(one)
    assert names(program) == ["P.points.toml", "P.rbl"]


def test_a_recovery_of_a_prompt_that_runs_is_not_offered(program):
    one, kept = changed(program), Recovery()
    kept.keep(one)
    assert pending_recovery(program) is None
    second, other = changed(program, "B1"), Recovery()
    other.keep(second)
    assert other.file.name == ".P.rbl.2.recover"
    kept.close()
    assert pending_recovery(program) is None
    other.close()
    assert names(program) == ["P.points.toml", "P.rbl"]


def test_changes_that_wait_for_a_decision_are_not_overwritten(program):
    killed(program)
    one, kept = changed(program, "B1"), Recovery()
    kept.keep(one)
    assert kept.file.name == ".P.rbl.2.recover"
    assert "A1" in pending_recovery(program).documents.points
    kept.close()
    discard(pending_recovery(program).file)
    assert pending_recovery(program) is None


def test_the_file_follows_the_name_of_the_program(program):
    one, kept = changed(program), Recovery()
    kept.keep(one)
    one.save_as(program.with_name("Q.rbl"))
    teach(one, "B1")
    kept.keep(one)
    assert kept.file.name == ".Q.rbl.recover"
    assert not (program.parent / ".P.rbl.recover").exists()


def test_what_changed_on_the_disk_since_is_merged_or_a_conflict(program):
    points = program.with_suffix(".points.toml")
    killed(program)
    other = desk(program)
    teach(other, "B1")
    other.save()
    one = recover(pending_recovery(program))
    one.save()
    assert load_points(points).names == {"P1", "P2", "A1", "B1"}
    points.write_text(POINTS)
    program.write_text(PROGRAM)
    (program.parent / ".P.rbl.recover").unlink()
    killed(program)
    program.write_text(PROGRAM + "40 DELAY 1\n")
    assert isinstance(refused("RBL714", recover(pending_recovery(program)).save), ConflictFault)


def test_a_program_without_a_name_is_recovered(program):
    def prompt():
        one = desk(None)
        teach(one, "A1")
        Recovery().keep(one)
        kept = Recovery()
        kept.keep(one)
        os.kill(os.getpid(), signal.SIGKILL)

    in_a_child(prompt)
    pending = pending_recovery()
    assert not pending.documents.named
    assert [path.name for path in pending.paths] == ["unnamed.points.toml"]
    refused("RBL716", recover(pending).save)


def sealed(content, schema=1):
    body = json.dumps(content)
    return f'{{"schema": {schema}, "sha256": "{hashlib.sha256(body.encode()).hexdigest()}", "content": {body}}}'


def damage(program):
    killed(program)
    file = program.parent / ".P.rbl.recover"
    good = file.read_bytes()
    content = json.loads(good)["content"]
    yield from (good[:size] for size in range(0, len(good) - 1, max(1, len(good) // 40)))
    yield good.replace(b"450", b"451")
    yield from (b"[]", b"null", b"7", b"\xff\xfe", b"[" * 100_000, sealed(content, 2).encode(), sealed([]).encode())
    for key in content:
        yield sealed({name: value for name, value in content.items() if name != key}).encode()
        yield sealed({**content, key: 7}).encode() if key != "named" else b"{}"
    yield sealed({**content, "texts": {**content["texts"], "program": 7}}).encode()


def test_a_damaged_file_is_reported_and_stays(program):
    file = program.parent / ".P.rbl.recover"
    for raw in damage(program):
        file.write_bytes(raw)
        fault = refused("RBL719", pending_recovery, program)
        assert isinstance(fault, RecoveryFault)
        assert fault.file == file
        assert file.read_bytes() == raw
        kept = Recovery()
        kept.keep(changed(program))
        assert kept.file.name == ".P.rbl.2.recover"
        kept.close()
    discard(fault.file)
    assert pending_recovery(program) is None


@pytest.mark.parametrize("kind", ["folder", "pipe", "link"])
def test_what_is_no_file_is_reported(program, kind):
    file = program.parent / ".P.rbl.recover"
    {"folder": file.mkdir, "pipe": lambda: os.mkfifo(file), "link": lambda: file.symlink_to("P.rbl")}[kind]()
    refused("RBL719", pending_recovery, program)


def test_a_folder_that_is_gone_is_reported_and_the_desk_stays(program):
    one, kept = changed(program), Recovery()
    program.parent.rename(program.parent.with_name("gone"))
    refused("RBL706", kept.keep, one)
    assert len(one.unsaved) == 2
    program.parent.with_name("gone").rename(program.parent)
    kept.keep(one)
    assert kept.file.name == ".P.rbl.recover"


def test_a_kill_while_changes_are_kept_leaves_the_old_ones_or_the_new(program):
    for moment, found in (("before", False), ("after", True)):

        def more(kept, one, moment=moment):
            def kill(number, when):
                if steps[-1] == "replace" and when == moment:
                    os.kill(os.getpid(), signal.SIGKILL)

            teach(one, "A2")
            with pytest.MonkeyPatch.context() as patch:
                steps = stepped(patch, kill)
                kept.keep(one)

        killed(program, more)
        pending = pending_recovery(program)
        assert ("A2" in pending.documents.points) == found
        discard(pending.file)


def test_a_lock_file_that_is_removed_before_it_is_locked_is_made_anew(tmp_path, monkeypatch):
    path, real = tmp_path / "lock", fcntl.flock

    def flock(handle, how):
        monkeypatch.undo()
        path.unlink()
        real(handle, how)

    monkeypatch.setattr(fcntl, "flock", flock)
    held = claim(path)
    assert claim(path) is None
    held.release()


def test_a_name_is_held_by_one_process_at_a_time(tmp_path):
    path = tmp_path / "lock"
    held = claim(path)
    assert claim(path) is None
    assert is_claimed(path)
    held.release()
    held.release()
    assert not is_claimed(path)
    path.write_text("left over")
    assert not is_claimed(path)
    assert not path.exists()
    path.symlink_to("elsewhere")
    with pytest.raises(OSError):
        claim(path)
    assert not is_claimed(path)
