"""Edits of points files: the text stays except for the point, and what is read back is what was taught."""

import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.project.points import Point, load_points, read_points
from robolang.teaching.cell_document import set_frame
from robolang.teaching.desk import Desk
from robolang.teaching.documents import Documents, load_documents
from robolang.teaching.points_document import copy_point, remove_point, set_point, taught
from robolang.teaching.renaming import rename_point
from robolang.teaching.toml_text import number
from tests.campaign import examples
from tests.robolang.cli.commands import BUILTIN
from tests.robolang.teaching.desks import POINTS, POSE, refused

NAMES = ("P1", "P2", "a", "Over_2", "s")
NEW = ("p1", "P9", "above", "Z_1", "points")
COMMENTS = ("# a word", "# [points.P9]", "#", '# "quoted', "   # indented")


def documents(points, cell="# a cell"):
    return Documents(path=Path("P.rbl"), program="", points=points, cell=cell, cell_path=Path("P.cell.toml"))


# --- one edit, byte by byte ------------------------------------------------------------------------------------------


def test_a_changed_point_keeps_its_comments_and_all_other_bytes():
    new = set_point(documents(POINTS), Point(name="p1", pose=(480.0, -220.5, 640.1 + 0.2 / 9, -1e-11, 0, 180)))
    old = 'pose = [480, -220, 640.000, 180, 0, 180]   # mm\ncomment = "around the part"\n'
    assert new.points == POINTS.replace(old, "pose = [480, -220.5, 640.122, 0, 0, 180]   # mm\n")


def test_a_new_point_comes_after_the_last_one():
    new = set_point(documents(POINTS), Point(name="P9", joints=(1 + 1e-10, 2, 3, 0, 0, 0), configuration=("LEFTY",)))
    added = '\n[points.P9]\njoints = [1, 2, 3, 0, 0, 0]\nconfiguration = "LEFTY"\n'
    assert new.points == POINTS.replace("0, 45, 0]\n", f"0, 45, 0]\n{added}")


def test_a_new_point_comes_after_the_comments_of_the_last_one_and_after_a_last_line_without_an_end():
    values = "pose = [450, -150, 840, 180, 0, 180]\n"
    text = f"schema = 1\n[points.P1]\n{values}# below\n# it\n\n# The end.\n"
    new = set_point(documents(text), Point(name="P9", pose=POSE)).points
    assert new == text.replace("# it\n", f"# it\n\n[points.P9]\n{values}")
    assert remove_point(documents(new), "P9").points == text
    assert (
        set_point(documents("schema = 1"), Point(name="P9", pose=POSE)).points == f"schema = 1\n\n[points.P9]\n{values}"
    )


def test_a_removed_point_takes_the_comment_right_above_it_along():
    start, end = POINTS.index("# over"), POINTS.index("[points.P2]")
    assert remove_point(documents(POINTS), "p1").points == POINTS[:start] + POINTS[end:]
    assert remove_point(documents(POINTS), "P2").points == POINTS.replace(
        "\n[points.P2]\njoints = [0, 45, 90, 0, 45, 0]\n\n", "\n"
    )


def test_a_renamed_point_changes_its_name_alone():
    new = rename_point(documents(POINTS), "p1", "Above")
    assert new.points == POINTS.replace("points.P1", "points.Above")


@pytest.mark.parametrize("value", [0.0, -0.0, -1e-13, 1 / 3, 2e5 / 3, 1e5, 99999.9995, -12.3456, 1e-300, 2**-40, 480.0])
@pytest.mark.parametrize("digits", [3, 4])
def test_a_number_reads_back_within_its_decimals(value, digits):
    text = number(value, digits)
    assert abs(float(text) - value) <= 0.5000001 * 10**-digits
    assert not text.startswith("-0") or float(text) != 0.0
    assert not text.endswith("0") or "." not in text
    assert "e" not in text
    assert number(float(text), digits) == text


def test_a_number_that_was_rounded_on_purpose_is_written_in_full():
    assert [number(value, 3) for value in (0.123456789, -1e-9, 12.0004, 480)] == [
        "0.123456789",
        "-0.000000001",
        "12.0004",
        "480",
    ]
    assert [number(value, 3) for value in (0.1234567891, 0.1 + 0.2, 1 / 3)] == ["0.123", "0.3", "0.333"]


# --- which text is edited --------------------------------------------------------------------------------------------


