"""Folders of pulse tables that are read, and everything else that is refused at its place."""

import json
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.faults import lookup
from runtime.core.tomlfile import FileFault
from runtime.pulses.folder import read_export
from runtime.pulses.replay import replay
from tests.campaign import examples
from tests.messages import fields
from tests.runtime.pulses import ARM, X_TABLE, Y_TABLE, Handmade, csv, pose, rows, staircase


def fault(folder):
    with pytest.raises(FileFault) as caught:
        read_export(folder)
    return caught.value


# --- what is refused: the manifest -----------------------------------------------------------------------------------


def without(*keys):
    def change(manifest):
        for key in keys[:-1]:
            manifest = manifest[key]
        del manifest[keys[-1]]

    return change


def put(*keys_and_value):
    *keys, last, value = keys_and_value

    def change(manifest):
        for key in keys:
            manifest = manifest[key]
        manifest[last] = value

    return change


def standing(*keys, steps):
    """A move in which no channel moves, for so many steps."""

    def change(manifest):
        put(*keys, "tables", {"X": None, "Y": None})(manifest)
        put(*keys, "steps", steps)(manifest)

    return change


CHANNEL = ("channels", 1)
LOAD, HAND, MOVE = ("sequence", 0), ("sequence", 1), ("sequence", 2)
BAD_MANIFESTS = [
    (without("schema"), "schema", "RBL630"),
    (put("schema", "1"), "schema 1", "RBL630"),
    (put("schema", True), "schema 1", "RBL630"),
    (put("schema", 2), "schema 2 1", "RBL633"),
    (put("schema", 0), "schema 0", "RBL633"),
    (put("schema", 10**30), "schema 100", "RBL633"),
    (without("program"), "program", "RBL630"),
    (put("program", None), "program", "RBL630"),
    (put("mechanism", []), "mechanism", "RBL630"),
    (put("mechanism", "kind", "delta"), "mechanism.kind delta", "RBL630"),
    (put("mechanism", "name", 3), "mechanism.name", "RBL630"),
    (put("mechanism", "axes", ["x", "w"]), "mechanism.axes w", "RBL630"),
    (put("mechanism", "axes", ["x", "x"]), "mechanism.axes x", "RBL630"),
    (put("mechanism", "axes", ["x", [1]]), "mechanism.axes", "RBL630"),
    (put("mechanism", "axes", []), "mechanism.axes", "RBL630"),
    (put("mechanism", "axes", ["x"]), "mechanism.y_mm", "RBL630"),
    (without("mechanism", "z_mm"), "mechanism.z_mm", "RBL630"),
    (put("mechanism", {"kind": "cylindrical", "name": "", "axes": ["r", "theta"]}), "", "RBL630"),
    (
        put("mechanism", {"kind": "scara", "name": "", "axes": ["theta1", "theta2"], "l1_mm": 1, "z_mm": 1}),
        "mechanism.l2_mm",
        "RBL630",
    ),
    (put("mechanism", {**ARM, "placements": []}), "mechanism.placements", "RBL630"),
    (put("mechanism", {**ARM, "placements": [pose(), 3]}), "mechanism.placements.2 4", "RBL630"),
    (
        put("mechanism", {**ARM, "placements": [pose(), [[1, 0, 0]] * 4]}),
        "mechanism.placements.2.1",
        "RBL630",
    ),
    (
        put("mechanism", {**ARM, "X_last_flange": pose(turn=((2, 0, 0), (0, 1, 0), (0, 0, 1)))}),
        "",
        "RBL630",
    ),
    (
        put("mechanism", {**ARM, "X_last_flange": pose(turn=((-1, 0, 0), (0, 1, 0), (0, 0, 1)))}),
        "",
        "RBL630",
    ),
    (
        put("mechanism", {**ARM, "X_flange_tool": [*pose()[:3], [0, 0, 1, 1]]}),
        "mechanism.X_flange_tool",
        "RBL630",
    ),
    (put("mechanism", ARM), "channels.1.unit", "RBL630"),
    (put("mechanism", {**ARM, "placements": [pose()]}), "channels 2 1", "RBL630"),
    (put("step_s", 0.03), "step_s s 0.03", "RBL630"),
    (put("step_s", 0), "step_s 0 0.0001 1", "RBL630"),
    (put("step_s", "10 ms"), "step_s", "RBL630"),
    (put("step_s", True), "step_s", "RBL630"),
    (put("channels", {}), "channels", "RBL630"),
    (put("channels", [1, 2]), "channels.1", "RBL630"),
    (put(*CHANNEL, "name", "X"), "channels.1.name X", "RBL630"),
    (put(*CHANNEL, "name", ""), "channels.2.name 1 40", "RBL630"),
    (put(*CHANNEL, "name", "\x1b[2J"), "channels.2.name 1 40", "RBL630"),
    (put(*CHANNEL, "unit", "inch"), "channels.2.unit inch", "RBL630"),
    (put(*CHANNEL, "unit", "deg"), "channels.2.unit", "RBL630"),
    (put(*CHANNEL, "per_pulse", 0), "channels.2.per_pulse 0", "RBL630"),
    (put(*CHANNEL, "per_pulse", 10**400), "channels.2.per_pulse 1329", "RBL630"),
    (put(*CHANNEL, "min_hz", -1), "channels.2.min_hz -1 0", "RBL630"),
    (put(*CHANNEL, "max_hz", 1), "channels.2.max_hz 1 1.5", "RBL630"),
    (put(*CHANNEL, "start_pulses", 50.0), "channels.2.start_pulses", "RBL630"),
    (put(*CHANNEL, "start_pulses", None), "channels.2.start_pulses", "RBL630"),
    (put(*CHANNEL, "start_pulses", 10**16), "channels.2.start_pulses 10000000000000000", "RBL630"),
    (put("sequence", None), "sequence", "RBL630"),
    (put(*LOAD, "kind", "weld"), "sequence.1.kind weld", "RBL630"),
    (put(*LOAD, "line", 0), "sequence.1.line 0", "RBL630"),
    (without(*LOAD, "number"), "sequence.1.number", "RBL630"),
    (put(*LOAD, "number", "10"), "sequence.1.number", "RBL630"),
    (without(*LOAD, "load"), "sequence.1.load hand other", "RBL630"),
    (put(*LOAD, "hand", "on"), "sequence.1.load hand other", "RBL630"),
    (put(*LOAD, "load", {"mass_kg": -1, "cog_mm": [0, 0, 0]}), "sequence.1.load.mass_kg -1", "RBL630"),
    (put(*LOAD, "load", {"mass_kg": 1, "cog_mm": [0, 0]}), "sequence.1.load.cog_mm 3 2", "RBL630"),
    (put(*HAND, "hand", "open"), "sequence.2.hand open", "RBL630"),
    (put(*HAND, "dwell_s", 601), "sequence.2.dwell_s 601", "RBL630"),
    (put(*MOVE, "text", 3), "sequence.3.text", "RBL630"),
    (put(*MOVE, "steps", -1), "sequence.3.steps -1", "RBL630"),
    (standing(*MOVE, steps=10**6), "sequence.4.steps 4 1000000", "RBL630"),
    (put(*MOVE, "start_mm", [1, 2, "3"]), "sequence.3.start_mm", "RBL630"),
    (put(*MOVE, "end_mm", [1, 2]), "sequence.3.end_mm 3 2", "RBL630"),
    (put(*MOVE, "tables", None), "sequence.3.tables", "RBL630"),
    (without(*MOVE, "tables", "X"), "sequence.3.tables.X", "RBL630"),
    (put(*MOVE, "tables", "Z", None), "sequence.3.tables.Z X Y", "RBL630"),
    (put(*MOVE, "tables", "X", 3), "sequence.3.tables.X", "RBL630"),
    (put(*MOVE, "tables", "X", Y_TABLE), "sequence.3.tables.Y 01_line30_Y.csv", "RBL630"),
    *(
        (put(*MOVE, "tables", "X", name), "sequence.3.tables.X", "RBL630")
        for name in ("", ".", "..", "../x.csv", "/etc/passwd", "a/b.csv", "a\\b.csv", "C:x.csv", "\\\\host\\x", "a\0b")
    ),
    (put(*MOVE, "tables", "X", "\ud800.csv"), "", "RBL630"),
    (put(*MOVE, "tables", "X", "x" * 300), "", "RBL630"),
]


