import os
import re

import pytest

from runtime.core.toml_places import locate
from runtime.core.tomlfile import MAX_BYTES, FileFault, Source, Table, load_table, read_source
from tests.messages import fields

TEXT = """\
# a comment, as robot = "x" would be one
title = "x"

[hand]
mass_kg = 0.8
tcp = [0, 0,
       113.7]
[[parts]]
name = "a"
[parts.inner]
deep = 1
[[parts]]
name = "b"
"quoted key" = 3
"""


def fault(call, *args, **options):
    with pytest.raises(FileFault) as caught:
        call(*args, **options)
    return caught.value


def table(text, path="f.toml"):
    return load_table(Source(path, text))


def place(found):
    return found.code, found.line, found.column


# reading ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda path: None, ""),
        (lambda path: path.mkdir(), ""),
        (os.mkfifo, ""),
        (lambda path: path.symlink_to("/dev/zero"), ""),
        (lambda path: path.symlink_to(path), ""),
        (lambda path: path.write_bytes(b" " * (MAX_BYTES + 1)), f"{MAX_BYTES + 1} {MAX_BYTES}"),
        (lambda path: path.write_bytes(b"a = 1\nb = \xff"), "UTF-8 10"),
        (lambda path: path.write_bytes("a = 1".encode("utf-16")), "UTF-8 0"),
    ],
    ids=["missing", "folder", "pipe", "device", "ring", "huge", "binary", "UTF-16"],
)
def test_what_is_no_small_text_file_is_refused_without_waiting(tmp_path, make, said):
    path = tmp_path / "f.toml"
    make(path)
    found = fault(read_source, path)
    assert place(found) == ("RBL600", *((2, 5) if "10" in said.split() else (1, 1)))
    assert found.path == str(path)
    assert set(said.split()) <= fields(found.message)
    assert fault(read_source, path, "RBL311").code == "RBL311"


def test_a_name_with_a_nul_is_refused(tmp_path):
    assert "null" in fault(read_source, tmp_path / "a\0b.toml").message


def test_a_file_of_the_largest_size_and_one_with_a_byte_order_mark_are_read(tmp_path):
    (tmp_path / "f.toml").write_bytes(b"#" * MAX_BYTES)
    assert load_table(read_source(tmp_path / "f.toml")).names() == []
    (tmp_path / "f.toml").write_bytes(b"\xef\xbb\xbfa = 1\r\n")
    assert load_table(read_source(tmp_path / "f.toml")).number("a") == 1.0


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [("a = 1\nb = \n", 2, 5), ("a = 1\na = 2\n", 2, 1), ("a = 1\nb = 'x", 2, 7), ("[a\n", 1, 3), ("a = [1, 2", 1, 10)],
)
def test_a_syntax_error_is_at_its_line(text, line, column):
    found = fault(table, text)
    assert place(found) == ("RBL601", line, column)
    assert found.excerpt == text.splitlines()[line - 1]
    assert "(at " not in found.message


def test_what_python_cannot_read_is_a_syntax_error_and_no_trace():
    assert "nested" in fault(table, "a = " + "[" * 100_000).message
    assert fault(table, "a = " + "9" * 5000).code == "RBL601"


# values -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "code", "said"),
    [
        ("nan", "RBL604", "nan"),
        ("inf", "RBL604", "inf"),
        ("-inf", "RBL604", "-inf"),
        ("1e400", "RBL604", "inf"),
        ("2e9", "RBL604", "2000000000.0"),
        ("9" * 4000, "RBL604", "13288"),
        ("0x" + "F" * 5000, "RBL604", "20000"),
        ("11", "RBL605", "11"),
        ("-1", "RBL605", "-1"),
        ("true", "RBL613", "boolean"),
        ("'1'", "RBL613", "text"),
        ("[1]", "RBL613", "list"),
        ("{b = 1}", "RBL613", "table"),
        ("1979-05-27", "RBL613", "date"),
    ],
)
@pytest.mark.parametrize("positive", [False, True])
def test_a_number_that_is_none(value, code, said, positive):
    text = f"# first\na = {value}\n"
    found = fault(table(text).number, "a", low=0.0, high=10.0, positive=positive)
    assert place(found) == (code, 2, 1)
    assert "a" in fields(found.message)
    assert re.search(rf"(?<!\w){re.escape(said)}(?!\w)", found.message)
    assert code != "RBL605" or {"0", "10"} <= fields(found.message)
    assert len(found.message) < 100
    found = fault(table(f"# first\na = [1, {value}]\n").numbers, "a", 2, low=0.0, high=10.0, positive=positive)
    assert place(found) == (code, 2, 1)


def test_zero_is_not_positive():
    assert "0" in fields(fault(table("a = 0").number, "a", positive=True).message)
    assert table("a = 0").number("a") == 0.0


def test_a_missing_key_names_itself_and_a_near_one():
    found = fault(table(TEXT).table("hand").number, "mas_kg")
    assert place(found) == ("RBL608", 4, 1)
    assert "hand.mas_kg" in fields(found.message)
    assert "mass_kg" in fields(found.hint)
    assert "axes.2" not in found.message