def test_the_built_in_points_are_written_with_the_first_change():
    builtin = load_points(BUILTIN / "points.toml")
    new = set_point(documents(None, cell=None), Point(name="P9", pose=POSE), robot="puma560")
    assert taught(new).points == {**builtin.points, "P9": Point(name="P9", pose=POSE)}
    assert taught(remove_point(documents(None, cell=None), "P3")).names == builtin.names - {"P3"}
    assert taught(set_point(documents(None, cell=None), Point(name="P9", pose=POSE), robot="scara")).robot == "scara"


def test_what_is_written_for_another_robot_can_be_used_on_it(tmp_path):
    (tmp_path / "P.rbl").write_text("10 LOAD (0, 0, 60), 0.8\n20 DELAY 1\n")
    found = load_documents(tmp_path / "P.rbl", None, "irb2400")
    for new in (remove_point(found, "P1"), set_frame(found, "pallet", POSE)):
        assert taught(new).robot == "irb2400"
    refused("RBL708", load_documents, tmp_path / "P.rbl", None, "nobody")


def test_the_first_point_in_a_cell_of_its_own_makes_a_file():
    new = set_point(documents(None), Point(name="P1", pose=POSE), robot="scara")
    assert new.points == ('schema = 1\nrobot = "scara"\n\n[points.P1]\npose = [450, -150, 840, 180, 0, 180]\n')
    assert remove_point(new, "P1").points.startswith('schema = 1\nrobot = "scara"\n')
    refused("RBL301", remove_point, documents(None), "P1")


@pytest.mark.parametrize(
    ("code", "line", "text"),
    [
        ("RBL304", 1, "schema = 2\n[points.P1]\n"),
        ("RBL303", 1, ""),
        ("RBL303", 3, "schema = 1\n[points.P1]\npose = [1, 2\n"),
        ("RBL307", 3, "schema = 1\n[points.P1]\npose = [1, 2]\n"),
        ("RBL303", 2, "schema = 1\npoints = {P1 = {pose = [1, 2, 3, 4, 5, 6]}}\n"),
        ("RBL308", 4, "schema = 1\n[points.P1]\npose = [1, 2, 3, 4, 5, 6]\nspeed = 1\n"),
    ],
)
def test_a_file_that_is_damaged_or_newer_is_left_alone(code, line, text):
    for edit in (
        lambda: set_point(documents(text), Point(name="P9", pose=POSE)),
        lambda: remove_point(documents(text), "P1"),
        lambda: copy_point(documents(text), "P1", "P9"),
        lambda: rename_point(documents(text), "P1", "P9"),
    ):
        fault = refused(code, edit)
        assert (fault.path, fault.line) == ("P.points.toml", line if text else 1)


@pytest.mark.parametrize(
    ("code", "point"),
    [
        ("RBL718", Point(name="MOVE", pose=POSE)),
        ("RBL718", Point(name="1st", pose=POSE)),
        ("RBL718", Point(name="P 9", pose=POSE)),
        ("RBL718", Point(name="P9]\nx = 1", pose=POSE)),
        ("RBL309", Point(name="P9", pose=(1e6, 0, 0, 0, 0, 0))),
        ("RBL309", Point(name="P9", pose=(float("nan"), 0, 0, 0, 0, 0))),
        ("RBL309", Point(name="P9", joints=(float("inf"), 0, 0, 0, 0, 0))),
        ("RBL307", Point(name="P9", joints=(1.0,))),
        ("RBL303", Point(name="P9")),
    ],
)
def test_what_no_point_can_be_is_refused(code, point):
    refused(code, set_point, documents(POINTS), point)


@pytest.mark.parametrize("name", ["X", "y", "GRIP", "tray"])
def test_a_name_that_means_something_else_in_the_program_is_refused(name):
    found = Documents(
        path=Path("P.rbl"),
        program="10 x = 1\n20 SUB s(y)\n30 ENDSUB\n",
        points=POINTS,
        cell='[tools.grip]\n["frames".\'TRAY\']\n["\\z"]\n',
        cell_path=Path("P.cell.toml"),
    )
    refused("RBL718", set_point, found, Point(name=name, pose=POSE))
    refused("RBL718", rename_point, found, "P1", name)
    refused("RBL718", copy_point, found, "P1", name)


