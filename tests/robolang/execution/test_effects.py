"""Every kind of effect is carried out on every target, and a kind that none knows is refused at once."""

from dataclasses import dataclass
from typing import get_args

import pytest

from robolang.execution.controller_target import ControllerTarget
from robolang.execution.dry_run import _DryRun, rehearse
from robolang.execution.observer import Observer
from robolang.execution.session import Session
from robolang.execution.target import Effects
from robolang.interpreter.effects import Drain, Effect, OfStatement, origin
from robolang.interpreter.machine import Machine
from robolang.project.project import load_project
from robolang.pulse_tables.table_target import TableTarget
from tests.programs.runs import ROOT

KINDS = get_args(Effect)
TARGETS = [ControllerTarget, _DryRun, TableTarget]


class Seen(Observer):
    """The kinds of effects that were carried out."""

    def __init__(self):
        self.kinds = set()

    def effect_done(self, effect):
        self.kinds.add(type(effect))


def project_of(tmp_path, text):
    for path in (ROOT / "wrist").glob("*.toml"):  # a cell with a seam sensor
        (tmp_path / path.name.replace("seam.", "p.")).write_text(path.read_text())
    (tmp_path / "p.rbl").write_text(text)
    return load_project(tmp_path / "p.rbl")


@pytest.mark.parametrize("target", TARGETS)
def test_a_target_has_a_method_for_every_kind(target):
    methods = [name for name in vars(Effects) if not name.startswith("_")]
    assert len(methods) == len(KINDS) + 2  # and ``begin``, ``rehearse``
    assert all(callable(getattr(target, name, None)) for name in methods)


ALL = """HAND OFF
LOAD (0, 0, 0), 0
WRIST AUTO
SEAM ON, torch
SEAM OFF
TOOL FLANGE
OUT(1) = 1
PRINT 1
DELAY 0.1
MOVEJ P1
STOP
"""


def test_one_program_has_every_kind(tmp_path):
    observer = Seen()
    assert Session(project_of(tmp_path, ALL), physics=False, observer=observer).run().ok
    assert observer.kinds == set(KINDS) - {Drain}  # nothing is done at a Drain: motion has ended


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknown(OfStatement):
    """An effect that was added to the machine alone."""


@pytest.mark.parametrize("carry_out", [rehearse, lambda project: Session(project, physics=False).run()])
def test_a_kind_that_no_target_knows_is_refused_at_once(tmp_path, monkeypatch, carry_out):
    project = project_of(tmp_path, "PRINT 1\n")
    line = project.program.statements[0]
    monkeypatch.setattr(Machine, "step", lambda self: Unknown(**origin(line, line.statement)))
    with pytest.raises(AssertionError, match="Unknown"):
        carry_out(project)
