"""Every limit of a run, at the limit and one beyond it; those of the text are in ``test_parse_errors``."""

import math
import re

import pytest

from robolang.analysis.checker import check
from robolang.core.diagnostics import Severity
from robolang.evaluation.evaluator import MAX_TEXT
from robolang.execution import run_bounds
from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.interpreter import run_limits
from robolang.interpreter.run_limits import MAX_CALLS, MAX_ROUNDS
from robolang.interpreter.scope import MAX_CELLS, MAX_TEXTS
from robolang.project.project import load_project
from robolang.syntax.parser import parse
from runtime.core import limits
from runtime.core.faults import Fault, lookup
from runtime.core.limits import SIZE
from tests.messages import numbers
from tests.robolang.helpers import source
from tests.robolang.running import World, execute, fault, ran

MAX_ELEMENTS = int(SIZE.high) + 1

LONG = f't$ = "{"x" * (MAX_TEXT // 2)}"\nt$ = t$ + t$\n'
FULL = LONG + f"DIM a$(2000)\nFOR i = 1 TO {MAX_TEXTS // MAX_TEXT - 1}\na$(i) = t$\nNEXT\n"
ARRAYS = "".join(f"DIM a{k}({MAX_ELEMENTS - 1})\n" for k in range(MAX_CELLS // MAX_ELEMENTS - 1))


@pytest.mark.parametrize(
    ("code", "inside", "beyond"),
    [
        ("RBL506", LONG, LONG + 't$ = t$ + "x"'),
        ("RBL506", FULL + 'b$ = ""', FULL + 'b$ = "x"'),
        ("RBL506", FULL + 'a$(2) = ""\nb$ = t$', FULL + "CALL s(t$)\nSUB s(b$)\nENDSUB"),
        ("RBL507", f"DIM a({MAX_ELEMENTS - 1})", f"DIM a({MAX_ELEMENTS})"),
        ("RBL507", ARRAYS + f"DIM b({MAX_ELEMENTS - 2})\nx = 1", ARRAYS + f"DIM b({MAX_ELEMENTS - 1})\nx = 1"),
        ("RBL502", f"FOR i = 1 TO {MAX_ROUNDS:.0f}\nEND\nNEXT", f"FOR i = 0 TO {MAX_ROUNDS:.0f}\nEND\nNEXT"),
        ("RBL405", "DELAY 86400", "n = 86401\nDELAY n"),
        ("RBL405", "PULSE 1, 86400", "n = 86401\nPULSE 1, n"),
        ("RBL405", "WAIT 1, TIMEOUT 86400", "n = 86401\nWAIT 1, TIMEOUT n"),
        ("RBL534", "n = 1024\nOUT(n) = 1", "n = 1025\nOUT(n) = 1"),
    ],
)
def test_a_limit_of_values(code, inside, beyond):
    ran(inside)
    assert fault(beyond).code == code


@pytest.mark.parametrize(
    ("name", "code", "text"),
    [
        ("MAX_STEPS", "RBL505", "DELAY 1\n"),
        ("MAX_SHOWN", "RBL506", "PRINT\n"),
        ("MAX_LOOPS", "RBL504", "FOR i{} = 1 TO 2\nGOTO *L{}\nNEXT\n*L{}\n"),
    ],
)
def test_a_limit_of_the_run(name, code, text, monkeypatch):
    """Counts that take long to reach, with a smaller limit in their place."""
    monkeypatch.setattr(run_limits, name, 20)
    within, beyond = ("".join(text.format(k, k, k) for k in range(count)) for count in (20, 21))
    ran(within)
    assert fault(beyond).code == code


def test_calls_and_gosubs():
    recursive = "SUB f(n)\nIF n > 1 THEN CALL f(n - 1)\nENDSUB\n"
    ran(f"CALL f({MAX_CALLS})\n{recursive}")
    assert fault(f"CALL f({MAX_CALLS + 1})\n{recursive}").code == "RBL504"
    chain = "".join(f"*S{k} GOSUB *S{k + 1}\nRETURN\n" for k in range(1, MAX_CALLS + 1))
    ran(chain.replace("*S1 GOSUB *S2\nRETURN\n", "GOSUB *S2\nEND\n") + f"*S{MAX_CALLS + 1} RETURN\n")
    assert fault(f"GOSUB *S1\nEND\n{chain}*S{MAX_CALLS + 1} RETURN\n").code == "RBL504"


def in_a_cell(tmp_path, text):
    path = tmp_path / "p.rbl"
    path.write_text(text)
    return load_project(path)


@pytest.mark.parametrize(("seconds", "good"), [(0.392, True), (0.4, False)])
def test_simulated_time(tmp_path, monkeypatch, seconds, good):
    """A run and its rehearsal end at the same cycle; 0.4 s in place of half an hour."""
    monkeypatch.setattr(run_bounds, "MAX_RUN_US", 400_000)
    project = in_a_cell(tmp_path, f"DELAY {seconds}\n")
    result = Session(project, physics=False).run()
    assert [alarm["code"] for alarm in result.report["alarms"]] == ([] if good else ["RBL509"])
    assert [item.code for item in rehearse(project).refused] == ([] if good else ["RBL509"])


def test_no_handler_outlives_the_simulated_time(tmp_path, monkeypatch):
    monkeypatch.setattr(run_bounds, "MAX_RUN_US", 400_000)
    project = in_a_cell(tmp_path, "ON ERROR GOTO *H\n*TOP DELAY 0.08\nGOTO *TOP\n*H RESUME NEXT\n")
    found = rehearse(project, every_round=True)
    assert [item.code for item in found.refused] == ["RBL509"]
    assert found.total_us == 400_000


RANGES = [each for each in vars(limits).values() if isinstance(each, limits.Limit)]


@pytest.mark.parametrize("limit", RANGES, ids=lambda limit: limit.name)
def test_the_remedy_of_a_range_states_its_end(limit):
    """SPEED ends at the robot's, which a page for all robots cannot state."""
    if limit is not limits.SPEED:
        assert f"{limit.high:.10g}" in re.findall(r"\d+", lookup(limit.code).remedy)


@pytest.mark.parametrize("limit", RANGES, ids=lambda limit: limit.name)
def test_every_range_holds_its_ends_and_nothing_beyond(limit):
    least = 0.5 if limit.above else limit.low
    assert limit.fault(least) is limit.fault(limit.high) is None
    beyond = (
        limit.low - 1.0,
        limit.low if limit.above else limit.low - 1e-9,
        limit.high * (1 + 1e-9),
        math.nan,
        math.inf,
        -math.inf,
        *([1.5] if limit.whole else []),
    )
    assert {limit.fault(value).code for value in beyond} == {limit.code}
    assert limit.fault(limit.high, limit.high / 2).code == limit.code
    assert limit.fault(limit.high / 4, math.nan if limit.whole else limit.high / 2) is None or limit.whole


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("MOVE P1, SPEED {}", "RBL404"),
        ("MOVEJ P1, SPEED {}", "RBL404"),
        ("MOVE P1, ACCEL {}", "RBL404"),
        ("MOVE P1, TIME {}", "RBL404"),
        ("MOVE P1, ZONE {}", "RBL415"),
        ("ZONE {}", "RBL415"),
        ("SPEED {}", "RBL404"),
        ("OVERRIDE {}", "RBL404"),
        ("APPROACH P1, {}", "RBL404"),
        ("DEPART {}", "RBL404"),
        ("HAND ON, {}", "RBL405"),
        ("DELAY {}", "RBL405"),
        ("PULSE 1, {}", "RBL405"),
        ("OUT({}) = 1", "RBL534"),
        ("DIM a({})", "RBL507"),
        ("WAIT 1, TIMEOUT {}", "RBL405"),
    ],
)
@pytest.mark.parametrize("value", ["0 - 1", "1E8", "NAN", "INF"])
def test_check_and_a_run_judge_a_value_alike(text, code, value):
    """As a constant it is refused by check, out of a variable by the run, with one code."""
    program = parse(source(text.format(value))).program
    assert [item.code for item in check(program) if item.severity is Severity.ERROR] == [code]
    with pytest.raises(Fault) as caught:
        list(execute(parse(source(f"v = {value}\n{text.format('v')}")).program, points=("P1",)))
    assert caught.value.code == code


