"""Line plots as small SVG texts: axes, grid, named curves. No library, same input, same bytes."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Literal

import numpy as np

from robolang.execution import svg
from runtime.core.frames import Array

WIDTH, HEIGHT = 640, 360
LEFT, RIGHT, TOP, BOTTOM = 62, 16, 34, 46
COLOURS = ("#0b6bcb", "#d1481c", "#2b8a3e", "#8a3ea8", "#b58900", "#555555")
# five steps of the colour map viridis: its brightness rises evenly, so it is read without colours as well
SHADES = ("#440154", "#3b528b", "#21918c", "#5ec962", "#fde725")
_POINTS = 400
_MAP_HEIGHT, _MAP_TOP, _MAP_RIGHT, _BAR = 420, 52, 104, 16  # of a map: height, margins beside its scale, its width
_BANDS = 10.0
_ROW, _LETTER = 18, 6.6  # height of a row of names, width of a letter in it


Corner = Literal["top", "bottom", "above"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Labels:
    """The ``title`` of a plot and what its axes ``x`` and ``y`` show, with units."""

    title: str
    x: str
    y: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A named line: ``x`` and ``y`` (N,); ``dashed`` to keep lines that lie on one another apart.

    ``colour``: of COLOURS; by default each curve has its own.
    """

    name: str
    x: Array
    y: Array
    dashed: bool = False
    colour: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A dashed line across the plot with its name: upright at ``x``, or level at ``y``.

    The name of an upright one stands above the plot, on that ``side`` of the line, that of a level one towards zero.
    """

    name: str
    x: float | None = None
    y: float | None = None
    side: Literal["left", "right"] = "right"


@dataclass(frozen=True, slots=True, kw_only=True)
class Dots:
    """Dots at ``x`` and ``y`` (N,), the k-th in the colour of the k-th curve, under one name."""

    name: str
    x: Array
    y: Array


def as_svg(
    labels: Labels,
    curves: Sequence[Curve],
    level: float | None = None,
    corner: Corner = "bottom",
    marks: Sequence[Mark] = (),
    dots: Dots | None = None,
) -> str:
    """Return an SVG of the curves; ``level`` draws a thin horizontal line, the set value.

    The names of the curves stand in the right-hand ``corner``, or ``above`` the plot, where no curve runs through them.
    """
    xs, ys = svg.ticks(svg.span([curve.x for curve in curves])), svg.ticks(_heights(curves, level, marks, dots))
    view = _View(xs[0], xs[-1], ys[0], ys[-1])
    keys, rows = _keys_above(curves, dots) if corner == "above" else ([], 0)
    # rows of names and the name of an upright mark need room over the plot, which goes down by as much
    down = _ROW * rows + (14 if any(mark.x is not None for mark in marks) else 0)
    plot = [
        *_grid(view, xs, ys),
        *_level(view, level),
        svg.label((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, labels.x, "middle"),
        svg.upright((TOP + HEIGHT - BOTTOM) / 2, labels.y),
        *(part for mark in marks for part in _mark(view, mark)),
        *_curves(view, curves, corner),
        *_dots(view, dots, curves),
    ]
    moved = [f'<g transform="translate(0 {down})">', *plot, "</g>"] if down else plot
    return "\n".join([*_head(labels.title, HEIGHT + down), *keys, *moved, "</svg>", ""])


def as_map_svg(
    labels: Labels,
    scale_label: str,
    x: Array,
    y: Array,
    values: Array,
    every: float | None = None,
) -> str:
    """Return an SVG of values (len(y), len(x)) over a plane, as bands of colour beside their scale.

    ``x`` and ``y`` rise, at least two points each; between the points of a row values are taken as linear. The
    smallest and the largest are marked where the values differ. What is not finite stays blank. ``every``: distance of
    the ticks on both axes.
    """
    view = _MapView(x, y)
    edges = _bands(values)
    parts = [
        *_head(labels.title, _MAP_HEIGHT),
        *(_band(view, values, edge, colour) for edge, colour in zip(edges[:-1], _shades(len(edges) - 1), strict=True)),
        *_map_axes(view, labels, every),
        *_scale(edges, scale_label),
    ]
    # this also keeps nanargmin from values of which none is finite, which it refuses
    if len(edges) > 2:
        parts += _extremes(view, x, y, values)
    return "\n".join([*parts, "</svg>", ""])


def as_html(title: str, drawing: str) -> str:
    """Return one page with a plot in it."""
    return f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>{escape(title)}</title>\n{drawing}</html>\n'


def stacked(svgs: Sequence[str]) -> str:
    """Return one SVG with others of ``as_svg`` or ``as_map_svg`` below one another."""
    parts, down = [], 0
    for drawing in svgs:
        height = int(drawing.partition(f'viewBox="0 0 {WIDTH} ')[2].partition('"')[0])
        parts.append(drawing.replace("<svg ", f'<svg y="{down}" width="{WIDTH}" height="{height}" ', 1))
        down += height
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {down}">\n{"".join(parts)}</svg>\n'


class _View:
    """Maps values to the picture."""

    def __init__(self, x0: float, x1: float, y0: float, y1: float) -> None:
        self._x0, self._y0 = x0, y0
        self._sx = (WIDTH - LEFT - RIGHT) / (x1 - x0)
        self._sy = (HEIGHT - TOP - BOTTOM) / (y1 - y0)

    def x(self, value: float) -> float:
        return LEFT + (value - self._x0) * self._sx

    def y(self, value: float) -> float:
        return HEIGHT - BOTTOM - (value - self._y0) * self._sy


def _head(title: str, height: int) -> list[str]:
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" '
        f'font-size="12" fill="#222"><rect width="{WIDTH}" height="{height}" fill="#fff"/>',
        f'<text x="{LEFT}" y="20" font-size="14">{escape(title)}</text>',
    ]


def _heights(
    curves: Sequence[Curve], level: float | None, marks: Sequence[Mark], dots: Dots | None
) -> tuple[float, float]:
    """Return the range of everything that has a height in the plot; zero is always in it."""
    levels = [mark.y for mark in marks if mark.y is not None]
    drawn = [*(curve.y for curve in curves), np.array([0.0, level or 0.0, *levels])]
    return svg.span(drawn if dots is None else [*drawn, dots.y])


def _grid(view: _View, xs: Sequence[float], ys: Sequence[float]) -> list[str]:
    """Return the grey lines of the grid and the numbers at their ends."""
    parts = []
    for x in xs:
        parts += [
            svg.rule(view.x(x), TOP, view.x(x), HEIGHT - BOTTOM, "#e4e4e4"),
            svg.label(view.x(x), HEIGHT - 28, f"{x:g}", "middle"),
        ]
    for y in ys:
        parts += [
            svg.rule(LEFT, view.y(y), WIDTH - RIGHT, view.y(y), "#e4e4e4"),
            svg.label(LEFT - 6, view.y(y) + 4, f"{y:g}", "end"),
        ]
    return parts


def _level(view: _View, level: float | None) -> list[str]:
    return [] if level is None else [svg.rule(LEFT, view.y(level), WIDTH - RIGHT, view.y(level), "#999")]


def _curves(view: _View, curves: Sequence[Curve], corner: Corner) -> list[str]:
    """Return the lines of the curves, each with its name where the names stand in a corner."""
    parts = []
    for index, curve in enumerate(curves):
        parts.append(_polyline(view, curve, index))
        if corner != "above":
            parts += _key(WIDTH - RIGHT - 270, _key_row(corner, index, len(curves)), curve, index)
    return parts


def _polyline(view: _View, curve: Curve, index: int) -> str:
    every = max(1, len(curve.x) // _POINTS)
    points = " ".join(
        f"{view.x(x):.1f},{view.y(y):.1f}" for x, y in zip(curve.x[::every], curve.y[::every], strict=True)
    )
    colour, dash = _stroke(curve, index)
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>'


def _key(x: float, y: float, item: Curve | Dots, index: int) -> list[str]:
    """Return a piece of a curve's line, or a dot, followed by its name."""
    name = svg.label(x + 32, y + 4, item.name, "start")
    if isinstance(item, Dots):
        return [_dot(x + 13, y, "#666"), name]
    colour, dash = _stroke(item, index)
    return [f'<line x1="{x}" y1="{y}" x2="{x + 26}" y2="{y}" stroke="{colour}" stroke-width="2"{dash}/>', name]


