import os
import subprocess
import sys

import pytest

from tests.messages import fields, heads, numbers
from tests.robolang.cli.commands import BUILTIN, ROOT, counted, places, robolang
from tests.steps import HANG_S

HEAVY = ("numpy", "pinocchio", "mujoco", "ruckig", "mcap", "google.protobuf")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.rbl").write_text("10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n")
    (tmp_path / "bad.rbl").write_text("10 MOV P1\n20 LOAD (0, 0, 60), -1\n")
    (tmp_path / "empty.rbl").write_text("")
    (tmp_path / "binary.rbl").write_bytes(b"\xff\xfe\x00")
    return tmp_path


def test_a_program_without_its_cell_is_noted_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "new.rbl").write_text("TOOL none\nMOVE HOME\nMOVE FEEDER\n")
    for command in ("check", "run"):
        result = robolang(command, "new.rbl", code=1)
        assert [
            line for line in result.stderr.splitlines() if "new.cell.toml" in line and line.startswith("note")
        ] != []
        assert (result.stdout + result.stderr).count("note: ") == 1
    # beside the standard input nothing can stand
    result = robolang("run", "-", code=1, typed="MOVE HOME\n")
    assert ".toml" not in result.stderr
    # with a cell of its own there is nothing to note
    (tmp_path / "new.cell.toml").write_text((BUILTIN / "cell.toml").read_text())
    assert "note: " not in robolang("check", "new.rbl", code=1).stderr


def test_a_good_program_is_silent():
    result = robolang("check", "good.rbl")
    assert (result.stdout, result.stderr) == ("", "")


def test_a_bad_program_is_exit_code_1():
    result = robolang("check", "bad.rbl", code=1)
    assert places(result.stdout) == [(1, 4, "RBL112"), (2, 21, "RBL401")]
    assert "MOVEJ" in fields(result.stdout)
    assert result.stderr == ""


def test_wrist_and_seam_are_checked(folder):
    text = "WRIST HOLD TILT, ADVANCE\nMOVE P1, WRIST KEEP\nSEAM OFF\n"
    (folder / "wrist.rbl").write_text(text)
    assert robolang("check", "wrist.rbl").stdout == ""
    (folder / "wrist.rbl").write_text(f"{text}WRIST HOLD TILT, ADVANCE, ROTATION\nSEAM ON\nMOVE P1, WRIST\n")
    found = places(robolang("check", "wrist.rbl", code=1).stdout)
    assert found == [(4, 27, "RBL120"), (5, 8, "RBL111"), (6, 15, "RBL111")]


def test_a_warning_is_printed_and_exit_code_0():
    assert "empty.rbl:1:1: warning RBL201" in robolang("check", "empty.rbl").stdout


@pytest.mark.parametrize(
    ("names", "code"),
    [
        (("good.rbl", "empty.rbl"), 0),
        (("good.rbl", "bad.rbl"), 1),
        (("bad.rbl", "good.rbl"), 1),
        (("none.rbl", "good.rbl"), 2),
        (("bad.rbl", "none.rbl", "bad.rbl"), 2),
        (("binary.rbl", "good.rbl"), 1),
        (("pipe.rbl", "good.rbl"), 2),
    ],
)
def test_every_file_is_checked_and_the_worst_gives_the_exit_code(names, code, folder):
    os.mkfifo(folder / "pipe.rbl")
    result = robolang("check", *names, code=code)
    assert result.stdout.count("bad.rbl:1:4: error RBL112") == ("bad.rbl" in names)
    for name, said in (("none.rbl", "RBL701"), ("binary.rbl", "RBL104"), ("pipe.rbl", "RBL702")):
        assert (f"{name}:1:1: error {said}" in result.stderr) == (name in names)


def test_without_a_path_it_is_the_working_folder(folder):
    (folder / "deep").mkdir()
    (folder / "deep" / "more.rbl").write_text("MOV P2\n")
    result = robolang("check", code=1)
    assert [head for head in heads(result.stdout) if "RBL112" in head] == [
        "bad.rbl:1:4: error RBL112",
        "deep/more.rbl:1:1: error RBL112",
    ]
    assert "binary.rbl:1:1: error RBL104" in result.stderr
    assert robolang("check", ".", code=1).stdout == result.stdout
    assert places(robolang("check", "deep", code=1).stdout) == [(1, 1, "RBL112")]


