"""An SVG as PNG, by the library of the extra ``[plot]`` and the fonts of the machine."""

from runtime.core.faults import Fault

ZOOM = 2.0
"""Pixels for each unit of the drawing, so that a line of text is sharp on a screen of many dots."""
_BLANK = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 24"><rect width="40" height="24" fill="#fff"/>{}</svg>'
)
_WORD = '<text x="2" y="18" font-family="sans-serif" font-size="14">J1</text>'


_FAMILIES = ("Arial", "DejaVu Sans", "Liberation Sans", "Noto Sans", "Helvetica")
"""Families that stand for ``sans-serif``, the first that is installed: the library itself knows the first alone."""


def check_png() -> None:
    """Refuse where no PNG could be made: ``Fault`` RBL839 without the library, or without any font."""
    _family()


def as_png(drawing: str) -> bytes:
    """Return an SVG as PNG; ``Fault`` RBL839."""
    return _drawn(drawing, _family())


def _family() -> str:
    """Return the family for text; ``Fault`` RBL839 where none of them is installed.

    The library leaves out text that it has no font for, without a word; so a text is drawn here and compared.
    """
    blank, word = _BLANK.format(""), _BLANK.format(_WORD)
    for family in _FAMILIES:
        # compared as bytes: the same picture is the same file
        if _drawn(word, family) != _drawn(blank, family):
            return family
    raise Fault(
        "RBL839",
        "no font is installed, so a .png would have no text",
        "install one: on Debian and Ubuntu 'apt-get install fonts-dejavu-core'; or write .svg",
    )


def _drawn(drawing: str, family: str) -> bytes:
    try:
        from resvg_py import svg_to_bytes
    except ImportError:
        raise Fault(
            "RBL839", "a .png needs the library resvg-py", "pip install 'robolang[plot]'; .svg and .html need none"
        ) from None
    return svg_to_bytes(svg_string=drawing, zoom=ZOOM, background="#ffffff", sans_serif_family=family)
