"""Values that are possible and unlikely are doubted, once each and at their place; values of built arms are not."""

import math
import re

import numpy as np
import pytest

from runtime.core.numerals import number_in
from runtime.core.tomlfile import FileFault, Source
from runtime.robot.files.importer import load_file, parse_model, read_arm, read_model
from runtime.robot.files.loader import load_builtin
from runtime.robot.files.plausibility import LEAST_ANGLE, MOST_TURNS, Moving, doubt_moving
from runtime.robot.files.robot_file import library
from runtime.robot.files.sidecar import template
from runtime.robot.files.sidecar_file import read_overlay
from tests.messages import fields
from tests.runtime.from_texts import parse_robot
from tests.runtime.robot.files.test_loader import TEXT as PUMA
from tests.runtime.robot.models import ANGLES, SEVEN, chain, fill, inertial

FRAMES = [((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.4), (0, 0, 0), (0, 1, 0)), ((0, 0, 0.4), (0, 0, 0), (0, 1, 0))]
TIP = ((0, 0, 0.2), (0, 0, 0))


def written(tmp_path, text, name="a.urdf"):
    path = tmp_path / name
    path.write_text(text)
    return path


def codes(warnings):
    return [fault.code for fault in warnings]


@pytest.mark.parametrize("name", library())
def test_built_arms_are_not_doubted(name):
    assert load_builtin(name).warnings == ()


def test_nor_are_the_arms_of_the_tests():
    assert read_model(SEVEN).warnings == ()
    assert read_model(ANGLES).warnings == ()


@pytest.mark.parametrize(
    ("expected", "limit", "bodies", "named"),
    [
        ("RBL627", 'lower="-170" upper="170"', None, ""),
        ("RBL627", 'lower="-0.05" upper="0.05"', None, ""),
        ("RBL627", 'lower="-3" upper="3" velocity="150"', None, "deg/s"),
        ("RBL629", 'lower="-3" upper="3" effort="50000"', None, "N"),
        ("RBL628", None, {"cog": (50, 0, 0)}, None),
        ("RBL628", None, {"cog": (3, 0, 0)}, ""),
        ("RBL629", None, {"mass": 2.0, "inertia": (3e4, 4e4, 2e4, 0, 0, 0)}, "mm2"),
        ("RBL629", None, {"mass": 2000.0}, ""),
        ("RBL629", None, {"mass": 2.0, "inertia": (3e-5, 3e-5, 3e-5, 0, 0, 0)}, ""),
    ],
)
def test_what_looks_like_another_unit_is_doubted(tmp_path, expected, limit, bodies, named):
    text = chain(FRAMES, TIP, bodies and [inertial(**bodies)] * 3, limit or 'lower="-3" upper="3"')
    if named is None:
        with pytest.raises(FileFault, match="RBL605"):
            read_model(written(tmp_path, text))
        return
    first, *_ = [fault for fault in read_model(written(tmp_path, text)).warnings if fault.code == expected]
    assert set(named.split()) <= fields(first.message)
    assert all(f"J{axis} j{axis} " in first.message for axis in (1, 2, 3))  # one warning for all of them
    assert first.line > 1


@pytest.mark.parametrize(
    ("frame", "expected"),
    [((0, 0, 300), "RBL605"), ((0, 0, 9.0), "RBL628"), ((0, 0, 0.4), None)],
)
def test_lengths_in_mm_are_refused_or_doubted(tmp_path, frame, expected):
    path = written(tmp_path, chain([FRAMES[0], (frame, (0, 0, 0), (0, 1, 0)), FRAMES[2]], TIP))
    if expected == "RBL605":
        with pytest.raises(FileFault, match=r"RBL605 .*\bmm\b"):
            read_model(path)
    else:
        assert codes(read_model(path).warnings) == ([expected] if expected else [])


def test_joints_in_one_place_and_axes_that_are_no_unit_vectors(tmp_path):
    nowhere = [((0, 0, 0), (0, 0, 0), axis) for _, _, axis in FRAMES]
    assert codes(read_model(written(tmp_path, chain(nowhere))).warnings) == ["RBL628"]
    long = chain([*FRAMES[:2], ((0, 0, 0.4), (0, 0, 0), (0, 2, 0))], TIP)
    (doubt,) = read_model(written(tmp_path, long)).warnings
    assert (doubt.code, doubt.excerpt[doubt.column - 1 :][:5]) == ("RBL628", "<axis")


def test_an_mjcf_of_degrees_with_radians_in_it():
    text = re.sub(r'range="[^"]*"', 'range="-2.9 2.9"', ANGLES.read_text())
    (doubt,) = with_limits(text)
    assert doubt.code == "RBL627"
    assert "radians" in doubt.message
    assert with_limits(text.replace('angle="degree"', 'angle="radian"')) == ()


def with_limits(text):
    from runtime.robot.files.importer import _with_limits_doubted
    from runtime.robot.files.sidecar_file import NO_OVERLAY

    return _with_limits_doubted(parse_model(Source("a.xml", text)), NO_OVERLAY).warnings


