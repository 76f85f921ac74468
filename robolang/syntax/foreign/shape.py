"""One kind of line of other languages, and the statement of this one that does the same."""

from typing import NamedTuple

ANY = "*"
"""In place of the first words of a shape: it may begin with any word."""


class Shape(NamedTuple):
    """``example`` is a line of ``languages``; ``pattern`` what follows its first word, see ``readings``.

    ``write`` is the statement, or several, one a line; empty where nothing has to be written. ``note`` says what was
    not carried over.
    """

    languages: tuple[str, ...]
    example: str
    pattern: str
    write: str
    note: str = ""
    words: str = ""
    """All first words, parted by blanks; that of the example where it is empty."""
