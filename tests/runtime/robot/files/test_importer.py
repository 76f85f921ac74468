"""Imported arms are the arms of their files: Pinocchio's and MuJoCo's own readers are the judges."""

import re

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.frames import pose
from runtime.core.tomlfile import FileFault, Source
from runtime.core.units import GRAVITY
from runtime.robot.files.importer import load_file, parse_model, read_arm, read_model
from runtime.robot.files.sidecar import template
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel
from tests.campaign import examples
from tests.messages import fields
from tests.runtime.robot.models import ANGLES, DATA, SEVEN, chain, fill, inertial, joint, urdf


def robot(path, tmp_path):
    """The robot of a model file, with a sidecar that lacks nothing."""
    copy = tmp_path / path.name
    copy.write_text(path.read_text())
    (tmp_path / f"{path.stem}.robot.toml").write_text(fill(template(read_model(copy))))
    return load_file(copy)


def poses(n, seed=1992):
    return np.random.default_rng(seed).uniform(-3.0, 3.0, (20, n))


def pinocchio_says(text, q, frame):
    model = pin.buildModelFromXML(text)
    model.gravity = pin.Motion(np.array([0.0, 0.0, -GRAVITY]), np.zeros(3))
    data = model.createData()
    M = pin.crba(model, data, q)
    M = np.triu(M) + np.triu(M, 1).T
    g = pin.computeGeneralizedGravity(model, data, q).copy()
    pin.framesForwardKinematics(model, data, q)
    return M, g, data.oMf[model.getFrameId(frame)].homogeneous


def mujoco_says(path, q, site):
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.gravity[:] = 0.0, 0.0, -GRAVITY
    model.dof_armature[:] = 0.0
    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    return M, data.qfrc_bias.copy(), pose(data.site(site).xpos, data.site(site).xmat.reshape(3, 3))


def same(spec, q, judge):
    model = ArmModel(spec)
    for ours, theirs in zip((model.mass_matrix(q), model.gravity(q), model.flange(q)), judge, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)


def test_an_urdf_is_the_arm_that_pinocchio_reads(tmp_path):
    spec = robot(SEVEN, tmp_path)
    assert spec.n == 7
    for q in poses(7):
        same(spec, q, pinocchio_says(SEVEN.read_text(), q, "flange"))


@pytest.mark.physics
def test_an_mjcf_is_the_arm_that_mujoco_reads(tmp_path):
    (tmp_path / "angles.robot.toml").write_text('flange = "tip"\n')
    copy = tmp_path / "angles.xml"
    copy.write_text(ANGLES.read_text())
    (tmp_path / "angles.robot.toml").write_text(fill(template(read_arm(copy))))
    spec = load_file(copy)
    assert spec.n == 5
    for q in poses(5):
        same(spec, q, mujoco_says(ANGLES, q, "tip"))


numbers = st.floats(-1.0, 1.0, allow_subnormal=False)
triples = st.tuples(numbers, numbers, numbers)
directions = triples.filter(lambda v: np.linalg.norm(v) > 0.1)


@examples(40)
@given(st.lists(st.tuples(triples, triples, directions), min_size=2, max_size=7), triples, triples, st.integers(0, 99))
def test_arms_of_any_form_are_those_that_pinocchio_reads(frames, xyz, rpy, seed):
    text = chain(frames, (xyz, rpy), [inertial(cog=frame[0], rpy=frame[1]) for frame in frames])
    arm = parse_model(Source("made.urdf", text))
    q = poses(arm.n, seed)[0]
    _, _, X = pinocchio_says(text, q, "flange")
    np.testing.assert_allclose(Kinematics(arm).forward(q), X, rtol=0, atol=1e-9)


def test_angles_of_an_mjcf_are_what_its_compiler_says_they_are():
    text = ANGLES.read_text()
    arm = parse_model(Source("angles.xml", text))
    hinges = {axis.name: axis.hinge for axis in arm.axes}
    assert list(hinges) == ["waist", "shoulder", "elbow", "bend", "roll"]
    np.testing.assert_allclose(np.rad2deg(arm.lower), [-150, -150, -120, -100, -150])
    np.testing.assert_allclose(np.rad2deg(arm.upper), [150, 150, 10, 100, 150])
    assert [h.armature for h in hinges.values()] == [0.02, 0.02, 0.02, 0.01, 0.02]
    assert [h.damping for h in hinges.values()] == [0.5, 0.5, 0.5, 0.5, 0.1]
    assert [h.friction for h in hinges.values()] == [0.3] * 5
    assert hinges["elbow"].effort == 55.0
    text = text.replace('angle="degree"', 'angle="radian"').replace("-120 10", "-2 1")
    radian = parse_model(Source("angles.xml", text))
    assert radian.lower[2] == -2.0


