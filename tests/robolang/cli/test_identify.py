"""``robolang identify``, and the compensation file in ``run``, a cell and a profile."""

import json
import pickle
import re
import shutil

import numpy as np
import pytest

from robolang.experiments import identify as identification
from robolang.project.project import builtin_cell, load_project
from runtime.dynamics.compensation import load_compensation
from runtime.robot.files.loader import load_builtin
from tests.campaign import some
from tests.messages import fields, heads
from tests.robolang.cli.commands import BUILTIN, PUMA, ROOT, dry, flat, places, robolang

SPEC = load_builtin("puma560")
QUICK = ("--plant", "rigid", "--positions", "2")
TABLE_JOINTS = dict(some(((1, (1, 2)), (2, (2,))), 1))
"""By the number of an axis, the joints (0-based) of its table."""
TABLE = (
    "--axis",
    ",".join(map(str, (*TABLE_JOINTS, 6))),
    "--plant",
    "rigid",
    "--positions",
    "1",
    "--table",
    "2",
    "--error",
    "4",
)


@pytest.fixture(scope="module", autouse=True)
def identified_once():
    """Commands that ask for the same share one identification: what they print and write of it is tested here."""
    run, kept = identification.identify, {}

    def identify(request, progress):
        key = pickle.dumps(request)
        if key in kept:
            results, told = kept[key]
            for where in told:
                progress(*where)
            return results
        told = []

        def tell(*where):
            told.append(where)
            progress(*where)

        results = run(request, tell)
        kept[key] = results, told
        return results

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(identification, "identify", identify)
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A file of axes 3 and 6, and what the command printed."""
    path = tmp_path_factory.mktemp("identify") / "arm.compensation.toml"
    result = robolang(
        "identify",
        "puma560",
        "--axis",
        "3,6",
        *QUICK,
        "--error",
        "4",
        "--out",
        path,
        "--date",
        "2026-11-24",
        "--carrying",
        "0.8,0,0,60",
    )
    return path, result


def test_the_table_has_a_row_for_each_axis_and_fits_80_columns(made):
    _, result = made
    assert {"puma560", "1e-6", "kg", "m2", "2"} <= fields(result.stdout.splitlines()[0])
    rows = re.findall(r"^ *(J\d) +(\S+) +(\S+) +(\S+) +(\S+) +(\S+) +(\S+) +(\S+)", result.stdout, re.M)
    assert [row[0] for row in rows] == ["J3", "J6"]
    for row in rows:
        _, identified, model, compensation, spread, _, off = map(float, row[1:])
        assert compensation == pytest.approx(identified - model, abs=2e-3)
        assert abs(off) < 0.5
        assert spread < 0.01 * identified
    assert max(map(len, result.stdout.splitlines()[1:])) <= 80


def test_progress_says_which_axis_and_position_runs(made):
    _, result = made
    lines = result.stderr.splitlines()
    assert [line.rpartition(",")[0] for line in lines] == [
        f"J{axis}, position {number} of 2" for axis in (3, 6) for number in (1, 2)
    ]
    assert all(line.endswith(" deg") for line in lines)


def test_the_file_holds_what_was_found(made):
    path, result = made
    found = load_compensation(path, SPEC)
    assert (found.robot, found.date, found.positions) == ("puma560", "2026-11-24", 2)
    assert found.payload.mass == 0.8
    assert [axis.identified is not None for axis in found.axes] == [False, False, True, False, False, True]
    for axis, nominal in zip(found.axes[:2], SPEC.axes, strict=False):
        assert axis.compensation == nominal.motor.rotor_inertia
    assert f"{found.axes[2].compensation * 1e6:.3f}" in result.stdout
    assert "# J1, not" in path.read_text("utf-8")


def test_json_has_every_position(tmp_path):
    found = json.loads(robolang("identify", "puma560", "--axis", "6", *QUICK, "--json").stdout)
    (axis,) = found["axes"]
    assert (found["robot"], found["plant"], found["model_errors"], axis["axis"]) == ("puma560", "rigid", False, 6)
    assert len(axis["positions_deg"]) == len(axis["identified_by_position_kg_m2"]) == 2
    assert axis["identified_kg_m2"] == pytest.approx(axis["true_kg_m2"], rel=1e-3)
    assert axis["compensation_kg_m2"] == pytest.approx(axis["rotor_kg_m2"], rel=2e-3)


def test_without_a_date_the_file_has_none(tmp_path):
    path = tmp_path / "a.compensation.toml"
    robolang("identify", "puma560", "--axis", "6", *QUICK, "--out", path)
    assert "date" not in path.read_text("utf-8")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--axis", "0"), "RBL703 --axis 1"),
        (("--axis", "1,7"), "RBL703 --axis 2"),
        (("--axis", "1,"), "RBL703 --axis 2"),
        (("--axis", "waist"), "1 6"),
        (("--plant", "real"), "RBL703 --plant"),
        (("--date", "yesterday"), "RBL703 --date"),
        (("--out", "file.toml"), ".compensation.toml"),
        (("--carrying", "1,0,0"), "RBL703 --carrying"),
        (("--carrying", "9,0,0,0"), "--carrying 9 kg"),
        (("--positions", "0"), "--positions"),
        (("--error", "x"), "--error"),
        (("--table", "1"), "--table"),
        (("--table", "8"), "--table"),
    ],
)
def test_options_that_cannot_be_are_refused(words, said):
    result = robolang("identify", "puma560", *words, code=2)
    assert set(said.split()) <= fields(flat(result.stderr))
    assert "position 1 " not in result.stderr


def test_an_unknown_robot_and_a_file_that_cannot_be_written_are_refused_before_anything_moves(tmp_path):
    assert "RBL708" in robolang("identify", "puma", code=2).stderr
    result = robolang("identify", "puma560", "--out", tmp_path / "no" / "a.compensation.toml", code=4)
    assert "RBL706" in result.stderr
    assert "position" not in result.stderr


def test_a_test_motion_that_would_leave_a_limit_is_refused_with_its_joint(tmp_path):
    robot = tmp_path / "narrow.toml"
    robot.write_text(PUMA.read_text("utf-8").replace("range_deg = [-225, 45]", "range_deg = [-100, -86]"), "utf-8")
    result = robolang("identify", robot, *QUICK, "--out", tmp_path / "a.compensation.toml", code=3)
    assert "error RBL420 J3 has 10.0 deg" in result.stderr
    assert "position 1" not in result.stderr
    assert not list(tmp_path.glob("*.compensation.toml"))


@pytest.fixture(scope="module")
def with_table(tmp_path_factory):
    path = tmp_path_factory.mktemp("table") / "arm.compensation.toml"
    return path, robolang("identify", "puma560", *TABLE, "--json", "--out", path)


def test_a_table_is_in_the_file_the_figures_and_the_progress(with_table):
    path, result = with_table
    found, shown = load_compensation(path, SPEC), json.loads(result.stdout)["axes"]
    assert [number for number, axis in enumerate(found.axes, start=1) if axis.table] == list(TABLE_JOINTS)
    told = []
    for (number, joints), axis in zip(TABLE_JOINTS.items(), shown, strict=False):
        table = found.axes[number - 1].table
        assert table.joints == joints
        assert [joint - 1 for joint in axis["table"]["joints"]] == list(joints)
        assert axis["table"]["compensation_kg_m2"] == list(table.values)
        assert np.radians(axis["table"]["deg"]) == pytest.approx(np.array(table.grid))
        assert found.axes[number - 1].compensation == axis["compensation_kg_m2"] == pytest.approx(table.mean)
        places = 1 + 2 ** len(joints)
        told += [(str(number), str(place), str(places)) for place in range(1, places + 1)]
    assert "table" not in shown[-1]
    assert re.findall(r"J(\d), position (\d) of (\d)", result.stderr) == [*told, ("6", "1", "1")]


def test_the_heading_names_the_table():
    heading = robolang("identify", "puma560", *TABLE).stdout.splitlines()[0]
    assert {"1", "2"} <= fields(heading)
    assert "table" in heading


def test_three_places_tell_friction_and_weight(tmp_path):
    axes = some((1, 2), 0)
    path = tmp_path / "a.compensation.toml"
    words = ("--axis", ",".join(str(axis + 1) for axis in axes), "--plant", "rigid", "--positions", "3", "--error", "4")
    shown = json.loads(robolang("identify", "puma560", *words, "--json", "--out", path).stdout)
    found = load_compensation(path, SPEC)
    assert [list(moment) for moment in found.first_moments] == shown["first_moments_kg_m"]
    assert np.linalg.norm(found.first_moments[1]) > 0.2
    for row, axis in zip(shown["axes"], axes, strict=True):
        assert row["friction_nm"] > SPEC.axes[axis].motor.joint_coulomb_friction[0]
        assert row["weight_beyond_nm"] > 0.5
    text = robolang("identify", "puma560", *words).stdout
    assert max(map(len, text.splitlines()[1:])) <= 80
    assert re.search(rf"^ *J2 +{shown['axes'][0]['friction_nm']:.2f} ", text, re.M)


def test_a_program_names_robot_controller_and_hand(tmp_path):
    program = ROOT / "programs/manutec_pick_and_place.rbl"
    path = tmp_path / "a.compensation.toml"
    words = ("--axis", "6", *QUICK, "--json", "--out", path)
    found = json.loads(robolang("identify", program, *words).stdout)
    hand = load_project(program).cell.hand
    assert (found["robot"], found["payload_kg"]) == ("manutec_r3", hand.mass)
    assert load_compensation(path, load_builtin("manutec_r3")).payload.mass == hand.mass
    assert heads(robolang("identify", tmp_path / "no.rbl", code=2).stderr) == [f"{tmp_path}/no.rbl:1:1: error RBL701"]


def test_the_payload_is_identified_as_weigh_does(tmp_path):
    words = (ROOT / "programs/pick_and_place.rbl", "--plant", "rigid", "--json")
    assert robolang("identify", "--payload", *words).stdout == robolang("weigh", *words).stdout
    of_robot = json.loads(robolang("identify", "puma560", "--payload", "--plant", "rigid", "--json").stdout)
    assert of_robot["true"]["mass_kg"] == builtin_cell().hand.mass
    result = robolang("identify", "puma560", "--payload", "--table", "3", code=2)
    assert "RBL703 --table" in result.stderr


# --- use -------------------------------------------------------------------------------------------------------------


def project(tmp_path, made, line='compensation = "arm.compensation.toml"'):
    program = tmp_path / "job.rbl"
    program.write_text("10 LOAD (0, 0, 60), 0.8\n", "utf-8")
    cell = (BUILTIN / "cell.toml").read_text("utf-8")
    (tmp_path / "job.cell.toml").write_text(f"{cell}\n[controller.servo]\n{line}\n", "utf-8")
    shutil.copy(made[0], tmp_path / "arm.compensation.toml")
    return program


def test_a_run_takes_the_file_by_option_and_by_the_cell(tmp_path, made):
    program = project(tmp_path, made)
    dry(program)
    dry(program, "--compensation", made[0])
    shown = json.loads(robolang("config", "show", program, "--json").stdout)["settings"]
    (row,) = [row for row in shown if row["key"] == "servo.compensation"]
    assert row["value"] == "arm.compensation.toml"
    assert re.search(r"job\.cell\.toml:\d+$", row["from"])
    expected = tuple(load_compensation(made[0], SPEC).rotors(SPEC))
    option = {"servo.compensation": ("--compensation", str(made[0]))}
    assert load_project(program).profile.servo.rotors == expected
    assert load_project(project(tmp_path, made, ""), options=option).profile.servo.rotors == expected
    assert load_project(program).profile.servo.rotors == ()


def test_a_run_takes_the_table(tmp_path, with_table):
    program = project(tmp_path, with_table)
    dry(program)
    found, servo = load_compensation(with_table[0], SPEC), load_project(program).profile.servo
    assert servo.rotors == tuple(found.rotors(SPEC))
    assert servo.rotor_tables == found.rotor_tables(SPEC)
    for number in TABLE_JOINTS:
        assert servo.rotor_tables[number - 1].mean == pytest.approx(0.0, abs=1e-12)


def test_a_profile_names_the_file_beside_itself(tmp_path, made):
    program = project(tmp_path, made, "")
    folder = tmp_path / "profiles"
    folder.mkdir()
    shutil.copy(made[0], folder / "its.compensation.toml")
    text = 'schema = 1\n[controller.servo]\ncompensation = "its.compensation.toml"\n'
    (folder / "p.toml").write_text(text, "utf-8")
    dry(program, "--profile", folder / "p.toml")
    (folder / "its.compensation.toml").rename(tmp_path / "its.compensation.toml")
    result = dry(program, "--profile", folder / "p.toml", code=2)
    assert "its.compensation.toml" in result.stderr


@pytest.mark.parametrize("name", ["../arm.compensation.toml", "/etc/passwd", "C:\\\\arm.toml"])
def test_a_cell_cannot_name_a_file_outside_its_folder(name, tmp_path, made):
    result = dry(project(tmp_path, made, f'compensation = "{name}"'), code=2)
    ((line, column, code),) = places(result.stderr)
    assert (column, code) == (1, "RBL602")
    assert line > 30


def test_an_unusable_file_is_refused_at_its_own_place(tmp_path, made):
    program = project(tmp_path, made)
    path = tmp_path / "arm.compensation.toml"
    path.write_text(path.read_text("utf-8").replace('robot = "puma560"', 'robot = "irb2400"'), "utf-8")
    result = dry(program, code=2)
    assert places(result.stderr) == [(2, 1, "RBL617")]
    assert "arm.compensation.toml:2:1" in result.stderr
    assert places(dry(program, "--compensation", tmp_path / "none.toml", code=2).stderr) == [(1, 1, "RBL600")]


def test_a_compensation_that_is_not_a_name_is_refused(tmp_path, made):
    result = dry(project(tmp_path, made, "compensation = 3"), code=2)
    assert [code for _, _, code in places(result.stderr)] == ["RBL613"]
