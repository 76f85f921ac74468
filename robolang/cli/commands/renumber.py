"""``robolang renumber FILE``: give the lines of a program new numbers, and its jumps the new targets.

Only the numbers change; ``robolang fmt`` puts the columns right. ``FILE`` or ``-o`` may be ``-``. A program that has
errors, the same number twice or a jump to no line is left alone and reported.
Imports no numpy, pinocchio or mujoco.
"""

from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import STORAGE, reported, say
from robolang.cli.options import Argument, Group, Option, RewriteOptions
from robolang.cli.output import echo
from robolang.cli.rewrite import BROKEN, CHANGES, STDIO, broken, load, show, store
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.cli.rewrite import Loaded
    from robolang.syntax.renumber import RenumberResult

_File = Annotated[str, Argument("FILE", "Program file (.rbl), or - for stdin.")]


class _Numbers(Group):
    """The numbers that the lines get."""

    PANEL: ClassVar[str] = "Line numbers"
    start: Annotated[int | None, Option("--start", metavar="N", low=0, help="First number; default: 10.")] = None
    step: Annotated[
        int | None, Option("--step", metavar="N", low=1, help="Step from one number to the next; default: 10.")
    ] = None
    remove: Annotated[bool, Option("--remove", help="Remove the numbers that no jump uses.")] = False


class _Output(RewriteOptions):
    out: Annotated[str | None, Option("--out", "-o", metavar="FILE", help="Write to this file instead.")] = None

    @property
    def dry(self) -> bool:
        """Whether nothing is written."""
        return self.check or self.diff


def renumber(program: _File, numbers: _Numbers, output: _Output) -> None:
    """Number the lines of a program, and change the targets of its jumps.

    Example: robolang renumber pick_and_place.rbl --diff

    Exit codes: 0 done; 1 with --check or --diff, the file would change; 2 the file has errors or cannot be read, and is
    left as it is; 4 the file cannot be written.
    """
    _refuse(numbers, output)
    with reported():
        from runtime.core.faults import Fault

        try:
            loaded = load(program)
            found = _renumbered(loaded, numbers)
            if broken(loaded, found.diagnostics):
                raise SystemExit(BROKEN)
            _deliver(loaded, found, output)
        except Fault as fault:
            raise SystemExit(STORAGE if say(fault) == STORAGE else BROKEN) from None
    if found.changed and output.dry:
        raise SystemExit(CHANGES)


def _refuse(numbers: _Numbers, output: _Output) -> None:
    """Refuse options that contradict each other."""
    # None and not 10 by default: only so can it be seen that they were given
    if numbers.remove and (numbers.start is not None or numbers.step is not None):
        raise OptionValueError("--remove", "cannot be used with --start or --step: no number is given")
    if output.out is not None and output.dry:
        raise OptionValueError("--out", "cannot be used with --check or --diff: nothing is written")


def _renumbered(loaded: "Loaded", numbers: _Numbers) -> "RenumberResult":
    from robolang.syntax.renumber import remove_numbers
    from robolang.syntax.renumber import renumber as number

    if numbers.remove:
        return remove_numbers(loaded.source)
    start, step = (10 if given is None else given for given in (numbers.start, numbers.step))
    return number(loaded.source, start=start, step=step)


def _deliver(loaded: "Loaded", found: "RenumberResult", output: _Output) -> None:
    """Show or write the result, and say in a sentence what changed."""
    from robolang.core.diagnostics import safe

    out = loaded.name if output.out is None else output.out
    if output.diff:
        show(loaded, found.text)
    # a file of its own is written even if nothing changes: the next step of a script reads it
    elif not output.check and (found.changed or out == STDIO or out != loaded.name):
        store(loaded, found.text, out)
    text = _summary(found, "would change" if output.dry else "changed")
    echo(safe(f"{loaded.source.path}: {text}"), err=output.diff or out == STDIO)  # stdout has a diff or a program


def _summary(found: "RenumberResult", changed: str) -> str:
    if not found.changed:
        return "nothing to change"
    parts = [_count(found.lines, "line number"), *([_count(found.targets, "jump")] if found.targets else [])]
    return f"{' and '.join(parts)} {changed}"


def _count(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"
