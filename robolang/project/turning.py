"""What an identification and tables of pulses refuse: they are for arms whose axes all turn."""

from runtime.core.faults import Fault
from runtime.robot.model.spec import RobotSpec


def only_turning(robot: RobotSpec, what: str, why: str) -> None:
    """Refuse ``what`` on an arm with an axis that slides, for the reason ``why``; ``Fault`` RBL703."""
    for number, axis in enumerate(robot.axes, 1):
        if axis.kind.slides:
            raise Fault(
                "RBL703",
                f"J{number} of {robot.name} slides, and {what} is for arms whose axes all turn: {why}",
                "Take an arm whose axes all turn.",
            )
