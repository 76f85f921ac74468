"""``robolang wrist-demo``: the figures of CN103429397A have the numbers of the acceptance table (docs/wrist.md)."""

import json
import re
import subprocess
import sys
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from robolang.execution.plot import BOTTOM, COLOURS, HEIGHT, LEFT, RIGHT, TOP, WIDTH, Curve, Dots, Labels, Mark, as_svg
from robolang.experiments import wrist_figures as demo
from runtime.core.faults import Fault
from runtime.core.units import DEG
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, flat, robolang
from tests.steps import HANG_S

SVG = "{http://www.w3.org/2000/svg}"
LIBRARY = ROOT / "runtime" / "robot" / "library"
IRB = load_builtin("irb2400")


@pytest.fixture(scope="module")
def figures():
    found = json.loads(robolang("wrist-demo", "--json").stdout)
    assert found["robot"] == "irb2400"
    return {figure["figure"]: figure for figure in found["figures"]}


def run_of(figures, number, index=0):
    return figures[number]["runs"][index]


# --- the numbers -----------------------------------------------------------------------------------------------------

CONVENTIONAL = [
    (4, "E1", (125, 65, -95), 54.3, 34.6),
    (6, "E2", (-225, -10, 215), 5.95, 102),
]


@pytest.mark.parametrize(("number", "move", "reached", "nearest", "fastest"), CONVENTIONAL)
def test_a_conventional_move_ends_in_the_other_wrist_solution(figures, number, move, reached, nearest, fastest):
    row = run_of(figures, number)
    assert (row["move"], row["switch_s"], row["axis"]) == (move, None, None)
    assert row["end_deg"][3:] == pytest.approx(reached, abs=1e-6)
    assert row["end_error_deg"] == pytest.approx(180.0, abs=1e-6)
    assert row["posture_deviation_deg"] < 1e-6
    assert row["off_path_mm"] < 1e-6
    assert max(row["speed_deg_s"][3:]) == pytest.approx(fastest, abs=0.5 if fastest == 102 else 0.05)
    nearest_found = min(abs(row["lowest_deg"][4]), abs(row["highest_deg"][4]))
    assert nearest_found == pytest.approx(nearest, abs=0.05)


PROCESSED = [
    # figure, run, switch s, axis, speeds of J4 to J6, main axes, posture, each with the digits of the table
    (5, 0, 2.71, 4, ((119.57, 0.01), (92.9, 0.1), (114.5, 0.1)), (41, 1), (43.6, 0.1)),
    (7, 0, 2.23, 4, ((76.2, 0.1), (11.3, 0.1), (64.2, 0.1)), (8.6, 0.1), (7.6, 0.1)),
    (10, 0, 2.78, 4, ((79.0, 0.1), (8.5, 0.1), (64.1, 0.1)), (6.4, 0.1), (2.8, 0.1)),
    (11, 0, 2.23, 4, ((76.2, 0.1), (11.3, 0.1), (64.2, 0.1)), (8.6, 0.1), (7.6, 0.1)),
]


@pytest.mark.parametrize(("number", "index", "switch", "axis", "speeds", "main", "turned"), PROCESSED)
def test_a_processed_move_switches_turns_and_ends_as_in_the_table(
    figures, number, index, switch, axis, speeds, main, turned
):
    row = run_of(figures, number, index)
    assert row["switch_s"] == pytest.approx(switch, abs=1e-9)
    assert row["axis"] == axis
    for found, (wanted, digit) in zip(row["speed_deg_s"][3:], speeds, strict=True):
        assert found == pytest.approx(wanted, abs=digit)
    assert max(row["speed_deg_s"][:3]) == pytest.approx(main[0], abs=main[1])
    assert row["posture_deviation_deg"] == pytest.approx(turned[0], abs=turned[1])
    assert row["end_error_deg"] < 1e-9
    assert row["off_path_mm"] < 1e-6


def test_ranges_are_those_of_the_table(figures):
    e1, e2 = run_of(figures, 5), run_of(figures, 7)
    assert e1["lowest_deg"][3:] == pytest.approx([-55, -65, -63], abs=0.5)
    assert e1["highest_deg"][3:] == pytest.approx([99, 65, 85], abs=0.5)
    assert e2["lowest_deg"][3] == pytest.approx(-179.9, abs=0.1)


def test_figure_10_is_too_fast_before_its_switch_and_not_after(figures):
    row = run_of(figures, 10)
    assert row["posture"] == "axis"
    assert row["whole_move_speed_deg_s"][3] == pytest.approx(979, abs=1)
    assert row["whole_move_speed_deg_s"][5] == pytest.approx(994, abs=1)
    assert max(row["speed_deg_s"]) < 80.0


