import math

import pytest

from runtime.core.tomlfile import FileFault, Source, load_table
from runtime.core.units import DEG
from runtime.settings.layers import read_layer, settle
from runtime.settings.profile import Profile
from tests.messages import fields


def profile(text):
    table = load_table(Source("cell.toml", f"[controller]\n{text}\n")).table("controller")
    return settle(read_layer(table)).profile


def test_no_table_and_an_empty_one_give_the_defaults():
    assert settle(read_layer(None)).profile == profile("") == Profile()
    assert (Profile().ticks_per_cycle, Profile().tick_s, Profile().period_s) == (8, 0.001, 0.008)


def test_the_acceleration_is_a_share_or_max():
    assert profile("acceleration = 'max'").acceleration == math.inf
    codes = {}
    for value in ("0", "101", "nan", "'fast'", "'MAX'", "true"):
        with pytest.raises(FileFault) as caught:
            profile(f"acceleration = {value}")
        codes[value] = caught.value.code
    refused = {"0": "RBL605", "101": "RBL605", "nan": "RBL604", "'fast'": "RBL610", "'MAX'": "RBL610", "true": "RBL613"}
    assert codes == refused


@pytest.mark.parametrize(("period_ms", "ticks"), [("1", 8), ("0.5", 16), ("0.25", 32), ("1.0", 8)])
def test_the_servo_period_divides_the_cycle(period_ms, ticks):
    read = profile(f"servo_period_ms = {period_ms}")
    assert read.ticks_per_cycle == ticks
    assert read.tick_us * ticks == read.period_us == 8000


def test_every_key_is_read_in_the_unit_of_its_name():
    read = profile(
        "interpolation_cost_ms = 2.5\ndynamics_cost_per_axis_ms = 0.5\nload_mode = 'replace'\n"
        "speed_shape = 'trapezoid'\nacceleration = 40\n"
        "in_position_deg = 0.1\nsettle_timeout_s = 1.5\n[controller.servo]\nmode = 'fixed'\nfeedforward = 'measured'\n"
        "velocity_feedforward = 0.9\nacceleration_feedforward = 0.8\nspring_compensation = 0.1\n"
        "gravity_compensation = 0.5\nfriction_compensation = 0"
    )
    assert (read.interpolation_cost_us, read.axis_cost_us) == (2500, 500)
    assert (read.load_mode, read.speed_shape, read.acceleration) == ("replace", "trapezoid", 0.4)
    assert (read.in_position, read.settle_timeout_us) == (0.1 * DEG, 1_500_000)
    servo = read.servo
    assert (servo.mode, servo.source) == ("fixed", "measured")
    assert (servo.velocity_feedforward, servo.acceleration_feedforward, servo.spring_compensation) == (0.9, 0.8, 0.1)
    assert (servo.gravity_compensation, servo.friction_compensation) == (0.5, 0.0)


def test_measured_feedforward_is_off_until_it_is_asked_for():
    servo = profile("[controller.servo]\nfeedforward = 'measured'").servo
    assert (servo.velocity_feedforward, servo.acceleration_feedforward) == (0.0, 0.0)


BAD = [
    ("servo_period_ms = 2", "RBL605", "0.25 0.5 1"),
    ("servo_period_ms = 0", "RBL605", "0"),
    ("servo_period_ms = nan", "RBL604", ""),
    ("servo_period_ms = '1'", "RBL613", ""),
    ("interpolation_cost_ms = -1", "RBL605", "0 80"),
    ("dynamics_cost_per_axis_ms = 0", "RBL605", "0.001 1000"),
    ("in_position_deg = inf", "RBL604", ""),
    ("settle_timeout_s = 61", "RBL605", "0 60"),
    ("load_mode = 'ad'", "RBL610", ""),
    ("speed_shape = 'cubic'", "RBL610", ""),
    ("servo = 1", "RBL613", ""),
    ("servo_period = 1", "RBL609", ""),
    ("[controller.servo]\nmode = 'schedule'", "RBL610", ""),
    ("[controller.servo]\ngain = 1", "RBL609", "controller.servo.gain"),
    ("[controller.servo]\nvelocity_feedforward = 1.1", "RBL605", "0 1"),
    ("[controller.servo]\nfeedforward = 'measured'\nvelocity_feedforward = 1", "RBL616", "1"),
    ("[controller.servo]\nfeedforward = 'measured'\nacceleration_feedforward = 1.0", "RBL616", "1"),
]


@pytest.mark.parametrize(("text", "code", "said"), BAD, ids=[case[0].split("\n")[-1] for case in BAD])
def test_a_bad_profile_is_refused_at_its_line(text, code, said):
    with pytest.raises(FileFault) as caught:
        profile(text)
    found = caught.value
    assert (found.code, found.line, found.column) == (code, 2 + text.count("\n"), 1)
    assert set(said.split()) <= fields(found.message)
    assert found.hint


def test_the_help_for_unstable_feedforward_mends_it():
    with pytest.raises(FileFault) as caught:
        profile("[controller.servo]\nfeedforward = 'measured'\nvelocity_feedforward = 1")
    assert "0.9" in fields(caught.value.hint)
    profile("[controller.servo]\nfeedforward = 'measured'\nvelocity_feedforward = 0.9")


def test_defaults_follow_the_mode_and_the_source_of_derivatives():
    assert (profile("").servo.coupling, profile("").servo.spring_compensation) == ("full", 1.0)
    assert profile("[controller.servo]\nmode = 'fixed'\n").servo.coupling == "diagonal"
    measured = profile("[controller.servo]\nfeedforward = 'measured'\n").servo
    assert (measured.spring_compensation, measured.gravity_lead) == (0.0, 1.0)
