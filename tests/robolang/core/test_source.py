import os

import pytest

from robolang.core.source import MAX_BYTES, Place, Source, Span, read_program
from runtime.core.tomlfile import FileFault


def fault_of(path):
    with pytest.raises(FileFault) as caught:
        read_program(path)
    return caught.value


def test_lines_end_at_lf_cr_and_crlf_and_nothing_else():
    text = "a\nb\rc\r\nd\x0ce\u2028f\x85g"
    source = Source("x", text)
    assert [source.slice(span) for span in source.line_spans] == ["a", "b", "c", "d\x0ce\u2028f\x85g"]


def test_place_is_one_based_and_counts_characters():
    source = Source("x", "ab\n点c")
    assert source.place(0) == Place(line=1, column=1)
    assert source.place(2) == Place(line=1, column=3)
    assert source.place(3) == Place(line=2, column=1)
    assert source.place(5) == Place(line=2, column=3)
    assert source.line_text(2) == "点c"
    assert source.slice(Span(3, 4)) == "点"


def test_the_byte_order_mark_is_removed(tmp_path):
    path = tmp_path / "a.rbl"
    path.write_bytes(b"\xef\xbb\xbfMOVE P1\r\n")
    assert read_program(path).text == "MOVE P1\r\n"


@pytest.mark.parametrize("name", ["none.rbl", "none/none.rbl", "x" * 253, "x" * 5000, "nul\0.rbl"])
def test_missing(tmp_path, name):
    assert fault_of(f"{tmp_path}/{name}").code == "RBL701"


def test_missing_suffix_is_suggested(tmp_path):
    (tmp_path / "pick.rbl").write_text("MOVE P1")
    assert str(tmp_path / "pick.rbl") in fault_of(tmp_path / "pick").hint


def test_a_file_used_as_a_folder_is_missing(tmp_path):
    (tmp_path / "a.rbl").write_text("")
    assert fault_of(tmp_path / "a.rbl" / "b.rbl").code == "RBL701"


def test_folder_pipe_and_device_are_refused_without_waiting(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", "/dev/zero", "/dev/null"):
        assert fault_of(path).code == "RBL702"


def test_size_limit_is_exact(tmp_path):
    path = tmp_path / "a.rbl"
    path.write_bytes(b"'" * MAX_BYTES)
    assert len(read_program(path).text) == MAX_BYTES
    path.write_bytes(b"'" * (MAX_BYTES + 1))
    assert fault_of(path).code == "RBL106"


def test_a_huge_file_is_refused_unread(tmp_path):
    path = tmp_path / "a.rbl"
    with path.open("wb") as stream:
        stream.truncate(200_000_000_000)
    assert fault_of(path).code == "RBL106"


@pytest.mark.parametrize(
    ("raw", "line", "column"),
    [
        (b"MOVE P1\nMOV\xc9 P2", 2, 4),
        (b"\xef\xbb\xbf\xc3\xa9\xff", 1, 2),
        (b"\xef\xbb\xbfMOVE\r\n\xff", 2, 1),
        (b"MOVE P1\rMO\0E", 2, 3),
        (b"\xff\xfeM\0", 1, 1),
    ],
)
def test_not_text_is_placed_at_the_first_bad_byte(tmp_path, raw, line, column):
    path = tmp_path / "a.rbl"
    path.write_bytes(raw)
    fault = fault_of(path)
    assert (fault.code, fault.line, fault.column) == ("RBL104", line, column)


def test_utf16_is_recognised(tmp_path):
    path = tmp_path / "a.rbl"
    path.write_bytes("MOVE P1".encode("utf-16"))
    assert "UTF-16" in fault_of(path).hint
