import math

import pytest

from robolang.evaluation.evaluator import MAX_SHIFTS, MAX_TEXT, Evaluator, Nowhere
from robolang.values.poses import Place, Shift
from runtime.core.faults import Fault
from tests.robolang.helpers import parsed


class World(Nowhere):
    """Inputs 1 and 2, the time, a place to be, and poses whose numbers are those they are written with."""

    def input(self, number):
        return {1: 1.0, 2: 0.0}[number]

    def seconds(self):
        return 12.5

    def here(self):
        return 1.0, 2.0, 3.0, 4.0, 5.0, 6.0

    def components(self, place, frame):
        base = place.pose or (100.0, 200.0, 300.0, 10.0, 20.0, 30.0)
        moved = [base[axis] + sum(shift.by[axis] for shift in place.shifts) for axis in range(6)]
        return tuple(moved)


class Names:
    def __init__(self, **values):
        self.values = values

    def value(self, key):
        return self.values.get(key)

    def element(self, key, index):
        return [10.0, 11.0][index] if key == "A" else None


def tree(text):
    (line,) = parsed(f"v$ = {text}").lines
    return line.statement.value


def evaluator(**values):
    return Evaluator(Names(P1=Place(point="P1"), P2=Place(pose=(0.0,) * 6), X=0.0, Y=7.0, **values), World())


def value(text):
    return evaluator().value(tree(text))


def fault(text):
    with pytest.raises(Fault) as caught:
        value(text)
    return caught.value.code


def shape(node):
    """An expression with every pair of parentheses written."""
    name = type(node).__name__
    if name == "Chain":
        return "(" + " ".join([shape(node.first), *(f"{sign} {shape(part)}" for sign, part in node.rest)]) + ")"
    if name in ("Not", "Negate"):
        return f"({'NOT ' if name == 'Not' else '-'}{shape(node.operand)})"
    return node.text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a OR b AND c", "(a OR (b AND c))"),
        ("a AND NOT b", "(a AND (NOT b))"),
        ("NOT a = b", "(NOT (a = b))"),
        ("NOT NOT a", "(NOT (NOT a))"),
        ("a + b < c - d", "((a + b) < (c - d))"),
        ("a <> b AND c <= d OR e >= f", "(((a <> b) AND (c <= d)) OR (e >= f))"),
        ("a + b * c", "(a + (b * c))"),
        ("a - b - c + d", "(a - b - c + d)"),
        ("a * b / c", "(a * b / c)"),
        ("a * b MOD c", "(a * b MOD c)"),
        ("a MOD b * c", "(a MOD b * c)"),
        ("a + b MOD c", "(a + (b MOD c))"),
        ("a XOR b OR c AND d", "(a XOR b OR (c AND d))"),
        ("NOT a XOR b = c", "((NOT a) XOR (b = c))"),
        ("a MOD b MOD c", "(a MOD b MOD c)"),
        ("-a MOD b", "((-a) MOD b)"),
        ("a MOD -b", "(a MOD (-b))"),
        ("-a ^ b", "(-(a ^ b))"),
        ("a ^ -b", "(a ^ (-b))"),
        ("a ^ b ^ c", "(a ^ b ^ c)"),
        ("- -a", "(-(-a))"),
        ("+a + +b", "(a + b)"),
        ("(a OR b) AND c", "((a OR b) AND c)"),
        ("(a + b) * c", "((a + b) * c)"),
        ("a - (b - c)", "(a - (b - c))"),
    ],
)
def test_how_signs_bind(text, expected):
    assert shape(tree(text)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2 + 3 * 4 ^ 2 MOD 5", 5.0),
        ("3 + 3 * (4 ^ 2 MOD 5)", 6.0),
        ("-2 ^ 2", -4.0),
        ("(-2) ^ 2", 4.0),
        ("2 ^ -1", 0.5),
        ("2 ^ 3 ^ 2", 512.0),
        ("10 - 4 - 3", 3.0),
        ("10 - (4 - 3)", 9.0),
        ("2 / 4 / 2", 0.25),
        ("7 / 2", 3.5),
        ("7 MOD 4 * 2", 6.0),
        ("2 * 7 MOD 4", 2.0),
        ("7 * 3 MOD 2", 1.0),
        ("7 * (3 MOD 2)", 7.0),
        ("10 / 4 MOD 3", 2.5),
        ("2 * 7 MOD 3", 2.0),
        ("-7 MOD 4", 1.0),
        ("7 MOD -4", -1.0),
        ("1E308 MOD 7", 1e308 % 7),
        ("5.5 MOD 2", 1.5),
        ("17 MOD 10 MOD 4", 3.0),
        ("3 XOR -1", 0.0),
        ("1 XOR 0", 1.0),
        ("0 XOR 0", 0.0),
        ("1 XOR 1 XOR 1", 1.0),
        ("1 OR 1 XOR 1", 0.0),
        ("0 XOR 1 OR 1 / 0", 1.0),
        ("0 AND 1 / 0 XOR 1", 1.0),
        ("NOT 1 = 2 OR 1", 1.0),
        ("NOT (1 = 2 OR 1)", 0.0),
        ("NOT NOT 5", 1.0),
        ("1 OR 0 AND 0", 1.0),
        ("(1 OR 0) AND 0", 0.0),
        ("5 AND -3", 1.0),
        ("1 + 1 = 2", 1.0),
        ("1 < 2", 1.0),
        ("2 < 2", 0.0),
        ("2 <= 2", 1.0),
        ("3 > 2", 1.0),
        ("2 >= 3", 0.0),
        ("2 <> 3", 1.0),
        ("1 OR 1 / 0", 1.0),
        ("0 AND 1 / 0", 0.0),
        ("ABS(-3) + ABS(2)", 5.0),
        ("SGN(-3) + 10 * SGN(0) + 100 * SGN(9)", 99.0),
        ("INT(-1.5)", -2.0),
        ("ROUND(2.5)", 3.0),
        ("ROUND(-2.5)", -3.0),
        ("ROUND(1.005 * 1000, -1)", 1010.0),
        ("ROUND(3.14159, 2)", 3.14),
        ("SQR(16)", 4.0),
        ("SIN(30)", 0.5),
        ("COS(60)", 0.5),
        ("TAN(45)", 1.0),
        ("ATN2(1, -1)", 135.0),
        ("DEG(RAD(90))", 90.0),
        ("RAD(180)", math.pi),
        ("MIN(3, 1, 2)", 1.0),
        ("MAX(3, 1, 2)", 3.0),
        ('VAL(" 1.5e2 ")', 150.0),
        ('LEN("abc")', 3.0),
        ("IN(1) + 2 * IN(2)", 1.0),
        ("TIMER", 12.5),
        ("ERR", 0.0),
        ("a(0) + a(Y - 6)", 21.0),
        ("DIST(P1, P1 + (3, 4, 0))", 5.0),
        ("P1.X + P1.RZ", 130.0),
        ("HERE.Y", 2.0),
        ("POSE(1, 2, 3, 4, 5, 6).RX", 4.0),
    ],
)
def test_values(text, expected):
    assert value(text) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('"a" + "b" + STR$(1.50)', "ab1.5"),
        ("STR$(-0.0)", "0"),
        ("STR$(1 / 3)", "0.3333333333"),
        ("STR$(1E300)", "1e+300"),
        ('"a" < "b"', 1.0),
        ('"a" = "A"', 0.0),
        ('"{0.__class__}"', "{0.__class__}"),
        ('"%s \' REM"', "%s ' REM"),
        ('""', ""),
    ],
)
def test_texts(text, expected):
    assert value(text) == expected


