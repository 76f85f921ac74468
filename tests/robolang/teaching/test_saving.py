import errno
import os
import tempfile
import warnings
from dataclasses import replace
from pathlib import Path

import pytest

from robolang.project.points import Point, load_points
from robolang.teaching.cell_document import remove_from_cell, set_frame, set_load, set_tool
from robolang.teaching.names import LOADS
from robolang.teaching.points_document import set_point, taught
from robolang.teaching.renaming import rename_point
from robolang.teaching.saving import ConflictFault, SaveFault
from runtime.cell.cell_file import read_cell_file
from tests.campaign import size
from tests.robolang.cli.commands import BUILTIN
from tests.robolang.core.test_saves import stepped
from tests.robolang.core.test_storage import ordinary_user
from tests.robolang.teaching.desks import POINTS, POSE, PROGRAM, desk, put, refused, remove, teach

CELL = (BUILTIN / "cell.toml").read_text()
COUNT = size(200, 15)


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "P.rbl"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def points(program):
    path = program.with_suffix(".points.toml")
    path.write_text(POINTS)
    return path


# --- two prompts on one file -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("there", [True, False])
def test_points_that_two_prompts_teach_are_all_kept(program, points, first, there):
    if not there:
        points.unlink()
    desks = [desk(program), desk(program)]
    before = set(taught(desks[0].documents).points)
    teach(desks[0], "A1")
    teach(desks[1], "B1")
    teach(desks[0], "A2")
    remove(desks[1], "P2")
    for one in (desks[first], desks[1 - first]):
        assert one.save() == (points,)
    assert load_points(points).names == before - {"P2"} | {"A1", "A2", "B1"}
    last = desks[1 - first]
    assert set(last.taken_over) == ({"A1", "A2"} if first == 0 else {"B1", "P2"})
    assert last.unsaved == ()
    # the first one, which still has its own text, takes the points of the other over when it saves again
    teach(desks[first], "C1")
    desks[first].save()
    assert load_points(points).names == before - {"P2"} | {"A1", "A2", "B1", "C1"}
    if there:
        assert points.read_text().startswith(POINTS[:150])


@pytest.mark.parametrize("there", [True, False])
def test_frames_tools_and_loads_that_two_prompts_make_are_all_kept(program, there):
    cell = program.with_suffix(".cell.toml")
    if there:
        cell.write_text(CELL)
    one, other = desk(program), desk(program)
    one.change(set_frame(one.documents, "pallet", POSE), "teachframe")
    one.change(set_tool(one.documents, "grip", (0, 0, 1, 0, 0, 0)), "teachtool")
    other.change(set_frame(other.documents, "tray", POSE), "teachframe")
    other.change(set_load(other.documents, "box", 1.5, (0, 0, 70)), "weigh")
    other.change(remove_from_cell(other.documents, LOADS, "empty"), "remove")
    one.save()
    other.save()
    assert other.taken_over == ("GRIP", "PALLET")
    found = read_cell_file(cell)
    assert found.frames.keys() == {"WORLD", "pallet", "tray"}
    assert found.loads.keys() == {"hand_and_part", "box"}
    assert found.tools["grip"] == (0, 0, 1, 0, 0, 0)
    assert cell.read_text().startswith(CELL[: CELL.index("[loads.empty]")])
    other.change(set_tool(other.documents, "grip", (0, 0, 2, 0, 0, 0)), "teachtool")
    one.change(set_tool(one.documents, "GRIP", (0, 0, 3, 0, 0, 0)), "teachtool")
    other.save()
    refused("RBL714", one.save)


def test_two_prompts_that_save_at_once_lose_no_point(program, points):
    ready, go = os.pipe()
    children = []
    for letter in "AB":
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", DeprecationWarning
            )  # threads of other libraries; the child runs none of them
            child = os.fork()
        if not child:
            try:
                one = desk(program)
                os.close(go)
                os.read(ready, 1)
                for number in range(COUNT):
                    teach(one, f"{letter}{number}")
                    one.save()
                os._exit(0)
            finally:
                os._exit(1)
        children.append(child)
    os.close(go)  # both begin
    os.close(ready)
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0]
    assert load_points(points).names == {
        "P1",
        "P2",
        *(f"{letter}{number}" for letter in "AB" for number in range(COUNT)),
    }


