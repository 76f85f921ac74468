"""What the commands that change program files share: reading one, showing what would change, writing it back.

``-`` stands for the standard input and output. A byte order mark and the permissions of a file stay as they are, and
the file is replaced whole or not at all. Imports no numpy, pinocchio or mujoco.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robolang.cli.output import echo, show_finding
from robolang.core.diagnostics import has_errors, render, safe
from runtime.core.record import Record

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robolang.analysis.analysis import Analysis
    from robolang.core.diagnostics import Diagnostic
    from robolang.core.source import Source

STDIO = "-"
CHANGES, BROKEN = 1, 2
"""Exit codes: something would change; a program cannot be read or has errors, and is left alone."""

_MARK = b"\xef\xbb\xbf"
_CONTEXT = 3
# str.splitlines would also split at form feeds and at line ends of Unicode, which no line of a program ends with
_LINE = re.compile(r"[^\r\n]*(?:\r\n?|\n)|[^\r\n]+")


class Loaded(Record):
    """A program with the name the user gave it, and the byte order mark that it began with, if any."""

    name: str
    mark: bytes
    source: "Source"


def load(name: str, shown: str = "") -> Loaded:
    """Read a program, that of ``-`` under the name ``shown``; ``FileFault`` RBL701, RBL702, RBL104, RBL106."""
    from robolang.core.source import STANDARD_INPUT, decode_program, read_bytes

    raw, shown = (_standard_input(), shown or STANDARD_INPUT) if name == STDIO else (read_bytes(name), name)
    mark = _MARK if raw.startswith(_MARK) else b""
    return Loaded(name=name, mark=mark, source=decode_program(shown, raw))


def read(name: str) -> "Analysis":
    """Return a program as ``load_project`` takes it, that of the standard input for ``-``; faults as ``load``."""
    from robolang.analysis.analysis import Analysis
    from robolang.core.source import read_program

    return Analysis(source=load(name).source if name == STDIO else read_program(name))


def _standard_input() -> bytes:
    """Return what a program can hold of the standard input, and one byte more."""
    from robolang.core.source import MAX_BYTES
    from runtime.core.faults import Fault

    if sys.stdin is None:
        raise Fault("RBL702", "there is no standard input")
    try:
        return sys.stdin.buffer.read(MAX_BYTES + 1)  # the one more tells a text that is too long from one that fits
    except OSError as error:
        raise Fault("RBL702", f"cannot read the standard input: {error.strerror}") from None


def store(loaded: Loaded, text: str, out: str | None = None) -> None:
    """Write a text in place of the program that was read, or to ``out``; ``Fault`` RBL706.

    The program is left alone when it is not what was read any more: somebody else is writing it.
    """
    from robolang.core.storage import write_atomic
    from runtime.core.faults import Fault

    raw, name = loaded.mark + text.encode("utf-8"), loaded.name if out is None else out
    if name == STDIO:
        echo(raw, nl=False)
        return
    if name == loaded.name and not _still(loaded):
        raise Fault("RBL706", f"{name} has changed since it was read", "Run the command again.")
    write_atomic(Path(name), lambda stream: stream.write(raw))


def _still(loaded: Loaded) -> bool:
    from robolang.core.source import read_bytes
    from runtime.core.faults import Fault

    try:
        return read_bytes(loaded.name) == loaded.mark + loaded.source.text.encode("utf-8")
    # it is gone or cannot be read any more, which is a change as well
    except Fault:
        return False


def broken(loaded: Loaded, diagnostics: "Iterable[Diagnostic]") -> bool:
    """Return whether there is an error among the diagnostics; they are printed to stderr then."""
    found = tuple(diagnostics)
    if not has_errors(found):
        return False
    for item in found:
        show_finding(render(item, loaded.source))
    return True


def show(loaded: Loaded, text: str) -> None:
    """Print what would change as a unified diff, in the bytes of the file."""
    echo("".join(unified(loaded.source.path, loaded.source.text, text)).encode("utf-8"), nl=False)


# --- a unified diff --------------------------------------------------------------------------------------------------


def unified(name: str, old: str, new: str) -> Iterator[str]:
    """Yield the lines of a unified diff of two texts, of which the second has some blank lines fewer and none moved.

    Lines are paired as they come, so the time is linear, where a search for common lines may take the square of it.
    """
    pairs = list(_pairs(_LINE.findall(old), _LINE.findall(new)))
    changed = [index for index, (before, after) in enumerate(pairs) if before != after]
    if changed:
        yield f"--- {safe(name)}\n+++ {safe(name)}\n"
    dropped = counted = 0
    for first, last in _hunks(changed, len(pairs)):
        dropped += sum(after is None for _, after in pairs[counted:first])
        counted, hunk = first, pairs[first:last]
        kept = sum(after is not None for _, after in hunk)
        yield f"@@ -{_range(first, len(hunk))} +{_range(first - dropped, kept)} @@\n"
        yield from _body(hunk)


def _pairs(old: list[str], new: list[str]) -> Iterator[tuple[str, str | None]]:
    """Yield each old line with the new one in its place; a blank line without one was dropped."""
    at = 0
    for line in old:
        other = new[at] if at < len(new) else None
        if other is None or (not line.strip() and other.strip()):
            yield line, None
        else:
            yield line, other
            at += 1


def _hunks(changed: list[int], count: int) -> Iterator[tuple[int, int]]:
    """Yield the ranges of lines that are shown: the changed ones with three more on either side."""
    ranges: list[list[int]] = []
    for index in changed:
        if ranges and index - ranges[-1][1] <= 2 * _CONTEXT + 1:  # their context would overlap or touch
            ranges[-1][1] = index
        else:
            ranges.append([index, index])
    for first, last in ranges:
        yield max(0, first - _CONTEXT), min(count, last + _CONTEXT + 1)


def _range(before: int, count: int) -> str:
    """Return the place of a hunk after ``before`` lines; of an empty one, that of the line above."""
    start = before + 1 if count else before
    return str(start) if count == 1 else f"{start},{count}"


def _body(hunk: list[tuple[str, str | None]]) -> Iterator[str]:
    # lines that are removed come before those that take their place, as patch and diff have them
    added: list[str] = []
    for before, after in hunk:
        if before == after:
            yield from added
            added = []
            yield _line(" ", before)
            continue
        yield _line("-", before)
        if after is not None:
            added.append(_line("+", after))
    yield from added


def _line(sign: str, line: str) -> str:
    missing = "" if line.endswith(("\n", "\r")) else "\\ No newline at end of file\n"
    return f"{sign}{line.removesuffix(chr(10))}\n{missing}"  # a \r stays: patch compares the bytes of the file
