"""The speed of the tool along its path: its places, its programmed steps, and what is no path."""

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.logs.files import read_log, write_log
from robolang.project.project import load_project
from robolang.view.log_plot import Window
from robolang.view.path_plot import path_plot
from runtime.core.faults import Fault
from tests.robolang.cli.commands import robolang
from tests.robolang.logs.made import log as made_log

pytestmark = pytest.mark.physics

TEXT = """MOVE HERE + (0, 60, 0), SPEED 200
DELAY 0.5
TOOL POSE(0, 0, 200, 0, 0, 0)
MOVE HERE + (0, 0, 40), SPEED 100, ZONE 5
MOVE HERE + (0, 30, 0), SPEED 50
MOVEJ HERE + (0, 20, 0)
"""


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return ran(tmp_path_factory.mktemp("path") / "p.rbl", TEXT)


def ran(path, text):
    path.write_text(text)
    project = load_project(path)
    assert project.ok, project.diagnostics
    return Session(project, physics=False).run().log


def at(line, place):
    return float(line.y[np.argmin(np.abs(line.x - place))])


def test_speeds_stand_over_the_length_of_the_path(log):
    found = path_plot(log, Window())
    (panel,) = found.panels
    commanded, programmed = panel.lines
    assert (found.axis.split(", ")[1], panel.label.split(", ")[1]) == ("mm", "mm/s")
    # 60 mm, the corner a little shorter than 40 and 30 mm, and a joint move that is nearly straight
    assert found.last == pytest.approx(150.0, abs=6.0)
    assert [at(programmed, place) for place in (5, 55, 70, 110)] == [200.0, 200.0, 100.0, 50.0]
    assert np.isnan(at(programmed, 140))
    assert at(commanded, 30) == pytest.approx(200.0, rel=0.02)
    assert at(commanded, 80) == pytest.approx(100.0, rel=0.02)
    assert at(commanded, 60) < 20.0
    # an exchanged tool is 80 mm further out at once
    assert commanded.y.max() < 1000.0
    assert np.ptp(np.diff(commanded.x)) < 1e-9
    blocks = {block.number: (block.begins, block.ends) for block in found.blocks}
    assert blocks["1"] == (0.0, pytest.approx(60.0, abs=0.1))
    assert blocks["2"] == (pytest.approx(60.0, abs=0.1), pytest.approx(blocks["2"][0], abs=1e-6))
    assert blocks["4"][1] == pytest.approx(100.0, abs=3.0)
    assert found.as_svg() == path_plot(log, Window()).as_svg()


def test_the_command_writes_it_beside_the_log(log, tmp_path):
    write_log(tmp_path / "run.npz", log)
    robolang("plot", tmp_path / "run.npz", "--along-path")
    assert (tmp_path / "run-path.svg").read_text("utf-8") == path_plot(
        read_log(tmp_path / "run.npz"), Window()
    ).as_svg()


def test_a_window_begins_at_its_own_place(log):
    found = path_plot(log, Window(first=0.0, last=0.2))
    assert 0.0 < found.last < 60.0
    with pytest.raises(ValueError, match="times"):
        path_plot(log, Window(first=0.1, last=0.1))


def test_a_joint_move_has_the_curve_alone_and_a_log_without_motion_is_refused(tmp_path):
    still = made_log(1)
    with pytest.raises(Fault) as refused:
        path_plot(still, Window())
    assert refused.value.code == "RBL832"
    (panel,) = path_plot(ran(tmp_path / "p.rbl", "MOVEJ HERE + (0, 50, 0)\n"), Window()).panels
    assert [each.name for each in panel.lines] == ["commanded"]
