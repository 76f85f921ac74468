"""Experiment A3 of docs/measured.md: what the background costs is paid by the background alone."""

import numpy as np
import pytest

from runtime.control.dynamics_task import DynamicsTask, StepCosts
from runtime.control.memory_areas import Areas
from runtime.control.scheduler import IdleProcessor
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload

PERIOD_US = 8000
TICK_US = 1000
STEPS = 4
"""Steps 302 to 308 of Fig 7 for one axis."""


class Bench:
    """The dynamics task alone on a processor whose encoders turn a little at every servo tick."""

    def __init__(self, Ci_us: int, Cd_us: int) -> None:
        self.Ci_us = Ci_us
        self.q = np.array([0.1, 0.8, -1.2, 0.3, 0.5, 0.2])
        self.model = ArmModel(load_builtin("puma560"))
        self.areas = Areas(6, self.q)
        self.refreshes: list[tuple[int, int, int]] = []
        self.readings: list[float] = []
        self.interrupts: list[int] = []
        self.cpu = IdleProcessor(DynamicsTask(self.areas, self.model, StepCosts.of_axis(Cd_us), self.read))

    def read(self) -> np.ndarray:
        self.readings.append(float(self.q[0]))
        return self.q

    def run(self, cycles: int) -> None:
        seen = [cell.version for cell in self.areas.ita]
        for cycle in range(cycles):
            self.interrupts.append(self.cpu.now_us)
            self.cpu.begin_cycle(self.Ci_us)
            for tick in range(PERIOD_US // TICK_US):
                self.q = self.q + 1e-4
                self.cpu.advance(cycle * PERIOD_US + (tick + 1) * TICK_US)
                for axis, cell in enumerate(self.areas.ita):
                    if cell.version != seen[axis]:
                        seen[axis] = cell.version
                        self.refreshes.append((axis, self.cpu.now_us, cell.read_us))


def monolithic(Ci_us: int, Cd_us: int) -> float:
    """Time between two points, ms, of one program that interpolates and then does every step of Fig 7 for six axes."""
    areas = Areas(6, np.zeros(6))
    model, costs = ArmModel(load_builtin("puma560")), StepCosts.of_axis(Cd_us)
    task, total_us = DynamicsTask(areas, model, costs, lambda: areas.ina), Ci_us
    for _ in range(6 * STEPS):
        total_us += task.cost_us
        task.work(0)
    return total_us / 1000.0


@pytest.mark.parametrize(
    ("Ci_ms", "Cd_ms", "refresh_ms", "monolithic_ms"),
    [(5, 2.5, 40.0, 20.0), (5, 4, 64.0, 29.0), (3, 1, 9.6, 9.0), (7, 3, 144.0, 25.0)],
)
def test_refresh_time_follows_the_formula_and_the_period_stays(Ci_ms, Cd_ms, refresh_ms, monolithic_ms):
    bench = Bench(int(Ci_ms * 1000), int(Cd_ms * 1000))
    bench.run(cycles=1800)
    of_axis_2 = [t for axis, t, _ in bench.refreshes if axis == 2]
    assert np.mean(np.diff(of_axis_2)) / 1000.0 == pytest.approx(refresh_ms, rel=0.01)
    assert bench.cpu.overruns == 0
    assert monolithic(int(Ci_ms * 1000), int(Cd_ms * 1000)) == monolithic_ms


def test_every_axis_reads_its_own_angles():
    bench = Bench(5000, 2500)
    bench.run(cycles=30)
    assert [axis for axis, _, _ in bench.refreshes[:6]] == [0, 1, 2, 3, 4, 5]
    assert (np.diff([read_us for _, _, read_us in bench.refreshes[:6]]) >= 2500).all()
    assert (np.diff(bench.readings[:6]) > 0.0).all()


def test_a_step_longer_than_the_idle_time_goes_on_in_the_next_cycle():
    bench = Bench(7000, 24_000)  # one axis takes 24 cycles of 1 ms idle time each
    bench.run(cycles=25)
    assert [(axis, t) for axis, t, _ in bench.refreshes] == [(0, 24 * PERIOD_US)]


def test_a_load_reaches_the_axes_one_by_one_within_one_refresh():
    bench = Bench(3000, 1000)
    bench.run(cycles=3)
    before = [cell.D for cell in bench.areas.ita]
    bench.areas.declare(Payload(mass=2.3, cog=np.array([0.0, 0.0, 0.095])))
    versions = []
    for _ in range(3):
        bench.cpu.begin_cycle(3000)
        bench.cpu.advance(bench.cpu.now_us + PERIOD_US)
        versions.append(sum(cell.payload_version == 1 for cell in bench.areas.ita))
    assert versions[0] not in (0, 6)
    assert versions[1] == 6
    assert all(cell.D > old for cell, old in list(zip(bench.areas.ita, before, strict=True))[:5])


def test_a_foreground_longer_than_the_period_is_counted_and_starves_the_background():
    bench = Bench(9000, 1000)
    bench.run(cycles=10)
    assert bench.cpu.overruns == 9
    assert bench.refreshes == []


def test_a_foreground_that_is_late_again_and_again_falls_further_behind():
    """Ci of 9 ms in cycles of 8 ms: after k cycles the foreground owes k ms, and the background waits for all of it."""
    bench = Bench(9000, 100)
    bench.run(cycles=5)
    assert bench.cpu.overruns == 4
    for _ in range(2):  # idle cycles: 5 ms are still owed in the first
        bench.cpu.begin_cycle(0)
        bench.cpu.advance(bench.cpu.now_us + PERIOD_US)
    assert sum(bench.areas.refreshes) == (2 * PERIOD_US - 5000) // 100


def test_the_longest_refresh_is_the_longest_and_not_the_last():
    areas = Areas(1, np.zeros(1))
    load = areas.ita[0]
    for now_us in (1000, 3000, 40_000, 45_000):
        areas.publish(0, load, now_us)
    assert areas.longest_refresh_us == 37_000
    assert areas.mean_refresh_us == pytest.approx(44_000 / 3)
