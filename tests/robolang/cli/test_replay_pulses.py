"""``robolang replay-pulses``: table, object and plots of folders written by hand, and what it does not take."""

import json
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from robolang.cli.commands import replay_pulses as module
from robolang.execution.plot import HEIGHT, LEFT, RIGHT, TOP, WIDTH, Curve, Labels, as_svg, stacked
from tests.messages import fields, numbers
from tests.robolang.cli.commands import ROOT, flat, places, robolang
from tests.robolang.pulse_tables.test_drive import puma, swing
from tests.runtime.pulses import Handmade, staircase, turntable

SVG = "{http://www.w3.org/2000/svg}"
CELL = ROOT / "programs" / "pick_and_place.cell.toml"


@pytest.fixture
def stairs(tmp_path):
    return staircase().write(tmp_path / "out")


def table(text):
    """The lines of the table: what stands below it is of any length."""
    return [line for line in text.splitlines() if not re.match(r"\d+ moves?, |simulated arm|warning|stopped", line)]


def rows(text):
    """The rows of the table by their line number: statement and figures."""
    return {
        int(number): [cell for cell in re.split(r"  +", rest.strip()) if cell]
        for number, rest in re.findall(r"^ *\d+ +(\d+)  (\S.*)$", text, re.M)
    }


# --- the table -------------------------------------------------------------------------------------------------------


def test_the_table_shows_moves_and_markers_in_their_places(stairs):
    result = robolang("replay-pulses", stairs)
    assert fields(result.stdout.splitlines()[0]) == {"by_hand.rbl", "10", "ms"}
    assert list(rows(result.stdout).items()) == [
        (10, ["LOAD (0, 0, 60), 0.8"]),
        (20, ["HAND OFF", "0.300"]),
        (30, ["MOVE P1", "6", "0.060", "30000 X", "2.4000", "1.8000", "0.0000"]),
        (40, ["MOVE P2", "4", "0.040", "4000 X", "0.0000", "0.0000", "0.0000"]),
    ]
    assert numbers(result.stdout.splitlines()[-1]) == [2, 10, 0.4, 1600, 2.4, 3, 30]
    assert result.stderr == ""


def test_the_table_fits_80_columns_whatever_stands_in_the_program(tmp_path):
    export = staircase()
    export.sequence[0]["text"] = "LOAD (" + "1 + " * 30 + "1, 0, 0), 0.8"
    export.sequence[1]["text"] = "HAND\x1b[b]OFF"
    export.sequence[2] |= {"number": None, "line": 123_456_789}
    export.channels[0] = ("a channel", *export.channels[0][1:])
    for move in export.sequence[2:]:
        move["tables"]["a channel"] = move["tables"].pop("X")
    result = robolang("replay-pulses", export.write(tmp_path / "out"))
    assert max(map(len, table(result.stdout))) <= 80
    assert "\x1b" not in result.stdout
    assert "HAND\ufffd[b" in result.stdout
    assert "LOAD (1 …" in result.stdout
    assert "123456789       MOVE P1" in result.stdout


def test_one_move_without_a_pulse_and_none_at_all(tmp_path):
    export = staircase()
    export.sequence = export.sequence[:2]
    export.files = {}
    assert numbers(robolang("replay-pulses", export.write(tmp_path / "a")).stdout.splitlines()[-1]) == [0, 0, 0.3, 0]
    export.at = {"X": 100, "Y": 50}
    export.move(3, (1, -1, 120), (1, -1, 120))
    result = robolang("replay-pulses", export.write(tmp_path / "b"), "--plot", tmp_path / "p.svg")
    assert rows(result.stdout)[30] == ["MOVE P1", "0", "0.000", "-", "0.0000", "0.0000", "0.0000"]
    assert numbers(result.stdout.splitlines()[-1])[:2] == [1, 0]


# --- the object ------------------------------------------------------------------------------------------------------


