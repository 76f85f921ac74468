"""What the arm, the hand or a held part touches, how far it moves that, and whether the hand still holds its part.

The plant reports every 8 ms cycle which shapes have touched, by name (``Touching``), and where parts and tool are
(``Bodies``). From these alone follows what a program did to its cell:

    allowed     pads and part from HAND ON to HAND OFF; a held part on its support where it is gripped and put down;
                parts that rest on the table or on one another
    pushed      anything else of the arm, the hand or a held part on a part, and what that part pushes in turn
    struck      the arm or the hand on an obstacle, the floor or another link; a held part that slides along one
    lost        a part that has moved in the closed hand from where it was gripped: by more than half the length of a
                pad, or by more than ``NOTICED`` when no pad has touched it for ``LOST_CYCLES``

A part is measured from where it was before the touch until it rests again: the largest displacement of one of its
corners. A touch that goes on in the next statement begins a record of its own there. Nothing here acts on the motion.
"""

import copy
import math
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np

from runtime.cell.gripper import FINGERS, is_holder
from runtime.core.frames import Array, rotation_angle
from runtime.core.linear import matmul, norm
from runtime.core.program_line import ProgramLine, named
from runtime.core.state import State
from runtime.core.units import DEG, MM

Pair = tuple[str, str]
NOTICED = 0.5e-3
"""Displacement from which a touch is a finding, m."""
LOST_CYCLES = 3
"""Cycles without a pad on a part in which it is only off the pads: fingers that close fast jump back from it."""
SETTLING = 5
"""Cycles from the first touch of both pads in which the hand aligns the part, and longer while HAND ON waits."""
GAP = 10
"""Cycles without a contact that end a touch: what slides also hops."""
TURNED = 0.1 * DEG
"""A smaller turn is not reported, rad."""
AT_REST = 2e-6
"""Displacement in a cycle below which a part rests, m: contacts creep slower than that."""
SLIPPED = 10e-3
"""A part that has moved less in the hand is held, m, however short the pads are."""
_PART = "part:"
_OBSTACLE = "obstacle:"


@dataclass(frozen=True, slots=True, kw_only=True)
class Bodies:
    """The m parts and the tool as live arrays of one instant, at most one physics step old; world frame, m.

    ``p`` (m, 3) and ``R`` (m, 3, 3) are the centres and orientations of the parts, ``size`` (m, 3) their edges,
    ``p_tool`` (3,) and ``R_tool`` (3, 3) the tool point, ``pad_length`` m how long a pad is or how wide a cup;
    ``holders``: how many pads or cups must touch a part that is held.
    """

    names: tuple[str, ...]
    size: Array
    p: Array
    R: Array
    p_tool: Array
    R_tool: Array
    pad_length: float
    holders: int = len(FINGERS)


