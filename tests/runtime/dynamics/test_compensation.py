"""The compensation file, and the servo that uses it: the rotor counts once."""

import re
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import lookup
from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG
from runtime.dynamics.compensation import AxisCompensation, Compensation, as_toml, load_compensation
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.payload import Payload
from runtime.servo.axes import ServoAxes, gains, rotors
from runtime.settings.profile import ServoOptions

SPEC = load_builtin("puma560")
N2 = SPEC.per_axis("motor", "gear_ratio") ** 2
FOUND = Compensation(
    robot="puma560",
    date="2026-11-24",
    positions=5,
    payload=Payload(mass=0.8, cog=np.array([0.0, 0.01, 0.06])),
    axes=(
        AxisCompensation(compensation=3.1529473526410994e-04, spread=2.3e-8, model=7.3e-4, identified=1.05e-3),
        AxisCompensation(compensation=2.2e-4, spread=0.0, model=1e-4, identified=3e-4, first_moment=(0.5, -0.01, 0.0)),
        AxisCompensation(compensation=2.2e-4 / 3, spread=0.0, model=1e-4, identified=3e-4),
        *(AxisCompensation(compensation=axis.motor.rotor_inertia) for axis in SPEC.axes[3:]),
    ),
)


TABLES = (
    JointTable(
        joints=(1, 2),
        grid=tuple(tuple(deg * DEG for deg in grid) for grid in ((1.33, 90.0), (-223, 0.1, 43))),
        values=tuple((3.1e-4 + np.arange(6) / 7e5).tolist()),
    ),
    JointTable(joints=(2,), grid=((-100.07 * DEG, 20.0 * DEG),), values=(2.1e-4, 2.3e-4)),
)
WITH_TABLES = replace(
    FOUND, axes=(*(replace(axis, table=t) for axis, t in zip(FOUND.axes, TABLES, strict=False)), *FOUND.axes[2:])
)


def read(tmp_path, text):
    path = tmp_path / "arm.compensation.toml"
    path.write_text(text, "utf-8")
    return load_compensation(path, SPEC)


def test_a_file_is_read_back_to_the_last_bit(tmp_path):
    found = read(tmp_path, as_toml(FOUND))
    assert (found.robot, found.date, found.positions, found.axes) == ("puma560", "2026-11-24", 5, FOUND.axes)
    assert found.payload.mass == 0.8
    np.testing.assert_allclose(found.payload.cog, FOUND.payload.cog, rtol=1e-15)
    assert as_toml(found) == as_toml(FOUND)


def test_the_date_may_be_left_out(tmp_path):
    text = as_toml(replace(FOUND, date=""))
    assert "date" not in text
    assert read(tmp_path, text).date == ""


def test_rotors_are_at_the_joint(tmp_path):
    np.testing.assert_array_equal(FOUND.rotors(SPEC)[3:], spec_rotors(SPEC)[3:])
    assert FOUND.rotors(SPEC)[0] == pytest.approx(62.6111**2 * 3.1529473526410994e-04)


def test_tables_are_read_back_to_the_last_bit(tmp_path):
    found = read(tmp_path, as_toml(WITH_TABLES))
    assert found.axes == WITH_TABLES.axes
    assert as_toml(found) == as_toml(WITH_TABLES)
    assert "table" not in as_toml(FOUND)


def test_an_axis_that_was_not_identified_may_have_a_table(tmp_path):
    axes = (*FOUND.axes[:3], replace(FOUND.axes[3], table=replace(TABLES[1], joints=(5,), values=(3e-5, 4e-5))))
    axes = (*axes, *FOUND.axes[4:])
    assert read(tmp_path, as_toml(replace(FOUND, axes=axes))).axes == axes


