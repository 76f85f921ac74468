"""The sources of the dynamics task for the inertia of an axis: three methods, the same numbers.

    pass        one unit-acceleration pass of Pinocchio over the chain; the default      ``ArmModel.inertia_column``
    recursion   document 003, from the link of the axis outward and back to the base     ``motor_inertia.inertia_row``
    matrix      the whole mass matrix, of which one row is taken                          ``ArmModel.mass_matrix``

They agree to 1e-12 kg m2 and differ in cost alone (docs/decisions/0019). Each returns the row of the axis, without the
rotor, since a servo with whole rows needs it (docs/decisions/0017); D is the element of the axis. Called once per axis
by the dynamics task.
Where a compensation file has a table, D is more by N^2 (Jc(q) - Jc), Jc being what the servo adds (``rotors``).
"""

from collections.abc import Callable, Sequence

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.state import Stateful
from runtime.dynamics.equations import axis_row
from runtime.dynamics.motor_inertia import inertia_row, link_chain
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.joint_table import JointTable
from runtime.robot.model.load_rules import LoadMode
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import InertiaSource

Row = Callable[[Array, int], Array]
"""Of joint angles (n,) rad and an axis (0-based): the row of the mass matrix (n,), kg m2, without rotors."""


class InertiaRows(Stateful):
    """The source of a robot's inertia rows; ``model`` carries the payload for the two sources that are Pinocchio's.

    ``tables``, one for each axis or None, or none at all: kg m2 that D has beyond the model, by posture.
    """

    VALUES = ("_chain",)
    PARTS = ("_model",)

    def __init__(
        self, spec: RobotSpec, model: ArmModel, source: InertiaSource, tables: Sequence[JointTable | None] = ()
    ) -> None:
        self._spec, self._model, self._source = spec, model, source
        self._chain = link_chain(spec)
        self._tables = tables
        self._bare: Row = {"pass": self._by_pass, "recursion": self._by_recursion, "matrix": self._by_matrix}[source]
        self.row: Row = self._with_table if tables else self._bare

    def set_payload(self, payload: Payload, mode: LoadMode) -> None:
        """Carry ``payload`` from now on, in the model as well."""
        self._model.set_payload(payload, mode)
        # the other two read the payload from the model; a chain is rebuilt only where it is used
        if self._source == "recursion":
            self._chain = link_chain(self._spec, payload, mode)

    def _with_table(self, q: Array, axis: int) -> Array:
        row, table = self._bare(q, axis), self._tables[axis]
        if table is None:
            return row
        # D alone has the table: what identification found belongs to the drive of the axis, not to its coupling
        row = np.array(row)
        row[axis] += table.at(q)
        return frozen(row)

    def _by_pass(self, q: Array, axis: int) -> Array:
        return axis_row(self._model, q, axis)

    def _by_recursion(self, q: Array, axis: int) -> Array:
        return inertia_row(self._chain, q, axis)

    def _by_matrix(self, q: Array, axis: int) -> Array:
        return frozen(np.array(self._model.mass_matrix(q)[axis]))