@pytest.mark.parametrize(("change", "said", "code"), BAD_MANIFESTS, ids=[said for _, said, _ in BAD_MANIFESTS])
def test_a_manifest_that_cannot_be_is_refused_by_its_key(tmp_path, change, said, code):
    export = staircase()
    manifest = export.manifest
    folder = export.write(tmp_path / "out")
    change(manifest)
    (folder / "manifest.json").write_text(json.dumps(manifest), "utf-8")
    found = fault(folder)
    assert (found.code, found.line, found.column) == (code, 1, 1)
    assert set(said.split()) <= fields(found.message)
    assert found.hint
    assert Path(found.path).parent == folder


BAD_JSON = [
    (b"", 1, 1, "JSON"),
    (b'{\n "schema": 1,\n "step_s": }', 3, 12, "JSON"),
    (b"[1, 2]", 1, 1, ""),
    (b"\xef\xbb\xbf{}", 1, 1, "JSON UTF-8 BOM"),
    (b'{\n "schema": 1,\n "step_s": NaN}', 3, 12, "JSON"),
    (b'{"a": "NaN \\" Infinity",\n\n "step_s": -Infinity}', 3, 12, ""),
    (b'{"step_s": 1e999}', 1, 1, "1e999"),
    (b'{"a": ' + b"9" * 5000 + b"}", 1, 1, "JSON"),
    (b'{"schema": 1, "schema": 1}', 1, 1, "schema"),
    (b'{"a":' * 100_000, 1, 1, ""),
    (b'{\n\n"a": "\xff"}', 3, 1, "UTF-8 9"),
    ('{"schema": 1}'.encode("utf-16"), 1, 1, "UTF-8 0"),
]


