"""Line plots as small SVG texts: axes, grid, named curves. No library, same input, same bytes."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Literal

import numpy as np

from runtime.frames import Array

WIDTH, HEIGHT = 640, 360
LEFT, RIGHT, TOP, BOTTOM = 62, 16, 34, 46
COLOURS = ("#0b6bcb", "#d1481c", "#2b8a3e", "#8a3ea8", "#b58900", "#555555")
_POINTS = 400
_ROW, _LETTER = 18, 6.6  # height of a row of names, width of a letter in it


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A named line: ``x`` and ``y`` (N,); ``dashed`` to tell lines that lie on one another apart.

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


def as_svg(title: str, x_label: str, y_label: str, curves: Sequence[Curve], level: float | None = None,
           corner: Literal["top", "bottom", "above"] = "bottom", marks: Sequence[Mark] = (),
           dots: Dots | None = None) -> str:  # fmt: skip
    """Return an SVG of the curves; ``level`` draws a thin horizontal line, the value that is wanted.

    The names of the curves stand in the right-hand ``corner``, or ``above`` the plot, where no curve runs through them.
    """
    levels = [mark.y for mark in marks if mark.y is not None]
    xs, ys = (
        _ticks(_range([c.x for c in curves])),
        _ticks(_range([*(c.y for c in curves), np.array([0.0, level or 0.0, *levels]), *([dots.y] if dots else [])])),
    )
    view = _View(xs[0], xs[-1], ys[0], ys[-1])
    keys, rows = _keys_above(curves, dots) if corner == "above" else ([], 0)
    down = _ROW * rows + (14 if any(mark.x is not None for mark in marks) else 0)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT + down}" font-family="sans-serif" '
        f'font-size="12" fill="#222"><rect width="{WIDTH}" height="{HEIGHT + down}" fill="#fff"/>',
        f'<text x="{LEFT}" y="20" font-size="14">{escape(title)}</text>',
        *keys,
    ]
    if down:
        parts.append(f'<g transform="translate(0 {down})">')
    for x in xs:
        parts += [
            _line(view.x(x), TOP, view.x(x), HEIGHT - BOTTOM, "#e4e4e4"),
            _text(view.x(x), HEIGHT - 28, f"{x:g}", "middle"),
        ]
    for y in ys:
        parts += [
            _line(LEFT, view.y(y), WIDTH - RIGHT, view.y(y), "#e4e4e4"),
            _text(LEFT - 6, view.y(y) + 4, f"{y:g}", "end"),
        ]
    if level is not None:
        parts.append(_line(LEFT, view.y(level), WIDTH - RIGHT, view.y(level), "#999"))
    parts += [
        _text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_label, "middle"),
        f'<text x="16" y="{(TOP + HEIGHT - BOTTOM) / 2:.0f}" text-anchor="middle" '
        f'transform="rotate(-90 16 {(TOP + HEIGHT - BOTTOM) / 2:.0f})">{escape(y_label)}</text>',
    ]
    for mark in marks:
        parts += _mark(view, mark)
    for index, curve in enumerate(curves):
        parts.append(_polyline(view, curve, index))
        if corner != "above":
            row = HEIGHT - BOTTOM - 14 - 17 * (len(curves) - 1 - index) if corner == "bottom" else TOP + 14 + 17 * index
            parts += _key(WIDTH - RIGHT - 270, row, curve, index)
    if dots is not None:
        parts += [_dot(view.x(x), view.y(y), _stroke(curves[k], k)[0])
                  for k, (x, y) in enumerate(zip(dots.x, dots.y, strict=True))]  # fmt: skip
    return "\n".join([*parts, *(["</g>"] if down else []), "</svg>", ""])


def as_html(title: str, svg: str) -> str:
    """Return one page with a plot in it."""
    return f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>{escape(title)}</title>\n{svg}</html>\n'


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


def _polyline(view: _View, curve: Curve, index: int) -> str:
    every = max(1, len(curve.x) // _POINTS)
    points = " ".join(
        f"{view.x(x):.1f},{view.y(y):.1f}" for x, y in zip(curve.x[::every], curve.y[::every], strict=True)
    )
    colour, dash = _stroke(curve, index)
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>'


def _key(x: float, y: float, curve: Curve, index: int) -> list[str]:
    """Return a piece of a curve's line with its name behind it."""
    colour, dash = _stroke(curve, index)
    return [
        f'<line x1="{x}" y1="{y}" x2="{x + 26}" y2="{y}" stroke="{colour}" stroke-width="2"{dash}/>',
        _text(x + 32, y + 4, curve.name, "start"),
    ]


