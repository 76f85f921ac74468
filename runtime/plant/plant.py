"""The seam between controller and robot: what a plant must offer, whoever plays it.

The controller writes joint torques and a hand command, advances the plant by one servo tick, and reads joint
angles. Everything else here is for reports. Two plants exist: ``MujocoPlant``, the robot with friction, contacts,
hand and parts, and ``RigidPlant``, an ideal rigid arm without any of them, for tests and ``--no-physics``.
"""

from dataclasses import dataclass
from typing import Protocol

from runtime.core.frames import Array
from runtime.core.state import State
from runtime.plant.touches import Bodies, Pair


@dataclass(frozen=True, slots=True, kw_only=True)
class HandState:
    """What the hand does: ``opening`` m between the fingers, ``holding`` the part between them (None: nothing)."""

    closed: bool
    opening: float
    holding: str | None


class Plant(Protocol):
    """A robot with n axes, a hand and parts, advanced one servo tick at a time."""

    @property
    def tick_s(self) -> float:
        """Duration of one step, s."""

    @property
    def q(self) -> Array:
        """True motor angles at the joint side (n,) rad, which the encoders see: one live read-only array.

        It is the same object for the plant's whole life. Where the gear is rigid it is the angle of the joint.
        """

    @property
    def dq(self) -> Array:
        """True motor speeds at the joint side (n,) rad/s: live as ``q``."""

    @property
    def q_link(self) -> Array:
        """True angles of the links (n,) rad: live as ``q``, and equal to it where the gear is rigid."""

    def step(self, tau: Array) -> bool:
        """Apply joint torques (n,) N m for one tick and advance.

        Returns False when the state is no longer finite or valid; ``q`` then holds the last valid one.
        """

    def why_invalid(self) -> str:
        """Return in a few words why the state is no longer valid; empty while it is."""

    def close_hand(self, closed: bool) -> None:
        """Start closing or opening the hand."""

    def hand(self) -> HandState:
        """Return what the hand does now."""

    def parts(self) -> dict[str, Array]:
        """Return the pose X_world_part (4, 4) of every part by name."""

    def moved(self) -> Array:
        """Return what a picture of the cell shows beside the joints (7 m + 2,), in the order of ``parts``.

        Of each part x y z, m, and the quaternion w x y z in the world; of each finger the distance of its pad from the
        tool point, m. Called every 16 ms.
        """

    @property
    def bodies(self) -> Bodies | None:
        """Parts and tool as live arrays; None where the plant knows no contacts."""

    def touching(self) -> frozenset[Pair]:
        """Return which shapes have touched since the last call, as sorted pairs of their names."""

    def gripped(self) -> tuple[str, ...]:
        """Return the parts between the fingers that press on them."""

    def snapshot(self) -> State:
        """Return everything that the steps to come depend on; called between two cycles."""

    def restore(self, state: State) -> None:
        """Put a state back, also into another plant of the same robot and cell: the same torques move it alike."""