@pytest.mark.parametrize(("raw", "line", "column", "said"), BAD_JSON, ids=[said for *_, said in BAD_JSON])
def test_what_is_no_strict_json_is_refused_at_its_line(tmp_path, raw, line, column, said):
    folder = staircase().write(tmp_path / "out")
    (folder / "manifest.json").write_bytes(raw)
    found = fault(folder)
    assert (found.code, found.line, found.column) == ("RBL630", line, column)
    assert set(said.split()) <= fields(found.message)


# --- what is refused: files ------------------------------------------------------------------------------------------


def huge(path, size):
    with path.open("wb") as stream:
        stream.truncate(size)


BAD_FILES = [
    (lambda path: None, ""),
    (lambda path: path.mkdir(), ""),
    (os.mkfifo, ""),
    (lambda path: path.symlink_to("/dev/zero"), ""),
    (lambda path: path.symlink_to(path.parent / "other"), ""),
    (lambda path: huge(path, 64_000_001), "64000001"),
    (lambda path: path.write_bytes(b"# \xc3\x28"), "UTF-8 2"),
]
IDS = ["missing", "folder", "pipe", "device", "link", "huge", "binary"]


@pytest.mark.parametrize(("make", "said"), BAD_FILES, ids=IDS)
@pytest.mark.parametrize("name", ["manifest.json", X_TABLE])
def test_what_is_no_small_text_file_is_refused_without_waiting(tmp_path, name, make, said):
    folder = staircase().write(tmp_path / "out")
    path = folder / name
    path.rename(folder / "other")
    make(path)
    found = fault(folder)
    assert (found.code, found.line, found.column, found.path) == ("RBL630", 1, 1, str(path))
    assert set(said.split()) <= fields(found.message)


def test_the_manifest_is_smaller_than_a_table(tmp_path):
    folder = staircase().write(tmp_path / "out")
    huge(folder / "manifest.json", 16_000_001)
    assert {"16000001", "16000000"} <= fields(fault(folder).message)


def test_a_folder_is_needed(tmp_path):
    (tmp_path / "file").write_text("{}")
    for path, said in (
        (tmp_path / "none", "No such file"),
        (tmp_path / "file", "is not a folder"),
        (tmp_path / "a\0b", "null"),
    ):
        found = fault(path)
        assert (found.code, found.path) == ("RBL630", str(path))
        assert said in found.message


# --- what is refused: tables -----------------------------------------------------------------------------------------


def replace_line(line, text):
    """The change of a table that puts ``text`` in place of a line; None takes the line away."""

    def change(lines):
        lines[line - 1 : line] = [] if text is None else [text]

    return change


