import re
import subprocess
import sys
from pathlib import Path

import pytest

import robolang.lint.registry  # noqa: F401
from robolang.analysis.rules import checks
from runtime.core.faults import all_codes, lookup

ROOT = Path(__file__).parents[3]


def test_every_code_is_complete():
    for code in all_codes():
        assert re.fullmatch(r"RBL[1-9]\d\d", code.code)
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", code.name)
        assert code.meaning.endswith(".")
        assert code.remedy.endswith(".")


@pytest.mark.parametrize(
    "code",
    [
        "RBL103",
        "RBL120",
        "RBL201",
        "RBL202",
        "RBL220",
        "RBL301",
        "RBL306",
        "RBL311",
        "RBL401",
        "RBL415",
        "RBL501",
        "RBL508",
        "RBL534",
        "RBL601",
        "RBL701",
        "RBL900",
    ],
)
def test_one_import_fills_the_registry(code):
    assert lookup(code).code == code


def test_the_front_end_imports_nothing_heavy():
    program = (
        "import sys, robolang.core.codes, robolang.syntax.parser, robolang.analysis.checker\n"
        "import robolang.interpreter.machine, robolang.project.points\n"
        "import robolang.lint.registry, robolang.syntax.unparse\n"
        "heavy = {'numpy', 'pinocchio', 'mujoco', 'rich', 'typer', 'ruckig'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_no_remedy_says_that_the_language_is_smaller_than_it_is():
    assert "WRIST and SEAM" not in lookup("RBL112").remedy


EVERYTHING = """
import importlib, pkgutil, robolang, runtime
for package in (robolang, runtime):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
"""


def registered(program):
    """Every code and name that a process knows after some imports."""
    after = (
        "\nfrom runtime.core.faults import all_codes\nfor entry in all_codes():\n    print(entry.code, entry.name)\n"
    )
    done = subprocess.run([sys.executable, "-c", program + after], check=True, capture_output=True, text=True)
    return done.stdout.splitlines()


def test_one_import_knows_as_many_codes_as_all_modules_together():
    """A code that only a heavy module registers is unknown to ``robolang check --select`` and ``robolang explain``."""
    whole = registered(EVERYTHING)
    assert len(whole) > 120
    assert registered("import robolang.lint.registry") == whole


def test_a_code_that_nothing_raises_is_not_registered():
    """A lint rule is raised by its own object; that its example raises it is tested in ``lint/test_registry.py``."""
    known = {entry.code for entry in all_codes()}
    lint_rules = {rule.code.code for check in checks() for rule in check.rules}
    places = [
        path.read_text("utf-8")
        for folder in ("robolang", "runtime")
        for path in (ROOT / folder).rglob("*.py")
        if path.name not in ("codes.py", "run_codes.py")
    ]
    used = (re.sub(r"\b(?:Code|Rule)\(\s*code=\"RBL\d{3}\"", "", text) for text in places)
    raised = {code for text in used for code in re.findall(r"\"(RBL\d{3})\b", text)}
    assert known - raised - lint_rules == set()