def test_the_slow_variant_of_figure_7_stays_in_range_and_ends_at_rest(figures):
    row = run_of(figures, 7, 1)
    assert row["switch_s"] == pytest.approx(2.13)  # ten cycles ahead of the other
    assert -180.0 < row["lowest_deg"][3] < -175.0
    assert row["end_error_deg"] < 1e-9
    found = demo.run(IRB, demo.FIGURES[3].trials[1])
    steps = np.abs(np.diff(found.q[:, 3:], axis=0)) / 0.01 / DEG
    assert (steps[-1] < 2.0).all()  # at rest
    assert np.abs(np.diff(steps, axis=0)).max() / 0.01 < 400.0  # and without a jump of speed: deg/s2


def test_the_wrist_follows_the_end_of_the_seam(figures):
    """S1: end angles are those of the moved end point, with the turns and the sign of J5 that were taught."""
    without, row = figures[11]["runs"]
    assert row["end_error_deg"] < 1e-6
    assert row["off_path_mm"] < 1e-6
    moved = np.abs(np.array(row["end_deg"]) - without["end_deg"])
    assert 5.0 < moved[3:].max() < 15.0  # J5 is 10 deg there: 2 deg of the tool are many of J4 and J6
    assert row["end_deg"][4] > 0.0
    assert row["lowest_deg"][3] >= -180.0
    trial = demo.FIGURES[5].trials[1]
    assert trial.seam == pytest.approx((0.0, 5e-3, -3e-3, 0.0, 0.0, 2.0 * DEG))
    found = demo.run(IRB, trial)
    tool = (Kinematics(IRB).forward(found.q[[0, -1]]) @ demo.X_FLANGE_TOOL)[:, :3, 3] * 1e3
    assert tool[0] == pytest.approx([1257.19, 385.01, 891.22], abs=0.01)
    assert tool[1] == pytest.approx([1200.90, 521.38 + 5.0, 1124.52 - 3.0], abs=0.01)


SUPPRESSED = [
    (17, 0, (3.0, 0.8, 7.7)),
    (18, 0, (0.45, 27.8, 6.6)),
    (19, 0, (10.6, 0.14, 8.4)),
    (20, 0, (6.2, 36.7, 0.15)),
    (21, 0, (2.3, 0.39, 7.8)),
    (22, 0, (4.4, 2.2, 2.2)),
    (22, 1, (0.14, 19.7, 9.4)),
    (22, 2, (5.6, 0.32, 14.3)),
    (22, 3, (2.5, 20.7, 0.13)),
    (22, 4, (0.73, 0.61, 10.5)),
]


@pytest.mark.parametrize(("number", "index", "components"), SUPPRESSED)
def test_suppression_gives_the_components_of_the_table(figures, number, index, components):
    row = run_of(figures, number, index)
    assert row["switch_s"] == pytest.approx(1.8 if number == 22 else 2.2)
    assert row["axis"] is None
    for found, wanted in zip(row["component_deviation_deg"].values(), components, strict=True):
        digit = 0.01 if wanted < 1.0 and wanted != 0.8 else 0.1
        assert found == pytest.approx(wanted, abs=digit)
    limits = np.array([180.0, 180.0, 225.0])
    assert (np.array(row["speed_deg_s"][3:]) <= limits + 1e-6).all()
    assert row["end_error_deg"] < 1e-9


def test_a_held_component_changes_less_than_a_fifth_of_what_it_does_unheld(figures):
    for rows in ([figures[number]["runs"][0] for number in range(17, 22)], figures[22]["runs"]):
        free = rows[0]["component_deviation_deg"]
        for row, name in zip(rows[1:4], free, strict=True):
            assert row["condition"] == name.upper()
            assert row["component_deviation_deg"][name] < 0.2 * free[name]


# --- the command -----------------------------------------------------------------------------------------------------


def test_the_table_has_a_row_for_each_run_within_80_columns(tmp_path):
    shown = robolang("wrist-demo", "22", "5", "4", "--out", tmp_path).stdout
    assert max(map(len, shown.splitlines()[:-1])) <= 80  # the last line is a path
    rows = [line.split() for line in shown.splitlines() if re.match(r" ?(4|5|22) +E", line)]
    assert [row[0] for row in rows[:3]] == ["4", "5", "22"]  # in the order of the document
    assert rows[0] == ["4", "E1", "J5", "kept", "-", "34.6", "9.8", "28.3", "0.0", "180.0", "wrist-fig04.svg"]
    assert rows[1][:11] == ["5", "E1", "C1", "any", "120", "2.71", "J4", "119.6", "92.9", "114.5", "43.6"]
    assert rows[1][-1] == "wrist-fig05.svg"
    assert ["22", "E3", "TILT", "0.14", "19.69", "9.35"] in rows
    assert "TILT" not in robolang("wrist-demo", "5").stdout