# the table of Y: 4 wait at 50, 5 down to -150, 6 wait, 7 down to -350, 8 wait, 9 down to -550, 10 end
BAD_TABLES = [
    (replace_line(3, None), 3, 1, "RBL631", "frequency_hz target_pulses"),
    (replace_line(3, "control,frequency,target,steps"), 3, 1, "RBL631", ""),
    (replace_line(5, ""), 5, 1, "RBL631", "4 frequency_hz target_pulses 0"),
    (replace_line(5, "down,20000,-150"), 5, 1, "RBL631", "3"),
    (replace_line(5, "down,20000,-150,1,1"), 5, 1, "RBL631", "5"),
    (replace_line(5, "left,20000,-150,1"), 5, 1, "RBL631", "left"),
    (replace_line(5, "Down,20000,-150,1"), 5, 1, "RBL631", "Down"),
    (replace_line(5, "down,2e4,-150,1"), 5, 6, "RBL631", "frequency_hz 2e4 0"),
    (replace_line(5, "down,-20000,-150,1"), 5, 6, "RBL631", "frequency_hz -20000"),
    (replace_line(5, "down,020000,-150,1"), 5, 6, "RBL631", "frequency_hz 020000"),
    (replace_line(5, "down,20000,-150.0,1"), 5, 12, "RBL631", "target_pulses -150.0"),
    (replace_line(5, "down,20000, -150,1"), 5, 12, "RBL631", "target_pulses -150"),
    (replace_line(5, "down,20000,-0,1"), 5, 12, "RBL631", "target_pulses -0"),
    (replace_line(5, "down,20000,-1000000000000000,1"), 5, 12, "RBL631", "15"),
    (replace_line(5, "down,20000,-150,one"), 5, 17, "RBL631", "one"),
    (replace_line(5, "down,20000,-150,\u0661"), 5, 17, "RBL631", "١"),
    (replace_line(5, "down,20000,-150,2"), 5, 17, "RBL631", "down 1 2"),
    (replace_line(5, "up,20000,-150,1"), 5, 10, "RBL631", "up 50 -150"),
    (replace_line(5, "down,20000,250,1"), 5, 12, "RBL631", "down 50 250"),
    (replace_line(5, "down,20000,50,1"), 5, 12, "RBL631", "down 50"),
    (replace_line(5, "down,1,-150,1"), 5, 6, "RBL631", "1 Hz 1.5 100000 Y"),
    (replace_line(5, "down,100001,-150,1"), 5, 6, "RBL631", "100001 Hz"),
    (replace_line(5, "down,20001,-150,1"), 5, 6, "RBL632", "20001 Hz 9.9995 ms 10"),
    (replace_line(5, "down,20000,-149,1"), 5, 6, "RBL632", "50 -149 20000 Hz 9.95 ms"),
    (replace_line(6, "wait,100,-150,1"), 6, 6, "RBL631", "wait 100 Hz"),
    (replace_line(6, "wait,0,-151,1"), 6, 8, "RBL631", "wait -150 -151"),
    (replace_line(6, "wait,0,-150,0"), 6, 13, "RBL631", "wait 0"),
    (replace_line(6, "wait,0,-150,2"), 10, 1, "RBL632", "Y 7 6"),
    (replace_line(6, "wait,0,-150,999999999999999"), 10, 1, "RBL632", "Y 1000000000000004"),
    (replace_line(6, None), 9, 1, "RBL632", "Y 5 6"),
    (replace_line(10, None), 9, 18, "RBL631", ""),
    (replace_line(10, "end,0,-551,0"), 10, 7, "RBL631", "end -550 -551"),
    (replace_line(10, "end,0,-550,1"), 10, 12, "RBL631", "end 1"),
    (replace_line(10, "end,5,-550,0"), 10, 5, "RBL631", "end"),
    (replace_line(10, "end,0,-550,0\nend,0,-550,0"), 11, 1, "RBL631", ""),
    (replace_line(8, "end,0,-350,0"), 9, 1, "RBL631", ""),
    (replace_line(10, "end,0,-550,0\n"), 11, 1, "RBL631", ""),
    # where the channel stood before the table
    (replace_line(4, "wait,0,51,1"), 4, 8, "RBL632", "Y 50 51"),
    (replace_line(4, "end,0,51,0"), 4, 7, "RBL632", "Y 50 51"),
    (replace_line(4, "down,20000,-149,1"), 4, 6, "RBL632", "50 Y -149 20000 Hz"),
    (replace_line(4, "up,20000,-150,1"), 4, 10, "RBL631", "up 50 Y -150"),
]


@pytest.mark.parametrize(("change", "line", "column", "code", "said"), BAD_TABLES, ids=[bad[4] for bad in BAD_TABLES])
def test_a_table_that_cannot_be_is_refused_at_its_row(tmp_path, change, line, column, code, said):
    folder = staircase().write(tmp_path / "out")
    lines = (folder / Y_TABLE).read_text("utf-8").splitlines()
    change(lines)
    text = "\n".join(lines) + "\n"
    (folder / Y_TABLE).write_text(text, "utf-8")
    found = fault(folder)
    assert (found.code, found.line, found.column) == (code, line, column), found.message
    assert set(said.split()) <= fields(found.message)
    assert found.path == str(folder / Y_TABLE)
    assert found.excerpt == (text.split("\n")[line - 1] if line <= text.count("\n") else "")


