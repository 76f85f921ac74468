"""The panel of a run: what it shows at which size, how often it is painted, and through a terminal."""

import io
import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from robolang.cli import run_panel
from robolang.cli.console import Console
from robolang.cli.run_panel import JointShown, Panel, PanelProgress, panel
from robolang.core.source import Span
from robolang.execution.outlook import Outlook, TimeLeft
from robolang.execution.result import StatementRun
from robolang.interpreter.effects import Origin
from runtime.core.faults import Alarm
from runtime.robot.model.axis_kind import REVOLUTE
from tests.campaign import size, some
from tests.robolang.cli.commands import dry
from tests.robolang.pendant.terminal import Terminal
from tests.together import together

JOINTS = tuple(
    JointShown(name=f"J{k}", value=-180.0 + 60.0 * k, unit="deg", share=k / 7.0, torque_pct=(-1) ** k * 16.0 * k)
    for k in range(1, 7)
)
PANEL = Panel(
    time_s=3.0,
    left=TimeLeft(seconds=1.0, waiting=False),
    where="line 9 (number 60)",
    text="MOVE P2, SPEED 250",
    lamp="WRIST",
    alarm="",
    speed_mm_s=249.6,
    joints=JOINTS,
)
NO_NUMBER = replace(JOINTS[0], value=np.nan, share=None, torque_pct=np.nan)


def painted(shown, width, height, encoding="utf-8"):
    console = Console()
    console.file = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    console._force_terminal, console.size = True, (width, height)
    console._color_system = None
    with console.capture() as capture:
        console.print(shown)
    return re.sub(r"\x1b\[[0-9;]*m", "", capture.get()).splitlines()


@together(
    "case",
    product(
        [10, 20, 40, 60, 80, 200],
        [2, 3, 4, 9, 10, 24],
        [None, PANEL.left, TimeLeft(seconds=1799.9, waiting=True)],
        ["utf-8", "ascii"],
    ),
)
def test_it_fits_every_terminal(case):
    width, height, left, encoding = case
    shown = replace(PANEL, left=left, text="PRINT " + '"日本"' * 40, joints=(*JOINTS[1:], NO_NUMBER))
    lines = painted(shown, width, height, encoding)
    assert len(lines) == (9 if height >= 10 else 3 if height >= 4 else 1)
    console = Console()
    assert max(console.measure(line).maximum for line in lines) < width
    if encoding == "ascii":
        assert set("".join(lines)) - set("日本") <= set(map(chr, range(32, 127)))


@pytest.mark.parametrize("width", [40, 60, 80])
def test_every_fact_is_there(width):
    first, second, third, *rows = painted(PANEL, width, 24)
    assert re.search(r" 75 %  .*\b1\.0 s", first)
    assert second.startswith("line 9 (number 60)  [WRIST]  MOVE P2")
    assert third.split() == ["3.000", "s", "tool", "250", "mm/s"]
    for joint, row in zip(JOINTS, rows, strict=True):
        name, value, unit, *_, torque, percent = row.split()
        assert (name, float(value), unit) == (joint.name, joint.value, "deg")
        assert (float(torque), percent) == (joint.torque_pct, "%")
        rail = re.search(r"├(─*)●(─*)┤", row)
        length = len(rail[1]) + len(rail[2]) + 1
        assert len(rail[1]) == int(joint.share * length)


def test_torques_have_bars_to_their_side_where_there_is_room():
    rows = painted(PANEL, 100, 24)[3:]
    bars = [re.search(r"┤ +(■*)│(■*) ", row) for row in rows]
    assert [len(bar[2]) - len(bar[1]) for bar in bars] == [round(9 * joint.torque_pct / 100.0) for joint in JOINTS]
    (full,) = painted(replace(PANEL, joints=(NO_NUMBER,)), 100, 24)[3:]
    assert "■" * 9 in full
    assert full.split()[:2] == ["J1", "nan"]


def test_where_the_time_is_not_known_there_is_no_number():
    first = painted(replace(PANEL, left=None), 80, 24)[0]
    assert not re.search(r"\d|%|━", first)


def test_an_alarm_takes_the_place_of_the_statement():
    lines = painted(replace(PANEL, alarm="RBL530 stopped"), 80, 24)
    assert "RBL530" in lines[1]
    assert "MOVE" not in lines[1]


@pytest.mark.parametrize(("angle", "share"), [(0.0, 0.5), (-1.0, 0.0), (np.nan, None), (np.inf, None)])
def test_the_place_in_a_range(angle, share):
    limits = type("Limits", (), {"lower": -1.0, "upper": 1.0, "kind": REVOLUTE})
    assert run_panel._joint(1, limits, angle, 0.0).share == share


