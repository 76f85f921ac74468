"""What a run leaves: the report, the two forms of the log, that both repeat, and what an empty program gives."""

import hashlib
import json
import zipfile

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from robolang.logs.files import read_log
from runtime.control.signals import NAMES
from tests.robolang.cli.commands import dry, robolang

REPORT_KEYS = {
    "program",
    "robot",
    "robot_estimated",
    "ok",
    "physics",
    "servo",
    "sim_time_s",
    "wall_time_s",
    "realtime_factor",
    "cycles",
    "overruns",
    "statements",
    "dynamics",
    "payload_history",
    "printed",
    "objects",
    "alarms",
    "warnings",
}
STATEMENT_KEYS = {
    "line",
    "number",
    "text",
    "begun",
    "start_s",
    "duration_s",
    "planned_s",
    "programmed_mm_s",
    "reached_mm_s",
    "programmed_pct",
    "reached_pct",
    "limited_by",
    "limited_why",
    "joint_error_deg",
    "tool_error_mm",
    "path_deviation_mm",
    "peak_torque_pct",
    "wrist",
    "seam",
    "notes",
    "touched",
}
SIGNALS = {
    "t",
    "q_plan",
    "q_cmd",
    "dq_cmd",
    "tau_cmd",
    "tau_sat",
    "q_fb",
    "dq_fb",
    "X_world_tool_fb",
    "D",
    "T",
    "D_age",
    "T_age",
    "payload_mass",
    "line",
    "number",
    "wrist_mode",
    "seam_deviation",
    "q_link",
    "X_world_tool",
    "tool_cmd",
    "tool_error",
    "tool_speed",
}
FRAMES = {"frame_t", "parts", "fingers"}
PROGRAMS = {
    "move": "10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n",
    "load": "10 LOAD (0, 0, 60), 0.8\n20 LOAD (0, 0, 95), 2.3\n",
    "empty": "",
    "comment": "' nothing to do\n",
}


