"""Codes of seeing a run: logs that are read, pages, pictures, films, the live view.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL825",
        name="viewer-incomplete",
        meaning="The files that every page is made of are missing from the installation, or are not those of a page.",
        remedy="Install robolang again.",
    ),
    Code(
        code="RBL826",
        name="runs-of-two-robots",
        meaning="Two runs cannot be compared in one page: they are of different robots.",
        remedy="Write a page for each of them.",
    ),
)
