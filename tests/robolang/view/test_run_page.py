"""What a page holds of a log: signals within their step, charts that say something, notes at their place, margins."""

import math

import numpy as np
import pytest

from robolang.view import run_page, run_signals, thinning
from robolang.view.run_page import check_comparable, pack_run
from runtime.core.faults import Fault
from tests.robolang.view.decoding import furthest, unpacked
from tests.robolang.view.recorded import AXES, MadeLog, event, happened, log, meta, statement


def shown(signals, **changes):
    return unpacked(pack_run(MadeLog(signals.arrays, meta(**changes)), "first"))


def chart(header, name):
    (found,) = [each for each in header["charts"] if each["id"] == name]
    return found


def ids(header):
    return [each["id"] for each in header["charts"]]


def test_every_signal_comes_back_within_its_step():
    header, found = shown(log(163))
    recorded = log(163).arrays
    listed = {each["name"]: each for each in header["signals"]}
    expected = {
        **{name: recorded[name] for name in ("q_cmd", "q_fb", "q_link", "dq_fb", "tau_sat", "parts", "fingers")},
        "tool_speed": recorded["tool_speed"][:, None],
        "tool_error": np.linalg.norm(recorded["tool_cmd"] - recorded["X_world_tool"][:, :3, 3], axis=1)[:, None],
        **{name: recorded[name][::8] for name in ("D", "T", "D_age", "seam_deviation", "tool_cmd")},
        **{name: recorded[name][::8, None] for name in ("payload_mass", "wrist_mode")},
        "tool": recorded["X_world_tool"][::8, :3, 3],
    }
    assert listed.keys() == expected.keys() | {"torque_limit"}
    for name, values in expected.items():
        assert listed[name]["rows"] == len(values)
        for column, step, read in zip(
            values.reshape(len(values), -1).T, listed[name]["step"], found[name], strict=True
        ):
            assert furthest(column, read) <= 0.5 * step + 1e-15, name
    assert [listed[name]["dt"] for name in ("q_cmd", "D", "parts")] == [0.001, 0.008, 0.016]
    assert header["thinned"] is None and header["duration_s"] == pytest.approx(0.163)
    assert (header["kind"], header["label"], header["tick_s"], header["cycle_s"]) == ("run", "first", 0.001, 0.008)


def test_program_robot_scene_and_report_are_in_the_page_and_the_cell_file_is_not():
    header, _ = shown(log(20))
    assert header["meta"] == {key: value for key, value in meta().items() if key not in ("cell", "points")}


def test_a_chart_names_columns_that_are_there():
    header, found = shown(log(163), events=[event("output", "2", 1, 0.01)])
    for each in header["charts"]:
        assert each["series"] and each["title"]
        for series in each["series"]:
            for signal, column in [(series["signal"], series["column"]), *filter(None, [series["minus"]])]:
                assert column < len(found[signal]), each["id"]


def test_axes_that_turn_and_axes_that_slide_have_their_own_charts_and_units():
    header, _ = shown(log(163))
    turned, slid = chart(header, "joints"), chart(header, "joints_mm")
    assert (turned["unit"], slid["unit"]) == ("deg", "mm")
    assert [(each["label"], each["signal"], each["column"], each["role"]) for each in turned["series"]] == [
        ("J1", "q_fb", 0, "value"),
        ("J2", "q_fb", 1, "value"),
        ("J1 command", "q_cmd", 0, "command"),
        ("J2 command", "q_cmd", 1, "command"),
    ]
    assert [each["scale"] for each in (turned["series"][0], slid["series"][0])] == pytest.approx([180 / math.pi, 1e3])
    assert chart(header, "torque")["unit"] == "N m" and chart(header, "torque_mm")["unit"] == "N"
    error = chart(header, "joint_error")["series"][0]
    assert (error["signal"], error["minus"]) == ("q_cmd", ["q_link", 0])
    assert error["scale"] == pytest.approx(180e3 / math.pi) and chart(header, "joint_error_mm")["unit"] == "µm"