def test_a_folder_without_programs_is_said(folder):
    (folder / "none").mkdir()
    result = robolang("check", "none", code=2)
    assert result.stdout == ""
    assert "error RBL713" in result.stderr
    assert "none" in result.stderr
    assert counted(robolang("check", "none", "--allow-empty").stderr) == 0


def test_the_programs_of_a_folder_are_counted(folder):
    (folder / "some").mkdir()
    (folder / "some" / "good.rbl").write_text("MOVE P1\n")
    assert counted(robolang("check", "some").stderr) == 1
    (folder / "some" / "inside.rbl").mkdir()  # a folder of that name is no program, but the files in it are
    (folder / "some" / "inside.rbl" / "more.rbl").write_text("MOVE P1\n")
    (folder / "some" / "binary.rbl").write_bytes(b"MOVE \xff\n")
    result = robolang("check", "some", code=1)
    assert "RBL104" in result.stderr
    assert counted(result.stderr) == 2  # a file that cannot be read is not checked


def test_files_that_are_named_are_not_counted():
    assert robolang("check", "good.rbl").stderr == ""


def test_points_are_those_that_a_run_would_use(folder):
    (folder / "p.rbl").write_text("MOVE P1\nMOVE Q\n")
    assert places(robolang("check", "p.rbl", code=1).stdout) == [(2, 6, "RBL301")]  # built in: P1 to P5
    (folder / "p.points.toml").write_text("schema = 1\n[points.Q]\npose = [1, 2, 3, 4, 5, 6]\n")
    assert places(robolang("check", "p.rbl", code=1).stdout) == [(1, 6, "RBL301")]
    (folder / "p.points.toml").unlink()
    (folder / "cell.toml").write_text((BUILTIN / "cell.toml").read_text())
    assert places(robolang("check", "p.rbl", code=1).stdout) == [(1, 6, "RBL301"), (2, 6, "RBL301")]


@pytest.mark.parametrize("link", [False, True], ids=["damaged", "dangling link"])
def test_points_that_cannot_be_read_are_a_configuration_error(folder, link):
    if link:
        (folder / "good.points.toml").symlink_to("none")
    else:
        (folder / "good.points.toml").write_text("schema = 1\n[points.P1]\npose = [1, 2, 3]\n")
    result = robolang("check", "good.rbl", "bad.rbl", code=2)
    assert ("RBL302" if link else "good.points.toml:3:1: error RBL307") in result.stderr
    assert "RBL112" in result.stdout


def test_a_text_is_checked_without_points_that_cannot_be_read(folder):
    (folder / "bad.points.toml").write_text("schema = 1\n[points.P1]\npose = [1, 2, 3]\n")
    (folder / "bad.rbl").write_text("10 MOVE P9\n20 MOV P1\n")
    result = robolang("check", "bad.rbl", code=2)
    assert places(result.stdout) == [(2, 4, "RBL112")]


def modules_after(*words):
    """Names of the heavy modules that a command has imported when it ends."""
    code = (
        "import sys, robolang.cli.main as m\n"
        "try: m.app(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        f"print('loaded', [name for name in {HEAVY} if name in sys.modules])"
    )
    result = subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        timeout=HANG_S,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    return result.stdout.splitlines()[-1]


@pytest.mark.parametrize("words", [("check", "good.rbl", "bad.rbl"), ("--help",), ("run", "--help")])
def test_checking_and_help_need_no_numerics(words):
    assert modules_after(*words) == "loaded []"


def test_the_probe_of_modules_finds_them():
    assert "numpy" in modules_after("robot", "list")


def test_nothing_of_the_working_folder_is_imported(folder):
    for name in ("lark", "numpy", "typer", "robolang_plugin"):
        (folder / f"{name}.py").write_text("raise SystemExit('planted code ran')\n")
    result = subprocess.run(
        [sys.executable, "-P", "-m", "robolang", "check", "bad.rbl"],
        capture_output=True,
        text=True,
        timeout=HANG_S,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert result.returncode == 1
    assert "RBL112" in result.stdout


@pytest.mark.parametrize("broken", ["p.cell.toml", "p.points.toml"])
def test_a_program_whose_cell_or_points_cannot_be_read_is_not_counted_as_checked(folder, broken):
    (folder / "some").mkdir()
    (folder / "some" / "p.rbl").write_text("HAND OFF\n")
    (folder / "some" / broken).write_text("schema = \n")
    result = robolang("check", "some", code=2)
    assert counted(result.stderr) == 0
    assert numbers(result.stderr.splitlines()[1]) == [1.0]