def test_the_flange_is_the_last_frame_or_the_one_that_is_named(tmp_path):
    tool = joint("m2", "l2", "tool0", kind="fixed", limit="") + '<link name="tool0"/>'
    text = chain([((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.2), (0, 0, 0), (0, 1, 0))], ((0, 0, 0.1), (0, 0, 0)))
    both = text.replace("</robot>", f"{tool}</robot>")
    assert parse_model(Source("a.urdf", text)).flange == "flange"
    assert parse_model(Source("a.urdf", both)).flange == "flange"
    assert parse_model(Source("a.urdf", both.replace('"flange"', '"x"'))).flange == "tool0"
    refused("RBL621", both.replace('"flange"', '"x"').replace('"tool0"', '"y"'))
    (tmp_path / "a.urdf").write_text(both)
    (tmp_path / "a.robot.toml").write_text('flange = "l2"\n')
    assert read_arm(tmp_path / "a.urdf").flange == "l2"
    (tmp_path / "a.robot.toml").write_text('flange = "l1"\n')
    with pytest.raises(FileFault, match="RBL610"):
        read_arm(tmp_path / "a.urdf")


# --- files that are refused ------------------------------------------------------------------------------------------


def mesh(name):
    """The end of a URDF with one more link that is shown by a mesh."""
    shape = f'<geometry><mesh filename="{name}"/></geometry>'
    return f'<link name="m"><visual>{shape}</visual></link></robot>'


def refused(code, text, name="a.urdf"):
    with pytest.raises(FileFault) as caught:
        parse_model(Source(name, text))
    assert caught.value.code == code, caught.value
    assert caught.value.line >= 1
    assert caught.value.column >= 1
    assert str(caught.value).startswith(f"{name}:{caught.value.line}:")
    return caught.value


