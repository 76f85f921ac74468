"""Identifications that several tests look at: each is made once."""

from functools import cache
from pathlib import Path

from robolang.identify import identify, with_errors
from robolang.trial_motion import Request
from runtime.robot.loader import load_builtin

ROOT = Path(__file__).parents[2]
SPEC = load_builtin("puma560")
N2 = SPEC.per_axis("motor", "gear_ratio") ** 2
SEEDS = (0, 3, 4, 8)


@cache
def experiment(robot="puma560", plant="mujoco", seed=None, axes=(0, 1, 2), mixed=False, positions=5, table=0):
    spec = load_builtin(robot)
    real = None if seed is None else with_errors(spec, seed, mixed=mixed)
    request = Request(robot=spec, axes=axes, plant=plant, real=real, positions=positions, table=table)
    return request, identify(request)
