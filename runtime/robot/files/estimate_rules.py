"""How a value of a drive that no file states is estimated: one function for each, in SI, scalars only.

The constants are those that fit the drives which are published with all of their data (Puma 560, Manutec r3; the tables
of ``runtime/robot/library``), a factor of 2 to 3 to either side; docs/robots-estimates.md has the comparison.
Torque T N m and speed w rad/s are limits at the joint, N motor turns per joint turn; of an axis that slides T is N, w
m/s, N rad/m and an inertia a mass. Decision 0060 has the sources, decision 0064 those of axes that slide.
"""

import math

MASS_AT_ONE_METRE = 50.0
"""Mass of all that moves of an arm with a reach of 1 m, kg; it grows with the reach to the power ``MASS_POWER``."""
MASS_POWER = 2.5
PAYLOAD_SHARE = 0.08
"""Rated payload over the mass of all that moves; arms with published bodies have 0.04 to 0.13."""
TOOL_LEVER = 0.1
"""Distance of the centre of gravity of a payload from the flange, m."""
GYRATION = 0.1
"""Radius of gyration of a payload, m."""
TIP_SPEED = 3.0
"""Speed of the flange at the stretched arm, m/s, that an arm axis gives alone."""
WRIST_SPEED = math.radians(250.0)
"""Speed of a wrist axis, rad/s."""
ARM_RISE, WRIST_RISE = 0.25, 0.08
"""Time in which an axis reaches its speed at its largest torque, s."""
SLIDE_SPEED = 1.0
"""Speed of an axis that slides, m/s: a screw of 20 mm a turn at 3000 1/min."""
SLIDE_ACCELERATION = 10.0
"""Acceleration of an axis that slides at its largest force, m/s2: about 1 g, in no less than ``WRIST_RISE``."""
MOTOR_SPEED = 315.0
"""Speed of a servo motor, rad/s (3000 1/min; the motors of the Manutec r3)."""
ROTOR_PER_TORQUE = 1.1e-4
"""Rotor inertia over the largest torque of a motor, kg m2 per N m: 9000 rad/s2 of the rotor alone."""
MOTOR_CURRENT, CURRENT_AT, CURRENT_POWER = 8.0, 2.0, 0.25
"""Largest current, A, of a motor with a torque of ``CURRENT_AT`` N m, and how it grows with the torque."""
COULOMB_SHARE = 0.065
"""Coulomb friction over the largest torque: gears of efficiency 0.93 at full load."""
VISCOUS_SHARE = 0.06
"""Viscous friction at the largest speed over the largest torque."""
STIFFNESS_PER_TORQUE = 300.0
"""Stiffness of a gear over its largest torque, 1/rad: it winds up 0.2 deg at full load (Manutec r3: 160 to 430)."""
STIFFNESS_PER_FORCE = 3000.0
"""Stiffness of a screw or belt over its largest force, 1/m: it yields 0.3 mm at full load."""
RESONANCE_SHARE = 0.25
"""Position bandwidth over the lowest resonance: the loop has its double pole at 2 Kp (Kv = 4 Kp), which stays at half
of the resonance (R. P. Paul, Robot Manipulators, 1981; J. J. Craig, Introduction to Robotics)."""
LOOP_RATIO = 4.0
"""Velocity over position bandwidth: both poles of the loop are real (docs/servo.md)."""
SLOWEST_LOOP, FASTEST_LOOP = 10.0, 60.0
"""Position bandwidths, 1/s, between which an estimate stays."""
ENCODER_COUNTS = 131072
"""17 bit."""
CURRENT_BANDWIDTH = 500.0
"""Bandwidth of a current loop, Hz."""
TIP_SHARE, DEFAULT_SHARE = 0.7, 0.4
"""Path speed over the tip speed of the slowest arm axis; speed of a MOVE without SPEED over the path speed."""
TIP_ACCELERATION_SHARE = 0.5
"""Path acceleration over the tip acceleration of the slowest arm axis."""
RISE_OF_JERK = 10.0
"""Jerk over acceleration, 1/s: full acceleration after 0.1 s."""
ROTATION_RISE = 4.0
"""Rotation acceleration over rotation speed, 1/s: full speed after 0.25 s."""
ARM_RADIUS, WRIST_RADIUS = 0.060, 0.040
"""Radii of links, m, of an arm with a reach of 1 m or more."""
SMALLEST_SCALE, GAP_SHARE, ONE_POINT = 0.4, 0.9, 5e-3
"""Least scale of the radii of a small arm; share of the gap between links that they fill; nearer joints, m, are in one
point."""
ARM_FLOOR = 0.5
"""Least torque of an arm axis over that of the strongest: the first axis carries no weight and turns all of it."""
ELBOW = 1.5
"""Speed of the third axis over that of the first two: it carries about two thirds of the arm."""
WRIST_FLOOR = 0.5
"""Least torque of a wrist axis over the largest of the wrist: its motors are of one size or two."""
HEADROOM = 0.7
"""Share of the torque that is left by gravity and friction and may accelerate: coupling and errors take the rest."""
BAD_POSTURE = 0.1
"""Share of all postures that are worse than the one for which an acceleration is stated."""
SMALLEST_PAYLOAD = 0.1
"""Least rated payload, kg."""
SMALLEST_ARM = 0.1
"""Least reach of an arm, m, for which the rules hold."""


