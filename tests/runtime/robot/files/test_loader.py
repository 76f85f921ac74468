"""A robot file is refused before anything is built from it: code, line, and what would mend it."""

import math
import os
import re

import numpy as np
import pytest

from runtime.core.tomlfile import FileFault, Source, read_source
from runtime.robot.files.corrections import TOKEN_MASS
from runtime.robot.files.loader import inertia_matrix, load_builtin
from runtime.robot.files.robot_file import library
from runtime.robot.model.drives import RISE_S
from runtime.robot.model.spec import inertia_defect
from tests.messages import fields, numbers
from tests.robolang.cli.commands import PUMA
from tests.runtime.from_texts import parse_robot

TEXT = PUMA.read_text()
ELBOW = TEXT.index('name = "elbow"')


def refused(text):
    """The fault of a text; its line must hold what the fault speaks of."""
    with pytest.raises(FileFault) as caught:
        parse_robot(Source("r.toml", text))
    found = caught.value
    assert found.path == "r.toml"
    assert found.hint
    return found


def changed(old, new, start=0):
    """The Puma's text with the first ``old`` behind ``start`` replaced."""
    assert old in TEXT[start:]
    return TEXT[:start] + TEXT[start:].replace(old, new, 1)


def line_of(text, part, start=0):
    return text[: text.index(part, start)].count("\n") + 1


def test_every_robot_of_the_library_loads():
    assert library() == ["cobra600", "irb2400", "manutec_r3", "puma560", "ur10e", "ur5e"]
    for name in library():
        assert load_builtin(name).name == name
    assert load_builtin("puma560") is load_builtin("puma560")
    with pytest.raises(KeyError):
        load_builtin("puma")


def test_a_robot_file_gives_what_the_built_in_gives():
    ours, theirs = parse_robot(read_source(PUMA)), load_builtin("puma560")
    assert ours.n == theirs.n == 6
    for a, b in zip(ours.axes, theirs.axes, strict=True):
        assert (a.name, a.motor, a.limits, a.bandwidths) == (b.name, b.motor, b.limits, b.bandwidths)
        assert np.array_equal(a.placement, b.placement)
        assert np.array_equal(a.body.inertia, b.body.inertia)


NUMBERS = [
    ("gear_ratio = -53.7063", "gear_ratio = 0", "RBL605", "axes.3.motor.gear_ratio 0"),
    ("gear_ratio = -53.7063", "gear_ratio = -1e-4", "RBL605", ""),
    ("gear_ratio = -53.7063", "gear_ratio = nan", "RBL604", ""),
    ("torque_constant_nm_a = 0.228", "torque_constant_nm_a = inf", "RBL604", "axes.3.motor.torque_constant_nm_a"),
    ("max_current_a = 7.4", "max_current_a = 0", "RBL605", "0"),
    ("viscous_friction_nm_s = 1.38e-3", "viscous_friction_nm_s = -1", "RBL605", "0"),
    ("coulomb_friction_nm = [0.132, 0.105]", "coulomb_friction_nm = [0.132]", "RBL613", "2"),
    ("encoder_counts = 131072", "encoder_counts = 1.5e3000", "RBL604", ""),
    ("encoder_counts = 131072", "encoder_counts = 0x" + "F" * 5000, "RBL604", "20000"),
    ("range_deg = [-225, 45]", "range_deg = [45, -225]", "RBL607", "axes.3.range_deg 45 -225"),
    ("range_deg = [-225, 45]", "range_deg = [45, 45]", "RBL607", "45"),
    ("range_deg = [-225, 45]", "range_deg = [nan, 45]", "RBL604", "axes.3.range_deg"),
    ("max_speed_deg_s = 176.0", "max_speed_deg_s = -176.0", "RBL605", "axes.3.max_speed_deg_s"),
    ("range_deg = [-225, 45]", "max_jerk_deg_s3 = 0\nrange_deg = [-225, 45]", "RBL605", "axes.3.max_jerk_deg_s3"),
    ("range_deg = [-225, 45]", "max_jerk_deg_s3 = nan\nrange_deg = [-225, 45]", "RBL604", "axes.3.max_jerk_deg_s3"),
    ("range_deg = [-225, 45]", "max_jerk_deg_s2 = 9\nrange_deg = [-225, 45]", "RBL609", "axes.3.max_jerk_deg_s2"),
    ("mass_kg = 4.8", "mass_kg = -4.8", "RBL605", "axes.3.mass_kg"),
    ("mass_kg = 4.8", "mass_kg = 0", "RBL606", "J3"),
    ("mass_kg = 4.8", 'mass_kg = "4.8"', "RBL613", ""),
    ("cog_m = [-0.0203, -0.0141, 0.070]", "cog_m = [-20.3, -14.1, 70]", "RBL605", "axes.3.cog_m -20.3"),
    ("inertia_kg_m2 = [0.066, 0.086, 0.0125]", "inertia_kg_m2 = [1, 1]", "RBL613", ""),
    ("velocity_bandwidth_rad_s = 120", "velocity_bandwidth_rad_s = 9e3", "RBL605", "0 8000"),
    ("velocity_bandwidth_rad_s = 120", "velocity_bandwidth_rad_s = 0", "RBL605", "0 8000"),
    ('name = "elbow"', 'name = "shoulder"', "RBL610", "shoulder"),
    ("added_mass_kg = 0.0", "added_mass_kg = 0.1", "RBL606", "J3"),
    ("inertia_shift_kg_m2 = 0.00375", "inertia_shift_kg_m2 = 0.0038", "RBL606", "0.00375 J3"),
    ("inertia_shift_kg_m2 = 0.00375", "inertia_shift_kg_m2 = 0", "RBL606", "J3"),
    ("inertia_shift_kg_m2 = 0.00375", "inertia_shift_kg_m2 = 0.003", "RBL606", "J3"),
]