def test_a_copy_has_the_values_of_the_point_and_a_name_of_its_own():
    refused("RBL718", copy_point, documents(POINTS), "P1", "p2")
    refused("RBL301", copy_point, documents(POINTS), "P8", "P9")
    found = copy_point(documents(POINTS), "p1", "P9", (1, 2, 3, 4, 5, 6))
    assert taught(found).get("P9") == taught(found).get("P1").replaced(name="P9", pose=(1, 2, 3, 4, 5, 6))
    assert taught(copy_point(found, "P2", "P8", POSE)).get("P8") == Point(name="P8", pose=POSE)


def test_a_use_that_does_not_mean_the_point_keeps_its_name():
    program = """\
10 MOVE P1  ' P1
20 p1.z = 1
30 MOVE P1 + (0, 0, P1.Z), SPEED 100
40 CALL s(P1)
*P1
DIM P1(3)
P1(1) = 2
SUB s(P2)
  MOVE P2
ENDSUB
MOVE (P1
x = P1.X
"""
    found = Documents(path=Path("P.rbl"), program=program, points=POINTS, cell="", cell_path=Path("P.cell.toml"))
    new = rename_point(found, "P1", "Q").program.splitlines()
    assert new == [
        "10 MOVE Q  ' P1",
        *program.splitlines()[1:2],
        "30 MOVE Q + (0, 0, Q.Z), SPEED 100",
        "40 CALL s(Q)",
        *program.splitlines()[4:11],
        "x = Q.X",
    ]
    # hidden in the SUB by its parameter
    assert rename_point(found, "P2", "Q").program == program


# --- any edits of any file -------------------------------------------------------------------------------------------


numbers = st.floats(-1000, 1000, allow_nan=False)
poses = st.tuples(*[numbers] * 6)
points = st.builds(
    lambda pose, joints, frame, configuration, comment: {
        "pose": None if joints else pose,
        "joints": joints,
        "frame": frame,
        "configuration": configuration,
        "comment": comment,
    },
    poses,
    st.none() | st.tuples(*[numbers] * 6),
    st.sampled_from(["", "PALLET"]),
    st.sampled_from([(), ("LEFTY",), ("RIGHTY", "ABOVE")]),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
)
noise = st.lists(st.sampled_from(["", *COMMENTS]), max_size=3)
values = st.sampled_from(["[1, 2, 3, 4, 5, 6]", "[ 1,2 , 3,\n  4, # four ]\n  5,6.000 ]", "[1.0,2,3,4,5,6,]"])
texts = st.sampled_from(['"x"', "'[points.P2]'", '"""\n[points.P3]\n# no comment\n"""', "'''\n]'''", '"# \\" ["'])


@st.composite
def entries(draw, name):
    """A point as somebody writes it: its own header, whatever spacing; and a comment in it."""
    header = draw(st.sampled_from([f"[points.{name}]", f'[ points . "{name}" ]', f"  [points.'{name}'] # ]"]))
    pose = f"{draw(st.sampled_from(['', '  ']))}pose{draw(st.sampled_from([' = ', '=']))}{draw(values)}"
    keys = [pose, f"comment = {draw(texts)}", *draw(noise)]
    return [header, *draw(st.permutations(keys))]


@st.composite
def files(draw):
    """The lines of a points file."""
    names = draw(st.lists(st.sampled_from(NAMES), unique=True, max_size=4))
    lines = [*draw(noise), "schema = 1 # yes", *draw(noise)]
    root = draw(st.integers(0, 3))
    if names and root == 0:
        name = names.pop()
        lines += [f"points.{name}.pose = [1, 2, 3, 4, 5, 6] # dotted", f"points . '{name}'.comment = ''", *draw(noise)]
    elif names and root == 1:
        lines += [f"points.{names.pop()} = {{pose = [1, 2, 3, 4, 5, 6]}} # inline", *draw(noise)]
    elif names and root == 2:
        lines += ["[points]", *draw(noise)]
        if draw(st.booleans()):
            lines += [f"{names.pop()} = {{pose = [1, 2, 3, 4, 5, 6], comment = 'in one line'}}", *draw(noise)]
        if names and draw(st.booleans()):
            name = names.pop()
            lines += [f"{name}.pose = [1, 2, 3, 4, 5, 6] # dotted", f'{name}.comment = "}}"', *draw(noise)]
    for name in names:
        lines += [*draw(entries(name)), *draw(noise)]
    end = draw(st.sampled_from(["\n", "\r\n"]))
    text = "\n".join(lines) + draw(st.sampled_from(["", "\n"]))
    return text.replace("\n", end)


