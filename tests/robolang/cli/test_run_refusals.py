"""Every bad program, point, cell and robot: a code, its place, what to do, the exit code, and nothing written."""

import os

import pytest

from tests.messages import fields
from tests.robolang.cli.commands import BUILTIN, PUMA, dry, flat, places, robolang

POINT = "pose = [480, -220, 840, 180, 0, {}]"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(name, *words, code):
    """Run with both outputs asked for; return stderr after checking that nothing was printed or left behind."""
    before = sorted(os.listdir())
    result = dry(name, "--report", "r.json", "--log", "l.npz", *words, code=code)
    assert result.stdout == ""
    assert sorted(os.listdir()) == before
    assert "help: " in result.stderr
    return result.stderr


BAD_TEXT = [
    ("10 MOV P1", (1, 4, "RBL112"), "MOVEJ P1"),
    ("10 FROB P1", (1, 4, "RBL112"), "MOVE LOAD HAND IF"),
    ("10 HAND OM", (1, 9, "RBL111"), ""),
    ("10 LOAD (0, 0, 60), -1", (1, 21, "RBL401"), ""),
    ("10 LOAD (0, 0, 60), 1E999", (1, 21, "RBL114"), ""),
    ("10 LOAD (0, 0, 60), NAN", (1, 21, "RBL401"), ""),
    ("10 LOAD (0, 0, 60), 2.6", (1, 21, "RBL402"), ""),
    ("10 LOAD (0, 0, 60), 800", (1, 21, "RBL402"), "800 g 0.8 kg"),
    ("10 LOAD (0, 0, 2001), 1", (1, 9, "RBL403"), ""),
    ("10 LOAD (0, 0, 1E200), 1", (1, 9, "RBL403"), ""),
    ("10 LOAD (0, 0, 10), 1, (1, 1, 5, 0, 0, 0)", (1, 24, "RBL403"), ""),
    ("10 MOVE P1\n20 MOVE P9", (2, 9, "RBL301"), "P1 P2 P3 P4 P5"),
    ("10 MOVE P1, SPEED 0", (1, 19, "RBL404"), "SPEED mm/s"),
    ("10 MOVE P1, SPEED 50\n20 MOVE P5, SPEED 5000", (2, 19, "RBL404"), "SPEED mm/s"),  # the robot's
    ("10 HAND ON, -1", (1, 13, "RBL405"), "0 600 s"),
    ("10 MOVE P1\n10 MOVE P1", (2, 1, "RBL113"), ""),
]


@pytest.mark.parametrize(
    ("text", "place", "help_"), BAD_TEXT, ids=[place[2] + " " + text for text, place, _ in BAD_TEXT]
)
def test_what_the_text_says_is_a_diagnostic(folder, text, place, help_):
    (folder / "p.rbl").write_text(text)
    said = refused("p.rbl", code=1)
    assert places(said) == [place]
    assert f"p.rbl:{place[0]}:{place[1]}: error" in said
    assert set(help_.split()) <= fields(said)
    assert text.splitlines()[place[0] - 1] in said  # the line is shown


def test_every_problem_of_a_text_is_listed(folder):
    (folder / "p.rbl").write_text("MOV P1\nLOAD (0, 0, 0), -1\nMOVE P1, P2, P3\nMOVE P8\n")
    assert [code for _, _, code in places(refused("p.rbl", code=1))] == ["RBL112", "RBL401", "RBL111", "RBL301"]


@pytest.mark.parametrize(
    ("make", "code", "exit_code", "said"),
    [
        (lambda p: None, "RBL701", 2, "p.rbl"),
        (lambda p: p.mkdir(), "RBL702", 2, ""),
        (os.mkfifo, "RBL702", 2, ""),
        (lambda p: p.symlink_to("/dev/zero"), "RBL702", 2, ""),
        (lambda p: p.symlink_to(p), "RBL702", 2, ""),
        (lambda p: p.write_bytes(b"10 MOVE P1\n\xff\xfe\x00"), "RBL104", 1, "UTF-8"),
        (lambda p: p.write_bytes(b"10 MOVE P1\n\x00"), "RBL104", 1, "NUL"),
        (lambda p: p.write_bytes(b" " * 1_000_001), "RBL106", 1, "1000000"),
        (lambda p: p.write_text("10 MOVE P1" + " " * 10_001), "RBL105", 1, ""),
    ],
    ids=["missing", "folder", "pipe", "device", "ring", "binary", "NUL", "huge", "long line"],
)
def test_a_program_that_is_no_text(folder, make, code, exit_code, said):
    make(folder / "p.rbl")
    text = refused("p.rbl", code=exit_code)
    assert code in text
    assert set(said.split()) <= fields(text)
    assert text.startswith("p.rbl:")


