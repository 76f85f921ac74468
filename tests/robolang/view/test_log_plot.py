"""Plots of a log: which panels and curves there are, that no peak is lost, and what a drawing does with odd input."""

import re
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from robolang.logs.files import read_log
from robolang.logs.log import Log
from robolang.view import png
from robolang.view.log_plot import Window, plot_of
from robolang.view.signal_plot import Block, Line, SignalPanel, SignalPlot
from runtime.core.faults import Fault
from tests.robolang.logs.made import ODD, PLAIN, log, old

SVG = "{http://www.w3.org/2000/svg}"
ALL = Window()


def drawn(panels, blocks=(), first=0.0, last=1.0):
    text = SignalPlot(title="t", panels=tuple(panels), blocks=tuple(blocks), first=first, last=last).as_svg()
    return ET.fromstring(text.encode("utf-8"))


def panel(*lines, label="y, mm"):
    return SignalPanel(label=label, lines=lines)


def line(y, name="a", first=0.0, last=1.0):
    return Line(name=name, x=np.linspace(first, last, len(y)), y=np.array(y, dtype=float))


def curves(root):
    """Return the points (K, 2) of the pieces of each curve, without the pieces in the legend."""
    found = []
    for path in root.iter(f"{SVG}path"):
        if "stroke-linejoin" in path.attrib:
            pieces = re.findall(r"M([^M]*)", path.attrib["d"])
            found.append([np.array([pair.split() for pair in piece.split("L")], dtype=float) for piece in pieces])
    return found


def texts(root):
    return [each.text for each in root.iter(f"{SVG}text")]


def test_panels_have_the_units_of_people_and_curves_the_names_of_axes():
    made = log(40, PLAIN)
    found = plot_of(made, ["q_fb", "seam_deviation", "tau_sat:J3", "X_world_tool", "payload_mass"], ALL)
    assert [each.label for each in found.panels] == [
        "q_fb, deg",
        "seam_deviation, mm",
        "seam_deviation, deg",
        "tau_sat, N m",
        "X_world_tool, mm",
        "payload_mass, kg",
    ]
    names = [[each.name for each in panel.lines] for panel in found.panels]
    assert names == [
        [f"J{k}" for k in range(1, 7)],
        ["x", "y", "z"],
        ["rx", "ry", "rz"],
        ["J3"],
        ["x", "y", "z"],
        ["payload_mass"],
    ]
    assert np.array_equal(found.panels[0].lines[1].y, made["q_fb"][:, 1] * (180.0 / np.pi))
    assert np.array_equal(found.panels[4].lines[2].y, made["X_world_tool"][:, 2, 3] * 1000.0)
    assert np.array_equal(found.panels[0].lines[0].x, made["t"])


def test_signals_with_a_plus_share_a_panel_and_are_told_apart():
    (both,) = plot_of(log(40), ["q_cmd:2+q_fb:2"], ALL).panels
    assert both.label == "q_cmd q_fb, deg"
    assert [(each.name, each.dashed) for each in both.lines] == [("q_cmd J2", False), ("q_fb J2", True)]


def test_signals_of_frames_are_drawn_at_their_times():
    made = log(100, PLAIN)
    fingers, parts = plot_of(made, ["fingers", "parts:2.z"], ALL).panels
    assert [each.name for each in fingers.lines] == ["left", "right"]
    assert np.array_equal(fingers.lines[0].x, made["frame_t"])
    assert np.array_equal(parts.lines[0].y, made["parts"][:, 1, 2] * 1000.0)


def test_a_window_holds_its_ends():
    made = log(100, PLAIN)
    found = plot_of(made, ["t", "fingers"], Window(first=0.02, last=0.05))
    assert (found.first, found.last) == (made["t"][20], made["t"][50])
    assert np.array_equal(found.panels[0].lines[0].x, made["t"][20:51])
    assert np.array_equal(found.panels[1].lines[0].x, made["frame_t"][2:4])


@pytest.mark.parametrize("window", [(0.2, None), (None, -0.1), (0.05, 0.05), (0.05, 0.02), (np.nan, None)])
def test_a_window_without_two_rows_is_refused(window):
    with pytest.raises(ValueError, match="between"):
        plot_of(log(100), ["t"], Window(first=window[0], last=window[1]))


def test_an_unknown_signal_is_refused_before_anything_is_drawn():
    with pytest.raises(Fault, match="RBL838"):
        plot_of(log(10), ["q_fb+nothing"], ALL)


def test_the_statements_that_ran_are_marked_with_their_numbers():
    made = log(64, PLAIN)
    blocks = plot_of(made, ["t"], ALL).blocks
    lines, numbers = made["line"], made["number"]
    edges = np.flatnonzero(np.diff(lines)) + 1
    starts = [0, *edges.tolist()]
    assert [(block.begins, block.number) for block in blocks] == [
        (made["t"][k], str(numbers[k])) for k in starts if lines[k]
    ]
    assert [block.text for block in blocks if block.number == "10"] == ["10 MOVE P1 ' \x00"] * 2
    root = drawn([panel(line([0.0, 1.0]))], [Block(begins=0.25, ends=0.75, number="60", text="MOVE <P2>")])
    shade = next(each for each in root.iter(f"{SVG}rect") if each.find(f"{SVG}title") is not None)
    title = shade.find(f"{SVG}title").text
    assert title == "60: MOVE <P2>"
    assert "60" in texts(root)
    x, width = float(shade.attrib["x"]), float(shade.attrib["width"])
    (curve,) = curves(root)[0]
    left, right = curve[:, 0]
    assert (x - left) / (right - left) == pytest.approx(0.25, abs=0.001)
    assert width / (right - left) == pytest.approx(0.5, abs=0.001)