TWO = chain([((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.2), (0, 0, 0), (0, 1, 0))])
MJCF = ANGLES.read_text()


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("RBL601", '<robot name="made_up">', '<!DOCTYPE robot SYSTEM "/etc/passwd"><robot name="made_up">'),
        ("RBL601", "</robot>", "</rob>"),
        ("RBL602", "</robot>", mesh("../x.stl")),
        ("RBL602", "</robot>", mesh("http://x/x.stl")),
        ("RBL602", "</robot>", mesh("c:\\x")),
        ("RBL604", 'value="2.0"', 'value="nan"'),
        ("RBL604", 'ixx="0.03"', 'ixx="1e999"'),
        ("RBL605", 'value="2.0"', 'value="-2.0"'),
        ("RBL605", '<axis xyz="0.0 1.0 0.0"/>', '<axis xyz="0 0 0"/>'),
        ("RBL605", '<axis xyz="0.0 1.0 0.0"/>', '<axis xyz="0 1 0"/><dynamics damping="-5"/>'),
        ("RBL605", 'velocity="3"', 'velocity="-3"'),
        ("RBL607", 'lower="-3"', 'lower="4"'),
        ("RBL608", '<mass value="2.0"/>', ""),
        ("RBL608", '<child link="l2"/>', ""),
        ("RBL610", 'name="j2"', 'name="j1"'),
        ("RBL610", '<link name="l2">', '<link name="l1">'),
        ("RBL610", '<child link="l2"/>', '<child link="other"/>'),
        ("RBL611", '<parent link="l0"/><child link="l1"/>', '<parent link="l2"/><child link="l1"/>'),
        ("RBL611", '<child link="l2"/>', '<child link="l1"/>'),
        ("RBL611", '<parent link="l1"/>', '<parent link="l0"/>'),
        ("RBL611", "</robot>", '<link name="alone"/></robot>'),
        ("RBL613", 'xyz="0.0 1.0 0.0"', 'xyz="0 1"'),
        ("RBL613", 'xyz="0.0 1.0 0.0"', 'xyz="0 1 z"'),
        ("RBL613", 'xyz="0.0 1.0 0.0"', 'xyz="0 1 1_0"'),
        ("RBL621", 'type="revolute"><parent link="l1"/>', 'type="planar"><parent link="l1"/>'),
        ("RBL621", "</robot>", '<xacro:macro name="m"/></robot>'),
        ("RBL621", '<axis xyz="0.0 1.0 0.0"/>', '<axis xyz="0 1 0"/><mimic joint="j1"/>'),
        ("RBL621", "</robot>", "<include filename='x'/></robot>"),
        ("RBL621", '<axis xyz="0.0 1.0 0.0"/>', '<axis xyz="0 1 0"/><dynamics spring_stiffness="2"/>'),
    ],
)
def test_an_urdf_that_cannot_be_used_is_refused_at_its_place(code, old, new):
    assert old in TWO
    fault = refused(code, TWO.replace(old, new))
    assert fault.line > 1 or old.startswith("<robot")


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("RBL602", "<actuator>", '<asset><mesh file="/x.stl"/></asset><actuator>'),
        ("RBL602", "<actuator>", '<include file="/etc/x.xml"/><actuator>'),
        ("RBL602", 'angle="degree"', 'angle="degree" meshdir="../../x"'),
        ("RBL603", "<actuator>", '<include file="a.xml"/><actuator>'),
        ("RBL604", 'damping="0.1"', 'damping="nan"'),
        ("RBL604", 'gravity="0 0 -9.81"', 'gravity="0 0 nan"'),
        ("RBL605", 'damping="0.1"', 'damping="-5"'),
        ("RBL605", 'armature="0.01"', 'armature="-1"'),
        ("RBL605", 'quat="0.9 0.1 -0.3 0.2"', 'quat="0 0 0 0"'),
        ("RBL607", 'range="-120 10"', 'range="120 10"'),
        ("RBL608", "worldbody", "world_body"),
        ("RBL610", 'name="roll"', 'name="bend"'),
        ("RBL610", 'class="arm" axis', 'class="none" axis'),
        ("RBL610", 'joint="waist"', 'joint="west"'),
        ("RBL610", 'zaxis="0.2 -0.3 1"', 'zaxis="0.2 -0.3 1" euler="0 0 0"'),
        ("RBL611", "<actuator>", '<equality><weld body1="hand"/></equality><actuator>'),
        ("RBL611", '<site name="tip"', '<body><joint/></body><body><joint/></body><site name="tip"'),
        ("RBL614", "<actuator>", '<extension><plugin plugin="x"/></extension><actuator>'),
        ("RBL621", "<actuator>", '<include file="b.xml"/><actuator>'),
        ("RBL621", '<joint name="bend"/>', '<joint name="bend" type="ball"/>'),
        ("RBL621", '<joint name="bend"/>', '<joint name="bend"/><joint name="free" type="ball"/>'),
        ("RBL621", '<joint name="bend"/>', '<joint name="bend" ref="0.3"/>'),
        ("RBL621", '<joint name="bend"/>', '<joint name="bend" stiffness="9"/>'),
        ("RBL621", '<body name="hand"', '<body gravcomp="1" name="hand"'),
        ("RBL621", 'gravity="0 0 -9.81"', 'gravity="0 -9.81 0"'),
        ("RBL621", 'autolimits="true"', 'inertiafromgeom="true"'),
        ("RBL621", '<site name="tip"', '<body><geom type="box" size="1 1 1" mass="1"/></body><site name="tip"'),
        ("RBL621", "<actuator>", "<tendon/><actuator>"),
    ],
)
def test_an_mjcf_that_cannot_be_used_is_refused_at_its_place(code, old, new):
    assert old in MJCF
    if code == "RBL608":
        old, new = "<worldbody>", "<asset>"
        text = MJCF.replace("<worldbody>", "<asset>").replace("</worldbody>", "</asset>")
    else:
        text = MJCF.replace(old, new, 1)
    assert refused(code, text, "a.xml").line >= 1


def test_a_fault_stands_at_its_element():
    fault = refused("RBL605", MJCF.replace('damping="0.1"', 'damping="-5"'), "a.xml")
    line = MJCF.splitlines().index(next(x for x in MJCF.splitlines() if 'name="roll"' in x)) + 1
    assert (fault.line, fault.column) == (line, MJCF.splitlines()[line - 1].index("<joint") + 1)
    assert 'name="roll"' in fault.excerpt