def test_plots_and_page_are_written(tmp_path):
    folder = tmp_path / "made"
    robolang("wrist-demo", "5", "7", "18", "--out", folder)
    assert sorted(path.name for path in folder.iterdir()) == [
        "index.html",
        "wrist-fig05.svg",
        "wrist-fig07.svg",
        "wrist-fig18.svg",
    ]
    for number, curves, said in ((5, 3, "L1 2.71 s"), (7, 6, "L2 2.23 s"), (18, 3, "switch 2.20 s")):
        root = ElementTree.fromstring((folder / f"wrist-fig{number:02}.svg").read_text("utf-8"))
        assert root.tag == f"{SVG}svg"
        assert len(root.findall(f".//{SVG}polyline")) == curves
        texts = [item.text for item in root.iter(f"{SVG}text")]
        assert said in texts
        assert [text for text in texts if text.endswith(", s")]
        assert any(text.startswith(f"Fig {number}, ") for text in texts)
    page = (folder / "index.html").read_text("utf-8")
    for number in ("05", "07", "18"):
        assert f'src="wrist-fig{number}.svg"' in page
    assert re.search(r"2\.71 s by J4\b", page)
    assert "0.45, 27.79, 6.56" in page


def test_the_curves_of_figure_5_are_the_angles(tmp_path):
    """The last point of each curve is at the taught end, where its dot is."""
    robolang("wrist-demo", "5", "--out", tmp_path)
    root = ElementTree.fromstring((tmp_path / "wrist-fig05.svg").read_text("utf-8"))
    dots = [(float(dot.get("cx")), float(dot.get("cy"))) for dot in root.iter(f"{SVG}circle")][-3:]
    ends = [tuple(map(float, line.get("points").split()[-1].split(","))) for line in root.iter(f"{SVG}polyline")]
    assert np.array(dots) == pytest.approx(np.array(ends))
    height = HEIGHT - TOP - BOTTOM
    axis = [HEIGHT - BOTTOM - (angle + 100.0) / 200.0 * height for angle in (-55.0, -65.0, 85.0)]
    assert [y for _, y in dots] == pytest.approx(axis, abs=0.06)


def test_json_names_the_files(tmp_path):
    found = json.loads(robolang("wrist-demo", "7", "--json", "--out", tmp_path).stdout)
    (figure,) = found["figures"]
    assert figure["file"] == str(tmp_path / "wrist-fig07.svg")
    assert (tmp_path / "wrist-fig07.svg").exists()
    assert json.loads(robolang("wrist-demo", "7", "--json").stdout)["figures"][0]["file"] is None


def test_the_plots_of_the_pages_are_what_the_command_draws(tmp_path):
    robolang("wrist-demo", "--out", tmp_path)
    drawn = sorted(tmp_path.glob("*.svg"))
    assert len(drawn) == len(demo.FIGURES)
    number = re.compile(r"-?\d+(?:\.\d+)?")
    for path in drawn:
        kept = (ROOT / "docs" / "plots" / path.name).read_text("utf-8")
        text = path.read_text("utf-8")
        again = "write it anew: robolang wrist-demo --out docs/plots"
        assert number.sub("#", kept) == number.sub("#", text), again
        values, wanted = (np.array(number.findall(each), dtype=float) for each in (kept, text))
        assert values == pytest.approx(wanted, abs=0.5), again  # half a pixel: another processor may round otherwise


def test_figures_that_take_long_are_named_on_stderr(monkeypatch):
    assert robolang("wrist-demo", "4").stderr == ""
    monkeypatch.setattr("robolang.cli.commands.wrist_demo.SILENT_S", -1.0)
    assert robolang("wrist-demo", "4", "6").stderr.splitlines() == ["1/2 figure 4", "2/2 figure 6"]


# --- what it refuses -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["9"], "RBL703 7 FIGURE 9 4 5 6 10 11 17 18"),
        (["4", "x"], "RBL703 FIGURE 2 x"),
        (["--robot", "puma"], "RBL708 puma"),
    ],
)
def test_what_is_not_known_is_refused(words, said):
    assert set(said.split()) <= fields(flat(robolang("wrist-demo", *words, code=2).stderr))


