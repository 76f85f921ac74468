"""``robolang plot`` and ``robolang log``: files, defaults, refusals."""

import csv
import json
import re

import numpy as np
import pyarrow.parquet as pq
import pytest

from robolang.logs.files import read_log, write_log
from robolang.logs.log import Log
from tests.messages import fields
from tests.robolang.cli.commands import dry, flat, robolang
from tests.robolang.logs.made import log as made_log
from tests.robolang.logs.made import old


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    (folder / "p.rbl").write_text('10 HAND ON\n20 MOVE P5\n30 PRINT "done"\n')
    dry(folder / "p.rbl", "--quiet", "--log", folder / "run.npz")
    return folder / "run.npz"


@pytest.fixture
def run(ran, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.npz").write_bytes(ran.read_bytes())
    return read_log("run.npz")


# --- plot -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("suffix", "begins"), [("svg", b"<svg "), ("png", b"\x89PNG"), ("html", b"<!doctype html>")])
@pytest.mark.usefixtures("run")
def test_a_plot_is_written_in_each_format(tmp_path, suffix, begins):
    robolang("plot", "run.npz", "q_fb", "tau_sat:J2", "-o", f"x.{suffix}")
    data = (tmp_path / f"x.{suffix}").read_bytes()
    assert data.startswith(begins)
    assert b"<script" not in data
    robolang("plot", "run.npz", "q_fb", "tau_sat:J2", "-o", f"y.{suffix}")
    assert (tmp_path / f"y.{suffix}").read_bytes() == data


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["q_fb"], "run-q_fb.svg"),
        (["q_cmd:2+q_fb:2", "parts:part.x"], "run-q_cmd2-q_fb2-partspart.x.svg"),
    ],
)
@pytest.mark.usefixtures("run")
def test_without_a_name_it_is_written_beside_the_log(tmp_path, words, name):
    result = robolang("plot", "run.npz", *words)
    assert name in result.stdout
    assert (tmp_path / name).read_text().startswith("<svg ")


@pytest.mark.usefixtures("run")
def test_the_window_is_that_of_the_options(tmp_path):
    robolang("plot", "run.npz", "q_fb", "--from", "0.1", "--to", "0.2", "-o", "x.svg")
    numbers = re.findall(r'y="\d+\.0" text-anchor="middle">([\d.]+)<', (tmp_path / "x.svg").read_text())
    assert {"0.1", "0.15", "0.2"} <= set(numbers)


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["run.npz", "nothing"], 2, {"RBL838"}),
        (["run.npz", "q_fb:9"], 2, {"RBL838", "q_fb"}),
        (["run.npz", "q_fb", "-o", "x.pdf"], 2, {"RBL703", "--out"}),
        (["run.npz"], 2, {"RBL703", "SIGNAL", "--along-path"}),
        (["run.npz", "q_fb", "--along-path"], 2, {"RBL703", "--along-path"}),
        (["run.npz", "--along-path", "--from", "99"], 2, {"RBL703", "--from"}),
        (["run.npz", "q_fb", "--from", "99"], 2, {"RBL703", "--from"}),
        (["run.npz", "q_fb", "--from", "nan"], 2, {"RBL703", "--from"}),
        (["absent.npz", "q_fb"], 2, {"RBL600"}),
        (["p.txt", "q_fb"], 2, {"RBL619"}),
        (["run.npz", "q_fb", "-o", "no/x.svg"], 4, {"RBL706"}),
    ],
)
@pytest.mark.usefixtures("run")
def test_what_cannot_be_plotted_is_refused_and_nothing_is_written(tmp_path, words, code, said):
    (tmp_path / "p.txt").write_text("no log")
    result = robolang("plot", *words, code=code)
    assert said <= fields(flat(result.stderr))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.txt", "run.npz"]


