"""The joint curves that a move through the wrist may take, in the order in which they are computed.

A remedy is a function of the request that yields candidates; ``stages`` names them in their order. The first two are
the method of CN103429397A (Kobe Steel); what the document leaves to chance (hazards H1 to H4, docs/wrist.md) the others
put right. Places to try are shares of the path, so the choice does not depend on the sampling. Candidates are yielded
one by one and judged as they come: solving one costs a fraction of a millisecond to some milliseconds, and most moves
are settled by the first.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from runtime.core.frames import Array
from runtime.motion.path_ik import LineSolver, WristSolver
from runtime.motion.wrist.hold import Suppression, held_angles, smoothed_table
from runtime.motion.wrist.switch import WristLaw, WristLimits, law_between, law_from
from runtime.motion.wrist_request import SHORTEST_TRAVEL, Candidate, SampledPath, WristRequest
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.settings.profile import WristOptions

EARLIER = (0.9, 0.75, 0.6, 0.45, 0.3, 0.15, 0.0)
"""Switches before that of the document: shares of the path up to it."""

LATER = (0.25, 0.5, 0.75)
"""And after it: shares of the path from it to the end."""

SOFTER = (1.0, 0.25)
"""Widths of the soft start beside that of the profile."""

HELD_EARLIER = (0.75, 0.45, 0.15)
"""Those of ``EARLIER`` from which a posture is held as well: choosing it costs more than all the rest."""

HELD_WINDOWS = (0.15, 0.4)
"""Shares of the rest of the path over which the choice of a held posture is averaged.

