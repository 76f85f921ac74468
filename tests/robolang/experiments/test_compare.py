"""Experiment A7: the same program under other gains and LOADs; figures of docs/servo.md."""

import json
import re

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.experiments.compare import VARIANTS, Request, compare, last_approach, wrong_mass
from tests.campaign import some
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, places, robolang

PROGRAM = str(ROOT / "programs" / "pick_and_place.rbl")
NAMES = ("scheduled", "diagonal", "load-omitted", "fixed-mid-load-omitted", "conventional")
CHOSEN = tuple(variant for variant in VARIANTS if variant.name in NAMES)
ARMS = some(["puma560", "manutec_r3"], 0)
"""Robots whose cells the figures hold for; each needs a program with 90 % of its rated payload."""


def heavy(folder, robot):
    """Return a program that carries 90 % of the rated payload of a robot."""
    if robot == "manutec_r3":
        return str(ROOT / "programs" / "manutec_pick_and_place.rbl")
    program = folder / "heavy.rbl"
    program.write_text(
        (ROOT / "programs" / "pick_and_place.rbl").read_text().replace("(0, 0, 95), 2.3", "(0, 0, 94.6), 2.25")
    )
    cell = (ROOT / "robolang/project/builtin/cell.toml").read_text().replace("mass_kg = 1.5", "mass_kg = 1.45")
    (folder / "cell.toml").write_text(cell)
    points = (ROOT / "robolang" / "project" / "builtin" / "points.toml").read_text()
    (folder / "heavy.points.toml").write_text(points)
    return str(program)


@pytest.fixture(scope="module", params=ARMS)
def rows(request, tmp_path_factory):
    program = heavy(tmp_path_factory.mktemp("heavy"), request.param)
    return {row["variant"]: row for row in compare(Request(program=program), CHOSEN)}


@pytest.mark.physics
def test_path_error_is_five_times_smaller_than_with_mid_gains_and_no_load(rows):
    good, bad = rows["scheduled"], rows["conventional"]
    assert bad["tool_rms_mm"] > 5.0 * good["tool_rms_mm"]
    assert bad["path_deviation_mm"] > 5.0 * good["path_deviation_mm"]


@pytest.mark.physics
def test_what_the_spring_lead_alone_does_is_not_counted_as_the_work_of_gains_and_load(rows):
    """The same with the lead in both: still 5 times on rigid gears, 3.5 on the Manutec, where dry friction remains."""
    good, bad = rows["scheduled"], rows["fixed-mid-load-omitted"]
    assert bad["tool_rms_mm"] > 3.5 * good["tool_rms_mm"]
    assert bad["path_deviation_mm"] > 4.5 * good["path_deviation_mm"]


@pytest.mark.physics
def test_whole_rows_follow_better_than_the_diagonal(rows):
    assert rows["scheduled"]["tool_rms_mm"] < 0.75 * rows["diagonal"]["tool_rms_mm"]


@pytest.mark.physics
def test_an_omitted_load_leaves_a_droop_and_never_settles(rows):
    assert rows["load-omitted"]["droop_deg"] > 3.5 * rows["scheduled"]["droop_deg"]
    assert rows["load-omitted"]["tool_rms_mm"] > 3.5 * rows["scheduled"]["tool_rms_mm"]
    assert rows["scheduled"]["settling_s"] is not None
    assert rows["load-omitted"]["settling_s"] is None


def test_a_wrong_load_never_changes_the_commanded_path():
    from robolang.experiments.compare import _Loads

    request = Request(program=PROGRAM, physics=False)
    plans = []
    for variant in VARIANTS:
        if variant.name in ("scheduled", "load-omitted", "load-wrong"):
            project = request.project(variant)
            session = Session(project, physics=False, alter=_Loads(variant.load, project.cell).alter)
            log = session.run().log
            for run in session.record.statements:
                if run.path is not None:
                    q = log["q_plan"][run.first_tick : run.end_tick]
                    moving = np.flatnonzero((np.diff(q, axis=0) != 0.0).any(axis=1))
                    plans.append((run.origin.number, q[moving]))
    by_line = {}
    for line, q in plans:
        by_line.setdefault(line, []).append(q)
    assert sorted(by_line) == [30, 60, 70, 100, 110]
    for line, same in by_line.items():
        assert len(same) == 3
        assert all(np.array_equal(q, same[0]) for q in same), line


