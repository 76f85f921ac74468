"""The bottom lines: every fact on any width, none in a colour alone."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.pendant.status import ArmFacts, Facts, status_lines

ARM = ArmFacts(
    frame="PALLET",
    tool="GRIP",
    declared_kg=2.3,
    felt_kg=2.25,
    joints=(-8.13, 77.0, -183.1, 0.0, -73.9, -0.0001),
    pose=(480.0, -220.0, 840.0, 180.0, -0.001, 180.0),
    limit="J5 26.1 deg",
    singular="wrist 4.2 deg",
    holding="part",
    seconds=12.345,
)
FACTS = Facts(mode="AUTO", armed=True, program="job.rbl", unsaved=True, place="next MOVE P1", alarm="RBL501", arm=ARM)

SHOWN = (
    *("AUTO", "ARMED", "ALARM RBL501", "PALLET", "GRIP", "2.3", "2.25", "12.345 s", "77.0", "840.0"),
    *("J5 26.1 deg", "wrist 4.2 deg", "part", "job.rbl", "(unsaved)"),
)


def texts(facts, columns):
    return ["".join(fragment[1] for fragment in line) for line in status_lines(facts, columns)]


@pytest.mark.parametrize("columns", [40, 60, 80, 100, 120, 200])
def test_every_fact_is_shown(columns):
    lines = texts(FACTS, columns)
    assert all(len(line) <= columns for line in lines)
    text = "  ".join(lines)
    for fact in SHOWN:
        assert fact in text, (fact, lines)


@pytest.mark.parametrize(("columns", "most"), [(200, 3), (100, 3), (80, 4)])
def test_lines_are_few(columns, most):
    assert len(texts(FACTS, columns)) <= most


def test_zero_has_no_sign():
    assert "-0.0 " not in "  ".join([*texts(FACTS, 200), *texts(FACTS, 60)]).replace("-0.00 ", "-0.0 ")


def test_without_a_controller_it_is_shown_why():
    facts = Facts(mode="MANUAL", armed=False, program="job.rbl", unsaved=False, starting="starting")
    assert texts(facts, 80) == ["MANUAL  not armed  starting  job.rbl"]


@given(st.integers(1, 300), st.text(max_size=300), st.text(max_size=50))
def test_any_names_fit_any_width(columns, place, program):
    facts = Facts(mode="MANUAL", armed=False, program=program, unsaved=False, place=place, arm=ARM)
    assert all(len(line) <= columns for line in texts(facts, columns))