@pytest.mark.parametrize(("old", "new", "code", "said"), NUMBERS, ids=[f"{c[2]} {c[1][:40]}" for c in NUMBERS])
def test_a_wrong_value_is_refused_at_its_line(old, new, code, said):
    text = changed(old, new, ELBOW)
    found = refused(text)
    assert found.code == code
    assert set(said.split()) <= fields(found.message)
    shifts = {"inertia_shift_kg_m2 = 0": "[axes.correction]", "inertia_shift_kg_m2 = 0.003": "inertia_kg_m2"}
    assert found.line == line_of(text, shifts.get(new, new.split(" ")[0]), ELBOW)
    assert len(found.message) < 200


def test_a_jerk_limit_that_no_file_states_is_an_estimate_from_the_acceleration():
    plain = parse_robot(Source("p.toml", TEXT))
    rise = plain.per_axis("limits", "acceleration") / plain.per_axis("limits", "jerk")
    assert rise == pytest.approx([RISE_S] * 6, rel=1e-15)
    jerks = {f"axes.{k}.max_jerk_deg_s3" for k in range(1, 7)}
    assert jerks <= set(plain.estimated)
    text = changed("range_deg = [-225, 45]", "max_jerk_deg_s3 = 5400\nrange_deg = [-225, 45]")
    stated = parse_robot(Source("p.toml", text))
    assert stated.axes[2].limits.jerk == math.radians(5400)
    assert jerks - set(stated.estimated) == {"axes.3.max_jerk_deg_s3"}


REQUIRED = sorted(set(re.findall(r"^(\w+) =", TEXT[ELBOW:], re.M)))
"""Every key that an axis has; ``theta_offset_deg`` is the only one with a default."""


@pytest.mark.parametrize("key", REQUIRED)
def test_nothing_is_guessed_when_a_key_of_an_axis_is_missing(key):
    line = re.compile(rf"^{key} = .*\n", re.M).search(TEXT, ELBOW)
    text = TEXT[: line.start()] + TEXT[line.end() :]
    found = refused(text)
    assert found.code == "RBL608"
    assert re.search(rf"'axes\.3\.(\w+\.)?{key}'", found.message)
    assert found.excerpt.startswith("[")


@pytest.mark.parametrize(
    "key", ["schema", "name", "title", "rated_payload_kg", "form", "a1_m", "signs", "max_speed_mm_s"]
)
def test_nothing_is_guessed_when_a_key_of_the_robot_is_missing(key):
    found = refused(re.sub(rf"^{key} = .*\n", "", TEXT, count=1, flags=re.M))
    assert found.code == "RBL608"
    assert key in found.message