@dataclass(slots=True, kw_only=True)
class Touch:
    """A touch: ``by`` which shapes (the first one first), of what, since which ``tick`` and in which statement.

    ``reach`` m is the largest displacement of a corner of the touched part, ``moved`` m and ``turned`` rad what its
    centre and its orientation had changed by then; ``slid`` m is how far a held part slid along what it touched.
    ``blocked``: it did not yield, and the drives were stopped by it.
    """

    by: list[str]
    what: str
    tick: int
    place: ProgramLine | None
    statement: int
    moved: float = 0.0
    turned: float = 0.0
    reach: float = 0.0
    slid: float = 0.0
    blocked: bool = False

    @property
    def message(self) -> str:
        """The touch in words, in mm and deg."""
        by, what = shape_text(self.by[0]), shape_text(self.what)
        if self.fixed:
            slid = f", along which it slid {self.slid / MM:.1f} mm" if self.by_part else ""
            return f"{by} touched {what}{slid}"
        if self.reach <= NOTICED:
            return f"{by} touched {what} and was stopped by it"
        turned = f" and turned it by {self.turned / DEG:.1f} deg" if self.turned >= TURNED else ""
        return f"{by} touched {what}, moved it {self.moved / MM:.1f} mm{turned}"

    @property
    def fixed(self) -> bool:
        """Whether an obstacle, the floor or a link of the arm was touched, which nothing pushes."""
        return not self.what.startswith(_PART)

    @property
    def by_part(self) -> bool:
        """Whether a part touched it and not the arm or the hand itself."""
        return self.by[0].startswith(_PART)

    @property
    def noticed(self) -> bool:
        """Whether it is a finding: something moved, or the arm or the hand struck what is fixed or does not move."""
        return self.blocked or (self.fixed and not self.by_part) or not (self.reach <= NOTICED and self.slid <= NOTICED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss:
    """A part that the hand no longer holds: since which tick and statement, and how far it is off its place."""

    part: str
    tick: int
    place: ProgramLine | None
    gripped: ProgramLine | None
    distance: float

    @property
    def message(self) -> str:
        """The loss in words, in mm."""
        gripped = "" if self.gripped is None else f", gripped in {named(self.gripped.line, self.gripped.number)},"
        return (
            f"{self.part}{gripped} has slipped out of the hand: it is "
            f"{self.distance / MM:.1f} mm from where it was gripped"
        )


@dataclass(slots=True, kw_only=True)
class _Grip:
    """A held part: where it is held (3,) m in the tool frame; cycles held, and without a pad since when and where."""

    place: tuple[float, float, float]
    gripped: ProgramLine | None
    age: int = 0
    bare: int = 0
    since: tuple[int, ProgramLine | None] = (0, None)


@dataclass(slots=True, kw_only=True)
class _Open:
    """A touch that goes on: the pose before it of the body that is measured, and cycles since the last contact.

    ``in_tool``: measured in the tool frame, a held part that another link touches.
    """

    touch: Touch
    body: int
    p: Array
    R: Array
    in_tool: bool = False
    gripping: bool = False
    gap: int = 0


@dataclass(slots=True)
class _Seen:
    """The contacts of a cycle by what they are."""

    pads: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    on_parts: list[Pair] = field(default_factory=list)
    on_fixed: list[Pair] = field(default_factory=list)
    among_parts: list[Pair] = field(default_factory=list)
    parts_on_fixed: list[Pair] = field(default_factory=list)


class Touches:
    """Watches the contacts of one run; ``records`` are the touches so far that are not allowed, in order."""

    def __init__(self, bodies: Bodies, gripped: Callable[[], Collection[str]]) -> None:
        """``gripped`` gives the parts that the fingers press on now (``Plant.gripped``)."""
        self.records: list[Touch] = []
        self._bodies, self._gripped = bodies, gripped
        self._index = {_PART + name: k for k, name in enumerate(bodies.names)}
        signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        self._corners = signs * bodies.size[:, None, :]
        self._before = replace(
            bodies, p=bodies.p.copy(), R=bodies.R.copy(), p_tool=bodies.p_tool.copy(), R_tool=bodies.R_tool.copy()
        )
        self._pairs: frozenset[Pair] | None = None
        self._seen = _Seen()
        self._closed = False
        self._closing: ProgramLine | None = None
        self._held: dict[str, _Grip] = {}
        self._lost: set[str] = set()
        self._free: set[str] = set()  # let go: they move by themselves until they rest
        self._open: dict[str, _Open] = {}  # by the part that is pushed, or by "part>fixed" that it slides along
        self._place: ProgramLine | None = None
        self._statement = 0

    @property
    def latest(self) -> tuple[Touch | None, int]:
        """The last record and how many are still measured: what is equal in two cycles has ended no touch between."""
        return (self.records[-1] if self.records else None), len(self._open)

    def over(self) -> list[Touch]:
        """Return the records so far that nothing changes any more."""
        going = {id(each.touch) for each in self._open.values()}
        return [touch for touch in self.records if id(touch) not in going]

    def snapshot(self) -> State:
        """Return what is held, lost, free and touched now, and all records so far."""
        twin = copy.copy(self)
        twin._separate()
        return State(owner=type(self), values=(twin,))

    def restore(self, state: State) -> None:
        """Put a state back, also into the touches of another run of the same cell."""
        state.check(self)
        twin = copy.copy(state.values[0])
        twin._separate()
        bodies, gripped = self._bodies, self._gripped
        self.__dict__.update(twin.__dict__)
        self._bodies, self._gripped = bodies, gripped

    def _separate(self) -> None:
        """Copy everything that changes in place, so that a shallow copy is independent."""
        touches: dict[int, Touch] = {}  # a touch that goes on is one object in records and in what is open

        def own(touch: Touch) -> Touch:
            return touches.setdefault(id(touch), replace(touch, by=[*touch.by]))

        self.records = [own(touch) for touch in self.records]
        self._open = {key: replace(going, touch=own(going.touch)) for key, going in self._open.items()}
        self._held = {part: replace(grip) for part, grip in self._held.items()}
        self._lost, self._free = set(self._lost), set(self._free)
        before = self._before
        self._before = replace(
            before, p=before.p.copy(), R=before.R.copy(), p_tool=before.p_tool.copy(), R_tool=before.R_tool.copy()
        )

    def hand(self, closed: bool, place: ProgramLine | None) -> None:
        """HAND ON or HAND OFF begins, a statement; OFF lets go what is held."""
        if not closed:
            self._free |= self._held.keys()
            self._held.clear()
        self._free |= self._lost
        self._lost.clear()
        self._closed, self._closing = closed, place if closed else None
        self._pairs = None

    def blocked(self) -> None:
        """The drives have been stopped: what the arm and the hand touch now may be why."""
        for going in self._open.values():
            going.touch.blocked = not going.gap and not going.touch.by_part

    def cycle(self, tick: int, place: ProgramLine | None, pairs: frozenset[Pair]) -> Loss | None:
        """Take the contacts of the cycle from ``tick`` on and the statement that ran; a part that was lost, if any."""
        # a new statement begins records of its own, also where the set of contacts stays the same
        if place != self._place:
            self._place, self._statement, self._pairs = place, self._statement + 1, None
        lost = None
        if pairs != self._pairs or self._open or self._free:
            lost = self._follow(tick, pairs)
        elif self._held:  # an arm in the air with a part
            lost = self._lose(self._seen, tick)
        self._remember()
        return lost

    def _follow(self, tick: int, pairs: frozenset[Pair]) -> Loss | None:
        if pairs != self._pairs:
            self._pairs, self._seen = pairs, _sorted(pairs)
        seen = self._seen
        self._grip(seen)
        lost = self._lose(seen, tick)
        touched = {self._push(by, what, tick) for by, what in self._pushes(seen)}
        sliding = [pair for pair in seen.parts_on_fixed if pair[0] in self._held and not self._settles(pair[0])]
        touched |= {self._slide(by, what, tick) for by, what in sliding}
        for by, what in seen.on_fixed:
            self._strike(by, what, tick)
        self._measure(touched)
        return lost

    def _remember(self) -> None:
        bodies, before = self._bodies, self._before
        before.p[:], before.R[:] = bodies.p, bodies.R
        if self._held:
            before.p_tool[:], before.R_tool[:] = bodies.p_tool, bodies.R_tool

    # the grip -------------------------------------------------------------------------------------------------------

    def _in_hand(self, part: str) -> tuple[float, float, float]:
        """Return the centre of a part in the tool frame, m; as floats, since every cycle with a part needs it."""
        bodies = self._bodies
        x, y, z = (bodies.p[self._index[part]] - bodies.p_tool).tolist()
        (ax, bx, cx), (ay, by, cy), (az, bz, cz) = bodies.R_tool.tolist()
        return x * ax + y * ay + z * az, x * bx + y * by + z * bz, x * cx + y * cy + z * cz

    def _grip(self, seen: _Seen) -> None:
        """Take a part between the pads of the closed hand as held; that it was pushed to there was its grasp."""
        may = [
            part for part, pads in seen.pads.items() if len(pads) == self._bodies.holders and part not in self._taken
        ]
        gripped = self._gripped() if self._closed and may else ()
        for part in may:
            if part.removeprefix(_PART) in gripped:
                self._held[part] = _Grip(place=self._in_hand(part), gripped=self._place)
                self._free.discard(part)
                going = self._open.pop(part, None)
                if going is not None and going.gripping:
                    self.records.remove(going.touch)

    def _settles(self, part: str) -> bool:
        """Return whether the closing hand still aligns a part, while HAND ON waits."""
        return self._held[part].age <= SETTLING or (self._closing is not None and self._place == self._closing)

    def _lose(self, seen: _Seen, tick: int) -> Loss | None:
        for part, grip in list(self._held.items()):
            grip.age += 1
            if part in seen.pads:
                grip.bare = 0
            elif not grip.bare:
                grip.bare, grip.since = 1, (tick, self._place)
            else:
                grip.bare += 1
            here = self._in_hand(part)
            if self._settles(part):
                grip.place = here
                if grip.bare >= LOST_CYCLES:  # squeezed out of the closing hand, which has closed on nothing then
                    self._free.add(part)
                    del self._held[part]
                continue
            distance = math.dist(here, grip.place)
            most = NOTICED if grip.bare >= LOST_CYCLES else max(SLIPPED, self._bodies.pad_length / 2.0)
            if not distance <= most:
                since, place = grip.since if grip.bare else (tick, self._place)
                del self._held[part]
                self._lost.add(part)
                return Loss(
                    part=part.removeprefix(_PART), tick=since, place=place, gripped=grip.gripped, distance=distance
                )
        return None

    @property
    def _taken(self) -> set[str]:
        """The parts that the closed hand has gripped, lost ones as well."""
        return self._held.keys() | self._lost

    # touches --------------------------------------------------------------------------------------------------------

    def _pushes(self, seen: _Seen) -> Iterable[Pair]:
        """Yield (by, part) of every contact that may push a part and is not allowed."""
        yield from (pair for pair in seen.on_parts if not self._may_touch(*pair))
        moving = self._taken | self._free
        loose = moving | {key for key in self._open if key in self._index}
        # a contact of two parts has no direction: either one may push the other
        both = chain.from_iterable((pair, pair[::-1]) for pair in seen.among_parts)
        for by, part in both:
            if by in loose and part not in moving and not self._pushed_by(by, part):
                yield by, part

    def _may_touch(self, by: str, part: str) -> bool:
        """Return whether a shape of the arm or hand may touch a part: the hand may while it holds it or lets it go."""
        if by.startswith("link"):
            return False
        # the palm never lets a part go: it pushes what is left of an opened grip
        return part in self._taken or (part in self._free and by != "palm")

    def _pushed_by(self, part: str, other: str) -> bool:
        """Return whether it is the other one that pushes this part."""
        return part in self._open and other in self._open[part].touch.by

    def _push(self, by: str, part: str, tick: int) -> str:
        """Open the record of a touch of a part, or go on with it in the same statement."""
        going = self._open.get(part)
        if going is None or going.touch.statement != self._statement:
            touch = Touch(by=[by], what=part, tick=tick, place=self._place, statement=self._statement)
            self._start(part, touch, self._index[part], self._closed and is_holder(by))
        elif by not in going.touch.by:
            going.touch.by.append(by)
        return part

    def _slide(self, part: str, fixed: str, tick: int) -> str:
        """Open the record of a held part on what is fixed, or go on with it in the same statement."""
        key = f"{part}>{fixed}"
        if key not in self._open or self._open[key].touch.statement != self._statement:
            touch = Touch(by=[part], what=fixed, tick=tick, place=self._place, statement=self._statement)
            self._start(key, touch, self._index[part])
        return key

    def _start(self, key: str, touch: Touch, body: int, gripping: bool = False) -> None:
        in_tool = key in self._held
        p, R = _pose(self._before, body, in_tool)  # of the cycle before, in which it was not touched yet
        self._open[key] = _Open(touch=touch, body=body, p=p, R=R, in_tool=in_tool, gripping=gripping)
        self.records.append(touch)

    def _strike(self, by: str, fixed: str, tick: int) -> None:
        """Record that the arm or the hand touches what is fixed, once for a statement."""
        # from the end: only records of this statement can be continued, and they are the last ones
        for touch in reversed(self.records):
            if touch.statement != self._statement:
                break
            if touch.what == fixed and not touch.by_part:
                if by not in touch.by:
                    touch.by.append(by)
                return
        self.records.append(Touch(by=[by], what=fixed, tick=tick, place=self._place, statement=self._statement))

    def _measure(self, touched: set[str]) -> None:
        """Measure what is touched or still moves, and end the records of what is neither."""
        for key, going in list(self._open.items()):
            going.gap = 0 if key in touched else going.gap + 1
            pushed = key in self._index
            rolls_on = pushed and not going.in_tool  # what is pushed moves on by itself
            if not going.gap or rolls_on:
                self._displace(going, pushed)
            if self._ended(going, rolls_on):
                del self._open[key]
        self._free = {part for part in self._free if self._stays_free(part)}

    def _ended(self, going: _Open, rolls_on: bool) -> bool:
        """Return whether a touch is over: without a contact for ``GAP`` cycles, and what rolled on is at rest."""
        return going.gap > GAP and not (rolls_on and self._moves(going.body))

    def _stays_free(self, part: str) -> bool:
        """Return whether a part that was let go still touches a pad or moves."""
        return part in self._seen.pads or self._moves(self._index[part])

    def _displace(self, going: _Open, pushed: bool) -> None:
        p, R = _pose(self._bodies, going.body, going.in_tool)
        touch, offset = going.touch, p - going.p
        reach = float(np.linalg.norm(matmul(self._corners[going.body], (R - going.R).T) + offset, axis=1).max())
        if not pushed:
            touch.slid = touch.slid if reach <= touch.slid else reach
        elif not reach <= touch.reach:
            touch.reach, touch.moved = reach, norm(offset)
            touch.turned = rotation_angle(going.R, R)

    def _moves(self, body: int) -> bool:
        return not float(np.abs(self._bodies.p[body] - self._before.p[body]).max()) <= AT_REST


def _pose(bodies: Bodies, body: int, in_tool: bool) -> tuple[Array, Array]:
    """Return centre (3,) m and orientation (3, 3) of a part, in the world or in the tool frame, as copies."""
    p, R = bodies.p[body], bodies.R[body]
    if not in_tool:
        return p.copy(), R.copy()
    return np.asarray(matmul(p - bodies.p_tool, bodies.R_tool)), np.asarray(matmul(bodies.R_tool.T, R))


def shape_text(name: str) -> str:
    """Return how a shape of the arm, the hand or the cell is named in messages."""
    kind, _, which = name.partition("_")
    if kind in ("pad", "shank"):
        return f"the {which} finger"
    if name.startswith("link"):
        return f"link {name.removeprefix('link')}"
    return {"palm": "the palm", "cup": "the cup", "floor": "the floor"}.get(
        name, name.removeprefix(_PART).removeprefix(_OBSTACLE)
    )


def _sorted(pairs: frozenset[Pair]) -> _Seen:
    """Sort contacts by what touches what, in a fixed order."""
    seen = _Seen()
    for pair in sorted(pairs):  # a set of names has another order in every process
        parts = [name.startswith(_PART) for name in pair]
        fixed = [is_fixed(name) for name in pair]
        if all(parts):
            seen.among_parts.append(pair)
        elif any(parts):
            part, other = pair[parts.index(True)], pair[parts.index(False)]
            if any(fixed):
                seen.parts_on_fixed.append((part, other))
            else:
                seen.on_parts.append((other, part))
                if is_holder(other):
                    seen.pads[part].add(other)
        elif any(fixed):
            seen.on_fixed.append((pair[fixed.index(False)], pair[fixed.index(True)]))
        else:  # the arm in itself: the shape that is nearer to its base counts as fixed
            inner, outer = sorted(pair, key=lambda name: (not name.startswith("link"), name))
            seen.on_fixed.append((outer, inner))
    return seen


def is_fixed(name: str) -> bool:
    """Return whether a shape never moves: the floor and obstacles."""
    return name == "floor" or name.startswith(_OBSTACLE)