def _key_row(corner: Corner, index: int, count: int) -> int:
    """Return the height of a name in its corner; the last one stands lowest in both corners."""
    return HEIGHT - BOTTOM - 14 - 17 * (count - 1 - index) if corner == "bottom" else TOP + 14 + 17 * index


def _keys_above(curves: Sequence[Curve], dots: Dots | None) -> tuple[list[str], int]:
    """Return names in rows under the title, and the number of rows: solid curves and the dots, then dashed curves."""
    solid = [(k, curve) for k, curve in enumerate(curves) if not curve.dashed]
    dashed = [(k, curve) for k, curve in enumerate(curves) if curve.dashed]
    keyed: list[tuple[int, Curve | Dots]] = [*solid, *([(0, dots)] if dots else []), *dashed]
    first_dashed = len(keyed) - len(dashed)
    parts: list[str] = []
    x, row = LEFT, 1
    for place, (index, item) in enumerate(keyed):
        width = round(32 + _LETTER * len(item.name))
        if x > LEFT and (x + width > WIDTH - RIGHT or place == first_dashed):
            x, row = LEFT, row + 1
        parts += _key(x, 18 + _ROW * row, item, index)
        x += width + 16
    return parts, row


def _dots(view: _View, dots: Dots | None, curves: Sequence[Curve]) -> list[str]:
    if dots is None:
        return []
    places = zip(dots.x, dots.y, strict=True)
    return [_dot(view.x(x), view.y(y), _stroke(curves[k], k)[0]) for k, (x, y) in enumerate(places)]


