"""Tables ``[group.NAME]`` of a TOML text, set, removed and renamed, with every other byte of the text as it was.

A table with a header of its own is cut out, edited by tomlkit and put back, so what stands around it cannot change. One
in another form (``NAME = {...}``, ``NAME.key = ...``) becomes one line when it is set. The text must be TOML, and not
have the whole group as one value (``check_form``).
"""

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

from runtime.core.tomlfile import Source

Values = Mapping[str, str | None]
"""All keys that a table may have, with TOML values as they are written; None: the key is removed."""

MOST_DIGITS = 9
"""Decimals of a taught value whose joint angles need more of them than are usual (docs/decisions/0048)."""

_TOKEN = re.compile(
    r"""
    \"{3}(?:\\.|[^\\])*?\"{3,5} | '{3}.*?'{3,5} | "(?:\\.|[^"\\\n])*" | '[^'\n]*' | \#[^\n]* | \n | [\[\]{}]
    """,
    re.VERBOSE | re.DOTALL,
)
_PART = re.compile(r"""(?:"(?:\\.|[^"\\\n])*"|'[^'\n]*'|[A-Za-z0-9_-]+)""")
_KEY = re.compile(rf"[ \t]*\[{{0,2}}[ \t]*{_PART.pattern}(?:[ \t]*\.[ \t]*{_PART.pattern})*")


class _Row(NamedTuple):
    """A statement with its line end, a line of its own for a comment, or a blank line.

    ``path``: the key path of a statement; ``parts``: the places of those of its names that are written in it, the last.
    """

    start: int
    end: int
    text: str
    path: tuple[str, ...]
    parts: tuple[tuple[int, int], ...]

    @property
    def is_header(self) -> bool:
        return self.text.startswith("[")

    @property
    def is_comment(self) -> bool:
        return self.text.startswith("#")


class _Block(NamedTuple):
    """A table from its header to its last key or the comment right below: the place, its key path, and where comments
    right above it begin."""

    start: int
    end: int
    path: tuple[str, ...]
    above: int


def check_form(source: Source, group: str, code: str) -> None:
    """Raise ``FileFault`` with a code where a group is one value, ``group = {...}``, which is not edited."""
    if any(row.path == (group,) and not row.is_header for row in _rows(source.text)):
        message = f"'{group}' is written as one value, in which nothing can be changed"
        source.fail(code, message, f"write a table for each of them, as in [{group}.NAME]", keys=(group,))


def set_table(text: str, group: str, name: str, values: Values) -> str:
    """Return a text with ``[group.NAME]`` set; a new table comes after the last one of the group.

    Names ignore case; one that is there keeps its spelling.
    """
    there = spelling(text, group, name)
    if there is None:
        return _appended(text, group, name, values)
    block = _find(text, group, there)
    if block is None:
        return _set_loose(text, group, there, values)
    import tomlkit  # late: nothing is edited at the start of a prompt

    part: Any = tomlkit.parse(text[block.start : block.end])
    table = part[group][there]
    for key, value in values.items():
        if value is not None:
            table[key] = tomlkit.value(value)
        elif key in table:
            del table[key]
    return f"{text[: block.start]}{_ends_as(tomlkit.dumps(part), text)}{text[block.end :]}"


def remove_table(text: str, group: str, name: str) -> str:
    """Return a text without ``[group.NAME]``, which must be there, and without the comment right above its header."""
    there = spelling(text, group, name)
    assert there is not None
    block = _find(text, group, there)
    if block is None:
        return _replaced(text, [(row.start, row.end, "") for row in _of(text, group, there)])
    before, after = text[: block.above], text[block.end :]
    # one of the blank lines around it goes too: those of its neighbours stay as many as they were
    if not after.strip():
        before = re.sub(r"(?:\r?\n)+\Z", _line_end(text), before)
        after = after.lstrip("\r\n")
    elif re.search(r"\n\r?\n\Z", before):
        after = re.sub(r"\A\r?\n", "", after)
    return before + after


def rename_table(text: str, group: str, name: str, new: str) -> str:
    """Return a text in which ``[group.NAME]``, which must be there, has another name."""
    there = spelling(text, group, name)
    return _replaced(text, [(*_name_in(row), new) for row in _of(text, group, there) if _writes_name(row)])


def spelling(text: str, group: str, name: str) -> str | None:
    """Return how a table of a group is written, None where no table has that name."""
    paths = (row.path for row in _rows(text) if len(row.path) > 1 and row.path[0] == group)
    return next((path[1] for path in paths if path[1].upper() == name.upper()), None)


def number(value: float, digits: int) -> str:
    """Return a number with at most so many decimals, without those that are 0; never ``-0``.

    One that has at most ``MOST_DIGITS`` is taken to be rounded on purpose, and written in full.
    """
    exact = float(value)
    kept = exact if exact == round(exact, MOST_DIGITS) else round(exact, digits)
    # one that is not finite is a value of TOML as well, and refused where the text is read
    text = f"{kept + 0.0:.{MOST_DIGITS}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def numbers(values: Iterable[str]) -> str:
    """Return a list of numbers as it is written."""
    return f"[{', '.join(values)}]"


