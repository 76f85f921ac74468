"""What runs MuJoCo has the marker ``physics``, so that ``make test-ideal`` leaves it out.

There, the model of MuJoCo refuses to be made (``tests/conftest.py``). Here, a module that makes the plant or its
shapes has the marker.
"""

import ast
from pathlib import Path

from tests.arch.parsed import nodes, nodes_of
from tests.together import together

TESTS = Path(__file__).parents[1]
MODULES = [path for path in sorted(TESTS.rglob("test_*.py")) if path != Path(__file__)]


def names_the_plant(found: list[ast.AST]) -> bool:
    """Return whether a module imports mujoco or calls the plant or its shapes; names in a text do not count."""
    for node in found:
        if isinstance(node, ast.Import) and any(alias.name == "mujoco" for alias in node.names):
            return True
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("MujocoPlant", "Shapes", "CellModel.of")):
            return True
    return False


@together("path", MODULES, ids=lambda path: path.relative_to(TESTS).as_posix())
def test_what_makes_the_plant_of_mujoco_has_the_marker(path):
    text = path.read_text("utf-8")
    assert "mark.physics" in text or not names_the_plant(nodes_of(path))


def test_the_plant_is_found():
    assert names_the_plant(nodes("import mujoco"))
    assert names_the_plant(nodes("plant = mujoco_plant.MujocoPlant(spec, cell, 1e-3)"))
    assert names_the_plant(nodes("shapes = Shapes(spec, cell)"))
    assert not names_the_plant(nodes("heavy = ('numpy', 'mujoco')\nname = 'MujocoPlant'"))