def _stroke(curve: Curve, index: int) -> tuple[str, str]:
    colour = COLOURS[(index if curve.colour is None else curve.colour) % len(COLOURS)]
    return colour, ' stroke-dasharray="6 5"' if curve.dashed else ""


def _mark(view: _View, mark: Mark) -> list[str]:
    dash = ' stroke="#666" stroke-dasharray="3 3"/>'
    if mark.x is not None:
        x = view.x(mark.x)
        left = mark.side == "left"
        return [
            f'<line x1="{x:.1f}" y1="{TOP - 12}" x2="{x:.1f}" y2="{HEIGHT - BOTTOM}"{dash}',
            svg.label(x - 4 if left else x + 4, TOP - 4, mark.name, "end" if left else "start"),
        ]
    y = view.y(mark.y or 0.0)
    towards_zero = 13 if (mark.y or 0.0) > 0.0 else -4
    return [
        f'<line x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}"{dash}',
        svg.label(LEFT + 6, y + towards_zero, mark.name, "start"),
    ]


class _MapView:
    """Maps values to the picture of a map; every row of points has a stripe that reaches half way to the next."""

    def __init__(self, x: Array, y: Array) -> None:
        self.x_bounds, self.y_bounds = (float(x[0]), float(x[-1])), (float(y[0]), float(y[-1]))
        self.columns = x
        self.rows = [f"{self.y(edge):.1f}" for edge in (y[0], *(y[1:] + y[:-1]) / 2.0, y[-1])]

    def x(self, value: float) -> float:
        low, high = self.x_bounds
        return LEFT + (value - low) / (high - low) * (WIDTH - LEFT - _MAP_RIGHT)

    def y(self, value: float) -> float:
        low, high = self.y_bounds
        return _MAP_HEIGHT - BOTTOM - (value - low) / (high - low) * (_MAP_HEIGHT - _MAP_TOP - BOTTOM)


def _bands(values: Array) -> list[float]:
    """Return round edges of about ten bands that span the values; two equal ones where the values are all one."""
    found = values[np.isfinite(values)]
    low, high = (float(found.min()), float(found.max())) if found.size else (0.0, 0.0)
    if not high - low > 1e-9 * max(abs(low), abs(high)):
        return [low, low]
    raw = (high - low) / _BANDS
    base = 10.0 ** np.floor(np.log10(raw))
    size = float(next(step * base for step in (1.0, 2.0, 2.5, 5.0, 10.0) if step * base >= raw * (1.0 - 1e-9)))
    first, last = int(np.floor(low / size + 1e-9)), int(np.ceil(high / size - 1e-9))
    return [float(f"{k * size:.10g}") + 0.0 for k in range(first, last + 1)]


def _band(view: _MapView, values: Array, edge: float, colour: str) -> str:
    """Return everything from ``edge`` upward in one colour; the next band is painted over it."""
    level = edge - 1e-9 * abs(edge)  # rounding can leave the smallest value a little below the first edge
    runs = []
    for row, above in enumerate(values >= level):
        # with nothing before and after a row, changes come in pairs: where a run begins and where it ends
        change = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]))).tolist()
        for first, end in zip(change[::2], change[1::2], strict=True):
            left, right = (f"{view.x(_crossing(view.columns, values[row], k, level)):.1f}" for k in (first, end))
            runs.append(f"M{left} {view.rows[row]}H{right}V{view.rows[row + 1]}H{left}Z")
    return f'<path d="{"".join(runs)}" fill="{colour}" shape-rendering="crispEdges"/>'