@pytest.mark.parametrize(
    ("new", "near"),
    [
        ("max_torque_nm = 89.4\nmax_torque = 1", "max_torque_nm"),
        ("max_torque_nm = 89.4\nplacement = 1", ""),
        ("max_torque_nm = 89.4\ntheta_offset = 1", "theta_offset_deg"),
    ],
)
def test_a_key_that_nobody_reads_is_refused(new, near):
    text = changed("max_torque_nm = 89.4", new, ELBOW)
    found = refused(text)
    assert found.code == "RBL609"
    assert found.line == line_of(text, new.split("\n")[1])
    assert near in found.hint
    assert bool(near) == (len(fields(found.hint)) == 1)


def test_the_number_of_axes_is_1_to_7():
    axis = TEXT[TEXT.rindex("[[axes]]") :]
    found = refused(TEXT + "".join(axis.replace('"flange"', f'"{k}"') for k in "ab"))
    assert (found.code, numbers(found.message)) == ("RBL605", [1, 7, 8])
    assert refused(TEXT[: TEXT.index("[[axes]]")]).code == "RBL608"


def test_seven_axes_without_a_closed_form_are_a_robot():
    start, end = TEXT.index("[kinematics.opw]"), TEXT.index("[path]")
    text = TEXT[:start] + TEXT[end:]
    seven = text + "\n" + text[text.rindex("[[axes]]") :].replace('"flange"', '"extra"')
    assert parse_robot(Source("r.toml", seven)).n == 7
    assert refused(TEXT + "\n" + TEXT[TEXT.rindex("[[axes]]") :].replace('"flange"', '"extra"')).code == "RBL615"


def test_all_links_have_a_radius_or_none():
    assert parse_robot(Source("r.toml", TEXT)).link_radii == pytest.approx([0.06] * 3 + [0.04] * 3)
    without = TEXT.replace('"axes.*.link_radius_mm", ', "")
    assert parse_robot(Source("r.toml", re.sub("link_radius_mm.*", "", without))).link_radii == ()
    assert refused(TEXT.replace("link_radius_mm = 60", "", 1)).code == "RBL608"
    assert refused(TEXT.replace("link_radius_mm = 60", "link_radius_mm = 0", 1)).code == "RBL605"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("b_m = -0.15005", "b_m = 0.15005"),
        ("a2_m = 0.0203", "a2_m = 0.0204"),
        ("offsets_deg = [0, 90", "offsets_deg = [0, -90"),
        ("signs = [1, -1, -1, 1", "signs = [1, -1, -1, -1"),
    ],
)
def test_a_closed_form_of_another_arm_is_refused(old, new):
    text = changed(old, new)
    found = refused(text)
    assert found.code == "RBL615"
    assert re.search(r"\b\d+\.\d+ mm", found.message)
    assert found.line == line_of(text, "[kinematics]")


@pytest.mark.parametrize(("old", "new"), [("schema = 1", "schema = 2"), ('form = "dh"', 'form = "urdf"')])
def test_another_schema_or_form_is_refused(old, new):
    found = refused(changed(old, new))
    assert found.line == line_of(changed(old, new), new)


# inertia ------------------------------------------------------------------------------------------------------------


def body(inertia, mass="4.8"):
    """The Puma with another elbow and no correction of it."""
    text = changed("inertia_kg_m2 = [0.066, 0.086, 0.0125]", f"inertia_kg_m2 = {inertia}", ELBOW)
    text = text.replace("mass_kg = 4.8", f"mass_kg = {mass}", 1)
    start = text.index("[axes.correction]", ELBOW)
    return text[:start] + text[text.index("[axes.motor]", start) :], start


