"""Drives without limits, for experiments on the equations alone.

The closed loop of docs/servo.md is derived with a current loop that follows at once, no current or torque limit and an
exact encoder. ``ideal_drives`` gives a robot such drives; bodies, gears, rotors and bandwidths stay what they are.
"""

from dataclasses import replace

from runtime.robot.model.spec import RobotSpec

# 1 - exp(-1e9 Ts) is 1, so that the current follows within the tick
HUGE = 1e9


def ideal_drives(spec: RobotSpec) -> RobotSpec:
    """Return the robot with a current loop and an encoder without error and no limit of current and torque."""
    axes = tuple(
        replace(
            axis,
            # 2**40 counts: far finer than any error, and q in steps is still a whole number that a float holds exactly
            motor=replace(axis.motor, max_current=HUGE, encoder_counts=2**40, current_bandwidth=HUGE),
            limits=replace(axis.limits, torque=HUGE),
        )
        for axis in spec.axes
    )
    return replace(spec, axes=axes)
