"""The controller's own model of the arm, on Pinocchio, with the payload that the program declared.

``ArmModel`` is the typed adapter around Pinocchio (which has no type stubs): mass matrix, one column of it, gravity
torque and forward dynamics, in SI, for one posture at a time; the row of a sliding axis is in N and kg. Rotor inertia
is not in it: the servo adds N^2 J itself (docs/servo.md). With ``rotors`` it is in the model, for the ideal plant and
the supervision. What an identification found beyond the bodies, first moments, is in ``gravity`` and ``torque`` alone
(docs/identification.md).
"""

from typing import Any

import numpy as np
import pinocchio as pin

from runtime.core.frames import Array
from runtime.core.state import State, Stateful
from runtime.core.units import GRAVITY
from runtime.robot.model.load_rules import LoadMode
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import Body, RobotSpec

_NO_MASS = 1e-9
"""Mass of the bodies that stand for first moments, kg: next to nothing of its own, and the moment is mass times cog."""


class ArmModel(Stateful):
    """Rigid-body model of a robot that carries one payload at a time.

    ``rotors`` (n,) kg m2 at the joints, ``first_moments`` (n, 3) kg m in link frames, weighed and not accelerated.
    """

    def __init__(self, spec: RobotSpec, *, rotors: Array | None = None, first_moments: Array | None = None) -> None:
        self.n = spec.n
        self._X_last_flange = pin.SE3(spec.X_last_flange)
        self._model = _build(spec)
        if rotors is not None:
            self._model.armature = rotors
        # a second model without gravity: a column of M is then one inverse dynamics, not the difference of two
        self._weightless = self._model.copy()
        self._weightless.gravity = pin.Motion.Zero()
        self._data = self._model.createData()
        self._moments: Any = None if first_moments is None else _only_moments(self._model, first_moments)
        self._weightless_data = self._weightless.createData()
        self._bare_last = self._model.inertias[self.n].copy()
        self._zero = np.zeros(self.n)
        self._units = np.eye(self.n)
        self._upper = np.triu(np.ones((self.n, self.n), dtype=bool))

    def set_payload(self, payload: Payload = NO_PAYLOAD, mode: LoadMode = "add") -> None:
        """Carry ``payload`` from now on: added to the last link, or in its place (``replace``)."""
        # from the bare last link every time: adding and taking off payloads would sum up rounding
        load = self._X_last_flange.act(pin.Inertia(payload.mass, np.array(payload.cog), np.array(payload.inertia)))
        self._carry(load if mode == "replace" else self._bare_last + load)

    def _carry(self, last: Any) -> None:
        """Give the last link an inertia, its own and that of the payload."""
        self._model.inertias[self.n] = last
        self._weightless.inertias[self.n] = last

    def snapshot(self) -> State:
        """Return the inertia of the last link with what it carries: adding even no payload may change its last bits."""
        return State(owner=type(self), values=(self._model.inertias[self.n].copy(),))

    def restore(self, state: State) -> None:
        """Carry again what was carried then."""
        state.check(self)
        self._carry(state.values[0])

    def mass_matrix(self, q: Array) -> Array:
        """Return M (n, n), kg m2, symmetric."""
        M = pin.crba(self._model, self._data, q)  # fills the upper triangle only
        return np.asarray(np.where(self._upper, M, M.T))

    def inertia_column(self, q: Array, axis: int) -> Array:
        """Return column ``axis`` of M (n,): the torques that accelerate that axis alone by 1 rad/s2, no gravity."""
        return np.asarray(pin.rnea(self._weightless, self._weightless_data, q, self._zero, self._units[axis]))

    def gravity(self, q: Array) -> Array:
        """Return the torques (n,) N m that hold the arm at rest."""
        T = np.asarray(pin.computeGeneralizedGravity(self._model, self._data, q))
        return T if self._moments is None else T + self._beyond(q)

    def acceleration(self, q: Array, dq: Array, tau: Array) -> Array:
        """Return ddq (n,) rad/s2 under joint torques tau (n,) N m (forward dynamics)."""
        return np.asarray(pin.aba(self._model, self._data, q, dq, tau))

    def torque(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Return the joint torques (n,) N m of a motion (inverse dynamics, with gravity)."""
        tau = np.asarray(pin.rnea(self._model, self._data, q, dq, ddq))
        return tau if self._moments is None else tau + self._beyond(q)

    def _beyond(self, q: Array) -> Array:
        """Return the torques (n,) N m of the identified first moments, which are weighed and not accelerated."""
        model, data = self._moments
        return np.asarray(pin.computeGeneralizedGravity(model, data, q))

    def flange(self, q: Array) -> Array:
        """Return X_base_flange (4, 4)."""
        pin.forwardKinematics(self._model, self._data, q)
        return np.asarray((self._data.oMi[self.n] * self._X_last_flange).homogeneous)


def spec_rotors(spec: RobotSpec) -> Array:
    """Return N^2 J of every axis (n,), kg m2."""
    return np.array([axis.motor.reflected_inertia for axis in spec.axes])


def _build(spec: RobotSpec) -> Any:
    model = pin.Model()
    model.gravity = pin.Motion(np.array([0.0, 0.0, -GRAVITY]), np.zeros(3))
    parent = 0
    for axis in spec.axes:
        joint = pin.JointModelPZ() if axis.kind.slides else pin.JointModelRZ()
        parent = model.addJoint(parent, joint, pin.SE3(axis.placement), axis.name)
        model.appendBodyToJoint(parent, _inertia(axis.body), pin.SE3.Identity())
    return model


def _only_moments(model: Any, first_moments: Array) -> tuple[Any, Any]:
    """Return the arm with bodies that have these first moments and next to no mass, and its data."""
    model = model.copy()
    for joint, h in enumerate(first_moments, start=1):
        model.inertias[joint] = pin.Inertia(_NO_MASS, h / _NO_MASS, np.zeros((3, 3)))
    return model, model.createData()


def _inertia(body: Body) -> Any:
    return pin.Inertia(body.mass, np.array(body.cog), np.array(body.inertia))