def test_thousands_of_short_statements_are_no_thousands_of_shades():
    blocks = [Block(begins=k / 1e5, ends=(k + 1) / 1e5, number="1", text="") for k in range(100_000)]
    assert len(list(drawn([panel(line([0.0, 1.0]))], blocks))) < 100


def test_a_curve_is_where_its_values_are():
    root = drawn([panel(line([0.0, 10.0, 5.0]))])
    (points,) = curves(root)[0]
    assert points[1, 1] < points[2, 1] < points[0, 1]
    assert (points[0, 1] - points[2, 1]) == pytest.approx((points[0, 1] - points[1, 1]) / 2, abs=0.11)
    assert np.diff(points[:, 0]) == pytest.approx([(points[2, 0] - points[0, 0]) / 2] * 2, abs=0.11)


@pytest.mark.parametrize("at", [0, 1, 12_345, 49_999])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_no_peak_is_lost_among_many_rows(at, sign):
    y = np.zeros(50_000)
    y[at] = sign
    (points,) = curves(drawn([panel(line(y))]))[0]
    assert len(points) <= 1600
    level = np.median(points[:, 1])
    assert np.sum(sign * (level - points[:, 1]) > 100.0) == 1
    spike = points[np.argmax(np.abs(points[:, 1] - level)), 0]
    width = points[-1, 0] - points[0, 0]
    assert (spike - points[0, 0]) / width == pytest.approx(at / 50_000, abs=0.005)


def test_a_curve_is_broken_where_there_is_no_value():
    pieces = curves(drawn([panel(line([0.0, 1.0, np.nan, 2.0, np.inf, 3.0, 2.0]))]))[0]
    assert [len(piece) for piece in pieces] == [2, 1, 2]
    assert curves(drawn([panel(line([np.nan, np.nan]))])) == [[]]


def test_a_level_curve_and_a_single_value_are_drawn():
    assert np.ptp(curves(drawn([panel(line([7.0, 7.0]))]))[0][0][:, 1]) == 0.0
    root = drawn([panel(Line(name="a", x=np.array([0.5]), y=np.array([3.0])))])
    assert any(each.attrib["d"].endswith("h0.1") for each in root.iter(f"{SVG}path"))


@pytest.mark.parametrize("numbers", [ODD, PLAIN])
def test_every_signal_of_a_log_can_be_drawn(numbers):
    made = log(100, numbers)
    ET.fromstring(plot_of(made, list(made), ALL).as_svg())


def test_the_same_log_gives_the_same_bytes():
    first, second = (plot_of(log(3000, PLAIN), ["q_fb", "tool_error"], ALL).as_svg() for _ in range(2))
    assert first == second


def test_hostile_words_are_words():
    name = '</text><script>alert(1)</script>\x00\x1b\udc80\ufffe"&'
    block = Block(begins=0.0, ends=1.0, number="1", text=name)
    text = SignalPlot(title=name, panels=(panel(line([0, 1], name), label=name),), blocks=(block,), first=0.0, last=1.0)
    root = ET.fromstring(text.as_svg().encode("utf-8"))
    assert not list(root.iter(f"{SVG}script"))
    assert sum("<script>" in (each.text or "") for each in root.iter()) == 4


def test_an_old_log_is_drawn_without_a_program(tmp_path):
    path = old(tmp_path / "o.npz", t=np.arange(9.0), q_cmd=np.ones((9, 2)), line=np.ones(9, np.int32))
    found = plot_of(read_log(path), ["q_cmd"], ALL)
    assert [(block.number, block.text) for block in found.blocks] == [("1", "")]
    assert found.title == str(path)


# --- as a picture -----------------------------------------------------------------------------------------------------


def test_a_picture_has_the_size_of_the_drawing():
    data = png.as_png(plot_of(log(20, PLAIN), ["q_fb"], ALL).as_svg())
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(data[16:20], "big") == 960 * png.ZOOM


def test_without_a_font_or_the_library_there_is_no_picture(monkeypatch):
    import resvg_py

    render = resvg_py.svg_to_bytes
    monkeypatch.setattr(resvg_py, "svg_to_bytes", lambda **how: render(**how, skip_system_fonts=True))
    with pytest.raises(Fault, match="RBL839") as caught:
        png.check_png()
    assert "fonts-dejavu-core" in caught.value.hint
    monkeypatch.setitem(sys.modules, "resvg_py", None)
    with pytest.raises(Fault, match="RBL839") as caught:
        png.check_png()
    assert "robolang[plot]" in caught.value.hint


def test_the_strip_says_whether_it_has_lines_or_numbers():
    made = log(40, PLAIN)
    assert made["number"].any()
    found = plot_of(made, ["q_fb"], ALL)
    assert found.strip == "number" and "number" in texts(ET.fromstring(found.as_svg().encode()))

    class Unnumbered(Log):
        def span(self, name, first, last):
            return super().span(name, first, last) * (0 if name == "number" else 1)

    plain = plot_of(Unnumbered(made.rows, made.meta), ["q_fb"], ALL)
    assert plain.strip == "line" and "line" in texts(ET.fromstring(plain.as_svg().encode()))
