"""``robolang fmt [PATH...]``: give programs the one layout, as ``ruff format`` does for Python.

Without ``--check`` and ``--diff`` files are rewritten. A file that cannot be read or has errors in its text is left
alone and reported, and the others are formatted all the same. ``-`` formats the standard input to the standard output.

Exit codes: 0; 1 with ``--check`` or ``--diff``, something would change; 2 a file is left alone; 4 one cannot be
written. Imports no numpy, pinocchio or mujoco.
"""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolang.cli.errors import STORAGE, reader_may_leave, reported, say
from robolang.cli.rewrite import BROKEN, CHANGES, STDIO, broken, load, show, store
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from runtime.faults import Fault


def fmt(
    paths: Annotated[
        list[str] | None,
        typer.Argument(metavar="[PATH...]", help="Programs, folders of them (*.rbl), or -; default: this folder."),
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Write nothing; exit code 1 if one would change.")] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Write nothing; print what would change.")] = False,
) -> None:
    """Format programs: keywords in capitals, blocks indented, comments aligned."""
    run, names = _Run(check=check, diff=diff), paths or ["."]
    with reported():
        if names == [STDIO]:
            run.one(STDIO)
        elif STDIO in names:
            raise OptionValueError("PATH", "'-' stands alone")
        else:
            for name in _programs(names, run.fail):
                run.one(name)
            with reader_may_leave():
                typer.echo(run.summary(), err=diff)
    if run.exit_code:
        raise typer.Exit(run.exit_code)


@dataclass(slots=True, kw_only=True)
class _Run:
    """Files counted by what became of them."""

    check: bool
    diff: bool
    changed: int = 0
    same: int = 0
    left: int = 0
    failure: int = 0

    @property
    def exit_code(self) -> int:
        return self.failure or (CHANGES if self.changed and (self.check or self.diff) else 0)

    def one(self, name: str) -> None:
        """Format a file, or say why not."""
        from runtime.faults import Fault

        try:
            self._format(name)
        except Fault as fault:
            self.fail(fault)

    def fail(self, fault: "Fault") -> None:
        """Say why a file is left alone."""
        self._leave(STORAGE if say(fault) == STORAGE else BROKEN)

    def _format(self, name: str) -> None:
        from robolang.diagnostics import safe
        from robolang.formatter import format_source

        loaded = load(name)
        found = format_source(loaded.source)
        if broken(loaded, found.diagnostics):
            self._leave(BROKEN)
            return
        with reader_may_leave():
            if self.diff:
                show(loaded, found.text)
            elif self.check and found.changed:
                typer.echo(safe(f"would reformat {loaded.source.path}"))
        if not self.check and not self.diff and (found.changed or name == STDIO):
            store(loaded, found.text)
        self.changed += found.changed
        self.same += not found.changed

    def _leave(self, code: int) -> None:
        self.left += 1
        self.failure = max(self.failure, code)

    def summary(self) -> str:
        """Return what became of the files, in a sentence."""
        if not (self.changed or self.same or self.left):
            return "no program (*.rbl) found"
        would, same = ("would be reformatted", "already formatted") if self.check or self.diff else (
            "reformatted", "left unchanged")  # fmt: skip
        parts = ((self.changed, would), (self.same, same), (self.left, "left alone for errors"))
        return ", ".join(f"{count} file{'s' * (count != 1)} {what}" for count, what in parts if count)


def _programs(names: list[str], fail: "Callable[[Fault], None]") -> Iterator[str]:
    """Yield the files that are meant, each once: those named, and ``*.rbl`` in folders at any depth.

    Folders whose name starts with a point are passed over, links to folders are not followed.
    """
    seen: set[Path] = set()
    for name in names:
        for path in _inside(name, fail) if Path(name).is_dir() else (name,):
            if (where := Path(path).absolute()) not in seen:
                seen.add(where)
                yield path


def _inside(folder: str, fail: "Callable[[Fault], None]") -> Iterator[str]:
    from runtime.faults import Fault

    def unreadable(error: OSError) -> None:
        fail(Fault("RBL702", f"cannot list {error.filename}: {error.strerror}"))

    for where, folders, files in os.walk(folder, onerror=unreadable):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            if name.endswith(".rbl"):
                yield str(Path(where, name))
