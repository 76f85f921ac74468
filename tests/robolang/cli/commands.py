"""Short ways to call the command line in this process and to read what it said."""

import os
import re
import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from robolang.cli.main import app
from tests.steps import HANG_S

ROOT = Path(__file__).parents[3]
BUILTIN = ROOT / "robolang" / "project" / "builtin"
PUMA = ROOT / "runtime" / "robot" / "library" / "puma560.toml"


def robolang(*words, code=0, typed=None):
    """Run a command at 80 columns and check its exit code, None: any; an exception that escapes fails the test.

    ``typed`` is what it reads.
    """
    result = CliRunner(env={"COLUMNS": "80", "TERM": "dumb"}).invoke(app, [str(word) for word in words], input=typed)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert code is None or result.exit_code == code, result.output + result.stderr
    assert "Traceback" not in result.output + result.stderr
    assert "error RBL900" not in result.output + result.stderr
    return result


def dry(program, *words, code=0):
    """Run a program on the ideal arm."""
    return robolang("run", "--no-physics", *words, program, code=code)


def flat(text):
    """The words of a text without the frame that a usage error is printed in."""
    return re.sub(r"[\s│╭╮╰╯─]+", " ", text)


def places(text):
    """``(line, column, code)`` of every diagnostic in a text."""
    found = re.findall(r"^\S.*?:(\d+):(\d+): (?:error|warning|info) (RBL\d{3}) ", text, re.M)
    return [(int(line), int(column), code) for line, column, code in found]


def counted(stderr):
    """How many programs ``check`` says that it has checked."""
    (count,) = re.findall(r"^(\d+) programs? checked$", stderr, re.M)
    return int(count)


def shell(*words, cwd=None, env=None, timeout=HANG_S, **options):
    """Run ``python -m robolang`` as a process."""
    return subprocess.run(
        [sys.executable, "-m", "robolang", *map(str, words)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80", **(env or {})},
        timeout=timeout,
        **{"capture_output": True, "text": True, **options},
    )
