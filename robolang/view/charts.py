"""Which charts a page has: those that say something about its run, as data that the page draws.

A chart names columns of packed signals; the page multiplies them by ``scale``, from SI to the unit that people read.
Axes that turn and axes that slide have charts of their own, since a chart has one unit.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from robolang.view.packing import Signal
from robolang.view.programmed import NAME
from runtime.core.units import DEG, MM, PERCENT

Role = Literal["value", "command", "limit", "step"]
_HIGH = 0.5
"""An axis that gets to this part of its torque limit has the limit drawn beside its torque."""
_WHOLE = (-100.0, 100.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One curve: a column of a signal, times ``scale``; ``minus`` another column, subtracted before that."""

    label: str
    signal: str
    column: int = 0
    scale: float = 1.0
    minus: tuple[str, int] | None = None
    role: Role = "value"


@dataclass(frozen=True, slots=True, kw_only=True)
class Chart:
    """Curves over one axis; ``band``: the range in which they should stay; ``lanes``: levels, one above another."""

    id: str
    title: str
    unit: str
    series: tuple[Series, ...] = ()
    band: tuple[float, float] | None = None
    lanes: bool = False


_TOOL_ERROR = Chart(id="tool_error", title="Tool error", unit="mm")
_TOOL_SPEED = Chart(id="tool_speed", title="Tool speed", unit="mm/s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """Axes of one kind, by name and index: how their charts are named, and what one of their units is in SI."""

    suffix: str
    word: str
    unit: str
    size: float
    load: str
    inertia: str
    axes: tuple[tuple[int, str], ...]


def kinds(axes: Sequence[Mapping[str, Any]]) -> list[Kind]:
    """Return the axes of a robot (``meta["robot"]["axes"]``) by kind, those that turn first."""
    named = {
        kind: tuple((k, str(axis["name"])) for k, axis in enumerate(axes) if axis["kind"] == kind)
        for kind in ("revolute", "prismatic")
    }
    found = [
        Kind(suffix="", word="angle", unit="deg", size=DEG, load="N m", inertia="kg m²", axes=named["revolute"]),
        Kind(suffix="_mm", word="position", unit="mm", size=MM, load="N", inertia="kg", axes=named["prismatic"]),
    ]
    return [kind for kind in found if kind.axes]


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """What the charts are chosen from: the robot of the run, and its signals as they are packed, by name."""

    robot: Mapping[str, Any]
    signals: Mapping[str, Signal]
    levels: Sequence[str] = ()
    """Names of the inputs and outputs, the columns of the signal ``levels``."""

    def says(self, name: str) -> bool:
        """Whether a signal is there and changes, or is not zero."""
        return name in self.signals and bool(np.any(self.signals[name].values != 0.0))

    def varies(self, name: str) -> bool:
        """Whether a signal is there and changes."""
        values = self.signals[name].values if name in self.signals else np.zeros((0, 1))
        return len(values) > 0 and bool(np.any(values != values[0]))

    def switches(self, name: str, column: int) -> bool:
        """Whether a column has no other values than 0 and 1."""
        return bool(np.isin(self.signals[name].values[:, column], (0.0, 1.0)).all())

    def limit(self, axis: int, kind: str) -> float | None:
        """Return a limit of an axis, in SI; None: it has none."""
        limit = self.robot["axes"][axis].get(kind)
        return float(limit) if limit is not None and 0.0 < limit < np.inf else None

    def high(self, axis: int) -> bool:
        """Whether the torque of an axis gets near its limit."""
        limit = self.limit(axis, "torque")
        return limit is not None and bool(np.any(np.abs(self.signals["tau_sat"].values[:, axis]) >= _HIGH * limit))


def of_run(shown: Shown) -> list[Chart]:
    """Return the charts of a run, what is read first at the top."""
    # the order is that of the page: what tells how good a run was, then what explains it
    read = [_tool_error(shown), *_by_kind(shown, _joint_error, _torque_pct, _joints, _speed), _tool_speed(shown)]
    load = Chart(id="payload", title="Payload declared by LOAD", unit="kg")
    wrist = Chart(id="wrist", title="Wrist mode", unit="0 path, 1 end angles, 2 held")
    found = [
        *read,
        *_levels(shown),
        _one(shown, "payload_mass", load, role="step"),
        *_by_kind(shown, _torque, _inertia, _gravity),
        _age(shown),
        _tool(shown),
        _one(shown, "wrist_mode", wrist, role="step"),
        *_seam(shown),
        _hand(shown),
    ]
    return _those_with_signals(found, shown)


def of_plan(shown: Shown) -> list[Chart]:
    """Return the charts of a planned motion, speeds and accelerations in per cent of their limits."""
    joints = _by_kind(shown, _joints, _planned_speed, _planned_acceleration)
    return _those_with_signals([*joints, _tool_speed(shown), _tool(shown)], shown)


def of_live(robot: Mapping[str, Any]) -> list[Chart]:
    """Return the charts of a run that still goes on: of what its frames hold (``robolang.view.frames``)."""
    # chosen without values, since there are none yet
    shown = Shown(robot=robot, signals={})
    tool = [
        _of_one_signal(chart, name, 1.0 / MM)
        for name, chart in (("tool_error", _TOOL_ERROR), ("tool_speed", _TOOL_SPEED))
    ]
    return [*tool, *_by_kind(shown, _joint_error, _torque_pct, _joints), _tool(shown)]


def _those_with_signals(found: Iterable[Chart | None], shown: Shown) -> list[Chart]:
    charts = (chart for chart in found if chart is not None)
    return [chart for chart in charts if chart.series and all(each.signal in shown.signals for each in chart.series)]


def _by_kind(shown: Shown, *makers: Callable[[Shown, Kind], Chart]) -> Iterator[Chart]:
    return (make(shown, kind) for make in makers for kind in kinds(shown.robot["axes"]))


def _tool_error(shown: Shown) -> Chart | None:
    return _one(shown, "tool_error", _TOOL_ERROR, 1.0 / MM)


def _tool_speed(shown: Shown) -> Chart | None:
    found = _one(shown, "tool_speed", _TOOL_SPEED, 1.0 / MM)
    if found is None or NAME not in shown.signals:
        return found
    return replace(found, series=(*found.series, Series(label="programmed", signal=NAME, scale=1.0 / MM, role="step")))


def _each(kind: Kind, signal: str, scale: float, role: Role = "value", label: str = "") -> tuple[Series, ...]:
    return tuple(
        Series(label=f"{name}{label}", signal=signal, column=k, scale=scale, role=role) for k, name in kind.axes
    )


def _joints(shown: Shown, kind: Kind) -> Chart:
    # a plan has set-points alone, and they are what moves its robot
    command = _each(kind, "q_cmd", 1.0 / kind.size, "command", " command") if "q_fb" in shown.signals else ()
    value = _each(kind, "q_fb" if command else "q_link", 1.0 / kind.size)
    return Chart(id=f"joints{kind.suffix}", title=f"Joint {kind.word}s", unit=kind.unit, series=value + command)


def _joint_error(shown: Shown, kind: Kind) -> Chart:
    scale = 1e3 / kind.size  # thousandths: an error is some hundredths of a degree at most
    # a long run has it as a signal of its own; else the page subtracts, which costs no bytes
    if "joint_error" in shown.signals:
        series = _each(kind, "joint_error", scale)
    else:
        series = tuple(
            Series(label=name, signal="q_cmd", column=k, scale=scale, minus=("q_link", k)) for k, name in kind.axes
        )
    unit = {"deg": "mdeg", "mm": "µm"}[kind.unit]
    return Chart(id=f"joint_error{kind.suffix}", title="Joint error, command − true", unit=unit, series=series)


def _speed(shown: Shown, kind: Kind) -> Chart:
    series = _each(kind, "dq_fb", 1.0 / kind.size)
    return Chart(id=f"joint_speed{kind.suffix}", title="Joint speed", unit=f"{kind.unit}/s", series=series)


def _torque_pct(shown: Shown, kind: Kind) -> Chart:
    limits = [(k, name, shown.limit(k, "torque")) for k, name in kind.axes]
    return Chart(
        id=f"torque_pct{kind.suffix}",
        title="Torque" if kind.unit == "deg" else "Force",
        unit="% of limit",
        series=tuple(
            Series(label=name, signal="tau_sat", column=k, scale=1.0 / (limit * PERCENT))
            for k, name, limit in limits
            if limit is not None
        ),
        band=_WHOLE,
    )


def _torque(shown: Shown, kind: Kind) -> Chart:
    # with the limits of all axes the curves of the weak ones would be flat
    high = [(k, name) for k, name in kind.axes if shown.high(k)]
    return Chart(
        id=f"torque{kind.suffix}",
        title="Torque" if kind.unit == "deg" else "Force",
        unit=kind.load,
        series=(
            *_each(kind, "tau_sat", 1.0),
            *(
                Series(label=f"{name} limit", signal="torque_limit", column=k, scale=sign, role="limit")
                for k, name in high
                for sign in (1.0, -1.0)
            ),
        ),
    )


def _inertia(shown: Shown, kind: Kind) -> Chart:
    series = _each(kind, "D", 1.0, "step")
    return Chart(id=f"inertia{kind.suffix}", title="Inertia in use", unit=kind.inertia, series=series)


def _gravity(shown: Shown, kind: Kind) -> Chart:
    series = _each(kind, "T", 1.0, "step")
    return Chart(id=f"gravity{kind.suffix}", title="Gravity load in use", unit=kind.load, series=series)


def _planned_speed(shown: Shown, kind: Kind) -> Chart:
    return _share(shown, kind, "joint_speed", "speed", "dq_cmd")


def _planned_acceleration(shown: Shown, kind: Kind) -> Chart:
    return _share(shown, kind, "joint_acc", "acceleration", "ddq_cmd")


def _share(shown: Shown, kind: Kind, name: str, limit: str, signal: str) -> Chart:
    limits = [(k, axis, shown.limit(k, limit)) for k, axis in kind.axes]
    series = tuple(
        Series(label=axis, signal=signal, column=k, scale=1.0 / (most * PERCENT))
        for k, axis, most in limits
        if most is not None
    )
    return Chart(id=f"{name}{kind.suffix}", title=f"Joint {limit}", unit="% of limit", series=series, band=_WHOLE)


def _age(shown: Shown) -> Chart | None:
    if not shown.says("D_age"):
        return None
    series = tuple(
        Series(label=str(axis["name"]), signal="D_age", column=k) for k, axis in enumerate(shown.robot["axes"])
    )
    return Chart(id="age", title="Age of inertia and gravity", unit="ms", series=series)


def _tool(shown: Shown) -> Chart:
    series = tuple(Series(label=name, signal="tool", column=k, scale=1.0 / MM) for k, name in enumerate("xyz"))
    return Chart(id="tool", title="Tool position", unit="mm", series=series)


def _levels(shown: Shown) -> list[Chart]:
    series = [Series(label=name, signal="levels", column=k, role="step") for k, name in enumerate(shown.levels)]
    # a lane has room for off and on; a number, such as the kind of a part, has an axis
    lanes = tuple(each for each in series if shown.switches("levels", each.column))
    numbers = [each for each in series if each not in lanes]
    return [
        Chart(id="io", title="Inputs and outputs", unit="", series=lanes, lanes=True),
        *(Chart(id=f"io_{each.column}", title=each.label, unit="", series=(each,)) for each in numbers),
    ]


def _seam(shown: Shown) -> list[Chart]:
    if not shown.says("seam_deviation"):
        return []
    moved = tuple(Series(label=name, signal="seam_deviation", column=k, scale=1.0 / MM) for k, name in enumerate("xyz"))
    turned = tuple(
        Series(label=name, signal="seam_deviation", column=3 + k, scale=1.0 / DEG)
        for k, name in enumerate(("rx", "ry", "rz"))
    )
    return [
        Chart(id="seam", title="Seam deviation", unit="mm", series=moved),
        Chart(id="seam_deg", title="Seam deviation, turned", unit="deg", series=turned),
    ]


def _hand(shown: Shown) -> Chart | None:
    if not shown.varies("fingers"):
        return None
    series = tuple(
        Series(label=name, signal="fingers", column=k, scale=1.0 / MM) for k, name in enumerate(("left", "right"))
    )
    return Chart(id="hand", title="Hand opening, pad to tool point", unit="mm", series=series)


def _one(shown: Shown, name: str, chart: Chart, scale: float = 1.0, role: Role = "value") -> Chart | None:
    """Return a chart with the only column of a signal; None where it says nothing."""
    return _of_one_signal(chart, name, scale, role) if shown.says(name) else None


def _of_one_signal(chart: Chart, name: str, scale: float, role: Role = "value") -> Chart:
    return replace(chart, series=(Series(label=chart.title, signal=name, scale=scale, role=role),))