def test_poses():
    frame, tool = Shift(kind="frame", by=(1.0, 2.0, 3.0, 0.0, 0.0, 0.0)), (0.0, 0.0, 5.0, 90.0, 0.0, 0.0)
    assert value("P1 + (1, 2, 1 + 2)") == Place(point="P1", shifts=(frame,))
    assert value("P1 * (0, 0, 5, 90, 0, 0)") == Place(point="P1", shifts=(Shift(kind="tool", by=tool),))
    assert value("(P1 + (1, 2, 3)) * (0, 0, 5, 90, 0, 0)").shifts == (frame, Shift(kind="tool", by=tool))
    assert value("JOINT(1, 2, -3)") == Place(joints=(1.0, 2.0, -3.0))
    assert value("HERE") == Place(pose=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0))
    found = evaluator()
    found.frame = "BENCH"
    assert found.value(tree("POSE(1, 2, 3, 0, 0, 0)")).frame == "BENCH"
    assert found.value(tree("P1 + (1, 2, 3)")).shifts[0].frame == "BENCH"


def test_ways_along_the_same_axes_are_added_and_turns_are_not():
    assert value("P1 + (1, 2, 3) + (1, 1, 1)").shifts[0].by == (2.0, 3.0, 4.0, 0.0, 0.0, 0.0)
    assert len(value("P1 * (0, 0, 5) * (0, 0, 5)").shifts) == 1
    assert len(value("P1 * (0, 0, 5, 90, 0, 0) * (0, 0, 5)").shifts) == 2
    assert len(value("(P1 + (0, 0, 5)) * (0, 0, 5)").shifts) == 2
    names = evaluator()
    far = names.value(tree("P1 + (1, 0, 0)"))
    names.frame = "BENCH"
    assert len(names._place(far, "+", tree("P1 + (1, 0, 0)").rest[0][1]).shifts) == 2


