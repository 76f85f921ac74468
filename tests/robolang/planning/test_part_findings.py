"""What ``check --motion`` shows of parts, lying, carried and put down.

``tests/runtime/plant/test_touches_of_mujoco.py`` runs such programs.
"""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from robolang.execution.dry_run import rehearse
from robolang.planning.motion_findings import findings
from robolang.planning.path_coverage import explore
from robolang.project.project import load_project
from runtime.core.frames import pose
from runtime.core.units import MM
from tests.runtime.meshes import angle_bracket, binary_stl, prism
from tests.runtime.plant.cells import BESIDE, GRIP, LEDGE, LET_GO, OWN, job
from tests.runtime.plant.test_touches_of_mujoco import ALLOWED

pytestmark = pytest.mark.physics

PROGRAMS = Path(__file__).parents[3] / "programs"
CODES = ("RBL421", "RBL440", "RBL441")


def found(folder, text, *parts, **cell):
    """Code and line of each finding about what is touched, and the messages."""
    project = job(folder, text, *parts, **cell)
    rehearsal = rehearse(project)
    assert rehearsal.refused == ()
    items = [item for item in findings(project, rehearsal) if item.code in CODES]
    rows = [(item.code, project.source.place(item.span.start).line) for item in items]
    return rows, [item.message for item in items]


@pytest.mark.parametrize("case", [case for case in ALLOWED if "nothing" not in case])
def test_what_a_program_is_there_for_is_no_finding(tmp_path, case):
    text, parts = ALLOWED[case]
    assert found(tmp_path, text, *parts) == ([], [])


ROUND_POST = """
[[obstacles]]
name = "post"
shape = "cylinder"
diameter_mm = 60
height_mm = 80
pose_mm_deg = [{}, {}, {}, 0, 0, 0]
"""
OTHER = ("other", 60, 40, 40, 0.5, 480, -150, 620)
PUSHED = {
    "open fingers push a neighbour": (BESIDE + "MOVE P1 + (0, 55, 0)\n", [OWN], 4, "right finger.*part"),
    "the palm stands on a part": (
        "MOVE P1 + (0, 0, 30)\nMOVE P1 + (0, 0, 10)\n",
        [("part", 60, 40, 160, 1.5, 480, -220, 680)],
        2,
        "the palm would touch part",
    ),
    "a carried part pushes another": (
        GRIP + "MOVE P1 + (0, 0, 30)\nMOVE P1 + (0, 50, 30)\n",
        [OWN, OTHER],
        6,
        "carried part.*other",
    ),
    "a carried part is pulled over the table": (
        GRIP + "MOVE P1 + (0, 20, 0)\n",
        [OWN],
        5,
        "carried part.*table",
    ),
    "a carried part is put too deep": (
        GRIP + "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, -2)\n" + LET_GO,
        [OWN],
        6,
        "carried part.*table",
    ),
    "what was put down is in the way": (
        GRIP
        + "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, 0)\n"
        + LET_GO
        + "MOVE P5 + (0, 100, 0)\nMOVE P5\nMOVE P1\nMOVE P1 + (0, 65, 0)\n",
        [OWN],
        13,
        "left finger.*part",
    ),
    "an arm from the other side": (
        "MOVE P5 + (0, 120, 0)\nMOVE P5 + (0, 120, -100)\nMOVE P5 + (0, 55, -100)\n",
        [("part", 60, 40, 190, 1.5, 480, -220, 695)],
        4,
        "right finger.*part",
    ),
}


@pytest.mark.parametrize("case", PUSHED)
def test_a_touch_is_found_at_its_statement_once(tmp_path, case):
    text, parts, line, said = PUSHED[case]
    rows, (message,) = found(tmp_path, text, *parts)
    assert rows == [("RBL440", line)]
    assert re.search(said, message)
    assert 0.0 < float(message.removeprefix("at ").split()[0]) <= 100.0


def test_less_than_half_a_millimetre_is_no_finding(tmp_path):
    assert found(tmp_path, BESIDE + "MOVE P1 + (0, 67.7, 0)\n", OWN) == ([], [])
    assert found(tmp_path, BESIDE + "MOVE P1 + (0, 67.3, 0)\n", OWN)[0] == [("RBL440", 4)]


def test_a_carried_part_slides_along_an_obstacle(tmp_path):
    text = GRIP + "MOVE P1 + (0, 0, {})\nMOVE P1 + (0, 150, {})\n"
    assert found(tmp_path, text.format(60.9, 60.9), OWN, obstacles=LEDGE)[0] == [("RBL440", 6)]
    assert found(tmp_path, text.format(62, 62), OWN, obstacles=LEDGE) == ([], [])


def test_a_hand_that_opens_meets_what_is_beside_it(tmp_path):
    """It closes to 40 mm around the part, which is put down 5 mm beside another."""
    text = GRIP + "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, 0)\n" + LET_GO
    rows, (message,) = found(tmp_path, text, OWN, ("next", 60, 40, 80, 1.5, 480, -60, 640))
    assert rows == [("RBL440", 8)]
    assert re.search("left finger.*next", message)


