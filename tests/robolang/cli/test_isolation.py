"""R26: nothing beside a program is code. Modules planted in the working folder are not imported, programs not run."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.campaign import some
from tests.robolang.cli.commands import ROOT
from tests.steps import HANG_S

SCRIPT = Path(sys.executable).with_name("robolang")
NAMES = (
    "lark",
    "typer",
    "click",
    "rich",
    "numpy",
    "pinocchio",
    "mujoco",
    "ruckig",
    "tomllib",
    "tomlkit",
    "runtime",
    "json",
    "ctypes",
    "struct",
    "multiprocessing",
    "encodings",
    "difflib",
    "pathlib",
    "dataclasses",
    "typing",
    "tempfile",
    "unicodedata",
    "runpy",
    "sitecustomize",
    "usercustomize",
    "glfw",
)
PROGRAM = '10 PRINT "it ran"\n20 MOVE P1\n30 WHILE 1\n40 WEND\n'


@pytest.fixture
def folder(tmp_path):
    """A program, and modules that leave a trace in a folder of their own when one imports them."""
    (tmp_path / "traces").mkdir()
    for name in NAMES:
        plant(tmp_path, name)
    (tmp_path / "job.rbl").write_text(PROGRAM)
    return tmp_path


def plant(folder, name):
    (folder / f"{name}.py").write_text(f"open({str(folder / 'traces' / name)!r}, 'w').close()\nraise SystemExit(99)\n")


def done(folder, *words):
    env = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONSAFEPATH")}
    return subprocess.run(list(map(str, words)), cwd=folder, env=env, capture_output=True, text=True, timeout=HANG_S)


def traces(folder):
    return sorted(os.listdir(folder / "traces"))


@pytest.mark.parametrize("name", ["lark", "typer", "tomllib", "runtime"])
def test_a_planted_module_is_noticed_when_it_is_imported(folder, name):
    assert done(folder, sys.executable, "-c", f"import {name}").returncode == 99
    assert traces(folder) == [name]


@pytest.mark.parametrize(
    "words",
    [
        ("check", "job.rbl"),
        ("check", "--motion", "job.rbl"),
        ("check", "--output-format", "sarif"),
        ("fmt", "--check", "job.rbl"),
        ("rules",),
        ("explain", "RBL412"),
        ("--version",),
    ],
    ids=" ".join,
)
@pytest.mark.parametrize("form", some(["script", "module"], 0))
def test_nothing_is_imported_from_the_working_folder(folder, form, words):
    if form == "script":
        plant(folder, "robolang")  # with python -m it would be what -m names: that is the rule of Python
    before = [str(SCRIPT)] if form == "script" else [sys.executable, "-m", "robolang"]
    result = done(folder, *before, *words)
    assert traces(folder) == []
    assert result.returncode in (0, 1, 3)
    assert "Traceback" not in result.stderr
    if words[0] == "check":  # nothing is executed
        assert "it ran" not in result.stdout


@pytest.mark.parametrize("form", some(["script", "module"], 1))
def test_processes_that_a_command_starts_import_nothing_from_it(folder, form):
    (folder / "job.rbl").write_text("MOVE P1\n")
    before = [str(SCRIPT)] if form == "script" else [sys.executable, "-m", "robolang"]
    words = ("compare", "--jobs", "2", "--no-physics", "--only", "scheduled,diagonal", "--json", "job.rbl")
    result = done(folder, *before, *words)
    assert traces(folder) == []
    assert result.returncode in (0, 3), result.stderr
    assert len(json.loads(result.stdout)["variants"]) == 2


def test_from_its_own_folder_robolang_is_found(tmp_path):
    """A checkout without an installation: the working folder is where the package is."""
    result = done(ROOT, sys.executable, "-m", "robolang", "check", "programs/pick_and_place.rbl")
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
