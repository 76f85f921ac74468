"""``robolang fmt [PATH...]``: give programs the one layout, as ``ruff format`` does for Python.

Without ``--check`` and ``--diff`` files are rewritten. A file that cannot be read or has errors in its text is left
alone and reported, and the others are formatted all the same. ``-`` formats the standard input to the standard output.
Imports no numpy, pinocchio or mujoco.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from robolang.cli.errors import STORAGE, reported, say
from robolang.cli.options import Argument, RewriteOptions
from robolang.cli.output import echo
from robolang.cli.rewrite import BROKEN, CHANGES, STDIO, broken, load, show, store
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from runtime.core.faults import Fault


_Paths = Annotated[
    list[str] | None,
    Argument("[PATH...]", "Programs, folders of programs (*.rbl), or - for stdin; default: this folder."),
]


def fmt(paths: _Paths, output: RewriteOptions) -> None:
    """Format programs: keywords in capitals, blocks indented, comments aligned.

    Example: robolang fmt --check programs

    Exit codes: 0 done; 1 with --check or --diff, a file would change; 2 a file has errors or cannot be read, and is
    left as it is; 4 a file cannot be written.
    """
    run, names = _Run(check=output.check, diff=output.diff), paths or ["."]
    with reported():
        if names == [STDIO]:
            run.one(STDIO)
        elif STDIO in names:
            # its program goes to stdout, where the sentences about the files go too
            raise OptionValueError("PATH", "'-' cannot be used with other paths")
        else:
            from robolang.lint.files import programs
            from robolang.lint.settings import Settings

            for name in programs(names, excludes=Settings().excludes):
                run.one(name)
            echo(run.summary(), err=output.diff)  # stdout may go on to patch
    if run.exit_code:
        raise SystemExit(run.exit_code)


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
        # a file that was left alone outranks one that would change: CI must not call the rest of it formatted
        return self.failure or (CHANGES if self.changed and (self.check or self.diff) else 0)

    def one(self, name: str) -> None:
        """Format a file, or say why not."""
        from runtime.core.faults import Fault

        try:
            self._format(name)
        except Fault as fault:
            self.fail(fault)

    def fail(self, fault: "Fault") -> None:
        """Say why a file is left alone."""
        self._leave(STORAGE if say(fault) == STORAGE else BROKEN)

    def _format(self, name: str) -> None:
        from robolang.core.diagnostics import safe
        from robolang.syntax.formatter import format_source

        loaded = load(name)
        found = format_source(loaded.source)
        if broken(loaded, found.diagnostics):
            self._leave(BROKEN)
            return
        if self.diff:
            show(loaded, found.text)
        elif self.check and found.changed:
            echo(safe(f"would reformat {loaded.source.path}"))
        # a filter of an editor gives back what it has read, changed or not; a file keeps its time
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
        would, same = (
            ("would be reformatted", "already formatted")
            if self.check or self.diff
            else ("reformatted", "left unchanged")
        )
        parts = ((self.changed, would), (self.same, same), (self.left, "left alone for errors"))
        return ", ".join(f"{count} file{'s' * (count != 1)} {what}" for count, what in parts if count)
