"""Every input of the corpus keeps the promises of every target; each one that ever broke one is in it."""

from pathlib import Path

import pytest

from tests.fuzz import targets
from tests.fuzz.targets import SEEDS, TARGETS
from tests.steps import calls
from tests.together import together

FOLDER = Path(__file__).with_name("corpus")
PROGRAMS = Path(__file__).parents[2] / "programs"
CORPUS = [path for folder in (FOLDER, PROGRAMS) for path in sorted(folder.rglob("*")) if path.is_file()]


MOST_CALLS = 1000
"""Calls of functions for each byte. Most take a tenth of that; work that grows with the square takes more."""


@pytest.fixture(scope="module", autouse=True)
def what_is_made_once_is_made():
    for target in TARGETS:
        targets.run(target, b"10 MOVE P1\n")


@together("path", CORPUS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_an_input_of_the_corpus_breaks_no_promise(path):
    data = path.read_bytes()
    for target in TARGETS:
        assert calls(targets.run, target, data) <= MOST_CALLS * (len(data) + 100), target


def test_the_corpus_has_inputs_for_every_target():
    for target in TARGETS:
        assert len(list((FOLDER / SEEDS.get(target, "program")).iterdir())) >= 8
