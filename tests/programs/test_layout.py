"""Programs that the project shows have the layout that it recommends."""

import re
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.syntax.formatter import format_source

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted((ROOT / "programs").rglob("*.rbl"))
LISTINGS = re.findall(r"^```rbl\n(.*?)^```$", (ROOT / "README.md").read_text("utf-8"), re.MULTILINE | re.DOTALL)


def test_there_are_programs():
    assert len(PROGRAMS) >= 12
    assert LISTINGS


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.relative_to(ROOT / "programs").as_posix())
def test_a_program_is_as_the_formatter_writes_it(path):
    text = path.read_bytes().decode("utf-8")
    assert format_source(Source(path.name, text)).text == text, "run: robolang fmt programs"


@pytest.mark.parametrize("text", LISTINGS)
def test_a_listing_of_the_readme_is_as_the_formatter_writes_it(text):
    assert format_source(Source("README.md", text)).text == text
