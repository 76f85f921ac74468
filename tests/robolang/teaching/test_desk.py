from pathlib import Path

import pytest

from robolang.lint.engine import check_points, check_source
from robolang.project.discovery import CellFiles
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
    (program.parent / "P.points.toml").write_text("schema = 1\n[points.P1]\njoints = [1, 2, 3, 4, 5]\n")
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
    (program.parent / "unnamed.cell.toml").write_text("another program's")
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


def test_a_program_without_a_name_runs_in_the_cell_of_its_folder(program):
    for name in ("unnamed.cell.toml", "cell.toml"):
        (program.parent / name).write_text(CELL + f"# {name}\n")
    one = Desk(load_documents())
    assert one.documents.cell == CELL + "# cell.toml\n"
    assert one.documents.cell_path == Path("cell.toml")


def test_a_point_is_renamed_in_all_files(program):
    one = desk(program)
    one.change(rename_point(one.documents, "p1", "Above"), "rename")
    assert one.documents.program == "10 LOAD (0, 0, 60), 0.8\n20 MOVE Above\n"
    assert load_project(one.typed).diagnostics == ()
    refused("RBL718", rename_point, one.documents, "Above", "P2")
    refused("RBL718", rename_point, one.documents, "Above", "MOVE")
    refused("RBL301", rename_point, one.documents, "P1", "P9")


def test_lint_checks_typed_files_as_those_on_the_disk(program):
    one = desk(program)
    teach(one, "P9")
    put(one, "30 MOVE P8")
    files = CellFiles(one.documents.texts)
    checked = check_source(one.documents.source, files=files)
    found = [item.code for item in checked.diagnostics], check_points(checked, files=files)
    one.save()
    checked = check_source(one.documents.source)
    assert [item.code for item in checked.diagnostics] == found[0] == ["RBL301"]
    assert check_points(checked).diagnostics == found[1].diagnostics
    assert len(found[1].diagnostics) == 5


# --- which files a program has ---------------------------------------------------------------------------------------


def test_what_cannot_be_read_is_refused_at_the_start(program):
    refused("RBL701", load_documents, program.with_name("Q.rbl"))
    refused("RBL702", load_documents, program.parent)
    refused("RBL600", load_documents, program, program.with_name("other.toml"))
    program.with_suffix(".points.toml").symlink_to("nowhere")
    refused("RBL302", load_documents, program)
    program.with_suffix(".points.toml").unlink()
    program.with_suffix(".points.toml").write_bytes(b"\xff")
    refused("RBL311", load_documents, program)
    program.write_bytes(b"\xff")
    refused("RBL104", load_documents, program)


@pytest.mark.parametrize("beside", ["P.cell.toml", "cell.toml", "given.toml"])
def test_a_cell_file_is_edited_where_it_is(program, beside):
    path = program.with_name(beside)
    path.write_text(CELL)
    one = Desk(load_documents(program, path if beside == "given.toml" else None))
    one.change(set_frame(one.documents, "pallet", POSE), "teachframe")
    assert load_project(one.typed).cell.frames.keys() == {"WORLD", "pallet"}
    assert one.save() == (path,)
    assert load_project(program, cell=path).cell.frames.keys() == {"WORLD", "pallet"}


# --- another name ----------------------------------------------------------------------------------------------------


def moved(program, name, cell=None):
    """What a program is saved as, and the folder then."""
    one = Desk(load_documents(program, cell))
    teach(one, "P9")
    one.save_as(program.parent / name)
    before, after = load_project(program, cell=cell), load_project(one.documents.path, cell=cell)
    assert [part.name for part in after.cell.parts] == [part.name for part in before.cell.parts]
    assert after.cell.frames.keys() == before.cell.frames.keys()
    assert after.ok
    assert one.unsaved == ()
    return one, sorted(path.name for path in one.documents.path.parent.iterdir() if path.name[0] in "Qc")


@pytest.mark.parametrize(
    ("beside", "name", "there"),
    [
        (None, "Q.rbl", ["Q.points.toml", "Q.rbl"]),
        ("P.cell.toml", "Q.rbl", ["Q.cell.toml", "Q.points.toml", "Q.rbl"]),
        ("cell.toml", "Q", ["Q.points.toml", "Q.rbl", "cell.toml"]),
        ("cell.toml", "sub/Q.rbl", ["Q.cell.toml", "Q.points.toml", "Q.rbl"]),
        ("given.toml", "sub/Q.rbl", ["Q.points.toml", "Q.rbl"]),
    ],
)
def test_a_program_under_another_name_runs_in_the_same_cell(program, beside, name, there):
    (program.parent / "sub").mkdir()
    if beside:
        program.with_name(beside).write_text(f"{CELL}\n[frames.f]\npose_mm_deg = [1, 2, 3, 4, 5, 6]\n")
        program.with_suffix(".points.toml").write_text(
            "schema = 1\n[points.P1]\npose = [480, -220, 840, 180, 0, 180]\n"
        )
    one, found = moved(program, name, program.with_name(beside) if beside == "given.toml" else None)
    assert found == there
    assert program.read_text() == PROGRAM
    assert one.undo() == "teach P9"
    assert one.documents.path.name == "Q.rbl"
    assert one.unsaved == (one.documents.points_path,)


def test_the_built_in_cell_goes_along_into_a_folder_with_another_cell(program):
    (program.parent / "sub").mkdir()
    (program.parent / "sub" / "cell.toml").write_text(CELL.replace('name = "part"', 'name = "other"'))
    _, found = moved(program, "sub/Q.rbl")
    assert found == ["Q.cell.toml", "Q.points.toml", "Q.rbl", "cell.toml"]


def test_a_name_that_is_taken_and_a_folder_that_is_not_there(program):
    one = desk(program)
    teach(one, "P9")
    before = one.documents
    program.with_name("Q.points.toml").write_text("mine")
    refused("RBL706", one.save_as, program.with_name("Q.rbl"))
    refused("RBL312", one.save_as, program.parent / "nowhere" / "Q.rbl")
    assert (one.documents, one.unsaved) == (before, (before.points_path,))
    assert program.with_name("Q.points.toml").read_text() == "mine"
    one.save_as(program.with_name("Q.rbl"), force=True)
    assert load_points(program.with_name("Q.points.toml")).names >= {"P9"}
    assert not program.with_suffix(".points.toml").exists()
    for name in ("", "..", ".", "/", "a\0b", "a\0b.rbl", str(program.parent)):
        refused("RBL706", one.save_as, Path(name))
    refused("RBL312", one.save_as, program.with_name("x" * 300))
    assert one.save_as(program.with_name("station.2"))[-1].name == "station.2.rbl"
    assert one.save_as(program.with_name("Q.rbl"), force=True)
    # the name that it has: saved as always
    teach(one, "P8")
    assert [path.name for path in one.save_as(program.with_name("Q.rbl"))] == ["Q.points.toml"]


def test_a_text_that_could_not_be_read_again_is_not_saved(program):
    one = desk(program)
    put(one, "30 ' " + "x" * 9_000)
    for number in range(200, 320):
        put(one, f"{number} ' " + "x" * 9_000)
    refused("RBL312", one.save)
    assert program.read_text() == PROGRAM
    one.undo()
