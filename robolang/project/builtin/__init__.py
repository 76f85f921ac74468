"""What a program runs on when its folder has no cell file: the default robot, a hand, a table and a part."""

from pathlib import Path

# importlib.resources would import tempfile and zipfile: 6 ms of every check
_FOLDER = Path(__file__).parent
POINTS = _FOLDER / "points.toml"
"""The taught points of the built-in cell."""


def cell_text() -> str:
    """Return the text of the built-in cell file, for ``runtime.cell.cell_file.parse_cell_file``."""
    return (_FOLDER / "cell.toml").read_text("utf-8")


def points_text() -> str:
    """Return the text of the built-in points, for ``robolang.project.points.read_points``."""
    return POINTS.read_text("utf-8")
