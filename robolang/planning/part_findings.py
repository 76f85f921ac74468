"""What the moves of a rehearsal touch: obstacles, and the parts of the cell, lying, carried and put down.

    RBL421   the arm or the hand in the floor or an obstacle of the cell
    RBL440   the arm or the hand in a lying part; a carried part in a part, an obstacle, the floor or the arm
    RBL441   a HAND ON with no part between the fingers, or under the whole rim of the cup

Parts lie where the cell puts them until HAND ON finds one between the fingers: the pads meet it from both sides and
centre it. From there it goes with the tool, to HAND OFF, and rests where it is let go or at most ``DROP`` below. A
carried part may stand on what is under it, but not slide along an obstacle by more than ``NOTICED``, as in a run.

Where a part is not known (dropped from higher up, touched, put into something else by the cell), it is left out of
everything that follows: one cause, one finding. Shapes are those of a run, without its physics; the rows are the
executed set-points, 8 ms apart.
"""

from collections.abc import Collection, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from robolang.core.diagnostics import Severity
from robolang.execution.dry_run import Rehearsal, RehearsedHand, RehearsedMove
from robolang.planning.placed import Placed, Places
from robolang.project.project import Project
from runtime.cell.sealing import seals
from runtime.core.frames import Array, inverse, pose
from runtime.plant.cell_model import CLEARANCE
from runtime.plant.mjcf import APART
from runtime.plant.shapes import MARGIN, Shapes
from runtime.plant.touches import NOTICED, Pair, is_fixed, shape_text
from runtime.robot.kinematics.kinematics import Kinematics

DROP = 5e-3
"""A part that is let go higher than this over its support may land anywhere, m."""
PRESSED = 1e-3
"""How far a carried part may be in what it stands on, m: a point is taught no better."""
ALIKE = 2e-4
"""Difference in width of parts that are gripped side by side, m."""