@pytest.mark.parametrize(
    ("old", "new", "code", "key"),
    [
        ("range_deg = [-160, 160]", "range_deg = [-1600, 1600]", "RBL627", "range_deg"),
        ("range_deg = [-160, 160]", "range_deg = [-2.79, 2.79]", "RBL627", "range_deg"),
        ("max_speed_deg_s = 151", "max_speed_deg_s = 2.6 #", "RBL627", "max_speed_deg_s"),
        ("max_speed_deg_s = 151", "max_speed_deg_s = 9000 #", "RBL627", "max_speed_deg_s"),
        # 1000 rad/s3 written as they are
        ("max_speed_deg_s = 151", "max_jerk_deg_s3 = 105\nmax_speed_deg_s = 151", "RBL627", "max_jerk_deg_s3"),
        ("gear_ratio = -62.6111", "gear_ratio = -0.016", "RBL629", "gear_ratio"),
        ("mass_kg = 17.4", "mass_kg = 8700", "RBL629", "mass_kg"),
    ],
)
def test_a_robot_file_in_toml_is_doubted_at_the_key(old, new, code, key):
    assert old in PUMA
    doubts = parse_robot(Source("p.toml", PUMA.replace(old, new, 1))).warnings
    assert codes(doubts)[0] == code
    assert doubts[0].excerpt[doubts[0].column - 1 :].startswith(key)


def test_an_arm_heavier_than_its_size_is_doubted(tmp_path):
    heavy = [inertial(mass=1000.0, inertia=(30.0, 30.0, 30.0, 0, 0, 0))] * 3  # as large and dense as bodies are
    (doubt,) = read_model(written(tmp_path, chain(FRAMES, TIP, heavy))).warnings
    assert doubt.code == "RBL629"
    assert "3000 kg" in doubt.message


def test_mm_in_a_robot_file_are_named():
    with pytest.raises(FileFault, match="RBL605") as caught:
        parse_robot(Source("p.toml", PUMA.replace("a_m = 0.4318", "a_m = 431.8", 1)))
    assert "0.4318" in caught.value.hint


def test_a_sidecar_is_doubted_where_it_rules(tmp_path):
    degrees = SEVEN.read_text().replace('lower="-2.967060" upper="2.967060"', 'lower="-170" upper="170"', 1)
    path = written(tmp_path, degrees, "seven.urdf")
    assert codes(read_model(path).warnings) == ["RBL627"]
    text = template(read_model(path))
    assert "# range_deg =   # MISSING" in text  # what could not be read back is not written
    sidecar = written(tmp_path, fill(text), "seven.robot.toml")
    assert load_file(path).warnings == read_arm(path).warnings == ()
    sidecar.write_text(fill(text).replace("gear_ratio = 100", "gear_ratio = 0.01", 1))
    (doubt,) = load_file(path).warnings
    assert (doubt.code, doubt.path) == ("RBL629", str(sidecar))
    sidecar.write_text(fill(text, range_deg="[-900, 900]"))
    for doubts in (load_file(path).warnings, read_arm(path).warnings):
        assert [(fault.code, fault.path) for fault in doubts] == [("RBL627", str(sidecar))]


@pytest.mark.parametrize(
    ("typed", "shown"),
    [
        ("3.2288591161895", "185.0"),
        ("-3.141592653589793", "-180.0"),
        ("-2.967060", "-170.000015"),
        ("1.2", "68.7549"),
        ("0.0", "0.0"),
        ("-170", "MISSING"),
    ],
)
def test_a_range_is_written_as_it_was_typed_and_read_back_the_same(tmp_path, typed, shown):
    low, high = sorted((typed, "0.5"), key=float)
    path = written(tmp_path, chain(FRAMES, TIP, limit=f'lower="{low}" upper="{high}"'))
    arm = read_model(path)
    text = template(arm)
    line = next(line for line in text.splitlines() if "range_deg" in line)
    assert shown in line
    if "MISSING" not in line:
        overlay = read_overlay(Source("a.robot.toml", text))
        assert list(overlay.ranges) == ["j1", "j2", "j3"]
        for name, (lower, upper) in overlay.ranges.items():
            index = int(name[1:]) - 1
            assert (lower, upper) == pytest.approx((arm.lower[index], arm.upper[index]), abs=2e-11)


@pytest.mark.parametrize("lower", [math.nan, -3.0, -MOST_TURNS, -LEAST_ANGLE * 1.001])
def test_what_is_not_known_or_at_the_bound_is_not_doubted(lower):
    joint = Moving(label="J1", lower=lower, upper=LEAST_ANGLE, speed=math.nan, in_units=False)
    assert doubt_moving([joint], lambda what, axis: lambda *_: pytest.fail("it was doubted")) == []


@pytest.mark.parametrize("text", ["1", "-1.5", "+.5", "1.", "1e3", "2E-3", "nan", "-inf", "INF"])
def test_a_number_is_what_xml_takes_for_one(text):
    np.testing.assert_equal(number_in(text), float(text))


@pytest.mark.parametrize(
    "text", ["", " 1", "1_000", "\u0661", "1\u0660", "0x10", "1,5", "1e", ".", "infinit", "\u00b2", "--1"]
)
def test_what_others_do_not_read_is_none(text):
    assert number_in(text) is None


@pytest.mark.parametrize(
    ("new", "code"),
    [
        ('value="\u0662"', "RBL613"),
        ('value="2_0"', "RBL613"),
        ('value="2\u00a0"', "RBL613"),
        ('value="0x2"', "RBL613"),
        ('value="2,0"', "RBL613"),
        ('value="inf"', "RBL604"),
        ('value=" 2.0 "', None),
    ],
)
def test_numbers_of_a_model_file_are_read_as_others_read_them(new, code):
    text = chain(FRAMES, TIP).replace('value="2.0"', new, 1)
    if code is None:
        assert parse_model(Source("a.urdf", text)).axes[0].body.mass == 2.0
        return
    with pytest.raises(FileFault) as caught:
        parse_model(Source("a.urdf", text))
    assert caught.value.code == code
