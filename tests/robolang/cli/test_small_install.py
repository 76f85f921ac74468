"""An install with few libraries: what checks text works, everything else says what it needs."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.programs.runs import ROOT

HEAVY = ("google", "mcap", "mcap_protobuf", "mujoco", "numpy", "pinocchio", "prompt_toolkit", "ruckig", "websockets")
WITHOUT_MESHES = [str(path.relative_to(ROOT.parent)) for path in sorted(ROOT.rglob("*.rbl")) if path.stem != "nuts"]
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
    done = run((*HEAVY, *TABLES), "check", *WITHOUT_MESHES, "--output-format", form)
    assert done.returncode == 0


def test_a_mesh_that_cannot_be_read_for_want_of_numbers_is_refused_where_it_is_named():
    done = run((*HEAVY, *TABLES), "check", "programs", "--output-format", "json")
    found = json.loads(done.stdout)
    assert done.returncode != 0
    assert {each["code"] for each in found} == {"RBL643"}
    assert {Path(each["file"]).name for each in found} == {"nuts.cell.toml"}
    assert all("numpy" in each["message"] for each in found)


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
