"""Drives without limits, for experiments on the equations alone.

The closed loop of docs/servo.md is derived with a current loop that follows at once, no current or torque limit and an
exact encoder. ``ideal_drives`` gives a robot such drives; bodies, gears, rotors and bandwidths stay what they are.
"""

from dataclasses import replace

from runtime.robot.model.spec import RobotSpec

HUGE = 1e9


def ideal_drives(spec: RobotSpec) -> RobotSpec:
    """Return the robot with a current loop and an encoder without error and no limit of current and torque."""
    axes = tuple(
        replace(
            axis,
            motor=replace(axis.motor, max_current=HUGE, encoder_counts=2**40, current_bandwidth=HUGE),
            limits=replace(axis.limits, torque=HUGE),
        )
        for axis in spec.axes
    )
    return replace(spec, axes=axes)
