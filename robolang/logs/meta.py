"""``meta`` of a log as it is read from a file: what everybody computes with is checked. Nothing in it is trusted."""

import json
import math
from typing import Any, NoReturn

import numpy as np

from robolang.logs.log import VERSION
from runtime.core.faults import Fault, lookup
from runtime.robot.files.robot_file import MOST_AXES

_LEAST_IN_BRACKETS = 5
"""Fewest characters for each bracket of a meta, on average: a face of a mesh, ``[0,1,2],``, has eight."""
_FEW_BRACKETS = 10_000
_MOST_TICKS_PER_CYCLE = 1000


def damaged(path: object, why: object) -> Fault:
    """Return the fault of a file that is no log, with the reason."""
    return Fault("RBL619", f"{path} is not the log of a run: {why}")


def unreadable(path: object, why: object) -> Fault:
    """Return the fault of a log that cannot be read, with the reason."""
    return Fault("RBL600", f"cannot read {path}: {why}", lookup("RBL619").remedy)


def read_meta(text: bytes, path: object) -> dict[str, Any]:
    """Return the ``meta`` of a log, whose robot and times can be computed with.

    ``Fault`` RBL619, and RBL821 for one of a later version; ``ValueError``, ``KeyError`` or ``TypeError`` where
    something is missing or of another kind.
    """
    try:
        # each takes twenty times its two characters in memory, and where there are many of them it is no meta
        brackets = text.count(b"[") + text.count(b"{")
        if not brackets <= _FEW_BRACKETS + len(text) / _LEAST_IN_BRACKETS:
            raise ValueError("brackets without content")
        meta = json.loads(text, parse_constant=_no_constant, parse_float=_finite)
    except (ValueError, RecursionError) as error:
        raise damaged(path, f"its meta cannot be read: {error}") from None
    if not isinstance(meta, dict):
        raise damaged(path, "its meta is no object")
    version = meta.get("format")
    if isinstance(version, int) and version > VERSION:
        raise Fault("RBL821", f"{path} has layout {version}; this version of robolang reads up to {VERSION}")
    if version != VERSION:
        raise damaged(path, "its meta has no format")
    _check_robot(meta["robot"])
    # the keys that everybody reads; what is inside them is for those who show it
    for key, kind in {"program": dict, "points": dict, "events": list, "report": dict}.items():
        if not isinstance(meta[key], kind):
            raise ValueError(f"'{key}' is of another kind")
    return meta


def ticks_of(meta: dict[str, Any]) -> tuple[int, int]:
    """Return the duration of a tick, us, and the ticks of a cycle; ``ValueError`` for times that no run has."""
    tick_s, cycle_s = meta["tick_s"], meta["cycle_s"]
    if not (isinstance(tick_s, float) and isinstance(cycle_s, float)):
        raise ValueError(f"a tick of {tick_s} in a cycle of {cycle_s}")
    if not (1e-6 <= tick_s <= 1.0 and 1 <= cycle_s / tick_s <= _MOST_TICKS_PER_CYCLE):
        raise ValueError(f"a tick of {tick_s} s in a cycle of {cycle_s} s")
    return round(tick_s * 1e6), round(cycle_s / tick_s)


def _check_robot(robot: dict[str, Any]) -> None:
    if not len(robot["axes"]) <= MOST_AXES:
        raise ValueError(f"a robot of {len(robot['axes'])} axes")
    matrices = [robot["flange"], robot["tool"], *(axis["placement"] for axis in robot["axes"])]
    poses = np.array(matrices, dtype=np.float64)
    if poses.shape != (len(matrices), 4, 4) or not np.isfinite(poses).all():
        raise ValueError("a pose of the robot is not 4 x 4 numbers")


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def _finite(text: str) -> float:
    value = float(text)
    # 1e999 is a number in JSON, and infinite
    return value if math.isfinite(value) else _no_constant(text)
