"""``robolang rules``, and what ``robolang explain`` says of a rule."""

import json
import re

from robolang.lint.registry import codes, rules
from runtime.core.faults import lookup
from tests.robolang.cli.commands import flat, robolang
from tests.robolang.cli.test_check import modules_after
from tests.together import together


def test_every_rule_is_in_the_table():
    lines = robolang("rules").stdout.splitlines()
    assert next(line for line in lines if "severity" in line).split() == ["code", "name", "severity", "fix", "meaning"]
    rows = [line for line in lines if re.match(r" RBL\d{3} ", line)]
    assert [row[1:7] for row in rows] == [entry.code for entry in codes()]
    assert max(map(len, lines)) <= 80
    for row in rows:
        known = rules().get(row[1:7])
        if known is not None:
            assert row.split()[1:3] == [known.entry.name, known.severity.value]
            assert (row.split()[3] == "yes") == bool(known.fix)


def test_json_holds_the_text_of_the_pages():
    found = json.loads(robolang("rules", "--json").stdout)
    assert [item["code"] for item in found] == [entry.code for entry in codes()]
    keys = {"code", "name", "meaning", "remedy", "severity", "why", "example", "instead", "fix", "found_by"}
    assert all(item.keys() == keys for item in found)
    by_code = {item["code"]: item for item in found}
    assert by_code["RBL190"]["fix"] == rules()["RBL190"].fix
    assert by_code["RBL112"]["fix"] is None
    assert (by_code["RBL402"]["found_by"], by_code["RBL401"]["found_by"]) == ("check", "check")
    assert all(item["why"] and item["example"] and item["instead"] for item in found)


@together("code", list(rules()))
def test_a_rule_is_explained_with_its_example(code):
    text, known = robolang("explain", code).stdout, rules()[code]
    assert text.startswith(f"{code} {known.entry.name}\n\n")
    assert flat(known.why) in flat(text)
    for program in (known.example, known.instead):
        assert "".join(f"    {line}\n" for line in program.splitlines()) in text
    assert ("--fix" in text) == bool(known.fix)


def test_a_code_without_a_page_is_explained_as_before():
    text = flat(robolang("explain", "RBL511").stdout)
    assert "RBL511" not in rules()
    assert text.strip().endswith(flat(lookup("RBL511").remedy))


def test_listing_the_rules_needs_no_numerics():
    assert modules_after("rules") == "loaded []"