def test_torque_is_shown_against_its_limit_and_without_one_only_as_it_is():
    header, found = shown(log(163, tau_sat=np.full((163, 3), [60.0, 5.0, -100.0]) + np.arange(163)[:, None] * 1e-3))
    share = chart(header, "torque_pct")
    assert [(each["label"], each["scale"]) for each in share["series"]] == [("J1", pytest.approx(1.0))]
    assert share["band"] == [-100.0, 100.0]
    limits = [each for each in chart(header, "torque")["series"] if each["role"] == "limit"]
    assert [(each["label"], each["column"], each["scale"]) for each in limits] == [
        ("J1 limit", 0, 1.0),
        ("J1 limit", 0, -1.0),
    ]
    assert found["torque_limit"] == [[100.0, 100.0], [None, None], [300.0, 300.0]]
    assert not [each for each in chart(header, "torque_mm")["series"] if each["role"] == "limit"]


def test_charts_that_would_say_nothing_are_not_there():
    quiet, _ = shown(log(163, payload_mass=np.zeros(163), fingers=np.full((11, 2), 0.02)))
    assert not {"payload", "wrist", "seam", "seam_deg", "io", "hand"} & set(ids(quiet))
    loud, found = shown(
        log(163, wrist_mode=np.repeat([0, 1], [100, 63]), seam_deviation=np.full((163, 6), 1e-3)),
        events=[event("input", "3", 0, 0.0), event("input", "3", 1, 0.016), event("output", "1", 1, 0.04)],
    )
    assert {"payload", "wrist", "seam", "seam_deg", "io", "hand"} <= set(ids(loud))
    io = chart(loud, "io")
    assert io["lanes"] and [each["label"] for each in io["series"]] == ["IN 3", "OUT 1"]
    assert [column[k] for column in found["levels"] for k in (1, 2, 4, 5)] == [0, 1, 1, 1, 0, 0, 0, 1]


def test_levels_are_those_of_the_last_change_in_each_cycle():
    changes = [(0, 0.0), (1, 0.008), (0, 0.008), (1, 0.016), (0, 0.04), (1, -1.0), (1, 9.0)]
    _, found = shown(log(163), events=[event("input", "3", value, time) for value, time in changes])
    assert found["levels"][0][:7] == [1, 0, 1, 1, 1, 0, 0]


def test_as_many_inputs_as_no_page_has_are_refused():
    most = [event("input", str(k), 1, 0.0) for k in range(run_page.MOST_LEVELS)]
    assert len(shown(log(163), events=most)[1]["levels"]) == run_page.MOST_LEVELS
    with pytest.raises(Fault) as refused:
        shown(log(163), events=[*most, event("output", "1", 1, 0.0)])
    assert refused.value.code == "RBL619"


def test_an_input_that_is_a_number_has_an_axis_and_no_lane():
    header, _ = shown(log(163), events=[event("input", "3", 2, 0.016), event("output", "1", 1, 0.04)])
    assert [each["label"] for each in chart(header, "io")["series"]] == ["OUT 1"]
    number = chart(header, "io_0")
    assert (number["title"], number["lanes"]) == ("IN 3", False)


def test_alarms_warnings_notes_and_prints_stand_at_their_time():
    header, _ = shown(
        log(163),
        report={
            "alarms": [happened("RBL501", 3, 0.1)],
            "warnings": [happened("RBL523", 2, 0.05), happened("RBL523", 2, 0.02)],
            "printed": [{"time_s": 0.03, "text": "round 1"}],
            "statements": [
                statement(1, 0.0, notes=["slowed: J2"]),
                {**statement(9, None), "begun": False},
            ],
        },
    )
    found = [
        (each["time_s"], each["line"], each["code"], each["severity"], each["text"].splitlines())
        for each in header["notes"]
    ]
    assert found == [
        (0.0, 1, None, "note", ["slowed: J2"]),
        (0.02, 2, "RBL523", "warning", ["RBL523", "hint"]),
        (0.03, None, None, "print", ["round 1"]),
        (0.05, 2, "RBL523", "warning", ["RBL523", "hint"]),
        (0.1, 3, "RBL501", "error", ["RBL501", "hint"]),
    ]


