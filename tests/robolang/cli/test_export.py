"""``robolang export pulses``: files, summary, refusals, and a folder that is whole or not there."""

import errno
import json
import os
import shutil

import numpy as np
import pytest

from robolang.cli.commands.export import written_here
from robolang.core import storage
from robolang.core.storage import write_folder
from runtime.core.faults import Fault
from runtime.robot.files.loader import load_builtin
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, flat, places, robolang, shell

PICK = ROOT / "programs/pick_and_place.rbl"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pulses") / "out"
    return folder, robolang("export", "pulses", PICK, "-o", folder)


def rows(path):
    lines = [line for line in path.read_text("utf-8").splitlines() if not line.startswith("#")]
    assert lines[0] == "control,frequency_hz,target_pulses,steps"
    return [(row[0], *map(int, row[1:])) for row in (line.split(",") for line in lines[1:])]


def test_the_folder_has_what_the_manifest_names(made):
    folder, _ = made
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    named = {"manifest.json"}
    for entry in manifest["sequence"]:
        for table in ("tables", "f174"):
            named |= {name for name in entry.get(table, {}).values() if name is not None}
    assert named == {item.name for item in folder.iterdir()}
    assert all(written_here(name) for name in named)
    kinds = [(entry["kind"], entry["number"]) for entry in manifest["sequence"]]
    assert kinds == [
        ("marker", 10),
        ("marker", 20),
        ("move", 30),
        ("marker", 40),
        ("marker", 50),
        ("move", 60),
        ("move", 70),
        ("marker", 80),
        ("marker", 90),
        ("move", 100),
        ("move", 110),
    ]
    load, hand = manifest["sequence"][4]["load"], manifest["sequence"][3]
    assert load == {"mass_kg": 2.3, "cog_mm": [0.0, 0.0, 95.0]}
    assert (hand["hand"], hand["dwell_s"]) == ("on", 0.3)


def test_the_tables_lead_from_home_to_the_end_without_a_gap(made):
    folder, _ = made
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    spec = load_builtin("puma560")
    for k, channel in enumerate(manifest["channels"]):
        assert channel["per_pulse"] == pytest.approx(360.0 / (2000.0 * abs(spec.axes[k].motor.gear_ratio)))
        at = channel["start_pulses"]
        for entry in manifest["sequence"]:
            if entry["kind"] == "marker" or entry["tables"][channel["name"]] is None:
                continue
            found = rows(folder / entry["tables"][channel["name"]])
            assert sum(row[3] for row in found) == entry["steps"]
            for control, frequency, target, steps in found:
                if control in ("up", "down"):
                    assert abs(target - at) * 100 == frequency >= channel["min_hz"]
                    assert (target > at) is (control == "up")
                    assert steps == 1
                else:
                    assert (target, frequency) == (at, 0)
                at = target
        # home, and the last point that a program ends at: P5 is taught where home is
        assert abs(at - channel["start_pulses"]) <= 2 + 0.02 / channel["per_pulse"]


def test_every_data_table_of_the_plc_is_one_stretch_of_the_neutral_one(made):
    folder, _ = made
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    checked = 0
    for entry in (entry for entry in manifest["sequence"] if entry["kind"] == "move"):
        for name, file in entry["f174"].items():
            neutral = [row for row in rows(folder / entry["tables"][name]) if row[0] in ("up", "down")]
            lines = [line.split(",") for line in (folder / file).read_text("utf-8").splitlines() if line[0].isdigit()]
            values = [line[3] for line in lines]
            frequencies = [value for value, line in zip(values, lines, strict=True) if line[4].startswith("frequency")]
            targets = [value for value, line in zip(values, lines, strict=True) if line[4].startswith("target")]
            assert [int(value) for value in frequencies] == [row[1] for row in neutral]
            assert [int(value) for value in targets] == [row[2] for row in neutral]
            assert lines[0][3][3:].isdigit()
            assert lines[-1][3:] == ["0", "end"]
            checked += 1
    assert checked > 10


def test_the_summary_fits_80_columns_and_says_what_was_done(made):
    _, result = made
    assert {"puma560", "10", "ms"} <= fields(result.stdout.splitlines()[0])
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80  # the last names the folder
    for words in ("30 MOVE P1", "40 HAND ON", "6 markers"):
        assert words in flat(result.stdout)


