import pytest

from robolang.project.project import load_project
from robolang.teaching.cell_document import (
    cell_of,
    remove_from_cell,
    set_frame,
    set_load,
    set_tool,
)
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.teaching.names import FRAMES, LOADS, TOOLS
from robolang.teaching.points_document import set_point, taught
from robolang.teaching.renaming import rename_of_cell
from tests.robolang.cli.commands import BUILTIN
from tests.robolang.teaching.desks import POSE, refused

CELL = (BUILTIN / "cell.toml").read_text()
PROGRAM = """\
10 TOOL grip
20 LOAD hand_and_part
30 FRAME pallet
40 MOVE P1
50 GOSUB 100
60 END
100 grip = 1
110 RETURN
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "P.rbl"
    path.write_text(PROGRAM)
    return path


def test_the_first_change_makes_a_cell_file_of_the_built_in_cell(program):
    new = set_frame(load_documents(program), "pallet", (1, 2, 3 + 1e-4 / 3, 0, -0.0, 45 - 1e-4 / 3))
    assert new.cell == f"{CELL}\n[frames.pallet]\npose_mm_deg = [1, 2, 3, 0, 0, 45]\n"
    assert new.cell_path == program.with_name("P.cell.toml")
    # the built-in points belong to the built-in cell alone
    assert taught(new).names == {"P1", "P2", "P3", "P4", "P5"}
    assert load_project(new.typed()).cell.frames.keys() == {"WORLD", "pallet"}


def test_a_cell_file_that_is_there_keeps_all_other_bytes(program):
    (program.parent / "cell.toml").write_text(CELL)
    found = load_documents(program)
    assert (found.points, found.cell_path) == (None, program.with_name("cell.toml"))
    new = set_tool(found, "GRIP", (0, 0, 120.5, 0, 0, 0))
    assert new.cell == CELL.replace("[0, 0, 113.7, 0, 0, 0]\n", "[0, 0, 120.5, 0, 0, 0]\n").replace(
        "tcp_mm_deg = [0, 0, 120.5", "tcp_mm_deg = [0, 0, 113.7"
    )
    new = set_load(found, "empty", 0.8123 + 1e-5 / 3, (0, 0, 61))
    assert new.cell == CELL.replace(
        "mass_kg = 0.8\ncog_mm = [0, 0, 60]\n\n", "mass_kg = 0.8123\ncog_mm = [0, 0, 61]\n\n"
    )
    assert new.points is None
    new = set_load(found, "box", 2, (1, 2, 3))
    assert new.cell == CELL.replace("0, 95]\n", "0, 95]\n\n[loads.box]\nmass_kg = 2\ncog_mm = [1, 2, 3]\n")
    assert remove_from_cell(new, LOADS, "BOX").cell == CELL


@pytest.mark.parametrize(
    ("code", "edit"),
    [
        ("RBL718", lambda found: set_frame(found, "a b", POSE)),
        ("RBL718", lambda found: set_frame(found, "FRAME", POSE)),
        ("RBL610", lambda found: set_frame(found, "world", POSE)),
        ("RBL605", lambda found: set_tool(found, "x", (1e6, 0, 0, 0, 0, 0))),
        ("RBL604", lambda found: set_tool(found, "x", (float("nan"), 0, 0, 0, 0, 0))),
        ("RBL613", lambda found: set_tool(found, "x", (0, 0, 0))),
        ("RBL605", lambda found: set_load(found, "x", -1.0, (0, 0, 0))),
        ("RBL305", lambda found: remove_from_cell(found, FRAMES, "x")),
        ("RBL305", lambda found: rename_of_cell(found, TOOLS, "x", "y")),
        ("RBL718", lambda found: rename_of_cell(found, LOADS, "empty", "hand_and_part")),
        ("RBL718", lambda found: rename_of_cell(found, TOOLS, "grip", "MOVE")),
    ],
)
def test_what_a_cell_cannot_have_is_refused(program, code, edit):
    refused(code, edit, load_documents(program))


def test_a_damaged_cell_is_left_alone(program):
    (program.parent / "cell.toml").write_text(CELL.replace("mass_kg = 2.3", "mass_kg = 'x'"))
    fault = refused("RBL613", set_frame, load_documents(program), "x", POSE)
    assert (fault.path, fault.line) == (str(program.parent / "cell.toml"), 39)
    (program.parent / "cell.toml").write_text(f"tools = {{}}\n{CELL.partition('[tools.grip]')[0]}")
    fault = refused("RBL601", set_tool, load_documents(program), "x", POSE)
    assert fault.line == 1


def test_a_frame_is_renamed_in_cell_points_and_program_where_it_is_meant(program):
    desk = Desk(set_frame(load_documents(program), "pallet", POSE))
    point = taught(desk.documents).get("P1")
    desk.change(set_point(desk.documents, point.replaced(frame="PALLET")), "teach")
    refused("RBL305", remove_from_cell, desk.documents, FRAMES, "pallet")
    new = rename_of_cell(desk.documents, FRAMES, "pallet", "tray")
    assert new.program == PROGRAM.replace("pallet", "tray")
    assert taught(new).get("P1").frame == "tray"
    assert cell_of(new).frames.keys() == {"WORLD", "tray"}
    # here the name is that of a variable
    new = rename_of_cell(desk.documents, TOOLS, "grip", "claw")
    assert new.program == PROGRAM
    new = rename_of_cell(desk.documents, LOADS, "hand_and_part", "both")
    assert new.program == PROGRAM.replace("hand_and_part", "both")
