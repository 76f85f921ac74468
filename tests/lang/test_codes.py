import re
import subprocess
import sys

import pytest

import robolang.codes  # noqa: F401
from runtime.faults import all_codes, lookup


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
        "import sys, robolang.parser, robolang.checker, robolang.interpreter, robolang.points, robolang.printer\n"
        "heavy = {'numpy', 'pinocchio', 'mujoco', 'rich', 'typer', 'ruckig'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_no_remedy_says_that_the_language_is_smaller_than_it_is():
    for code in ("RBL112", "RBL117"):
        assert "WRIST and SEAM" not in lookup(code).remedy