def test_billion_laughs_and_deep_nesting_are_not_read():
    laughs = (
        '<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "ha">'
        + "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
        + "]><robot>&i;</robot>"
    )
    refused("RBL601", laughs)
    deep = "<mujoco><worldbody>" + "<body>" * 5000 + "</body>" * 5000 + "</worldbody></mujoco>"
    refused("RBL612", deep, "a.xml")
    refused("RBL612", "<robot>" + "<link/>" * 60_000 + "</robot>")


@pytest.mark.parametrize("count", [0, 1, 8])
def test_an_arm_has_two_to_seven_axes(count):
    frames = [((0, 0, 0.1), (0, 0, 0), (0, 0, 1))] * count
    refused("RBL605", chain(frames))


MAKERS = """
<gazebo><plugin name="c" filename="/opt/lib.so"><x>nan</x></plugin><sensor:camera/></gazebo>
<gazebo reference="l1"><mu1>1e999</mu1></gazebo>
<transmission name="t"><actuator name="a"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>
<ros2_control name="r" type="system"><hardware><plugin>x/Y</plugin></hardware></ros2_control>
<material name="m"><color rgba="1 0 0 1"/></material>
<surprise a="1 -inf"/>
"""


def test_what_belongs_to_other_programs_is_left_out_with_one_note_each():
    text = TWO.replace("</robot>", f"{MAKERS}</robot>")
    text = text.replace(
        "<limit ", '<safety_controller k_velocity="1"/><calibration rising="0"/><limit acceleration="9" '
    )
    arm, plain = parse_model(Source("a.urdf", text)), parse_model(Source("a.urdf", TWO))
    assert {note.code for note in arm.notes} == {"RBL641"}
    kinds = [note.message.split(" is left out")[0] for note in arm.notes]
    assert kinds == [
        "<gazebo>",
        "<transmission>",
        "<ros2_control>",
        "<material>",
        "<surprise>",
        "<safety_controller>",
        "<calibration>",
        "'acceleration' of <limit>",
    ]
    assert len(plain.notes) == 0
    for ours, theirs in zip(arm.axes, plain.axes, strict=True):
        assert ours.body.mass == theirs.body.mass
        np.testing.assert_array_equal(ours.placement, theirs.placement)


def test_a_mesh_of_another_computer_is_left_out():
    shape = '<visual><geometry><mesh filename="file:///opt/ros/x.dae"/></geometry></visual>'
    arm = parse_model(Source("a.urdf", TWO.replace('<link name="l1">', f'<link name="l1">{shape}')))
    assert arm.meshes == ()
    assert [note.line for note in arm.notes] == [4]


def test_a_body_that_cannot_be_is_refused_unless_the_sidecar_corrects_it(tmp_path):
    path = tmp_path / "a.urdf"
    path.write_text(TWO.replace('izz="0.02"', 'izz="0.2"', 2).replace('izz="0.2"', 'izz="0.02"', 1))
    with pytest.raises(FileFault, match="RBL606"):
        read_arm(path)
    text = fill(template(read_model(path)))
    assert text.count("# [axes.correction]") == 1
    sidecar = tmp_path / "a.robot.toml"
    sidecar.write_text(text)
    with pytest.raises(FileFault, match="RBL606"):
        load_file(path)
    frames = [((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.2), (0, 0, 0), (0, 1, 0))]
    path.write_text(chain(frames, bodies=["", ""]))
    assert read_arm(path).n == 2  # kinematics needs no bodies
    with pytest.raises(FileFault, match=r"RBL606 .*J1 j1, J2 j2 .*"):
        load_file(path)
    sidecar.unlink()
    path.write_text(chain(frames, bodies=[inertial(mass=0.0), inertial()]))
    with pytest.raises(FileFault, match=r"RBL606 .*J1 j1 "):
        read_arm(path)


