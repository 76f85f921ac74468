"""The forms in which findings are printed, read back by what reads them."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from robolang.core.diagnostics import Diagnostic, Severity
from robolang.core.diagnostics import render as excerpt
from robolang.core.source import Source, Span
from robolang.lint.engine import Checked
from robolang.lint.pages import page
from robolang.lint.reporters import FOR_PEOPLE, FORMS, render, statistics
from robolang.lint.reporters.finding import Region, findings, fingerprints, relative
from runtime.core.faults import Fault, lookup
from runtime.core.tomlfile import FileFault, FilePlace
from tests.messages import fields
from tests.robolang.lint.helpers import checked

ROOT = Path("/srv/repo")
BAD = "10 MOVE P1\r\n10 MOVE P9\n30 LOAD (0, 0, 60), -1\n"
"""RBL110 info with a fix, RBL113 with a note, RBL301 and RBL401 errors."""
CODES = ["RBL110", "RBL113", "RBL301", "RBL401"]
LOST = FileFault("RBL307", "one, two", "write six", FilePlace("/srv/repo/cell/pick.points.toml", 3, 2, "pose = [1]"))


@pytest.fixture
def results():
    return [
        checked(BAD, "/srv/repo/cell/pick.rbl"),
        checked("MOVE P1\n", "/srv/repo/good.rbl"),
        checked("", "/srv/repo/cell/empty.rbl", faults=[LOST]),
    ]


def read(form, results, root=ROOT):
    text = render(form, results, root)
    assert text.endswith("\n")
    assert text.isascii() or form in ("full", "concise", "junit", "github")
    return text


def as_json(form, results):
    return json.loads(read(form, results))


@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_a_function_of_the_results(form, results):
    assert render(form, results, ROOT) == render(form, list(results), ROOT)
    module = Path("robolang/lint/reporters").joinpath(
        f"{ {'json': 'json_array'}.get(form, form).replace('-', '_') }.py"
    )
    assert len((Path(__file__).parents[3] / module).read_text("utf-8").splitlines()) < 120


@pytest.mark.parametrize("form", FORMS)
def test_nothing_found_is_a_whole_document(form):
    text = render(form, [], ROOT)
    empty = {"json": [], "gitlab": []}
    if form in empty:
        assert json.loads(text) == empty[form]
    elif form == "sarif":
        assert json.loads(text)["runs"][0]["results"] == []
    elif form == "junit":
        assert ET.fromstring(text).tag == "testsuites"
    else:
        assert text == ""


# --- for people ------------------------------------------------------------------------------------------------------


def test_full_is_every_finding_with_its_excerpt(results):
    blocks = [excerpt(item, result.source) for result in results for item in result.diagnostics]
    assert read("full", results) == "".join(f"{block}\n" for block in blocks)
    assert re.search(r"^  fix: .*\bCR LF\b", read("full", results), re.M)


def test_concise_is_one_line_for_each(results):
    lines = read("concise", results).splitlines()
    assert [line.split()[:3] for line in lines] == [
        ["/srv/repo/cell/pick.rbl:2:1:", "error", "RBL113"],
        ["/srv/repo/cell/pick.rbl:2:9:", "error", "RBL301"],
        ["/srv/repo/cell/pick.rbl:2:11:", "info", "RBL110"],
        ["/srv/repo/cell/pick.rbl:3:21:", "error", "RBL401"],
        ["/srv/repo/cell/empty.rbl:1:1:", "warning", "RBL201"],
    ]
    assert [line.endswith(" [*]") for line in lines] == [False, False, True, False, False]


@pytest.mark.parametrize("form", sorted(FOR_PEOPLE))
def test_forms_for_people_leave_faults_to_the_command_line(form):
    assert render(form, [checked("MOVE P1\n", faults=[LOST])], ROOT) == ""


# --- json ------------------------------------------------------------------------------------------------------------

PLACE = {"file", "line", "column", "end_line", "end_column"}
KEYS = PLACE | {"code", "name", "severity", "message", "hint", "related", "fix"}


def test_json_has_plain_objects_with_ranges(results):
    found = as_json("json", results)
    assert all(item.keys() == KEYS for item in found)
    (repeated,) = [item for item in found if item["code"] == "RBL113"]
    assert repeated["name"] == "line-number-duplicated"
    assert (repeated["line"], repeated["column"], repeated["end_line"], repeated["end_column"]) == (2, 1, 2, 3)
    (note,) = repeated["related"]
    assert (note["line"], note["end_column"]) == (1, 3)
    assert note["message"]
    assert repeated["fix"] is None
    (ends,) = [item for item in found if item["code"] == "RBL110"]
    assert ends["fix"]["safe"] is True
    assert ends["fix"]["edits"][0] == {"line": 2, "column": 11, "end_line": 3, "end_column": 1, "text": "\r\n"}
    (fault,) = [item for item in found if item["code"] == "RBL307"]
    assert (fault["file"], fault["line"], fault["column"]) == ("/srv/repo/cell/pick.points.toml", 3, 2)
    assert {item["severity"] for item in found} == {"error", "warning", "info"}


def test_json_lines_are_the_same_objects(results):
    lines = read("json-lines", results).splitlines()
    assert [json.loads(line) for line in lines] == as_json("json", results)


# --- github ----------------------------------------------------------------------------------------------------------


def test_github_commands(results):
    lines = read("github", results).splitlines()
    place = r"file=([^,]+),line=\d+,col=\d+,endLine=\d+,endColumn=\d+"
    matches = [re.fullmatch(rf"::(error|warning|notice) title=robolang \((RBL\d+)\),{place}::(.+)", s) for s in lines]
    assert all(matches)
    commands = {match[2]: match[1] for match in matches}
    assert commands == {**dict.fromkeys([*CODES, "RBL307"], "error"), "RBL110": "notice", "RBL201": "warning"}
    assert {match[3] for match in matches} == {"cell/pick.rbl", "cell/empty.rbl", "cell/pick.points.toml"}
    assert all("%0Ahelp: " in match[4] for match in matches)


def test_github_escapes_what_would_end_a_command():
    text = render("github", [checked("MOVE P9\n", "/srv/repo/a,b:c%\nd.rbl")], ROOT)
    assert "file=a%2Cb%3Ac%25%0Ad.rbl,line=1," in text
    assert text.count("\n") == 1


def test_github_has_columns_of_one_line_only():
    span = Span(2, 12)
    found = Diagnostic(code="RBL301", message="over two lines", span=span)
    result = Checked(source=Source("/srv/repo/a.rbl", "MOVE P1\nMOVE P9\n"), diagnostics=(found,))
    assert "file=a.rbl,line=1,endLine=2::" in render("github", [result], ROOT)


# --- gitlab ----------------------------------------------------------------------------------------------------------


def test_gitlab_issues(results):
    issues = as_json("gitlab", results)
    for issue in issues:
        assert issue.keys() == {"description", "check_name", "fingerprint", "severity", "location"}
        assert issue["severity"] in ("info", "minor", "major", "critical", "blocker")
        assert re.fullmatch(r"[0-9a-f]{32}", issue["fingerprint"])
        assert not issue["location"]["path"].startswith(("/", "."))
        positions = issue["location"]["positions"]
        assert all(isinstance(positions[end][key], int) for end in ("begin", "end") for key in ("line", "column"))
        assert positions["begin"]["line"] >= 1
    assert len({issue["fingerprint"] for issue in issues}) == len(issues)


def marks(text, path="/srv/repo/cell/pick.rbl", root=ROOT):
    found = findings([checked(text, path)])
    return dict(zip([item.code for item in found], fingerprints(found, root), strict=True))


def test_fingerprints_survive_edits_elsewhere():
    before = marks("10 MOVE P1\n20 MOVE P9\n30 LOAD (0, 0, 60), -1\n")
    after = marks("' more\n\n10 MOVE P1\n15 MOVE P2\n25   MOVE  P9\n300 LOAD (0, 0, 60), -1\n")
    assert before == after
    assert marks("20 MOVE P8\n") != {"RBL301": before["RBL301"]}


def test_fingerprints_are_of_the_path_below_the_root():
    text = "MOVE P9\n"
    assert marks(text) == marks(text, "/elsewhere/cell/pick.rbl", Path("/elsewhere"))
    assert marks(text) != marks(text, "/srv/repo/pick.rbl")


def test_equal_lines_have_different_fingerprints():
    found = findings([checked("MOVE P9\nMOVE P9\nMOVE P9\n")])
    assert len(set(fingerprints(found, ROOT))) == 3


# --- junit -----------------------------------------------------------------------------------------------------------


def test_junit_has_a_suite_for_each_program(results):
    document = ET.fromstring(read("junit", results))
    suites = document.findall("testsuite")
    assert [suite.get("name") for suite in suites] == ["cell/pick.rbl", "good.rbl", "cell/empty.rbl"]
    assert [(suite.get("tests"), suite.get("failures")) for suite in suites] == [("4", "3"), ("1", "0"), ("2", "2")]
    assert (document.get("tests"), document.get("failures")) == ("7", "5")
    for suite in suites:
        cases = suite.findall("testcase")
        assert len(cases) == int(suite.get("tests"))
        assert len(suite.findall("testcase/failure")) == int(suite.get("failures"))
    (case,) = suites[1]
    assert case.get("classname") == "good.rbl"
    assert list(case) == []


def test_junit_failures_say_what_and_where(results):
    cases = ET.fromstring(read("junit", results)).findall("testsuite/testcase")
    (case,) = [case for case in cases if case.get("name").startswith("RBL401")]
    assert case.attrib == {"name": "RBL401 payload-not-a-mass", "classname": "cell/pick.rbl"}
    failure = case.find("failure")
    assert failure.get("message").startswith("line 3, column 21: ")
    assert {"-1", "kg"} <= fields(failure.get("message"))
    assert failure.get("type") == "error"
    assert "help: " in failure.text
    (info,) = [case for case in cases if case.get("name").startswith("RBL110")]
    assert info.find("failure") is None
    assert info.find("system-out") is not None


@pytest.mark.parametrize(
    "text", ["MOVE \x0b\x1b P1\n", "MOVE P1 ' \ufffe\u202e\n", "MOVE <&\"'>\n", "\x85\n", "MOVE \uffff\n"]
)
def test_junit_is_xml_whatever_the_program_holds(text):
    assert ET.fromstring(render("junit", [checked(text, "a<&\"\x0b'.rbl")], ROOT)).tag == "testsuites"


# --- sarif -----------------------------------------------------------------------------------------------------------


def region_is_sound(region):
    assert region.keys() == {"startLine", "startColumn", "endLine", "endColumn"}
    assert all(isinstance(value, int) and value >= 1 for value in region.values())
    assert (region["startLine"], region["startColumn"]) <= (region["endLine"], region["endColumn"])


def uri_is_relative(uri):
    parts = urlsplit(uri)
    assert (parts.scheme, parts.netloc) == ("", "")
    assert not uri.startswith("/")
    assert "\\" not in uri


def test_sarif_log(results):
    log = as_json("sarif", results)
    assert log["version"] == "2.1.0"
    assert log["$schema"].endswith("sarif-schema-2.1.0.json")
    (run,) = log["runs"]
    assert run["columnKind"] == "unicodeCodePoints"
    driver = run["tool"]["driver"]
    assert driver["name"] == "robolang"
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", driver["semanticVersion"])
    assert [rule["id"] for rule in driver["rules"]] == sorted({*CODES, "RBL201", "RBL307"})
    for rule in driver["rules"]:
        assert rule["name"] == lookup(rule["id"]).name
        assert rule["help"]["markdown"] == page(rule["id"])
        assert rule["help"]["text"] == lookup(rule["id"]).remedy
        assert rule["shortDescription"]["text"]
        assert "helpUri" not in rule
        assert rule["defaultConfiguration"]["level"] in ("error", "warning", "note")


def test_sarif_results(results):
    (run,) = as_json("sarif", results)["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert len(run["results"]) == 6
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
        assert result["level"] in ("error", "warning", "note")
        assert isinstance(result["message"]["text"], str)
        (location,) = result["locations"]
        for place in (location, *result.get("relatedLocations", [])):
            region_is_sound(place["physicalLocation"]["region"])
            uri_is_relative(place["physicalLocation"]["artifactLocation"]["uri"])
        (mark,) = result["partialFingerprints"].values()
        assert re.fullmatch(r"[0-9a-f]{32}", mark)
    levels = {result["ruleId"]: result["level"] for result in run["results"]}
    assert (levels["RBL110"], levels["RBL201"], levels["RBL301"]) == ("note", "warning", "error")


def test_sarif_fixes_and_related_places(results):
    found = {result["ruleId"]: result for result in as_json("sarif", results)["runs"][0]["results"]}
    (fix,) = found["RBL110"]["fixes"]
    (change,) = fix["artifactChanges"]
    uri_is_relative(change["artifactLocation"]["uri"])
    for replacement in change["replacements"]:
        region_is_sound(replacement["deletedRegion"])
        assert replacement["insertedContent"] == {"text": "\r\n"}
    (note,) = found["RBL113"]["relatedLocations"]
    assert note["message"].keys() == {"text"}
    assert "fixes" not in found["RBL301"]


@pytest.mark.parametrize("name", ["a b.rbl", "ä,%#?.rbl", "c:d.rbl", "\udcff.rbl"])
def test_sarif_uris_are_escaped(name):
    log = json.loads(render("sarif", [checked("MOVE P9\n", f"/srv/repo/{name}")], ROOT))
    uri = log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    uri_is_relative(uri)
    assert uri.isascii()
    assert urlsplit(uri).path == uri
    assert unquote(uri, errors="surrogateescape") == name


# --- what they are made from -----------------------------------------------------------------------------------------


def test_findings_have_places_of_both_ends():
    (item,) = findings([checked("\n20 MOVE P9\n")])
    assert item.region == Region(line=2, column=9, end_line=2, end_column=11)
    assert (item.code, item.severity, item.line_text) == ("RBL301", Severity.ERROR, "20 MOVE P9")


def test_a_fault_without_a_place_is_at_the_start_of_its_program():
    result = Checked(source=Source("pick.rbl", ""), faults=(Fault("RBL706", "no\x1b"),))
    (item,) = findings([result])
    assert (item.path, item.region, item.message) == ("pick.rbl", Region(), "no\ufffd")


@pytest.mark.parametrize(
    ("path", "shown"),
    [("/srv/repo/a/b.rbl", "a/b.rbl"), ("/srv/other/b.rbl", "../other/b.rbl"), ("-", "-"), ("a\0b", "a\0b")],
)
def test_paths_are_relative_to_the_root(path, shown):
    assert relative(path, ROOT) == shown


def test_a_relative_path_is_one_of_the_working_folder(tmp_path, monkeypatch):
    (tmp_path / "deep").mkdir()
    monkeypatch.chdir(tmp_path / "deep")
    assert relative("pick.rbl", tmp_path) == "deep/pick.rbl"


def test_statistics_count_each_code():
    results = [checked("MOVE P9\nMOVE P8\n10 MOVE P1, SPEED 1_0\n"), checked("MOVE P7\nMOV P1\n")]
    assert statistics.render(results, as_json=False) == (
        "3  RBL301  point-undefined\n1  RBL112  unknown-instruction\n1  RBL115  number-malformed  [*]\n"
    )
    assert json.loads(statistics.render(results, as_json=True))[2] == {
        "code": "RBL115",
        "name": "number-malformed",
        "count": 1,
        "fixable": 1,
    }
    assert statistics.render([], as_json=False) == ""
    assert statistics.render([], as_json=True) == "[]\n"