def test_least_margins_are_found_with_their_time_and_past_a_limit_are_negative():
    q = np.tile([0.5, 0.0, 0.1], (100, 1))
    q[40, 0], q[7, 2], q[50, 2] = 2.5, -0.002, math.nan
    first, second, third = shown(log(100, q_link=q))[0]["joints"]
    assert (first["unit"], third["unit"]) == ("deg", "mm")
    assert (first["least_margin"], first["at_s"]) == (pytest.approx(math.degrees(0.5)), pytest.approx(0.04))
    assert (second["lower"], second["upper"], second["least_margin"], second["at_s"]) == (None,) * 4
    assert (third["least_margin"], third["at_s"]) == (pytest.approx(-2.0), pytest.approx(0.007))
    assert (third["lower"], third["upper"]) == (0.0, 500.0)


def test_a_joint_without_any_angle_has_no_margin():
    (first, *_) = shown(log(24, q_link=np.full((24, 3), math.nan)))[0]["joints"]
    assert (first["least_margin"], first["at_s"]) == (None, None)


def test_a_run_without_a_tick_has_a_page():
    header, found = shown(log(0), events=[event("input", "1", 1, 0.0)])
    assert header["duration_s"] == 0.0 and found["q_link"] == [[], [], []]
    assert [each["least_margin"] for each in header["joints"]] == [None] * 3


def test_gaps_in_a_log_are_gaps_in_the_page():
    q = log(163).arrays["q_link"]
    q[20:30, 1] = math.nan
    _, found = shown(log(163, q_link=q, tool_cmd=np.full((163, 3), math.nan)))
    assert [k for k, value in enumerate(found["q_link"][1]) if value is None] == list(range(20, 30))
    assert found["tool_error"] == [[None] * 163]


def test_a_long_run_is_thinned_and_says_so(monkeypatch):
    monkeypatch.setattr(thinning, "MOST_ROWS", 100)
    monkeypatch.setattr(thinning, "EVEN_ROWS", 100)
    made = log(1000)
    recorded = made.arrays
    recorded["q_cmd"][503, 0] += 0.01
    header, found = shown(made)
    listed = {each["name"]: each for each in header["signals"]}
    assert max(each["rows"] for each in header["signals"]) <= 100
    assert header["thinned"]["every_s"] == pytest.approx(0.02)
    assert (listed["q_cmd"]["base"], listed["q_cmd"]["dt"]) == ("pairs", pytest.approx(0.01))
    # the peak of the error is in its own pairs; a difference of two thinned signals would not have it
    error = chart(header, "joint_error")["series"][0]
    assert (error["signal"], error["minus"]) == ("joint_error", None)
    assert max(found["joint_error"][0]) == pytest.approx(0.01 - 0.0002)
    assert (listed["q_link"]["base"], listed["q_link"]["dt"]) == ("tick", pytest.approx(0.01))
    assert found["q_link"][0] == pytest.approx(recorded["q_link"][::10, 0].tolist(), abs=1e-6)