def strict(path):
    """Read JSON and refuse what strict JSON lacks: NaN, Infinity and a key twice."""

    def no_constant(text):
        raise AssertionError(text)

    def once(pairs):
        assert len({key for key, _ in pairs}) == len(pairs)
        return dict(pairs)

    return json.loads(path.read_bytes().decode("utf-8"), parse_constant=no_constant, object_pairs_hook=once)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Every program run twice on the physics; report, npz and mcap of each: ``{name: [folder, folder]}``."""
    made = {}
    for name, text in PROGRAMS.items():
        for _ in range(2):
            folder = tmp_path_factory.mktemp(name)
            (folder / "p.rbl").write_text(text)
            for words in (["--report", folder / "r.json", "--log", folder / "l.npz"], ["--log", folder / "l.mcap"]):
                robolang("run", folder / "p.rbl", "--quiet", *words)
            made.setdefault(name, []).append(folder)
    return made


def test_the_documented_signals_are_those_of_the_recorder():
    assert set(NAMES) == SIGNALS | FRAMES


@pytest.mark.physics
@pytest.mark.parametrize("name", PROGRAMS)
def test_the_report_is_strict_json_with_exactly_the_documented_keys(results, name):
    report = strict(results[name][0] / "r.json")
    assert set(report) == REPORT_KEYS
    assert report["ok"] is True
    assert report["alarms"] == []
    assert report["robot"] == "puma560"
    assert set(report["objects"]) == {"part"}
    assert list(report["objects"]["part"]) == ["pose_mm_deg"]
    assert len(report["objects"]["part"]["pose_mm_deg"]) == 6
    assert all(set(statement) == STATEMENT_KEYS for statement in report["statements"])
    assert len(report["statements"]) == PROGRAMS[name].count("0 ") - PROGRAMS[name].count(" 0 ")
    assert report["sim_time_s"] == pytest.approx(report["cycles"] * 0.008)


@pytest.mark.physics
def test_the_report_of_a_move_says_what_was_measured(results):
    report = strict(results["move"][0] / "r.json")
    load, move = report["statements"]
    assert (load["line"], load["number"], load["text"], load["duration_s"]) == (1, 10, "LOAD (0, 0, 60), 0.8", 0.0)
    assert (move["line"], move["number"], move["text"], move["start_s"]) == (2, 20, "MOVE P1", 0.0)
    assert move["duration_s"] >= move["planned_s"] > 0.5
    assert 0.0 < move["path_deviation_mm"] <= move["tool_error_mm"]
    assert load["tool_error_mm"] is None
    (declared,) = report["payload_history"]
    assert declared == {"time_s": 0.0, "line": 1, "number": 10, "mass_kg": 0.8, "cog_mm": [0.0, 0.0, 60.0]}
    assert report["cycles"] == len(np.load(results["move"][0] / "l.npz")["t"]) // 8 > 80


@pytest.mark.physics
@pytest.mark.parametrize("name", ["load", "empty", "comment"])
def test_a_program_without_motion_takes_no_cycle(results, name):
    report = strict(results[name][0] / "r.json")
    assert (report["cycles"], report["sim_time_s"], report["overruns"]) == (0, 0.0, 0)
    assert [row["mass_kg"] for row in report["payload_history"]] == ([0.8, 2.3] if name == "load" else [])


@pytest.mark.physics
@pytest.mark.parametrize("name", PROGRAMS)
def test_the_npz_has_every_signal_with_the_ticks_first(results, name):
    log = read_log(results[name][0] / "l.npz")
    ticks = len(log["t"])
    assert set(log) == SIGNALS | FRAMES
    assert log["parts"].shape == (-(-ticks // 16), 1, 7)
    assert ticks == (0 if name != "move" else strict(results[name][0] / "r.json")["cycles"] * 8)
    for signal in SIGNALS:
        numbers = ("t", "payload_mass", "line", "number", "wrist_mode", "tool_error", "tool_speed")
        shape = {"X_world_tool_fb": (4, 4), "X_world_tool": (4, 4), "tool_cmd": (3,)}.get(
            signal, () if signal in numbers else (6,)
        )
        assert log[signal].shape == (ticks, *shape), signal
        assert np.isfinite(log[signal]).all(), signal
    assert np.array_equal(log["t"], np.arange(ticks) * 1000 * 1e-6)


@pytest.mark.physics
@pytest.mark.parametrize("name", PROGRAMS)
def test_stock_readers_find_the_same_numbers_in_the_mcap(results, name):
    log = read_log(results[name][0] / "l.npz")
    with (results[name][0] / "l.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        messages = list(reader.iter_decoded_messages(topics=["/controller"]))
    topics = {c.topic: (summary.schemas[c.schema_id].name, c.message_encoding) for c in summary.channels.values()}
    assert topics["/controller"] == ("robolang.Sample", "protobuf")
    assert len(log["t"]) == len(messages)
    for signal in SIGNALS - {"X_world_tool", "X_world_tool_fb"}:
        field = np.array([getattr(sample, signal) for _, _, _, sample in messages])
        assert np.array_equal(field.reshape(log[signal].shape), log[signal]), signal
    assert [message.log_time for _, _, message, _ in messages] == [k * 1_000_000 for k in range(len(messages))]
    assert [message.publish_time for _, _, message, _ in messages] == [k * 1_000_000 for k in range(len(messages))]


@pytest.mark.physics
@pytest.mark.parametrize("name", PROGRAMS)
def test_two_runs_give_the_same_bytes(results, name):
    for file in ("l.npz", "l.mcap"):
        first, second = (hashlib.sha256((folder / file).read_bytes()).hexdigest() for folder in results[name])
        assert first == second, file
    reports = [strict(folder / "r.json") for folder in results[name]]
    for report in reports:
        for key in ("program", "wall_time_s", "realtime_factor"):
            del report[key]
    assert reports[0] == reports[1]


@pytest.mark.physics
def test_no_time_of_day_is_in_a_log(results):
    """The two runs above are a second apart at most; what a file could carry of the clock is looked at itself."""
    folder = results["move"][0]
    with zipfile.ZipFile(folder / "l.npz") as archive:
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    with (folder / "l.mcap").open("rb") as stream:
        reader = make_reader(stream)
        header, statistics = reader.get_header(), reader.get_summary().statistics
        times = [(each.create_time, each.log_time) for each in reader.iter_attachments()]
    assert header.profile == ""
    assert not any(year in header.library for year in ("202", "203"))
    assert (statistics.metadata_count, statistics.attachment_count, times) == (0, 1, [(0, 0)])
    assert statistics.message_end_time < 2_000_000_000  # ns: simulated, from power-up


@pytest.mark.parametrize("name", ["empty", "comment"])
def test_an_empty_program_is_a_warning_and_runs(tmp_path, name):
    (tmp_path / "p.rbl").write_text(PROGRAMS[name])
    result = dry(tmp_path / "p.rbl")
    assert "p.rbl:1:1: warning RBL201" in result.stderr
    assert "0 cycles" in result.stdout
    assert "dynamics" not in result.stdout  # it had no time to refresh anything


@pytest.mark.parametrize(
    ("text", "code"),
    [(b"20 LOAD (0, 0, 60), 0.8\n10 MOVE P1\n", "warning RBL116"), (b"10 MOVE P1\r\n' x\n", "info RBL110")],
)
def test_a_warning_or_a_remark_does_not_stop_a_run(tmp_path, text, code):
    (tmp_path / "p.rbl").write_bytes(text)
    result = dry(tmp_path / "p.rbl", "--report", tmp_path / "r.json")
    assert code in result.stderr
    assert strict(tmp_path / "r.json")["cycles"] > 80


def test_a_file_name_that_is_not_utf_8_does_not_cost_the_report(tmp_path):
    name = tmp_path / "p\udcff.rbl"
    name.write_text("LOAD (0, 0, 60), 0.8\n")
    result = dry(name, "--report", tmp_path / "r.json")
    assert strict(tmp_path / "r.json")["program"] == str(name)
    assert "p\ufffd.rbl" in result.stdout