@pytest.mark.parametrize(
    ("inertia", "shift"),
    [
        ([0.066, 0.086, 0.0125], "0.00375"),  # the Puma's own: half of what is missing
        ([0.01, 0.123456789, 0.02], "0.0467283945"),
        ([-0.01, 0.05, 0.02], "0.02"),  # a negative moment, and a triangle that needs more
        ([-0.01, 0.002, -0.008], "0.01"),  # two negative moments
        ([0.066, 0.086, 0.0125, 0.0, 0.0, 0.001], None),
    ],
)
def test_the_correction_named_in_the_help_is_the_one_that_works(inertia, shift):
    """What the help says is copied into the file: then it loads. A little less does not, a little more does not."""
    text, start = body(inertia)
    found = refused(text)
    assert found.code == "RBL606"
    assert found.line == line_of(text, "inertia_kg_m2", ELBOW)
    named, point = re.search(r"inertia_shift_kg_m2 = (\S+), added_mass_kg = 0(.*) and a reason", found.hint).groups()
    assert shift is None or named == shift

    def corrected(value):
        lines = f'[axes.correction]\ninertia_shift_kg_m2 = {value}\nadded_mass_kg = 0\nreason = "r"\n'
        return text[:start] + lines + point.removeprefix(", ") + "\n" + text[start:]

    spec = parse_robot(Source("r.toml", corrected(named)))
    assert inertia_defect(spec.axes[2].body.inertia) < 1e-9
    small, large = (refused(corrected(float(named) + step)).message for step in (-1e-6, 1e-6))
    assert str(float(named) + 1e-6)[:6] in large or "larger" in large
    assert "larger" not in small


@pytest.mark.parametrize("inertia", [[0.5, 0.01, 0.01], [0.01, -0.5, 0.01], [0.0, 0.0, 1.0]])
def test_an_inertia_that_no_shift_mends_says_so(inertia):
    """Axis 2 of the file is z of the joint here: about the others a shift adds to two moments alike."""
    found = refused(body(inertia)[0])
    assert found.code == "RBL606"
    assert "inertia_shift_kg_m2" not in found.hint


def test_a_body_without_mass_is_given_a_token_of_one_and_no_more():
    text, start = body([0.066, 0.07, 0.0125], mass="0")
    found = refused(text)
    assert f"[axes.correction] with added_mass_kg = {TOKEN_MASS:g}" in found.hint

    def corrected(mass):
        lines = f'[axes.correction]\ninertia_shift_kg_m2 = 0\nadded_mass_kg = {mass}\nreason = "r"\n'
        return text[:start] + lines + text[start:]

    assert parse_robot(Source("r.toml", corrected(TOKEN_MASS))).axes[2].body.mass == TOKEN_MASS
    found = refused(corrected(2e-6))
    assert found.code == "RBL606"
    assert "1e-06" in fields(found.message)


def test_a_correction_that_nothing_needs_is_refused():
    text, start = body([0.066, 0.07, 0.0125])
    for shift in (0, 1e-6):
        lines = f'[axes.correction]\ninertia_shift_kg_m2 = {shift}\nadded_mass_kg = 0\nreason = "r"\n'
        found = refused(text[:start] + lines + text[start:])
        assert found.code == "RBL606"
        assert "needs" in found.message


def test_the_products_of_inertia_are_the_matrix_entries():
    assert inertia_matrix((1, 2, 3, 4, 5, 6)).tolist() == [[1, 4, 5], [4, 2, 6], [5, 6, 3]]
    assert inertia_matrix((1, 2, 3)).tolist() == [[1, 0, 0], [0, 2, 0], [0, 0, 3]]


# files --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda path: None, "RBL600"),
        (lambda path: path.mkdir(), "RBL600"),
        (os.mkfifo, "RBL600"),
        (lambda path: path.write_bytes(TEXT.encode("utf-16")), "RBL600"),
        (lambda path: path.write_bytes(TEXT.encode() + b"# \xff"), "RBL600"),
        (lambda path: path.write_bytes(TEXT.encode() + b"#" * 1_000_000), "RBL600"),
        (lambda path: path.write_bytes(b""), "RBL608"),
        (lambda path: path.write_bytes(os.urandom(4000)), "RBL600"),
    ],
    ids=["missing", "folder", "pipe", "UTF-16", "not UTF-8", "huge", "empty", "random"],
)
def test_a_file_that_is_none(tmp_path, make, code):
    make(tmp_path / "r.toml")
    with pytest.raises(FileFault) as caught:
        parse_robot(read_source(tmp_path / "r.toml"))
    assert (caught.value.code, caught.value.path) == (code, str(tmp_path / "r.toml"))


@pytest.mark.parametrize("size", range(0, TEXT.rindex("position_bandwidth"), 211))
def test_a_file_cut_off_anywhere_is_refused(size):
    """Never a trace, never a robot: what is left lacks a key, an axis or a bracket."""
    assert refused(TEXT[:size]).code in ("RBL601", "RBL608", "RBL615")