def test_what_the_servo_gets_adds_up_to_the_table():
    """N^2 Jc of the file stays in the gains, D has the rest: together they are the table, wherever its mean is."""
    assert FOUND.rotor_tables(SPEC) == ()
    tables = WITH_TABLES.rotor_tables(SPEC)
    assert [table is None for table in tables] == [False, False, True, True, True, True]
    for q in np.random.default_rng(2).uniform(SPEC.lower, SPEC.upper, (20, 6)):
        Jc = [TABLES[0].at(q), TABLES[1].at(q), *(axis.compensation for axis in FOUND.axes[2:])]
        np.testing.assert_allclose(WITH_TABLES.at(SPEC, q), N2 * Jc, rtol=1e-12)
        added = [0.0 if table is None else table.at(q) for table in tables]
        np.testing.assert_allclose(FOUND.rotors(SPEC) + added, N2 * Jc, rtol=1e-12)
    np.testing.assert_array_equal(FOUND.at(SPEC, np.zeros(6)), FOUND.rotors(SPEC))


@pytest.mark.parametrize(("point", "fits"), [(0, True), (1, True), (2, False), (3, False)])
def test_a_table_may_take_off_what_the_arm_has_in_that_posture(point, fits, tmp_path):
    """J1 of the Puma has 4.3 and 2.7 kg m2 with the upper arm level, 1.6 upright."""
    values = [1e-4] * 4
    values[point] = -2.0 / N2[0]
    table = JointTable(joints=(1, 2), grid=((0.0, 0.5 * np.pi), (-0.5 * np.pi, 0.5 * np.pi)), values=tuple(values))
    text = as_toml(replace(FOUND, axes=(replace(FOUND.axes[0], table=table), *FOUND.axes[1:])))
    if fits:
        assert read(tmp_path, text).axes[0].table == table
    else:
        with pytest.raises(FileFault, match="table_kg_m2"):
            read(tmp_path, text)


WRONG_TABLE = {
    "no joint": (r"(table_joints = )\[2, 3\]", r"\1[]", "RBL613", "one or two"),
    "three joints": (r"(table_joints = )\[2, 3\]", r"\1[2, 3, 4]", "RBL613", "one or two"),
    "the axis itself": (r"(table_joints = )\[2, 3\]", r"\1[1, 3]", "RBL605", "beyond J1"),
    "a joint twice": (r"(table_joints = )\[2, 3\]", r"\1[3, 3]", "RBL605", "rising"),
    "joints the other way": (r"(table_joints = )\[2, 3\]", r"\1[3, 2]", "RBL605", "rising"),
    "a joint that is none": (r"(table_joints = )\[2, 3\]", r"\1[2, 7]", "RBL605", "up to J6"),
    "half a joint": (r"(table_joints = )\[2, 3\]", r"\1[2, 2.5]", "RBL605", "beyond J1"),
    "joints are no list": (r"(table_joints = )\[2, 3\]", r"\1 2", "RBL613", "list"),
    "no joints": (r"table_joints = \[2, 3\]\n", "", "RBL608", "table_joints"),
    "one list": (r"(table_deg = )\[(\[.*?\]).*", r"\1[\2]", "RBL613", "2 lists"),
    "no lists": (r"(table_deg = ).*", r"\1[1, 2]", "RBL613", "list"),
    "no angles": (r"table_deg = .*\n", "", "RBL613", "2 lists"),
    "angles are no list": (r"(table_deg = ).*", r"\1 3", "RBL613", "list"),
    "one angle": (r"\[1.33, 90.0\]", "[1.33]", "RBL613", "2 to 50"),
    "too many angles": (r"\[1.33, 90.0\]", str(list(range(51))), "RBL613", "2 to 50"),
    "angles that fall": (r"\[1.33, 90.0\]", "[90, 1]", "RBL605", "rise"),
    "an angle twice": (r"\[1.33, 90.0\]", "[90, 90]", "RBL605", "rise"),
    "two angles that are one": (r"\[1.33, 90.0\]", "[0, 1e-323]", "RBL605", "rise"),
    "an angle without end": (r"\[1.33, 90.0\]", "[1, inf]", "RBL604", "finite"),
    "an angle far off": (r"\[1.33, 90.0\]", "[1, 1e6]", "RBL605", "3600"),
    "an angle in words": (r"\[1.33, 90.0\]", '[1, "two"]', "RBL613", "number"),
    "a value less": (r"(table_kg_m2 = \[\n).*?,", r"\1", "RBL613", "6 numbers, not 5"),
    "a value more": (r"(table_kg_m2 = \[\n)", r"\1 1e-4, ", "RBL613", "6 numbers, not 7"),
    "a value without end": (r"(table_kg_m2 = \[\n).*?,", r"\1 nan,", "RBL604", "finite"),
    "a value beyond belief": (r"(table_kg_m2 = \[\n).*?,", r"\1 0.1,", "RBL605", "10 times"),
    "a value below nothing": (r"(table_kg_m2 = \[\n).*?,", r"\1 -0.01,", "RBL605", "J1"),
    "no values": (r"table_kg_m2 = \[[^]]*\]\n", "", "RBL608", "table_kg_m2"),
}


