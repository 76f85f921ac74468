"""The two kinds of axis: one that turns about the z axis of its frame, and one that slides along it.

Inside, a joint coordinate is rad or m, and force is what its power divides by its speed: N m or N. The equations of
motion, the servo law and the planner are the same for both; units and the keys of files are not. Imports no numerics.
"""

import math
from typing import Literal

from runtime.core.record import Record
from runtime.core.units import DEG, MM

KindName = Literal["revolute", "prismatic"]


class AxisKind(Record):
    """What an axis is measured in, and how files name its values.

    ``unit`` is what people type and read, ``size`` the same in SI; ``coordinate``, ``force`` and ``inertia`` are SI
    units, of a position, of what moves the link and of what resists it. No axis goes
    further to a side than ``widest`` rad or m. The keys of files are those of range, speed, acceleration, jerk, force,
    of the spring and the damper of the gear, and of the ``transmission`` between motor and axis.
    """

    name: KindName
    unit: str
    size: float
    coordinate: str
    force: str
    inertia: str
    widest: float
    range_key: str
    speed_key: str
    acceleration_key: str
    jerk_key: str
    force_key: str
    stiffness_key: str
    damping_key: str
    transmission_key: str

    @property
    def slides(self) -> bool:
        """Whether the axis slides; else it turns."""
        return self.name == "prismatic"

    @property
    def moves(self) -> str:
        """What the axis does, as messages say it."""
        return "slides" if self.slides else "turns"

    @property
    def effort(self) -> str:
        """What the axis moves its link with, as messages say it."""
        return "force" if self.slides else "torque"

    def text(self, value: float, form: str = "g") -> str:
        """Return a coordinate, rad or m, as people read it: ``12.5 deg``, ``40 mm``."""
        return f"{value / self.size:{form}} {self.unit}"

    def transmission(self, ratio: float) -> float:
        """Return the transmission as files have it: N of an axis that turns, mm per motor turn of one that slides."""
        return 2.0 * math.pi / (ratio * self.size) if self.slides else ratio

    def motor_ratio(self, transmission: float) -> float:
        """Return N, motor turns in rad per rad or m of the axis, of a transmission as files have it."""
        return self.transmission(transmission)  # 2 pi over the travel in one direction as in the other


REVOLUTE = AxisKind(
    name="revolute",
    unit="deg",
    size=DEG,
    coordinate="rad",
    force="N m",
    inertia="kg m2",
    widest=3600.0 * DEG,
    range_key="range_deg",
    speed_key="max_speed_deg_s",
    acceleration_key="max_acceleration_deg_s2",
    jerk_key="max_jerk_deg_s3",
    force_key="max_torque_nm",
    stiffness_key="joint_stiffness_nm_rad",
    damping_key="joint_damping_nm_s_rad",
    transmission_key="gear_ratio",
)
PRISMATIC = AxisKind(
    name="prismatic",
    unit="mm",
    size=MM,
    coordinate="m",
    force="N",
    inertia="kg",
    widest=20.0,
    range_key="range_mm",
    speed_key="max_speed_mm_s",
    acceleration_key="max_acceleration_mm_s2",
    jerk_key="max_jerk_mm_s3",
    force_key="max_force_n",
    stiffness_key="joint_stiffness_n_m",
    damping_key="joint_damping_n_s_m",
    transmission_key="travel_mm_per_turn",
)
KINDS: dict[str, AxisKind] = {kind.name: kind for kind in (REVOLUTE, PRISMATIC)}
URDF_KINDS = {"revolute": REVOLUTE, "continuous": REVOLUTE, "prismatic": PRISMATIC}
MJCF_KINDS = {"hinge": REVOLUTE, "slide": PRISMATIC}
"""By the type of a joint in a model file."""