def test_the_place_of_a_bad_byte_is_where_it_stands(folder):
    (folder / "p.rbl").write_bytes(b"10 MOVE P1\n20 \xff\n")
    assert places(refused("p.rbl", code=1)) == [(2, 4, "RBL104")]


def test_a_missing_program_with_its_suffix_forgotten(folder):
    (folder / "p.rbl").write_text("10 MOVE P1\n")
    assert "p.rbl" in fields(refused("p", code=2))


@pytest.mark.parametrize(
    ("second", "code", "said"),
    [
        ("pose = [5000, 0, 840, 180, 0, 180]", "RBL410", "puma560"),
        (POINT.format(-160), "RBL411", "J6 266 deg 65.89 61.8 %"),
        ("pose = [480, -220, 840, 180, 100, 170]", "RBL412", "62.7 % J4"),
    ],
)
def test_a_move_that_the_robot_cannot_make_is_refused_before_any_motion(folder, second, code, said):
    (folder / "p.rbl").write_text("10 LOAD (0, 0, 60), 0.8\n20 MOVE A\n30 MOVE B, WRIST KEEP\n")
    first = POINT.format(10 if code == "RBL411" else 180)
    (folder / "p.cell.toml").write_text((BUILTIN / "cell.toml").read_text())
    (folder / "p.points.toml").write_text(f"schema = 1\n[points.A]\n{first}\n[points.B]\n{second}\n")
    text = refused("p.rbl", code=3)
    assert places(text) == [(3, 4, code)]
    assert set(said.split()) <= fields(text)
    assert "0.000 s" not in text  # no statement was started


def test_a_point_in_a_frame_that_the_cell_lacks(folder):
    (folder / "p.rbl").write_text("MOVE A\n")
    (folder / "p.cell.toml").write_text((BUILTIN / "cell.toml").read_text())
    (folder / "p.points.toml").write_text(f"schema = 1\n[points.A]\n{POINT.format(180)}\nframe = 'BENCH'\n")
    text = refused("p.rbl", code=2)
    assert places(text) == [(4, 1, "RBL305")]
    assert "BENCH" in text


CELL = [
    ("mass_kg = 0.8", "mass_kg = 0.8\nmas_kg = 0.8", "RBL609", "mass_kg"),
    ("grip_force_n = 120", "grip_force_n = nan", "RBL604", "hand.grip_force_n"),
    ("grip_force_n = 120", "grip_force_n = -inf", "RBL604", ""),
    ("stroke_mm = 80", "stroke_mm = -80", "RBL605", "0"),
    ("stroke_mm = 80", "", "RBL608", "hand.stroke_mm"),
    ('robot = "puma560"', 'robot = "../puma560.toml"', "RBL602", ""),
    ('robot = "puma560"', 'robot = "/etc/puma560.toml"', "RBL602", ".."),
    ('robot = "puma560"', 'robot = "puma650"', "RBL610", "puma560"),
    ("joints_deg = [-8.1", "joints_deg = [-800.1", "RBL605", "J1"),
    ("schema = 1", "schema = ", "RBL601", ""),
    ("friction = 0.6", "friction = 0.6\n[controller]\nservo_period_ms = 3", "RBL605", "0.25 0.5 1"),
    ("friction = 0.6", "friction = 0.6\n[controller]\nservo_period = 1", "RBL609", "servo_period_ms"),
]


@pytest.mark.parametrize(("old", "new", "code", "said"), CELL, ids=[f"{c[2]} {c[1]}"[:40] for c in CELL])
@pytest.mark.parametrize("given", [True, False], ids=["--cell", "beside"])
def test_a_bad_cell_file_is_located(folder, given, old, new, code, said):
    text = (BUILTIN / "cell.toml").read_text()
    assert old in text
    broken = text.replace(old, new, 1)
    (folder / "p.rbl").write_text("MOVE P1\n")
    name = "other.toml" if given else "p.cell.toml"
    (folder / name).write_text(broken)
    found = refused("p.rbl", *(["--cell", name] if given else []), code=2)
    assert set(said.split()) <= fields(found)
    ((line, _, found_code),) = places(found)
    assert found_code == code
    key = (new or "[hand]").splitlines()[-1].split("=")[0].strip()
    assert broken.splitlines()[line - 1].startswith(key)
    assert found.startswith(f"{name}:{line}:")


