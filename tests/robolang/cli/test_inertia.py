"""``robolang inertia``: the numbers of the model in the units they are printed with, and maps that show them."""

import json
import re
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest

from robolang.execution.plot import LEFT, SHADES, WIDTH, Labels, as_map_svg
from robolang.experiments.inertia import POINTS, AxisInertia, extremes, over_plane, plain
from runtime.core.units import DEG
from runtime.dynamics.equations import axis_gravity, axis_inertia
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, flat, robolang

JOINTS = "10,60,150,-20,40,30"
CARRIED = "2.3,10,-20,95"
PUMA = load_builtin("puma560")
SVG = "{http://www.w3.org/2000/svg}"


def found(*words):
    return json.loads(robolang("inertia", "--robot", "puma560", *words, "--json").stdout)


def carrying(mass, *cog_mm):
    model = ArmModel(PUMA)
    model.set_payload(Payload(mass=mass, cog=np.array(cog_mm) / 1000.0))
    return model


# --- a posture -------------------------------------------------------------------------------------------------------


def test_json_has_the_numbers_of_the_model_in_si():
    out = found("--joints", JOINTS, "--payload", CARRIED)
    assert set(out) == {"robot", "joints_deg", "payload_kg", "axes"}
    assert out["robot"] == "puma560"
    assert out["joints_deg"] == pytest.approx([10, 60, 150, -20, 40, 30])
    assert out["payload_kg"] == 2.3
    model, q = carrying(2.3, 10, -20, 95), np.array([10, 60, 150, -20, 40, 30]) * DEG
    assert [axis["axis"] for axis in out["axes"]] == [1, 2, 3, 4, 5, 6]
    for index, (axis, spec) in enumerate(zip(out["axes"], PUMA.axes, strict=True)):
        D, N, rotor = axis_inertia(model, q, index), spec.motor.gear_ratio, spec.motor.rotor_inertia
        assert axis["link_inertia"] == pytest.approx(D, abs=1e-12)
        assert axis["rotor_inertia"] == pytest.approx(N * N * rotor, rel=1e-12)
        assert axis["motor_inertia"] == pytest.approx(D / N**2 + rotor, rel=1e-12)
        assert axis["gravity"] == pytest.approx(axis_gravity(model, q, index), abs=1e-12)
        assert axis["compensation"] == 0.0
        assert set(axis) == {"axis", "link_inertia", "rotor_inertia", "motor_inertia", "compensation", "gravity"}


def test_the_table_has_the_published_posture_and_fits_80_columns():
    joints = ",".join(repr(float(angle)) for angle in np.rad2deg([1, 2, 3, 4, 5, 6]))
    table = robolang("inertia", "--robot", "puma560", "--joints", joints).stdout
    assert max(map(len, table.splitlines())) <= 80
    assert "…" not in table
    rows = [line.split() for line in table.splitlines() if re.match(r" *J\d ", line)]
    assert [row[0] for row in rows] == ["J1", "J2", "J3", "J4", "J5", "J6"]
    published = [2.6152, 4.3038, 0.9366, 0.1926, 0.1713, 0.1941]
    assert [float(row[1]) + float(row[2]) for row in rows] == pytest.approx(published, rel=1e-3)
    at_motor = np.array(published) / PUMA.per_axis("motor", "gear_ratio") ** 2 / 1e-4
    assert [float(row[3]) for row in rows] == pytest.approx(at_motor, rel=1e-3)
    assert [float(row[4]) for row in rows] == [0.0] * 6
    assert [float(row[5]) for row in rows] == pytest.approx([0, -7.9683, 8.4581, -0.0197, 0.0027, 0], abs=6e-4)
    assert "kg cm2" in table


def test_no_negative_zeros_and_a_posture_in_range_by_default():
    row = AxisInertia(axis=1, link_inertia=1.0, rotor_inertia=1.0, motor_inertia=1.0, compensation=0.0, gravity=-0.0)
    assert "-" not in json.dumps(plain([row]))
    text = robolang("inertia", "--robot", "puma560", "--json").stdout
    assert "-0.0" not in re.findall(r"[-.\de]+", text)
    assert json.loads(text)["joints_deg"] == [0.0] * 6


