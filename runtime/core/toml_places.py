"""The places of the keys of a TOML text: tomllib keeps none.

A scan of lines, not a parser: an inline table is located at its own key. A second parser with places was rejected: it
would have to agree with tomllib on every file. Called when an error is reported; the standard library only.
"""

import re
from collections.abc import Iterator, Sequence

_HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\"' -]+?)\s*\]\]?\s*(?:#.*)?$")
_KEY = re.compile(r"^(\s*)([A-Za-z0-9_.\"'-]+)\s*=")


def locate(text: str, keys: Sequence[str | int]) -> tuple[int, int]:
    """Return the 1-based line and column of a key path; of the nearest enclosing header where it is missing.

    A path that occurs only in longer ones (``a`` in ``[[a]]`` or ``[a.b]``) is at the first of these.
    """
    best, place = -1, (1, 1)
    for number, column, path in _places(text):
        shared = min(len(path), len(keys))
        rank = 2 * shared + (len(path) <= len(keys))  # of two that share as much the one that is not longer
        if shared and rank > best and list(keys[:shared]) == path[:shared]:
            best, place = rank, (number, column)
    return place


def clash(text: str, line: int) -> tuple[int, int, str, int | None]:
    """Return the last key or header up to ``line``: its line, column and name, and the line of an earlier one of it."""
    earlier = [found for found in _places(text) if found[0] <= line]
    number, column, path = earlier[-1] if earlier else (line, 1, [])
    first = next((found[0] for found in earlier[:-1] if found[2] == path), None)
    written = lines_of(text)[number - 1]
    header = _HEADER.match(written)
    name = header[0].partition("#")[0].strip() if header else f"'{written.partition('=')[0].strip()}'"
    return number, column, name, first


def lines_of(text: str) -> list[str]:
    """Return the lines of a TOML text, split only where TOML and editors do (LF, CRLF); at least one."""
    lines = [line.removesuffix("\r") for line in text.split("\n")]
    # a line end closes its line and begins none
    return lines[:-1] if len(lines) > 1 and not lines[-1] else lines


def _places(text: str) -> Iterator[tuple[int, int, list[str | int]]]:
    """Yield line, column and key path of every header and key.

    A line inside a text of several lines may look like a key; it then only takes part in the search for the best match.
    """
    here: list[str | int] = []
    counts: dict[tuple[str | int, ...], int] = {}
    for number, line in enumerate(lines_of(text), start=1):
        if header := _HEADER.match(line):
            here = _header_path(header[2], header[1] == "[[", counts)
            yield number, line.index("[") + 1, list(here)
        elif key := _KEY.match(line):
            yield number, len(key[1]) + 1, [*here, *_split(key[2])]


def _split(dotted: str) -> list[str]:
    # a dot within quotes parts as well: such a key is located at the table that holds it
    return [part.strip().strip("\"'") for part in dotted.split(".")]


def _header_path(dotted: str, is_array: bool, counts: dict[tuple[str | int, ...], int]) -> list[str | int]:
    path: list[str | int] = []
    parts = _split(dotted)
    for position, part in enumerate(parts):
        path.append(part)
        key = tuple(path)
        # [[a]] counts up its own entry; [a.b] after it belongs to the entry that is open
        if is_array and position == len(parts) - 1:
            counts[key] = counts.get(key, -1) + 1
            path.append(counts[key])
        elif key in counts:
            path.append(counts[key])
    return path
