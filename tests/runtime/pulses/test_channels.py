"""Channel files: what they say, what they may leave out, and what is refused at its line."""

import numpy as np
import pytest

from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG, MM
from runtime.pulses.channels import MAX_HZ, MIN_HZ, channels_of, default_channels, motor_pulse, read_channel_file
from runtime.pulses.mechanism import load_builtin
from tests.messages import fields

MACHINE = load_builtin("cylindrical")
TEXT = """\
schema = 1
mechanism = "cylindrical"

[[channels]]
joint = "r"
pulse_mm = 0.01
min_hz = 48
max_hz = 20000
output = "cw-ccw"

[[channels]]
joint = "theta"

[[channels]]
joint = "z"
"""


def read(tmp_path, text=TEXT, min_hz=None):
    path = tmp_path / "f.toml"
    path.write_text(text, "utf-8")
    return channels_of(read_channel_file(path), MACHINE.joints, MACHINE.pulse, MACHINE.name, min_hz)


def test_a_file_gives_channels_in_the_order_of_the_joints(tmp_path):
    theta, r, z = read(tmp_path)
    assert [each.joint.name for each in (theta, r, z)] == ["theta", "r", "z"]
    assert (theta.pulse, theta.min_hz, theta.max_hz, theta.output) == (
        pytest.approx(0.0036 * DEG),
        MIN_HZ,
        MAX_HZ,
        "pulse-direction",
    )
    assert (r.pulse, r.min_hz, r.max_hz, r.output) == (pytest.approx(0.01 * MM), 48.0, 20000.0, "cw-ccw")
    assert (r.unit, theta.unit) == (("mm", MM), ("deg", DEG))


def test_the_option_goes_over_the_file(tmp_path):
    assert [each.min_hz for each in read(tmp_path, min_hz=500.0)] == [500.0] * 3


def test_without_a_file_the_mechanism_says_the_pulses():
    channels = default_channels(MACHINE.joints, MACHINE.pulse, None)
    assert [each.pulse for each in channels] == list(MACHINE.pulse)
    assert motor_pulse(-100.0) == pytest.approx(2.0 * np.pi / 200_000)


@pytest.mark.parametrize(
    ("before", "after", "code", "says", "line"),
    [
        ('[[channels]]\njoint = "z"\n', "", "RBL608", "z", 11),
        ('joint = "z"', 'joint = "r"', "RBL610", "", 15),
        ('joint = "z"', 'joint = "w"', "RBL610", "", 15),
        ("pulse_mm = 0.01", "pulse_deg = 0.01", "RBL613", "pulse_mm", 6),
        ("pulse_mm = 0.01", "pulse_mm = 0", "RBL605", "channels.1.pulse_mm", 6),
        ("pulse_mm = 0.01", "pulse_mm = nan", "RBL604", "", 6),
        ("max_hz = 20000", "max_hz = 60", "RBL605", "96 min_hz", 8),
        ('output = "cw-ccw"', 'output = "up"', "RBL610", "", 9),
        ("min_hz = 48", "minimum = 48", "RBL609", "", 7),
        ("schema = 1", "schema = 3", "RBL605", "", 1),
        ('mechanism = "cylindrical"', "mechanism = 1", "RBL613", "", 2),
    ],
)
def test_what_is_wrong_is_refused_at_its_line(tmp_path, before, after, code, says, line):
    assert before in TEXT
    with pytest.raises(FileFault) as caught:
        read(tmp_path, TEXT.replace(before, after, 1))
    assert caught.value.code == code
    assert set(says.split()) <= fields(caught.value.message)
    assert caught.value.line == line


def test_a_mechanism_file_stands_beside_its_channels(tmp_path):
    path = tmp_path / "f.toml"
    path.write_text(TEXT.replace('"cylindrical"', '"../m.toml"'), "utf-8")
    with pytest.raises(FileFault) as caught:
        read_channel_file(path).mechanism_path()
    assert caught.value.code == "RBL602"
