"""Limits are compared so that NaN fails them: ``if not x <= limit: refuse``, never ``if x > limit: refuse``.

Every ordered comparison with NaN is false, so the second form lets NaN pass; and Python's ``max(1.0, nan)`` is 1.0. The
source is searched for both, and for masks of bad rows. What the source shows to be a whole number cannot be NaN and is
left out; the rest is listed with the reason.
"""

import ast
import importlib
import re
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest

from tests.arch.parsed import nodes, nodes_of

ROOT = Path(__file__).parents[2]
FOLDERS = ("robolang", "runtime", "tests/bench", "tests/faults")
FILES = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
ORDERED = ast.Lt | ast.Gt | ast.LtE | ast.GtE
REFUSING = re.compile(r"_?(Fault|FileFault|Alarm|Diagnostic|Finding|Verdict|fail|alarm|refuse\w*|warn\w*|_at|at)")
MASKS = {"bad", "out", "outside", "over", "beyond", "lost", "wrong"}
MEASURE = re.compile(r"\w+_(mm|deg|pct|hz)|speed|acceleration|jerk|ratio|length|angle|deviation|duration|error")

FILE = "read from a file, and what is read is finite"
WHOLE = "whole numbers"
OPEN = {
    "robolang/analysis/checker.py: line.number < previous": WHOLE,
    "robolang/testing/golden.py: size < _END.size": WHOLE,
    "robolang/interpreter/control_flow.py: rounds > run_limits.MAX_ROUNDS": "the language has no NaN",
    "runtime/cell/signals.py: round(seconds * 1000000.0) <= changes[-1][0]": WHOLE,
    "runtime/pulses/folder.py: steps > self._steps_left": WHOLE,
    "runtime/robot/files/corrections.py: mass > 0.0": FILE,
    "runtime/robot/files/corrections.py: mass > TOKEN_MASS": FILE,
    "runtime/robot/files/corrections.py: moments > 0.0": FILE,
    "runtime/robot/files/corrections.py: moments > TOKEN_INERTIA": FILE,
    "runtime/robot/files/corrections.py: published.mass > 0.0": FILE,
    "runtime/robot/files/mjcf_import.py: geom.number('mass', 1.0, low=0.0) > 0.0": FILE,
    "runtime/robot/model/load_rules.py: moments[0] < 0.0": "refused in either case, NaN before it",
    "runtime/supervision/supervisor.py: self._late >= self._limits.overruns": WHOLE,
}
"""Refusals by an open comparison, with what makes NaN impossible or harmless there."""

REACH = "NaN is out of reach, which is a condition of its own"
JUMPED = "a speed that is NaN has jumped, which is judged in the same tick"
MASKED = {
    "runtime/motion/wrist/switch.py: away > SAME_ANGLES": REACH,
    "runtime/motion/wrist/switch.py: wrist < limits.lower": REACH,
    "runtime/motion/wrist/switch.py: wrist > limits.upper": REACH,
    "runtime/supervision/tick_monitor.py: away[k, 3] > CATCH_UP * command": JUMPED,
    "runtime/supervision/tick_monitor.py: command > self._fast": JUMPED,
}
"""Masks of bad rows by an open comparison, with the reason."""

PLANNED = "of moves that are planned: theirs is finite"
SOLVED = "no solution of the inverse kinematics has a NaN"
EXTREMES = {
    "robolang/cli/commands/export.py: max((move['highest_hz'] for move in moves), default=0)": WHOLE,
    "robolang/experiments/compare.py: max(settled, float(t[stop + outside[-1] + 1] - t[stop]))": "times of ticks",
    "robolang/pulse_tables/plots.py: max(float(x[-1] - x[0]), 1e-09)": "a width of a drawing",
    "runtime/pulses/mechanism.py: min(joint.acceleration, _FAST)": FILE,
    "runtime/pulses/mechanism.py: min(joint.speed, _FAST)": FILE,
    "runtime/pulses/move.py: min(limits.speed, math.sqrt(limits.acceleration))": PLANNED,
    "runtime/motion/joint_planner.py: max(fitting, key=lambda q: float(kinematics.limit_margin(q)))": SOLVED,
}
"""``max`` and ``min`` of measures, with the reason."""


@cache
def constants(path):
    """Names of a module that are whole numbers, and those of the modules that it imports, as ``module.NAME``."""
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    names = vars(importlib.import_module(name))
    found = {f"{key}.": vars(value) for key, value in names.items() if isinstance(value, ModuleType)}
    return {
        prefix + key for prefix, held in ({"": names} | found).items() for key in held if isinstance(held[key], int)
    }


def called(node):
    """The name that a call is of; ``""`` for what is no call."""
    function = node.func if isinstance(node, ast.Call) else None
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def refuses(body):
    """Whether statements refuse something: raise, or make or report a fault, an alarm or a finding."""
    nodes = [node for statement in body for node in ast.walk(statement)]
    return any(isinstance(node, ast.Raise) or REFUSING.fullmatch(called(node)) for node in nodes)


