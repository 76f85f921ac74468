"""Which library draws, and what is refused where there is none."""

import os

import pytest

from runtime.core.faults import Fault
from runtime.plant import graphics
from runtime.plant.graphics import VARIABLE, open_graphics
from tests.runtime.plant.drawing import need_graphics

ABSENT = "libNoSuchThing.so.1"


@pytest.fixture(autouse=True)
def environment(monkeypatch):
    # restored afterwards, although the code under test writes it
    monkeypatch.setenv(VARIABLE, "")


def test_egl_is_the_first_choice_and_the_environment_follows():
    need_graphics()
    found = open_graphics()
    found.close()
    assert found.title.lower() == os.environ[VARIABLE]


@pytest.mark.parametrize("name", ["egl", "osmesa", " OSMesa "])
def test_a_user_chooses_by_the_variable_of_mujoco(monkeypatch, name):
    monkeypatch.setenv(VARIABLE, name)
    need_graphics()
    found = open_graphics()
    found.close()
    assert found.title.lower() == name.strip().lower()


def test_without_egl_osmesa_draws(monkeypatch):
    monkeypatch.setattr(graphics, "EGL_LIBRARY", ABSENT)
    need_graphics()
    found = open_graphics()
    found.close()
    assert (found.title, os.environ[VARIABLE]) == ("OSMesa", "osmesa")


def test_an_egl_without_a_device_is_not_taken(monkeypatch):
    monkeypatch.setattr(graphics, "_MOST_DEVICES", 0)
    need_graphics()
    found = open_graphics()
    found.close()
    assert found.title == "OSMesa"


def test_two_contexts_of_one_kind_follow_one_another():
    need_graphics()
    for _ in range(2):
        open_graphics().close()


@pytest.mark.parametrize("chosen", ["", "egl", "osmesa"])
def test_where_nothing_draws_the_packages_are_named(monkeypatch, chosen):
    monkeypatch.setenv(VARIABLE, chosen)
    monkeypatch.setattr(graphics, "EGL_LIBRARY", ABSENT)
    monkeypatch.setattr(graphics, "OSMESA_LIBRARIES", (ABSENT,))
    with pytest.raises(Fault) as refused:
        open_graphics()
    assert refused.value.code == "RBL830"
    assert "libegl1" in refused.value.hint
    assert "libosmesa6" in refused.value.hint
    assert refused.value.message.count(ABSENT) == (1 if chosen else 2)
    assert os.environ[VARIABLE] == chosen
