"""A run adds in one order on every processor: no sum of it is left to OpenBLAS (runtime/core/linear.py)."""

import ast
from pathlib import Path

import pytest

from tests.arch.parsed import nodes, nodes_of
from tests.together import together

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "runtime").rglob("*.py"))
NUMPY = {"dot", "matmul", "inner", "vdot", "tensordot", "convolve", "correlate", "polyfit"}
ALLOWED = {
    ("runtime/robot/kinematics/closed_form.py", "linalg.cond"),  # whether lines meet, decided far from the bound
    (
        "runtime/robot/model/spec.py",
        "linalg.eigvalsh",
    ),  # whether an inertia is refused; a file that is read needs no Eigen
    ("runtime/robot/files/body_plausibility.py", "linalg.eigvalsh"),  # whether a warning is given
    ("runtime/robot/files/corrections.py", "linalg.eigvalsh"),  # whether a moment is missing altogether
    ("runtime/plant/mjcf.py", "linalg.det"),  # the sign of 1 or -1
    ("runtime/pulses/manifest.py", "linalg.det"),  # the same
    ("runtime/motion/wrist/hold.py", "convolve"),  # of ones: whole numbers, exact in any order
    ("runtime/dynamics/payload_identification.py", "convolve"),  # the same
}


def left_to_the_processor(found):
    """Yield line and name of every operation of a module whose order of summation numpy leaves to OpenBLAS."""
    calls = [node for node in found if isinstance(node, ast.Call)]
    with_axis = {node.func for node in calls if any(key.arg == "axis" for key in node.keywords)}
    for node in found:
        if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.MatMult):
            yield node.lineno, "@"
        elif isinstance(node, ast.Attribute):
            owner = ast.unparse(node.value)
            # a length along an axis is added as np.sum does; without an axis it is a scalar product
            if owner == "np.linalg" and not (node.attr == "norm" and node in with_axis):
                yield node.lineno, f"linalg.{node.attr}"
            elif owner == "np" and node.attr in NUMPY:
                yield node.lineno, node.attr


@together("file", FILES, ids=lambda file: file.relative_to(ROOT).as_posix())
def test_a_run_leaves_no_sum_to_the_processor(file):
    name = file.relative_to(ROOT).as_posix()
    found = [each for each in left_to_the_processor(nodes_of(file)) if (name, each[1]) not in ALLOWED]
    assert not found


def test_every_exception_is_used():
    there = {
        (file.relative_to(ROOT).as_posix(), what) for file in FILES for _, what in left_to_the_processor(nodes_of(file))
    }
    assert there >= ALLOWED


@pytest.mark.parametrize(
    "text", ["A @ B", "A @= B", "np.dot(a, b)", "np.linalg.solve(A, b)", "np.linalg.norm(v)", "f(np.matmul)"]
)
def test_what_leaves_a_sum_to_the_processor_is_found(text):
    assert list(left_to_the_processor(nodes(text)))


@pytest.mark.parametrize("text", ["a * b", "np.linalg.norm(v, axis=1)", "np.einsum('ij,j->i', A, b)", "this.dot(b)"])
def test_what_adds_in_one_order_is_not(text):
    assert not list(left_to_the_processor(nodes(text)))