def test_json_has_the_same_figures(tmp_path):
    found = json.loads(robolang("export", "pulses", PICK, "-o", tmp_path / "x", "--json").stdout)
    assert [move["number"] for move in found["moves"]] == [30, 60, 70, 100, 110]
    assert [marker["text"] for marker in found["markers"]][:2] == ["LOAD (0, 0, 60), 0.8", "HAND OFF"]
    move = found["moves"][0]
    assert move["seconds"] == pytest.approx(move["steps"] * 0.01)
    assert 0.0 < move["error_mm"] < 0.1
    assert {channel["name"] for channel in move["channels"]} == {f"J{k}" for k in range(1, 7)}


@pytest.mark.parametrize(("name", "joints"), [("scara", 4), ("cylindrical", None), ("xy", None)])
def test_other_machines_run_what_they_have_joints_for(tmp_path, name, joints):
    """The program lifts and turns its part: a SCARA can, a cylindrical arm cannot turn it, a table cannot lift it."""
    result = robolang("export", "pulses", PICK, "-o", tmp_path / "x", "--channels", name, code=0 if joints else 3)
    if joints:
        assert len(json.loads((tmp_path / "x/manifest.json").read_text("utf-8"))["channels"]) == joints
        return
    assert [(line, code) for line, _, code in places(result.stderr)] == [(9, "RBL431")]
    assert not (tmp_path / "x").exists()


def program(tmp_path, text, points=""):
    path = tmp_path / "job.rbl"
    path.write_text(text, "utf-8")
    (tmp_path / "job.points.toml").write_text(points or PICK.with_suffix(".points.toml").read_text("utf-8"), "utf-8")
    shutil.copy(PICK.with_suffix(".cell.toml"), tmp_path / "job.cell.toml")
    return path


def test_a_frequency_too_high_is_refused_at_its_move_with_a_speed_that_fits(tmp_path):
    channels = tmp_path / "f.toml"
    rows = "".join(f'[[channels]]\njoint = "J{k}"\nmax_hz = 9000\n' for k in range(1, 7))
    channels.write_text(f"schema = 1\n{rows}", "utf-8")
    path = program(tmp_path, "10 MOVE P1\n20 MOVE P2\n")
    words = ("export", "pulses", path, "-o", tmp_path / "x", "--channels", channels)
    result = robolang(*words, code=3)
    assert places(result.stderr) == [(1, 4, "RBL430")]
    speed = result.stderr.split("SPEED ")[1].split(" ")[0]
    path.write_text(f"10 MOVE P1, SPEED {speed}\n", "utf-8")
    robolang(*words)


def test_a_tool_before_the_first_move_is_that_of_the_tables(tmp_path):
    """The flange makes the same moves by a tool that is 50 mm longer and points that are 50 mm lower."""
    longer = "TOOL POSE(0, 0, 163.7, 0, 0, 0)\n"
    path = program(tmp_path, longer + "10 MOVE POSE(480, -220, 690, 180, 0, 180)\n")
    robolang("export", "pulses", path, "-o", tmp_path / "x")
    tool = json.loads((tmp_path / "x" / "manifest.json").read_text("utf-8"))["mechanism"]["X_flange_tool"]
    assert tool[2][3] == pytest.approx(0.1637)
    # the same one again changes nothing, another one is refused where it stands
    path.write_text(path.read_text() + longer + "20 MOVE POSE(480, -220, 740, 180, 0, 180)\n")
    robolang("export", "pulses", path, "-o", tmp_path / "y")
    path.write_text(path.read_text() + "TOOL POSE(0, 0, 100, 0, 0, 0)\n")
    result = robolang("export", "pulses", path, "-o", tmp_path / "z", code=3)
    assert [(line, code) for line, _, code in places(result.stderr)] == [(5, "RBL431")]


def test_what_a_table_cannot_carry_is_refused_at_its_place(tmp_path):
    result = robolang("export", "pulses", ROOT / "programs/wrist/seam.rbl", "-o", tmp_path / "x", code=3)
    assert [(line, code) for line, _, code in places(result.stderr)] == [(5, "RBL431")]
    assert not (tmp_path / "x").exists()
    points = "schema = 1\n[points.P1]\njoints = [0, 90, -180, 0, 45, 0]\n"
    path = program(tmp_path, "10 MOVE P1\n", points)
    result = robolang("export", "pulses", path, "-o", tmp_path / "x", "--channels", "scara", code=3)
    assert [(line, code) for line, _, code in places(result.stderr)] == [(1, "RBL431")]


