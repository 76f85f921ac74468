"""The files that stand beside a program: which cell it runs in and which points it may use.

``NAME.rbl`` takes ``NAME.cell.toml``, else ``cell.toml`` of its folder, and ``NAME.points.toml``. With no cell and no
points it gets the built-in ones (docs/language.md). A link that leads nowhere is there all the same: it is reported,
not passed over. Imports no numpy: ``robolang check`` uses this too.
"""

import os
from importlib import resources
from pathlib import Path

from robolang.points import PointStore, load_points


def cell_beside(program: Path) -> Path | None:
    """Return the cell file of a program; None when it has none and runs in the built-in cell."""
    for candidate in (program.with_suffix(".cell.toml"), program.with_name("cell.toml")):
        if os.path.lexists(candidate):
            return candidate
    return None


def taught_points(program: Path, *, builtin: bool, robot: str | None = None, axes: int | None = None) -> PointStore:
    """Return the points of a program; ``FileFault`` RBL30x or RBL311 for a file that cannot be used.

    ``builtin``: without a file of its own it has the built-in points, not none; ``robot`` and ``axes`` as for
    ``load_points``.
    """
    beside = program.with_suffix(".points.toml")
    if os.path.lexists(beside):
        return load_points(beside, robot=robot, axes=axes)
    if not builtin:
        return PointStore(path=str(beside))
    with resources.as_file(resources.files("robolang.builtin").joinpath("points.toml")) as path:
        return load_points(path, axes=axes)
