"""No test depends on how fast the machine is: none reads a clock, and what ends a hang waits for a minute at least.

What measures times, and fails no test by them, is listed in ``MEASURING``.
"""

import ast
import os
from pathlib import Path

import pytest

from tests import steps
from tests.arch import parsed
from tests.arch.parsed import nodes_of
from tests.together import together

TESTS = Path(__file__).parents[1]
CLOCKS = {
    "time": {"time", "monotonic", "perf_counter", "process_time", "thread_time", "sleep", "clock_gettime"},
    "os": {"times"},
    "resource": {"getrusage"},
    "timeit": {"timeit", "repeat", "default_timer", "Timer"},
    "datetime": {"datetime", "date"},
    "asyncio": {"sleep", "wait_for", "timeout"},
    "threading": {"Timer"},
}
"""Functions that read a clock or wait for one, by module; those that end in ``_ns`` too."""
MEASURING = {
    "bench/check.py",
    "bench/gcode_campaign.py",
    "bench/inertia.py",
    "bench/live.py",
    "bench/long_path.py",
    "bench/pages.py",
    "bench/prompt.py",
    "bench/pulse_campaign.py",
    "bench/run.py",
    "bench/wrist_campaign.py",
    "processor_time.py",
}
WAITS = {"timeout", "deadline", "timeout_seconds"}
LEAST_S = 60
"""The shortest time that may end a hang."""


def clock(module: str | None, name: str) -> bool:
    return name.removesuffix("_ns") in CLOCKS.get(module or "", ())


def faults(nodes: list[ast.AST]) -> list[str]:
    """Return what in a module depends on the speed of the machine, with its lines."""
    modules = {"time": "time", "os": "os", "resource": "resource"}
    found = []
    for node in nodes:
        if isinstance(node, ast.Import):
            modules |= {alias.asname or alias.name: alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found += [f"{node.lineno}: {alias.name}" for alias in node.names if clock(node.module, alias.name)]
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if clock(modules.get(node.value.id), node.attr):
                found.append(f"{node.lineno}: {node.value.id}.{node.attr}")
        elif isinstance(node, ast.Call):
            found += [f"{node.lineno}: {word.arg}" for word in node.keywords if short(word)]
            if isinstance(node.func, ast.Attribute) and node.func.attr in ("alarm", "setitimer"):
                found += [
                    f"{node.lineno}: alarm" for each in node.args[:1] if too_short(each) and ast.unparse(each) != "0"
                ]
        elif isinstance(node, ast.FunctionDef):
            at_the_end = zip(reversed(node.args.args), reversed(node.args.defaults), strict=False)
            by_name = zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
            found += [
                f"{node.lineno}: {name.arg}"
                for name, value in (*at_the_end, *by_name)
                if name.arg in WAITS and too_short(value)
            ]
    return found


def short(word: ast.keyword) -> bool:
    """Return whether an argument ends something before a minute; a deadline of Hypothesis must be None."""
    if word.arg == "deadline":
        return not (isinstance(word.value, ast.Constant) and word.value.value is None)
    return word.arg in WAITS and too_short(word.value)


def too_short(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Constant) and isinstance(value.value, int | float) and not value.value >= LEAST_S


@together("name", sorted(path.relative_to(TESTS).as_posix() for path in TESTS.rglob("*.py")))
def test_no_test_reads_a_clock_or_ends_a_wait_early(name):
    found = faults(nodes_of(TESTS / name))
    assert bool(found) == (name in MEASURING), found


def test_what_ends_a_hang_is_no_measure_of_speed():
    assert steps.HANG_S >= LEAST_S


def test_a_hang_is_a_failed_test(tmp_path, monkeypatch):
    monkeypatch.setattr(steps, "HANG_S", 1)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(AssertionError, match="still waits"), steps.guarded():
        (tmp_path / "pipe").open()


@pytest.mark.parametrize(
    "text",
    [
        "import time\nbegan = time.process_time()",
        "import time as t\nt.sleep(1)",
        "from time import perf_counter_ns",
        "from datetime import datetime",
        "import os\nos.times()",
        "import resource\nresource.getrusage(0)",
        "import subprocess\nsubprocess.run([], timeout=30)",
        "process.communicate(timeout=59.9)",
        "def shell(*words, cwd=None, timeout=30): pass",
        "@settings(deadline=200)\ndef f(): pass",
        "from signal import *\nsignal.alarm(5)",
        "event.wait(timeout=0.5)",
    ],
)
def test_a_clock_is_found(text):
    assert len(faults(parsed.nodes(text))) == 1


@pytest.mark.parametrize(
    "text",
    [
        "import time\ntime.strftime('%Y')",
        "run(timeout=60)",
        "run(timeout=HANG_S)",
        "signal.alarm(0)",
        "@settings(deadline=None)\ndef f(): pass",
        "Wait(condition=x, timeout=None)",
        "spec.per_axis('limits', 'speed')",
    ],
)
def test_no_clock_is_no_fault(text):
    assert faults(parsed.nodes(text)) == []
