"""An install with few libraries: what checks text works, everything else says what it needs."""

import re
import subprocess
import sys

import pytest

from tests.programs.runs import ROOT

HEAVY = ("google", "mcap", "mcap_protobuf", "mujoco", "numpy", "pinocchio", "prompt_toolkit", "ruckig", "websockets")
TABLES = ("rich", "typer", "tomlkit")


def run(missing, *words):
    """A command without some libraries: Python takes a name that is None for a module that is not there."""
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({missing!r}));"
        f"sys.argv = ['robolang', *{words!r}]; from robolang.__main__ import main; main()"
    )
    return subprocess.run([sys.executable, "-c", code], cwd=ROOT.parent, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("form", ["full", "sarif", "junit", "github", "json"])
def test_text_is_checked_with_lark_alone(form):
    done = run((*HEAVY, *TABLES), "check", "programs", "--output-format", form)
    assert done.returncode == 0


@pytest.mark.parametrize(
    "words",
    [("fmt", "--check", "programs/pick_and_place.rbl"), ("explain", "RBL412"), ("rules",), ("--help",)],
    ids=" ".join,
)
def test_what_needs_no_numbers_works_with_typer(words):
    assert run(HEAVY, *words).returncode == 0


@pytest.mark.parametrize(
    ("missing", "words", "library"),
    [
        (HEAVY, ("run", "programs/pick_and_place.rbl"), "numpy"),
        (HEAVY, ("check", "--motion", "programs/pick_and_place.rbl"), "numpy"),
        (("mujoco",), ("run", "programs/pick_and_place.rbl"), "mujoco"),
        ((*HEAVY, *TABLES), ("run", "programs/pick_and_place.rbl"), "typer"),
        ((*HEAVY, *TABLES), ("--help",), "typer"),
    ],
)
def test_what_needs_more_says_so(missing, words, library):
    done = run(missing, *words)
    assert done.returncode == 2
    assert {"RBL845", library} <= set(re.findall(r"\w+", done.stderr.splitlines()[0]))
    assert "Traceback" not in done.stderr
