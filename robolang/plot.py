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


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A named line: ``x`` and ``y`` (N,); ``dashed`` to tell lines that lie on one another apart."""

    name: str
    x: Array
    y: Array
    dashed: bool = False


def as_svg(title: str, x_label: str, y_label: str, curves: Sequence[Curve], level: float | None = None,
           corner: Literal["top", "bottom"] = "bottom") -> str:  # fmt: skip
    """Return an SVG of the curves; ``level`` draws a thin horizontal line, the value that is wanted.

    The names of the curves stand in the right-hand ``corner``.
    """
    xs, ys = (
        _ticks(_range([c.x for c in curves])),
        _ticks(_range([*(c.y for c in curves), np.array([0.0, level or 0.0])])),
    )
    view = _View(xs[0], xs[-1], ys[0], ys[-1])
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="12" fill="#222"><rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
        f'<text x="{LEFT}" y="20" font-size="14">{escape(title)}</text>',
    ]
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
    for index, curve in enumerate(curves):
        parts += _curve(view, curve, index, len(curves) if corner == "bottom" else 0)
    return "\n".join([*parts, "</svg>", ""])


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


def _curve(view: _View, curve: Curve, index: int, count: int) -> list[str]:
    every = max(1, len(curve.x) // _POINTS)
    points = " ".join(
        f"{view.x(x):.1f},{view.y(y):.1f}" for x, y in zip(curve.x[::every], curve.y[::every], strict=True)
    )
    colour = COLOURS[index % len(COLOURS)]
    dash = ' stroke-dasharray="6 5"' if curve.dashed else ""
    y = HEIGHT - BOTTOM - 14 - 17 * (count - 1 - index) if count else TOP + 14 + 17 * index
    x = WIDTH - RIGHT - 270
    return [
        f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>',
        f'<line x1="{x}" y1="{y}" x2="{x + 26}" y2="{y}" stroke="{colour}" stroke-width="2"{dash}/>',
        _text(x + 32, y + 4, curve.name, "start"),
    ]


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
