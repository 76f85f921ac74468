"""An axis that slides in a robot file: its keys, its units, and what is refused."""

import math

import pytest

from runtime.core.tomlfile import FileFault, Source
from runtime.core.units import MM
from runtime.robot.files import loader, robot_file
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.axis_kind import PRISMATIC
from tests.messages import fields

TEXT = (robot_file._LIBRARY / "cobra600.toml").read_text()


def fault(old: str, new: str) -> FileFault:
    assert TEXT.count(old) == 1
    text = TEXT.replace(old, new)
    with pytest.raises(FileFault) as caught:
        loader.build(robot_file.parse(Source("r.toml", text)))
    return caught.value


def test_values_are_si():
    axis = load_builtin("cobra600").axes[2]
    assert axis.kind is PRISMATIC
    limits, motor = axis.limits, axis.motor
    assert (limits.lower, limits.upper, limits.speed) == pytest.approx((0.0, 0.21, 1.1))
    assert (limits.acceleration, limits.jerk, limits.torque) == pytest.approx((10.0, 100.0, 343.0))
    # 20 mm a turn; a rotor of 1e-5 kg m2 is (2 pi / 0.02)^2 1e-5 kg at the screw
    assert motor.gear_ratio == pytest.approx(2.0 * math.pi / 0.02)
    assert motor.reflected_inertia == pytest.approx((2.0 * math.pi / 0.02) ** 2 * 1e-5)
    assert motor.joint_torque_constant == pytest.approx(0.18 * 2.0 * math.pi / 0.02)


def test_a_bound_in_degrees_holds_as_so_many_mm():
    spec = load_builtin("cobra600")
    assert spec.bound(math.radians(1.5)) == pytest.approx([math.radians(1.5)] * 2 + [1.5 * MM, math.radians(1.5)])
    assert (load_builtin("puma560").bound(0.1) == 0.1).all()


@pytest.mark.parametrize(
    ("old", "new", "code", "named"),
    [
        ("range_mm = [0, 210]", "range_deg = [0, 210]", "RBL608", "range_mm"),
        ("range_mm = [0, 210]", "range_mm = [210, 0]", "RBL607", "range_mm"),
        ("range_mm = [0, 210]", "range_mm = [0, 21000]", "RBL605", "range_mm"),
        ("max_force_n = 343", "max_torque_nm = 343", "RBL608", "max_force_n"),
        ("max_force_n = 343", "max_force_n = 343\nmax_jerk_deg_s3 = 9", "RBL609", "max_jerk_deg_s3"),
        ("travel_mm_per_turn = 20", "gear_ratio = 20", "RBL608", "travel_mm_per_turn"),
        ("travel_mm_per_turn = 20", "travel_mm_per_turn = 0", "RBL605", "travel_mm_per_turn"),
        ("travel_mm_per_turn = 20", "travel_mm_per_turn = nan", "RBL604", "travel_mm_per_turn"),
        ('kind = "prismatic"', 'kind = "sliding"', "RBL610", "kind"),
        ('kind = "prismatic"', "", "RBL608", "gear_ratio"),
    ],
)
def test_keys_of_the_other_kind_are_refused(old, new, code, named):
    found = fault(old, new)
    assert found.code == code
    assert any(field.split(".")[-1] == named for field in fields(found.message))


def test_a_closed_form_needs_axes_that_turn():
    text = (robot_file._LIBRARY / "puma560.toml").read_text()
    slides = text.replace("range_deg = [-160, 160]", 'kind = "prismatic"\nrange_mm = [0, 100]')
    for old, new in (
        ("max_speed_deg_s = 151.0", "max_speed_mm_s = 151.0"),
        ("max_acceleration_deg_s2 = 600", "max_acceleration_mm_s2 = 600"),
        ("max_torque_nm = 97.6", "max_force_n = 97.6"),
        ("gear_ratio = -62.6111", "travel_mm_per_turn = 10"),
    ):
        assert slides.count(old) == 1
        slides = slides.replace(old, new)
    with pytest.raises(FileFault) as caught:
        robot_file.parse(Source("r.toml", slides))
    assert caught.value.code == "RBL615"