def test_a_body_of_the_sidecar_replaces_that_of_the_model(tmp_path):
    path, sidecar = tmp_path / "a.urdf", tmp_path / "a.robot.toml"
    path.write_text(TWO)
    text = fill(template(read_model(path)))
    body = "mass_kg = 3.0\ncog_m = [0.1, 0.2, 0.3]\ninertia_kg_m2 = [0.1, 0.2, 0.25, 0.01, 0.02, 0.03]\n"
    sidecar.write_text(text.replace("[axes.motor]", f"{body}[axes.motor]", 1))
    first, second = load_file(path).axes
    assert first.body.mass == 3.0
    np.testing.assert_array_equal(first.body.cog, [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(first.body.inertia, [[0.1, 0.01, 0.02], [0.01, 0.2, 0.03], [0.02, 0.03, 0.25]])
    assert second.body.mass == 2.0
    for old, new, code in (
        ("mass_kg = 3.0\n", "", "RBL608"),
        ("[0.1, 0.2, 0.3]", "[0.1, nan, 0.3]", "RBL604"),
        ("0.01, 0.02, 0.03]", "0.01]", "RBL613"),
        ("[0.1, 0.2, 0.25", "[0.1, 0.2, 0.9", "RBL606"),
    ):
        sidecar.write_text(text.replace("[axes.motor]", f"{body.replace(old, new)}[axes.motor]", 1))
        with pytest.raises(FileFault, match=code):
            load_file(path)


def test_a_correction_in_the_sidecar_makes_a_published_body_possible(tmp_path):
    path, sidecar = tmp_path / "a.urdf", tmp_path / "a.robot.toml"
    frames = [((0, 0, 0.3), (0, 0, 0), (0, 0, 1)), ((0, 0, 0.2), (0, 0, 0), (0, 1, 0))]
    wide = inertial(inertia=(0.03, 0.2, 0.03, 0.0, 0.0, 0.0))  # 0.03 + 0.03 < 0.2 about the axis of J2
    path.write_text(chain(frames, bodies=[inertial(inertia=(0.5, 0.5, 0.5, 0, 0, 0)), wide]))
    text = fill(template(read_model(path)))
    lines = text.splitlines()
    start = lines.index("# [axes.correction]")
    lines[start : start + 4] = [line.removeprefix("# ") for line in lines[start : start + 4]]
    sidecar.write_text("\n".join(lines))
    spec = load_file(path)
    assert spec.corrections[0].axis == 1
    assert spec.corrections[0].inertia_shift == pytest.approx(0.07, abs=1e-8)
    for q in poses(2):  # the same motion as the body that cannot be
        np.testing.assert_allclose(
            ArmModel(spec).mass_matrix(q), pinocchio_says(path.read_text(), q, "l2")[0], rtol=0, atol=1e-9
        )
    assert read_arm(path).n == 2


# --- the sidecar -----------------------------------------------------------------------------------------------------


def test_without_a_sidecar_every_gap_is_named(tmp_path):
    path = tmp_path / "seven.urdf"
    path.write_text(SEVEN.read_text().replace(' effort="40"', "", 1))
    assert read_arm(path).n == 7
    fault = load_file(path).undriven
    assert fault is not None
    assert fault.code == "RBL608"
    message = fault.message
    assert "J6: max_torque_nm" in message
    assert {"max_acceleration_deg_s2", "axes.motor", "axes.servo"} <= fields(message)
    assert len(message) < 300
    assert str(path) in fields(fault.hint)


def test_a_template_is_refused_until_each_gap_is_filled(tmp_path):
    path, sidecar = tmp_path / "seven.urdf", tmp_path / "seven.robot.toml"
    path.write_text(SEVEN.read_text())
    text = template(read_model(path))
    sidecar.write_text(text)
    assert read_arm(path).n == 7  # kinematics needs no drives
    bare = load_file(path)
    assert bare.undriven is not None
    assert bare.undriven.code == "RBL608"
    assert {"rated_payload_kg", "max_acceleration_deg_s2"} <= fields(bare.undriven.message)
    # what somebody has filled in already rules over the estimates of the ideal arm
    sidecar.write_text(re.sub("# rated_payload_kg = .*", "rated_payload_kg = 4.5", text))
    ideal = load_file(path)
    assert ideal.rated_payload == 4.5
    assert "rated_payload_kg" not in ideal.estimated
    assert ideal.estimated.keys() == bare.estimated.keys() - {"rated_payload_kg"}
    sidecar.write_text(fill(text))
    spec = load_file(path)
    np.testing.assert_allclose(np.rad2deg(spec.upper), [170, 120, 170, 120, 170, 120, 175], atol=1e-4)
    np.testing.assert_allclose(spec.per_axis("limits", "torque"), [320, 320, 176, 176, 110, 40, 40])
    assert spec.axes[0].motor.gear_ratio == 100.0
    for line in dict.fromkeys(fill(text).splitlines()):  # what several axes have alike is left out of the first one
        if " = " in line and line.split(" = ")[0] not in ("flange", "title") and not line.startswith("#"):
            sidecar.write_text(fill(text).replace(line + "\n", "", 1))
            with pytest.raises(FileFault, match=r"RBL608|RBL610"):
                raise load_file(path).undriven or AssertionError(line)


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("RBL610", 'robot = "seven.urdf"', 'robot = "eight.urdf"'),
        ("RBL610", 'name = "joint_3"', 'name = "joint_4"'),
        ("RBL609", "gear_ratio = 100", "gear_ratio = 100\ngear_ration = 100"),
        ("RBL607", "range_deg = [-170", "range_deg = [190"),
        ("RBL605", "gear_ratio = 100", "gear_ratio = 0"),
    ],
)
def test_a_sidecar_that_cannot_be_used_is_refused(tmp_path, code, old, new):
    path = tmp_path / "seven.urdf"
    path.write_text(SEVEN.read_text())
    text = fill(template(read_model(path)))
    assert old in text
    (tmp_path / "seven.robot.toml").write_text(text.replace(old, new, 1))
    with pytest.raises(FileFault) as caught:
        load_file(path)
    assert caught.value.code == code
    assert caught.value.path.endswith("seven.robot.toml")