def test_a_program_with_errors_is_not_exported(tmp_path):
    path = program(tmp_path, "10 MOVE\n20 MOVE P9\n")
    result = robolang("export", "pulses", path, "-o", tmp_path / "x", code=1)
    assert {line for line, _, _ in places(result.stderr)} == {1, 2}
    assert not (tmp_path / "x").exists()


def test_an_empty_program_gives_a_manifest_alone(tmp_path):
    path = program(tmp_path, "10 HAND ON\n")
    robolang("export", "pulses", path, "-o", tmp_path / "x")
    assert [item.name for item in (tmp_path / "x").iterdir()] == ["manifest.json"]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--step", "7ms"), "7 ms"),
        (("--step", "fast"), "10ms"),
        (("--step", "0.1ms"), "1 1000 ms"),
        (("--plc", "s7"), "f174"),
        (("--fmin", "0"), "1 100000"),
        (("--fmin", "nan"), "1 100000"),
        (("--plot", "x.png"), ".svg .html"),
    ],
)
def test_options_that_cannot_be_are_refused(tmp_path, words, says):
    result = robolang("export", "pulses", PICK, "-o", tmp_path / "x", *words, code=2)
    assert set(says.split()) <= fields(flat(result.stderr))
    assert not (tmp_path / "x").exists()


def test_a_channel_file_without_a_joint_is_refused_at_its_end(tmp_path):
    channels = tmp_path / "f.toml"
    channels.write_text('schema = 1\n[[channels]]\njoint = "J1"\n', "utf-8")
    result = robolang("export", "pulses", PICK, "-o", tmp_path / "x", "--channels", channels, code=2)
    assert {"RBL608", "J2", "puma560"} <= fields(result.stderr)
    channels.write_text('schema = 1\nmechanism = "delta"\n[[channels]]\njoint = "J1"\n', "utf-8")
    result = robolang("export", "pulses", PICK, "-o", tmp_path / "x", "--channels", channels, code=2)
    assert f"{channels}:2:1: error RBL610 " in result.stderr
    assert "delta" in fields(result.stderr)


def test_a_mechanism_file_beside_the_channels_is_used(tmp_path):
    from runtime.pulses.mechanism import _folder

    (tmp_path / "m.toml").write_text(_folder().joinpath("scara.toml").read_text("utf-8"), "utf-8")
    channels = tmp_path / "f.toml"
    rows = "".join(f'[[channels]]\njoint = "{name}"\n' for name in ("theta1", "theta2", "z", "theta4"))
    channels.write_text(f'schema = 1\nmechanism = "m.toml"\n{rows}', "utf-8")
    robolang("export", "pulses", PICK, "-o", tmp_path / "x", "--channels", channels)
    assert json.loads((tmp_path / "x/manifest.json").read_text("utf-8"))["mechanism"]["l1_mm"] == pytest.approx(325.0)


# --- the folder ------------------------------------------------------------------------------------------------------


def test_an_export_replaces_an_earlier_one_and_nothing_else(tmp_path):
    folder = tmp_path / "x"
    robolang("export", "pulses", PICK, "-o", folder)
    robolang("export", "pulses", PICK, "-o", folder, "--plc", "none")
    assert not [item for item in folder.iterdir() if "f174" in item.name]
    (folder / "notes.txt").write_text("mine", "utf-8")
    before = sorted(item.name for item in folder.iterdir())
    assert "RBL706" in robolang("export", "pulses", PICK, "-o", folder, code=4).stderr
    assert sorted(item.name for item in folder.iterdir()) == before
    assert sorted(item.name for item in tmp_path.iterdir()) == ["x"]


@pytest.mark.parametrize("target", ["file", "link", "missing/x"])
def test_a_place_that_is_no_folder_is_refused(tmp_path, target):
    (tmp_path / "file").write_text("x", "utf-8")
    (tmp_path / "link").symlink_to(tmp_path)
    result = robolang("export", "pulses", PICK, "-o", tmp_path / target, code=4)
    assert "RBL706" in result.stderr
    assert sorted(item.name for item in tmp_path.iterdir()) == ["file", "link"]