def test_the_number_of_turns_behind_a_pose_is_bounded():
    turn = Shift(kind="tool", by=(0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    for count, code in ((MAX_SHIFTS - 1, None), (MAX_SHIFTS, "RBL502")):
        names = evaluator(Q=Place(point="P1", shifts=(turn,) * count))
        if code is None:
            assert len(names.value(tree("Q * (0, 0, 0, 1, 0, 0)")).shifts) == MAX_SHIFTS
        else:
            with pytest.raises(Fault, match=code):
                names.value(tree("Q * (0, 0, 0, 1, 0, 0)"))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1 / X", "RBL501"),
        ("1 MOD X", "RBL501"),
        ("SQR(-1)", "RBL502"),
        ("1E308 * 10", "RBL502"),
        ("1E308 + 1E308", "RBL502"),
        ("10 ^ 400", "RBL502"),
        ("X ^ -1", "RBL502"),
        ("(0 - 2) ^ 0.5", "RBL502"),
        ("INT(INF)", "RBL502"),
        ("INT(NAN)", "RBL502"),
        ("ROUND(NAN)", "RBL502"),
        ("ROUND(1E308, 12)", "RBL502"),
        ("SIN(INF)", "RBL502"),
        ("NAN + 1", "RBL502"),
        ("INF - INF", "RBL502"),
        ('VAL("1_000")', "RBL502"),
        ('VAL("inf")', "RBL502"),
        ('VAL("")', "RBL502"),
        ("P1 + (INF, 0, 0)", "RBL502"),
        ("POSE(NAN, 0, 0, 0, 0, 0)", "RBL502"),
        ('1 + "a"', "RBL531"),
        ('"a" - "b"', "RBL531"),
        ('"a" AND 1', "RBL531"),
        ("-P1", "RBL531"),
        ("NOT P1", "RBL531"),
        ("P1 + P2", "RBL531"),
        ("P1 - (0, 0, 1)", "RBL531"),
        ("P1 + (0, 0)", "RBL531"),
        ("P1 + (0, 0, 0, 0, 0, 0)", "RBL531"),
        ("P1 * (0, 0, 0, 0)", "RBL531"),
        ("P1 + 1", "RBL531"),
        ("P1 + (0, 0, 1) * (0, 0, 1)", "RBL531"),
        ("1 + P1", "RBL531"),
        ("X + (0, 0, 1)", "RBL531"),
        ("(1, 2, 3)", "RBL531"),
        ('ABS("a")', "RBL531"),
        ("ABS(1, 2)", "RBL531"),
        ("ATN2(1)", "RBL531"),
        ("POSE(1, 2)", "RBL531"),
        ("JOINT(1)", "RBL531"),
        ("DIST(P1, 3)", "RBL531"),
        ("LEN(1)", "RBL531"),
        ("X.RX", "RBL531"),
        ("HERE.Q", "RBL531"),
        ("a(0.5)", "RBL531"),
        ("a(NAN)", "RBL531"),
        ("a(0, 1)", "RBL531"),
        ("z", "RBL532"),
        ("z(1)", "RBL532"),
    ],
)
def test_what_has_no_value_is_a_fault(text, code):
    assert fault(text) == code


def test_longest_text():
    half = "x" * (MAX_TEXT // 2)
    names = Evaluator(Names(**{"H$": half}), Nowhere())
    assert len(names.value(tree("h$ + h$"))) == MAX_TEXT
    with pytest.raises(Fault, match="RBL506"):
        names.value(tree('h$ + h$ + "x"'))


@pytest.mark.parametrize("text", ["IN(1)", "TIMER", "HERE", "P1.X"])
def test_without_a_world_what_it_knows_is_a_fault(text):
    with pytest.raises(Fault, match="program"):
        Evaluator(Names(P1=Place(point="P1")), Nowhere()).value(tree(text))


@pytest.mark.parametrize("lead", ["-", "NOT ", "(", "ABS(", "MIN(1, ", "1 + (", "0 OR (", "1 ^ ("])
def test_the_deepest_expression_is_evaluated(lead):
    depth = 100 if lead[-1] != "(" or lead == "(" else 90
    text = lead * depth + "1" + ")" * (depth if "(" in lead else 0)
    assert math.isfinite(value(text))
