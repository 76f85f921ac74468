"""The paced clock, on a wall clock that the test turns."""

import time

import pytest

from runtime.control import clock


@pytest.fixture
def wall(monkeypatch):
    class Wall:
        now, slept = 100.0, 0.0

        def sleep(self, seconds: float) -> None:
            self.slept += seconds
            self.now += seconds

    fake = Wall()
    monkeypatch.setattr(time, "monotonic", lambda: fake.now)
    monkeypatch.setattr(time, "sleep", fake.sleep)
    return fake


def test_it_waits_until_simulated_time_is_due(wall):
    paced = clock.PacedClock(8000)
    assert [paced.wait_until(t) for t in (0, 8000, 16000)] == [False, False, False]
    assert wall.slept == pytest.approx(0.016)


def test_a_late_start_is_counted_once_and_the_pace_goes_on_from_there(wall):
    paced = clock.PacedClock(8000)
    paced.wait_until(0)
    wall.now += 0.050
    assert paced.wait_until(8000)
    assert not paced.wait_until(16000)
    assert wall.slept == pytest.approx(0.008)


def test_being_late_by_less_than_a_period_is_made_up_for(wall):
    paced = clock.PacedClock(8000)
    paced.wait_until(0)
    wall.now += 0.012
    assert not paced.wait_until(8000)
    assert not paced.wait_until(16000)
    assert wall.slept == pytest.approx(0.004)


def test_the_virtual_clock_never_waits(wall):
    assert not clock.VirtualClock().wait_until(10**9)
    assert wall.slept == 0.0
