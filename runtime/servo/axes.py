"""The servo of all axes: encoder, law, friction term and motor wired together, tick by tick.

Once per cycle it takes the loads of ITA (step 220) and the commanded motion of the cycle's ticks (step 218, after
fine interpolation); at every tick it turns the true joint angles into joint torques. ``n`` axes, joint side.

The friction term is not in the document. Eqs (6) to (11) have no integrator, so published Coulomb friction alone
would leave an axis of the Puma up to 0.2 deg from its command; it is therefore added to the current from the robot
file, smoothed over ``SMOOTH`` rad/s: ``(N^2 B dq + |N| Tc tanh(dq / SMOOTH)) / Ktn`` (docs/decisions/0003).
"""

import numpy as np
from numpy import multiply

from runtime.core.frames import Array
from runtime.core.state import Stateful
from runtime.robot.model.arm_model import spec_rotors
from runtime.robot.model.spec import RobotSpec
from runtime.servo.motor import Encoders, Motors, current_limit, encoder_resolution
from runtime.servo.servo_law import Gains, ServoLaw
from runtime.settings.profile import ServoOptions

SMOOTH = 0.01
"""Speed over which the sign of the commanded speed is smoothed, rad/s; of a sliding axis ``RobotSpec.bound`` of it."""


class ServoAxes(Stateful):
    """All axes of one robot. Buffers ``alpha``, ``beta``, ``tau_cmd`` and ``tau`` (n,) are live, for the recorder."""

    BUFFERS = ("alpha", "tau_cmd", "tau")
    VALUES = ("q_ref",)
    PARTS = ("law", "motors")

    def __init__(self, spec: RobotSpec, options: ServoOptions, tick_s: float, q: Array, D_fixed: Array) -> None:
        self.options = options
        # gains that are held fixed have no rows: what is fixed is the inertia of each axis alone
        self.coupled = options.coupling == "full" and options.mode == "scheduled"
        self.held_inertia = D_fixed if options.mode == "fixed" else None
        """Inertia (n,) of gains that are held fixed, kg m2; None where they follow the posture."""
        self.encoders = Encoders(encoder_resolution(spec))
        self.alpha = np.zeros(spec.n)
        self.encoders.read(q, self.alpha)
        # from a reading, not from q: the first difference would be a part of an encoder step, and no speed
        self.law = ServoLaw(gains(spec, options), self.alpha, tick_s)
        self.beta = self.law.beta
        self.q_ref = self.alpha
        """Where the motors should be at the last tick of the cycle (n,) rad: the command and the lead of eq (6)."""
        self._Ktn = spec_torque_constants(spec)
        self.motors = Motors(self._Ktn, current_limit(spec), spec.per_axis("motor", "current_bandwidth"), tick_s)
        self.tau_cmd = np.zeros(spec.n)
        self.tau = np.zeros(spec.n)
        friction = np.array([axis.motor.joint_coulomb_friction for axis in spec.axes])
        self._forward, self._backward = friction[:, 0], friction[:, 1]
        self._viscous = spec.per_axis("motor", "joint_viscous_friction")
        self._smooth = spec.bound(SMOOTH)

    def take(self, D: Array, T: Array, motion: Array, rows: Array | None = None) -> None:
        """Take the loads D kg m2, T N m (n,) and the motion (3, ticks, n) of the cycle that begins.

        ``rows`` (n, n), kg m2, is the mass matrix of ITA when the axes are coupled.
        """
        self.law.update(D, T, self.held_inertia, rows)
        theta, beta, gamma = motion
        # friction of the commanded speed: the sign of the detected one is noise at rest (docs/decisions/0003)
        self.law.command(theta, beta, gamma, self.friction_current(beta))
        self.q_ref = self.law.reference[-1]

    def resting_command(self, q: Array, T: Array) -> Array:
        """Return the command (n,) rad whose lead holds motors at q (n,) rad under the weight T (n,) N m."""
        return np.asarray(q - self.law.sag(T))

    def friction_current(self, dq: Array) -> Array:
        """Return the current (..., n) A that overcomes the published friction at speed dq (..., n) rad/s."""
        # tanh is 0 at rest, so that the term cannot make a resting axis creep
        coulomb = np.where(dq > 0.0, self._forward, self._backward) * np.tanh(dq / self._smooth)
        return np.asarray((coulomb + self._viscous * dq) * (self.options.friction_compensation / self._Ktn))

    def tick(self, k: int, q: Array) -> Array:
        """Return the joint torques (n,) N m of tick k of the cycle, at true joint angles q (n,) rad: a live buffer."""
        self.encoders.read(q, self.alpha)
        current = self.law.current(k, self.alpha)
        multiply(current, self._Ktn, self.tau_cmd)
        self.motors.torque(current, self.tau)
        return self.tau


def spec_torque_constants(spec: RobotSpec) -> Array:
    """Return Ktn of every axis (n,), N m/A."""
    return np.array([axis.motor.joint_torque_constant for axis in spec.axes])


def bandwidths(spec: RobotSpec, options: ServoOptions) -> tuple[Array, Array]:
    """Return Kp and Kv of every axis (n,), 1/s: the profile's, else the robot file's."""
    given = {"position": options.position_bandwidth, "velocity": options.velocity_bandwidth}
    Kp, Kv = (
        np.broadcast_to(values, spec.n).copy() if values else spec.per_axis("bandwidths", name)
        for name, values in given.items()
    )
    return Kp, Kv


def rotors(spec: RobotSpec, options: ServoOptions) -> Array:
    """Return what D' has beyond D (n,), kg m2 at the joint: N^2 Jc of a compensation, else N^2 J. Never both."""
    return np.array(options.rotors) if options.rotors else spec_rotors(spec)


def first_moments(spec: RobotSpec, options: ServoOptions) -> Array | None:
    """Return the first moments that an identification found beyond the model (n, 3), kg m; None: there are none."""
    return np.array(options.first_moments).reshape(spec.n, 3) if options.first_moments else None


def gains(spec: RobotSpec, options: ServoOptions) -> Gains:
    """Derive the constants of the law from the bandwidths and the profile's options."""
    Kp, Kv = bandwidths(spec, options)
    return Gains(
        Kp=Kp,
        Kv=Kv,
        Ktn=spec_torque_constants(spec),
        rotor=rotors(spec, options),
        Kf=options.velocity_feedforward,
        Ka=options.acceleration_feedforward,
        K2=options.spring_compensation,
        KG=options.gravity_lead,
        Kc=spec.per_axis("motor", "stiffness"),
        KT_scale=options.gravity_compensation,
        source=options.source,
    )
