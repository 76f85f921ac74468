"""Driving a machine step by step in a world that follows from the time alone, and programs of every kind for it."""

from dataclasses import dataclass

from hypothesis import strategies as st

from robolang.evaluation.evaluator import Nowhere
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Effect, Pass
from robolang.interpreter.events import Done, Failed
from robolang.interpreter.machine import Machine
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.syntax import ast
from runtime.core.faults import Fault
from tests.robolang import generator
from tests.robolang.helpers import parsed
from tests.robolang.running import POINTS


class Clocked(Nowhere):
    """Inputs and a place of the robot that follow from the time, s."""

    def __init__(self, seed=0):
        self.seed, self.time = seed, 0.0

    def input(self, number):
        return float((round(self.time * 1000) // 8 + number + self.seed) % 3)

    def seconds(self):
        return self.time

    def here(self):
        return self.time, 2.0, 3.0, 4.0, 5.0, 6.0

    def components(self, place, frame):
        return place.pose or (10.0, 20.0, 30.0, self.time, 0.0, 0.0)


@dataclass(frozen=True)
class State:
    machine: MachineSnapshot
    time: float
    effects: int


class Driver:
    """A machine, its world, and the effects, by their number, that are refused; time passes as the program lets it."""

    def __init__(self, program, refused=(), seed=0, decisions=None):
        self.program, self.refused, self.seed = program, frozenset(refused), seed
        self.world, self.effects = Clocked(seed), 0
        self.machine = Machine(program, self.world, POINTS, decisions)

    def step(self):
        event = self.machine.step()
        if isinstance(event, Effect):
            self.effects += 1
            if isinstance(event, Pass):
                self.world.time += event.seconds or 0.008
            if self.effects in self.refused:
                self.machine.refuse(Fault("RBL410", "no"))
        return event

    def steps(self, most):
        """So many events at most; the last is the end of the program."""
        found = []
        while len(found) < most and not (found and isinstance(found[-1], Done | Failed) and self.is_over()):
            found.append(self.step())
        return found

    def is_over(self):
        return self.machine.snapshot().cursor.ended is not None

    def keep(self):
        return State(self.machine.snapshot(), self.world.time, self.effects)

    def take_back(self, state):
        self.machine.restore(state.machine)
        self.world.time, self.effects = state.time, state.effects

    def fresh(self):
        """Another machine of the same program, at its beginning."""
        return Driver(self.program, self.refused, self.seed, Decisions())


# --- programs --------------------------------------------------------------------------------------------------------

BEGIN = 'x = 0\ns$ = ""\nDIM a(600)\nSPEED 100\n'
SUBS = """END
*G PRINT "g"; x
y = 1 / (x MOD 3)
RETURN
*H PRINT ERR; x
RESUME NEXT
*K x = x + 1
IF x < 20 THEN RESUME
SUB s(p)
ON ERROR GOTO *I
x = p
DIM a(2)
a(1) = 10 / (p - 1)
PRINT p; a(1)
IF p > 0 THEN CALL s(p - 1)
RETURN
*I PRINT "i"; ERR
WAIT IN(1) = 2
RESUME NEXT
ENDSUB
SUB t(p)
FOR j = 1 TO p
MOVE P2 + (j, 0, 0)
z = 1 / (j - 2)
NEXT
ENDSUB
"""
PIECES = (
    "x = x + 1",
    's$ = s$ + "a"',
    "a(x * 5) = x + a(3)",
    "a(599) = a(599) + 1",
    "PRINT x; s$; a(5); a(599); ERR",
    "SPEED 100 + x\nMOVE P1",
    "FRAME POSE(x, 0, 0, 0, 0, 0)",
    "MOVE POSE(1, 2, 3, 0, 0, 0), ZONE 5",
    "WRIST KEEP",
    "MOVEJ P3",
    "HAND ON",
    "CONST k = 2",
    "k = 3",
    "DIM b(300)\nb(300) = 1",
    "GOSUB *G",
    "CALL s(x MOD 4)",
    "CALL t(2)",
    "IF IN(2) THEN CALL t(3) ELSE GOSUB *G",
    "WAIT IN(1) = 1",
    "WAIT IN(1) = 5, TIMEOUT 0.03",
    "WAIT IN(1) = 5, TIMEOUT 0.03, GOTO *L{k}",
    "IF IN(1) THEN WAIT IN(2), TIMEOUT 0.01",
    "y = 1 / (x MOD 3)",
    "IF IN(2) THEN MOVE P1 ELSE PRINT HERE.X",
    "DELAY 0.1",
    "ON ERROR GOTO *H",
    "ON ERROR GOTO *K",
    "ON ERROR STOP",
    "PAUSE",
    "OUT(1) = IN(1)",
    "IF x > 5 THEN GOTO *L{k}",
)
BLOCKS = (
    "FOR i{k} = 1 TO 3\n{one}\nNEXT",
    "IF IN(1) THEN\n{one}\nELSEIF IN(2) = 1 THEN\n{two}\nELSE\nPRINT {k}\nENDIF",
    "SELECT IN(1)\nCASE x\n{one}\nCASE IN(2), 0\n{two}\nENDSELECT",
    "SELECT x MOD 2\nCASE 1\n{one}\nCASE TIMER, IN(3)\n{two}\nENDSELECT",
    "n{k} = x\nWHILE x < n{k} + 2\nx = x + 1\n{one}\nWEND",
)


@st.composite
def texts(draw):
    """Texts of programs: every statement, blocks, calls within one another, errors that are caught and that are not."""
    pieces = st.sampled_from((*PIECES, *BLOCKS))
    lines = ["ON ERROR GOTO *H"] * draw(st.integers(0, 1))
    for k, piece in enumerate(draw(st.lists(pieces, min_size=2, max_size=9))):
        one, two = (draw(st.sampled_from(PIECES)).format(k=k) for _ in range(2))
        lines += [piece.format(k=k, one=one, two=two), f"*L{k}"]
    return f"{BEGIN}{chr(10).join(lines)}\n{SUBS}"


@st.composite
def trees(draw):
    """Programs of the statements of ``generator`` that need no block; a handler goes on after each that fails."""
    numbers = draw(st.lists(generator.line_numbers, min_size=2, max_size=8, unique=True))
    leading = st.sampled_from(numbers).map(lambda number: ast.Target(number=number))
    simple = generator.simple_statements(leading)
    kinds = st.one_of(*simple.values())
    several = kinds | generator.make(ast.If, condition=generator.expressions, then=kinds, otherwise=st.none() | kinds)
    *between, last = numbers
    lines = [ast.Line(statement=ast.OnError(target=ast.Target(number=last)))]
    lines += [ast.Line(number=number, statement=draw(several), source_line=k + 2) for k, number in enumerate(between)]
    lines += [ast.Line(statement=ast.Word(word="END")), ast.Line(number=last, statement=ast.Word(word="RESUME NEXT"))]
    return ast.Program(source_path="p", lines=tuple(lines))


programs = st.one_of(texts().map(parsed), trees())
refusals = st.frozensets(st.integers(1, 40), max_size=4)

EVERYTHING = parsed(
    BEGIN
    + 's$ = "a"\nGOSUB *M\nCONST k = 2\nON ERROR GOTO *H\nFOR i = 2 TO 5 STEP 3\na(i) = i\nMOVE P1 + (0, 0, a(i))\n'
    + "NEXT\nFRAME POSE(1, 0, 0, 0, 0, 0)\nWRIST KEEP\nMOVE POSE(1, 2, 3, 0, 0, 0)\nGOSUB *G\nCALL t(3)\nCALL s(2)\n"
    + "WAIT IN(1) = 5, TIMEOUT 0.05\nIF IN(1) THEN PRINT 1 ELSE PRINT 2\nWHILE x < 4\nx = x + 1\nWEND\nPRINT ERR; x\n"
    + "SELECT 1\nCASE IN(1), 7\nPRINT 1\nENDSELECT\nON ERROR STOP\n"
    + SUBS.replace("END\n", "END\n*M ON ERROR GOTO *K\nRETURN\n", 1)
)
"""A program that changes everything that a machine holds."""
