"""What a user sees when something goes wrong, and the exit code that goes with it. No traceback gets past here.

Exit codes: 0 clean, 1 diagnostics found, 2 usage or configuration, 3 motion fault, 4 storage, 70 internal,
130 and 143 stopped by a signal (docs/decisions/0005).
"""

import errno
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress

from robolang.cli.output import drop, show_finding
from robolang.cli.usage import OptionValueError
from robolang.core.defects import internal
from robolang.core.diagnostics import Severity, render_fault, safe
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault

DIAGNOSTICS, USAGE, MOTION, STORAGE, INTERNAL = 1, 2, 3, 4, 70
INTERRUPTED = 130

_OF_CODE = {
    "RBL301": DIAGNOSTICS,
    "RBL312": STORAGE,
    "RBL706": STORAGE,
    "RBL804": MOTION,
    "RBL805": DIAGNOSTICS,
    "RBL806": MOTION,
    "RBL809": MOTION,
    "RBL811": MOTION,
    "RBL810": STORAGE,
    "RBL841": STORAGE,
}
# A group of two digits counts before one of one: 40x is about the text, the rest of 4xx a motion (decision 0005).
_OF_GROUP = {"1": DIAGNOSTICS, "2": DIAGNOSTICS, "40": DIAGNOSTICS, "4": MOTION, "5": MOTION, "9": INTERNAL}
# Errors of a device that is full or broken. Only stdout gets here with one: storage turns those of files into faults.
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


def exit_code(code: str) -> int:
    """Return the exit code of a registered code, whoever found it.

    What the text of a program says is 1: RBL1xx, RBL2xx, an undefined point (RBL301), a LOAD, SPEED or HAND that no
    robot can follow (RBL40x). A move that this robot cannot make, and every alarm, is 3.
    """
    number = code.removeprefix("RBL")
    return _OF_CODE.get(code) or _OF_GROUP.get(number[:2]) or _OF_GROUP.get(number[:1]) or USAGE


def say(fault: Fault) -> int:
    """Print a fault to stderr, with its place when it has one, and return its exit code."""
    if isinstance(fault, FileFault):
        show_finding(render_fault(fault))
    else:
        show_finding(f"error {fault.code} {safe(fault.message)}\n  help: {safe(fault.hint)}")
    return exit_code(fault.code)


def say_warning(code: str, place: str, message: str, hint: str) -> None:
    """Print a warning about an option to stderr; ``place`` names the option and, in a list, the number of the value."""
    show_finding(f"warning {code} {place}: {safe(message)}\n  help: {safe(hint)}")


def say_warnings(warnings: Iterable[FileFault]) -> None:
    """Print what is unlikely about files to stderr, each once: many programs may run in one cell."""
    for text in dict.fromkeys(render_fault(warning, Severity.WARNING) for warning in warnings):
        show_finding(text)


def say_notes(notes: Iterable[FileFault]) -> None:
    """Print notes about files to stderr, a line each: they ask for nothing."""
    for note in notes:
        place = f"{note.path}:{note.line}:{note.column}"
        show_finding(safe(f"{place}: {Severity.INFO.value} {note.code} {note.message}"))


def say_all(fault: Fault) -> int:
    """Print a fault and what else was found with it, and return the worst exit code."""
    return max(say(each) for each in fault.all)


@contextmanager
def reported() -> Iterator[None]:
    """Print faults to stderr and leave with their exit code.

    Where showing a fault fails as well, that is shown in its place: RBL900, and exit code 70 even if nothing can be.
    """
    try:
        with _left_with_exit_code():
            yield
    except OptionValueError:  # typer shows it, with the usage of the command
        raise
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None
    except Exception as error:
        fault = internal(error)
        with suppress(Exception):  # stderr may be what failed; the exit code is all that is left then
            say(fault)
        raise SystemExit(INTERNAL) from None


@contextmanager
def _left_with_exit_code() -> Iterator[None]:
    try:
        yield
    except Fault as fault:
        raise SystemExit(say_all(fault)) from None
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None
    except OptionValueError:
        raise
    except OSError as error:
        if error.errno not in _FULL:
            raise SystemExit(say(internal(error))) from None
        drop(sys.stdout)
        message = f"cannot write the standard output: {error.strerror}"
        raise SystemExit(say(Fault("RBL706", message))) from None
    except Exception as error:
        raise SystemExit(say(internal(error))) from None