def written(value: Any) -> str:
    """Return a value, as ``tomllib`` reads it, as it is written."""
    import tomlkit

    return str(tomlkit.item(value).as_string())


def _appended(text: str, group: str, name: str, values: Values) -> str:
    end = _line_end(text)
    blocks = [block for block in _blocks(text) if block.path[:1] == (group,)]
    at = blocks[-1].end if blocks else len(text)
    before, after = text[:at], text[at:]
    if before and not before.endswith("\n"):
        before += end
    rows = [f"[{group}.{name}]", *(f"{key} = {value}" for key, value in values.items() if value is not None)]
    blank = "" if not before or before.endswith(("\n\n", "\n\r\n")) else end
    return f"{before}{blank}{''.join(f'{row}{end}' for row in rows)}{after}"


def _set_loose(text: str, group: str, written: str, values: Values) -> str:
    """Return a text in which a table without a header is one line, where its first key was."""
    first, *others = _of(text, group, written)
    _, end = _name_in(first)
    inside = ", ".join(f"{key} = {value}" for key, value in values.items() if value is not None)
    whole = text[first.start : first.end]
    row = f"{text[first.start : end]} = {{{inside}}}{whole[len(whole.rstrip()) :]}"
    return _replaced(text, [(first.start, first.end, row), *((other.start, other.end, "") for other in others)])


# --- where the tables are --------------------------------------------------------------------------------------------


def _of(text: str, group: str, written: str | None) -> list[_Row]:
    """Return the statements of a table, its header among them."""
    return [row for row in _rows(text) if row.path[:2] == (group, written)]


def _writes_name(row: _Row) -> bool:
    return len(row.path) - len(row.parts) < 2


def _name_in(row: _Row) -> tuple[int, int]:
    """Return the place of the second name of a key path."""
    return row.parts[1 - len(row.path)]


def _replaced(text: str, edits: list[tuple[int, int, str]]) -> str:
    """Return a text with edits made that do not overlap: what stands from start to end becomes another text."""
    for start, end, new in sorted(edits, reverse=True):
        text = f"{text[:start]}{new}{text[end:]}"
    return text


def _find(text: str, group: str, written: str) -> _Block | None:
    return next((block for block in _blocks(text) if block.path == (group, written)), None)


def _blocks(text: str) -> Iterator[_Block]:
    """Yield the tables that have a header."""
    rows = _rows(text)
    headers = [index for index, row in enumerate(rows) if row.is_header]
    for index, following in pairwise([*headers, len(rows)]):
        last = max(at for at in range(index, following) if rows[at].path)
        comments = _comments(rows, range(last + 1, following))
        # a comment right below the last key, unless it is right above the next header
        if last + comments + 1 < following or following == len(rows):
            last += comments
        above = index - _comments(rows, range(index - 1, -1, -1))
        yield _Block(rows[index].start, rows[last].end, rows[index].path, rows[above].start)


def _comments(rows: Sequence[_Row], places: range) -> int:
    """Return how many rows are comments, from the first place on without a gap."""
    return next((count for count, at in enumerate(places) if not rows[at].is_comment), len(places))


@lru_cache(maxsize=4)
def _rows(text: str) -> tuple[_Row, ...]:
    """Return the statements of a text; a file is scanned once for all that is done with it."""
    return tuple(_scan(text))


def _scan(text: str) -> Iterator[_Row]:
    table: tuple[str, ...] = ()
    start = depth = 0
    ends = [*_TOKEN.finditer(text), None]
    for token in ends:
        sign = "\n" if token is None else token[0]
        depth += (sign in "[{") - (sign in "]}") if len(sign) == 1 else 0
        end = len(text) if token is None else token.end()
        if sign != "\n" or depth or start == end:
            continue
        row = _row(text, start, end, table)
        table = row.path if row.is_header else table
        yield row
        start = end


def _row(text: str, start: int, end: int, table: tuple[str, ...]) -> _Row:
    key, whole = _KEY.match(text, start), text[start:end].strip()
    if key is None:
        return _Row(start, end, whole, (), ())
    parts = tuple(part.span() for part in _PART.finditer(text, *key.span()))
    written = tuple(_decoded(text[slice(*part)]) for part in parts)
    return _Row(start, end, whole, written if whole.startswith("[") else (*table, *written), parts)


def _decoded(part: str) -> str:
    """Return the name that is written in a part of a key."""
    try:
        return next(iter(tomllib.loads(f"{part} = 0"))) if part[0] in "\"'" else part
    except tomllib.TOMLDecodeError:  # in a text that is no TOML, where only the name of something else is searched for
        return part


def _line_end(text: str) -> str:
    first = text.find("\n")
    return "\r\n" if first > 0 and text[first - 1] == "\r" else "\n"


def _ends_as(part: str, text: str) -> str:
    """Return a part of a text whose new lines end as those of the text."""
    end = _line_end(text)
    return part if end == "\n" else re.sub(r"(?<!\r)\n", end, part)
