"""A whole session through a pseudo-terminal: from an empty folder to the bytes of a log."""

import pytest

from tests.robolang.cli.commands import robolang
from tests.robolang.pendant.terminal import Terminal

TAUGHT = [
    ("jog Z -100", "Z 740.000", "teach ABOVE", "ABOVE = JOINT"),
    ("jog Z -100", "Z 640.000", "teach PICK pose", "PICK = POSE"),
    ("jog Z 200", "Z 840.000", "teach HIGH", "HIGH = JOINT"),
    ("jog Y 440", "Y 220.000  Z 840.000", "teach OVER", "OVER = JOINT"),
    ("jog Z -200", "Y 220.000  Z 640.000", "teach PUT pose", "PUT = POSE"),
]
PROGRAM = """\
10 LOAD (0, 0, 60), 0.8
20 HAND OFF
30 MOVE ABOVE
40 MOVE PICK
50 HAND ON
60 LOAD (0, 0, 95), 2.3
70 MOVE HIGH
80 MOVE OVER
90 MOVE PUT
100 HAND OFF
110 LOAD (0, 0, 60), 0.8
120 MOVE OVER
"""


@pytest.mark.physics
def test_a_session_from_an_empty_folder_equals_a_run_of_its_files(tmp_path, monkeypatch):
    terminal = Terminal(tmp_path, physics=True, columns=120, rows=40)

    typed = terminal.enter
    try:
        terminal.until("limit J")
        typed("LOAD (0, 0, 60), 0.8")
        for jog, there, teach, taught in TAUGHT:
            typed(jog, there)
            typed(teach, taught)
        for line in PROGRAM.splitlines():
            typed(line)
        typed("step", "next: 20 HAND OFF")
        typed("step", "next: 30 MOVE ABOVE")
        typed("step", "next: 40 MOVE PICK")
        typed("back", "next: 30 MOVE ABOVE")
        typed("step", "next: 40 MOVE PICK")  # from beside the part the arm would sweep it away
        typed("go PICK", "Z 640.000")
        typed("jog Z -1", "Z 639.000")
        typed("touchup PICK", "1.000 mm, 0.000 deg", then="Replace PICK? (y/n)")
        typed("y", "PICK = POSE(480, -220, 639, 180, 0, 180)")
        typed("again", "start state")
        typed("run", "the program has ended")
        typed("save as job", "saved: job.points.toml, job.rbl")
        typed("log session.npz", "session.npz:")
        terminal.send("quit\r")
        assert terminal.ended() == 0
    finally:
        terminal.close()
    saved = [line.split() for line in (tmp_path / "job.rbl").read_text().splitlines()]
    assert saved == [line.split() for line in PROGRAM.splitlines()]  # the formatter aligns the numbers
    monkeypatch.chdir(tmp_path)
    robolang("run", "job.rbl", "--log", "run.npz")
    assert (tmp_path / "run.npz").read_bytes() == (tmp_path / "session.npz").read_bytes()
