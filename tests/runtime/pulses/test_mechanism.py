"""Mechanisms: kinematics there and back, what they refuse, and their files."""

import re

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.core.tomlfile import FileFault, Source
from runtime.core.units import DEG, MM
from runtime.motion.commands import MoveLinear
from runtime.pulses.machine import Stand
from runtime.pulses.mechanism import library, load_builtin, load_file, parse
from tests.messages import fields

Z = np.array([0.0, 0.0, 1.0])
SCARA = load_builtin("scara")


def to(x, y, z=700.0, R=None, **options):
    return MoveLinear(X_world_tool=pose(np.array([x, y, z]) * MM, R), **options)


def way_of(machine, q, command, R=None):
    return machine.placed(command.X_world_tool[:3, 3]).curve(Stand(q=np.array(q), R=R), command)


@pytest.mark.parametrize("name", library())
def test_forward_kinematics_undoes_the_inverse_along_a_line(name):
    machine = load_builtin(name).placed(np.array([0.0, 0.0, 0.7]))
    start = machine.points(machine.home.q[None])[0]
    end = start + np.array([0.05, 0.12, 0.0])
    s = np.linspace(0.0, 1.0, 101)
    q = machine.curve(machine.home, MoveLinear(X_world_tool=pose(end))).joints(s)
    np.testing.assert_allclose(machine.points(q), start + s[:, None] * (end - start), atol=1e-9)
    assert np.abs(np.diff(q, axis=0)).max() < 0.02


def test_a_scara_keeps_its_elbow_and_turns_its_tool_by_the_rest():
    end = np.array([400.0, 100.0, 650.0])
    for elbow in (80.0, -80.0):
        q0 = np.array([-60.0 if elbow > 0.0 else 60.0, elbow, 0.0, 10.0]) * DEG
        q0[2] = 0.7
        command = to(end[0], end[1], end[2], rotation_about(Z, 0.5))
        q = way_of(SCARA, q0, command, R=np.eye(3)).joints(np.linspace(0.0, 1.0, 50))
        assert np.sign(q[:, 1]).tolist() == [np.sign(elbow)] * 50
        turned = q[:, [0, 1, 3]].sum(axis=1)
        np.testing.assert_allclose(turned - turned[0], np.linspace(0.0, 0.5, 50), atol=1e-9)


@pytest.mark.parametrize(
    ("theta4", "end"),
    [(300.0, 120.0), (-300.0, -120.0), (20.0, -160.0), (-20.0, 160.0), (0.0, 180.0), (0.004, 180.004)],
)
@pytest.mark.parametrize("rounding", [0.0, 1e-12, -1e-12])
def test_a_half_turn_keeps_the_range_of_theta4_and_its_sign_is_not_that_of_rounding(theta4, end, rounding):
    q = np.array([-60.0 * DEG, 80.0 * DEG, 0.7, theta4 * DEG])
    here = SCARA.points(q[None])[0] / MM
    way = way_of(SCARA, q, to(here[0], here[1], here[2], rotation_about(Z, np.pi + rounding)), R=np.eye(3))
    assert way.joints(np.linspace(0.0, 1.0, 50))[-1, 3] / DEG == pytest.approx(end, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "command", "R", "code", "says"),
    [
        ("scara", to(900, 0), None, "RBL410", ""),
        ("cylindrical", to(-300, 400), None, "RBL411", ""),
        ("cylindrical", to(300, 100, 2000), None, "RBL411", "2000.00 mm 100.0 %"),
        ("xy", to(300, 100, R=rotation_about(Z, 0.1)), np.eye(3), "RBL431", "5.73 deg"),
        ("scara", to(400, 100, R=rotation_about([1.0, 0.0, 0.0], 0.1)), np.eye(3), "RBL431", ""),
        ("xy", to(300, 100, speed=0.6), None, "RBL404", "SPEED mm/s 600"),
        ("xy", to(300, 100, acceleration=1.5), None, "RBL404", "ACCEL 150"),
    ],
)
def test_what_a_mechanism_cannot_do_is_refused(name, command, R, code, says):
    machine = load_builtin(name)
    with pytest.raises(Fault) as caught:
        way_of(machine, machine.home.q, command, R).joints(np.linspace(0.0, 1.0, 200))
    assert caught.value.code == code
    assert set(says.split()) <= fields(caught.value.message)


def test_a_line_through_the_column_is_singular():
    text = re.sub(r"range_mm = \[150, 1000\]", "range_mm = [0, 1000]", source("cylindrical"))
    machine = parse(Source("c.toml", text))
    with pytest.raises(Fault, match=r"theta .*180 deg") as caught:
        way_of(machine, [0.0, 0.3, 0.7], to(-299, 0)).joints(np.linspace(0.0, 1.0, 50))
    assert caught.value.code == "RBL412"


def test_a_plane_is_kept():
    machine = load_builtin("xy").placed(np.array([0.3, 0.1, 0.7]))
    assert machine.described()["z_mm"] == pytest.approx(700.0)
    with pytest.raises(Fault, match=r"z .*700 mm.*650 mm"):
        machine.curve(machine.home, to(300, 100, 650))


def test_a_move_to_where_the_tool_is_has_no_limits():
    machine = load_builtin("xy")
    assert way_of(machine, machine.home.q, to(300, -150)).limits is None


def source(name):
    from runtime.pulses.mechanism import _folder

    return _folder().joinpath(f"{name}.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("before", "after", "code", "says"),
    [
        ("schema = 1", "schema = 2", "RBL605", "schema"),
        ('kind = "scara"', 'kind = "delta"', "RBL610", "delta"),
        ("l1_mm = 325", "", "RBL608", "l1_mm"),
        ("l1_mm = 325", "l1_mm = nan", "RBL604", "finite"),
        ("l1_mm = 325", "l1_mm = -325", "RBL605", "above 0"),
        ('name = "theta2"', 'name = "elbow"', "RBL608", "theta2"),
        ('name = "z"', 'name = "height"', "RBL610", "height"),
        ('name = "theta4"', 'name = "z"', "RBL613", "slides"),
        ("range_deg = [-132, 132]", "range_deg = [132, -132]", "RBL607", "lower"),
        ("home_deg = -60", "home_deg = -160", "RBL605", "between -132 and 132"),
        ("pulse_deg = 0.009", "pulse_deg = 0", "RBL605", "above 0"),
        ("pulse_deg = 0.009", "", "RBL608", "pulse_deg"),
        ("speed_mm_s = 100", "speed_mm_s = 900", "RBL605", "speed_mm_s"),
        ("l2_mm = 275", "l2_mm = 275\ncolour = 1", "RBL609", "colour"),
    ],
)
def test_a_mechanism_file_is_refused_at_its_line(tmp_path, before, after, code, says):
    text = source("scara")
    assert before in text
    path = tmp_path / "m.toml"
    path.write_text(text.replace(before, after, 1), "utf-8")
    with pytest.raises(FileFault) as caught:
        load_file(path)
    assert caught.value.code == code
    assert says in caught.value.message
    assert caught.value.line >= 1


def test_joints_stand_in_their_order(tmp_path):
    text = source("xy").replace('"x"', '"?"').replace('"y"', '"x"').replace('"?"', '"y"')
    with pytest.raises(FileFault, match="order") as caught:
        parse(Source("m.toml", text))
    assert caught.value.code == "RBL610"


def test_there_is_no_other_built_in():
    assert library() == ("cylindrical", "scara", "xy")
    with pytest.raises(KeyError):
        load_builtin("delta")
