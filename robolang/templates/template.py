"""The templates: each a program with its cell, points and test, which runs as it is in the library.

Taught points and frames, parts and obstacles stand on a table; a placement moves that table to where an arm reaches it.
"""

import difflib
import itertools
from collections.abc import Mapping
from pathlib import Path

import robolang.core.codes  # noqa: F401 - RBL840 must be registered
from runtime.core.faults import Fault
from runtime.core.record import Record

LIBRARY = Path(__file__).parent / "library"
NAMES = ("pick-place", "palletise", "tend", "dispense", "measure")
"""The templates, the simplest first."""
PROGRAM, CELL, POINTS, TEST = ".rbl", ".cell.toml", ".points.toml", ".test.toml"
ENDINGS = (PROGRAM, CELL, POINTS, TEST)
"""Endings of the files of a template, and of a project."""


class Template(Record):
    """A template: ``texts`` by the ending of the file."""

    name: str
    texts: Mapping[str, str]

    @property
    def title(self) -> str:
        """What the job does: the first comment of the program."""
        return title_of(self.texts[PROGRAM])


def template(name: str) -> Template:
    """Return a template; ``Fault`` RBL840 for a name that none has."""
    # by the list, and never by the file: a name could lead out of the library
    if name not in NAMES:
        near = difflib.get_close_matches(name.lower(), NAMES, n=1)
        guess = f"did you mean {near[0]}? " if near else ""
        raise Fault("RBL840", f"there is no template '{name}'", f"{guess}templates: {', '.join(NAMES)}")
    return Template(name=name, texts={ending: (LIBRARY / (name + ending)).read_text("utf-8") for ending in ENDINGS})


def title_of(program: str) -> str:
    """Return the first sentence of the comment with which a program begins; empty without one."""
    # a sentence may go on in the next line of the comment
    comment = itertools.takewhile(lambda line: line.startswith("'"), program.splitlines())
    sentence, end, _ = " ".join(line.removeprefix("'").strip() for line in comment).partition(". ")
    return sentence + end.strip()
