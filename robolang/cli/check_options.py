"""The options of ``robolang check`` in groups, as ``--help`` shows them."""

from typing import Annotated, ClassVar

from robolang.cli.options import AllowEmpty, Argument, Group, Option, Strict

_Codes = list[str] | None
Paths = Annotated[
    list[str] | None, Argument("[PATHS|-]", "Programs, folders of them, or - for stdin; default: this folder.")
]


class SelectionOptions(Group):
    """Which findings are reported."""

    PANEL: ClassVar[str] = "Selection"
    select: Annotated[
        _Codes,
        Option("--select", metavar="CODE,...", help="Report only these: a code, RBL2 for a group, a name, or ALL."),
    ] = None
    ignore: Annotated[_Codes, Option("--ignore", metavar="CODE,...", help="Do not report these.")] = None
    extend_select: Annotated[_Codes, Option("--extend-select", metavar="CODE,...", help="Report these too.")] = None


class FixOptions(Group):
    """What is corrected."""

    PANEL: ClassVar[str] = "Fixes"
    fix: Annotated[bool, Option("--fix", help="Correct the files, where only one correction is possible.")] = False
    diff: Annotated[bool, Option("--diff", help="Print what --fix would change; write nothing.")] = False


class ReportOptions(Group):
    """How the findings are reported, and when they make the exit code 1."""

    PANEL: ClassVar[str] = "Report and exit code"
    output_format: Annotated[
        str,
        Option(
            "--output-format",
            metavar="FORM",
            envvar="ROBOLANG_OUTPUT_FORMAT",
            help="full, concise, json, json-lines, github, gitlab, junit or sarif.",
        ),
    ] = "full"
    as_json: Annotated[bool, Option("--json", help="The same as --output-format json.")] = False
    output_file: Annotated[
        str | None, Option("--output-file", metavar="FILE", help="Write the report to this file.")
    ] = None
    statistics: Annotated[bool, Option("--statistics", help="Count the findings of each code.")] = False
    strict: Strict = False
    exit_zero: Annotated[bool, Option("--exit-zero", help="Exit code 0 in place of 1, whatever is found.")] = False

    @property
    def form(self) -> str:
        """The form of the report that the two options order."""
        return "json" if self.as_json else self.output_format


class MotionOptions(Group):
    """Whether the motion is planned, too."""

    PANEL: ClassVar[str] = "Motion"
    motion: Annotated[
        bool, Option("--motion", help="Plan every move too: reach, limits, collisions, time of each line.")
    ] = False
    max_cycle: Annotated[
        str | None,
        Option("--max-cycle", metavar="TIME", help="With --motion: longest cycle time, such as 12.5s."),
    ] = None
    times: Annotated[
        str | None,
        Option("--times", metavar="FILE.json", help="With --motion: write the time of every line, s, to this file."),
    ] = None
    html: Annotated[
        str | None,
        Option("--html", metavar="FILE.html", help="With --motion: show the planned motion of one program in a page."),
    ] = None


class FileOptions(Group):
    """Which files are read, and how often."""

    PANEL: ClassVar[str] = "Files"
    stdin_filename: Annotated[
        str | None, Option("--stdin-filename", metavar="NAME", help="File name to report for the program that - reads.")
    ] = None
    watch: Annotated[bool, Option("--watch", help="Check again whenever a file changes, until Ctrl-C.")] = False
    allow_empty: AllowEmpty = False
