"""What a command, a statement or a change ends with when it fails: texts to show, and the code that decides the exit.

Everything that can go wrong comes together here, so that prompt and script show it alike and nothing of it is lost.
"""

from collections.abc import Iterable

from robolang.core.diagnostics import Diagnostic, Severity, render, render_fault, safe
from robolang.core.source import Source
from runtime.core.faults import Fault, lookup
from runtime.core.tomlfile import FileFault


class Failure(Exception):  # noqa: N818 - of a line, as a fault is one of a request
    """A line of the prompt that failed. ``codes`` are those of its errors, ``text`` is what to show."""

    def __init__(self, codes: tuple[str, ...], text: str) -> None:
        super().__init__(text)
        self.codes, self.text = codes, text


def failure(code: str, message: str, hint: str = "") -> Failure:
    """Return the failure of a command, with the remedy of the code where there is no hint."""
    return of_fault(Fault(code, message, hint or lookup(code).remedy))


def of_fault(fault: Fault) -> Failure:
    """Return the failure that a fault and all that was found with it make."""
    return Failure(tuple(each.code for each in fault.all), "\n".join(map(_shown, fault.all)))


def of_diagnostics(found: Iterable[Diagnostic], source: Source) -> Failure:
    """Return the failure of a text with errors; warnings beside them are shown too."""
    # an iterator could be read only once
    all_found = tuple(found)
    codes = tuple(item.code for item in all_found if item.severity is Severity.ERROR)
    return Failure(codes, "\n".join(render(item, source) for item in all_found))


def _shown(fault: Fault) -> str:
    if isinstance(fault, FileFault):
        return render_fault(fault)
    return f"error {fault.code} {safe(fault.message)}\n  help: {safe(fault.hint)}"