def short(folder):
    """Return a program of two short moves, with a load each."""
    program = folder / "short.rbl"
    program.write_text("LOAD (0, 0, 60), 0.8\nMOVE P2\nLOAD (0, 0, 95), 2.3\nMOVE P4\n")
    return str(program)


def test_two_processes_give_what_one_gives(tmp_path):
    request, two = Request(program=short(tmp_path), physics=False), (VARIANTS[0], VARIANTS[3])
    told = []
    assert compare(request, two, jobs=2, done=told.append) == compare(request, two)
    assert told == [variant.title for variant in two]


def test_a_load_is_wrong_by_thirty_percent_of_the_rated_one():
    assert wrong_mass(0.8, 2.5) == pytest.approx(1.55)
    assert wrong_mass(2.3, 2.5) == pytest.approx(1.55)
    assert wrong_mass(0.5, 100.0) == 30.5


def variants(*names):
    return tuple(variant for variant in VARIANTS if variant.name in names)


@pytest.mark.physics
def test_a_load_declared_by_name_is_made_wrong_too(tmp_path):
    """LOAD by its name and LOAD by numbers are one payload, so they are made wrong alike."""
    text = "LOAD {}\nMOVE P2\n"
    rows = []
    for name, load in (("named", "hand_and_part"), ("numbers", "(0, 0, 95), 2.3")):
        program = tmp_path / f"{name}.rbl"
        program.write_text(text.format(load))
        rows.append(compare(Request(program=str(program)), variants("scheduled", "load-omitted", "load-wrong")))
    named, numbers = rows
    assert named == numbers
    assert all(row["changes"] and not row["note"] for row in named)
    assert named[2]["tool_rms_mm"] != named[0]["tool_rms_mm"]


@pytest.mark.parametrize(
    ("text", "name", "options"),
    [
        ("MOVE P2\n", "load-omitted", {}),
        ("MOVE P2\n", "load-wrong", {}),
        ("LOAD (0, 0, 0), 0\nMOVE P2\n", "load-omitted", {}),
        ("LOAD (0, 0, 60), 0.8\nMOVE P2\n", "starved", {"dynamics_cost_per_axis_ms": ("--set", 50.0)}),
        ("LOAD (0, 0, 60), 0.8\nMOVE P2\n", "no-lead", {}),  # an arm without gear springs, and without physics
    ],
)
def test_a_variant_that_changes_nothing_says_so_and_has_no_figures(tmp_path, text, name, options):
    program = tmp_path / "p.rbl"
    program.write_text(text)
    request = Request(program=str(program), options=options, physics=False)
    base, row = compare(request, variants("scheduled", name))
    assert (base["changes"], base["note"]) == (True, "")
    assert base["tool_rms_mm"] is not None
    assert not row["changes"]
    assert row["note"]
    assert row["tool_rms_mm"] is row["moves"] is None


@pytest.mark.physics
def test_a_part_of_a_variant_that_changes_nothing_is_named(tmp_path):
    program = tmp_path / "p.rbl"
    program.write_text("MOVE P2\n")
    _, row = compare(Request(program=str(program)), variants("scheduled", "fixed-mid-load-omitted"))
    assert (row["changes"], fields(row["note"])) == (True, {"LOAD"})
    assert row["tool_rms_mm"] is not None