def test_a_default_is_taken_only_when_the_key_is_missing():
    t = table("a = 1\nb = 'x'\nc = [1]\nd = true")
    assert (t.number("a", 5.0), t.number("z", 5.0)) == (1.0, 5.0)
    assert (t.text("b", "y"), t.text("y", "y")) == ("x", "y")
    assert (t.numbers("c", 1, [2]), t.numbers("x", 1, [2])) == ((1.0,), (2,))
    assert (t.flag("d", False), t.flag("w", False)) == (True, False)
    t.done()


@pytest.mark.parametrize(
    ("call", "text", "code", "said"),
    [
        (lambda t: t.numbers("a", 3), "a = [1, 2]", "RBL613", "3 2"),
        (lambda t: t.numbers("a", None), "a = 1", "RBL613", ""),
        (lambda t: t.integer("a", low=0, high=9), "a = 1.5", "RBL613", ""),
        (lambda t: t.integer("a", low=0, high=9), "a = 10", "RBL605", "0 9"),
        (lambda t: t.text("a"), "a = 1", "RBL613", ""),
        (lambda t: t.text("a", choices=("one", "two")), "a = 'onn'", "RBL610", "a onn"),
        (lambda t: t.flag("a", True), "a = 1", "RBL613", ""),
        (lambda t: t.table("a"), "a = 1", "RBL613", ""),
        (lambda t: t.tables("a"), "a = [1]", "RBL613", ""),
        (lambda t: t.tables("a"), "[a]\nb = 1", "RBL613", ""),
        (lambda t: t.named_tables("a"), "[a]\nb = 1", "RBL613", "a.b"),
        (lambda t: t.raw_list("a"), "a = 1", "RBL613", ""),
    ],
)
def test_a_value_of_the_wrong_kind(call, text, code, said):
    found = fault(call, table(text))
    assert found.code == code
    assert set(said.split()) <= fields(found.message)
    assert found.hint


def test_a_choice_that_is_nearly_right_is_suggested():
    assert "scheduled" in fields(fault(table("a = 'schduled'").text, "a", choices=("scheduled", "fixed")).hint)


# unknown keys -------------------------------------------------------------------------------------------------------


def test_a_key_that_may_be_there_is_known_before_it_is():
    t = table("alarm = []\npositon = 1\n[[obstacle]]\n")
    assert not any(key in t for key in ("alarms", "pose", "obstacles"))
    for key, line, meant in (("alarm", 1, "alarms"), ("positon", 2, "pose"), ("obstacle", 3, "obstacles")):
        found = fault(t.done)
        assert place(found) == ("RBL609", line, 1)
        assert meant in fields(found.hint)
        t.ask(key)


def test_a_key_that_nobody_read_is_refused_at_its_place():
    t = table(TEXT).table("hand")
    t.number("mass_kg")
    found = fault(t.done)
    assert place(found) == ("RBL609", 6, 1)
    assert "mass_kg" in fields(found.hint)
    t.numbers("tcp", 3)
    t.done()


def test_a_misspelt_key_is_told_the_one_that_is_missing():
    t = table("mas_kg = 1\nmass_g = 2")
    t.number("mass_kg", 1.0)
    t.number("mass_g")
    assert "mass_kg" in fields(fault(t.done).hint)


# places -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "line", "column"),
    [
        (["title"], 2, 1),
        (["hand"], 4, 1),
        (["hand", "mass_kg"], 5, 1),
        (["hand", "none"], 4, 1),
        (["parts", 0], 8, 1),
        (["parts", 0, "name"], 9, 1),
        (["parts", 0, "inner", "deep"], 11, 1),
        (["parts", 1, "name"], 13, 1),
        (["parts", 1, "missing"], 12, 1),
        (["robot"], 1, 1),
        (["none"], 1, 1),
    ],
)
def test_keys_are_found_where_they_stand(keys, line, column):
    assert locate(TEXT, keys) == (line, column)


@pytest.mark.parametrize(
    ("text", "keys", "line"),
    [
        ("a = 1\n[[b]]\n[[b]]\n", ["b"], 2),
        ("a = 1\n[b.c]\n[b]\n", ["b"], 3),
        ("a = 1\n[b.c]\n", ["b"], 2),
        ("a = 1\nb.c = 2\n", ["b"], 2),
        ("a = 1\n[b]\n[b.d]\n", ["b", "c"], 2),
    ],
)
def test_a_key_that_is_only_the_beginning_of_others_is_at_the_first_of_them(text, keys, line):
    assert locate(text, keys) == (line, 1)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("[home]\na = 1\n[home] # again\n", 3, "[home] is given twice, first in line 1"),
        ("a = 1\n  a = 2", 2, "'a' is given twice, first in line 1"),
        ("a = [1,\n2]\na = [1,\n2]\n", 3, "'a' is given twice, first in line 1"),
        ("[a]\nb = 1\n[a.b]\n", 3, "[a.b] is given twice, first in line 2"),
        ("a = {x = 1}\n[a.y]\n", 2, "[a.y] is given twice"),
        ("a = []\n[[a]]\n", 2, "[[a]] is given twice"),
        ("[a.b]\n[a]\nb.c = 3\n", 3, "'b.c' is given twice"),
        ("[[a]]\n[a]\n", 2, "[a] is given twice, first in line 1"),
    ],
)
def test_what_is_there_twice_is_named_with_both_places(text, line, message):
    found = fault(table, text)
    assert (found.code, found.line, found.message) == ("RBL601", line, message)
    assert found.excerpt == text.splitlines()[line - 1]