def open_comparisons(test):
    """Yield the ordered comparisons by which a condition becomes true; those under ``not`` and ``~`` are left out."""
    if isinstance(test, ast.BoolOp):
        parts = test.values
    elif isinstance(test, ast.BinOp) and isinstance(test.op, ast.BitOr | ast.BitAnd):
        parts = [test.left, test.right]
    elif isinstance(test, ast.Call):  # (x > most).any(), bool(x > most), any(x > most for x in found)
        parts = [*test.args, *([test.func.value] if isinstance(test.func, ast.Attribute) else [])]
    elif isinstance(test, ast.GeneratorExp):
        parts = [test.elt]
    else:
        parts = []
    for part in parts:
        yield from open_comparisons(part)
    if isinstance(test, ast.Compare) and any(isinstance(each, ORDERED) for each in test.ops):
        yield test


def whole(comparison, path):
    """Whether the source shows that a comparison is of whole numbers."""
    return any(
        called(side) in ("len", "int", "count")
        or (isinstance(side, ast.Constant) and isinstance(side.value, int))
        or ast.unparse(side) in constants(path)
        or (isinstance(side, ast.Attribute) and (side.attr.endswith("_us") or side.attr == "st_size"))
        for side in (comparison.left, *comparison.comparators)
    )


def key(path, node):
    return f"{path.relative_to(ROOT)}: {ast.unparse(node)}"


def open_refusals(path, found):
    for node in found:
        if isinstance(node, ast.If) and refuses(node.body):
            yield from (key(path, each) for each in open_comparisons(node.test) if not whole(each, path))


def open_masks(path, found):
    for node in found:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id in MASKS:
            yield from (key(path, each) for each in open_comparisons(node.value) if not whole(each, path))


def measures(node):
    """Whether an expression is of measured numbers: ``float()``, numpy, a name with a unit."""
    return any(
        called(each) == "float"
        or (isinstance(each, ast.Name) and each.id == "np")
        or (isinstance(each, ast.Attribute) and MEASURE.fullmatch(each.attr))
        or (isinstance(each, ast.Constant) and isinstance(each.value, str) and MEASURE.fullmatch(each.value))
        for each in ast.walk(node)
    )


def blind_extremes(path, found):
    for node in found:
        if isinstance(node, ast.Call) and called(node) in ("max", "min") and isinstance(node.func, ast.Name):
            guarded = any(item.arg == "key" and "badness" in ast.unparse(item.value) for item in node.keywords)
            if (
                measures(node)
                and not guarded
                and not any(called(each) in ("len", "int") for argument in node.args for each in ast.walk(argument))
            ):
                yield key(path, node)


RULES = {
    "open_refusals": (open_refusals, OPEN),
    "open_masks": (open_masks, MASKED),
    "blind_extremes": (blind_extremes, EXTREMES),
}


@pytest.mark.parametrize("rule", RULES)
def test_nan_passes_no_limit(rule):
    find, known = RULES[rule]
    found = [each for path in FILES for each in find(path, nodes_of(path))]
    assert set(found) - set(known) == set(), "NaN passes here: write 'not x <= limit', key=badness or np.maximum"
    assert set(known) - set(found) == set(), "listed and not there any more"


@pytest.mark.parametrize(
    ("rule", "text"),
    [
        ("open_refusals", "if x > limit:\n    raise Fault('RBL404')"),
        ("open_refusals", "if known and (x > limit).any():\n    self.fail('no')"),
        ("open_refusals", "if any(x > limit for x in found):\n    findings.append(Diagnostic())"),
        ("open_masks", "bad = (q > upper) | (q < lower)"),
        ("blind_extremes", "worst = max(a.error_mm, b.error_mm)"),
        ("blind_extremes", "worst = max(1.0, float(x.max()))"),
    ],
)
def test_what_nan_would_pass_is_noticed(rule, text):
    assert list(RULES[rule][0](FILES[0], nodes(text)))


@pytest.mark.parametrize(
    ("rule", "text"),
    [
        ("open_refusals", "if not x <= limit:\n    raise Fault('RBL404')"),
        ("open_refusals", "if not (x <= limit).all() or len(x) > 3:\n    self.fail('no')"),
        ("open_refusals", "if x > limit:\n    slow = True"),
        ("open_masks", "bad = ~((lower <= q) & (q <= upper))"),
        ("blind_extremes", "worst = max((a.error_mm for a in rows), key=badness)"),
        ("blind_extremes", "worst = np.maximum(a.error_mm, b.error_mm)"),
    ],
)
def test_what_nan_would_fail_is_left_out(rule, text):
    assert not list(RULES[rule][0](FILES[0], nodes(text)))
