"""``robolang report`` and ``robolang run --html``: one page from a log or from the run, whole or not at all."""

import os

import numpy as np
import pytest

from robolang.project.project import load_project
from tests.robolang.cli.commands import ROOT, dry, flat, robolang
from tests.robolang.view.decoding import Page, furthest

pytestmark = pytest.mark.physics

PICK = ROOT / "programs" / "pick_and_place.rbl"
OTHER = ROOT / "programs" / "manutec_pick_and_place.rbl"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with the log, the page and the report of a run."""
    folder = tmp_path_factory.mktemp("made")
    outputs = ("--log", folder / "run.npz", "--html", folder / "run.html", "--report", folder / "run.json")
    robolang("run", "--quiet", PICK, *outputs)
    return folder


@pytest.fixture
def short(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.rbl").write_text("MOVE P1 + (0, 0, 120)\n")
    return tmp_path


def header_of(path, number=0):
    return Page(path).runs[number][0]


def test_a_run_and_its_log_give_the_same_page_but_for_the_name(made):
    robolang("report", made / "run.npz", "-o", made / "again.html", "--label", "pick_and_place.rbl")
    assert (made / "again.html").read_bytes() == (made / "run.html").read_bytes()
    assert (made / "run.html").stat().st_size <= 1_200_000


def test_a_log_for_other_viewers_gives_the_same_page(short):
    dry("p.rbl", "--quiet", "--log", "a.npz")
    dry("p.rbl", "--quiet", "--log", "b.mcap")
    for name in ("a.npz", "b.mcap"):
        robolang("report", name, "--label", "run")
    assert (short / "a.html").read_bytes() == (short / "b.html").read_bytes()


def test_the_page_is_the_log_within_a_step(made):
    import robolang as api

    header, found = Page(made / "run.html").runs[0]
    log, steps = api.read_log(made / "run.npz"), {each["name"]: each["step"] for each in header["signals"]}
    for name in ("q_cmd", "q_fb", "q_link", "dq_fb", "tau_sat", "tool_error", "tool_speed", "parts", "fingers"):
        columns = log[name].astype(float).reshape(len(log[name]), -1).T
        for column, read, step in zip(columns, found[name], steps[name], strict=True):
            assert furthest(column, read) <= 0.5 * step + 1e-12, name
    for name in ("D", "D_age"):
        assert furthest(log[name][::8, 1], found[name][1]) <= 0.5 * steps[name][1] + 1e-12
    assert header["duration_s"] == pytest.approx(len(log["t"]) * 0.001)


def test_two_runs_are_in_one_page(made, short):
    dry("p.rbl", "--log", "b.npz", "--quiet")
    done = robolang("report", made / "run.npz", "b.npz", "-o", "both.html", "--label", "one", "--label", "two")
    assert "both.html" in done.stdout
    assert [header_of(short / "both.html", k)["label"] for k in (0, 1)] == ["one", "two"]


def test_the_page_stands_beside_its_log_where_no_name_is_given(short):
    dry("p.rbl", "--log", "a.npz", "--quiet")
    robolang("report", "a.npz")
    assert header_of(short / "a.html")["label"] == "a"


def test_runs_of_two_robots_are_refused_and_nothing_is_written(short):
    dry("p.rbl", "--log", "a.npz", "--quiet")
    dry(OTHER, "--log", "b.npz", "--quiet")
    assert "RBL826" in robolang("report", "a.npz", "b.npz", "-o", "c.html", code=2).stderr
    assert not (short / "c.html").exists()


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (("a.npz", "-o", "a.npz"), "--out"),
        (("a.npz", "-o", "page.txt"), "--out"),
        (("a.npz", "-o", "link.html"), "--out"),
        (("a.npz", "--label", "a", "--label", "b"), "--label"),
    ],
)
def test_options_that_cannot_be_are_refused_and_the_log_stays(short, words, option):
    dry("p.rbl", "--log", "a.npz", "--quiet")
    (short / "link.html").symlink_to("a.npz")
    before = (short / "a.npz").read_bytes()
    assert option in flat(robolang("report", *words, code=2).stderr)
    assert (short / "a.npz").read_bytes() == before


@pytest.mark.parametrize(
    ("data", "code"), [(None, "RBL600"), (b"", "RBL619"), (b"PK\5\6" + bytes(18), "RBL619"), (bytes(5000), "RBL619")]
)
def test_what_is_no_log_is_a_fault_and_nothing_is_written(short, data, code):
    if data is not None:
        (short / "a.npz").write_bytes(data)
    assert code in robolang("report", "a.npz", code=2).stderr
    assert not (short / "a.html").exists()


def test_a_log_of_an_older_layout_says_what_it_lacks(short):
    np.savez(short / "old.npz", t=np.zeros(3), q_cmd=np.zeros((3, 6)))
    assert "RBL820" in robolang("report", "old.npz", code=2).stderr
    assert not (short / "old.html").exists()


def test_a_folder_that_is_not_there_or_not_writable_is_found_first(short):
    dry("p.rbl", "--log", "a.npz", "--quiet")
    assert "RBL706" in robolang("report", "a.npz", "-o", "none/p.html", code=4).stderr
    assert "RBL706" in dry("p.rbl", "--html", "none/p.html", code=4).stderr
    (short / "shut").mkdir()
    if os.geteuid():
        (short / "shut").chmod(0o500)
        assert "RBL706" in robolang("report", "a.npz", "-o", "shut/p.html", code=4).stderr


@pytest.mark.parametrize(
    "words",
    [("--html", "p.rbl"), ("--html", "p.htm"), ("--html", "o.html", "--report", "./o.html"), ("--html", "link.html")],
)
def test_a_run_does_not_write_its_page_over_anything_else(short, words):
    (short / "link.html").symlink_to("p.rbl")
    assert "RBL703" in dry("p.rbl", *words, code=2).stderr
    assert (short / "p.rbl").read_text() == "MOVE P1 + (0, 0, 120)\n" and not (short / "o.html").exists()


def test_the_page_is_written_where_the_log_cannot_be(short, monkeypatch):
    from robolang.logs import files
    from runtime.core.faults import Fault

    def full(*_):
        raise Fault("RBL706", "no space")

    monkeypatch.setattr(files, "write_log", full)
    assert "RBL706" in dry("p.rbl", "--log", "a.npz", "--html", "a.html", code=4).stderr
    assert header_of(short / "a.html")["label"] == "p.rbl"


def test_a_run_that_ends_with_an_alarm_has_a_page_with_it(short):
    (short / "p.rbl").write_text("MOVE P1 + (0, 0, 120)\nFOR k = 1 TO 3\n  x = 1 / (2 - k)\nNEXT k\n")
    done = dry("p.rbl", "--html", "a.html", "--report", "a.json", code=3)
    header = header_of(short / "a.html")
    (alarm,) = [note for note in header["notes"] if note["severity"] == "error"]
    assert alarm["code"] in done.stderr and not header["meta"]["report"]["ok"]
    assert alarm["line"] == 3 and alarm["time_s"] == pytest.approx(header["duration_s"], abs=0.2)


def test_a_run_without_a_tick_has_a_page(short):
    (short / "p.rbl").write_text("x = 1\n")
    dry("p.rbl", "--html", "a.html")
    header, found = Page(short / "a.html").runs[0]
    # the arm stands at home: a row that takes no time
    assert (header["duration_s"], len(found["q_link"][0])) == (0.0, 1)


def test_no_folder_is_in_a_page(short):
    dry("p.rbl", "--html", "a.html")
    assert str(short) not in str(header_of(short / "a.html")) and load_project("p.rbl").ok
