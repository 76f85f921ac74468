import math

import pytest

from robolang.teaching.dead_man import ALIVE_S
from robolang.teaching.held_button import HeldButton

ALIVE_MS = round(ALIVE_S * 1000)


@pytest.fixture
def button():
    return HeldButton()


def test_a_press_holds_until_it_expires(button):
    press = button.press(1, 7, 10.0)
    assert button.holds(press, 10.0)
    assert button.holds(press, 10.0 + ALIVE_S / 2)
    assert not button.holds(press, 10.0 + ALIVE_S + 0.001)


def test_a_sign_holds_it_longer(button):
    press = button.press(1, 7, 10.0)
    for ms in range(0, 2000, ALIVE_MS - 20):
        assert button.keep(1, 7, 10.0 + ms / 1000)
    assert button.holds(press, 12.1)
    assert not button.holds(press, 12.5)


def test_what_has_expired_is_not_revived(button):
    press = button.press(1, 7, 10.0)
    late = 10.0 + ALIVE_S + 0.01
    assert not button.keep(1, 7, late)
    assert not button.keep(1, 7, late)
    assert not button.holds(press, late)


def test_what_was_released_is_not_revived(button):
    press = button.press(1, 7, 10.0)
    button.release(1, 7)
    assert not button.keep(1, 7, 10.01)
    assert not button.holds(press, 10.01)


@pytest.mark.parametrize(("page", "jog"), [(2, 7), (1, 6), (2, None)])
def test_a_sign_or_a_release_of_another_button_changes_nothing(button, page, jog):
    press = button.press(1, 7, 10.0)
    if jog is not None:
        assert not button.keep(page, jog, 10.15)
    button.release(page, jog)
    assert button.holds(press, 10.0)
    assert not button.holds(press, 10.0 + ALIVE_S + 0.001)


@pytest.mark.parametrize("of", [(), (1,), (1, 7)])
def test_a_release_of_all_of_a_page_or_of_a_jog_ends_it(button, of):
    press = button.press(1, 7, 10.0)
    button.release(*of)
    assert not button.holds(press, 10.0)


def test_another_press_ends_the_first_one(button):
    first = button.press(1, 7, 10.0)
    second = button.press(1, 8, 10.0)
    assert not button.holds(first, 10.0)
    assert button.holds(second, 10.0)


@pytest.mark.parametrize("now", [math.nan, math.inf, -math.inf, 9.0])
def test_a_time_that_is_none_or_runs_backward_holds_nothing(button, now):
    press = button.press(1, 7, 10.0)
    assert not button.holds(press, now)
    assert not button.keep(1, 7, now)
