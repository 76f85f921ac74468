"""The robot as MuJoCo simulates it: friction, rotor inertia, contacts, hand and parts.

``step`` is the inner loop of every run (one call per servo tick). It writes the torques, lets MuJoCo advance by one
or more physics steps of at most 1 ms, and copies the joint state out. How a broken state is noticed in the same
tick: MuJoCo checks positions and speeds at the start of every physics step, controls before they act
and accelerations before they are integrated, and counts each number that is NaN, infinite or above 1e10. A step
whose counters stay at zero therefore starts, and by ``v + h a`` also ends, with a finite state; so comparing the
counters (28 bytes, 0.1 us) is the finiteness check of the whole state. Adding up the state each tick was rejected:
it costs ten times that and says less. MuJoCo's own answers, zeroed controls and a reset to the start, are
overruled: the plant latches, puts back the last valid state and never steps again.

A physics warning that is no such number (contact buffer full, singular inertia) invalidates the state as well: the
forces of that tick were wrong. Where a gear is elastic (see ``mjcf``) motor and link have an angle each: ``q`` is the
motor's, which the encoder sees, ``q_link`` the link's; the physics step is then a share of the spring's period
(``gears``), and the arm starts hanging in its springs. Dry friction differs by direction through a constant bias
torque (see ``mjcf``).
"""

from dataclasses import dataclass
from typing import Any, cast

import mujoco
import numpy as np

from runtime.cell.cell import CellSpec
from runtime.cell.gripper import FINGERS
from runtime.core.frames import Array, pose
from runtime.core.linear import dot, norm
from runtime.core.state import State
from runtime.plant.cell_model import CellModel
from runtime.plant.gears import elastic_axes, physics_steps
from runtime.plant.mjcf import friction_bias
from runtime.plant.plant import HandState
from runtime.plant.suction import Suction
from runtime.plant.touches import Bodies, Pair
from runtime.robot.model.spec import RobotSpec

MAX_PHYSICS_STEP = 1e-3
"""Longest physics step, s: contacts have a time constant of four of them (``mjcf.CONTACT_TIME``)."""