def test_json_holds_the_figures_in_full_and_repeats(tmp_path):
    folder = turntable().write(tmp_path / "out")
    first, second = (robolang("replay-pulses", folder, "--json").stdout for _ in range(2))
    assert first == second
    found = json.loads(first)
    sagitta = 300.0 * (1.0 - math.cos(math.radians(10.0)))
    move = found["sequence"][0]
    assert move.pop("end_mm") == pytest.approx(0.0, abs=1e-9)
    assert move == {
        "kind": "move",
        "line": 1,
        "number": 10,
        "text": "MOVE P1",
        "steps": 2,
        "seconds": 0.02,
        "pulses": {"T": 400, "R": 0},
        "highest_hz": 20000.0,
        "highest_channel": "T",
        "rows_mm": pytest.approx(sagitta),
        "real": None,
        "between_mm": pytest.approx(300.0 * (math.cos(math.radians(2.5)) - math.cos(math.radians(10.0)))),
    }
    assert found == {
        "folder": str(folder),
        "program": "by_hand.rbl",
        "mechanism": {"kind": "cylindrical", "name": "cylindrical"},
        "step_s": 0.01,
        "seconds": 0.02,
        "path_error_mm": pytest.approx(sagitta),
        "sequence": [move],
        "physics": None,
        "channels": [
            {"name": "T", "unit": "deg", "per_pulse": 0.05, "pulses": 400, "highest_hz": 20000.0},
            {"name": "R", "unit": "mm", "per_pulse": 0.01, "pulses": 0, "highest_hz": 0.0},
        ],
    }


def test_markers_are_in_the_object_too(stairs):
    sequence = json.loads(robolang("replay-pulses", stairs, "--json").stdout)["sequence"]
    assert [item["kind"] for item in sequence] == ["marker", "marker", "move", "move"]
    assert sequence[1] == {"kind": "marker", "line": 2, "number": 20, "text": "HAND OFF", "dwell_s": 0.3}


# --- how far is too far ----------------------------------------------------------------------------------------------


def test_tables_that_lead_too_far_from_a_line_are_exit_code_1(stairs):
    result = robolang("replay-pulses", stairs, "--max-error", "2.39", code=1)
    assert result.stderr.startswith("error RBL635 line 3 (number 30), MOVE P1: ")
    assert {"2.4000", "2.39", "mm"} <= fields(result.stderr)
    assert "2 moves" in result.stdout
    assert robolang("replay-pulses", stairs, "--max-error", "2.41").stderr == ""


def test_the_end_of_a_line_counts_and_the_worst_move_is_named(tmp_path):
    export = staircase()
    export.sequence[3] |= {"end_mm": [5.0, 11.0, 120.0], "number": None}
    folder = export.write(tmp_path / "out")
    result = robolang("replay-pulses", folder, "--json", "--max-error", "3", code=1)
    assert {"RBL635", "4", "MOVE", "P2", "4.0000", "mm"} <= fields(result.stderr)
    assert json.loads(result.stdout)["path_error_mm"] == pytest.approx(4.0)
    assert numbers(robolang("replay-pulses", folder).stdout.splitlines()[-1])[-2:] == [4.0, 4]


# --- the real arm ----------------------------------------------------------------------------------------------------


@pytest.mark.physics
def test_the_real_arm_is_driven_and_stands_in_the_table(tmp_path):
    export = puma()
    export.load(1)
    swing(2, export, 5.0)
    folder = export.write(tmp_path / "out")
    result = robolang("replay-pulses", folder, "--physics", "--cell", CELL)
    assert fields(result.stderr) == {"puma560", "1.0", "s"}
    assert max(map(len, table(result.stdout))) <= 80
    *_, at_rows, _, _, real = map(float, rows(result.stdout)[20][-4:])
    assert at_rows == pytest.approx(0.502, abs=0.01)  # 528 mm (1 - cos 2.5 deg)
    assert real == pytest.approx(0.502, abs=0.1)
    seconds, *others = numbers(result.stdout.splitlines()[-1])
    assert 1.0 <= seconds < 2.0
    assert others == [pytest.approx(real, abs=5e-4), 2, 20]
    found = json.loads(robolang("replay-pulses", folder, "--physics", "--cell", CELL, "--json").stdout)
    assert round(found["sequence"][1]["real"]["error_mm"], 3) == real
    assert (found["physics"]["alarms"], found["physics"]["warnings"]) == ([], [])


@pytest.mark.physics
def test_an_arm_that_is_not_in_position_is_noted_and_one_with_an_alarm_is_exit_code_3(tmp_path):
    export = puma()
    export.load(1, mass=2.5, cog=(200, 0, 200))
    swing(2, export, 5.0)
    export.max_hz = 1e6
    start = export.at["J1"]
    export.move(3, (0, 0, 0), (1, 0, 0), J1=[start + 3000 * k for k in range(1, 17)])
    swing(4, export, 1.0)
    words = ("replay-pulses", export.write(tmp_path / "out"), "--physics", "--cell", CELL)
    result = robolang(*words, code=3)
    assert re.search(r"^warning .*line 2 \(number 20\), 2\.\d\d\d s: RBL523 ", result.stdout, re.M)
    axis = re.search(r"^stopped .*line 3 \(number 30\), 2\.\d\d\d s: RBL5\d\d J(\d) ", result.stdout, re.M)[1]
    assert rows(result.stdout)[40][-1] == "-"
    found = json.loads(robolang(*words, "--json", "--max-error", "0.1", code=3).stdout)
    assert found["sequence"][3]["real"] is None
    (alarm,) = found["physics"]["alarms"]
    assert (alarm["line"], alarm["number"], alarm["axis"]) == (3, 30, int(axis))