def test_a_posture_outside_the_ranges_is_a_warning_at_its_number():
    result = robolang("inertia", "--robot", "puma560", "--joints", JOINTS, "--json")
    assert "warning RBL309 --joints" in result.stderr
    assert {"3", "J3", "150", "-225", "45", "deg"} <= fields(result.stderr)
    assert json.loads(result.stdout)["joints_deg"][2] == 150.0


def test_a_payload_over_the_rated_one_is_said_and_taken():
    result = robolang("inertia", "--robot", "puma560", "--payload", "5,0,0,100", "--json")
    assert {"2.5", "kg"} <= fields(result.stderr)
    assert json.loads(result.stdout)["axes"][0]["link_inertia"] > found()["axes"][0]["link_inertia"] + 0.5


# --- maps ------------------------------------------------------------------------------------------------------------


def test_a_map_finds_what_single_postures_have():
    out = found("--map", "J2,J3", "--joints", JOINTS, "--payload", CARRIED)
    assert (out["axis"], out["map"], out["file"]) == (1, [2, 3], None)
    q = out["joints_deg"]
    for name in ("smallest", "largest"):
        at = out[name]
        joints = ",".join(map(str, [q[0], *at["joints_deg"], *q[3:]]))
        single = found("--joints", joints, "--payload", CARRIED)["axes"][0]
        assert at["link_inertia"] == pytest.approx(single["link_inertia"], rel=1e-9)
        assert at["motor_inertia"] == pytest.approx(single["motor_inertia"], rel=1e-9)
    assert out["largest"]["motor_inertia"] > 1.5 * out["smallest"]["motor_inertia"]
    # no posture of the plane is beyond them by more than the grid is coarse
    model, rng = carrying(2.3, 10, -20, 95), np.random.default_rng(3)
    for angles in rng.uniform(PUMA.lower[1:3], PUMA.upper[1:3], (200, 2)):
        D = axis_inertia(model, np.array([0.0, *angles, *np.deg2rad(q[3:])]), 0)
        assert 0.99 * out["smallest"]["link_inertia"] < D < 1.01 * out["largest"]["link_inertia"]


def test_joints_by_number_in_either_order_and_another_axis():
    one, two = found("--map", "5,4", "--axis", "3"), found("--map", "j4, j5", "--axis", "3")
    assert one["axis"] == two["axis"] == 3
    assert one["smallest"]["motor_inertia"] == two["smallest"]["motor_inertia"]
    assert (one["map"], two["map"]) == ([5, 4], [4, 5])
    at = two["smallest"]
    single = found("--joints", ",".join(map(str, [0, 0, 0, *at["joints_deg"], 0])))["axes"][2]
    assert at["link_inertia"] == pytest.approx(single["link_inertia"], rel=1e-9)
    assert at["motor_inertia"] == pytest.approx(single["motor_inertia"], rel=1e-9)


def test_the_values_stand_at_their_angles():
    """Row and column of the grid are not mixed up: J5 matters to J4's inertia, J1 does not."""
    drawn = over_plane(PUMA, 3, (0, 4), np.zeros(6), Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.1])))
    assert drawn.link.shape == (POINTS, POINTS)
    assert (drawn.link == drawn.link[:, :1]).all()
    assert np.ptp(drawn.link[:, 0]) > 0.01
    other = over_plane(PUMA, 3, (4, 0), np.zeros(6), Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.1])))
    assert other.link == pytest.approx(drawn.link.T, rel=1e-12)


def test_a_plane_that_does_not_matter():
    text = robolang("inertia", "--robot", "puma560", "--map", "J1,J2", "--axis", "3").stdout
    assert "everywhere" in text
    drawn = over_plane(PUMA, 2, (0, 1), np.zeros(6), NO_PAYLOAD)
    assert np.ptp(drawn.motor) == 0.0
    at = extremes(drawn)
    assert at["smallest"] == at["largest"]


def test_the_words_of_a_map_and_its_file(tmp_path):
    out = tmp_path / "map.svg"
    text = robolang("inertia", "--robot", "puma560", "--map", "J2,J3", "--out", out).stdout
    smallest, largest = (float(value) for value in re.findall(r"([\d.]+) kg cm2", text))
    assert 5.0 < smallest < largest < 20.0
    assert "J2" in text
    root = ElementTree.fromstring(out.read_text("utf-8"))
    words = [node.text for node in root.iter(f"{SVG}text")]
    assert "kg cm2" in words
    assert f"smallest {smallest:.4g}" in words
    assert f"largest {largest:.4g}" in words
    assert {"-45", "225", "-225", "45"} <= set(words)  # both ranges from end to end
    assert any("J3, deg" in word for word in words)
    first = out.read_bytes()
    robolang("inertia", "--robot", "puma560", "--map", "J2,J3", "--out", out)
    assert out.read_bytes() == first
    assert len(first) < 60_000
    assert [path.name for path in tmp_path.iterdir()] == ["map.svg"]


