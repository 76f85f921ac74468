"""Runs of the programs of ``programs/`` on MuJoCo that several tests look at: each is made once."""

from functools import cache
from pathlib import Path

from robolang.execution.session import RunResult, Session
from robolang.project.project import load_project
from tests.campaign import WHOLE

ROOT = Path(__file__).parents[2] / "programs"
PROGRAMS = tuple(sorted(ROOT.rglob("*.rbl")))


def some_programs(*stems: str) -> list[Path]:
    """Return all programs, or in a sample those of these names."""
    assert {path.stem for path in PROGRAMS} >= set(stems)
    return [path for path in PROGRAMS if WHOLE or path.stem in stems]


@cache
def run(name: str) -> tuple[Session, RunResult]:
    """Return the session of a program, by its path below ``programs``, and its result; neither may be changed."""
    session = Session(load_project(ROOT / name))
    return session, session.run()
