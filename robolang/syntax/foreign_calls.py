"""A call as other languages write it: ``pick()``, ``pick;`` or ``pick 1, 2;`` for ``CALL pick(1, 2)``."""

import re

from robolang.syntax import other_languages
from robolang.syntax.foreign_lines import BEFORE, MOST, canonical
from robolang.syntax.keywords import kind_of
from runtime.core.record import Record

# a run of blanks is taken whole: parts that could share it would take time with its third power
_CALL = re.compile(
    r"[ \t]*+(?:.*(?<!\w)(?:THEN|ELSE)[ \t]++)?(?:CALL[ \t]++)?(?P<name>[A-Za-z_]\w*+)[ \t]*+"
    r"(?:\((?P<inner>.*)\)|(?<=[ \t])(?P<after>[^=:(;'](?:[^=:;']*[^=:;' \t])?))?[ \t]*+(?P<end>;?)[ \t]*+(?:'.*)?",
    re.IGNORECASE,
)


class Called(Record):
    """A line that is a call elsewhere: the name, the statement of this language, and what stands before it.

    ``is_sure``: parentheses or a sign at its end, so that the name is no misspelt instruction.
    """

    name: str
    statement: str
    start: int
    is_sure: bool

    @property
    def advice(self) -> str:
        """What to write where nothing is known of the name."""
        return f"a call is {self.statement}, which runs SUB {self.name} of the same file"


def called(code: str) -> Called | None:
    """Return the call that a line seems to be, without its line number; None for what can be none."""
    before = BEFORE.match(code)
    found = _CALL.fullmatch(code.rstrip(), before.end() if before else 0) if len(code) <= MOST else None
    if found is None or kind_of(found["name"]):
        return None
    values = (found["inner"] or found["after"] or "").strip()
    statement = canonical(f"CALL {found['name']}({values})" if values else f"CALL {found['name']}")
    if not statement:
        return None
    is_sure = found["inner"] is not None or bool(found["end"])
    return Called(name=found["name"], statement=statement, start=found.start("name"), is_sure=is_sure)


def unknown(code: str) -> Called | None:
    """Return the call that a line certainly is, where its name is no word of another language."""
    found = called(code)
    return found if found and found.is_sure and not other_languages.is_known(found.name) else None
