"""Short ways to lint a text in this process and to say what was found where."""

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Source
from robolang.lint.engine import Checked, lint
from robolang.lint.selection import Layer, Selection, selector
from tests.robolang.helpers import cell_with

POINTS = ("P1", "P2", "P3", "P4", "P5")


def found(text: str, **options) -> tuple[Diagnostic, ...]:
    """The findings of a text with P1 to P5 taught."""
    return lint(Source("pick.rbl", text), cell_with(points=POINTS), **options)


def places(text: str, **options) -> list[tuple[str, int, int]]:
    """Code, line and column of each finding."""
    source = Source("pick.rbl", text)
    spots = ((item.code, source.place(item.span.start)) for item in found(text, **options))
    return [(code, spot.line, spot.column) for code, spot in spots]


def marked(text: str, code: str) -> list[str]:
    """The texts that the findings of a code cover."""
    return [text[item.span.start : item.span.end] for item in found(text) if item.code == code]


def checked(text: str, path: str = "cell/pick.rbl", faults=()) -> Checked:
    return Checked(source=Source(path, text), diagnostics=found(text), faults=tuple(faults))


def layer(select=None, extend=(), ignore=()) -> Layer:
    """A layer from selectors as a user writes them."""

    def known(words):
        chosen = tuple(selector(word) for word in words)
        assert None not in chosen, words
        return chosen

    return Layer(select=None if select is None else known(select), extend=known(extend), ignore=known(ignore))


def selection(*layers: Layer) -> Selection:
    return Selection(layers=layers)