def test_a_hand_on_without_a_part(tmp_path):
    assert found(tmp_path, "MOVE P1 + (0, 0, 100)\nHAND ON\n", OWN)[0] == [("RBL441", 3)]
    assert found(tmp_path, "MOVE P1 + (0, 0, 100)\nHAND ON\n") == ([], [])  # a cell without parts says nothing of them
    wide = ("part", 60, 81, 80, 1.5, 480, -220, 640)
    assert [code for code, _ in found(tmp_path, "MOVE P1 + (0, 0, 61)\nHAND ON\n", wide)[0]] == ["RBL441"]


def test_a_part_is_taken_where_it_was_put_down(tmp_path):
    place = "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, {})\n" + LET_GO
    again = "MOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, 0)\nHAND ON\nLOAD (0, 0, 95), 2.3\nMOVE P5\n"
    assert found(tmp_path, GRIP + place.format(0) + again, OWN) == ([], [])
    assert found(tmp_path, GRIP + place.format(4) + again, OWN) == ([], [])  # it rests on the table


def test_a_part_that_was_dropped_is_not_known_any_more(tmp_path):
    dropped = GRIP + "MOVE P1 + (0, 0, 50)\n" + LET_GO
    assert found(tmp_path, dropped + "MOVE P1\nHAND ON\n", OWN) == ([], [])
    assert found(tmp_path, dropped + BESIDE + "MOVE P1 + (0, 55, 0)\n", OWN) == ([], [])


def test_only_the_widest_of_two_parts_is_gripped(tmp_path):
    """They stand side by side between the pads; the narrower one stays, and is gripped the next time."""
    parts = [("wide", 9, 40, 80, 0.5, 475, -220, 640), ("narrow", 9, 30, 80, 0.5, 485, -220, 640)]
    there = "MOVE P1 + (0, 0, 100)\nMOVE P1 + (0, 150, 100)\nMOVE P1 + (0, 150, 0)\n"
    place = there + LET_GO + "MOVE P5 + (0, 150, 0)\n"
    again = "MOVE P5\nMOVE P1\nHAND ON\nLOAD (0, 0, 95), 1.3\nMOVE P5\n"
    assert found(tmp_path, GRIP + place + again, *parts) == ([], [])
    parts[1] = (*parts[1][:2], 40, *parts[1][3:])
    assert [code for code, _ in found(tmp_path, GRIP + place + again, *parts)[0]] == ["RBL441"]


def test_a_part_that_the_cell_puts_into_another_is_not_known(tmp_path):
    """Physics throws both out at the start."""
    text = BESIDE + "MOVE P1 + (0, 55, 0)\n"
    assert found(tmp_path, text, OWN, ("other", 60, 40, 80, 1.5, 480, -250, 640)) == ([], [])
    assert found(tmp_path, text, OWN, ("other", 60, 40, 80, 1.5, 480, -260.5, 640))[0] == [("RBL440", 4)]


def test_the_fingers_centre_what_they_close_on(tmp_path):
    """10 mm off, the part is pulled over by as much: its face is 20 mm from the tool then, and not 10."""
    text = "MOVE P1 + (0, 10, 0)\nHAND ON\nLOAD (0, 0, 95), 2.3\nMOVE P1 + (0, 10, 50)\nMOVE P1 + (0, 85, 50)\n"
    for beside, rows in ((25, []), (15, [("RBL440", 6)])):
        low_wall = ("wall", 60, 10, 66, 1.5, 480, -220 + 85 + beside + 5, 633)
        assert found(tmp_path, text, OWN, low_wall)[0] == rows


def test_the_other_branch_is_followed_with_its_own_parts(tmp_path):
    """The part is only put in the way where the input is not set, which the simulated inputs do not show."""
    place = "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, 0)\n" + LET_GO
    text = "IF IN(1) = 1 THEN\nMOVE P5\nELSE\n" + GRIP + place + "MOVE P5 + (0, 100, 0)\nENDIF\n"
    text += "MOVE P5 + (0, 180, 0)\nMOVE P1 + (0, 180, 0)\nMOVE P1 + (0, 155, 0)\n"
    project = job(tmp_path, text, OWN, obstacles="[inputs.1]\nchanges = [[0, 1]]\n")
    explored = explore(project)
    items = findings(project, explored.rehearsal, None, explored.detours)
    (touched,) = (item for item in items if item.code in CODES)
    assert (touched.code, project.source.place(touched.span.start).line) == ("RBL440", 17)
    assert re.search(r"\bpart\b.*'IN\(1\) = 1' in line 2 ", touched.message)


