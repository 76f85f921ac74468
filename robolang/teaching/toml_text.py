"""Tables ``[group.NAME]`` of a TOML text, set, removed and renamed, with every other byte of the text as it was.

A table with a header of its own is cut out, edited by tomlkit and put back, so what stands around it cannot change. One
in another form (inline, or with dotted keys) is edited by tomlkit in the whole text. The text must be TOML.
"""

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import tomlkit

Values = Mapping[str, str | None]
"""TOML values by key as they are written; None: the key is removed. Other keys stay."""

_TOKEN = re.compile(
    r"""
    \"{3}(?:\\.|[^\\])*?\"{3,5} | '{3}.*?'{3,5} | "(?:\\.|[^"\\\n])*" | '[^'\n]*' | \#[^\n]* | \n | [\[\]{}]
    """,
    re.VERBOSE | re.DOTALL,
)


class _Row(NamedTuple):
    """A statement with its line end, a line of its own for a comment, or a blank line."""

    start: int
    end: int
    text: str

    @property
    def is_header(self) -> bool:
        return self.text.startswith("[")

    @property
    def is_comment(self) -> bool:
        return self.text.startswith("#")


class _Block(NamedTuple):
    """A table from its header to its last key: the place, its key path, and where comments right above it begin."""

    start: int
    end: int
    path: tuple[str, ...]
    above: int


def set_table(text: str, group: str, name: str, values: Values) -> str:
    """Return a text with keys of ``[group.NAME]`` set; a new table comes after the last one of the group.

    Names ignore case; one that is there keeps its spelling.
    """
    written = spelling(text, group, name)
    if written is None:
        return _appended(text, group, name, values)
    block = _find(text, group, written)
    if block is None:
        document: Any = tomlkit.parse(text)
        _assign(document[group][written], values)
        return tomlkit.dumps(document)
    part: Any = tomlkit.parse(text[block.start : block.end])
    _assign(part[group][written], values)
    return f"{text[: block.start]}{_ends_as(tomlkit.dumps(part), text)}{text[block.end :]}"


def remove_table(text: str, group: str, name: str) -> str:
    """Return a text without ``[group.NAME]``, which must be there, and without the comment right above its header."""
    written = spelling(text, group, name)
    assert written is not None
    block = _find(text, group, written)
    if block is None:
        document: Any = tomlkit.parse(text)
        del document[group][written]
        return tomlkit.dumps(document)
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
    written = spelling(text, group, name)
    assert written is not None
    block = _find(text, group, written)
    if block is None:
        document: Any = tomlkit.parse(text)
        table = document[group]
        # tomlkit cannot rename a key in its place: all tables of this form are put anew, in their order
        for key, value in list(table.items()):
            del table[key]
            table[new if key == written else key] = value
        return tomlkit.dumps(document)
    header = text[block.start : text.index("]", block.start)]
    place = header.rindex(written)
    start = block.start + place
    return f"{text[:start]}{new}{text[start + len(written) :]}"


def spelling(text: str, group: str, name: str) -> str | None:
    """Return how a table of a group is written, None where no table has that name."""
    names = tomllib.loads(text).get(group, {})
    return next((each for each in names if each.upper() == name.upper()), None)


def number(value: float, digits: int) -> str:
    """Return a number with at most so many decimals, as short as it is exact to them; never ``-0``."""
    rounded = round(value, digits) + 0.0
    return str(int(rounded)) if rounded == int(rounded) else repr(rounded)


def numbers(values: Iterable[str]) -> str:
    """Return a list of numbers as it is written."""
    return f"[{', '.join(values)}]"


def quoted(text: str) -> str:
    """Return a text as it is written."""
    return tomlkit.item(text).as_string()


def _assign(table: Any, values: Values) -> None:
    for key, value in values.items():
        if value is not None:
            table[key] = tomlkit.value(value)
        elif key in table:
            del table[key]


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


def _find(text: str, group: str, written: str) -> _Block | None:
    return next((block for block in _blocks(text) if block.path == (group, written)), None)


def _blocks(text: str) -> Iterator[_Block]:
    """Yield the tables that have a header."""
    rows = list(_rows(text))
    for index, row in enumerate(rows):
        if not row.is_header:
            continue
        own = [row]
        for following in rows[index + 1 :]:
            if following.is_header:
                break
            own.append(following)
        while own[-1].is_comment or not own[-1].text:
            own.pop()
        first = index
        while first and rows[first - 1].is_comment:
            first -= 1
        # comments at the top of a file are about the file
        above = rows[first].start if first else row.start
        yield _Block(row.start, own[-1].end, _path(row.text), above)


def _path(header: str) -> tuple[str, ...]:
    found, path = tomllib.loads(header), []
    while isinstance(found, dict) and found:
        path += list(found)
        found = found[path[-1]]
    return tuple(path)


def _rows(text: str) -> Iterator[_Row]:
    start = depth = 0
    for token in _TOKEN.finditer(text):
        sign = token[0]
        depth += (sign in "[{") - (sign in "]}") if len(sign) == 1 else 0
        if sign == "\n" and not depth:
            yield _Row(start, token.end(), text[start : token.end()].strip())
            start = token.end()
    if start < len(text):
        yield _Row(start, len(text), text[start:].strip())


def _line_end(text: str) -> str:
    first = text.find("\n")
    return "\r\n" if first > 0 and text[first - 1] == "\r" else "\n"


def _ends_as(part: str, text: str) -> str:
    """Return a part of a text whose new lines end as those of the text."""
    end = _line_end(text)
    return part if end == "\n" else re.sub(r"(?<!\r)\n", end, part)