def test_an_mcap_gives_the_same_plot_and_table(run, tmp_path):
    write_log(tmp_path / "run.mcap", run)
    for name in ("npz", "mcap"):
        robolang("plot", f"run.{name}", "q_fb", "tool_error", "parts", "-o", f"{name}.svg")
        robolang("log", "export", f"run.{name}", "-o", f"{name}.csv")
    assert (tmp_path / "npz.svg").read_bytes() == (tmp_path / "mcap.svg").read_bytes()
    assert (tmp_path / "npz.csv").read_bytes() == (tmp_path / "mcap.csv").read_bytes()


# --- export -----------------------------------------------------------------------------------------------------------


def test_csv_is_what_the_log_holds(run, tmp_path):
    robolang("log", "export", "run.npz", "--csv", "--signals", "q_fb,tool_cmd:z")
    with (tmp_path / "run.csv").open(newline="") as file:
        heading, *rows = csv.reader(file)
    assert heading == ["t [s]", *(f"q_fb:{k} [rad]" for k in range(1, 7)), "tool_cmd:z [m]"]
    read = np.array(rows, dtype=np.float64)
    assert np.array_equal(read[:, 0], run["t"])
    assert np.array_equal(read[:, 1:7], run["q_fb"])
    assert np.array_equal(read[:, 7], run["tool_cmd"][:, 2])


def test_parquet_is_what_the_log_holds(run, tmp_path):
    robolang("log", "export", "run.npz", "-o", "x.parquet")
    read = pq.read_table(tmp_path / "x.parquet")
    assert read.num_rows == len(run["t"])
    for k in range(6):
        assert np.array_equal(read[f"q_link:{k + 1}"].to_numpy(), run["q_link"][:, k])
    assert read["parts:part.x"].to_numpy()[0] == run["parts"][0, 0, 0]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ([], 2, {"RBL703", "--csv"}),
        (["--csv", "--parquet"], 2, {"RBL703", "--csv"}),
        (["-o", "x.txt"], 2, {"RBL703", "--csv"}),
        (["--csv", "-o", "x.parquet"], 2, {"RBL703", "--csv"}),
        (["--csv", "--signals", "q_fb,,t"], 2, {"RBL838"}),
        (["--csv", "-o", "no/x.csv"], 4, {"RBL706"}),
    ],
)
@pytest.mark.usefixtures("run")
def test_what_cannot_be_exported_is_refused_and_nothing_is_written(tmp_path, words, code, said):
    result = robolang("log", "export", "run.npz", *words, code=code)
    assert said <= fields(flat(result.stderr))
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]


# --- show -------------------------------------------------------------------------------------------------------------


def test_a_log_shows_what_it_holds(run):
    found = json.loads(robolang("log", "show", "run.npz", "--json").stdout)
    assert (found["program"], found["robot"], found["ok"]) == ("p.rbl", "puma560", True)
    assert found["duration_s"] == pytest.approx(len(run["t"]) * 0.001)
    assert found["events"] == [{"time_s": 0.0, "kind": "hand", "name": "hand", "value": 1.0}]
    signals = {each["name"]: each for each in found["signals"]}
    assert list(signals) == list(run)
    assert signals["parts"] == {
        "name": "parts",
        "rows": run.count("parts"),
        "columns": [f"part.{each}" for each in ("x", "y", "z", "qw", "qx", "qy", "qz")],
        "unit": "m",
    }
    shown = robolang("log", "show", "run.npz").stdout
    assert {"p.rbl", "puma560", "q_fb", "frame_t"} <= fields(shown)
    assert max(map(len, shown.splitlines())) <= 80


def test_a_log_of_an_older_version_is_shown_as_far_as_it_goes(tmp_path):
    old(tmp_path / "o.npz", t=np.arange(3.0), q_cmd=np.ones((3, 2)))
    found = json.loads(robolang("log", "show", tmp_path / "o.npz", "--json").stdout)
    assert (found["program"], found["ticks"]) == (None, 3)
    assert [each["name"] for each in found["signals"]] == ["t", "q_cmd"]
    robolang("log", "show", tmp_path / "o.npz")