@pytest.mark.parametrize("case", WRONG_TABLE)
def test_what_is_wrong_with_a_table_is_refused_in_its_axis(case, tmp_path):
    before, after, code, word = WRONG_TABLE[case]
    text, count = re.subn(before, after, as_toml(WITH_TABLES), count=1)
    assert count == 1
    with pytest.raises(FileFault) as caught:
        read(tmp_path, text)
    assert (caught.value.code, word in caught.value.message) == (code, True), caught.value
    first, second = [k for k, line in enumerate(text.splitlines(), start=1) if "[[axes]]" in line][:2]
    assert first <= caught.value.line < second


def test_the_last_axis_has_no_table(tmp_path):
    axes = (*FOUND.axes[:5], replace(FOUND.axes[5], table=TABLES[1]))
    with pytest.raises(FileFault, match="beyond"):
        read(tmp_path, as_toml(replace(FOUND, axes=axes)))


WRONG = {
    "other robot": ('robot = "puma560"', 'robot = "irb2400"', "RBL617", "irb2400"),
    "newer schema": ("schema = 1", "schema = 2", "RBL618", "newer"),
    "older schema": ("schema = 1", "schema = 0", "RBL618", "older"),
    "no schema": ("schema = 1\n", "", "RBL608", "schema"),
    "one axis less": (r"\[\[axes\]\]  # J1\n(.*\n){4}", "", "RBL613", "5 entries"),
    "one axis more": (r"\Z", "[[axes]]\ncompensation_kg_m2 = 1e-4\n", "RBL613", "7 entries"),
    "axes are no tables": (r"\[\[axes\]\](.*\n)*", "[axes]\n", "RBL613", "axes"),
    "not a number": (r"compensation_kg_m2 = 0.0002\d*", "compensation_kg_m2 = nan", "RBL604", "finite"),
    "infinite spread": (r"spread_kg_m2 = 0.0\b", "spread_kg_m2 = inf", "RBL604", "finite"),
    "a text": (r"compensation_kg_m2 = 0.0002\d*", 'compensation_kg_m2 = "much"', "RBL613", "number"),
    "a figure alone": (r"spread_kg_m2 = 2.3e-08\n", "", "RBL608", "spread"),
    "negative spread": ("spread_kg_m2 = 2.3e-08", "spread_kg_m2 = -1e-9", "RBL605", "spread"),
    "no inertia": ("model_kg_m2 = 0.00073", "model_kg_m2 = 0", "RBL605", "model"),
    "misspelt key": ("identified_kg_m2 = 0.00105", "identifed_kg_m2 = 0.00105", "RBL608", "identified"),
    "unknown key of an axis": (r"(identified_kg_m2 = 0.00105)", r"\1\nrotor = 1", "RBL609", "rotor"),
    "unknown key": ("positions = 5", 'positions = 5\ncolour = "red"', "RBL609", "colour"),
    "unknown key of the payload": ("mass_kg = 0.8", "mass_kg = 0.8\nmass_g = 800", "RBL609", "mass_g"),
    "no positions": ("positions = 5", "positions = 0", "RBL605", "positions"),
    "no day": ("2026-11-24", "2026-13-24", "RBL605", "2026-13-24"),
    "payload far away": (r"cog_mm = .*", "cog_mm = [0, 0, 3000]", "RBL403", "3000"),
    "payload below nothing": ("mass_kg = 0.8", "mass_kg = -0.8", "RBL605", "mass_kg"),
    "inertia below nothing": (r"compensation_kg_m2 = 0.0003\d*", "compensation_kg_m2 = -0.01", "RBL605", "J1"),
    "a moment of two": (r"first_moment_kg_m = \[.*\]", "first_moment_kg_m = [1.0, 2.0]", "RBL613", "3 numbers"),
    "a moment beyond belief": (r"first_moment_kg_m = \[.*\]", "first_moment_kg_m = [99.0, 0.0, 0.0]", "RBL605", "J2"),
    "a moment not a number": (r"first_moment_kg_m = \[.*\]", "first_moment_kg_m = [nan, 0.0, 0.0]", "RBL604", "finite"),
    "inertia beyond belief": (r"compensation_kg_m2 = 0.0003\d*", "compensation_kg_m2 = 0.1", "RBL605", "10 times"),
    "not TOML": ("positions = 5", "positions = = 5", "RBL601", ""),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_refused_at_its_line(case, tmp_path):
    before, after, code, word = WRONG[case]
    text, count = re.subn(before, after, as_toml(FOUND), count=1)
    assert count == 1
    with pytest.raises(FileFault) as caught:
        read(tmp_path, text)
    assert caught.value.code == code
    assert word in caught.value.message
    assert caught.value.path.endswith("arm.compensation.toml")
    assert caught.value.line >= 1
    assert caught.value.hint


def test_the_line_is_that_of_the_key(tmp_path):
    with pytest.raises(FileFault) as caught:
        read(tmp_path, as_toml(FOUND).replace('robot = "puma560"', 'robot = "irb2400"'))
    assert (caught.value.line, caught.value.excerpt) == (2, 'robot = "irb2400"')


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(FileFault) as caught:
        load_compensation(tmp_path / "none.compensation.toml", SPEC)
    assert caught.value.code == "RBL600"


def test_the_codes_have_remedies():
    assert all(lookup(code).remedy for code in ("RBL617", "RBL618"))


# --- in the servo ----------------------------------------------------------------------------------------------------

Q = np.array([0.1, 1.2, -1.5, 0.2, 0.3, 0.4])
MOTION = np.stack([np.tile(Q + 1e-3, (8, 1)), np.full((8, 6), 0.2), np.full((8, 6), 1.5)])


def current(options):
    """Return the current of the first tick after a step of command, speed and acceleration, at posture ``Q``."""
    model = ArmModel(SPEC)
    M, servo = model.mass_matrix(Q), ServoAxes(SPEC, options, 1e-3, Q, np.zeros(6))
    servo.take(np.diag(M), np.zeros(6), MOTION, M if servo.coupled else None)
    servo.tick(0, Q)
    return M, servo


@pytest.mark.parametrize("coupling", ["diagonal", "full"])
def test_the_rotor_is_counted_once(coupling):
    """(9) and (10) with D' = D + N^2 Jc: the rotor is in Jc, and N^2 J is not added again."""
    options = ServoOptions(coupling=coupling, friction_compensation=0.0, rotors=tuple(FOUND.rotors(SPEC)))
    M, servo = current(options)
    D = M + np.diag(N2 * np.array([axis.compensation for axis in FOUND.axes]))
    D = np.diag(np.diag(D)) if coupling == "diagonal" else D
    g = gains(SPEC, options)
    domega = g.Kp * (Q + 1e-3 - servo.alpha) + 0.2
    np.testing.assert_allclose(servo.tau_cmd, D @ (g.Kv * domega) + D @ np.full(6, 1.5), rtol=1e-9)


@pytest.mark.parametrize("coupling", ["diagonal", "full"])
def test_the_compensation_of_a_perfect_model_changes_nothing(coupling):
    perfect = tuple(spec_rotors(SPEC))
    _, without = current(ServoOptions(coupling=coupling))
    _, with_it = current(ServoOptions(coupling=coupling, rotors=perfect))
    np.testing.assert_array_equal(without.tau_cmd, with_it.tau_cmd)
    np.testing.assert_array_equal(rotors(SPEC, ServoOptions()), spec_rotors(SPEC))
