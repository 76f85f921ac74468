"""An SVG as PNG, by the library of the extra ``[plot]`` and the fonts of the machine."""

from runtime.core.faults import Fault

ZOOM = 2.0
"""Pixels for each unit of the drawing, so that a line of text is sharp on a screen of many dots."""
_BLANK = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 24"><rect width="40" height="24" fill="#fff"/>{}</svg>'
)
_WORD = '<text x="2" y="18" font-family="sans-serif" font-size="14">J1</text>'


def check_png() -> None:
    """Refuse where no PNG could be made: ``Fault`` RBL839 without the library, or without any font.

    The library leaves out text that it has no font for, without a word; so a text is drawn here and compared.
    """
    # compared as bytes: the same picture is the same file
    if _drawn(_BLANK.format(_WORD)) == _drawn(_BLANK.format("")):
        raise Fault(
            "RBL839",
            "no font is installed, so a .png would have no text",
            "install one: on Debian and Ubuntu 'apt-get install fonts-dejavu-core'; or write .svg",
        )


def as_png(drawing: str) -> bytes:
    """Return an SVG as PNG; ``Fault`` RBL839."""
    check_png()
    return _drawn(drawing)


def _drawn(drawing: str) -> bytes:
    try:
        from resvg_py import svg_to_bytes
    except ImportError:
        raise Fault(
            "RBL839", "a .png needs the library resvg-py", "pip install 'robolang[plot]'; .svg and .html need none"
        ) from None
    return svg_to_bytes(svg_string=drawing, zoom=ZOOM, background="#ffffff")