def test_the_rows_of_an_array_are_no_headers():
    text = "[hand]\na = [\n  [1, 2],\n  [3, 4]\n]\nb = 1\n[other] # comment\n  c = 2\n"
    assert locate(text, ["hand", "b"]) == (6, 1)
    assert locate(text, ["other", "c"]) == (8, 3)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_lines_are_counted_as_editors_do(end):
    text = end.join(["# \u2028 \x85", "a = 1", "[b]", "c = nan"])
    assert fault(table(text).table("b").number, "c").line == 4


def test_a_fault_says_where_it_is():
    found = fault(table("a = nan").number, "a")
    assert str(found) == f"f.toml:1:1: RBL604 {found.message}"
    assert "a" in fields(found.message)
    assert found.excerpt == "a = nan"


def test_an_empty_table_belongs_to_a_missing_optional_one():
    t = table("")
    assert t.table("servo", required=False).names() == []
    assert t.tables("parts", required=False) == []
    assert isinstance(t, Table)
    assert fault(t.table, "servo").code == "RBL608"


# everything at once -------------------------------------------------------------------------------------------------


def gathered(text, read):
    """What a reader of a whole file finds, and the value that it returns."""
    whole = load_table(Source("f.toml", text), gather=True)
    value = whole.attempt(lambda: read(whole))
    found = fault(whole.finish)
    return [(each.code, each.line, each.message) for each in found.all], value


def test_every_value_that_is_wrong_is_found_and_every_key():
    text = "a = nan\nb = 'x'\nc = [1, inf]\nd = true\n[e]\nf = 11\n[[g]]\nzzz = 1\n"
    found, value = gathered(
        text,
        lambda table: (
            table.number("a"),
            table.number("b"),
            table.numbers("c", 2),
            table.text("d"),
            table.table("e").number("f", high=10.0),
            [each.done() for each in table.tables("g")],
        ),
    )
    assert [each[:2] for each in found] == [
        ("RBL604", 1),
        ("RBL613", 2),
        ("RBL604", 3),
        ("RBL613", 4),
        ("RBL605", 6),
        ("RBL609", 8),
    ]
    assert value is None


def test_the_keys_that_a_table_lacks_are_one_fault():
    text = "[hand]\nmas = 1\n"
    found, _ = gathered(
        text,
        lambda table: [
            table.table("hand").gather(
                lambda hand: (
                    hand.number("mass"),
                    hand.number("stroke"),
                    hand.table("inner").number("deep"),
                    hand.done(),
                )
            )
        ],
    )
    ((*place, message),) = found
    assert place == ["RBL608", 1]
    assert fields(message) == {"hand.mass", "hand.stroke", "hand.inner"}


def test_a_key_that_is_read_twice_is_wrong_once():
    for text, code in (("", "RBL608"), ("a = 1\n", "RBL613")):
        found, _ = gathered(text, lambda table: (table.text("a"), table.text("a", choices=("x", "y"))))
        assert [each[0] for each in found] == [code]


def test_what_follows_from_a_mistake_is_none_of_its_own():
    def read(table):
        low, high = table.number("low"), table.number("high")
        if not low < high:
            table.fail("RBL607", "inverted")

    assert [each[:2] for each in gathered("low = nan\nhigh = 0\n", read)[0]] == [("RBL604", 1)]
    assert [each[:2] for each in gathered("low = 1\nhigh = 0\n", read)[0]] == [("RBL607", 1)]


def test_without_gathering_the_first_fault_is_raised():
    assert len(fault(table("a = nan\nb = nan\n").number, "a").all) == 1


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.toml", "robot = puma560  # the arm\n", {"puma560"}),
        ("a.toml", "x = 1\nmode = fixed at mid\n", set()),
        ("p.rbl", "MOVE P1\n", {"p.rbl", ".toml"}),
    ],
)
def test_words_without_quotes_and_files_of_another_kind_are_named(name, text, said):
    with pytest.raises(FileFault) as caught:
        load_table(Source(name, text))
    fault = caught.value
    assert fault.code == "RBL601"
    assert said <= fields(f"{fault.message} {fault.hint}")
    assert ("TOML" in fault.message) is (name == "p.rbl")
    assert ("quotes" in fault.hint) is (name == "a.toml")