# --- the plots -------------------------------------------------------------------------------------------------------


def polyline(element):
    return np.array([[float(x) for x in point.split(",")] for point in element.get("points").split()])


def drawn(path):
    """The two plots of a file: the curves of each."""
    root = ElementTree.fromstring(path.read_text("utf-8"))
    plots = root.findall(f"{SVG}svg")
    return root, plots, [[polyline(line) for line in plot.iter(f"{SVG}polyline")] for plot in plots]


def test_an_svg_holds_frequencies_above_path_error(stairs, tmp_path):
    path = tmp_path / "p.svg"
    robolang("replay-pulses", stairs, "--plot", path)
    root, plots, (frequencies, errors) = drawn(path)
    assert len(plots) == 2
    height = HEIGHT + 18 + 14  # a row of names, the names of the marks
    assert root.get("viewBox") == f"0 0 {WIDTH} {2 * height}"
    assert [(plot.get("y"), plot.get("width"), plot.get("height")) for plot in plots] == [
        ("0", str(WIDTH), str(height)),
        (str(height), str(WIDTH), str(height)),
    ]
    texts = [[text.text for text in plot.iter(f"{SVG}text")] for plot in plots]
    assert {"frequency, kHz", "X", "Y", "3", "4", "time, s"} <= set(texts[0])
    assert {"path error, mm", "3", "4", "tool point"} <= set(texts[1])
    # 0.4 s over the width, 50 kHz over the height: X at 30 kHz from 0.3 to 0.31 s, Y at -20 kHz after that
    x_of = [LEFT + (WIDTH - LEFT - RIGHT) * t / 0.4 for t in (0.3, 0.31, 0.32)]
    x, y = frequencies
    top, bottom = min(x[:, 1]), max(y[:, 1])
    assert [point.tolist() for point in x if point[1] == top][:2] == [
        [pytest.approx(x_of[0], abs=0.06), top],
        [pytest.approx(x_of[1], abs=0.06), top],
    ]
    assert [point.tolist() for point in y if point[1] == bottom][:2] == [
        [pytest.approx(x_of[1], abs=0.06), bottom],
        [pytest.approx(x_of[2], abs=0.06), bottom],
    ]
    (error,) = errors
    assert error[np.argmin(error[:, 1]), 0] == pytest.approx(x_of[1], abs=0.06)
    assert error[0, 0] == pytest.approx(LEFT, abs=0.06)
    assert error[-1, 0] == pytest.approx(WIDTH - RIGHT, abs=0.06)


def test_a_page_holds_both(stairs, tmp_path):
    path = tmp_path / "p.html"
    robolang("replay-pulses", stairs, "--plot", path)
    text = path.read_text("utf-8")
    assert text.startswith("<!doctype html>")
    assert "<title>by_hand.rbl: " in text
    assert text.count("<svg ") == 2


def test_small_errors_and_low_frequencies_have_small_units(tmp_path):
    export = Handmade(
        {"kind": "cartesian", "name": "xy", "axes": ["x", "y"], "z_mm": 0},
        [("<X>", "mm", 0.001, 0), ("Y", "mm", 0.001, 0)],
    )
    export.move(1, (0, 0, 0), (0.06, 0.08, 0), **{"<X>": [60, 60], "Y": [0, 80]})
    robolang("replay-pulses", export.write(tmp_path / "out"), "--plot", tmp_path / "p.svg")
    _, plots, _ = drawn(tmp_path / "p.svg")
    texts = [text.text for plot in plots for text in plot.iter(f"{SVG}text")]
    assert {"frequency, Hz", "<X>", "path error, µm", "50", "8000"} <= set(texts)


def test_a_program_name_that_no_file_can_hold_is_drawn(tmp_path):
    export = staircase()
    folder = export.write(tmp_path / "out")
    manifest = export.manifest | {"program": "\ud800\x00<&>" + 60 * "x"}
    (folder / "manifest.json").write_text(json.dumps(manifest), "utf-8")
    robolang("replay-pulses", folder, "--plot", tmp_path / "p.svg")
    root, *_ = drawn(tmp_path / "p.svg")
    title = next(root.iter(f"{SVG}text")).text
    assert title.startswith("\ufffd\ufffd<&>xxx")
    assert "x…: frequency" in title


