"""Signals of a log as one drawing: panels below one another over one time axis, the running statements marked.

Of many rows the least and the largest in each column of the picture are drawn, so that no peak is lost. The same log
gives the same bytes.
"""

import re
from dataclasses import dataclass
from html import escape

import numpy as np

from robolang.core.diagnostics import safe
from robolang.execution import svg
from robolang.execution.plot import COLOURS
from robolang.view.thinning import least_and_largest
from runtime.core.frames import Array

WIDTH, LEFT, RIGHT = 960, 76, 140
TOP, STRIP, BOTTOM = 40, 24, 40
PANEL, GAP = 180, 24
_TIMES = 12.0
"""About how many times stand below the plot."""
_KEY_ROW = 16
_LETTER = 6.7
"""Width of a letter, px; the names in the strip of statements are left out where they have no room."""
COLUMNS = WIDTH - LEFT - RIGHT
"""Columns of the picture."""
_NONE = re.compile("[\ufffe\uffff]")  # XML 1.0, production 2
_NARROWEST = 0.2
"""Statements that are narrower, px, are left out of the strip."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A named curve: ``x`` and ``y`` (N,), ``x`` rising in equal steps; ``dashed`` to be seen on top of another one."""

    name: str
    x: Array
    y: Array
    dashed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalPanel:
    """Curves of one unit over the axis of the plot."""

    label: str
    lines: tuple[Line, ...]

    @property
    def height(self) -> int:
        """How high it is drawn: its names need room beside it."""
        return max(PANEL, _KEY_ROW * (len(self.lines) + 1))


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A statement that runs from ``begins`` to ``ends`` on the axis: its number for the strip, and its ``text``."""

    begins: float
    ends: float
    number: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalPlot:
    """What is drawn, from ``first`` to ``last`` on an ``axis``; ``strip``: what the numbers of the blocks are."""

    title: str
    panels: tuple[SignalPanel, ...]
    blocks: tuple[Block, ...]
    first: float
    last: float
    strip: str = "line"
    axis: str = "time, s"

    def as_svg(self) -> str:
        """Return the drawing."""
        # shades first: everything else is drawn over them
        bottom = TOP + STRIP + sum(panel.height + GAP for panel in self.panels) - GAP
        height = bottom + BOTTOM
        parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" '
            f'height="{height}" font-family="sans-serif" font-size="12" fill="#222">'
            f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>',
            f'<text x="{LEFT}" y="24" font-size="15">{_words(self.title)}</text>',
            *self._strip(bottom),
            *self._times(bottom),
        ]
        down = TOP + STRIP
        for panel in self.panels:
            parts += self._panel(panel, down)
            down += panel.height + GAP
        return "\n".join([*parts, "</svg>", ""])

    def _x(self, time: float) -> float:
        return LEFT + (time - self.first) / (self.last - self.first) * COLUMNS

    def _strip(self, bottom: int) -> list[str]:
        parts = []
        for k, block in enumerate(self.blocks):
            left, right = self._x(max(block.begins, self.first)), self._x(min(block.ends, self.last))
            # a loop may run a statement in every cycle of half an hour
            if right - left >= _NARROWEST:
                parts += self._block(block, (left, right), bottom, shaded=k % 2 == 0)
        return parts

    @staticmethod
    def _block(block: Block, ends: tuple[float, float], bottom: int, *, shaded: bool) -> list[str]:
        left, right = ends
        fill = "#eef2f7" if shaded else "#fff"
        label = f"{block.number}: {block.text}" if block.text else block.number
        parts = [
            f'<rect x="{left:.1f}" y="{TOP}" width="{right - left:.1f}" height="{bottom - TOP}" fill="{fill}">'
            f"<title>{_words(label)}</title></rect>"
        ]
        if right - left >= _LETTER * len(block.number) + 4:
            parts.append(svg.label((left + right) / 2, TOP + 13, _plain(block.number), "middle"))
        return parts

    def _times(self, bottom: int) -> list[str]:
        parts = [svg.label(LEFT - 8, TOP + 13, self.strip, "end")] if self.blocks else []
        rounding = 1e-9 * (self.last - self.first)
        for tick in svg.ticks((self.first, self.last), _TIMES):
            if self.first - rounding <= tick <= self.last + rounding:
                x = self._x(tick)
                parts += [
                    svg.rule(x, TOP + STRIP, x, bottom, "#dcdcdc"),
                    svg.label(x, bottom + 16, f"{tick:.10g}", "middle"),
                ]
        return [*parts, svg.label(LEFT + COLUMNS / 2, bottom + 33, self.axis, "middle")]

    def _panel(self, panel: SignalPanel, top: int) -> list[str]:
        levels = svg.ticks(svg.span([line.y for line in panel.lines]))
        bottom = top + panel.height
        scale = panel.height / (levels[-1] - levels[0])
        parts = []
        for level in levels:
            y = bottom - (level - levels[0]) * scale
            parts += [
                svg.rule(LEFT, y, LEFT + COLUMNS, y, "#dcdcdc"),
                svg.label(LEFT - 6, y + 4, f"{level:.10g}", "end"),
            ]
        parts.append(svg.upright((top + bottom) / 2, _plain(panel.label)))
        for k, line in enumerate(panel.lines):
            look = f'stroke="{COLOURS[k % len(COLOURS)]}" stroke-width="1.5"'
            look += ' stroke-dasharray="5 3"' if line.dashed or k >= len(COLOURS) else ""
            path = self._path(line, bottom, levels[0], scale)
            x, y = LEFT + COLUMNS + 10, top + 12 + _KEY_ROW * k
            parts += [
                f'<path d="{path}" fill="none" stroke-linejoin="round" {look}/>',
                f'<path d="M{x} {y}h18" {look}/>',
                svg.label(x + 23, y + 4, _plain(line.name), "start"),
            ]
        return parts

    def _path(self, line: Line, bottom: int, lowest: float, scale: float) -> str:
        """Return the curve as a path, which is broken where a value is not finite."""
        x, y = _thinned(line)
        known = np.isfinite(y)
        columns, rows = self._x_of(x), bottom - (np.where(known, y, lowest) - lowest) * scale
        parts = []
        pen = "M"
        for px, py, there in zip(columns.tolist(), rows.tolist(), known.tolist(), strict=True):
            if there:
                parts.append(f"{pen}{px:.1f} {py:.1f}")
            pen = "L" if there else "M"
        # a single point is a dot: a path without length is not drawn
        return "".join([*parts, "h0.1"]) if len(parts) == 1 else "".join(parts)

    def _x_of(self, times: Array) -> Array:
        return LEFT + (times - self.first) / (self.last - self.first) * COLUMNS


def _thinned(line: Line) -> tuple[Array, Array]:
    """Return at most two points for each column of the picture."""
    # rounded up: a column of the picture has a bin of its own or a part of one
    size = -(-len(line.x) // COLUMNS)
    if size <= 2:
        return line.x, line.y
    bins = -(-len(line.x) // size)
    x = line.x[0] + (line.x[1] - line.x[0]) * size / 2 * np.arange(2 * bins)
    return x, least_and_largest(line.y, bins, size)


def _plain(text: str) -> str:
    """Return a text without what an SVG cannot hold: control characters, halves of characters, no characters."""
    return _NONE.sub("\ufffd", safe(text)).encode("utf-8", "replace").decode("utf-8")


def _words(text: str) -> str:
    return escape(_plain(text))