def arm_axes(n: int) -> int:
    """Return how many of the ``n`` first axes carry the arm, the others being its wrist: three, of seven four."""
    return 4 if n >= 7 else min(3, n)


def moving_mass(reach: float) -> float:
    """Return the mass of all that moves, kg, of an arm of ``reach`` m."""
    return MASS_AT_ONE_METRE * math.pow(reach, MASS_POWER)


def rated_payload(mass: float) -> float:
    """Return the rated payload, kg, of an arm of which ``mass`` kg move."""
    return max(SMALLEST_PAYLOAD, PAYLOAD_SHARE * mass)


def speed(axis: int, n: int, reach: float, slides: bool) -> float:
    """Return the speed limit of an axis (0-based) of ``n``, rad/s or m/s."""
    if slides:
        return SLIDE_SPEED
    if axis >= arm_axes(n):
        return WRIST_SPEED
    return min(TIP_SPEED / reach * (ELBOW if axis >= 2 else 1.0), WRIST_SPEED)


def rise(axis: int, n: int, w: float, slides: bool) -> float:
    """Return the time, s, in which an axis (0-based) of ``n`` reaches its speed limit w at its largest torque."""
    if slides:
        return max(WRIST_RISE, w / SLIDE_ACCELERATION)
    return ARM_RISE if axis < arm_axes(n) else WRIST_RISE


def torque(gravity: float, inertia: float, w: float, rise: float) -> float:
    """Return the torque limit, N m: it holds ``gravity`` N m and takes ``inertia`` kg m2 to w in ``rise`` s.

    The rotor takes J N / T = ROTOR_PER_TORQUE N of the acceleration whatever T is, and friction its share.
    """
    # a share of T itself, so that T is solved for and not found by iteration
    own = ROTOR_PER_TORQUE * MOTOR_SPEED / rise + COULOMB_SHARE
    return (gravity + inertia * w / rise) / (1.0 - own)


def acceleration(T: float, gravity: float, inertia: float) -> float:
    """Return the acceleration, rad/s2, that T N m give ``inertia`` kg m2, rotor included, against ``gravity`` N m.

    An axis that can hardly hold its arm still gets a tenth of its torque.
    """
    return HEADROOM * max(0.1 * T, T * (1.0 - COULOMB_SHARE) - gravity) / inertia


def gear_ratio(w: float) -> float:
    """Return motor turns per joint turn: the motor turns at ``MOTOR_SPEED`` when the joint turns at its limit."""
    return MOTOR_SPEED / w


def rotor_inertia(T: float, N: float) -> float:
    """Return the rotor inertia, kg m2, of a motor with the torque T / N."""
    return ROTOR_PER_TORQUE * T / abs(N)


def max_current(T: float, N: float) -> float:
    """Return the current limit, A, of a motor with the torque T / N."""
    return MOTOR_CURRENT * math.pow(T / abs(N) / CURRENT_AT, CURRENT_POWER)


def coulomb_friction(T: float, N: float) -> float:
    """Return the Coulomb friction at the motor, N m."""
    return COULOMB_SHARE * T / abs(N)


def viscous_friction(T: float, N: float, w: float) -> float:
    """Return the viscous friction at the motor, N m s/rad."""
    return VISCOUS_SHARE * T / (N**2 * w)


def resonance(T: float, inertia: float, slides: bool) -> float:
    """Return the resonance, rad/s, of a link of ``inertia`` kg m2 on the gear of its axis, the rotor at rest."""
    return math.sqrt((STIFFNESS_PER_FORCE if slides else STIFFNESS_PER_TORQUE) * T / inertia)


def position_bandwidth(lowest: float) -> float:
    """Return the position bandwidth of all axes, 1/s, of an arm with this lowest resonance, rad/s."""
    return min(FASTEST_LOOP, max(SLOWEST_LOOP, RESONANCE_SHARE * lowest))