def test_no_peak_is_lost_where_a_curve_has_more_points_than_the_plot(tmp_path):
    """One step of 4000 goes 30 kHz, all others 1 kHz; the name of a mark stands only where there is room for it."""
    export = Handmade({"kind": "cartesian", "name": "x", "axes": ["x"], "y_mm": 0, "z_mm": 0}, [("X", "mm", 0.01, 0)])
    at = 0
    for move in range(40):
        targets = []
        for k in range(100):
            at += 300 if (move, k) == (17, 33) else 10
            targets.append(at)
        export.move(move + 1, (0, 0, 0), (1, 0, 0), X=targets)
    robolang("replay-pulses", export.write(tmp_path / "out"), "--plot", tmp_path / "p.svg")
    _, plots, ((curve,), (error,)) = drawn(tmp_path / "p.svg")
    assert len(curve) < 800
    assert len(error) < 800
    peak = np.flatnonzero(curve[:, 1] == curve[:, 1].min())
    assert curve[peak, 0] == pytest.approx(LEFT + (WIDTH - LEFT - RIGHT) * 17.335 / 40.0, abs=0.6)
    assert np.median(curve[:, 1]) - curve[peak[0], 1] > 200.0
    above = f"{TOP - 4:.1f}"
    named = [text.text for text in plots[0].iter(f"{SVG}text") if text.get("y") == above and text.text]
    marks = [line for line in plots[0].iter(f"{SVG}line") if line.get("stroke-dasharray") == "3 3"]
    assert len(marks) == 40
    assert named[8:12] == ["9", "10", "12", "14"]  # 14 pixels apart: two digits need more


def test_the_plot_is_tried_before_anything_is_played(stairs, tmp_path, monkeypatch):
    monkeypatch.setattr("runtime.pulses.replay.replay", lambda *_: pytest.fail("it was played"))
    result = robolang("replay-pulses", stairs, "--plot", tmp_path / "none" / "p.svg", code=4)
    assert "RBL706" in fields(result.stderr)


def test_stacked_plots_keep_their_heights():
    curve = Curve(name="a", x=np.array([0.0, 1.0]), y=np.array([0.0, 1.0]))
    labels = Labels(title="t", x="x", y="y")
    low, high = as_svg(labels, [curve]), as_svg(labels, [curve], corner="above")
    root = ElementTree.fromstring(stacked([low, high, low]))
    assert [plot.get("y") for plot in root] == ["0", str(HEIGHT), str(2 * HEIGHT + 18)]
    assert root.get("viewBox") == f"0 0 {WIDTH} {3 * HEIGHT + 18}"


# --- what it does not take -------------------------------------------------------------------------------------------

BAD = [
    (["--plot", "p.png"], "RBL703 --plot p.png .svg .html"),
    (["--max-error", "-1"], "RBL703 --max-error -1"),
    (["--max-error", "nan"], "RBL703 --max-error"),
    (["--max-error", "inf"], "RBL703 --max-error"),
    (["--physics"], "RBL703 --physics --cell FILE.toml"),
    (["--cell", "c.toml"], "RBL703 --cell --physics"),
    (["--physics", "--cell", "nothing.toml"], "RBL600"),
    (["--physics", "--cell", CELL], "RBL634 puma560"),
]


@pytest.mark.parametrize(("words", "said"), BAD, ids=[said for _, said in BAD])
def test_options_that_cannot_be(stairs, monkeypatch, words, said):
    monkeypatch.setattr(module, "_print", lambda *_: pytest.fail("it was played"))
    assert set(said.split()) <= fields(flat(robolang("replay-pulses", stairs, *words, code=2).stderr))


def test_a_folder_that_is_none_is_exit_code_2(tmp_path):
    assert "RBL630" in fields(robolang("replay-pulses", tmp_path / "none", code=2).stderr)
    assert "Missing argument" in flat(robolang("replay-pulses", code=2).stderr)


def test_a_row_that_cannot_be_is_shown_at_its_place(stairs):
    path = stairs / "01_line30_Y.csv"
    path.write_text(path.read_text().replace("wait,0,-150,1", "wait,0,-151,1"))
    result = robolang("replay-pulses", stairs, code=2)
    assert places(result.stderr) == [(6, 8, "RBL631")]
    assert result.stderr.splitlines()[1:3] == ["   6 | wait,0,-151,1", "     |        ^"]
    assert result.stdout == ""