def _crossing(x: Array, values: Array, k: int, level: float) -> float:
    """Return where a row passes ``level`` between points k-1 and k; half way beside a gap, the end beyond the last."""
    if k in (0, len(x)):
        return float(x[0] if k == 0 else x[-1])
    share = (level - values[k - 1]) / (values[k] - values[k - 1])
    return float(x[k - 1] + (share if np.isfinite(share) else 0.5) * (x[k] - x[k - 1]))


def _shades(count: int) -> list[str]:
    """Return colours from dark to light, as many as there are bands."""
    anchors = np.array([[int(shade[k : k + 2], 16) for k in (1, 3, 5)] for shade in SHADES], dtype=np.float64)
    at = np.linspace(0.0, len(SHADES) - 1.0, count) if count > 1 else np.array([(len(SHADES) - 1.0) / 2.0])
    mixed = [np.interp(at, np.arange(len(SHADES)), anchors[:, k]) for k in range(3)]
    return ["#" + "".join(f"{round(float(part[k])):02x}" for part in mixed) for k in range(count)]


def _map_axes(view: _MapView, labels: Labels, every: float | None) -> list[str]:
    bottom, middle = _MAP_HEIGHT - BOTTOM, (_MAP_TOP + _MAP_HEIGHT - BOTTOM) / 2
    parts = []
    for tick in _inner_ticks(view.x_bounds, every):
        parts += [
            svg.rule(view.x(tick), bottom, view.x(tick), bottom + 5, "#666"),
            svg.label(view.x(tick), bottom + 18, f"{tick:g}", "middle"),
        ]
    for tick in _inner_ticks(view.y_bounds, every):
        parts += [
            svg.rule(LEFT - 5, view.y(tick), LEFT, view.y(tick), "#666"),
            svg.label(LEFT - 8, view.y(tick) + 4, f"{tick:g}", "end"),
        ]
    return [
        *parts,
        svg.label((LEFT + WIDTH - _MAP_RIGHT) / 2, _MAP_HEIGHT - 8, labels.x, "middle"),
        svg.upright(middle, labels.y),
    ]


def _inner_ticks(bounds: tuple[float, float], every: float | None) -> list[float]:
    low, high = bounds
    if every is None:
        return [tick for tick in svg.ticks(bounds) if low <= tick <= high]
    # ends of a range given in degrees and kept in radians come back a little short
    first, last = int(np.ceil(low / every - 1e-9)), int(np.floor(high / every + 1e-9))
    return [k * every + 0.0 for k in range(first, last + 1)]


def _scale(edges: Sequence[float], label: str) -> list[str]:
    """Return the column of colours beside the map, each edge with its value, and what the values are above it."""
    x, height = WIDTH - _MAP_RIGHT + 22, _MAP_HEIGHT - _MAP_TOP - BOTTOM
    step = height / (len(edges) - 1)
    bottom = _MAP_HEIGHT - BOTTOM
    parts = [svg.label(x, _MAP_TOP - 10, label, "start")]
    for k, shade in enumerate(_shades(len(edges) - 1)):
        parts.append(
            f'<rect x="{x}" y="{bottom - (k + 1) * step:.1f}" width="{_BAR}" height="{step:.1f}" '
            f'fill="{shade}" shape-rendering="crispEdges"/>'
        )
    if len(edges) == 2 and edges[0] == edges[1]:
        return [*parts, svg.label(x + _BAR + 6, bottom - height / 2 + 4, f"{edges[0]:.4g}", "start")]
    return [
        *parts,
        *(svg.label(x + _BAR + 6, bottom - k * step + 4, f"{edge:g}", "start") for k, edge in enumerate(edges)),
    ]


def _extremes(view: _MapView, x: Array, y: Array, values: Array) -> list[str]:
    """Return a white dot at the smallest value and a black one at the largest, and their names above the map."""
    parts = []
    for at, name, fill, edge, index in (
        (LEFT + 5, "smallest", "#fff", "#222", np.nanargmin(values)),
        (LEFT + 165, "largest", "#222", "#fff", np.nanargmax(values)),
    ):
        row, column = divmod(int(index), len(x))
        look = f'r="5" fill="{fill}" stroke="{edge}" stroke-width="1.5"/>'
        parts += [
            f'<circle cx="{view.x(float(x[column])):.1f}" cy="{view.y(float(y[row])):.1f}" {look}',
            f'<circle cx="{at}" cy="{_MAP_TOP - 14}" {look}',
            svg.label(at + 12, _MAP_TOP - 10, f"{name} {values[row, column]:.4g}", "start"),
        ]
    return parts


def _dot(x: float, y: float, colour: str) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}" stroke="#fff"/>'
