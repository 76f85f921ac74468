"""Small programs of every kind of way, run for real: what was true before a line is among the facts of ``flow``.

The program is run by the interpreter, conditions and time-outs go any way, and two facts are followed along: the PRINT
that came last, and the hand with what was declared since it last moved. Programs without loops are run on every way, by
brute force, and there ``flow`` must find the very facts of the runs and no more.

Not looked at, since ``flow`` does not follow it: CALLs and GOSUBs within one another beyond their most, names without a
value, and memory that runs out.
"""

import random
from collections import defaultdict

from hypothesis import given
from hypothesis import strategies as st

from robolang.analysis.checker import check
from robolang.analysis.dataflow import edges_of, facts_before
from robolang.core.diagnostics import has_errors
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import MoveTo, SetHand, SetPayload, Show
from robolang.interpreter.events import Done, Failed, LineBegun
from robolang.interpreter.machine import Machine
from robolang.planning.branch_forcing import open_conditions
from robolang.syntax.ast import Hand, HandState, LoadNamed, Move, Print
from robolang.syntax.blocks import structure_of, word_of
from tests.campaign import examples
from tests.robolang.helpers import parsed
from tests.robolang.planning.test_branch_forcing import Still

MOST_LINES = 90
"""A run ends after so many lines: before CALLs within one another are too many."""
RUNS = 6
MOST_WAYS = 300
PASSED = ("ENDIF", "ENDSELECT")
"""A block none of whose branches is taken goes on below its end, in ``flow`` at its end, where nothing happens."""

# --- programs --------------------------------------------------------------------------------------------------------

ACTS = ("PRINT 1", "PRINT 2", "HAND ON", "HAND OFF", "LOAD l", "SPEED 100", "MOVE P1", "DELAY 0")
ENDS = ("END", "STOP", "RETURN")
FAILING = ("x = 1 / IN(2)", "WAIT IN(1), TIMEOUT 1", "RESUME", "RESUME NEXT", "ON ERROR STOP", "RETURN")


class Section:
    """The main program or a SUB while it is made: which of its labels and which SUBs a line may name."""

    def __init__(self, draw, name, subs, *, loops, errors):
        self.draw, self.name, self.subs, self.loops, self.errors = draw, name, subs, loops, errors
        self.chunks = draw(st.integers(1, 4))
        self.catches = errors and draw(st.booleans())
        self.at = 0

    def text(self):
        lines = [f"CALL {self.pick(self.subs)}"] if self.subs and self.pick((False, True)) else []
        for at in range(self.chunks):
            self.at = at
            if (label := self._label()) and self.pick((False, False, True)):
                lines += [f"GOSUB {label}", self.pick(ACTS)]
            if self.catches and label and self.pick((False, True)):
                lines += [f"ON ERROR GOTO {label}", self.pick((*FAILING, *map("CALL {}".format, self.subs)))]
            lines += [f"*{self.name}{at}{' DELAY 0' * self.pick((0, 1))}", *self.block(2)]
        return lines

    def pick(self, items):
        return self.draw(st.sampled_from(items))

    def block(self, depth):
        """Some lines: statements, and blocks of such lines."""
        lines = []
        for _ in range(self.pick((1, 1, 2))):
            kinds = ("one", "one", "if", "block", "select", *(("while", "for") if self.loops else ()))
            kind = self.pick(kinds if depth else ("one", "if"))
            lines += getattr(self, f"_{kind}")(depth - 1)
        return lines

    def _one(self, depth):
        return [self.simple()]

    def _if(self, depth):
        return [f"IF IN(1) THEN {self.simple()}" + self.pick(("", f" ELSE {self.simple()}"))]

    def _block(self, depth):
        lines = ["IF IN(1) THEN", *self.block(depth)]
        if self.pick((False, True)):
            lines += ["ELSEIF IN(2) THEN", *self.block(depth)]
        return [*lines, *(["ELSE", *self.block(depth)] if self.pick((False, True)) else []), "ENDIF"]

    def _select(self, depth):
        lines = ["SELECT CASE IN(1)", "CASE 1", *self.block(depth), "CASE 2, 3", *self.block(depth)]
        return [*lines, *(["CASE ELSE", *self.block(depth)] if self.pick((False, True)) else []), "ENDSELECT"]

    def _while(self, depth):
        return [self.pick(("WHILE IN(1)", "WHILE 1")), *self.block(depth), "WEND"]

    def _for(self, depth):
        return [f"FOR i = 1 TO {self.pick(('2', 'IN(3)', '0'))}", *self.block(depth), "NEXT"]

    def simple(self):
        kind = self.pick(("act", "act", "act", "end", "jump", "jump", "call", *(("error", "error") * self.errors)))
        if kind == "end":
            return self.pick(ENDS)
        if kind == "call" and self.subs:
            return f"CALL {self.pick(self.subs)}"
        if kind == "jump" and (label := self._label()):
            return self.pick(("GOTO ", "GOSUB ", "WAIT IN(1), TIMEOUT 1, GOTO ")) + label
        if kind == "error":
            label = self._label()
            return self.pick((*FAILING, *((f"ON ERROR GOTO {label}",) * 4 if label and self.catches else ())))
        return self.pick(ACTS)

    def _label(self):
        """A label of this section; without loops one further down."""
        among = range(0 if self.loops else self.at + 1, self.chunks)
        return f"*{self.name}{self.pick(among)}" if among else ""


@st.composite
def programs(draw, *, loops, errors=False):
    """The text of a program of up to three SUBs; without ``loops`` every run of it comes to an end."""
    subs = [f"S{k}_" for k in range(draw(st.integers(0, 3)))]
    lines = [*Section(draw, "M", subs, loops=loops, errors=errors).text(), "END"]
    for k, name in enumerate(subs):
        inner = Section(draw, name, subs if loops else subs[k + 1 :], loops=loops, errors=errors)
        lines += [f"SUB {name}", *inner.text(), "ENDSUB"]
    return "\n".join(lines)


