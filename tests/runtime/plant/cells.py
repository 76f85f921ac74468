"""The built-in cell with other parts and obstacles on its table, and short programs in it."""

from pathlib import Path

from robolang.project.builtin import cell_text
from robolang.project.project import load_project

POINTS = Path(__file__).parents[3] / "programs/pick_and_place.points.toml"
PART = """
[[parts]]
name = "{}"
size_mm = [{}, {}, {}]
mass_kg = {}
pose_mm_deg = [{}, {}, {}, 0, 0, 0]
friction = 0.6
"""
OBSTACLE = """
[[obstacles]]
name = "{}"
size_mm = [{}, {}, {}]
pose_mm_deg = [{}, {}, {}, 0, 0, 0]
"""
OWN = ("part", 60, 40, 80, 1.5, 480, -220, 640)
FIRST = "LOAD (0, 0, 60), 0.8\n"
GRIP = "MOVE P1\nHAND ON\nLOAD (0, 0, 95), 2.3\n"
LEDGE = OBSTACLE.format("ledge", 100, 20, 61, 480, -120, 630.5)
POST = OBSTACLE.format("post", 20, 200, 130, 540, -220, 665)
LET_GO = "HAND OFF\nLOAD (0, 0, 60), 0.8\n"
BESIDE = "MOVE P5 + (0, 80, 0)\nMOVE P1 + (0, 80, 0)\n"
"""With the open fingers 12 mm from the part, one after the other in y; the moves that follow are in line 4."""


def job(folder, text, *parts, obstacles="", grip_force_n=120):
    """Return the project of a program in a cell with these parts and obstacles; the text begins in line 2."""
    whole = cell_text()
    head, tail = whole[: whole.index("# Steel, ")], whole[whole.index("[loads.empty]") :]
    cell_toml = head + obstacles + "".join(PART.format(*part) for part in parts) + tail
    cell_toml = cell_toml.replace("grip_force_n = 120", f"grip_force_n = {grip_force_n}")
    (folder / "p.rbl").write_text(FIRST + text)
    (folder / "p.cell.toml").write_text(cell_toml)
    (folder / "p.points.toml").write_text(POINTS.read_text("utf-8"))
    project = load_project(folder / "p.rbl")
    assert project.ok, project.diagnostics
    return project