def test_a_table_without_a_single_line_of_data_is_refused(tmp_path):
    folder = staircase().write(tmp_path / "out")
    for text, line in (("", 1), ("# a\n# b\n", 2), ("\n\n", 1)):
        (folder / Y_TABLE).write_text(text)
        found = fault(folder)
        assert (found.code, found.line) == ("RBL631", line)


def test_a_frequency_of_zero_never_ends(tmp_path):
    export = staircase()
    export.min_hz = 0
    folder = export.write(tmp_path / "out")
    text = (folder / Y_TABLE).read_text()
    (folder / Y_TABLE).write_text(text.replace("down,20000,-150,1", "down,0,-150,1"))
    found = fault(folder)
    assert (found.code, found.line) == ("RBL632", 5)
    assert {"0", "Hz"} <= fields(found.message)


def test_the_next_move_continues_where_the_last_one_ended(tmp_path):
    """The first row of P2 counts 40 pulses from 1000 down; from anywhere else it is not one step long."""
    export = staircase()
    export.files["02_line40_X.csv"] = csv(rows(1010, [970, 940, 920, 900], 100))
    found = fault(export.write(tmp_path / "out"))
    assert (found.code, found.line) == ("RBL632", 4)
    assert {"1000", "X", "970"} <= fields(found.message)


@pytest.mark.parametrize(("hz", "good"), [(1_000_000_000, True), (999_999_950, True), (999_999_850, False)])
def test_a_row_may_be_off_by_a_billionth_of_a_second(tmp_path, hz, good):
    """Ten million pulses in 10 ms, in half a nanosecond more, and in one and a half."""
    export = Handmade(
        {"kind": "cartesian", "name": "x", "axes": ["x"], "y_mm": 0, "z_mm": 0}, [("X", "mm", 1e-9, 0)], max_hz=1e9
    )
    export.move(1, (0, 0, 0), (1, 0, 0), X=[10_000_000])
    export.files = dict.fromkeys(export.files, csv([["up", hz, 10_000_000, 1], ["end", 0, 10_000_000, 0]]))
    folder = export.write(tmp_path / "out")
    assert replay(read_export(folder))[0].counts == (10_000_000,) if good else fault(folder).code == "RBL632"


# --- whatever happens to a file --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return staircase().write(tmp_path_factory.mktemp("pulses") / "out")


def outcome(path, raw):
    """The fault of reading the folder with other bytes in a file, None when it can be read; any other error escapes."""
    before = path.read_bytes()
    path.write_bytes(raw)
    try:
        replay(read_export(path.parent))
    except FileFault as found:
        assert found.code in ("RBL630", "RBL631", "RBL632", "RBL633")
        assert found.line >= 1
        assert found.column >= 1
        return found
    finally:
        path.write_bytes(before)
    return None


@examples(400)
@given(data=st.data())
def test_a_corrupt_byte_anywhere_is_read_or_a_fault(folder, data):
    path = folder / data.draw(st.sampled_from(sorted(path.name for path in folder.iterdir())))
    raw = bytearray(path.read_bytes())
    at, byte = data.draw(st.integers(0, len(raw) - 1)), data.draw(st.integers(0, 255))
    raw[at] = byte
    outcome(path, raw)


@examples(300)
@given(data=st.data())
def test_no_byte_of_the_rows_can_change_unnoticed(folder, data):
    """Every byte of header and rows but the last line end; carriage returns before a line end are not told apart."""
    path = folder / data.draw(st.sampled_from(sorted(path.name for path in folder.glob("*.csv"))))
    raw = bytearray(path.read_bytes())
    at = data.draw(st.integers(raw.index(b"control"), len(raw) - 2))
    raw[at] = data.draw(st.integers(0, 255).filter(lambda byte: byte != raw[at]))
    assert outcome(path, raw) is not None


@examples(200)
@given(data=st.data())
def test_a_file_that_is_cut_off_is_a_fault(folder, data):
    path = folder / data.draw(st.sampled_from(sorted(path.name for path in folder.iterdir())))
    raw = path.read_bytes().rstrip(b"\n")
    assert outcome(path, raw[: data.draw(st.integers(0, len(raw) - 1))]) is not None


@examples(200)
@given(text=st.text(max_size=60), name=st.sampled_from(["manifest.json", X_TABLE]))
def test_any_text_in_place_of_a_file_is_a_fault(folder, text, name):
    assert outcome(folder / name, text.encode("utf-8", "surrogatepass")) is not None


@pytest.mark.parametrize("code", ["RBL630", "RBL631", "RBL632", "RBL633", "RBL634", "RBL635"])
def test_the_codes_are_registered(code):
    assert lookup(code).name.startswith("pulse-")