Found = Iterator[Placed]
_PART = "part:"
NO_BOUND = (-np.inf, -np.inf, -np.inf)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Where the parts are: ``lying`` X_world_part, ``held`` X_tool_part, both (4, 4).

    ``opening`` m is that of the hand; ``known``: no part was left out.
    """

    lying: Mapping[str, Array]
    held: Mapping[str, Array]
    opening: float
    closed: bool

    known: bool = True

    @property
    def key(self) -> tuple[object, ...]:
        """What the touches of a move depend on."""
        poses = (part for parts in (self.lying, self.held) for part in sorted(parts.items()))
        return (self.opening, *((name, X.tobytes()) for name, X in poses))

    def without(self, names: Collection[str]) -> "Scene":
        """Return the scene without parts that are nobody knows where."""
        lying, held = ({key: X for key, X in parts.items() if key not in names} for parts in (self.lying, self.held))
        return replace(self, lying=lying, held=held, known=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Meeting:
    """The first row of a move at which something meets: ``by`` which shape or part, in ``what``."""

    row: int
    by: str
    what: str


@dataclass(slots=True, kw_only=True)
class Sweep:
    """What a move meets, row by row: ``struck`` the first of what is fixed, ``met`` the first of what is not allowed.

    ``stood``: where (3,) m carried parts came to stand on what they still stand on.
    """

    struck: Meeting | None = None
    met: Meeting | None = None
    stood: dict[Pair, Array] = field(default_factory=dict)

    def note(self, row: int, pairs: Sequence[Pair], under: NDArray[np.bool_]) -> None:
        """Take the pairs of a row; ``under`` (3, k): which of them are under their distances of ``_bounds``."""
        if self.struck is None and under[0].any():
            self.struck = _meeting(row, pairs[int(np.argmax(under[0]))])
        if self.met is None and under[1].any():
            self.met = _meeting(row, pairs[int(np.argmax(under[1]))])

    def stand(self, row: int, on: Collection[Pair], carried: Mapping[str, Array]) -> None:
        """Take on what carried parts X_world_part (4, 4) stand: a part that slides on it meets it."""
        self.stood = {pair: self.stood.get(pair, _centre(carried, pair)) for pair in on}
        for pair, start in self.stood.items():
            if not np.linalg.norm(_centre(carried, pair) - start) <= NOTICED:
                self.met = _meeting(row, pair)


Followed = Generator[Placed, None, Scene]


class CellTouches:
    """Follows the parts of a cell through rehearsals; what was checked before is remembered."""

    def __init__(self, project: Project, kinematics: Kinematics) -> None:
        cell = project.cell
        self._cell, self._kinematics = cell, kinematics
        self._places = Places(kinematics, project.profile.period_us)
        self.shapes = Shapes(cell.robot, cell)
        self._swept: dict[tuple[object, ...], Sweep] = {}
        self._sizes = {part.name: part.size for part in cell.parts}
        self._limits: dict[tuple[object, ...], Array | None] = {}
        self._start = self._resting(
            Scene(
                lying={part.name: np.array(part.X_world_part) for part in cell.parts},
                held={},
                opening=cell.hand.stroke,
                closed=False,
            ),
            {part.name for part in cell.parts},
        )

    def follow(self, rehearsal: Rehearsal) -> Found:
        """Yield what the moves and HANDs of a rehearsal touch, in order."""
        scene, hands = self._start, list(rehearsal.hands)
        for index, move in enumerate(rehearsal.moves):
            while hands and hands[0].after <= index:
                scene = yield from self._hand(hands.pop(0), scene)
            scene = yield from self._move(move, scene)
        for hand in hands:
            scene = yield from self._hand(hand, scene)

    def scenes(self, rehearsal: Rehearsal) -> list[tuple[int, Scene]]:
        """Return where the parts are by the HANDs of a rehearsal, each with the time from which on, us."""
        found = [(0, self._start)]
        for hand in rehearsal.hands:
            steps = self._hand(hand, found[-1][1])
            scene = None
            while scene is None:
                try:
                    next(steps)
                except StopIteration as end:
                    scene = end.value
            found.append((hand.begins_us, scene))
        return found

    def _tool(self, q: Array) -> Array:
        return np.asarray(self._kinematics.forward(q) @ self._cell.hand.X_flange_tool)

    # moves ----------------------------------------------------------------------------------------------------------

    def _move(self, move: RehearsedMove, scene: Scene) -> Followed:
        key = (move.q.tobytes(), scene.key)
        if key not in self._swept:
            self._swept[key] = self._sweep(move.q, scene)
        struck, met = self._swept[key].struck, self._swept[key].met
        if struck is not None:
            by, what = struck.by, struck.what.removeprefix("obstacle:")
            message = f"at {move.share(struck.row):.1f} % of the path {by} would be in {what}"
            yield self._places.at("RBL421", move, message, row=struck.row, severity=Severity.ERROR)
        if met is None or struck is not None:  # an obstacle stops the move, so that what it meets later is not reached
            return scene
        carried = "the carried " if met.by.startswith(_PART) else ""
        what = f"{carried}{shape_text(met.by)} would touch {shape_text(met.what)}"
        yield self._places.at("RBL440", move, f"at {move.share(met.row):.1f} % of the path {what}", row=met.row)
        return scene.without({name.removeprefix(_PART) for name in (met.by, met.what) if name.startswith(_PART)})

    def _sweep(self, q: Array, scene: Scene) -> Sweep:
        """Return what joint angles q (rows, n) rad strike and meet."""
        self.shapes.lay(scene.lying, scene.opening)
        X_world_tool = self._tool(q) if scene.held else np.empty((len(q), 4, 4))
        held = {name: X_world_tool @ X for name, X in scene.held.items()}
        sweep = Sweep()
        for row in range(len(q)):
            carried = {name: X[row] for name, X in held.items()}
            meeting, distances = self.shapes.meeting(q[row], carried)
            bounds = self._bounds(meeting, scene) if meeting else None
            if bounds is None:
                sweep.stood.clear()
                continue
            pairs, under = self._ordered(meeting, scene), ~(distances >= bounds)
            sweep.note(row, pairs, under)
            if held and sweep.met is None:
                sweep.stand(row, {pairs[k] for k in np.flatnonzero(under[2])}, carried)
        return sweep

    def _bounds(self, meeting: bytes, scene: Scene) -> Array | None:
        """Return the distances (3, k) m below which the k pairs that meet count; None: none of them can.

        In the rows: for RBL421, for RBL440, and for a carried part that stands on what is fixed.
        """
        key = (meeting, tuple(scene.held))
        if key not in self._limits:
            limits = np.array([self._bound(*pair, scene) for pair in self._ordered(meeting, scene)]).T
            self._limits[key] = limits if np.isfinite(limits).any() else None
        return self._limits[key]

    def _bound(self, by: str, what: str, scene: Scene) -> tuple[float, float, float]:
        """Return a column of ``_bounds`` for two shapes, what moves first."""
        fixed = is_fixed(what)
        if by.removeprefix(_PART) in scene.held:
            return -np.inf, self._carried_bound(what), MARGIN if fixed else -np.inf
        if by.startswith(_PART) or is_fixed(by):  # what lies on the table or on one another
            return NO_BOUND
        # the arm may not strike, but open fingers may graze a part: a run reports that from NOTICED on, too
        return -CLEARANCE if fixed else -np.inf, -NOTICED if what.startswith(_PART) else -np.inf, -np.inf

    def _carried_bound(self, what: str) -> float:
        """Return the distance m below which a carried part meets what it should not."""
        if what.startswith("link"):
            # the last links hold the part: their coarse shapes reach into it in every posture
            near = int(what.removeprefix("link")) > self._cell.robot.n - APART
            return -np.inf if near else -CLEARANCE
        return -PRESSED if what.startswith(_PART) or is_fixed(what) else -np.inf

    def _ordered(self, meeting: bytes, scene: Scene) -> list[Pair]:
        """Return pairs with what moves first: a carried part, then a shape of the arm, then the others."""

        def rank(name: str) -> tuple[bool, bool, bool]:
            # False sorts first: what is held, the arm, what is fixed, lying parts
            return name.removeprefix(_PART) not in scene.held, name.startswith(_PART), is_fixed(name)

        return [(a, b) if rank(a) <= rank(b) else (b, a) for a, b in self.shapes.pairs_of(meeting)]

    # the hand -------------------------------------------------------------------------------------------------------

    def _hand(self, hand: RehearsedHand, scene: Scene) -> Followed:
        if hand.effect.closed == scene.closed:
            return scene
        if not hand.effect.closed:
            return (yield from self._release(hand, scene))
        scene = self._grip(hand, scene)
        if not scene.held and self._cell.parts and scene.known:
            nothing = (
                "the cup seals on no part here" if self._cell.hand.is_cup else "no part is between the fingers here"
            )
            yield self._places.at("RBL441", hand, nothing)
        return scene

    def _grip(self, hand: RehearsedHand, scene: Scene) -> Scene:
        """Close the hand: what both pads meet is centred between them and held."""
        if self._cell.hand.is_cup:
            return self._suck(hand, scene)
        spec, X_tool_world = self._cell.hand, inverse(self._tool(hand.q))
        self.shapes.lay(scene.lying, spec.stroke)
        faces: dict[str, tuple[float, float]] = {}
        for name, X in scene.lying.items():
            reach = float(np.linalg.norm(self._sizes[name])) + spec.stroke
            if float(np.linalg.norm((X_tool_world @ X)[:3, 3])) <= reach:
                found = self.shapes.faces(hand.q, name)
                faces |= {} if found is None else {name: found}
        widest = max((high - low for low, high in faces.values()), default=0.0)
        held = {
            name: pose([0.0, -(low + high) / 2.0, 0.0]) @ X_tool_world @ scene.lying[name]
            for name, (low, high) in faces.items()
            if high - low >= widest - ALIKE
        }
        lying = {name: X for name, X in scene.lying.items() if name not in held}
        return replace(scene, lying=lying, held=held, opening=widest, closed=True)

    def _suck(self, hand: RehearsedHand, scene: Scene) -> Scene:
        """Hold the part that the cup seals on as it lies; a run draws it to the rim, by ``sealing.GAP`` at most."""
        X_world_tool = self._tool(hand.q)
        parts = [part for part in self._cell.parts if part.name in scene.lying]
        sealed = [p.name for p in parts if seals(self._cell.hand, X_world_tool, p, scene.lying[p.name])][:1]
        # not drawn to the rim here: by 1 mm at most, and where it is put down it rests as it lay
        held = {name: inverse(X_world_tool) @ scene.lying[name] for name in sealed}
        lying = {name: X for name, X in scene.lying.items() if name not in held}
        return replace(scene, lying=lying, held=held, closed=True)

    def _release(self, hand: RehearsedHand, scene: Scene) -> Followed:
        """Open the hand: held parts stay or rest a little lower, and the fingers may meet what is beside them."""
        X_world_tool, opening = self._tool(hand.q), self._cell.hand.stroke
        released = {name: X_world_tool @ X for name, X in scene.held.items()}
        scene = replace(scene, held={}, opening=opening, closed=False)
        met = self._sweep(hand.q[None], scene).met
        if met is not None:
            yield self._places.at("RBL440", hand, f"{shape_text(met.by)} would touch {shape_text(met.what)}")
            scene = scene.without({met.what.removeprefix(_PART)})
        return self._resting(replace(scene, lying={**scene.lying, **released}), released)

    def _resting(self, scene: Scene, names: Iterable[str]) -> Scene:
        """Return a scene in which these parts rest on what is under them; those that would fall far are left out."""
        unknown = set()
        for name in sorted(names, key=lambda name: (float(scene.lying[name][2, 3]), name)):  # the lower ones first
            self.shapes.lay(scene.lying, scene.opening)
            gap = self.shapes.gap_below(name, DROP, PRESSED)
            if gap is None:
                unknown.add(name)
            else:
                scene = replace(scene, lying={**scene.lying, name: pose([0.0, 0.0, -gap]) @ scene.lying[name]})
        return scene.without(unknown) if unknown else scene


def _meeting(row: int, pair: Pair) -> Meeting:
    return Meeting(row=row, by=pair[0], what=pair[1])


def _centre(carried: Mapping[str, Array], pair: Pair) -> Array:
    """Return the centre (3,) m of the carried part of a pair."""
    return carried[pair[0].removeprefix(_PART)][:3, 3]