def test_the_picture_of_the_page_is_the_one_that_its_command_draws(tmp_path):
    page = (ROOT / "docs" / "motor-inertia.md").read_text("utf-8")
    (words,) = re.findall(r"^\.venv/bin/robolang (inertia .*--map.*) --out docs/plots/inertia-map\.svg$", page, re.M)
    robolang(*words.split(), "--out", tmp_path / "map.svg")
    drawn, kept = (
        (folder / name).read_text("utf-8")
        for folder, name in ((tmp_path, "map.svg"), (ROOT / "docs" / "plots", "inertia-map.svg"))
    )
    numbers = [[float(word) for word in re.findall(r"\d+\.?\d*", text)] for text in (drawn, kept)]
    assert len(numbers[0]) == len(numbers[1])
    assert numbers[0] == pytest.approx(numbers[1], abs=0.11)  # another processor may round a tenth the other way


def test_the_table_of_the_page_is_what_the_command_prints():
    page = (ROOT / "docs" / "motor-inertia.md").read_text("utf-8")
    words = re.search(r"^\.venv/bin/robolang (inertia --robot puma560 --joints .*)$", page, re.M)[1]
    printed = robolang(*words.split()).stdout
    assert [line.rstrip() for line in printed.splitlines() if line.strip()] == [
        line
        for text in re.findall(r"^```text\n(.*?)^```$", page, re.M | re.S)
        if "link D" in text
        for line in text.splitlines()
        if line.strip()
    ]


# --- the heat map ----------------------------------------------------------------------------------------------------


def bands(svg):
    """``(colour, [(left, top, right, bottom), ...])`` of every band."""
    out = []
    for node in ElementTree.fromstring(svg).iter(f"{SVG}path"):
        runs = re.findall(r"M([\d.]+) ([\d.]+)H([\d.]+)V([\d.]+)H[\d.]+Z", node.get("d"))
        out.append((node.get("fill"), [tuple(map(float, run)) for run in runs]))
    return out


def test_bands_lie_where_the_values_are():
    x, y = np.linspace(0.0, 10.0, 21), np.linspace(-1.0, 1.0, 5)
    svg = as_map_svg(Labels(title="a < b", x="x", y="y"), "unit", x, y, np.broadcast_to(x, (5, 21)))
    drawn = bands(svg)
    assert len(drawn) == 10
    assert (drawn[0][0], drawn[-1][0]) == (SHADES[0], SHADES[-1])
    right = max(run[2] for run in drawn[0][1])
    for k, (_, runs) in enumerate(drawn):
        assert len(runs) == 5
        assert [run[2] for run in runs] == [right] * 5
        assert [run[0] for run in runs] == pytest.approx([LEFT + k / 10.0 * (right - LEFT)] * 5, abs=0.06)
    tops = [run[1] for run in drawn[0][1]]
    assert tops == sorted(tops, reverse=True)  # y points up
    assert "a &lt; b" in svg
    assert right < WIDTH


def test_bands_upward_and_what_is_not_finite():
    x, y = np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 6)
    values = np.broadcast_to(y[:, None], (6, 4)).copy()
    values[0, 1] = np.nan
    drawn = bands(as_map_svg(Labels(title="t", x="x", y="y"), "unit", x, y, values))
    assert len(drawn[0][1]) == 7  # six rows, the lowest in two pieces
    top = drawn[-1][1]
    assert len(top) == 1
    assert top[0][1] == min(run[3] for run in drawn[0][1]) or top[0][3] == min(run[3] for run in drawn[0][1])


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_values_of_any_size_and_values_that_are_all_one(scale):
    x = np.linspace(0.0, 1.0, 5)
    varied = as_map_svg(Labels(title="t", x="x", y="y"), "unit", x, x, scale * (1.0 + np.outer(x, x)))
    assert 8 <= len(bands(varied)) <= 12
    rounded = scale * (1.0 + 1e-13 * np.outer(x, x))
    for alike in (rounded, np.full((5, 5), scale), np.zeros((5, 5)), np.full((5, 5), np.nan)):
        svg = as_map_svg(Labels(title="t", x="x", y="y"), "unit", x, x, alike)
        assert len(bands(svg)) == 1
        assert "circle" not in svg