def test_a_thinned_run_says_how_far_its_robot_is_off(monkeypatch):
    """Of the made-up log a posture is a point, so that the joints say how far."""
    monkeypatch.setattr(thinning, "MOST_ROWS", 100)
    for rows, step in ((1003, 16), (250, 4)):
        monkeypatch.setattr(thinning, "EVEN_ROWS", rows // step + 1)
        made = log(rows)
        q, t = made.arrays["q_link"], np.arange(rows)
        kept = np.array([np.interp(t, t[::step], column[::step]) for column in q.T]).T
        off = np.linalg.norm(kept - q, axis=1)[: (rows - 1) // step * step]
        assert run_signals.drawn_off(made) == pytest.approx(off.max(), rel=1e-3)
        header, _ = shown(made)
        assert f"{step} ms apart, up to {off.max() * 1000:.2g} mm off" in header["thinned"]["text"]
    made.arrays["q_link"] = np.full((rows, 3), np.nan)
    assert run_signals.drawn_off(made) == 0.0


@pytest.mark.parametrize("other", [{"name": "made", "axes": AXES[:2]}, {"name": "another", "axes": AXES}])
def test_runs_of_two_robots_are_not_compared(other):
    first = log(24)
    check_comparable([first])
    check_comparable([first, log(24, meta(program={"name": "other.rbl", "text": ""}))])
    with pytest.raises(Fault) as caught:
        check_comparable([first, log(24, meta(robot={**meta()["robot"], **other}))])
    assert caught.value.code == "RBL826"


def test_a_tool_that_changes_is_no_motion_of_the_tool():
    """From tick 80 on another tool counts, and its point is 0.3 m away; the log knows the speed of that tick."""
    made = log(163)
    made.arrays["cycle/tool"][10:] = 1
    made.arrays["X_world_tool"][80:, 2, 3] += 0.3
    _, found = shown(made)
    assert max(found["tool_speed"][0]) < 10.0
    assert found["tool_speed"][0][80] == pytest.approx(made.arrays["tool_speed"][80], abs=1e-6)


def test_pieces_make_the_same_signals_as_the_whole(monkeypatch):
    whole = pack_run(log(1000), "a")
    monkeypatch.setattr(run_signals, "PIECE", 24)
    assert pack_run(log(1000), "a") == whole
    monkeypatch.setattr(thinning, "MOST_ROWS", 100)
    monkeypatch.setattr(thinning, "EVEN_ROWS", 100)
    monkeypatch.setattr(run_signals, "PIECE", 100_000)
    thin = pack_run(log(1003), "a")
    monkeypatch.setattr(run_signals, "PIECE", 24)
    assert pack_run(log(1003), "a") == thin


@pytest.mark.parametrize(
    "broken",
    [
        {"report": []},
        {"report": {"statements": [{}]}},
        {"events": [{"kind": "output", "name": "1", "value": "x", "time_s": 0.0}]},
        {"events": [{"kind": "output", "name": "1", "value": 1, "time_s": 1e400}]},
        {"tick_s": None},
    ],
    ids=str,
)
def test_a_log_that_says_something_else_is_refused(broken):
    made = log(24)
    made.meta = {**meta(), **broken}
    with pytest.raises(Fault) as caught:
        pack_run(made, "a")
    assert caught.value.code == "RBL619"


def test_a_statement_that_has_not_begun_is_at_no_time():
    header, _ = shown(log(24), report={"statements": [statement(1, 0.0), {**statement(9, None), "begun": False}]})
    assert [each["line"] for each in header["meta"]["report"]["statements"]] == [1]


def found_before(code, line, **changes):
    item = {"code": code, "line": line, "severity": "warning", "message": code, "hint": "hint", "file": "made.rbl"}
    return item | changes


def test_what_was_found_before_the_run_stands_where_its_line_begins_first():
    statements = [statement(1, 0.0), statement(2, 0.5), statement(2, 0.9), statement(3, None, begun=False)]
    found = [
        found_before("RBL228", 2),
        found_before("RBL225", 3),
        found_before("RBL640", 2, file="made.cell.toml"),
        found_before("RBL110", 1, severity="info"),
    ]
    header, _ = shown(log(20), findings=found, report={"statements": statements})
    notes = [(each["code"], each["line"], each["time_s"], each["severity"]) for each in header["notes"]]
    assert notes == [
        ("RBL110", 1, 0.0, "note"),
        ("RBL228", 2, 0.5, "warning"),
        ("RBL225", 3, None, "warning"),
        ("RBL640", None, None, "warning"),
    ]
    assert header["notes"][3]["text"] == "made.cell.toml:2: RBL640\nhint"
    assert "findings" not in header["meta"]


def test_an_arm_that_has_not_moved_stands_at_home():
    header, found = shown(log(0), home=[0.5, -0.25, 0.125])
    assert found["q_link"] == [pytest.approx([each], abs=1e-6) for each in (0.5, -0.25, 0.125)]
    assert [each["at_s"] for each in header["joints"]] == [0.0, None, 0.0]
    with pytest.raises(Fault) as refused:
        shown(log(0), home=[0.5])
    assert refused.value.code == "RBL619"
    assert len(shown(log(0))[1]["q_link"][0]) == 0