def test_an_undo_after_a_merge_keeps_what_somebody_else_taught(program, points):
    one, other = desk(program), desk(program)
    teach(one, "A1")
    teach(one, "A2")
    one.undo()
    teach(other, "B1")
    other.save()
    one.save()
    one.undo()
    one.save()
    assert load_points(points).names == {"P1", "P2", "B1"}
    for name in ("A1", "A2"):
        one.redo()
        one.save()
        assert load_points(points).names >= {"P1", "P2", "B1", name}


def test_a_renamed_point_keeps_its_place_in_a_merge(program, points):
    one = desk(program)
    one.change(rename_point(one.documents, "P1", "Above"), "rename P1")
    points.write_text(POINTS.replace("[0, 45", "[1, 45").replace("# The end.", "# The very end."))
    one.save()
    changed = POINTS.replace("[0, 45", "[1, 45").replace("# The end.", "# The very end.")
    assert points.read_text() == changed.replace("points.P1", "points.Above")
    assert "MOVE Above" in program.read_text()


def test_a_point_that_both_changed_is_a_conflict_and_nothing_is_overwritten(program, points):
    one, other = desk(program), desk(program)
    teach(one, "P1", (1, 2, 3, 4, 5, 6))
    put(one, "30 MOVE P2")
    teach(other, "p1", (6, 5, 4, 3, 2, 1))
    other.save()
    theirs, documents = points.read_text(), one.documents
    fault = refused("RBL714", one.save)
    assert isinstance(fault, ConflictFault)
    assert fault.path == points
    assert "+pose = [6, 5, 4, 3, 2, 1]" in fault.theirs
    assert "+pose = [1, 2, 3, 4, 5, 6]" in fault.ours
    assert points.read_text() == theirs
    assert program.read_text() == PROGRAM
    assert one.documents == documents
    assert one.unsaved == (points, program)
    one.save(force=True)
    assert load_points(points).get("P1").pose == (1, 2, 3, 4, 5, 6)


def test_two_prompts_make_the_first_points_file_of_a_cell(program):
    (program.parent / "cell.toml").write_text(CELL)
    one, other = desk(program), desk(program)
    for each, name in ((one, "A1"), (other, "B1")):
        each.change(set_point(each.documents, Point(name=name, pose=POSE), "puma560"), "teach")
    one.save()
    other.save()
    found = load_points(program.with_suffix(".points.toml"))
    assert (found.names, found.robot) == ({"A1", "B1"}, "puma560")


def test_what_is_changed_outside_of_the_points_is_a_conflict(program, points):
    one, other = desk(program), desk(program)
    robot = POINTS.replace("schema = 1", 'schema = 1\nrobot = "puma560"')
    one.change(replace(one.documents, points=robot), "robot")
    teach(other, "B1")
    other.save()
    refused("RBL714", one.save)


def test_the_same_change_of_both_is_no_conflict(program, points):
    one, other = desk(program), desk(program)
    for each in (one, other):
        teach(each, "P1")
        remove(each, "P2")
    teach(other, "B1")
    other.save()
    one.save()
    assert load_points(points).names == {"P1", "B1"}


@pytest.mark.parametrize(
    "text", ["", "schema = 2\n", "schema = 1\n[points.P1]\n", "schema = 1\n[points", None, b"\xff\xfe\x00", b"\0"]
)
def test_what_somebody_else_broke_is_a_conflict(program, points, text):
    one = desk(program)
    teach(one, "A1")
    if text is None:
        points.unlink()
    else:
        points.write_bytes(text.encode() if isinstance(text, str) else text)
    before = points.read_bytes() if text is not None else None
    refused("RBL714", one.save)
    assert (points.read_bytes() if points.exists() else None) == before
    one.save(force=True)
    assert load_points(points).names == {"P1", "P2", "A1"}


