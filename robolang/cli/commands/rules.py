"""``robolang rules``: everything that ``robolang check`` can find, as a table or as JSON."""

import json
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import reported
from robolang.cli.options import Group, Option
from robolang.cli.output import echo

if TYPE_CHECKING:
    from runtime.core.faults import Code


class _RulesOptions(Group):
    PANEL: ClassVar[str] = "Output"
    as_json: Annotated[bool, Option("--json", help="Print one JSON array, with the text of each page.")] = False


def rules(output: _RulesOptions) -> None:
    """List the rules of robolang check; robolang explain CODE explains one of them.

    Example: robolang rules

    Exit codes: 0 done.
    """
    from robolang.cli.code_data import code_data
    from robolang.lint.registry import codes

    with reported():
        if output.as_json:
            echo(json.dumps([code_data(entry) for entry in codes()], indent=2))
        else:
            _print(codes())


def _print(entries: "list[Code]") -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.bounds import of_rule
    from robolang.lint.registry import rule

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in ("code", "name", "severity", "fix"):
        table.add_column(heading, no_wrap=True)
    table.add_column("meaning", overflow="fold")
    for entry in entries:
        known = rule(entry.code)
        severity, fix = ("", "") if known is None else (known.severity.value, "yes" if known.fix else "")
        bounds = ", ".join(f"{bound.key} = {bound.default:g}" for bound in of_rule(entry.code))
        table.add_row(entry.code, entry.name, severity, fix, entry.meaning + (f" Bounds: {bounds}." if bounds else ""))
    Console().print(table)