@pytest.mark.parametrize("there", [False, True])
def test_a_full_disk_leaves_what_was_there(tmp_path, monkeypatch, there):
    folder = tmp_path / "x"
    if there:
        write_folder(folder, {"manifest.json": b"old"}, written_here)
    calls = []

    def full(handle):
        calls.append(handle)
        if len(calls) > 1:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("robolang.core.storage.os.fsync", full)
    with pytest.raises(Fault, match=os.strerror(errno.ENOSPC)) as caught:
        write_folder(folder, {"manifest.json": b"new", "1_line2_J1.csv": b"row"}, written_here)
    assert caught.value.code == "RBL706"
    assert [item.name for item in tmp_path.iterdir()] == (["x"] if there else [])
    if there:
        assert (folder / "manifest.json").read_bytes() == b"old"


def test_a_folder_that_cannot_take_its_name_is_put_back(tmp_path, monkeypatch):
    folder = tmp_path / "x"
    write_folder(folder, {"manifest.json": b"old"}, written_here)
    replace, calls = type(folder).replace, []

    def refuse(self, target):
        calls.append(target)
        if len(calls) == 2:
            raise PermissionError(errno.EACCES, "no")
        return replace(self, target)

    def refuse_exchange(one, other):
        raise PermissionError(errno.EACCES, "no")

    monkeypatch.setattr(type(folder), "replace", refuse)
    for exchange in (lambda one, other: False, refuse_exchange):  # a system without an exchange in one step, and one
        monkeypatch.setattr(storage, "_exchange", exchange)
        with pytest.raises(Fault, match="RBL706"):
            write_folder(folder, {"manifest.json": b"new"}, written_here)
        assert (folder / "manifest.json").read_bytes() == b"old"
        assert [item.name for item in tmp_path.iterdir()] == ["x"]


def test_a_folder_is_replaced_where_the_system_has_no_exchange(tmp_path, monkeypatch):
    monkeypatch.setattr(storage, "_exchange", lambda one, other: False)
    for text in (b"old", b"new"):
        write_folder(tmp_path / "x", {"manifest.json": text}, written_here)
        assert (tmp_path / "x" / "manifest.json").read_bytes() == text
        assert [item.name for item in tmp_path.iterdir()] == ["x"]


def test_the_same_program_gives_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        robolang("export", "pulses", PICK, "-o", tmp_path / name)
    for item in (tmp_path / "a").iterdir():
        assert item.read_bytes() == (tmp_path / "b" / item.name).read_bytes()


def test_an_arm_that_changes_its_wrist_is_exported_with_it(tmp_path):
    found = json.loads(
        robolang("export", "pulses", ROOT / "programs/wrist/e1.rbl", "-o", tmp_path / "x", "--json").stdout
    )
    (move,) = found["moves"]
    assert move["error_mm"] < 0.05
    turned = {channel["name"]: channel["pulses"] for channel in move["channels"]}
    assert np.abs(turned["J4"]) * 0.00225 > 60.0


def test_a_loop_is_shown_in_the_order_that_it_runs(tmp_path):
    program = tmp_path / "loop.rbl"
    program.write_text("FOR n = 0 TO 1\nHAND ON\nHAND OFF\nNEXT\n", "utf-8")
    shown = robolang("export", "pulses", program, "-o", tmp_path / "x").stdout
    hands = [line.split()[2] for line in shown.splitlines() if "HAND" in line]
    assert hands == ["ON", "OFF", "ON", "OFF"]


def test_nothing_heavy_is_imported_for_help():
    result = shell("export", "pulses", "--help")
    assert result.returncode == 0
    assert "--channels" in result.stdout


def test_what_has_no_value_is_refused_at_its_statement_with_the_calls_that_led_there(tmp_path):
    path = program(tmp_path, "3 X = 0\n4 CALL S\n5 END\n6 SUB S\n7 IF X = 0 THEN PRINT 1 / X\n8 ENDSUB\n")
    result = robolang("export", "pulses", path, "-o", tmp_path / "out", code=3)
    assert places(result.stderr) == [(5, 17, "RBL501")]
    assert f"{path}:2:3: note: " in result.stderr
