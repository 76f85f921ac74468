"""Pieces of an SVG text that all plots are made of: lines, words, and the numbers beside an axis."""

from collections.abc import Sequence
from html import escape

import numpy as np

from runtime.core.frames import Array


def rule(x1: float, y1: float, x2: float, y2: float, colour: str) -> str:
    """Return a thin straight line."""
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"/>'


def label(x: float, y: float, text: str, anchor: str) -> str:
    """Return a text beside, or in the middle of, its place."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def upright(y: float, text: str) -> str:
    """Return the label of a vertical axis, read from below."""
    return f'<text x="16" y="{y:.0f}" text-anchor="middle" transform="rotate(-90 16 {y:.0f})">{escape(text)}</text>'


def span(values: Sequence[Array]) -> tuple[float, float]:
    """Return the least and the largest of all finite values, a little apart where they are one."""
    found = np.concatenate(values)
    found = found[np.isfinite(found)]
    low, high = (float(found.min()), float(found.max())) if len(found) else (0.0, 1.0)
    # a level curve has no height, and the scale would divide by it
    return (low, high) if high - low > 1e-9 * max(1.0, abs(high)) else (low - 0.5, high + 0.5)


def ticks(bounds: tuple[float, float], count: float = 5.0) -> list[float]:
    """Return round values that span the bounds, about ``count`` of them."""
    low, high = bounds
    raw = (high - low) / count
    base = 10.0 ** np.floor(np.log10(raw))
    # the last step always fits, since base is the power of ten below raw
    size = float(next(step * base for step in (1.0, 2.0, 2.5, 5.0, 10.0) if step * base >= raw))
    first, last = int(np.floor(low / size + 1e-9)), int(np.ceil(high / size - 1e-9))
    return [round(k * size, 10) + 0.0 for k in range(first, last + 1)]
