"""What ``import robolang`` offers, and the examples of the page about it."""

import re
import subprocess
import sys

import pytest

import robolang
from robolang import api
from tests.programs.runs import ROOT

PAGE = ROOT.parent / "docs" / "python.md"
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


def test_the_package_offers_what_its_api_does():
    assert set(robolang.__all__) == {*api.__all__, "__version__"}
    assert all(getattr(robolang, name) is getattr(api, name) for name in api.__all__)
    assert set(robolang.__all__) <= set(dir(robolang))  # a prompt completes them
    with pytest.raises(AttributeError):
        _ = robolang.nothing_of_this_name


def test_nothing_is_imported_before_a_name_is_used():
    code = "import sys; before = set(sys.modules); import robolang; print(sorted(set(sys.modules) - before))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown == "['robolang']\n"


@pytest.mark.physics
@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_the_examples_of_the_page_do_what_they_say(monkeypatch, number):
    monkeypatch.chdir(ROOT.parent)
    exec(compile(EXAMPLES[number], f"{PAGE.name}, example {number + 1}", "exec"), {})


def test_the_page_has_examples():
    assert len(EXAMPLES) == 5
