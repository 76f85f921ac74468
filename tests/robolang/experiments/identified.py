"""Identifications that several tests look at: each is made once."""

from functools import cache
from pathlib import Path

from robolang.experiments.excitation import Request
from robolang.experiments.identify import identify, with_errors
from runtime.robot.files.loader import load_builtin
from tests.campaign import size, some

ROOT = Path(__file__).parents[3]
SPEC = load_builtin("puma560")
N2 = SPEC.per_axis("motor", "gear_ratio") ** 2
SEEDS = some((0, 3, 4, 8), 3)
"""Of seed 0 a constant reaches less than of the others."""
WITH_TABLE = some((0, 3, 4, 8), 0)
TABLE_AXES = tuple(some((0, 1), 1))
"""Axes with a table: that of J1 is over two joints, five times the postures of J2's."""
POSITIONS = size(5, 3)
"""Of an axis; fewer do not tell weight from friction."""


@cache
def experiment(robot="puma560", plant="mujoco", seed=None, axes=(0, 1, 2), mixed=False, positions=POSITIONS, table=0):
    spec = load_builtin(robot)
    real = None if seed is None else with_errors(spec, seed, mixed=mixed)
    request = Request(robot=spec, axes=axes, plant=plant, real=real, positions=positions, table=table)
    return request, identify(request)