def test_a_robot_that_does_not_get_there_is_refused(tmp_path):
    text = (LIBRARY / "irb2400.toml").read_text("utf-8")
    assert text.count("range_deg = [-120, 120]") == 1
    (tmp_path / "short.toml").write_text(text.replace("range_deg = [-120, 120]", "range_deg = [-60, 60]"))
    said = flat(robolang("wrist-demo", "--robot", tmp_path / "short.toml", code=2).stderr)
    assert {"RBL703", "--robot", "J5", "irb2400", "65", "deg", "E1"} <= fields(said)
    seven = replace(IRB, axes=(*IRB.axes, IRB.axes[0]))
    assert fields(demo.unusable(seven)) == {"irb2400", "7", "6"}
    assert demo.unusable(IRB) == ""


def test_a_figure_that_another_robot_cannot_make_is_named():
    said = robolang("wrist-demo", "11", "--robot", "manutec_r3", code=3).stderr
    assert said.startswith("error RBL526 figure 11: at ")
    slow = replace(demo.FIGURES[5].trials[1], seam=(0.0, 0.5, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(Fault, match="RBL524"):
        demo.run(IRB, slow)


def test_a_folder_that_cannot_be_written_is_rbl706_before_anything_is_computed(tmp_path, monkeypatch):
    monkeypatch.setattr("robolang.cli.commands.wrist_demo.SILENT_S", -1.0)  # so that a figure that is computed says so
    (tmp_path / "file").write_text("")
    for folder in (tmp_path / "no" / "such", tmp_path / "file", "/proc"):
        said = robolang("wrist-demo", "4", "--out", folder, code=4)
        assert said.stderr.startswith("error RBL706 ")
        assert said.stdout == ""


def test_the_command_is_listed_and_imports_nothing_heavy():
    code = "import sys, robolang.cli.main as m; print(sorted({'numpy', 'pinocchio', 'rich.table'} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=HANG_S)
    assert found.stdout == "[]\n"
    assert "wrist-demo" in robolang("--help").stdout


# --- what the plots needed -------------------------------------------------------------------------------------------


def test_marks_dots_and_names_above_stand_where_no_curve_is():
    x = np.linspace(0.0, 4.0, 5)
    curves = [Curve(name="a", x=x, y=x), Curve(name="b", x=x, y=-x, dashed=True, colour=0)]
    marks = [Mark(name="here", x=1.0), Mark(name="before", x=1.0, side="left"), Mark(name="top", y=6.0)]
    dots = Dots(name="end", x=np.array([4.0]), y=np.array([4.0]))
    labels = Labels(title="t", x="x", y="y")
    root = ElementTree.fromstring(as_svg(labels, curves, corner="above", marks=marks, dots=dots))
    assert root.get("viewBox") == f"0 0 {WIDTH} {HEIGHT + 2 * 18 + 14}"
    texts = {item.text: item for item in root.iter(f"{SVG}text")}
    assert texts["here"].get("text-anchor") == "start"
    assert texts["before"].get("text-anchor") == "end"
    assert float(texts["here"].get("x")) - float(texts["before"].get("x")) == pytest.approx(8.0)
    assert float(texts["a"].get("y")) < float(texts["b"].get("y"))  # dashed ones in a row of their own
    assert {line.get("stroke") for line in root.iter(f"{SVG}polyline")} == {COLOURS[0]}
    assert "6" in texts  # the level mark is in view
    (group,) = root.findall(f"{SVG}g")
    circle = group.find(f"{SVG}circle")
    assert float(circle.get("cx")) == WIDTH - RIGHT
    level = [
        line
        for line in group.iter(f"{SVG}line")
        if line.get("stroke-dasharray") == "3 3" and line.get("x1") == str(LEFT)
    ]
    assert len(level) == 1


def test_the_name_of_dots_stands_with_the_solid_curves_where_the_first_curve_is_dashed():
    x = np.linspace(0.0, 4.0, 5)
    curves = [Curve(name="a", x=x, y=x, dashed=True), Curve(name="b", x=x, y=-x)]
    svg = as_svg(
        Labels(title="t", x="x", y="y"), curves, corner="above", dots=Dots(name="end", x=np.array([4.0]), y=x[-1:])
    )
    heights = {item.text: float(item.get("y")) for item in ElementTree.fromstring(svg).iter(f"{SVG}text")}
    assert heights["b"] == heights["end"] < heights["a"]
