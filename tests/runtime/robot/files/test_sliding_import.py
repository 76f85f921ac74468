"""Axes that slide in URDF and MJCF files: Pinocchio's and MuJoCo's own readers are the judges."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.tomlfile import FileFault, Source
from runtime.core.units import DEG, MM
from runtime.robot.files.arm_file import read_arm_file
from runtime.robot.files.estimate import estimate
from runtime.robot.files.importer import load_file, parse_model, read_arm, read_model
from runtime.robot.files.known import known_of
from runtime.robot.files.loader import load_builtin
from runtime.robot.files.sidecar import template
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE
from tests.messages import fields
from tests.runtime.robot.files.estimates import known
from tests.runtime.robot.files.test_importer import mujoco_says, pinocchio_says, refused, same
from tests.runtime.robot.models import DATA, SIX, fill, inertial, joint, urdf

SCARA, GANTRY = DATA / "scara.urdf", DATA / "gantry.xml"
TEXT, MJCF = SCARA.read_text(), GANTRY.read_text()
STROKE = 'lower="-2" upper="2" velocity="1.5" effort="3000"'
RAIL = SIX.replace(
    '<link name="l0"/>',
    '<link name="floor"/>'
    + joint("rail", "floor", "l0", xyz=(0, 0, 0.1), axis=(0, 1, 0), kind="prismatic", limit=STROKE)
    + f'<link name="l0">{inertial(60.0, (0, 0, 0.05), (2, 2, 2, 0, 0, 0))}</link>',
)


def imported(tmp_path, text, name="a.urdf"):
    """The arm of a model file whose sidecar is estimated, and the text of the sidecar."""
    path = tmp_path / name
    path.write_text(text)
    arm = read_model(path)
    sidecar = template(arm, estimate(known_of(arm)))
    (tmp_path / "a.robot.toml").write_text(sidecar)
    return load_file(path), sidecar


def number(found, key):
    """The estimate of one number."""
    return float(found[key].value)


def postures(spec, count=20):
    return np.random.default_rng(7).uniform(spec.lower, spec.upper, (count, spec.n))


def test_a_scara_is_the_arm_that_pinocchio_reads(tmp_path):
    spec, _ = imported(tmp_path, TEXT)
    assert [axis.kind for axis in spec.axes] == [REVOLUTE, REVOLUTE, PRISMATIC, REVOLUTE]
    # one number for the angle of the last joint, where Pinocchio has cosine and sine of an endless one
    text = TEXT.replace("continuous", "revolute")
    for q in postures(spec):
        same(spec, q, pinocchio_says(text, q, "tool0"))


@pytest.mark.physics
def test_a_gantry_is_the_arm_that_mujoco_reads(tmp_path):
    path = tmp_path / "a.xml"
    path.write_text(MJCF)
    arm = read_model(path)
    (tmp_path / "a.robot.toml").write_text(
        template(arm, estimate(known_of(arm))).replace('flange = "wrist"', 'flange = "tip"')
    )
    spec = load_file(path)
    assert [axis.kind.slides for axis in spec.axes] == [True, True, True, False]
    bare = [axis.body.mass for axis in spec.axes]
    assert bare[0] == 1e-6  # x and y move one body, which counts once
    for q in postures(spec):
        for ours, theirs in zip(_of(spec, q), mujoco_says(path, q, "tip"), strict=True):
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=2e-6)


def _of(spec, q):
    from runtime.robot.model.arm_model import ArmModel

    model = ArmModel(spec)
    return model.mass_matrix(q), model.gravity(q), model.flange(q)


def test_values_of_a_slide_are_in_m_and_newton():
    arm = parse_model(Source("scara.urdf", TEXT))
    quill = arm.axes[2].hinge
    assert (quill.lower, quill.upper, quill.speed, quill.effort) == (-0.2, 0.005, 1.1, 330.0)
    assert (quill.damping, quill.friction) == (60.0, 9.0)
    gantry = parse_model(Source("gantry.xml", MJCF))
    assert list(gantry.lower[:3]) == [-0.9, -0.4, -0.05]  # m, although the file has degrees
    assert gantry.upper[3] == pytest.approx(170 * DEG)
    assert [axis.hinge.effort for axis in gantry.axes] == [900.0, 500.0, None, 14.0]
    assert [axis.hinge.damping for axis in gantry.axes] == [30.0, 30.0, 20.0, 0.2]


def test_ranges_are_written_as_they_were_typed(tmp_path):
    _, sidecar = imported(tmp_path, TEXT)
    lines = sidecar.splitlines()
    assert 'kind = "prismatic"' in lines
    assert sum(line.startswith("range_mm = [-200.0, 5.0]") for line in lines) == 1
    assert sum(line.startswith("max_speed_mm_s = 1100.0") for line in lines) == 1
    assert sum(line.startswith("max_force_n = 330.0") for line in lines) == 1


def test_a_template_is_filled_in_by_the_keys_of_each_axis(tmp_path):
    path, sidecar = tmp_path / "a.xml", tmp_path / "a.robot.toml"
    path.write_text(MJCF.replace('name="y" type="slide" ', 'name="y" type="hinge" '))
    text = template(read_model(path)).replace("# [axes.correction]", "[axes.correction]", 1)
    for key in ("inertia_shift_kg_m2", "added_mass_kg", "added_inertia_kg_m2", "reason"):
        text = text.replace(f"# {key} =", f"{key} =", 1)
    sidecar.write_text(text)
    missing = load_file(path).undriven
    assert missing.code == "RBL608"
    assert {"max_speed_mm_s", "max_acceleration_mm_s2", "axes.motor"} <= fields(missing.message)
    sidecar.write_text(
        fill(
            text,
            max_speed_mm_s="800",
            max_acceleration_mm_s2="5000",
            max_force_n="700",
            travel_mm_per_turn="-20",
        ).replace("# max_jerk_mm_s3 = ...", "max_jerk_mm_s3 = 40000", 1)
    )
    spec = load_file(path)
    assert spec.undriven is None
    assert spec.axes[0].motor.gear_ratio == pytest.approx(-2 * math.pi / 0.02)
    assert spec.axes[0].limits.acceleration == pytest.approx(5.0)
    assert spec.per_axis("limits", "jerk")[:2] == pytest.approx([40.0, 10.0 * spec.axes[1].limits.acceleration])
    jerks = {name for name in spec.estimated if "jerk" in name}
    assert {"axes.2.max_jerk_deg_s3", "axes.3.max_jerk_mm_s3"} <= jerks
    assert "axes.1.max_jerk_mm_s3" not in jerks
    assert spec.axes[1].motor.gear_ratio == 100.0


@pytest.mark.parametrize("known_as", ["a.urdf", "a.xml"])
def test_a_sidecar_with_an_axis_of_the_other_kind_is_refused(tmp_path, known_as):
    _, sidecar = imported(tmp_path, TEXT if known_as == "a.urdf" else MJCF, known_as)
    (tmp_path / "a.robot.toml").write_text(sidecar.replace('kind = "prismatic"\n', "", 1))
    for read in (load_file, read_arm, read_arm_file):
        with pytest.raises(FileFault) as caught:
            read(tmp_path / known_as)
        assert caught.value.code == "RBL610"
        assert caught.value.path.endswith("a.robot.toml")


def test_a_check_without_numerics_knows_the_kinds_and_ranges(tmp_path):
    for name, text, slides, lower in (
        ("a.urdf", TEXT, [False, False, True, False], -0.2),
        ("a.xml", MJCF, [True, True, True, False], -math.inf),
    ):
        (tmp_path / name).write_text(text)
        limits = read_arm_file(tmp_path / name).limits
        assert [each.kind.slides for each in limits] == slides
        assert limits[2].lower == lower


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("RBL607", 'lower="-0.2" upper="0.005"', 'lower="0.2" upper="0.005"'),
        ("RBL605", 'velocity="1.1"', 'velocity="-1.1"'),
        ("RBL605", '<axis xyz="0 -1 0"/>', '<axis xyz="0 0 0"/>'),
        ("RBL621", '<axis xyz="0 -1 0"/>', '<axis xyz="0 -1 0"/><mimic joint="elbow"/>'),
        ("RBL621", 'damping="60"', 'spring_stiffness="60"'),
        ("RBL621", 'type="prismatic"', 'type="planar"'),
        ("RBL621", 'type="prismatic"', 'type="floating"'),
    ],
)
def test_a_slide_that_cannot_be_used_is_refused_at_its_place(code, old, new):
    assert TEXT.count(old) == 1
    refused(code, TEXT.replace(old, new))


def test_a_mimic_of_a_slide_is_no_axis():
    # two fingers of one drive: the arm before them is one branch too many as well, so the joint itself is named
    fingers = urdf(
        '<link name="l0"/><link name="l1"/><link name="l2"/>',
        joint("a", "l0", "l1", kind="prismatic"),
        joint("b", "l1", "l2", kind="prismatic", more='<mimic joint="a" multiplier="-1"/>'),
    )
    fault = refused("RBL621", fingers)
    assert "b" in fields(fault.message)


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (TEXT, ' lower="-0.2" upper="0.005"', ""),
        (TEXT, 'lower="-0.2"', 'lower="-200"'),
        (MJCF, ' range="-0.05 0.45"', ""),
    ],
)
def test_how_far_an_axis_slides_is_never_estimated(text, old, new):
    assert text.count(old) == 1
    arm = parse_model(Source("a.urdf", text.replace(old, new)))
    with pytest.raises(FileFault) as caught:
        known_of(arm)
    assert caught.value.code == "RBL608"
    assert "J3" in caught.value.message.split()


@pytest.mark.parametrize(
    ("old", "new", "doubted"),
    [
        ('lower="-0.2"', 'lower="-200"', True),
        ('lower="-0.2" upper="0.005"', 'lower="-0.0002" upper="0.000005"', True),
        ('velocity="1.1"', 'velocity="1100"', True),
        ('velocity="1.1"', 'velocity="0.0011"', True),
        ('lower="-0.2"', 'lower="-14"', False),
    ],
)
def test_mm_in_a_file_of_m_are_doubted(tmp_path, old, new, doubted):
    path = tmp_path / "a.urdf"
    path.write_text(TEXT.replace(old, new))
    codes = [warning.code for warning in read_model(path).warnings]
    assert codes == (["RBL628"] if doubted else [])


def test_a_gantry_whose_joints_are_in_one_place_is_no_point():
    directions = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    frames = [
        joint(name, f"l{k}", f"l{k + 1}", xyz=(0, 0, 0), axis=axis, kind="prismatic", limit=STROKE)
        for k, (name, axis) in enumerate(directions.items())
    ]
    links = [
        '<link name="l0"/>',
        *(f'<link name="l{k}">{inertial(m)}</link>' for k, m in ((1, 9.0), (2, 5.0), (3, 2.0))),
    ]
    assert parse_model(Source("a.urdf", urdf(*links, *frames))).warnings == ()


# --- inverse kinematics ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "text"), [("scara.urdf", TEXT), ("gantry.xml", MJCF), ("rail.urdf", RAIL)])
def test_every_pose_of_an_arm_with_a_slide_is_met(tmp_path, name, text):
    spec, _ = imported(tmp_path, text, f"a.{name.split('.')[1]}")
    arm = Kinematics(spec)
    for q in postures(spec, 12):
        X = arm.forward(q)
        found = arm.solutions(X)
        assert found and found[0].limit_margin >= 0.0
        for each in found:
            np.testing.assert_allclose(arm.forward(each.q), X, rtol=0, atol=1e-8)


def test_a_cartesian_arm_has_one_solution(tmp_path):
    spec, _ = imported(tmp_path, MJCF, "a.xml")
    arm = Kinematics(spec)
    for q in postures(spec, 5):
        (only,) = arm.solutions(arm.forward(q))
        np.testing.assert_allclose(only.q, q, rtol=0, atol=1e-8)


# --- estimates -------------------------------------------------------------------------------------------------------


def test_estimates_of_a_slide_are_within_a_factor_of_three_of_the_library():
    # force, speed and masses of the Cobra 600 are those of its library file: the data sheet, and estimates of bodies
    spec = load_builtin("cobra600")
    force = number(estimate(known(spec, torque=False)), "axes.3.max_force_n") / spec.axes[2].limits.torque
    assert 1 / 3 < force < 3
    drives = estimate(known(spec))
    assert 1 / 3 < number(drives, "axes.3.max_acceleration_mm_s2") * MM / spec.axes[2].limits.acceleration < 3
    assert 1 / 3 < number(drives, "axes.3.motor.travel_mm_per_turn") / 20.0 < 3
    bare = estimate(known(spec, bodies=False, turning=False, torque=False, payload=False))
    assert number(bare, "axes.3.max_speed_mm_s") == 1000.0
    for axis in (1, 2, 3, 4):
        assert 1 / 3 < number(bare, f"axes.{axis}.mass_kg") / spec.axes[axis - 1].body.mass < 3


def test_what_a_model_gives_at_a_slide_is_taken_over_its_screw(tmp_path):
    spec, _ = imported(tmp_path, TEXT)
    motor = spec.axes[2].motor
    assert motor.joint_viscous_friction == pytest.approx(60.0, rel=0.01)
    assert motor.joint_coulomb_friction == pytest.approx((9.0, 9.0), rel=0.01)
    gantry, _ = imported(tmp_path, MJCF, "a.xml")
    assert gantry.axes[0].motor.reflected_inertia == pytest.approx(14.0, rel=0.01)


def test_an_arm_that_only_slides_has_estimates(tmp_path):
    text = re.sub(r'<body name="wrist".*?</body>', '<site name="tip" pos="0 0 0.08"/>', MJCF, flags=re.DOTALL)
    spec, _ = imported(tmp_path, text, "a.xml")
    assert [axis.kind.slides for axis in spec.axes] == [True] * 3
    assert np.isfinite(spec.per_axis("limits", "torque")).all()
    assert spec.path.rotation_speed > 0.0


def test_a_torque_sets_no_floor_for_a_force():
    given = replace(known_of(parse_model(Source("a.urdf", TEXT))), payload=1.0, torque=np.full(4, math.nan))
    first = given.bodies[0]
    heavy = replace(given, bodies=(replace(first, inertia=300.0 * first.inertia), *given.bodies[1:]))
    found, other = (estimate(each) for each in (given, heavy))
    assert number(other, "axes.1.max_torque_nm") > 2.0 * number(found, "axes.1.max_torque_nm")
    assert other["axes.3.max_force_n"] == found["axes.3.max_force_n"]