def test_a_program_that_somebody_else_changed_is_a_conflict(program, points):
    one = desk(program)
    put(one, "30 MOVE P2")
    teach(one, "A1")
    program.write_text(PROGRAM + "40 DELAY 1\n")
    fault = refused("RBL714", one.save)
    assert fault.path == program
    assert points.read_text() == POINTS
    one.save_as(program.with_name("Q.rbl"))
    assert program.read_text() == PROGRAM + "40 DELAY 1\n"
    assert program.with_name("Q.rbl").read_text() == PROGRAM + "30 MOVE P2\n"


# --- what is written -------------------------------------------------------------------------------------------------


def test_the_program_is_saved_in_its_layout_and_with_an_error_as_it_is_typed(program):
    one = desk(program)
    put(one, "15   delay   1 ' wait")
    put(one, "30 move p1")
    assert one.save() == (program,)
    assert program.read_text() == "10 LOAD (0, 0, 60), 0.8\n15 DELAY 1  ' wait\n20 MOVE P1\n30 MOVE p1\n"
    assert one.documents.program == program.read_text()
    assert [one.lines.of(index) for index in range(4)] == [0, 1, 2, 3]
    assert one.save() == ()
    put(one, "40   move (")
    put(one, "50   delay 1")
    one.save()
    assert program.read_text().endswith("40   move (\n50   delay 1\n")


def test_line_ends_and_byte_order_mark_are_kept(program, points):
    program.write_bytes(b"\xef\xbb\xbf" + PROGRAM.replace("\n", "\r\n").encode())
    points.write_bytes(b"\xef\xbb\xbf" + POINTS.replace("\n", "\r\n").encode())
    one = desk(program)
    put(one, "30 MOVE P2")
    teach(one, "A1")
    teach(one, "P2")
    one.save()
    for path in (program, points):
        raw = path.read_bytes()
        assert raw.startswith(b"\xef\xbb\xbf")
        assert raw.count(b"\n") == raw.count(b"\r\n") > 2
    assert load_points(points).names == {"P1", "P2", "A1"}


def test_a_file_that_an_undo_takes_back_is_removed(program):
    one = desk(program)
    teach(one, "A1")
    one.save()
    one.undo()
    assert [path.name for path in one.unsaved] == ["P.points.toml"]
    one.save()
    assert [path.name for path in program.parent.iterdir()] == ["P.rbl"]


def test_half_a_character_is_refused_at_the_save(program):
    one = desk(program)
    put(one, "30 ' \udcff")
    assert "RBL104" not in one.diff()
    fault = refused("RBL312", one.save)
    assert fault.unsaved == (program,)
    assert program.read_text() == PROGRAM


# --- what cannot be written ------------------------------------------------------------------------------------------


def three(program):
    """A desk on which all three files are changed."""
    one = desk(program)
    teach(one, "A1")
    one.change(set_frame(one.documents, "pallet", POSE), "teachframe")
    put(one, "30 MOVE A1")
    return one


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EIO])
@pytest.mark.parametrize("bad", [0, 1, 2])
def test_a_disk_that_fails_at_a_file_is_reported_with_what_is_saved(program, points, monkeypatch, number, bad):
    one, real, count = three(program), os.replace, []
    cell = program.with_suffix(".cell.toml")

    def replace(*names):
        count.append(names)
        if len(count) == bad + 1:
            raise OSError(number, os.strerror(number))
        real(*names)

    monkeypatch.setattr(os, "replace", replace)
    before = one.documents
    fault = refused("RBL312", one.save)
    assert isinstance(fault, SaveFault)
    files = (points, cell, program)
    assert (fault.saved, fault.unsaved) == (files[:bad], files[bad:])
    assert one.documents == before
    assert one.unsaved == files[bad:]
    old = {points: POINTS, cell: None, program: PROGRAM}
    for path in files[bad:]:
        assert (path.read_text() if path.exists() else None) == old[path]
    monkeypatch.undo()
    assert one.save() == files[bad:]
    assert sorted(path.name for path in program.parent.iterdir()) == ["P.cell.toml", "P.points.toml", "P.rbl"]
    assert {path: path.read_text() for path in files} == one.documents.texts


