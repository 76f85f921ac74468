import os

import pytest

from robolang.analysis.cell_symbols import CellSymbols
from robolang.project.discovery import builtin_cell_file
from robolang.project.points import Point, load_points
from runtime.core.tomlfile import FileFault
from tests.messages import fields

PUMA = builtin_cell_file().arm.limits

GOOD = """schema = 1
robot = "puma560"   # kept
[points.P1]
pose = [450, -150, 200, 180, 0, 90]
configuration = "lefty ABOVE noflip"
turns = [0, -1, 0]
frame = "TABLE"
tool = "GRIP"
comment = "over the tray"
[points.home]
joints = [0, 90, -90, 0, 0, 0]
"""


@pytest.fixture
def write(tmp_path):
    def write(text):
        path = tmp_path / "pick.points.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


def fault_of(path, **facts):
    with pytest.raises(FileFault) as caught:
        load_points(path, CellSymbols(**facts))
    return caught.value


def test_a_good_file(write):
    store = load_points(write(GOOD), CellSymbols(robot="PUMA560", limits=PUMA))
    assert store.robot == "puma560"
    assert store.names == {"P1", "HOME"}
    assert store.get("p1") == Point(
        name="P1",
        pose=(450, -150, 200, 180, 0, 90),
        configuration=("LEFTY", "ABOVE", "NOFLIP"),
        turns=(0, -1, 0),
        frame="TABLE",
        tool="GRIP",
        comment="over the tray",
    )
    assert store.get("HOME").joints == (0, 90, -90, 0, 0, 0)
    assert store.get("nowhere") is None


def test_no_points_is_no_error(write):
    assert load_points(write("schema = 1\n")).names == frozenset()


def test_missing(tmp_path):
    assert fault_of(tmp_path / "none.points.toml").code == "RBL302"


def test_not_a_file(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "ring").symlink_to(tmp_path / "ring")
    (tmp_path / "out").symlink_to("/etc/hostname")
    for path in (tmp_path, tmp_path / "pipe", "/dev/zero", tmp_path / "ring", tmp_path / "out", f"{tmp_path}/a\0b"):
        assert fault_of(path).code == "RBL311"


P1 = "schema = 1\n[points.P1]\n"


@pytest.mark.parametrize(
    ("text", "code", "line", "column"),
    [
        ("", "RBL303", 1, 1),
        ("[points.P1]\npose = [1, 2, 3, 4, 5, 6]", "RBL303", 1, 1),
        ('schema = 1\nrobot = "pu\n', "RBL303", 2, 12),
        (b"schema = 1 \xff", "RBL311", 1, 12),
        (b"\xef\xbb\xbfschema = 1\r\n# \xc3\xa4 \xff\r\n", "RBL311", 2, 5),
        ("schema = 2\nfuture = 1", "RBL304", 1, 1),
        ('schema = "1"', "RBL303", 1, 1),
        (P1 + "pose = [1, 2, 3, 4, 5]", "RBL307", 3, 1),
        (P1 + 'pose = "a"', "RBL303", 3, 1),
        (P1 + "joints = [1]", "RBL307", 3, 1),
        (P1 + "joints = [1, 2, 3, 4, 5, 6, 7, 8]", "RBL307", 3, 1),
        (P1 + "  pose = [1, 2, 3, 4, 5, nan]", "RBL309", 3, 3),
        (P1 + "pose = [inf, 2, 3, 4, 5, 6]", "RBL309", 3, 1),
        (P1 + "pose = [1e6, 2, 3, 4, 5, 6]", "RBL309", 3, 1),
        (P1 + "pose = [1, 2, 3, 4, 5, 1e5]", "RBL309", 3, 1),
        (P1 + "pos = [1, 2, 3, 4, 5, 6]", "RBL308", 3, 1),
        (P1 + 'comment = "x"', "RBL303", 2, 1),
        (P1 + "pose = [1, 2, 3, 4, 5, 6]\nspeed = 3", "RBL308", 4, 1),
        (P1 + "pose = [1, 2, 3, 4, 5, 6]\njoints = [1, 2]", "RBL303", 4, 1),
        (P1 + 'joints = [1, 2]\nconfiguration = "LEFT"', "RBL308", 4, 1),
        (P1 + 'joints = [1, 2]\nconfiguration = "LEFTY RIGHTY"', "RBL303", 4, 1),
        (P1 + "joints = [1, 2]\nturns = [0.5]", "RBL307", 4, 1),
        (P1 + "joints = [1, 2]\n[points.p1]\njoints = [1, 2]", "RBL303", 4, 1),
        ("schema = 1\n[points.MOVE]\njoints = [1, 2]", "RBL303", 2, 1),
        ('schema = 1\nunits = "mm"', "RBL308", 2, 1),
    ],
)
def test_bad_files(write, text, code, line, column):
    fault = fault_of(write(text))
    assert (fault.code, fault.line, fault.column) == (code, line, column)


def test_a_file_that_was_cut_off(write):
    assert fault_of(write(GOOD[:60])).code == "RBL303"


def test_a_number_of_thousands_of_digits(write):
    assert fault_of(write("schema = " + "1" * 5000)).code == "RBL303"


def test_another_robot(write):
    fault = fault_of(write(GOOD), robot="other")
    assert (fault.code, fault.line) == ("RBL310", 2)


def test_another_number_of_axes(write):
    fault = fault_of(write(GOOD), limits=(*PUMA, PUMA[0]))
    assert (fault.code, fault.line) == ("RBL307", 11)
    assert {"6", "7"} <= fields(fault.message)


def test_a_copy_is_offered(write):
    path = write("")
    assert "bak" not in fault_of(path).hint
    path.with_name("pick.points.toml.bak").write_text(GOOD)
    assert "pick.points.toml.bak" in fields(fault_of(path).hint)


def test_near_words_are_suggested(write):
    assert "LEFTY" in fields(fault_of(write(P1 + 'joints = [1, 2]\nconfiguration = "LEFT"')).hint)
    assert "comment" in fields(fault_of(write(P1 + 'joints = [1, 2]\ncoment = "x"')).hint)
