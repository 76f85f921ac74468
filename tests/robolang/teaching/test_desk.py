import pytest

from robolang.project.points import load_points
from robolang.project.project import load_project
from robolang.teaching.cell_document import set_frame, set_load, set_tool
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.teaching.points_document import remove_point
from robolang.teaching.program_document import insert_line, put_line
from robolang.teaching.renaming import rename_point
from tests.robolang.cli.commands import BUILTIN
from tests.robolang.teaching.desks import POSE, PROGRAM, desk, put, refused, teach

CELL = (BUILTIN / "cell.toml").read_text()


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "P.rbl"
    path.write_text(PROGRAM)
    return path


def test_what_is_typed_is_checked_as_if_it_were_saved(program):
    one = desk(program)
    teach(one, "P9")
    one.change(set_frame(one.documents, "pallet", POSE), "teachframe pallet")
    one.change(set_tool(one.documents, "long", (0, 0, 200, 0, 0, 0)), "teachtool long")
    one.change(set_load(one.documents, "box", 1.25, (0, 0, 60)), "weigh")
    for line in ("20", "30 FRAME pallet", "40 TOOL long", "50 LOAD box", "60 MOVE P9"):
        put(one, line)
    typed = load_project(one.typed)
    assert sorted(path.name for path in program.parent.iterdir()) == ["P.rbl"]
    assert [path.name for path in one.save()] == ["P.points.toml", "P.cell.toml", "P.rbl"]
    saved = load_project(program)
    assert typed.diagnostics == saved.diagnostics == ()
    assert typed.analysis.source == saved.analysis.source
    assert typed.points == saved.points
    assert typed.cell.frames.keys() == saved.cell.frames.keys() == {"WORLD", "pallet"}
    assert typed.points.names == {"P1", "P2", "P3", "P4", "P5", "P9"}
    assert one.unsaved == ()


def test_a_typed_file_hides_the_one_on_the_disk(program):
    (program.parent / "P.points.toml").write_text("schema = 1\n[points.P1]\npose = [1, 2, 3, 4, 5, 6]\n")
    (program.parent / "cell.toml").write_text(CELL)
    one = desk(program)
    one.change(remove_point(one.documents, "P1"), "del P1")
    assert [item.code for item in load_project(one.typed).diagnostics] == ["RBL301"]
    assert load_project(program).ok


def test_an_error_in_a_typed_file_is_at_its_place(program):
    (program.parent / "cell.toml").write_text(CELL.replace("mass_kg = 1.5", "mass_kg = -1.5"))
    (program.parent / "P.points.toml").write_text("schema = 1\n[points.P1]\npose = [1, 2, 3, 4, 5]\n")
    found = desk(program)
    (program.parent / "cell.toml").write_text("")
    (program.parent / "P.points.toml").write_text("")
    fault = refused("RBL605", load_project, found.typed)
    assert [(each.code, each.path, each.line) for each in fault.all] == [
        ("RBL605", str(program.parent / "cell.toml"), 30),
        ("RBL307", str(program.parent / "P.points.toml"), 3),
    ]


def test_changes_are_taken_back_and_made_again(program):
    one = desk(program)
    first = one.documents
    teach(one, "P9")
    one.change(insert_line(one.documents, 1, "5 DELAY 1")[0], "5 DELAY 1")
    last = one.documents
    assert one.lines.of(1) == 2
    assert one.undo() == "5 DELAY 1"
    assert (one.lines.of(0), one.lines.of(1)) == (None, 0)
    assert one.undo() == "teach P9"
    assert one.documents == first
    assert one.unsaved == ()
    assert one.diff() == ""
    refused("RBL715", one.undo)
    assert [one.redo(), one.redo()] == ["teach P9", "5 DELAY 1"]
    assert one.documents == last
    refused("RBL715", one.redo)
    one.undo()
    teach(one, "P8")
    refused("RBL715", one.redo)


def test_the_analysis_follows_every_change(program):
    one = desk(program)
    for line in ("15 DELAY 1", "20", "12 x = 1", "15 DELAY x"):
        put(one, line)
        assert one.analysis.source == one.documents.source
        assert one.analysis.program == Desk(one.documents).analysis.program
    one.undo()
    assert one.analysis.source == one.documents.source


def test_a_program_without_a_name_is_saved_under_one(program):
    (program.parent / "unnamed.points.toml").write_text("another program's")
    one = Desk(load_documents())
    assert (one.documents.named, one.documents.points, one.unsaved) == (False, None, ())
    one.change(put_line(one.documents, "10 move p1")[0], "10")
    teach(one, "P9")
    refused("RBL716", one.save)
    refused("RBL706", one.save_as, program)
    assert not one.documents.named
    assert [path.name for path in one.save_as(program.parent / "Q")] == ["Q.points.toml", "Q.rbl"]
    assert (program.parent / "Q.rbl").read_text() == "10 MOVE p1\n"
    assert load_points(program.parent / "Q.points.toml").names >= {"P1", "P9"}
    assert one.undo() == "teach P9"
    assert one.documents.path.name == "Q.rbl"


def test_a_point_is_renamed_in_all_files(program):
    one = desk(program)
    one.change(rename_point(one.documents, "p1", "Above"), "rename")
    assert one.documents.program == "10 LOAD (0, 0, 60), 0.8\n20 MOVE Above\n"
    assert load_project(one.typed).diagnostics == ()
    refused("RBL718", rename_point, one.documents, "Above", "P2")
    refused("RBL718", rename_point, one.documents, "Above", "MOVE")
    refused("RBL301", rename_point, one.documents, "P1", "P9")