def test_a_carried_part_meets_the_arm(tmp_path):
    """A long rod, gripped in its middle, is swung up to the forearm by J5."""
    rod = ("rod", 850, 40, 40, 1.0, 480, -220, 620)
    text = "MOVE P1 + (0, 0, 2)\nHAND ON\nLOAD (0, 0, 95), 1.8\nMOVE P5 + (0, 0, 120)\n"
    rows, (message,) = found(tmp_path, text + "MOVEJ JOINT(-8, 77, -160, 0, 97, -8)\n", rod)
    assert rows == [("RBL440", 6)]
    assert re.search("rod.*link 3", message)


def test_nothing_to_grip_is_not_said_of_another_branch(tmp_path):
    text = "IF IN(1) = 1 THEN MOVE P1 ELSE MOVE P1 + (0, 0, 100)\nHAND ON\n"
    project = job(tmp_path, text, OWN, obstacles="[inputs.1]\nchanges = [[0, 1]]\n")
    explored = explore(project)
    assert len(explored.detours) == 1
    items = findings(project, explored.rehearsal, None, explored.detours)
    assert [item.code for item in items if item.code in CODES] == []


@pytest.mark.parametrize(("raised_mm", "codes"), [(39.6, set()), (40.3, {"RBL421"})])
def test_the_links_of_an_elastic_arm_stand_at_the_set_points(raised_mm, codes):
    """The pads of MOVE PICK end 40 mm over the table; the weight at home would twist the gears by another 1.1 mm.

    In a run the drives hold the links to 0.2 mm.
    """
    project = load_project(PROGRAMS / "manutec_pick_and_place.rbl")
    (table,) = project.cell.obstacles
    raised = replace(table, X_world_obstacle=pose([0.0, 0.0, raised_mm * MM]) @ table.X_world_obstacle)
    project = replace(project, cell=replace(project.cell, obstacles=(raised,), parts=()))
    assert {item.code for item in findings(project, rehearse(project))} == codes


def test_a_cylinder_is_met_where_it_is_and_not_where_its_box_would_be(tmp_path):
    """A post of 60 mm beside the path of the open hand: its box would reach into it, the post does not."""
    text = "MOVE P5\nMOVE P1\n"
    side = 10.0 + 30.0 / 2.0**0.5 + 3.0  # the edges of pads and shanks are at x = 10, y = 48 mm from P1
    where = (480.0 + side, -220.0 + 48.0 + 30.0 / 2.0**0.5 + 3.0, 640.0)
    post = ROUND_POST.format(*where)
    assert found(tmp_path, text, OWN, obstacles=post) == ([], [])
    box = post.replace('shape = "cylinder"', "size_mm = [60, 60, 80]").replace("diameter_mm = 60\nheight_mm = 80\n", "")
    assert [row[0] for row in found(tmp_path, text, OWN, obstacles=box)[0]] == ["RBL421"]
    nearer = ROUND_POST.format(where[0] - 6.0, where[1] - 6.0, where[2])
    assert [row[0] for row in found(tmp_path, text, OWN, obstacles=nearer)[0]] == ["RBL421"]


def mesh(folder, mesh, kind, keys, pose_mm_deg):
    """The table of a part or an obstacle that is a mesh."""
    name = f"{kind}.stl"
    (folder / name).write_bytes(binary_stl(mesh))
    return f'\n[[{kind}]]\nname = "{kind}"\nshape = "mesh"\nfile = "{name}"\n{keys}pose_mm_deg = {pose_mm_deg}\n'


def test_a_hexagon_is_met_carried_and_put_down_as_one(tmp_path):
    """34.6 mm over its flats, which are along y, and 40 mm over its corners."""
    part = mesh(tmp_path, prism(6, 20.0, 80.0), "parts", "mass_kg = 1.5\n", [480, -220, 640, 0, 0, 0])
    text = GRIP + "MOVE P1 + (0, 0, 50)\nMOVE P1 + (0, 100, 50)\nMOVE P1 + (0, 100, 0)\n" + LET_GO
    assert found(tmp_path, text, obstacles=part) == ([], [])
    # the open pads are at 40 mm: from 22.7 mm beside it one is in a flat
    beside = "MOVE P5 + (0, {0}, 0)\nMOVE P1 + (0, {0}, 0)\n"
    assert found(tmp_path, beside.format(22.2), obstacles=part) == ([], [])
    assert found(tmp_path, beside.format(24.0), obstacles=part)[0] == [("RBL440", 3)]


def test_a_corner_that_goes_in_is_filled(tmp_path):
    """A bracket around the path of the right finger: its legs are 20 mm off, its hull is in the way."""
    bracket = angle_bracket(160.0, 10.0, 80.0)
    keys = "filled = true\n"
    clear = mesh(tmp_path, bracket, "obstacles", keys, [480 + 60, -220 + 140, 640, 0, 0, 0])
    assert found(tmp_path, "MOVE P5\nMOVE P1\n", OWN, obstacles=clear) == ([], [])
    around = mesh(tmp_path, bracket, "obstacles", keys, [480 + 40, -220 - 20, 640, 0, 0, 0])
    assert [row[0] for row in found(tmp_path, "MOVE P5\nMOVE P1\n", obstacles=around)[0]] == ["RBL421"]
