"""Runs of the programs of ``programs/`` on MuJoCo that several tests look at: each is made once."""

from functools import cache
from pathlib import Path

from robolang.execution.session import RunResult, Session
from robolang.project.project import load_project

ROOT = Path(__file__).parents[2] / "programs"


@cache
def run(name: str) -> tuple[Session, RunResult]:
    """Return the session of a program, by its path below ``programs``, and its result; neither may be changed."""
    session = Session(load_project(ROOT / name))
    return session, session.run()
