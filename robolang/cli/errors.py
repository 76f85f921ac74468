"""What a user sees when something goes wrong, and the exit code that goes with it. No traceback gets past here.

Exit codes: 0 clean, 1 diagnostics found, 2 usage or configuration, 3 motion fault, 4 storage, 70 internal,
130 and 143 stopped by a signal (docs/decisions/0005).
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from robolang.diagnostics import has_errors, render, render_fault, safe
from runtime.faults import Fault
from runtime.tomlfile import FileFault

DIAGNOSTICS, USAGE, MOTION, STORAGE, INTERNAL = 1, 2, 3, 4, 70
INTERRUPTED = 130


def exit_code(code: str, *, in_program: bool = False) -> int:
    """Return the exit code of a fault; ``in_program``: it was found in the program's text."""
    if in_program:
        return DIAGNOSTICS
    group = code[3:4]
    if code == "RBL706":
        return STORAGE
    return {"1": DIAGNOSTICS, "2": DIAGNOSTICS, "4": MOTION, "5": MOTION, "9": INTERNAL}.get(group, USAGE)


@contextmanager
def reported() -> Iterator[None]:
    """Print faults to stderr and leave with their exit code."""
    try:
        yield
    except FileFault as fault:
        typer.echo(render_fault(fault), err=True)
        raise typer.Exit(exit_code(fault.code)) from None
    except Fault as fault:
        typer.echo(f"error {fault.code} {safe(fault.message)}\n  help: {safe(fault.hint)}", err=True)
        raise typer.Exit(exit_code(fault.code)) from None
    except KeyboardInterrupt:
        raise typer.Exit(INTERRUPTED) from None
    except BrokenPipeError:
        # the reader has gone: nothing can be said, and the interpreter must not try at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(STORAGE) from None
    except (typer.Exit, typer.Abort, typer.BadParameter):
        raise
    except Exception as error:
        if os.environ.get("ROBOLANG_DEBUG"):
            raise
        kind = type(error).__name__
        typer.echo(
            f"error RBL900 internal error: {kind}: {safe(str(error))}\n"
            "  help: this is a defect of robolang; ROBOLANG_DEBUG=1 shows where it happened",
            err=True,
        )
        raise typer.Exit(INTERNAL) from None


__all__ = ["exit_code", "has_errors", "render", "reported"]
