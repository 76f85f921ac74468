"""What a page holds of a run: its signals, its charts, notes and joints, and what the log says of it, packed."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from robolang.logs.files import read_log
from robolang.logs.log import Log, Meta
from robolang.view import charts, joints, notes
from robolang.view.packing import Signal, pack
from robolang.view.programmed import programmed_signal
from robolang.view.run_signals import drawn_off, in_pieces, signals_of
from robolang.view.thinning import paired, thinned
from runtime.appearance.scene import Scene
from runtime.core.faults import Fault
from runtime.core.frames import Array

_LEFT_OUT = ("cell", "points", "findings", "home")
"""Of the log's ``meta``: what no part of the page shows, or has in another place: the points are in the scene."""
MOST_LEVELS = 1024
"""Most inputs and outputs that change in a run that is shown."""
_WRONG = (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError, RecursionError)
"""What is raised for a ``meta`` that says something else than one of a run."""
_WORDS = {"input": "IN", "output": "OUT"}


def pack_run(log: Log, label: str) -> bytes:
    """Return a run as a page holds it; ``Fault`` RBL820 for a log of an older layout, RBL619 for a wrong one."""
    try:
        return _packed(log, log.needed_meta(), label)
    except _WRONG as error:
        raise Fault(
            "RBL619", f"{log.source} is not the log of a run: its meta is not as it should be: {error}"
        ) from None


def open_run(path: Path) -> Log:
    """Return the log in a file, with what a page needs; ``Fault`` RBL600, RBL619, RBL820, RBL821, RBL833."""
    log = read_log(path)
    scene = log.needed_meta().get("scene")
    if scene is not None:
        Scene.from_json(scene)  # a file is not trusted, and the page draws what is in it
    return log


def check_comparable(logs: Sequence[Log]) -> None:
    """Raise ``Fault`` RBL826 when logs are not of one robot."""
    robots = [log.needed_meta()["robot"] for log in logs]
    for robot in robots[1:]:
        if _shape(robot) != _shape(robots[0]):
            first, other = (f"{robot['name']} with {len(robot['axes'])} axes" for robot in (robots[0], robot))
            message = f"the first run is of {first}, the other of {other}"
            raise Fault("RBL826", message, "Write a page for each of them.")


def _shape(robot: Mapping[str, Any]) -> object:
    return robot["name"], [(axis["name"], axis["kind"]) for axis in robot["axes"]]


def _programmed(log: Log, meta: Meta, cycle_s: float) -> Iterator[Signal]:
    return programmed_signal(meta["report"]["statements"], log.count("t") // log.rows.ticks_per_cycle, cycle_s)


def _packed(log: Log, meta: Meta, label: str) -> bytes:
    robot, tick_s, cycle_s = meta["robot"], float(meta["tick_s"]), float(meta["cycle_s"])
    names, levels = _levels(log, cycle_s)
    signals = {signal.name: signal for signal in (*signals_of(log, robot), *levels, *_programmed(log, meta, cycle_s))}
    if not log.count("t"):
        signals.update(_standing(meta, tick_s))
    shown = charts.Shown(robot=robot, signals=signals, levels=names)
    header = {
        "kind": "run",
        "label": label,
        "duration_s": log.count("t") * tick_s,
        "tick_s": tick_s,
        "cycle_s": cycle_s,
        "thinned": thinned(log.count("t"), tick_s, drawn_off(log)),
        "meta": {
            **{key: value for key, value in meta.items() if key not in _LEFT_OUT},
            "report": _report(meta["report"]),
        },
        "charts": [asdict(chart) for chart in charts.of_run(shown)],
        "notes": [asdict(note) for note in notes.of_run(meta)],
        "joints": [asdict(joint) for joint in joints.ranges(robot["axes"], _angles(log, signals), tick_s)],
    }
    return pack(header, list(signals.values()))


def _standing(meta: Meta, tick_s: float) -> dict[str, Signal]:
    """Return the posture of an arm that has not moved: without a row it would be drawn with all joints at 0."""
    # a log of an earlier version does not have it
    if "home" not in meta:
        return {}
    q = np.array([meta["home"]], dtype=np.float64)
    if q.shape != (1, len(meta["robot"]["axes"])):
        raise ValueError("home has another number of axes")
    return {"q_link": Signal(name="q_link", base="tick", dt=tick_s, values=q)}


def _angles(log: Log, signals: Mapping[str, Signal]) -> Iterable[Array]:
    # of a long run the page has fewer rows than the log
    return in_pieces(log, "q_link") if log.count("t") else [signals["q_link"].values]


def _report(report: Mapping[str, Any]) -> dict[str, Any]:
    """Return a report with the statements that have begun: the others are at no time of the run."""
    return {**report, "statements": [item for item in report["statements"] if item["begun"]]}


def _levels(log: Log, cycle_s: float) -> tuple[list[str], list[Signal]]:
    """Return names and levels of the inputs and outputs that change in a run, from the events of its log."""
    found = [(f"{_WORDS[item['kind']]} {item['name']}", item) for item in log.events if item["kind"] in _WORDS]
    # IN 2 before IN 10
    names = sorted({name for name, _ in found}, key=lambda name: (name.split()[0], len(name), name))
    if not names:
        return [], []
    if not len(names) <= MOST_LEVELS:
        raise ValueError(f"{len(names)} inputs and outputs change, more than {MOST_LEVELS}")
    values = np.zeros((max(1, log.rows.cycles), len(names)))
    changes: dict[str, list[tuple[int, float]]] = {name: [] for name in names}
    for name, item in found:
        # the cycle in which it changes: a little before one, by rounding, is that one
        changes[name].append((max(0, math.floor(item["time_s"] / cycle_s + 1e-6)), float(item["value"])))
    for k, name in enumerate(names):
        # each up to the next, not to the end: a signal may change in every cycle
        rows = sorted(changes[name], key=lambda change: change[0])
        for (row, value), (following, _) in pairwise((*rows, (len(values), 0.0))):
            values[row:following, k] = value
    return names, [paired(Signal(name="levels", base="cycle", dt=cycle_s, values=values))]
