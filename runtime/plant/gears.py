"""How fast the gear springs of an arm swing, which sets the physics step of the plant.

Let R = diag(N^2 J), M(q) the inertia of the links and K the springs of the elastic axes. With e the rows and columns of
those axes, motor angles and twists (link minus motor) have the inertia

    [ M + R   M_e  ]
    [ M_e'    M_ee ]        (runtime.plant.mjcf)

and with W the block of its inverse that belongs to the twists, the springs alone give ``twist'' = -W K twist``. The
frequencies are the roots of the eigenvalues of W K. One axis alone: w = sqrt(K (1/(N^2 J) + 1/M)), two masses on a
spring. MuJoCo steps springs with the new speed and the old angle (semi-implicit Euler), which is stable for w h < 2
and makes the frequency wrong by (w h)^2 / 24. Called once when a plant is made.
"""

import math

import numpy as np

from runtime.core.decompositions import inverse_of, symmetric_eigen
from runtime.core.frames import Array
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.spec import RobotSpec

PHASE_PER_STEP = 0.25
"""Largest w h of a gear spring, rad: its frequency is then right to 0.3 %."""

POSTURES = 64


def elastic_axes(spec: RobotSpec) -> list[int]:
    """Return the indices of the m axes whose gear is a spring."""
    return [index for index, axis in enumerate(spec.axes) if axis.motor.elastic]


def spring_frequencies(spec: RobotSpec, q: Array) -> Array:
    """Return the angular frequencies (m,) rad/s of the gear springs of the bare arm at q (n,) rad, ascending."""
    elastic = elastic_axes(spec)
    M = ArmModel(spec).mass_matrix(q)
    motors_and_twists = np.block(
        [[M + np.diag(spec_rotors(spec)), M[:, elastic]], [M[elastic], M[np.ix_(elastic, elastic)]]]
    )
    W = inverse_of(motors_and_twists)[spec.n :, spec.n :]
    root_K = np.sqrt(spec.per_axis("motor", "stiffness")[elastic])
    # W K has the eigenvalues of K^1/2 W K^1/2, which is symmetric: its solver gives real ones
    squares = symmetric_eigen(root_K[:, None] * W * root_K)[0]
    return np.sqrt(np.maximum(squares, 0.0))


def fastest_spring(spec: RobotSpec) -> float:
    """Return the highest frequency of a gear spring over the joint ranges, rad/s; 0 for a robot with rigid gears.

    Sampled at fixed pseudo-random postures of the bare arm; a load makes every spring slower.
    """
    if not elastic_axes(spec):
        return 0.0
    postures = np.random.default_rng(560).uniform(spec.lower, spec.upper, (POSTURES, spec.n))
    return float(np.max([spring_frequencies(spec, q)[-1] for q in postures]))


def physics_steps(spec: RobotSpec, tick_s: float, longest_s: float) -> int:
    """Return the number of equal physics steps in a tick: none longer than ``longest_s`` s or a spring allows."""
    fastest = fastest_spring(spec)
    step = longest_s if fastest == 0.0 else min(longest_s, PHASE_PER_STEP / fastest)
    return max(1, math.ceil(tick_s / step - 1e-9))  # the ratio of two equal periods may be 1 + rounding: one step
