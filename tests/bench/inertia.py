"""``make bench``: what the inertia of an axis costs by each way that the repository has.

Experiment B7 (docs/motor-inertia.md). All ways take their turn in every round, so that they meet the same speed of the
machine; the medians over the rounds, and their ratios, are printed. Nothing is promised: times depend on the machine.
"""

import statistics
import time
from collections.abc import Callable, Iterator

import numpy as np

from runtime.dynamics.motor_inertia import axis_inertia, inertia_row, link_chain, link_inertia
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel
from tests.bench import figures
from tests.bench.figures import Row
from tests.runtime.dynamics import lagrangian

POSTURES = 1000
FEW = 8
"""Postures of one round of the ways that take them one by one."""


def ways(name: str) -> dict[str, tuple[int, Callable[[], object]]]:
    """Return by name what one round does, and for how many axes and postures together."""
    spec = load_builtin(name)
    chain, model, rows, axes = link_chain(spec), ArmModel(spec), lagrangian.published(name), range(spec.n)
    q = np.random.default_rng(7).uniform(spec.lower, spec.upper, (POSTURES, spec.n))
    few, one = q[:FEW], q[0]

    def each(call: Callable[[np.ndarray, int], object]) -> Callable[[], object]:
        return lambda: [call(posture, axis) for posture in few for axis in axes]

    whole = FEW * spec.n
    return {
        f"all axes at once, {POSTURES} postures": (POSTURES * spec.n, lambda: link_inertia(chain, q)),
        "all axes at once, one posture": (spec.n, lambda: link_inertia(chain, one)),
        "the recursion word for word": (whole, each(lambda p, i: axis_inertia(chain, p, i))),
        "the same on to the base (a row)": (whole, each(lambda p, i: inertia_row(chain, p, i))),
        "pinocchio, rnea of one column": (whole, each(model.inertia_column)),
        "pinocchio, crba / n": (whole, lambda: [model.mass_matrix(p) for p in few]),
        "Lagrangian of the tests / n": (whole, lambda: [lagrangian.mass_matrix(rows, p) for p in few]),
    }


def measure(name: str, rounds: int) -> dict[str, float]:
    """Return the median time of an axis and posture by each way, us."""
    times: dict[str, list[float]] = {}
    todo = ways(name)
    for _, run in todo.values():
        run()  # what is made once is made before
    for _ in range(rounds):
        for way, (count, run) in todo.items():
            started = time.perf_counter()
            run()
            times.setdefault(way, []).append((time.perf_counter() - started) / count * 1e6)
    return {way: statistics.median(found) for way, found in times.items()}


def rows(smallest: bool) -> Iterator[Row]:
    """Measure all ways on the Puma."""
    found = measure("puma560", 1 if smallest else 15)
    batch, *_, lagrange = found.values()
    pass_, matrix = found["pinocchio, rnea of one column"], found["pinocchio, crba / n"]
    yield Row(
        figure="recursion, all axes of 1000 postures at once, per axis and posture",
        form="{:.2g} us; 1/{:.0f} of Pinocchio's pass, 1/{:.0f} of its mass matrix, 1/{:.0f} of the Lagrangian",
        values=(batch, pass_ / batch, matrix / batch, lagrange / batch),
        details=tuple(f"{way:<36} {us:>8.3g} us, {us / batch:>6.4g} times" for way, us in found.items()),
    )


if __name__ == "__main__":
    figures.run(rows)