AT_AN_END = [
    ("MOVE P1, ACCEL {}", limits.ACCEL),
    ("MOVE P1, TIME {}", limits.TIME),
    ("MOVE P1, ZONE {}", limits.ZONE),
    ("MOVEJ P1, SPEED {}", limits.SPEED_PCT),
    ("SPEEDJ {}", limits.SPEEDJ),
    ("OVERRIDE {}", limits.OVERRIDE),
    ("HAND ON, {}", limits.DWELL),
    ("DELAY {}", limits.DELAY),
    ("PULSE 1, {}", limits.PULSE),
    ("WAIT 1, TIMEOUT {}", limits.TIMEOUT),
    ("OUT({}) = 1", limits.OUTPUT),
    ("x = IN({})", limits.INPUT),
    ("DIM a({})", limits.SIZE),
]


def beside_the_ends(limit):
    """The ends of a range, the numbers next to them, and NaN."""
    low, high = limit.low, limit.high
    return (low, math.nextafter(low, -math.inf), math.nextafter(low, 1), high, math.nextafter(high, math.inf), math.nan)


def written(value):
    return "NAN" if math.isnan(value) else f"0 - {-value:.17g}" if value < 0.0 else f"{value:.17g}"


@pytest.mark.parametrize(("text", "limit"), AT_AN_END, ids=[text for text, _ in AT_AN_END])
def test_check_and_a_run_agree_at_the_ends(text, limit):
    world = World()
    world.inputs = {1: 0.0, 1024: 0.0}
    for value in beside_the_ends(limit):
        refused = value != value or limit.fault(value) is not None
        found = check(parse(source(text.format(written(value)))).program)
        assert [item.code for item in found if item.severity is Severity.ERROR] == [limit.code] * refused, value
        program = parse(source(f"v = {written(value)}\n{text.format('v')}")).program
        if refused:
            with pytest.raises(Fault) as caught:
                list(execute(program, world, points=("P1",)))
            assert caught.value.code == limit.code, value
        else:
            list(execute(program, world, points=("P1",)))


