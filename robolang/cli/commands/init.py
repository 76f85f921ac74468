"""``robolang init``: what ``robolang new`` makes, in a folder that is there."""

from pathlib import Path
from typing import Annotated, ClassVar

from robolang.cli.commands.new import TemplateOptions, tell
from robolang.cli.errors import reported
from robolang.cli.options import Argument, Group, Option
from robolang.cli.usage import OptionValueError

_Folder = Annotated[Path | None, Argument("[FOLDER]", "Folder for the project; default: this one.")]


class _NameOptions(Group):
    """How the program is called."""

    PANEL: ClassVar[str] = "Name"
    name: Annotated[
        str | None, Option("--name", metavar="NAME", help="Name of the program; default: that of the folder.")
    ] = None


def init(folder: _Folder, options: TemplateOptions, naming: _NameOptions) -> None:
    """Put a job that runs into an existing folder, as 'robolang new' does, and overwrite nothing.

    A README, CI workflow or editor setting that the folder has is kept.

    Example: robolang init --template tend --name press2

    Exit codes: 0 done; 2 the template, the robot, the folder or the name cannot be used, or the template does not fit
    the robot; 4 a file of that name exists or cannot be written.
    """
    where = Path() if folder is None else folder
    if not where.is_dir():
        raise OptionValueError("FOLDER", f"'{where}' is not a folder; 'robolang new {where.name}' makes one")
    with reported():
        from robolang.templates.writing import init_project

        name = naming.name if naming.name is not None else where.resolve().name
        tell(init_project(where, name, options.template, options.robot))
