"""Joint lines in space: the same arm as from DH rows, and what a file in this form may not say."""

import re
from importlib import resources

import numpy as np
import pytest

from runtime.core.tomlfile import FileFault, Source
from runtime.robot.files.corrections import TOKEN_INERTIA
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.motor import torque_limit
from tests.messages import fields
from tests.robolang.cli.commands import PUMA
from tests.runtime.from_texts import parse_robot
from tests.runtime.robot.arms import DEG, Irb2400

TEXT = resources.files("runtime.robot.library").joinpath("manutec_r3.toml").read_text("utf-8")


def row(values) -> str:
    return "[" + ", ".join(repr(float(value)) for value in values) + "]"


def as_lines(spec: RobotSpec, text: str) -> str:
    """Rewrite a DH file as joint lines, from the placements and published bodies of its spec."""
    X, at = np.eye(4), 0
    text = text.replace('form = "dh"', 'form = "lines"')
    for axis, body in zip(spec.axes, spec.published, strict=True):
        X = X @ axis.placement
        R, inertia = X[:3, :3], X[:3, :3] @ body.inertia @ X[:3, :3].T
        moments = [*np.diag(inertia), *inertia[np.triu_indices(3, 1)]]
        lines = [
            f"origin_m = {row(X[:3, 3])}",
            f"direction = {row(3.0 * R[:, 2])}",
            f"mass_kg = {body.mass}",
            f"cog_m = {row(R @ body.cog)}",
            f"inertia_kg_m2 = {row(moments)}",
        ]
        start, end = text.index("d_m = ", at), text.index("range_deg", text.index("d_m = ", at))
        text = text[:start] + "\n".join(lines) + "\n" + text[end:]
        at = start + sum(map(len, lines))
    flange = X @ spec.X_last_flange
    assert np.allclose(flange[:3, :3], np.eye(3))
    where = f"[flange]\nposition_m = {row(flange[:3, 3])}\nrotation_deg = [0, 0, 0]\n\n[path]"
    return text.replace("[path]", where)


def test_an_arm_given_as_lines_is_the_arm_given_as_rows():
    """The Puma either way: same kinematics, same inertia and gravity, same corrections."""
    rows = load_builtin("puma560")
    lines = parse_robot(Source("r.toml", as_lines(rows, PUMA.read_text())))
    assert lines.corrections == rows.corrections
    models = ArmModel(rows), ArmModel(lines)
    for q in np.random.default_rng(3).uniform(rows.lower, rows.upper, (20, 6)):
        np.testing.assert_allclose(Kinematics(lines).forward(q), Kinematics(rows).forward(q), atol=1e-12)
        np.testing.assert_allclose(models[1].mass_matrix(q), models[0].mass_matrix(q), atol=1e-12)
        np.testing.assert_allclose(models[1].gravity(q), models[0].gravity(q), atol=1e-12)


def test_the_irb_2400_of_the_library_is_the_one_of_the_data_sheet():
    spec = load_builtin("irb2400")
    for q in np.random.default_rng(4).uniform(spec.lower, spec.upper, (20, 6)):
        np.testing.assert_allclose(Kinematics(spec).forward(q), Irb2400.forward(q), atol=1e-12)
    np.testing.assert_allclose(np.stack([spec.lower, spec.upper], axis=1), np.array(Irb2400.range_deg) * DEG)
    assert sum(axis.body.mass for axis in spec.axes) == pytest.approx(380.0 - 110.0)
    assert any("ESTIMATE" in note for note in spec.notes)


def test_the_irb_2400_can_carry_its_rated_payload():
    """At rest, and with 2 rad/s2 on an axis, the estimated motors have something left in every posture."""

    spec = load_builtin("irb2400")
    model, rotors = ArmModel(spec), spec_rotors(spec)
    model.set_payload(Payload(mass=spec.rated_payload, cog=np.array([0.0, 0.0, 0.15])))
    postures = np.random.default_rng(5).uniform(spec.lower, spec.upper, (500, 6))
    weight = np.array([np.abs(model.gravity(q)) for q in postures])
    assert (weight.max(axis=0) < 0.6 * torque_limit(spec)).all()
    moving = np.array([np.diag(model.mass_matrix(q)) + rotors for q in postures]) * 2.0 + weight
    assert (moving.max(axis=0) < torque_limit(spec)).all()