def test_overshoot_and_settling_of_a_made_up_move():
    t = np.arange(300) * 0.01
    q_cmd = np.minimum(t, 1.0)[:, None] * 0.5  # to 0.5 rad in one second
    q_fb = q_cmd + np.where(t < 1.0, 0.0, 0.05 * np.exp(-(t - 1.0) / 0.2))[:, None]
    overshoot, settling = last_approach(q_cmd, q_fb, t)
    assert overshoot == pytest.approx(10.0)
    assert settling == pytest.approx(0.2 * np.log(5.0), abs=0.011)  # 0.05 rad down to 2 % of 0.5 rad
    assert last_approach(q_cmd, q_cmd + 0.02, t) == (pytest.approx(4.0), None)
    assert last_approach(0.0 * q_cmd, q_fb, t)[0] is None  # no axis approaches anything


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_command_that_passes_its_end_and_comes_back_is_no_overshoot(sign):
    t = np.arange(300) * 0.01
    q_cmd = sign * np.interp(t, [0.0, 1.0, 1.5], [0.0, 0.11, 0.1])[:, None]  # 0.57 deg past its end
    assert last_approach(q_cmd, q_cmd, t)[0] == 0.0
    assert last_approach(q_cmd, q_cmd + sign * 0.002, t)[0] == pytest.approx(2.0)
    broken = np.where(np.arange(300)[:, None] == 150, np.nan, q_cmd)
    assert np.isnan(last_approach(q_cmd, broken, t)[0])


def test_the_command_prints_every_variant_and_says_how_far_it_is(tmp_path):
    program = short(tmp_path)
    shown = robolang("compare", "--no-physics", "--only", "scheduled,fixed-max", program)
    (title,) = (variant.title for variant in variants("fixed-max"))
    assert title in shown.stdout
    assert f"2/2 {title}" in shown.stderr
    found = json.loads(robolang("compare", "--no-physics", "--json", "--only", "scheduled", program).stdout)
    assert [row["variant"] for row in found["variants"]] == ["scheduled"]
    assert len(found["variants"][0]["per_axis"]["droop_deg"]) == 6
    assert "RBL703 --only" in robolang("compare", "--only", "nothing", program, code=2).stderr


def test_a_program_with_errors_is_not_compared(tmp_path):
    program = tmp_path / "bad.rbl"
    program.write_text("MOV P1\n")
    assert "RBL112" in robolang("compare", program, code=1).stderr


def test_a_run_that_ends_with_an_alarm_is_placed_in_the_program(tmp_path):
    program = tmp_path / "p.rbl"
    program.write_text("2 LOAD (0, 0, 60), 0.8\n3 X = 0\n4 MOVE P1\n5 IF X = 0 THEN PRINT 1 / X\n")
    words = ("compare", program, "--no-physics", "--only", "scheduled")
    result = robolang(*words, code=3)
    assert re.search(rf" {re.escape(str(program))}:4:17, \d+\.\d+ s: RBL501 ", result.stdout)
    (row,) = json.loads(robolang(*words, "--json", code=3).stdout)["variants"]
    (alarm,) = row["alarms"]
    assert (alarm["code"], alarm["file"], alarm["line"], alarm["column"], alarm["number"]) == (
        "RBL501",
        str(program),
        4,
        17,
        5,
    )
    assert [(move["line"], move["number"]) for move in row["moves"]] == [(3, 4)]


@pytest.mark.physics
def test_supervision_is_off_and_the_output_says_so(tmp_path):
    """A LOAD declared 1.5 kg too light: `run` stops, `compare` goes on."""
    program = tmp_path / "p.rbl"
    program.write_text("LOAD (0, 0, 60), 2.3\nMOVE P2\nMOVE P1\nMOVE P2\n")
    assert places(robolang("run", program, "--quiet", code=3).stderr)[0][2] == "RBL517"
    words = ("compare", program, "--only", "scheduled")
    assert "supervision" in robolang(*words).stdout.lower()
    found = json.loads(robolang(*words, "--json").stdout)
    assert (found["supervision"], found["variants"][0]["alarms"]) == (False, [])
