"""``robolang render``: pictures of a program that is run for them, or of a log."""

import os
import shutil

import numpy as np
import pytest
from PIL import Image as Pillow

from robolang.execution.session import Session
from robolang.logs.files import read_log
from tests.robolang.cli.commands import ROOT, dry, robolang
from tests.runtime.plant.drawing import need_graphics

pytestmark = pytest.mark.physics

DEMO = ROOT / "programs" / "pick_and_place.rbl"
SMALL = ("--size", "120x90")


@pytest.fixture
def program(tmp_path):
    need_graphics()
    for file in DEMO.parent.glob("pick_and_place.*"):
        shutil.copy(file, tmp_path)
    path = tmp_path / DEMO.name
    path.write_text("30 MOVE P1\n")  # 0.7 s of motion
    return path


def image(path):
    return np.asarray(Pillow.open(path).convert("RGB")).astype(int)


def test_a_program_is_run_and_drawn(program):
    result = robolang("render", program, "--no-physics", *SMALL)
    path = program.with_suffix(".png")
    assert result.stdout.startswith(f"{path}: ")
    assert image(path).shape == (90, 120, 3)
    # what a run shows, then what draws
    assert "MOVE P1" in result.stderr
    assert result.stderr.split()[-1] in ("EGL", "OSMesa")


def test_a_log_gives_the_picture_of_its_program(program, tmp_path):
    log = tmp_path / "run.npz"
    dry(program, "--quiet", "--log", log)
    robolang("render", log, "-o", tmp_path / "log.png", "--at", 0.2, *SMALL)
    robolang("render", program, "--no-physics", "-o", tmp_path / "program.png", "--at", 0.2, *SMALL)
    robolang("render", log, "-o", tmp_path / "end.png", *SMALL)
    assert np.array_equal(image(tmp_path / "log.png"), image(tmp_path / "program.png"))
    assert not np.array_equal(image(tmp_path / "log.png"), image(tmp_path / "end.png"))
    assert read_log(log).needed_meta()["scene"]["robot"] == "puma560"


def test_a_film_shows_how_far_it_is(program, tmp_path):
    log = tmp_path / "run.npz"
    dry(program, "--quiet", "--log", log)
    result = robolang("render", log, "-o", tmp_path / "x.webp", "--fps", 14, "--size", "48x32")
    lines = result.stderr.splitlines()
    count = int(lines[0].split()[1])
    assert count == int(read_log(log)["t"][-1] * 14) + 2
    assert lines[-1] == f"{count} of {count} pictures"
    assert len(lines) == 11


def test_the_camera_of_a_cell_is_the_usual_view(program):
    cell = program.with_suffix(".cell.toml")
    cell.write_text(cell.read_text() + "\n[camera]\nposition_mm = [0, 1, 9000]\ntarget_mm = [0, 0, 0]\n")
    robolang("render", program, "--no-physics", *SMALL)
    above = image(program.with_suffix(".png"))
    robolang("render", program, "--no-physics", "--view", "iso", *SMALL)
    assert np.abs(above - image(program.with_suffix(".png"))).mean() > 10
    cell.write_text(cell.read_text().replace("[0, 1, 9000]", "[0, 1, 9]"))
    result = robolang("render", program, "--no-physics", *SMALL, code=2)
    assert "RBL605" in result.stderr


def test_a_run_that_ends_with_an_alarm_is_drawn_and_leaves_with_3(program, monkeypatch):
    run = Session.run

    def stopped(self):
        cycle, count = self.controller.cycle, iter(range(10**6))

        def counted():
            if next(count) == 60:
                self.request_stop()
            return cycle()

        monkeypatch.setattr(self.controller, "cycle", counted)
        return run(self)

    monkeypatch.setattr(Session, "run", stopped)
    result = robolang("render", program, "--no-physics", *SMALL, code=3)
    assert "RBL530" in result.stderr
    assert image(program.with_suffix(".png")).shape == (90, 120, 3)


def test_a_program_with_an_error_is_not_drawn(program):
    program.write_text("10 MOVE NOWHERE\n")
    assert "RBL3" in robolang("render", program, "--no-physics", *SMALL, code=1).stderr
    assert not program.with_suffix(".png").exists()


@pytest.mark.parametrize(
    ("words", "code", "named"),
    [
        (("-o", "x.jpg"), 2, "RBL832"),
        (("-o", "pick_and_place.rbl"), 2, "--out"),
        (("-o", "other.npz"), 2, "--out"),
        (("--size", "big"), 2, "--size"),
        (("--size", "9x9"), 2, "RBL832"),
        (("-o", "x.mp4", "--size", "31x32"), 2, "RBL832"),
        (("-o", "x.gif", "--at", "1"), 2, "RBL832"),
        (("--at", "nan"), 2, "RBL832"),
        (("--at", "99"), 2, "RBL832"),
        (("--fps", "0"), 2, "--fps"),
        (("-o", "x.png", "--fps", "5"), 2, "RBL703"),
        (("--view", "below"), 2, "--view"),
        (("-o", "nowhere/x.png"), 4, "RBL706"),
    ],
)
def test_what_cannot_be_drawn_is_refused_and_nothing_is_left(program, monkeypatch, words, code, named):
    monkeypatch.chdir(program.parent)
    before = sorted(os.listdir())
    result = robolang("render", program.name, "--no-physics", *words, code=code)
    assert named in result.stderr
    assert sorted(os.listdir()) == before


def test_files_of_a_cell_are_no_matter_of_a_log(program, tmp_path):
    log = tmp_path / "run.npz"
    log.write_bytes(b"no log")
    assert "RBL619" in robolang("render", log, code=2).stderr
    assert "--cell" in robolang("render", log, "--cell", "x.cell.toml", code=2).stderr
    assert "RBL600" in robolang("render", tmp_path / "absent.npz", code=2).stderr
