"""Bad files and options and what each gets: the rows B1 to B16, C1 to C27 and D4 to D13 of the promises.

A row of a file is a golden place: line, column and code of what is refused; the name is that of the file. The rows of
groups A are in ``test_bad_inputs``, how the command line says a fault in ``cli/test_run_refusals``.
"""

import os
from itertools import pairwise
from pathlib import Path

import pytest

from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.source import read_program
from robolang.lint.settings import Settings
from robolang.project.discovery import builtin_cell_file
from robolang.project.points import load_points
from runtime.core.tomlfile import FileFault
from runtime.robot.files.importer import load_file, read_arm
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, flat, robolang
from tests.runtime.robot.models import ANGLES, chain
from tests.steps import calls, guarded

PUMA = CellSymbols(robot="puma560", limits=builtin_cell_file().arm.limits)

POINT = "schema = 1\n[points.P1]\n"
POSE = "pose = [450, -150, 200, 180, 0, 90]\n"
TWO = chain([((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.2), (0, 0, 0), (0, 1, 0))])
MJCF = ANGLES.read_text("utf-8")


def place(call, *words, **options):
    """Code, line and column of the fault that a call ends with, and that it names the file it was given."""
    with pytest.raises(FileFault) as caught:
        call(*words, **options)
    fault = caught.value
    assert Path(fault.path).name == Path(words[0]).name
    return fault.code, fault.line, fault.column


# --- B: taught points ------------------------------------------------------------------------------------------------

POINTS = [
    ("B2", "", ("RBL303", 1, 1)),
    ("B3", (POINT + POSE)[:40], ("RBL303", 3, 18)),
    ("B3 inside a key", (POINT + POSE)[:14], ("RBL303", 2, 4)),
    ("B4", "schema = 2\n[points.P1]\n" + POSE, ("RBL304", 1, 1)),
    ("B5", (POINT + POSE).replace("[450", "{450"), ("RBL303", 3, 12)),
    ("B5 in a key", (POINT + POSE).replace("pose", "qose"), ("RBL308", 3, 1)),
    ("B5 no text", (POINT + POSE).replace("450", "4\udcb50"), ("RBL311", 3, 10)),
    ("B9", POINT + "pose = [450, -150, 200, 180, 0]\n", ("RBL307", 3, 1)),
    ("B9 joints", POINT + "joints = [1, 2, 3, 4, 5]\n", ("RBL307", 3, 1)),
    ("B10", 'schema = 1\nunits = "mm"\n', ("RBL308", 2, 1)),
    ("B10 glued", POINT + "pose = [450mm, -150, 200, 180, 0, 90]\n", ("RBL303", 3, 12)),
    ("B11", 'schema = 1\nrobot = "irb2400"\n[points.P1]\n' + POSE, ("RBL310", 2, 1)),
]


@pytest.mark.parametrize(("text", "expected"), [row[1:] for row in POINTS], ids=[row[0] for row in POINTS])
def test_points(tmp_path, text, expected):
    path = tmp_path / "pick.points.toml"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    before = path.read_bytes()
    assert place(load_points, path, PUMA) == expected
    assert path.read_bytes() == before


def test_points_that_are_no_file(tmp_path):
    """B1, B14, B15 and B16: missing, a link out of the project, a pipe, a device; none of them is waited for."""
    path = tmp_path / "pick.points.toml"
    assert place(load_points, path) == ("RBL302", 1, 1)
    for make in (
        lambda: path.symlink_to("/etc/hostname"),
        lambda: os.mkfifo(path),
        lambda: path.symlink_to("/dev/zero"),
    ):
        make()
        with guarded():
            assert place(load_points, path) == ("RBL311", 1, 1)
        path.unlink()


# --- C: robot files --------------------------------------------------------------------------------------------------


def laughs(levels):
    """An XML file whose text is ten times as long for each level."""
    names = "abcdefghi"[: levels + 1]
    entities = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in pairwise(names))
    return f'<?xml version="1.0"?>\n<!DOCTYPE r [<!ENTITY a "ha">{entities}]>\n<robot>&{names[-1]};</robot>'


def nested(depth):
    return "<mujoco><worldbody>\n" + "<body>\n" * depth + "</body>" * depth + "</worldbody></mujoco>"


ROBOTS = [
    ("C1", "a.urdf", '<!DOCTYPE robot SYSTEM "/etc/passwd">\n' + TWO, ("RBL601", 1, 37)),
    (
        "C1 entity",
        "a.urdf",
        '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<robot>&x;</robot>',
        ("RBL601", 1, 13),
    ),
    ("C2", "a.urdf", laughs(8), ("RBL601", 2, 13)),
    ("C7", "a.xml", MJCF.replace("<actuator>", '<include file="/etc/x.xml"/>\n<actuator>'), ("RBL602", 47, 3)),
    ("C8", "a.xml", MJCF.replace("<actuator>", '<include file="a.xml"/>\n<actuator>'), ("RBL603", 47, 3)),
    ("C9", "a.xml", MJCF.replace('damping="0.1"', 'damping="nan"'), ("RBL604", 38, 17)),
    ("C10", "a.xml", MJCF.replace('gravity="0 0 -9.81"', 'gravity="0 0 nan"'), ("RBL604", 5, 3)),
    ("C11", "a.xml", MJCF.replace('damping="0.1"', 'damping="-5"'), ("RBL605", 38, 17)),
    ("C15", "a.xml", MJCF.replace('range="-120 10"', 'range="120 10"'), ("RBL607", 32, 13)),
    ("C16 position", "a.urdf", TWO.replace(' lower="-3" upper="3"', "", 1), ("RBL608", 3, 1)),
    ("C19", "a.urdf", TWO.replace('name="j2"', 'name="j1"'), ("RBL610", 5, 1)),
    ("C19 body", "a.xml", MJCF.replace('name="roll"', 'name="bend"'), ("RBL610", 38, 17)),
    ("C20", "a.xml", MJCF.replace('joint="waist"', 'joint="west"'), ("RBL610", 48, 5)),
    ("C21", "a.urdf", TWO.replace('<parent link="l0"/>', '<parent link="l2"/>'), ("RBL611", 4, 1)),
    (
        "C21 weld",
        "a.xml",
        MJCF.replace("<actuator>", '<equality><connect body1="hand"/></equality><actuator>'),
        ("RBL611", 47, 13),
    ),
    ("C22", "a.xml", nested(5000), ("RBL612", 100, 1)),
    (
        "C25",
        "a.xml",
        MJCF.replace("<actuator>", '<extension><plugin plugin="x"/></extension><actuator>'),
        ("RBL614", 47, 3),
    ),
]