def test_a_merge_whose_program_cannot_be_written_loses_no_point(program, points, monkeypatch):
    one, other, real = desk(program), desk(program), os.replace
    teach(one, "A1")
    put(one, "30 MOVE A1")
    teach(other, "B1")
    other.save()

    def replace(old, new):
        if Path(new).name == "P.rbl":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(old, new)

    monkeypatch.setattr(os, "replace", replace)
    refused("RBL312", one.save)
    assert load_points(points).names == {"P1", "P2", "A1", "B1"}
    teach(one, "A2")
    monkeypatch.undo()
    assert one.save() == (points, program)
    assert load_points(points).names == {"P1", "P2", "A1", "A2", "B1"}


@pytest.mark.parametrize("what", ["folder gone", "a folder", "a pipe"])
def test_what_cannot_be_written_leaves_the_desk_usable(program, points, what):
    one = three(program)
    if what == "folder gone":
        moved = program.parent.with_name("moved")
        program.parent.rename(moved)
    else:
        points.unlink()
        points.mkdir() if what == "a folder" else os.mkfifo(points)
    before = one.documents
    fault = refused("RBL714", one.save)
    assert fault.message
    assert one.documents == before
    refused("RBL312", one.save, force=True)
    if what == "folder gone":
        moved.rename(program.parent)
    else:
        points.rmdir() if what == "a folder" else points.unlink()
    one.save(force=True)
    assert "A1" in load_points(points).names


@pytest.mark.parametrize("what", ["folder", "file"])
def test_what_is_read_only_stays_as_it_is(what):
    # not in the folder of the test, which is root's alone
    with ordinary_user(), tempfile.TemporaryDirectory() as folder:
        program, points = Path(folder) / "P.rbl", Path(folder) / "P.points.toml"
        program.write_text(PROGRAM)
        points.write_text(POINTS)
        one = three(program)
        bad = program.parent if what == "folder" else points
        bad.chmod(0o555)
        fault = refused("RBL312", one.save)
        assert fault.saved == ()
        assert (points.read_text(), program.read_text()) == (POINTS, PROGRAM)
        bad.chmod(0o755)
        assert len(one.save()) == 3


def test_a_link_outside_is_refused_and_one_inside_stays(program, points, tmp_path_factory):
    inside = points.with_name("real.toml")
    points.rename(inside)
    points.symlink_to(inside.name)
    one = desk(program)
    teach(one, "A1")
    one.save()
    assert points.is_symlink()
    assert load_points(inside).names == {"P1", "P2", "A1"}
    outside = tmp_path_factory.mktemp("other") / "points.toml"
    outside.write_text(POINTS)
    points.unlink()
    points.symlink_to(outside)
    refused("RBL311", desk, program)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
def test_every_call_of_a_save_that_fails_leaves_old_files_and_a_usable_desk(program, points, number):
    cell = program.with_suffix(".cell.toml")
    old = {points: POINTS, cell: None, program: PROGRAM}

    def reset():
        cell.unlink(missing_ok=True)
        points.write_text(POINTS)
        program.write_text(PROGRAM)
        return three(program)

    def there():
        return {path: path.read_text() if path.exists() else None for path in old}

    one = reset()
    with pytest.MonkeyPatch.context() as patch:
        steps = stepped(patch, lambda count, when: None)
        one.save()
    new, names = there(), list(steps)
    failed = set()
    for step in range(1, len(names) + 1):

        def fail(count, when, step=step):
            if count == step and when == "before":
                raise OSError(number, os.strerror(number))

        one = reset()
        before = one.documents
        with pytest.MonkeyPatch.context() as patch:
            stepped(patch, fail)
            try:
                one.save()
                saved = tuple(old)
            except SaveFault as fault:
                saved = fault.saved
                assert (*fault.saved, *fault.unsaved) == tuple(old)
                assert one.unsaved == fault.unsaved
                assert one.documents == before
                failed.add(names[step - 1])
        for path, text in there().items():
            assert text == new[path] if path in saved else text in (old[path], new[path])
        one.save()
        assert there() == new
        assert sorted(path.name for path in program.parent.iterdir()) == sorted(path.name for path in old)
    assert {"mkstemp", "write", "fsync", "replace"} <= failed