def test_a_range_in_the_sidecar_rules(tmp_path):
    path = tmp_path / "seven.urdf"
    path.write_text(SEVEN.read_text().replace("revolute", "continuous", 1))
    with pytest.raises(FileFault, match=r"RBL608 .*J1 joint_1"):
        read_arm(path)
    text = fill(template(read_model(path)), range_deg="[-45, 60]")
    (tmp_path / "seven.robot.toml").write_text(text)
    assert read_arm(path).upper[0] == load_file(path).upper[0] == np.deg2rad(60)


def test_a_file_of_any_name_is_a_file(tmp_path):
    path = tmp_path / "$(x).xml"
    path.write_text(MJCF)
    assert read_arm(path).n == 5
    assert "$(x).robot.toml" in str(load_file(path).undriven)
    assert 'robot = "$(x).xml"' in template(read_model(path))


# --- any bytes -------------------------------------------------------------------------------------------------------

PIECES = (
    "<robot <mujoco <link <joint <body <geom <inertial <worldbody> <default> <limit <axis /> > </robot> </mujoco> "
    'name="a" name="b" type="revolute" type="fixed" link="a" xyz="0 0 1" xyz="nan" range="1 0" pos="1 2" mass="-1" '
    '<!DOCTYPE <!-- --> <![CDATA[ ]]> &amp; &x; <?xml version="1.0"?> <?x ?> \0 \ud7ff class="c" file="../x"'
)
pieces = st.sampled_from(PIECES.split())


@examples(300)
@given(st.one_of(st.lists(pieces, max_size=40).map(" ".join), st.text(max_size=200)))
def test_any_text_is_an_arm_or_a_located_fault(text):
    for name in ("a.urdf", "a.xml"):
        try:
            parse_model(Source(name, text))
        except FileFault as fault:
            assert fault.line >= 1
            assert fault.column >= 1


@examples(300)
@given(st.data(), st.sampled_from([MJCF, SEVEN.read_text()]))
def test_a_damaged_file_is_an_arm_or_a_located_fault(data, text):
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 60)))
    patch = data.draw(st.one_of(pieces, st.text(max_size=5), st.just(text[:60])))
    try:
        parse_model(Source("a.xml", text[:start] + patch + text[end:]))
    except FileFault as fault:
        assert fault.line >= 1


@examples(100)
@given(raw=st.binary(max_size=300))
def test_any_bytes_are_an_arm_or_a_fault(tmp_path_factory, raw):
    path = tmp_path_factory.getbasetemp() / "raw.xml"
    path.write_bytes(raw)
    with pytest.raises(FileFault):
        load_file(path)


def test_the_data_of_the_tests_have_no_sidecar():
    assert not list(DATA.glob("*.toml"))
    assert urdf()