HANG_ROUNDS = 8
"""Rounds in which the twist of the gears at the start finds itself; each leaves a share of weight over spring."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Touch:
    """A contact: the names of the two geoms in sorted order and the normal force between them, N."""

    names: tuple[str, str]
    force: float


class MujocoPlant:
    """A robot in its cell, at the cell's home posture with the hand open, advanced by ``tick_s`` per step."""

    def __init__(self, spec: RobotSpec, cell: CellSpec, tick_s: float = 1e-3) -> None:
        if not 1e-5 <= tick_s <= 0.1:
            raise ValueError(f"a tick of {tick_s} s")
        self._n = n = spec.n
        self._tick_s = tick_s
        self._substeps = physics_steps(spec, tick_s, MAX_PHYSICS_STEP)
        built = CellModel.of(spec, cell, tick_s / self._substeps)
        self._model = built.model
        self._data: Any = mujoco.MjData(self._model)
        self._qpos, self._qvel = cast(Array, self._data.qpos), cast(Array, self._data.qvel)
        self._tau, self._finger_force = self._data.ctrl[:n], self._data.ctrl[n:]
        self._grip_force = cell.hand.grip_force
        self._motors, self._gears, self._fingers = built.motors, built.gears, built.fingers
        self._elastic = elastic_axes(spec)
        self._part_address, self._geom_names = built.parts, built.shapes
        # a finger's coordinate is the distance of its pad from the tool point
        places = [np.arange(at, at + 7) for at in built.parts.values()]
        fingers = np.arange(built.fingers.start, built.fingers.stop)
        self._pictured = np.concatenate([*places, fingers])
        self._warnings = self._data.warning.number.tobytes
        self._no_warning = self._warnings()
        self._valid = True
        self._qpos[self._motors] = cell.home
        # each finger's coordinate is half of the opening
        self._qpos[self._fingers] = cell.hand.stroke / 2.0
        # set once: MuJoCo keeps applied forces from step to step
        self._data.qfrc_applied[self._motors] = friction_bias(spec)
        self._hang(spec.per_axis("motor", "stiffness")[self._elastic])
        self._last_qpos, self._last_qvel = self._qpos.copy(), self._qvel.copy()
        self._show_state()
        self._watch(cell)
        self.close_hand(False)

    def _watch(self, cell: CellSpec) -> None:
        """Set up what ``touching`` and ``bodies`` give: mjData's own arrays, which stay where they are."""
        data, m = self._data, len(cell.parts)
        first = self._model.nbody - m  # parts are the last bodies
        site = int(self._model.site("tool").id)
        mujoco.mj_kinematics(self._model, data)  # so that they hold from the first cycle on
        self.bodies = Bodies(
            names=tuple(part.name for part in cell.parts),
            size=np.array([part.size for part in cell.parts]).reshape(m, 3),
            p=data.xpos[first:],
            R=data.xmat[first:].reshape(m, 3, 3),
            p_tool=data.site_xpos[site],
            R_tool=data.site_xmat[site].reshape(3, 3),
            pad_length=float(cell.hand.pad[2]),
            holders=1 if cell.hand.is_cup else len(FINGERS),
        )
        hand = int(self._model.body("hand").id)
        self._suction = Suction(cell, self.bodies, data.xfrc_applied, hand, data.xipos) if cell.hand.is_cup else None
        self._known_contacts: dict[bytes, frozenset[Pair]] = {}
        self._touched: frozenset[Pair] = frozenset()
        self._ncon = -1

    def _hang(self, stiffness: Array) -> None:
        """Twist the gears (m,) N m/rad by the weight that hangs on them: the arm starts at rest."""
        for _ in range(HANG_ROUNDS if len(stiffness) else 0):
            mujoco.mj_forward(self._model, self._data)
            self._qpos[self._gears] = -self._data.qfrc_bias[self._gears] / stiffness

    def _show_state(self) -> None:
        """Set up the live arrays: views of the state where every gear is rigid, else copies that ``step`` renews."""
        if not self._elastic:
            self._q, self._dq = _read_only(self._last_qpos[: self._n]), _read_only(self._last_qvel[: self._n])
            self._q_link = self._q
            self._renew = None
            return
        self._state = np.zeros((3, self._n))
        self._twist = np.zeros(len(self._elastic))
        self._q, self._dq, self._q_link = (_read_only(row.view()) for row in self._state)
        self._renew = self._read_motors_and_links
        self._read_motors_and_links()

    def _read_motors_and_links(self) -> None:
        q, dq, q_link = self._state
        # "clip": the addresses are valid, and numpy needs no buffer for the result then
        self._last_qpos.take(self._motors, out=q, mode="clip")
        self._last_qvel.take(self._motors, out=dq, mode="clip")
        self._last_qpos.take(self._gears, out=self._twist, mode="clip")
        q_link[:] = q
        q_link[self._elastic] += self._twist

    @property
    def tick_s(self) -> float:
        """Duration of one step, s."""
        return self._tick_s

    @property
    def q(self) -> Array:
        """True motor angles at the joint side (n,) rad: one live read-only array."""
        return self._q

    @property
    def dq(self) -> Array:
        """True motor speeds at the joint side (n,) rad/s: one live read-only array."""
        return self._dq

    @property
    def q_link(self) -> Array:
        """True angles of the links (n,) rad: one live read-only array, ``q`` itself where every gear is rigid."""
        return self._q_link

    def step(self, tau: Array) -> bool:
        """Apply joint torques (n,) N m for one tick and advance; False when the state is not valid (latched).

        The state is then the last valid one, of the tick before. Called once per servo tick.
        """
        if not self._valid:
            return False
        self._tau[:] = tau
        if self._suction is not None:
            self._suction.pull(self._closed)
        _mj_step(self._model, self._data, self._substeps)
        if self._warnings() != self._no_warning:
            return self._stop()
        # the number alone: the set of contacts changes with it but for rare swaps, which the call of each cycle sees
        if self._data.ncon != self._ncon:
            self._note_contacts()
        self._last_qpos[:] = self._qpos
        self._last_qvel[:] = self._qvel
        if self._renew is not None:
            self._renew()
        return True

    def _stop(self) -> bool:
        self._valid = False
        self._qpos[:] = self._last_qpos
        self._qvel[:] = self._last_qvel
        return False

    def snapshot(self) -> State:
        """Return what the steps to come depend on, and where the shapes were when contacts were found last.

        MuJoCo's integration state (time, positions, speeds, controls, applied forces, solver warm start) makes the
        steps repeat bit for bit. Poses and contacts in mjData are those from before the last integration and cannot be
        had from it: the poses are kept, and the contacts follow from them. Copying mjData was rejected: it takes 490
        kB and 0.5 ms instead of 5 kB and 0.01 ms.
        """
        data = self._data
        physics = np.empty(mujoco.mj_stateSize(self._model, _INTEGRATION))
        mujoco.mj_getState(self._model, data, physics, _INTEGRATION)
        poses = tuple([getattr(data, name).copy() for name in _POSES])
        last = self._last_qpos.copy(), self._last_qvel.copy()
        warnings = data.warning.number.copy(), data.warning.lastinfo.copy()
        values = (self._closed, self._touched, self._ncon, self._valid)
        return State(owner=type(self), buffers=(physics, poses, last, warnings), values=values)

    def restore(self, state: State) -> None:
        """Put a state back; the forces in ``contacts`` are those of the next step."""
        state.check(self)
        data, (physics, poses, last, warnings) = self._data, state.buffers
        mujoco.mj_setState(self._model, data, physics, _INTEGRATION)
        for name, values in zip(_POSES, poses, strict=True):
            getattr(data, name)[:] = values
        # contacts are no part of MuJoCo's state, but follow from the poses that were put back
        mujoco.mj_collision(self._model, data)
        self._last_qpos[:], self._last_qvel[:] = last
        data.warning.number[:], data.warning.lastinfo[:] = warnings
        self._closed, self._touched, self._ncon, self._valid = state.values
        if self._renew is not None:
            self._renew()

    def why_invalid(self) -> str:
        """Return MuJoCo's reason in a few words, empty while the state is valid."""
        counts = self._data.warning.number
        kinds = [kind for kind in range(len(counts)) if counts[kind]]
        return "; ".join(_text(kind, int(self._data.warning.lastinfo[kind])) for kind in kinds)

    def close_hand(self, closed: bool) -> None:
        """Start closing or opening the hand: both fingers push with the grip force, or the pump is on."""
        # a cup has no fingers, and so none of these forces
        self._closed = closed
        self._finger_force[:] = -self._grip_force if closed else self._grip_force

    def hand(self) -> HandState:
        """Return what the hand does now; ``holding`` is the first part that it grips, the hand being closed."""
        opening = float(self._last_qpos[self._fingers].sum())
        holding = next(iter(self.gripped()), None) if self._closed else None
        return HandState(closed=self._closed, opening=opening, holding=holding)

    def gripped(self) -> tuple[str, ...]:
        """Return the parts that both pads press on from the sides; one that the tips of the pads stand on is not.

        Of a cup the part that it pulls.
        """
        return self._between_pads() if self._suction is None else tuple(self._suction.held())

    def _between_pads(self) -> tuple[str, ...]:
        data = self._data
        y_tool = self.bodies.R_tool[:, 1]
        pads: dict[str, set[str]] = {name: set() for name in self._part_address}
        for contact in (data.contact[index] for index in range(data.ncon)):
            pair = [self._geom_names[geom] for geom in contact.geom]
            pad, part = sorted(pair)  # "pad_left" before "part:..."
            if pad.startswith("pad_") and part.startswith("part:") and abs(dot(contact.frame[:3], y_tool)) > SIDEWAYS:
                pads[part.removeprefix("part:")].add(pad)
        return tuple(name for name, touched in pads.items() if len(touched) == len(FINGERS))

    def contacts(self) -> list[Touch]:
        """Return every contact that carries a force, in MuJoCo's order: names such as ``link4``, ``pad_left``,
        ``palm``, ``floor``, ``obstacle:table``, ``part:part``. For reports and collision supervision.
        """
        touches: list[Touch] = []
        wrench = np.zeros(6)
        for index in range(self._data.ncon):
            contact = self._data.contact[index]
            # within a margin but not in contact: it has no constraint, and so no force
            if contact.efc_address < 0:
                continue
            mujoco.mj_contactForce(self._model, self._data, index, wrench)
            if wrench[0] > 0.0:
                first, second = sorted(str(self._model.geom(geom).name) for geom in contact.geom)
                touches.append(Touch(names=(first, second), force=float(wrench[0])))
        return touches

    def touching(self) -> frozenset[Pair]:
        """Return which shapes have touched since the last call, as sorted pairs of their names.

        ``step`` adds to them whenever the number of contacts has changed; called once per cycle.
        """
        self._note_contacts()
        touched, self._touched = self._touched, frozenset()
        return touched

    def _note_contacts(self) -> None:
        self._ncon = self._data.ncon
        geoms = self._data.contact.geom
        # the same few sets return for most of a run: names are looked up once for each
        key = geoms.tobytes()
        pairs = self._known_contacts.get(key)
        if pairs is None:
            if len(self._known_contacts) >= MOST_KNOWN:
                self._known_contacts.clear()
            names = self._geom_names
            pairs = frozenset(
                (names[a], names[b]) if names[a] < names[b] else (names[b], names[a]) for a, b in geoms.tolist()
            )
            self._known_contacts[key] = pairs
        if not pairs <= self._touched:
            self._touched |= pairs

    def parts(self) -> dict[str, Array]:
        """Return the pose X_world_part (4, 4) of every part by name."""
        return {name: _pose(self._last_qpos[at : at + 7]) for name, at in self._part_address.items()}

    def moved(self) -> Array:
        """Return pose of each part and distance of each pad, as ``Plant.moved``."""
        moved = np.asarray(self._last_qpos[self._pictured])
        # logs have two fingers, whatever the hand: those of a cup stay at 0
        return moved if self._suction is None else np.concatenate([moved, np.zeros(len(FINGERS))])

    def X_world_tool(self) -> Array:
        """Return the true pose (4, 4) of the tool point, of the same instant as ``q``."""
        # after mj_step the poses in mjData are those from before the last integration
        mujoco.mj_kinematics(self._model, self._data)
        site = self._data.site("tool")
        return pose(site.xpos, np.reshape(site.xmat, (3, 3)))


_mj_step = mujoco.mj_step
_INTEGRATION = mujoco.mjtState.mjSTATE_INTEGRATION
_POSES = ("xpos", "xquat", "xmat", "xipos", "ximat", "geom_xpos", "geom_xmat", "site_xpos", "site_xmat")
"""Poses in mjData on which contacts, and what ``bodies`` shows, depend."""
SIDEWAYS = 0.7
"""Cosine of the largest angle between a contact and the direction in which the fingers close, of a grip."""
MOST_KNOWN = 10_000
"""Sets of contacts whose names are remembered."""


def _text(kind: int, info: int) -> str:
    return str(mujoco.mju_warningText(kind, info)).strip()


def _read_only(view: Array) -> Array:
    view.setflags(write=False)
    return view


def _pose(values: Array) -> Array:
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, values[3:] / norm(values[3:]))
    return pose(values[:3], R.reshape(3, 3))