# as the Modelica Standard Library prints them, in its axes (y up, z forward): way to the next joint, mass, centre of
# gravity, I_11 I_22 I_33 I_21, and the direction of the joint before the body
MODELICA = [
    ((0, 0.324, 0.3), 1.0, (0, 0, 0), (0, 1.16, 0, 0), (0, 1, 0)),
    ((0, 0.65, 0), 56.5, (0.172, 0.205, 0), (2.58, 0.64, 2.73, -0.46), (1, 0, 0)),
    ((0, 0.414, -0.155), 26.4, (0.064, -0.034, 0), (0.279, 0.245, 0.413, -0.070), (1, 0, 0)),
    ((0, 0.186, 0), 28.7, (0, 0, 0), (1.67, 0.081, 1.67, 0), (0, 1, 0)),
    ((0, 0.125, 0), 5.2, (0, 0, 0), (1.25, 0.81, 1.53, 0), (1, 0, 0)),
    ((0, 0, 0), 0.5, (0.05, 0.05, 0.05), (0, 0, 0, 0), (0, 1, 0)),
]
OURS = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Turns a vector of the library, (x, y, z) with y up, into (z, x, y)."""


def test_the_manutec_is_the_one_of_the_modelica_library():
    spec, X, origin = load_builtin("manutec_r3"), np.eye(4), np.array([0.0, 0.351, 0.0])
    for axis, body, (way, mass, cog, (xx, yy, zz, yx), direction) in zip(
        spec.axes, spec.published, MODELICA, strict=True
    ):
        X = X @ axis.placement
        R = X[:3, :3]
        inertia = OURS @ np.array([[xx, yx, 0], [yx, yy, 0], [0, 0, zz]]) @ OURS.T
        np.testing.assert_allclose(X[:3, 3], OURS @ origin, atol=1e-12)
        np.testing.assert_allclose(R[:, 2], OURS @ direction, atol=1e-15)
        np.testing.assert_allclose(R @ body.cog, OURS @ cog, atol=1e-15)
        np.testing.assert_allclose(R @ body.inertia @ R.T, inertia, atol=1e-15)
        assert body.mass == mass
        origin = origin + way
    np.testing.assert_allclose((X @ spec.X_last_flange)[:3, 3], OURS @ origin, atol=1e-12)


def test_the_drives_of_the_manutec_are_the_published_ones():
    """Springs, dampers and friction of joints 1 to 3 at the motor, friction of joints 4 to 6 at the joint."""
    motors = [axis.motor for axis in load_builtin("manutec_r3").axes]
    N = np.array([-105, 210, 60, -99, 79.2, -99])
    assert [m.gear_ratio for m in motors] == N.tolist()
    assert [m.rotor_inertia for m in motors] == [1.3e-3, 1.3e-3, 1.3e-3, 1.6e-4, 1.8e-4, 4.3e-5]
    assert [m.torque_constant for m in motors] == [1.1616, 1.1616, 1.1616, 0.2365, 0.2608, 0.0842]
    assert [m.stiffness / m.gear_ratio**2 for m in motors[:3]] == pytest.approx([43, 8, 58])
    assert [m.damping / m.gear_ratio**2 for m in motors[:3]] == pytest.approx([0.005, 0.01, 0.04])
    assert not any(m.elastic for m in motors[3:])
    assert [m.coulomb_friction[0] for m in motors[:3]] == [0.4, 0.5, 0.7]
    assert [m.viscous_friction for m in motors[:3]] == pytest.approx([0.13 / 160, 0.1 / 130, 0.2 / 130], rel=1e-5)
    assert [m.joint_coulomb_friction[0] for m in motors[3:]] == pytest.approx([21.8, 30.1, 10.9], rel=1e-5)
    assert [m.joint_viscous_friction for m in motors[3:]] == pytest.approx([9.8, 0.03, 3.92], rel=1e-5)
    assert {m.max_current for m in motors} == {9.0}


def test_right_angles_are_exact():
    for name in ("manutec_r3", "irb2400"):
        spec = load_builtin(name)
        for X in [*(axis.placement for axis in spec.axes), spec.X_last_flange]:
            assert set(np.abs(X[:3, :3]).ravel()) <= {0.0, 1.0}


def test_a_direction_askew_gives_a_proper_frame():
    text = TEXT.replace("direction = [0, 1, 0]", "direction = [0.3, 2, -0.4]", 1)
    without_closed_form = text[: text.index("# The same arm")] + text[text.index("# The flange at") :]
    spec = parse_robot(Source("r.toml", without_closed_form))
    X_base_joint = spec.axes[0].placement @ spec.axes[1].placement
    direction = np.array([0.3, 2, -0.4])
    np.testing.assert_allclose(X_base_joint[:3, 2], direction / np.linalg.norm(direction), atol=1e-15)
    np.testing.assert_allclose(X_base_joint[:3, :3].T @ X_base_joint[:3, :3], np.eye(3), atol=1e-15)
    assert np.linalg.det(X_base_joint[:3, :3]) == pytest.approx(1.0)


def refused(text: str) -> FileFault:
    with pytest.raises(FileFault) as caught:
        parse_robot(Source("r.toml", text))
    assert caught.value.hint
    return caught.value


POINT = "added_inertia_kg_m2 = 1e-12"


@pytest.mark.parametrize(
    ("old", "new", "code", "said"),
    [
        ("direction = [0, 1, 0]", "direction = [0, 0, 0]", "RBL605", "axes.2.direction"),
        ("direction = [0, 1, 0]", "direction = [0, nan, 0]", "RBL604", ""),
        ("direction = [0, 1, 0]", "direction = [1, 0, 0]", "RBL615", ""),
        ("direction = [0, 1, 0]\n", "", "RBL608", "axes.2.direction"),
        ("origin_m = [0.3, 0.0, 0.675]", "origin_m = [0.3, 0.0]", "RBL613", "3"),
        ("origin_m = [0.3, 0.0, 0.675]", "d_m = 0.1\norigin_m = [0.3, 0.0, 0.675]", "RBL609", "axes.2.d_m"),
        ("[flange]\nposition_m = [0.145, 0.0, 2.05]\nrotation_deg = [0, 0, 0]\n", "", "RBL608", ""),
        ("rotation_deg = [0, 0, 0]", "rotation_deg = [0, 0, 1]", "RBL615", ""),
        ('form = "lines"', 'form = "dh"', "RBL608", "axes.1.d_m"),
        # the spring of joint 1
        ("rotor_inertia_kg_m2 = 1.3e-3", "rotor_inertia_kg_m2 = 0", "RBL605", ""),
        (
            "joint_stiffness_nm_rad = 474075.0",
            "joint_stiffness_nm_rad = 5e8",
            "RBL605",
            "axes.1.motor.joint_stiffness_nm_rad",
        ),
        ("rotor_inertia_kg_m2 = 1.3e-3", "rotor_inertia_kg_m2 = 1e-9", "RBL605", ""),
        ("joint_damping_nm_s_rad = 55.125 ", "# none ", "RBL608", "axes.1.motor.joint_damping_nm_s_rad"),
        (
            "joint_damping_nm_s_rad = 55.125",
            "joint_damping_nm_s_rad = -1",
            "RBL605",
            "axes.1.motor.joint_damping_nm_s_rad",
        ),
        # the point mass of link 6
        (POINT, "", "RBL606", "J6"),
        (POINT, "added_inertia_kg_m2 = 2e-12", "RBL606", "1e-12"),
        ("inertia_kg_m2 = [0.0, 0.0, 0.0]", "inertia_kg_m2 = [1e-4, 1e-4, 1e-4]", "RBL606", ""),
    ],
)
def test_a_file_of_lines_is_refused_where_it_is_wrong(old, new, code, said):
    assert old in TEXT
    found = refused(TEXT.replace(old, new, 1))
    assert found.code == code
    assert set(said.split()) <= fields(found.message)
    assert found.line >= 1


def test_a_point_mass_without_a_correction_is_refused_and_the_help_works():
    start = TEXT.rindex("[axes.correction]")
    end = TEXT.index("[axes.motor]", start)
    found = refused(TEXT[:start] + TEXT[end:])
    assert found.code == "RBL606"
    assert "J6" in fields(found.message)
    assert re.search(rf"added_inertia_kg_m2 = {TOKEN_INERTIA:g}", found.hint)
