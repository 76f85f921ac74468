"""``robolang check --motion --html``: which files it takes, what it writes, and when it writes nothing."""

import pytest

from tests.robolang.cli.commands import BUILTIN, PUMA, robolang
from tests.robolang.view.decoding import Page

pytestmark = pytest.mark.physics

CHECK = ("check", "--motion", "--html")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_page_has_the_plan_and_all_findings(tmp_path):
    text = "x = 1\nMOVE P5\nMOVE P1 + (0, 0, -30)\n"
    (tmp_path / "p.rbl").write_text(text)
    robolang(*CHECK, "p.html", "p.rbl", code=1)
    ((header, _),) = Page(tmp_path / "p.html").runs
    assert header["kind"] == "plan" and header["meta"]["program"]["text"] == text
    # RBL225 is about the text, RBL421 about the motion
    found = {each["code"]: each for each in header["notes"]}
    assert {"RBL225", "RBL421"} <= found.keys()
    assert found["RBL421"]["p"] and not found["RBL225"]["p"]


@pytest.mark.parametrize(
    "options",
    [("--html", "p.html"), ("--motion", "--html", "p.rbl"), ("--motion", "--html", "page.htm")],
    ids=["without --motion", "a program", "another suffix"],
)
def test_options_that_cannot_be_are_refused(tmp_path, options):
    (tmp_path / "p.rbl").write_text("x = 1\n")
    assert "--html" in robolang("check", "p.rbl", *options, code=2).stderr
    assert [path.name for path in tmp_path.iterdir()] == ["p.rbl"]


def test_a_page_is_of_one_program(tmp_path):
    for name in ("a", "b"):
        (tmp_path / f"{name}.rbl").write_text("x = 1\n")
    assert "--html" in robolang(*CHECK, "p.html", ".", code=2).stderr
    assert not (tmp_path / "p.html").exists()


def test_a_program_with_errors_has_no_page_and_says_so(tmp_path):
    (tmp_path / "p.rbl").write_text("MOV P1\n")
    assert "p.html" in robolang(*CHECK, "p.html", "p.rbl", code=1).stderr
    assert not (tmp_path / "p.html").exists()


def test_a_folder_that_is_not_there_is_found_before_anything_is_planned(tmp_path):
    (tmp_path / "p.rbl").write_text("x = 1\n")
    done = robolang(*CHECK, "none/p.html", "p.rbl", code=4)
    assert "RBL706" in done.stderr and not done.stdout


def test_two_outputs_are_not_one_file(tmp_path):
    (tmp_path / "p.rbl").write_text("x = 1\n")
    assert "--html" in robolang(*CHECK, "o.html", "--times", "./o.html", "p.rbl", code=2).stderr
    assert not (tmp_path / "o.html").exists()


def test_a_link_to_the_program_is_not_written_through(tmp_path):
    (tmp_path / "p.rbl").write_text("x = 1\n")
    (tmp_path / "p.html").symlink_to("p.rbl")
    assert "--html" in robolang(*CHECK, "p.html", "p.rbl", code=2).stderr
    assert (tmp_path / "p.rbl").read_text() == "x = 1\n"


def test_what_is_in_another_file_has_its_place_there_and_no_line_of_the_program(tmp_path):
    """Line 9 of the points file is no line of a program, and line 1 of it is another one."""
    (tmp_path / "odd.toml").write_text(PUMA.read_text().replace("gear_ratio = -62.6111", "gear_ratio = -0.9", 1))
    cell = (BUILTIN / "cell.toml").read_text().replace('robot = "puma560"', 'robot = "odd.toml"')
    (tmp_path / "p.cell.toml").write_text(cell)
    points = (BUILTIN / "points.toml").read_text()
    (tmp_path / "p.points.toml").write_text(f"{points}[points.OLD]\njoints = [0, 45, -180, 0, 45, 0]\n")
    (tmp_path / "p.rbl").write_text("x = 1\nMOVE P1\nMOVE P2\nMOVE P3\nMOVE P4\nMOVE P5\n")
    robolang(*CHECK, "p.html", "p.rbl")
    ((header, _),) = Page(tmp_path / "p.html").runs
    found = {each["code"]: each for each in header["notes"]}
    assert (found["RBL225"]["line"], found["RBL225"]["time_s"]) == (1, None)
    lines = {"RBL224": f"p.points.toml:{len(points.splitlines()) + 1}: ", "RBL629": "odd.toml:"}
    for code, place in lines.items():
        assert (found[code]["line"], found[code]["time_s"], found[code]["severity"]) == (None, None, "warning")
        assert found[code]["text"].startswith(place) and str(tmp_path) not in found[code]["text"]
    assert len([each for each in header["notes"] if each["code"] == "RBL629"]) == 1