# --- runs ------------------------------------------------------------------------------------------------------------


class Ways(Decisions):
    """Decisions that are taken from a list, and False beyond its end; ``asked`` is how many there were."""

    def __init__(self, program, choices):
        super().__init__()
        self._open, self._choices, self.asked = open_conditions(program), choices, 0

    def of(self, place, value):
        return self._next() if place in self._open else value

    def of_wait(self, place, *, endless):
        return endless or self._next()

    def _next(self):
        self.asked += 1
        return self.asked <= len(self._choices) and self._choices[self.asked - 1]


class Inputs(Still):
    """Inputs of 0 to 2, by chance."""

    def __init__(self, chance):
        super().__init__()
        self._chance = chance

    def input(self, number):
        return float(self._chance.randrange(3))


class EnoughError(Exception):
    """A run has been long enough."""


class Followed(Machine):
    """A program that runs, with the facts before every line that it came to."""

    def __init__(self, program, world, decisions):
        super().__init__(program, world, ("P1",), decisions)
        self.lines, self.printed, self.hand = 0, 0, (False, 0)
        self.seen = {"print": defaultdict(set), "hand": defaultdict(set)}
        self.slow_moves, self.bare_hands = 0, set()

    def _come_to(self, at):
        self.lines += 1
        if self.lines > MOST_LINES:
            raise EnoughError
        self.seen["print"][at].add(self.printed)
        self.seen["hand"][at].add(self.hand)

    def follow(self):
        """Run to the end, or until it has been long enough."""
        try:
            while not isinstance(event := self.step(), Done | Failed):
                if isinstance(event, LineBegun):
                    self._come_to(event.line - 1)
                else:
                    self._note(event)
        except EnoughError:
            pass
        return self

    def _note(self, effect):
        if isinstance(effect, Show):
            self.printed = effect.line
        elif isinstance(effect, SetPayload):
            self.hand = (self.hand[0], 0)
        elif isinstance(effect, SetHand):
            if effect.closed is not self.hand[0]:
                self.hand = (effect.closed, effect.line)
        elif isinstance(effect, MoveTo):
            self.slow_moves += effect.speed_mm_s is None
            if self.hand[1]:
                self.bare_hands.add(self.hand[1])
                self.hand = (self.hand[0], 0)


def printed(at, node, fact):
    """Which PRINT came last, by line."""
    return (at + 1 if isinstance(node, Print) else fact,)


def declared(at, node, fact):
    """Whether the hand is closed, and the line of the HAND since which no LOAD or move has come, or 0."""
    closed, _ = fact
    if isinstance(node, Hand):
        on = node.state is HandState.ON
        return ((on, at + 1) if on is not closed else fact,)
    return ((closed, 0) if isinstance(node, LoadNamed | Move) else fact,)


FACTS = {"print": (0, printed), "hand": ((False, 0), declared)}


def found_by_flow(program):
    ways = edges_of(program, structure_of(program))
    return {name: facts_before(ways, *rule) for name, rule in FACTS.items()}


def assert_sound(text, chance):
    """Run a program some ways; every fact before a line is one that flow found, every defect one that check says."""
    program = parsed(text)
    found = check(program)
    assert not has_errors(found), (text, found)
    facts = found_by_flow(program)
    said = {(item.code, text.count("\n", 0, item.span.start) + 1) for item in found}
    for _ in range(RUNS):
        choices = [chance.random() < 0.5 for _ in range(MOST_LINES)]
        run = Followed(program, Inputs(chance), Ways(program, choices)).follow()
        for name, seen in run.seen.items():
            if facts[name] is not None:
                for at, true in seen.items():
                    assert true <= facts[name][at], (text, name, at + 1)
        dead = {line for code, line in said if code in ("RBL221", "RBL222")}
        assert not dead & {at + 1 for at in run.seen["print"] if not text.split("\n")[at].startswith("SUB")}, text
        assert not run.slow_moves or "SPEED" not in text or any(code == "RBL226" for code, _ in said), text
        assert facts["hand"] is None or {("RBL228", line) for line in run.bare_hands} <= said, text


@given(programs(loops=True), st.integers(0, 10**6))
@examples(150)
def test_what_is_true_in_a_run_is_found(text, seed):
    assert_sound(text, random.Random(seed))


@given(programs(loops=True, errors=True), st.integers(0, 10**6))
@examples(300)
def test_what_is_true_in_a_run_with_errors_is_found(text, seed):
    assert_sound(text, random.Random(seed))


def every_run(program):
    """The facts before every line, of all ways; None when those are too many or too long."""
    seen = {name: defaultdict(set) for name in FACTS}
    todo, runs = [[]], 0
    while todo:
        choices = todo.pop()
        runs += 1
        ways = Ways(program, choices)
        run = Followed(program, Still(), ways).follow()
        if run.lines > MOST_LINES or runs > MOST_WAYS:
            return None
        todo += [[*choices, *[False] * (k - len(choices)), True] for k in range(len(choices), ways.asked)]
        for name, table in run.seen.items():
            for at, facts in table.items():
                seen[name][at] |= facts
    return seen


@given(programs(loops=False))
@examples(100)
def test_without_loops_the_facts_are_those_of_all_runs(text):
    program = parsed(text)
    expected, facts = every_run(program), found_by_flow(program)
    for name in FACTS if expected is not None else ():
        for at, line in enumerate(program.lines):
            if facts[name] is not None and line.statement is not None and word_of(line.statement) not in PASSED:
                assert facts[name][at] == expected[name][at], (text, name, at + 1)
