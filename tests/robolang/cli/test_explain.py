import json
import re

import pytest

import robolang.project.project as _registers_its_codes  # noqa: F401
from runtime.core.faults import all_codes, lookup
from tests.messages import fields
from tests.robolang.cli.commands import ROOT, flat, robolang, shell
from tests.together import together


@pytest.mark.parametrize("word", ["RBL412", "rbl412", "412", "wrist-singularity", " RBL412 "])
def test_a_code_is_explained(word):
    text = robolang("explain", word).stdout
    assert text.startswith("RBL412 wrist-singularity\n\n")
    assert flat(lookup("RBL412").remedy) in flat(text)
    assert max(map(len, text.splitlines())) <= 80


@together("entry", all_codes(), ids=lambda entry: entry.code)
def test_every_code_has_a_meaning_and_says_what_to_do(entry):
    words = flat(robolang("explain", entry.code).stdout)
    assert flat(entry.meaning) in words
    assert flat(entry.remedy) in words
    assert len(entry.meaning) > 20
    assert len(entry.remedy) >= 10


@pytest.mark.parametrize(
    ("word", "near"),
    [
        ("RBL5111", "RBL511"),
        ("5111", "RBL511"),
        ("RLB412", "RBL412"),
        ("wrist-singularty", "wrist-singularity"),
        ("joint-limits", "joint-limit"),
        ("APPROCH", "APPROACH"),
        ("dpart", "DEPART"),
    ],
)
def test_an_unknown_code_is_answered_with_the_nearest(word, near):
    words = flat(robolang("explain", word, code=2).stderr)
    assert {"RBL703", word} <= fields(words)
    assert re.findall(r"[\w-]+", words)[-1] == near


@pytest.mark.parametrize("word", ["", "zzzzzz", "zzzzzz P1", "$", "RBL", "٤١٢"])
def test_a_word_like_no_code_is_refused(word):
    said = robolang("explain", word, code=2).stderr
    assert "RBL703" in said
    assert not {entry.code for entry in all_codes()} & fields(said) - {"RBL703"}


def test_all_codes_are_listed_in_an_aligned_table():
    lines = robolang("explain").stdout.splitlines()
    heading = next(line for line in lines if line.split() == ["code", "name", "meaning"])
    name, meaning = heading.index("name"), heading.index("meaning")
    rows = [line for line in lines if re.match(r" RBL\d{3} ", line)]
    assert [row[1:7] for row in rows] == [entry.code for entry in all_codes()]
    assert [row[name:meaning].strip() for row in rows] == [entry.name for entry in all_codes()]
    assert all(row[7:name].isspace() and row[meaning - 2 : meaning].isspace() for row in rows)
    assert max(map(len, lines)) <= 80
    assert "…" not in "".join(lines)


def test_a_fresh_process_knows_every_code_of_the_page():
    """Here the tests have imported everything; a user's command imports no more than it asks for."""
    page = (ROOT / "docs" / "codes.md").read_text("utf-8")
    listed = shell("explain").stdout
    codes = re.findall(r"^\| (RBL\d{3}) \|", page, re.M)
    assert len(codes) > 80
    assert re.findall(r"^ (RBL\d{3}) ", listed, re.M) == codes


def test_a_whole_code_that_does_not_exist_has_no_nearest():
    assert re.findall(r"RBL\d+", robolang("explain", "RBL999", code=2).stderr) == ["RBL703", "RBL999"]


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("PTP", ("KRL", "KUKA", "MOVEJ P1")),
        ("mov", ("MELFA", "Mitsubishi", "MOVEJ P1")),
        ("set", ("RAPID", "OUT(1) = 1", "INFORM", "x = 5")),
        ("MOVE", ("MOVE point", "V+", "MOVEJ P1")),
        ("sin", ("SIN(x)",)),
        ("fine", ("ZONE mm or FINE", "MELFA")),
        ("tilt", ("WRIST HOLD component",)),
        ("offs", ("RAPID", "P1 + (0, 0, 50)")),
        ("==", ("==", "IF x = 1 THEN")),
        ("MoveL p10, v1000, z50, tool0;", ("RAPID", "MOVE p10, SPEED 1000, ZONE 50")),
        (" DO[1]=ON ", ("TP", "OUT(1) = 1")),
        ("$IN[1]", ("$IN[1]", "IN(n)")),
        ("$VEL.CP", ("SPEED mm/s",)),
        ("pick(1,2);", ("CALL pick(1, 2)", "SUB pick")),
        ("MoveL p10\\Bad:=10, z10;", ("RAPID", "MOVE P1")),
        ("MOVE P1, SPEED 5", ("MOVE point", "V+")),
    ],
)
def test_a_word_or_a_line_is_explained(word, parts):
    said = robolang("explain", word).stdout
    assert [part for part in parts if part not in said] == []


def test_a_statement_to_copy_is_on_one_line():
    lines = robolang("explain", "movej([0,-1.57,1.57,0,1.57,0], a=1.4, v=1.05)").stdout.splitlines()
    assert any("MOVEJ JOINT(0, -89.954, 89.954, 0, 89.954, 0);" in line for line in lines)


def test_no_word_is_the_name_of_a_code():
    from robolang.syntax.foreign import words
    from robolang.syntax.keywords import FUNCTIONS, KEYWORDS

    names = {entry.name.upper() for entry in all_codes()}
    assert names & (KEYWORDS | FUNCTIONS | words.instructions().keys() | words.functions().keys()) == set()


def test_json_of_a_code_is_that_of_the_rules():
    of_rules = {entry["code"]: entry for entry in json.loads(robolang("rules", "--json").stdout)}
    assert json.loads(robolang("explain", "RBL103", "--json").stdout) == of_rules["RBL103"]


def test_json_of_all_codes_and_of_a_word():
    listed = json.loads(robolang("explain", "--json").stdout)
    assert [entry["code"] for entry in listed] == [entry.code for entry in all_codes()]
    of_word = json.loads(robolang("explain", "PTP", "--json").stdout)
    assert of_word["word"] == "PTP"
    assert of_word["text"].splitlines() == robolang("explain", "PTP").stdout.splitlines()