# --- refusals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--joints", "1,2,x,4,5,6"), "RBL703 3 --joints"),
        (("--joints", "1,2"), "2"),
        (("--joints", "1,2,3,4,5,nan"), "6"),
        (("--payload", "1,2,3"), "RBL703 --payload"),
        (("--payload", "-1,0,0,0"), "RBL703 --payload"),
        (("--payload", "1,0,0,9000"), "RBL703 --payload"),
        (("--map", "J2"), "RBL703 --map 2 J2 J3 1"),
        (("--map", "J2,J3,J4"), "3"),
        (("--map", "J2,J7"), "RBL703 --map 2 J7 J1 J6"),
        (("--map", "J0,J3"), "RBL703 --map 1"),
        (("--map", "elbow,J3"), "RBL703 --map 1 elbow"),
        (("--map", "J³,J2"), "RBL703 --map 1"),
        (("--map", "J2,J٣"), "RBL703 --map 2"),
        (("--map", "J3,3"), "RBL703 --map 2"),
        (("--map", "J2,J3", "--axis", "7"), "RBL703 7 --axis 1 6"),
        (("--map", "J2,J3", "--axis", "0"), "RBL703 --axis"),
        (("--axis", "2"), "RBL703 --axis"),
        (("--out", "map.svg"), "RBL703 --out"),
        (("--map", "J2,J3", "--out", "map.png"), "RBL703 --out map.png .svg"),
    ],
)
def test_a_value_that_cannot_be_used_is_located(words, said):
    result = robolang("inertia", "--robot", "puma560", *words, code=2)
    assert set(said.split()) <= fields(flat(result.stderr))
    assert result.stdout == ""


def test_a_robot_that_is_not_there():
    assert "RBL708" in robolang("inertia", "--robot", "puma", code=2).stderr
    assert "RBL600" in robolang("inertia", "--robot", "none.toml", code=2).stderr


def test_a_picture_that_cannot_be_written(tmp_path):
    result = robolang("inertia", "--robot", "puma560", "--map", "J2,J3", "--out", tmp_path / "no" / "m.svg", code=4)
    assert "RBL706" in result.stderr
    assert result.stdout == ""


def test_importing_the_command_loads_no_numerics():
    heavy = ("numpy", "pinocchio", "mujoco", "ruckig", "rich.table")
    code = f"import sys, robolang.cli.commands.inertia; print([m for m in {heavy} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"


def test_a_compensation_takes_the_place_of_the_rotor(tmp_path):
    """Jc of J1 is 3e-4 kg m2, the rotor of the file 2e-4; the others keep what they have."""
    rows = "".join(f"[[axes]]\ncompensation_kg_m2 = {value}\n" for value in (3e-4, 2e-4, 2e-4, 33e-6, 33e-6, 33e-6))
    file = tmp_path / "p.compensation.toml"
    head = 'schema = 1\nrobot = "puma560"\npositions = 5\n[payload]\nmass_kg = 0.0\ncog_mm = [0, 0, 0]\n'
    file.write_text(head + rows)
    words = ("inertia", "--robot", "puma560", "--joints", "0,45,-90,0,45,0", "--json")
    bare, found = (json.loads(robolang(*words, *more).stdout)["axes"] for more in ((), ("--compensation", file)))
    assert [axis["compensation"] for axis in bare] == [0.0] * 6
    assert found[0]["compensation"] == pytest.approx(3e-4)
    assert found[0]["motor_inertia"] - bare[0]["motor_inertia"] == pytest.approx(1e-4)
    assert found[1]["motor_inertia"] == pytest.approx(bare[1]["motor_inertia"])
    assert "RBL617" in robolang("inertia", "--robot", "irb2400", "--compensation", file, code=2).stderr
    mapped = ("--map", "J2,J3", "--compensation", file)
    assert "RBL703" in robolang("inertia", "--robot", "puma560", *mapped, code=2).stderr