class Recorded:
    """A terminal that counts how often something is painted."""

    def __init__(self, monkeypatch, times, fails=False):
        self.now, self.painted, self.fails = iter(times), [], fails
        monkeypatch.setattr(run_panel, "wall_s", lambda: next(self.now))
        monkeypatch.setattr(run_panel, "Live", lambda **how: self)

    def start(self):
        if self.fails:
            raise OSError(5, "no terminal")

    def stop(self):
        self.painted.append(None)

    def update(self, shown, *, refresh):
        assert refresh
        self.painted.append(shown)


RUN = StatementRun(origin=Origin(line=3, span=Span(0, 4)), text="DELAY 9", first_tick=0)


@pytest.mark.parametrize(("step", "count"), [(0.0, 1), (0.011, 12), (0.25, 100)])
def test_it_is_painted_ten_times_a_second_at_most(monkeypatch, step, count):
    terminal = Recorded(monkeypatch, [100.0 + step * k for k in range(100)])
    progress = PanelProgress(Console(stderr=True), Outlook(()))
    progress.run_began(RUN, 0)
    for cycle in range(1, 100):
        progress.cycle_done(8_000 * cycle)
    assert abs(len(terminal.painted) - count) <= 2


def test_a_terminal_that_has_gone_does_not_end_the_run(monkeypatch):
    terminal = Recorded(monkeypatch, [0.0, 10.0, 20.0], fails=True)
    with panel(()) as progress:
        progress.run_began(RUN, 0)
        progress.cycle_done(8_000)
    assert terminal.painted == []


def test_an_alarm_is_kept_for_the_next_turn(monkeypatch):
    terminal = Recorded(monkeypatch, [0.0, 10.0])
    progress = PanelProgress(Console(stderr=True), Outlook(()))
    progress.run_began(RUN, 0)
    progress.alarm(Alarm(code="RBL530", message="halt \x1b[2J", tick=0, category=1))
    progress.cycle_done(8_000)
    assert [shown.alarm.partition(" ")[0] for shown in terminal.painted] == ["", "RBL530"]
    assert "\x1b" not in terminal.painted[-1].alarm


# --- through a terminal ----------------------------------------------------------------------------------------------

ROWS = size(40, 16)
COUNTED = f"""FOR I = 1 TO {ROWS}
  PRINT "row "; I
  MOVEJ JOINT(0, 77, -183, 0, -74 + I, 0)
NEXT I
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.rbl").write_text(COUNTED)
    return tmp_path


@pytest.mark.parametrize(("columns", "rows"), some([(100, 30), (40, 12), (30, 4)], 0, 2))
def test_what_is_printed_stays_whole_and_the_panel_goes(folder, columns, rows):
    terminal = Terminal(folder, "p.rbl", "--report", "r.json", columns=columns, rows=rows, command="run")
    terminal.screen.resize(400, columns)
    assert terminal.ended() == 0
    shown = [line for line in terminal.lines if line.startswith("row")]
    assert shown == [f"row {k}" for k in range(1, ROWS + 1)]
    assert not terminal.shows("mm/s   ")
    assert not any("━" in line and "%" in line for line in terminal.lines)
    assert not terminal.screen.cursor.hidden


def test_it_is_seen_while_the_program_runs(folder):
    (folder / "p.rbl").write_text("10 MOVEJ JOINT(0, 77, -183, 0, -50, 0)\n20 DELAY 3\n")
    terminal = Terminal(folder, "--realtime", "p.rbl", columns=80, rows=24, command="run")
    lines = terminal.until("line 2 (number 20)  DELAY 3", "tool     0 mm/s", " s left")
    rows = [line.split() for line in lines if line.startswith("J")]
    assert [(name, unit) for name, _, unit, *_ in rows] == [(f"J{k}", "deg") for k in range(1, 7)]
    assert [float(row[1]) for row in rows] == pytest.approx([0.0, 77.0, -183.0, 0.0, -50.0, 0.0], abs=0.2)
    assert terminal.ended() == 0


def test_the_log_is_the_same_as_without_it(folder):
    terminal = Terminal(folder, "p.rbl", "--log", "a.npz", command="run")
    assert terminal.ended() == 0
    assert b"\x1b[?25l" in terminal.raw
    dry("p.rbl", "--quiet", "--log", "b.npz")
    assert (folder / "a.npz").read_bytes() == (folder / "b.npz").read_bytes()


@pytest.mark.parametrize("words", some([{"TERM": "dumb"}, {"TERM": "unknown"}, {"quiet": "--quiet"}], 0, 2))
def test_a_terminal_of_lines_gets_lines_and_a_quiet_run_nothing(folder, words):
    quiet = [words.pop("quiet")] if "quiet" in words else []
    terminal = Terminal(folder, "p.rbl", *quiet, command="run", **words)
    assert terminal.ended() == 0
    assert b"\x1b" not in terminal.raw
    begun = [line for line in terminal.raw.decode().splitlines() if " s  line " in line]
    assert len(begun) == (0 if quiet else 2 * ROWS)