def _keys_above(curves: Sequence[Curve], dots: Dots | None) -> tuple[list[str], int]:
    """Return names in rows under the title, and the number of rows: solid curves and the dots, then dashed curves."""
    solid: list[tuple[int, Curve | Dots]] = [(k, curve) for k, curve in enumerate(curves) if not curve.dashed]
    dashed = [(k, curve) for k, curve in enumerate(curves) if curve.dashed]
    parts: list[str] = []
    x, row = LEFT, 1
    for index, item in [*solid, *([(0, dots)] if dots else []), *dashed]:
        width = round(32 + _LETTER * len(item.name))
        if x > LEFT and (x + width > WIDTH - RIGHT or (dashed and index == dashed[0][0])):
            x, row = LEFT, row + 1
        y = 18 + _ROW * row
        if isinstance(item, Curve):
            parts += _key(x, y, item, index)
        else:
            parts += [_dot(x + 13, y, "#666"), _text(x + 32, y + 4, item.name, "start")]
        x += width + 16
    return parts, row


def _stroke(curve: Curve, index: int) -> tuple[str, str]:
    colour = COLOURS[(index if curve.colour is None else curve.colour) % len(COLOURS)]
    return colour, ' stroke-dasharray="6 5"' if curve.dashed else ""


def _mark(view: _View, mark: Mark) -> list[str]:
    dash = ' stroke="#666" stroke-dasharray="3 3"/>'
    if mark.x is not None:
        x = view.x(mark.x)
        left = mark.side == "left"
        return [f'<line x1="{x:.1f}" y1="{TOP - 12}" x2="{x:.1f}" y2="{HEIGHT - BOTTOM}"{dash}',
                _text(x - 4 if left else x + 4, TOP - 4, mark.name, "end" if left else "start")]  # fmt: skip
    y = view.y(mark.y or 0.0)
    towards_zero = 13 if (mark.y or 0.0) > 0.0 else -4
    return [f'<line x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}"{dash}',
            _text(LEFT + 6, y + towards_zero, mark.name, "start")]  # fmt: skip


def _dot(x: float, y: float, colour: str) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}" stroke="#fff"/>'


def _line(x1: float, y1: float, x2: float, y2: float, colour: str) -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"/>'


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _range(values: Sequence[Array]) -> tuple[float, float]:
    found = np.concatenate(values)
    found = found[np.isfinite(found)]
    low, high = (float(found.min()), float(found.max())) if len(found) else (0.0, 1.0)
    return (low, high) if high - low > 1e-9 * max(1.0, abs(high)) else (low - 0.5, high + 0.5)


def _ticks(bounds: tuple[float, float]) -> list[float]:
    """Return round values that span the bounds, about five of them."""
    low, high = bounds
    raw = (high - low) / 5.0
    base = 10.0 ** np.floor(np.log10(raw))
    size = float(next(step * base for step in (1.0, 2.0, 2.5, 5.0, 10.0) if step * base >= raw))
    first, last = int(np.floor(low / size + 1e-9)), int(np.ceil(high / size - 1e-9))
    return [round(k * size, 10) + 0.0 for k in range(first, last + 1)]