def test_a_robot_file_outside_the_folder_of_the_cell_is_not_opened_through_a_link(folder):
    (folder / "p.rbl").write_text("MOVE P1\n")
    (folder / "mine.toml").symlink_to(PUMA)
    (folder / "cell.toml").write_text((BUILTIN / "cell.toml").read_text().replace('"puma560"', '"mine.toml"', 1))
    assert {"RBL602", "mine.toml"} <= fields(refused("p.rbl", code=2))


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("--robot", "puma650"), "RBL708", "puma560"),
        (("--robot", "x"), "RBL708", "irb2400 manutec_r3 puma560"),
        (("--robot", "none.toml"), "RBL600", "none.toml"),
        (("--robot", "folder.toml"), "RBL600", ""),
        (("--robot", "pipe.toml"), "RBL600", ""),
        (("--cell", "none.toml"), "RBL600", "none.toml"),
        (("--cell", "pipe.toml"), "RBL600", ""),
        (("--cell", ""), "RBL600", ""),
    ],
)
def test_a_robot_or_cell_that_is_not_there(folder, words, code, said):
    (folder / "p.rbl").write_text("MOVE P1\n")
    (folder / "folder.toml").mkdir()
    os.mkfifo(folder / "pipe.toml")
    text = refused("p.rbl", *words, code=2)
    assert code in text
    assert set(said.split()) <= fields(text)


def test_a_robot_file_with_another_number_of_axes_does_not_fit_the_cell(folder):
    (folder / "p.rbl").write_text("MOVE P1\n")
    text = PUMA.read_text()
    text = text[: text.index("[kinematics.opw]")] + text[text.index("[path]") : text.rindex("[[axes]]")]
    (folder / "five.toml").write_text(text)
    assert {"RBL709", "puma560", "5"} <= fields(refused("p.rbl", "--robot", "five.toml", code=2))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--servo", "nope"), "RBL703 --servo nope"),
        (("--log", "x.txt"), "RBL703 --log x.txt .npz .mcap"),
        (("--log", "npz"), "RBL703 --log npz .npz .mcap"),
        (("--report", "p.rbl"), "RBL703 --report p.rbl"),
        (("--report", "cell.toml"), "RBL703 --report cell.toml"),
        (("--report", "x.npz", "--log", "./x.npz"), "RBL703 --log x.npz"),
        (("--frob",), "--frob"),
    ],
)
def test_a_bad_option_is_a_usage_error_before_anything_is_read(folder, words, said):
    (folder / "p.rbl").write_text("MOVE P1\n")
    before = sorted(os.listdir())
    result = dry("p.rbl", *words, code=2)
    assert set(said.split()) <= fields(flat(result.stderr))
    assert sorted(os.listdir()) == before
    assert (folder / "p.rbl").read_text() == "MOVE P1\n"


def test_a_program_is_never_overwritten_by_its_own_log(folder):
    (folder / "p.npz").write_text("MOVE P1\n")
    (folder / "link.npz").symlink_to("p.npz")
    for name in ("p.npz", "link.npz"):
        # what has the name of a log is no program, whatever is in it
        assert {"RBL702", "p.npz"} <= fields(flat(dry("p.npz", "--log", name, code=2).stderr))
    assert (folder / "p.npz").read_text() == "MOVE P1\n"


def test_a_name_that_cannot_be_a_cell_or_points_file(folder):
    """A name of 254 characters is a file, but the names beside it would be longer than a file system allows."""
    name = "a" * 250 + ".rbl"
    (folder / name).write_text("MOVE P1\n")
    assert dry(name, "--quiet").exit_code == robolang("check", name).exit_code == 0


def test_gains_that_no_sampled_loop_can_have_are_refused(folder):
    (folder / "p.rbl").write_text("MOVE P1\n")
    text = PUMA.read_text().replace("velocity_bandwidth_rad_s = 120", "velocity_bandwidth_rad_s = 2000", 1)
    (folder / "fast.toml").write_text(text)
    said = refused("p.rbl", "--robot", "fast.toml", code=2)
    assert {"RBL616", "velocity_bandwidth_rad_s", "2000", "J1", "puma560", "1", "ms"} <= fields(said)
    (folder / "fast.toml").write_text(text.replace("_rad_s = 2000", "_rad_s = 1999"))
    dry("p.rbl", "--robot", "fast.toml", "--quiet")