The narrow one holds the components better, the wide one needs less acceleration of the wrist.
"""

WINDOWS = (0.1, 0.2, 0.35, 0.5)
"""Half widths of the part of the path in which the wrist goes from one configuration to the other."""

MIDDLES = (0.5, 0.25, 0.75)
"""Middles of that part, beside the one about which the wrist has to turn least."""

SHORTEST_WINDOW = 4
"""Samples of such a part at least: a cubic over fewer has no speed that the samples would show."""

DETOUR = "detour of the wrist"
DETOURS = ((0, 45), (0, -45), (60, 0), (-60, 0), (0, 80), (0, -80), (60, 80), (-60, -80), (120, 80), (-120, -80))
"""How far J4 and J5 deviate from their cubic at its middle, deg, where nothing else places the main axes at all."""

Remedy = Callable[[WristRequest, "HeldPosture"], Iterator[Candidate]]


class HeldPosture:
    """Curves of the wrist that hold posture components, from any sample of a path on (embodiment 4, S81 to S85).

    What suppression chose at a sample is kept: both windows smooth the same choice, and it costs more than all other
    candidates together. Yields none where no component is held, or none can be.
    """

    def __init__(self, request: WristRequest) -> None:
        self._request = request
        self._suppression = _suppression(request)
        self._chosen: dict[int, tuple[WristLaw, Array]] = {}

    def candidates(self, sample: int, windows: tuple[float, ...], remedy: str = "") -> Iterator[Candidate]:
        """Yield the curve that leaves the path at a sample, smoothed over each of some windows."""
        if self._suppression is None:
            return
        request, sampled = self._request, self._request.sampled
        for window in windows:
            if sample not in self._chosen:
                self._chosen[sample] = self._choose(self._suppression, sample)
            law, chosen = self._chosen[sample]
            table = smoothed_table(chosen, law, window)
            solver = WristSolver(sampled.line, table, sampled.q[sample], request.q_end)
            yield _leaving(request, solver, law.s_switch, remedy, held=True)

    def _choose(self, suppression: Suppression, sample: int) -> tuple[WristLaw, Array]:
        sampled = self._request.sampled
        law = law_from(sampled.q, sampled.s, sample, self._request.wrist_end, "linear")
        # at the top speed of the move: what suppression finds room for there, it has room for everywhere
        rate = float(np.diff(sampled.s).max()) / sampled.timing.period_s
        return law, held_angles(suppression, sampled.line.path, sampled.q[sample], law, rate)


def stages(options: WristOptions) -> tuple[tuple[Remedy, ...], ...]:
    """Return the remedies in their order, in stages: a later stage is computed when none before has a solution at all.

    ``remedies = false`` in the profile is the document alone.
    """
    if not options.remedies:
        return (DOCUMENT,)
    return DOCUMENT + OURS, LAST_RESORT


def posture_of_the_path(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """The path with its posture, S5 and S64, where it ends at the taught angles.

    The document leaves such a path as well when a condition is met. With remedies it is slowed first: a taught posture
    is not given up for a little time (docs/decisions/0018).
    """
    if request.arrives and (request.trigger is None or request.options.remedies):
        yield Candidate(solver=request.sampled.line)


def switch_of_the_document(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """The switch at the sample before the first condition, S61 to S63, in the shape of the profile (Figs 7, 8)."""
    if request.trigger is not None:
        yield _switched(request, request.switch, request.options.width)
        yield from holding.candidates(request.switch, HELD_WINDOWS[:1])


def softer_starts(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """The same switch with another soft start: where its acceleration or its peak speed was too large."""
    if request.trigger is not None:
        for width in _widths(request.options)[1:]:
            yield _switched(request, request.switch, width, "softer start")
        yield from holding.candidates(request.switch, HELD_WINDOWS[1:], "softer start")


def other_switches(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """Earlier and later switches: H1 is met where the wrist turns elsewhere, H3 and H4 where it has more time."""
    sampled, here = request.sampled, request.sampled.s[request.switch]
    # from near to far on either side: the nearer to the document's switch, the longer the tool keeps its posture
    places = [(share * here, "earlier switch", share in HELD_EARLIER) for share in EARLIER]
    places += [(here + share * (1.0 - here), "later switch", False) for share in LATER]
    seen = {request.switch}
    for place, remedy, held in places:
        sample = sampled.sample_at(place)
        if sample in seen or sample > sampled.last_solved:
            continue
        seen.add(sample)
        for width in _widths(request.options):
            yield _switched(request, sample, width, remedy)
        if held:
            yield from holding.candidates(sample, HELD_WINDOWS, remedy)


def back_to_the_posture(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """Curves that leave the path and return to it before the end; not in the document.

    Before and after, the tool has the posture of the path; in between the wrist goes from one solution to the other. At
    one place J4 and J6 of the two are always half a turn apart. But near a singularity both turn fast, so one solution
    before it and the other one after it are close: the half turn that J4 and J6 would make there is left out. The first
    middle of each width is where the wrist turns least.
    """
    if request.tracked:
        return
    sampled, s = request.sampled, request.sampled.s
    back = LineSolver(sampled.line.arm, sampled.line.path, request.q_end, to_end=True)
    q_back = back.rows(s)
    # NaN in either one makes the sum NaN: both solutions have to exist where the wrist leaves and where it returns
    both = np.isfinite((sampled.q + q_back)[:, -WRIST_AXES:].sum(axis=1))
    if not both.any():
        return
    for half in WINDOWS:
        for middle in (_nearest(sampled, q_back, half), *MIDDLES):
            first = sampled.sample_at(max(0.0, middle - half))
            last = min(int(np.searchsorted(s, min(1.0, middle + half))), len(s) - 1)
            if last - first < SHORTEST_WINDOW or not (both[first] and both[last]):
                continue
            law = law_between(sampled.q, q_back, s, first, last)
            solver = WristSolver(sampled.line, law, sampled.q[first], request.q_end, back)
            remedy = "back to the posture" if last < len(s) - 1 else "other switch"
            yield _leaving(request, solver, float(s[first]), remedy)


def detours(request: WristRequest, holding: HeldPosture) -> Iterator[Candidate]:
    """Detours of J4 and J5 from the start on, for H1: with the wrist turned away the main axes may have a solution."""
    sampled = request.sampled
    # slope 0: the move starts from rest there, and the slope of the path belongs to a posture that is being left
    cubic = replace(law_from(sampled.q, sampled.s, 0, request.wrist_end, "hermite"), slope=np.zeros(WRIST_AXES))
    for j4, j5 in DETOURS:
        law = replace(cubic, detour=np.radians([j4, j5, 0.0]))
        solver = WristSolver(sampled.line, law, sampled.q[0], request.q_end)
        yield _leaving(request, solver, 0.0, DETOUR)


DOCUMENT: tuple[Remedy, ...] = (posture_of_the_path, switch_of_the_document)
OURS: tuple[Remedy, ...] = (softer_starts, other_switches, back_to_the_posture)
LAST_RESORT: tuple[Remedy, ...] = (detours,)


def _suppression(request: WristRequest) -> Suppression | None:
    """Return what holds posture components; None where none are to be held, or none can be.

    A tool that turns in place has no direction of travel to count them in. Without a closed form, 125 solutions by
    steps in every cycle would take half a minute.
    """
    line = request.sampled.line
    if not request.held or line.path.length < SHORTEST_TRAVEL or not line.arm.kinematics.closed_form:
        return None
    speed = WristLimits.of(line.arm.spec, request.options).speed
    return Suppression(line.arm.kinematics, line.arm.X_flange_tool, request.held, speed)


def _widths(options: WristOptions) -> tuple[float, ...]:
    """Return the widths of the soft start to try, that of the profile first; other shapes have none to vary."""
    return (options.width, *SOFTER) if options.shape == "smooth" else (options.width,)


def _switched(request: WristRequest, sample: int, width: float, remedy: str = "") -> Candidate:
    """Return the candidate whose wrist goes to its end angles from a sample on, S7 and S8 in the profile's shape."""
    sampled = request.sampled
    law = law_from(sampled.q, sampled.s, sample, request.wrist_end, request.options.shape, width)
    solver = WristSolver(sampled.line, law, sampled.q[sample], request.q_end)
    return _leaving(request, solver, float(sampled.s[sample]), remedy)


def _leaving(
    request: WristRequest, solver: WristSolver, switch: float, remedy: str, *, held: bool = False
) -> Candidate:
    return Candidate(
        solver=solver,
        switch=switch,
        trigger=request.trigger,
        remedy=remedy,
        held=request.held if held else (),
    )


def _nearest(sampled: SampledPath, q_back: Array, half: float) -> float:
    """Return the middle of the window of half width ``half`` in which the wrist turns least; 0.5 where there is none.

    q_back (N + 1, n): the path in the configuration of its end. Turns are counted in the time that each axis needs.
    """
    s, limits = sampled.s, sampled.line.arm.spec.per_axis("limits", "speed")[-WRIST_AXES:]
    leaves, joins = sampled.q[:, -WRIST_AXES:] / limits, q_back[:, -WRIST_AXES:] / limits
    # all windows at once; a share of the path may have few samples where the move is fast, so places are looked up
    firsts = np.searchsorted(s, np.maximum(s - half, 0.0), side="right") - 1
    lasts = np.minimum(np.searchsorted(s, np.minimum(s + half, 1.0)), len(s) - 1)
    turns = np.abs(joins[lasts] - leaves[firsts]).max(axis=1)
    return float(s[int(np.nanargmin(turns))]) if np.isfinite(turns).any() else 0.5
