"""What experiments and pulse tables refuse: they turn axes, and their tables are in deg and N m."""

from runtime.core.faults import Fault
from runtime.robot.model.spec import RobotSpec


def only_turning(robot: RobotSpec, what: str) -> None:
    """Refuse ``what`` on an arm with an axis that slides; ``Fault`` RBL703."""
    for number, axis in enumerate(robot.axes, 1):
        if axis.kind.slides:
            raise Fault(
                "RBL703",
                f"J{number} of {robot.name} slides, and {what} is for arms whose axes all turn",
                "Take an arm whose axes all turn.",
            )
