"""A fault that no ON ERROR catches, with the statement that it comes from."""

from robolang.interpreter.effects import Origin
from runtime.core.faults import Fault


class ProgramFault(Fault):
    """A fault that no ON ERROR caught: the statement it comes from, and the calls that led there, outermost first."""

    def __init__(self, fault: Fault, origin: Origin, calls: tuple[Origin, ...] = ()) -> None:
        super().__init__(fault.code, fault.message, fault.hint)
        self.origin = origin
        self.calls = calls