def test_events_of_a_file_that_are_none_are_left_out(tmp_path):
    made = made_log(8)
    events = [*made.events, 3, {"time_s": "x"}, {"time_s": 1.0, "kind": "\x1b[2J", "name": "n", "value": 1}]
    write_log(tmp_path / "l.npz", Log(made.rows, {**made.meta, "events": events}))
    shown = robolang("log", "show", tmp_path / "l.npz").stdout
    assert "\x1b" not in shown
    assert len(json.loads(robolang("log", "show", tmp_path / "l.npz", "--json").stdout)["events"]) == 2


# --- what is mistaken for a log, and a log for something else ---------------------------------------------------------


@pytest.mark.parametrize("command", ["report {}", "plot {} q_fb", "log show {}", "log export {} --csv"])
def test_a_program_in_place_of_a_log_is_called_a_program(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.rbl").write_text("10 DELAY 0.1\n")
    said = flat(robolang(*command.format("p.rbl").split(), code=2).stderr)
    assert "RBL619" in said and said.count("p.rbl") >= 2
    assert [path.name for path in tmp_path.iterdir()] == ["p.rbl"]


@pytest.mark.parametrize("name", ["none.npz", "none.mcap"])
def test_a_log_that_is_missing_is_no_text_of_a_megabyte(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    said = flat(robolang("log", "show", name, code=2).stderr)
    assert "RBL600" in said and "UTF-8" not in said and "--log FILE.npz" in said and "FILE.mcap" in said


@pytest.mark.parametrize("command", ["log show {}", "report {}", "plot {} q_fb", "log export {} --csv -o x.csv"])
@pytest.mark.parametrize("name", ["folder", "folder.mcap"])
def test_a_folder_is_no_log(tmp_path, monkeypatch, command, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).mkdir()
    said = flat(robolang(*command.format(name).split(), code=2).stderr)
    assert "RBL600" in said and "a folder" in said and "None" not in said


def test_arrays_of_something_else_are_no_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    said = robolang("log", "show", "other.npz", code=2).stderr
    assert {"RBL619", "other.npz", "t"} <= fields(said) and "archive" not in said


@pytest.mark.parametrize("command", ["run run.npz", "check run.npz", "fmt run.npz", "view run.npz"])
@pytest.mark.usefixtures("run")
def test_a_log_in_place_of_a_program_is_called_a_log(command):
    said = flat(robolang(*command.split(), code=2).stderr)
    assert "RBL702" in said and "report" in said


def test_a_plot_of_a_run_without_rows_does_not_blame_the_times(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.rbl").write_text("x = 1\n")
    dry(tmp_path / "p.rbl", "--quiet", "--log", "run.npz")
    said = robolang("plot", "run.npz", "q_fb", code=2).stderr
    assert "RBL832" in said and "--from" not in said


@pytest.mark.usefixtures("run")
def test_a_plot_from_after_its_end_says_so():
    said = flat(robolang("plot", "run.npz", "q_fb", "--from", 0.5, "--to", 0.25, code=2).stderr)
    assert "RBL703" in said and "0.5" in said and "0.25" in said


@pytest.mark.usefixtures("run")
def test_blanks_between_signals_do_not_count(tmp_path):
    robolang("log", "export", "run.npz", "--csv", "--signals", "q_fb: 2, tool_cmd:z", "-o", "spaced.csv")
    robolang("log", "export", "run.npz", "--csv", "--signals", "q_fb:2,tool_cmd:z", "-o", "dense.csv")
    assert (tmp_path / "spaced.csv").read_bytes() == (tmp_path / "dense.csv").read_bytes()
    robolang("plot", "run.npz", "q_cmd:2 + q_fb:2")
    assert (tmp_path / "run-q_cmd2-q_fb2.svg").exists()