PUMA_MM_S, PUMA_KG, FARTHEST_MM = 1000.0, 2.5, 2000.0
"""Greatest speed and rated payload of the robot, and the farthest centre of gravity."""


@pytest.mark.parametrize(
    ("text", "value", "code"),
    [
        ("MOVE POSE(400, 0, 300, 0, 180, 0), SPEED {}", PUMA_MM_S, ""),
        # less than conversions to SI and back may add
        ("MOVE POSE(400, 0, 300, 0, 180, 0), SPEED {}", math.nextafter(PUMA_MM_S, math.inf), ""),
        ("MOVE POSE(400, 0, 300, 0, 180, 0), SPEED {}", PUMA_MM_S * (1.0 + 1e-9), "RBL404"),
        ("MOVE POSE(400, 0, 300, 0, 180, 0), SPEED {}", math.nan, "RBL404"),
        ("LOAD (0, 0, 60), {}", PUMA_KG, ""),
        ("LOAD (0, 0, 60), {}", math.nextafter(PUMA_KG, math.inf), "RBL402"),
        ("LOAD (0, 0, 60), {}", -5e-324, "RBL401"),
        ("LOAD (0, 0, 60), {}", math.nan, "RBL401"),
        ("LOAD (0, 0, {}), 1", FARTHEST_MM, ""),
        ("LOAD (0, 0, {}), 1", FARTHEST_MM * (1.0 + 1e-12), "RBL403"),
        ("LOAD (0, 0, {}), 1", math.nan, "RBL403"),
        ("LOAD (0, 0, 60), 1, (0.01, 0.01, {}, 0, 0, 0)", 0.02, ""),
        ("LOAD (0, 0, 60), 1, (0.01, 0.01, {}, 0, 0, 0)", 0.0200001, "RBL403"),
        ("LOAD (0, 0, 60), 1, (0.01, 0.01, {}, 0, 0, 0)", math.nan, "RBL403"),
        ("x = IN({})", 1.0, "RBL534"),
        ("x = IN({})", 0.5, "RBL534"),
        ("x = IN({})", math.nan, "RBL534"),
    ],
)
def test_check_and_a_run_agree_at_the_limits_of_the_robot(tmp_path, text, value, code):
    """A constant is judged by check, the same value out of a variable by the dry run."""
    known = in_a_cell(tmp_path, f"{text.format(written(value))}\n")
    judged = in_a_cell(tmp_path, f"v = {written(value)}\n{text.format('v')}\n")
    expected = [code] if code else []
    assert [item.code for item in known.diagnostics if item.severity is Severity.ERROR] == expected
    assert [item.code for item in judged.diagnostics if item.severity is Severity.ERROR] == []
    assert [item.code for item in rehearse(judged).refused] == expected


def test_remedies_give_the_limits_of_the_table():
    """A number in a remedy of a range is one of the ends of a range with that code."""
    ends: dict[str, set[float]] = {}
    for limit in vars(limits).values():
        if isinstance(limit, limits.Limit):
            ends.setdefault(limit.code, set()).update((limit.low, limit.high))
    for code in ("RBL404", "RBL405", "RBL415"):
        assert set(numbers(lookup(code).remedy)) <= ends[code] | {0.0}
        assert max(ends[code] - {10_000.0}) in numbers(lookup(code).remedy)
    for code in ("RBL507", "RBL534"):
        assert max(ends[code]) in numbers(lookup(code).remedy)
