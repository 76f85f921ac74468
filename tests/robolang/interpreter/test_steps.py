"""The events of a machine, statements that are fed, and what a prompt or a debugger sees."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.interpreter.effects import Drain, Effect, MoveTo, Pass, Show
from robolang.interpreter.events import DONE, FED_ENDED, Done, Failed, FedEnded, LineBegun
from robolang.interpreter.machine import Machine
from robolang.interpreter.program_fault import ProgramFault
from robolang.syntax.parser import parse
from runtime.core.faults import Fault
from tests.campaign import examples
from tests.robolang.helpers import parsed, source
from tests.robolang.interpreter.stepping import Clocked, Driver, programs, refusals
from tests.robolang.running import POINTS, effects_of, ran

LONGEST = 80


def machine(text=""):
    return Machine(parsed(text), Clocked(), POINTS)


def brief(event):
    """An event in a word: the line of a statement that begins, the text of a PRINT, a code, else its class."""
    if isinstance(event, LineBegun):
        return event.line
    if isinstance(event, Show):
        return event.text
    return event.code if isinstance(event, Failed) else type(event).__name__


def events(over, most=99):
    """What a machine yields up to its end."""
    found = []
    while len(found) < most and (not found or (found[-1] not in ("Done", "FedEnded") and found[-1][:3:] != "RBL")):
        event = over.step()
        found.append(brief(event) if not isinstance(event, LineBegun) else f"{event.line}")
    return found


# --- events ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "Done"),
        ("' nothing\n\n", "Done"),
        ("x = 1\n' no statement\nPRINT x", "1 3 1 Done"),
        ("MOVE P1\nHAND ON", "1 MoveTo 2 SetHand Done"),
        ("IF 1 THEN PRINT 7", "1 7 Done"),
        ("x = IN(1)\nPRINT 5", "1 Drain 2 5 Done"),
        ("WAIT IN(1) = 1\nEND\nx = 1", "1 Drain 2 Done"),
        ("WAIT 0, TIMEOUT 0, GOTO *L\n*L", "1 Drain Done"),
        ("FOR i = 1 TO 2\nNEXT\nSTOP\nPRINT 1", "1 2 2 3 Halt Done"),
        ("GOTO *L\n*L x = 1 / 0\nPRINT 1", "1 2 RBL501"),
        ("IF 0 THEN\nPRINT 1\nELSEIF IN(1) = 1 THEN\nPRINT 2\nENDIF", "1 Drain 4 2 5 Done"),
        ("SELECT 0\nCASE IN(1)\nPRINT 1\nCASE 0\nPRINT 2\nENDSELECT", "1 Drain 5 2 6 Done"),
    ],
)
def test_the_events_of_a_program(text, expected):
    assert " ".join(events(machine(text))) == expected


def test_what_is_over_stays_over():
    done, failed = machine("x = 1"), machine("x = 1 / 0")
    assert [events(done)[-1], done.step(), done.step()] == ["Done", DONE, DONE]
    assert events(failed)[-1] == "RBL501"
    last = failed.step()
    assert isinstance(last, Failed)
    assert (failed.step(), last.origin.line, last.fed) == (last, 1, False)


def test_a_failure_names_what_ran_and_the_calls_that_led_there():
    over = machine("CALL s\nSUB s\nGOSUB *G\nRETURN\n*G x = 1 / 0\nENDSUB")
    events(over)
    failed = over.step()
    assert (failed.origin.line, [each.line for each in failed.calls]) == (5, [1, 3])


@given(programs, refusals)
@examples(100)
def test_a_generator_and_the_steps_of_a_machine_agree(program, refused):
    driver, other = Driver(program, refused), Driver(program, refused)
    stepped = driver.steps(300)
    effects, program, fault = [], effects_of(other.machine), None
    try:
        while len(effects) < sum(isinstance(event, Effect) for event in stepped):
            effects.append(next(program) if fault is None else program.throw(fault))
            other.effects += 1
            fault = Fault("RBL410", "no") if other.effects in refused else None
            if isinstance(effects[-1], Pass):
                other.world.time += effects[-1].seconds or 0.008
    except (StopIteration, ProgramFault):
        pass
    assert effects == [event for event in stepped if isinstance(event, Effect)]


def test_a_statement_with_an_error_must_not_run():
    over = Machine(parse(source("MOVE P1\nMOV P2")).program, Clocked(), POINTS)
    assert [brief(over.step()), brief(over.step())] == [1, "MoveTo"]
    with pytest.raises(ValueError, match="line 2"):
        over.step()


# --- refusals --------------------------------------------------------------------------------------------------------


def test_what_is_refused_goes_to_on_error_or_ends_the_program():
    for lead, expected in (("ON ERROR GOTO *H\n", "4 410 Done"), ("' none\n", "RBL410")):
        over = machine(lead + "MOVE P1\nEND\n*H PRINT ERR")
        while not isinstance(over.step(), MoveTo):
            pass
        over.refuse(Fault("RBL410", "no"))
        assert " ".join(events(over)) == expected


@pytest.mark.parametrize("steps", [0, 1, 3, 9])
def test_only_an_effect_can_be_refused(steps):
    over = machine("MOVE P1\nx = 1")
    for _ in range(steps):
        over.step()
    with pytest.raises(ValueError, match="no effect"):
        over.refuse(Fault("RBL410", "no"))


# --- feeding ---------------------------------------------------------------------------------------------------------


def fed(over, text):
    over.feed(parsed(text).lines[0])
    return " ".join(events(over))


def test_a_prompt_without_a_program():
    over = machine()
    assert fed(over, "x = 2") == "1 FedEnded"
    assert fed(over, "PRINT x") == "1 2 FedEnded"
    assert fed(over, "PRINT y") == "1 RBL532"
    assert fed(over, "IF x = 2 THEN PRINT 3 ELSE PRINT 4") == "1 3 FedEnded"
    assert fed(over, "DIM a(2)") == fed(over, "a(1) = 5") == fed(over, "CONST k = 1") == "1 FedEnded"
    assert fed(over, "PRINT a(1); x; k") == "1 521 FedEnded"
    assert fed(over, "k = 2") == "1 RBL531"
    assert fed(over, "SPEED 70") == "1 FedEnded"
    over.feed(parsed("MOVE P1").lines[0])
    assert over.step().line == 1
    assert over.step().speed_mm_s == 70.0
    assert events(over) == ["FedEnded"]
    assert fed(over, "GOTO 10") == fed(over, "RETURN") == "1 RBL533"
    assert events(over) == ["Done"]


SHOP = """n = 1
WAIT IN(1) = 5
PRINT "on"
END
*G PRINT "g"
RETURN
SUB s(p)
PRINT p
z = 1 / (p - 3)
ENDSUB
SUB c
ON ERROR GOTO *H
z = 1 / 0
RETURN
*H PRINT ERR
ENDSUB
SUB e
END
ENDSUB
"""


def waiting():
    """A machine inside of a WAIT."""
    over = machine(SHOP)
    assert [brief(over.step()) for _ in range(5)] == [1, 2, "Drain", "Pass", "Pass"]
    return over


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("n = 2", "1 FedEnded"),
        ("CALL s(1)", "1 8 1 9 10 FedEnded"),
        ("CALL s(3)", "1 8 3 9 RBL501"),
        ("IF 1 THEN CALL s(1)", "1 8 1 9 10 FedEnded"),
        ("CALL c", "1 12 13 15 501 16 FedEnded"),
        ("CALL nothing", "1 RBL533"),
        ("GOSUB *G", "1 5 g 6 FedEnded"),
        ("WAIT IN(1) = 5, TIMEOUT 0", "1 Drain RBL503"),
        ("WAIT TIMER = 0", "1 Drain FedEnded"),
        ("RETURN", "1 RBL533"),
        ("RESUME", "1 RBL533"),
        ("ON ERROR STOP", "1 FedEnded"),
    ],
)
def test_what_is_fed_comes_back_to_the_inside_of_a_wait(text, expected):
    over = waiting()
    assert fed(over, text) == expected
    assert [brief(over.step()) for _ in range(3)] == ["Pass"] * 3
    assert len(over.variables) == 1


@pytest.mark.parametrize(
    ("text", "expected", "then"),
    [
        ("GOTO *G", "1 FedEnded", "5 g 6 RBL533"),
        ("END", "1 FedEnded", "Done"),
        ("STOP", "1 Halt FedEnded", "Done"),
        ("CALL e", "1 18 Done", "Done"),
    ],
)
def test_a_jump_that_is_fed_moves_the_program(text, expected, then):
    over = waiting()
    assert fed(over, text) == expected
    assert " ".join(events(over)) == then
    assert fed(over, "PRINT n") == "1 1 FedEnded"


def test_a_program_that_is_over_goes_on_where_a_jump_leads():
    for text in ("10 PRINT 1", "10 PRINT 1\n20 x = 1 / 0"):
        over = machine(text)
        events(over)
        assert fed(over, "GOTO 10") == "1 FedEnded"
        assert events(over)[:2] == ["1", "1"]


def test_handlers_of_the_program_do_not_catch_what_is_fed():
    over = machine("ON ERROR GOTO *H\nx = 1\nx = 1 / 0\nEND\n*H PRINT ERR\nRESUME NEXT\nSUB s\nx = 2 / 0\nENDSUB")
    assert [brief(over.step()) for _ in range(2)] == [1, 2]
    assert fed(over, "x = 1 / 0") == "1 RBL501"
    assert fed(over, "CALL s") == "1 8 RBL501"
    assert fed(over, "PRINT ERR") == "1 0 FedEnded"
    assert " ".join(events(over)) == "3 5 501 6 4 Done"


def test_a_call_that_was_fed_and_is_left_by_resume_keeps_no_handler_from_its_errors():
    text = "ON ERROR GOTO *H\nx = 1 / 0\nx = 2 / 0\nPRINT 3\nEND\n*H PRINT ERR\nRESUME NEXT\n*G RESUME NEXT"
    over = machine(text)
    assert [brief(over.step()) for _ in range(3)] == [1, 2, 6]
    over.feed(parsed("GOSUB *G").lines[0])
    assert " ".join(events(over)) == "1 8 3 6 501 7 4 3 5 Done"


def test_statements_are_fed_within_one_another():
    over = waiting()
    over.feed(parsed("CALL s(1)").lines[0])
    assert [brief(over.step()) for _ in range(2)] == [1, 8]
    assert fed(over, "PRINT p; n") == "1 11 FedEnded"
    assert fed(over, "GOSUB *G") == "1 5 g 6 FedEnded"
    assert fed(over, "p = 3") == "1 FedEnded"
    assert " ".join(events(over)) == "3 9 RBL501"
    assert brief(over.step()) == "Pass"
    over.feed(parsed("CALL s(1)").lines[0])
    assert [brief(over.step()) for _ in range(2)] == [1, 8]
    assert fed(over, "RETURN") == "1 FedEnded"  # ends the SUB, and with it the CALL that was fed
    assert brief(over.step()) == "Pass"


def test_an_effect_that_was_fed_can_be_refused():
    over = waiting()
    over.feed(parsed("MOVE P1").lines[0])
    assert [brief(over.step()) for _ in range(2)] == [1, "MoveTo"]
    over.refuse(Fault("RBL410", "no"))
    failed = over.step()
    assert (failed.code, failed.fed, failed.origin.line) == ("RBL410", True, 1)
    assert brief(over.step()) == "Pass"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("IF 1 THEN", "RBL211"),
        ("WHILE 1", "RBL211"),
        ("SELECT 1", "RBL211"),
        ("FOR i = 1 TO 2", "RBL211"),
        ("SUB s", "RBL211"),
        ("ELSEIF 1 THEN", "RBL212"),
        ("ELSE", "RBL212"),
        ("ENDIF", "RBL212"),
        ("NEXT", "RBL212"),
        ("WEND", "RBL212"),
        ("CASE 1", "RBL212"),
        ("CASE ELSE", "RBL212"),
        ("ENDSELECT", "RBL212"),
        ("ENDSUB", "RBL212"),
    ],
)
def test_a_part_of_a_block_cannot_be_fed(text, code):
    over = waiting()
    with pytest.raises(Fault) as caught:
        over.feed(parse(source(text)).program.lines[0])
    assert caught.value.code == code
    assert brief(over.step()) == "Pass"


@pytest.mark.parametrize("text", ["' a comment", "MOV P2"])
def test_what_is_no_statement_cannot_be_fed(text):
    over = waiting()
    with pytest.raises(ValueError, match="line"):
        over.feed(parse(source(text)).program.lines[0])
    assert brief(over.step()) == "Pass"


FED = ("zz = 1", "IF 1 THEN zz = 1", "zz = 1 / 0", "PRINT 1", "DELAY 0", "ON ERROR GOTO 7", "WAIT 0, TIMEOUT 0")


@given(programs, refusals, st.sampled_from(FED))
@examples(150)
def test_what_is_fed_at_any_step_leaves_the_rest_as_it_was(program, refused, text):
    driver = Driver(program, refused)
    states, expected = [], []
    while len(expected) < LONGEST and not (expected and isinstance(expected[-1], Done | Failed)):
        states.append(driver.keep())
        expected.append(driver.step())
    line = parsed(text).lines[0]
    for at, state in enumerate(states):
        driver.take_back(state)
        driver.machine.feed(line)
        inside, kept = [], []
        while not (inside and isinstance(inside[-1], FedEnded | Failed)):
            kept.append(driver.machine.snapshot())
            inside.append(driver.machine.step())
        assert inside[-1] == FED_ENDED or inside[-1].fed
        rest = expected[at : at + 10]
        assert driver.steps(len(rest)) == rest
        for step, snapshot in enumerate(kept):  # the inside of what was fed is a place to go back to as well
            driver.take_back(replace(state, machine=snapshot))
            assert [driver.machine.step() for _ in inside[step:]] == inside[step:]
            assert driver.steps(len(rest)) == rest


# --- what a debugger sees --------------------------------------------------------------------------------------------


def test_place_calls_and_variables():
    over = machine("x = 1\nDIM a(3)\nCONST k = 2\nCALL s(5)\nSUB s(p)\nx = 3\nGOSUB *G\nRETURN\n*G x = 4\nENDSUB")
    assert (over.origin, over.calls) == (None, ())
    while over.origin is None or over.origin.line != 9:
        over.step()
    assert [each.line for each in over.calls] == [4, 7]
    main, inner = over.variables
    assert (main.values, inner.values) == ({"X": 1.0, "K": 2.0}, {"P": 5.0, "X": 3.0})
    assert (list(main.arrays["A"]), main.constants, inner.constants) == ([0.0] * 4, {"K"}, frozenset())
    events(over)
    assert (inner.values["X"], over.origin) == (3.0, None)


def test_a_drain_comes_once_for_an_effect_of_a_branch():
    assert [type(each) for each in ran("IF 1 THEN x = IN(1)")] == [Drain]
