"""What ``check`` accepts, a run does not refuse for a reason that was knowable, and the other way round.

A sample of ``make verdict-campaign``; the verdicts are in ``verdicts``.
"""

from dataclasses import replace

import pytest

from robolang.analysis import expression_check, statement_check
from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.diagnostics import has_errors
from robolang.core.source import Source, read_program
from robolang.lint import engine
from robolang.lint.engine import check_source
from robolang.project.project import load_project
from tests.robolang.verdicts import case, disagreement

SAMPLE = range(80)


def differing(folder):
    for number in SAMPLE:
        if found := disagreement(case(number), folder):
            yield number, found


def test_check_and_a_run_agree(tmp_path):
    assert list(differing(tmp_path)) == []


def test_check_and_a_run_have_the_same_facts(tmp_path):
    """One value holds every fact of the cell and its points; a run takes it over from the analysis of the check."""
    compared = 0
    for number in SAMPLE:
        made = case(number)
        for name, text in (("p.rbl", made.program), ("p.cell.toml", made.cell), ("p.points.toml", made.points)):
            (tmp_path / name).write_text(text)
        found = check_source(read_program(tmp_path / "p.rbl"))
        if not found.faults:
            facts = load_project(tmp_path / "p.rbl").analysis.cell
            assert facts == found.analysis.cell
            assert None not in [getattr(facts, name) for name in CellSymbols.FIELDS]
            assert load_project(found.analysis).analysis is found.analysis
            compared += 1
    assert compared > len(SAMPLE) / 2


def test_half_of_the_sample_is_refused_and_half_is_carried_out(tmp_path):
    """A sample that is all of one kind would show nothing."""
    clean = 0
    for number in SAMPLE:
        made = case(number)
        for name, text in (("p.cell.toml", made.cell), ("p.points.toml", made.points)):
            (tmp_path / name).write_text(text)
        found = check_source(Source(str(tmp_path / "p.rbl"), made.program))
        clean += not (found.faults or has_errors(found.diagnostics))
    assert 0.3 < clean / len(SAMPLE) < 0.7


@pytest.mark.parametrize("fault", ["payload", "range", "cell"])
def test_a_seeded_disagreement_is_found(tmp_path, monkeypatch, fault):
    if fault == "payload":
        monkeypatch.setattr(statement_check, "mass_fault", lambda mass, rated: None)
    elif fault == "range":
        monkeypatch.setattr(expression_check, "beyond_range", lambda q_deg, limits: "")
    else:
        read = vars(engine)["read_beside"]
        monkeypatch.setattr(engine, "read_beside", lambda *given: replace(read(*given), faults=()))
    assert next(differing(tmp_path), None) is not None
