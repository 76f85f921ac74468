"""What a program runs on when its folder has no cell file: the default robot, a hand, a table and a part."""

from importlib import resources


def cell_text() -> str:
    """Return the text of the built-in cell file, for ``runtime.cell.cell.parse_cell``."""
    return resources.files(__name__).joinpath("cell.toml").read_text("utf-8")
