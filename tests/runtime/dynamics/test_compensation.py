"""The compensation file, and the servo that uses it: the rotor counts once."""

import re
from dataclasses import replace

import numpy as np
import pytest

from runtime.dynamics.compensation import AxisCompensation, Compensation, as_toml, load_compensation
from runtime.faults import lookup
from runtime.profile import ServoOptions
from runtime.robot.loader import load_builtin
from runtime.robot.model import ArmModel, spec_rotors
from runtime.robot.payload import Payload
from runtime.servo.axes import ServoAxes, gains, rotors
from runtime.tomlfile import FileFault

SPEC = load_builtin("puma560")
N2 = SPEC.per_axis("motor", "gear_ratio") ** 2
FOUND = Compensation(
    robot="puma560",
    date="2026-11-24",
    positions=5,
    payload=Payload(mass=0.8, cog=np.array([0.0, 0.01, 0.06])),
    axes=(
        AxisCompensation(compensation=3.1529473526410994e-04, spread=2.3e-8, model=7.3e-4, identified=1.05e-3),
        *(AxisCompensation(compensation=2.2e-4 / k, spread=0.0, model=1e-4, identified=3e-4) for k in (1, 3)),
        *(AxisCompensation(compensation=axis.motor.rotor_inertia) for axis in SPEC.axes[3:]),
    ),
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