edits = st.one_of(
    st.tuples(st.just("set"), st.sampled_from(NAMES + NEW), points),
    st.tuples(st.just("remove"), st.sampled_from(NAMES + NEW), st.none()),
    st.tuples(st.just("rename"), st.sampled_from(NAMES + NEW), st.sampled_from(NEW)),
    st.tuples(st.just("copy"), st.sampled_from(NAMES + NEW), st.sampled_from(NEW)),
)


def rounded(point):
    """A point as it is read back."""
    pose = point.pose and tuple(float(number(each, 3 if axis < 3 else 4)) for axis, each in enumerate(point.pose))
    return point.replaced(pose=pose, joints=point.joints and tuple(float(number(each, 4)) for each in point.joints))


def edited(found, model, edit):
    """Make an edit in documents and in the model; both as they were where it is refused."""
    kind, name, what = edit
    there = model.get(name.upper())
    if kind == "set":
        point = Point(name=name, **what)
        # a point that is there keeps its spelling
        model = {**model, name.upper(): rounded(point.replaced(name=there.name if there else name))}
        return set_point(found, point), model
    if there is None:
        refused("RBL301", remove_point if kind == "remove" else copy_point, found, name, *[what] * (kind != "remove"))
        return found, model
    if kind == "remove":
        return remove_point(found, name), {key: each for key, each in model.items() if key != name.upper()}
    if what.upper() in model and not (kind == "rename" and what.upper() == name.upper()):
        refused("RBL718", rename_point if kind == "rename" else copy_point, found, name, what)
        return found, model
    if kind == "copy":
        return copy_point(found, name, what), {**model, what.upper(): rounded(there.replaced(name=what))}
    moved = {(what.upper() if key == name.upper() else key): each for key, each in model.items()}
    return rename_point(found, name, what), {**moved, what.upper(): there.replaced(name=what)}


@examples(3000, 150)
@given(files(), st.lists(edits, min_size=1, max_size=5))
def test_any_edits_of_any_file_read_back_as_taught(text, changes):
    found = documents(text)
    model = dict(read_points_of(found))
    desk = Desk(found)
    for change in changes:
        new, model = edited(desk.documents, model, change)
        desk.change(new, change[0])
        assert dict(read_points_of(desk.documents)) == model
        assert ("\r\n" in text) or "\r" not in desk.documents.points
    while desk.documents != found:
        desk.undo()
    assert desk.documents.points == text


def read_points_of(found):
    from runtime.core.tomlfile import Source

    return read_points(Source("P.points.toml", found.points)).points


@examples(3000, 150)
@given(st.data(), st.lists(st.sampled_from(NAMES), unique=True, min_size=1), points)
def test_an_edit_leaves_every_byte_around_the_point(data, names, what):
    parts = [(name, "\n".join(data.draw(entries(name))) + "\n") for name in names]
    head = "\n".join([*data.draw(noise), "schema = 1"]) + "\n"
    # what stands before a header and after the last key of the point above it
    gaps = [head, *("\n" + "".join(f"{line}\n" for line in data.draw(noise)) + "\n" for _ in names)]
    whole = "".join(gap + part for gap, (_, part) in zip(gaps, parts, strict=False)) + gaps[-1]
    at = data.draw(st.integers(0, len(names) - 1))
    before = "".join(gap + part for gap, (_, part) in zip(gaps[:at], parts[:at], strict=True)) + gaps[at]
    after = whole[len(before) + len(parts[at][1]) :]
    for new in (
        set_point(documents(whole), Point(name=names[at], **what)).points,
        rename_point(documents(whole), names[at], "Other").points,
    ):
        assert new.startswith(before)
        assert new.endswith(after)
    removed = remove_point(documents(whole), names[at]).points
    assert removed.startswith(before.rstrip("\n"))
    assert removed.endswith(after.lstrip("\n"))
    added = set_point(documents(whole), Point(name="Other", **what)).points
    # one insertion, and no other change
    same = next((at for at, pair in enumerate(zip(added, whole, strict=False)) if pair[0] != pair[1]), len(whole))
    assert added.endswith(whole[same:])
    assert tomllib.loads(added)["points"].keys() == {*names, "Other"}


def test_load_documents_reads_what_is_beside(tmp_path):
    (tmp_path / "P.rbl").write_text("10 MOVE P1\n")
    (tmp_path / "P.points.toml").write_text(POINTS)
    found = load_documents(tmp_path / "P.rbl")
    assert (found.points, found.cell, found.cell_path) == (POINTS, None, tmp_path / "P.cell.toml")