@pytest.mark.parametrize(("name", "text", "expected"), [row[1:] for row in ROBOTS], ids=[row[0] for row in ROBOTS])
def test_robots(tmp_path, name, text, expected):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    assert place(load_file, path) == expected


@pytest.mark.parametrize(("bomb", "few", "many"), [(laughs, 2, 8), (nested, 200, 5000)])
def test_a_robot_file_that_grows_when_it_is_read_is_refused_where_it_begins_to(bomb, few, many, tmp_path):
    """The work to refuse it does not depend on what would come of it."""
    small, large = tmp_path / "small.xml", tmp_path / "large.xml"
    small.write_text(bomb(few), "utf-8")
    large.write_text(bomb(many), "utf-8")
    assert calls(place, load_file, large) <= calls(place, load_file, small) + 100


def test_joints_without_limits_are_listed(tmp_path):
    """C16 and C20: what no file says of an axis, its effort without an actuator among it, is asked for by name."""
    path = tmp_path / "a.urdf"
    path.write_text(TWO.replace(' velocity="3" effort="50"', ""), "utf-8")
    fault = load_file(path).undriven
    assert fault is not None
    assert (fault.code, fault.line, fault.column) == ("RBL608", 3, 1)
    assert {"max_speed_deg_s", "max_acceleration_deg_s2", "max_torque_nm"} <= fields(fault.message)


def test_a_name_is_never_a_command(tmp_path, monkeypatch):
    """C27."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "$(touch x).xml"
    path.write_text(MJCF, "utf-8")
    assert read_arm(path).n == 5
    assert os.listdir(tmp_path) == ["$(touch x).xml"]


# --- D: files and options of the command line ------------------------------------------------------------------------


def test_programs_that_are_no_file(tmp_path):
    """D4, D5 and D6; a folder is read for its programs by ``check`` and ``fmt`` alone."""
    assert place(read_program, tmp_path / "none.rbl") == ("RBL701", 1, 1)
    assert place(read_program, tmp_path) == ("RBL702", 1, 1)
    os.mkfifo(tmp_path / "pipe.rbl")
    for name in (tmp_path / "pipe.rbl", "/dev/zero"):
        with guarded():
            assert place(read_program, name) == ("RBL702", 1, 1)


OPTIONS = [
    ("D7 nan", ("weigh", "--payload", "nan,0,0,0"), "RBL703 --payload 1 nan"),
    ("D7 -1", ("weigh", "--payload=-1,0,0,0"), "RBL703 --payload -1 kg"),
    ("D7 5kg", ("weigh", "--payload", "5kg,0,0,0"), "RBL703 --payload 1 5kg"),
    ("D8", ("identify", "--error", "1e400"), "RBL703 --error 1e400"),
    ("D9 0", ("compare", "--jobs", "0"), "RBL703 0 --jobs 1 64"),
    ("D9 x", ("compare", "--jobs", "x"), "RBL703 --jobs x"),
    ("D9 axis", ("step", "--robot", "puma560", "--axis", "0"), "RBL703 7 0 --axis 1"),
    ("D9 time", ("step", "--robot", "puma560", "--axis", "1", "--seconds", "nan"), "RBL703 --seconds"),
]


@pytest.mark.parametrize(("words", "said"), [row[1:] for row in OPTIONS], ids=[row[0] for row in OPTIONS])
def test_options(words, said):
    command, *rest = words
    program = [] if command == "step" else [ROOT / "programs/pick_and_place.rbl"]
    assert set(said.split()) <= fields(flat(robolang(command, *program, *rest, code=2).stderr))


SETTINGS = [
    ("D12 twice", "[lint]\nignore = []\nignore = []\n", ("RBL707", 3, 1)),
    ("D12 unknown", "[lint]\nignored = []\n", ("RBL707", 2, 1)),
]


@pytest.mark.parametrize(("text", "expected"), [row[1:] for row in SETTINGS], ids=[row[0] for row in SETTINGS])
def test_settings(tmp_path, text, expected):
    (tmp_path / "robolang.toml").write_text(text, "utf-8")
    with pytest.raises(FileFault) as caught:
        Settings().layer(tmp_path)
    assert (caught.value.code, caught.value.line, caught.value.column) == expected
    assert caught.value.path.endswith("robolang.toml")


def test_a_name_that_begins_with_a_hyphen(tmp_path, monkeypatch):
    """D13."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "-x.rbl").write_text("MOVE P9\n", "utf-8")
    assert "-x.rbl:1:6: error RBL301" in robolang("check", "--", "-x.rbl", code=1).stdout
    assert "-x" in robolang("check", "-x.rbl", code=2).stderr
