"""The timeline: what `back` restores is what was there, to the byte, and memory stays bounded."""

import random

import pytest

from robolang.execution import timeline as timelines
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.execution.timeline import Timeline
from robolang.project.project import load_project
from runtime.core.faults import Fault
from tests.campaign import size
from tests.programs.runs import PROGRAMS
from tests.robolang.execution.standing import (
    dump,
    ended,
    fed,
    jogged,
    log_of,
    paused_after,
    session_of,
    shown,
    stands,
    stops_at,
)

FOLLOWED = PROGRAMS[:10]
STOPS = size(200, 4)


def followed(session):
    return session.executor, Timeline(session.executor)


def state_of(session):
    return dump(session.executor.snapshot()), log_of(session), session.executor.status, session.executor.origin


def stepped(session):
    """Go on to the next statement."""
    session.executor.stops_before = lambda begun: True
    session.executor.resume()
    return stands(session)


@pytest.mark.physics
@pytest.mark.parametrize("number", range(STOPS))
def test_back_restores_the_very_state(number):
    """From a random stop the program goes on for some statements, to its end or to an alarm, and comes back."""
    chance = random.Random(number)
    session = Session(load_project(FOLLOWED[number % len(FOLLOWED)]))
    executor, timeline = followed(session)
    stop, count = chance.randrange(1, 12), 0
    stepped(session)
    while count < stop and executor.status.state is State.PAUSED:
        stepped(session)
        count += 1
    if executor.status.state is not State.PAUSED:
        timeline.back()
    there, places = state_of(session), len(timeline)
    if chance.random() < 0.3:
        executor.stops_before = None
        executor.resume()
        executor.advance(chance.randrange(1, 400))
        if chance.random() < 0.5:
            executor.stop()
            stands(session)
    else:
        for _ in range(chance.randrange(1, 4)):
            if stepped(session).state in ENDED:
                break
    timeline.back(len(timeline) - places)
    assert state_of(session) == there


def test_back_from_each_statement_to_each(tmp_path):
    text = "X = 1\nMOVE P1\nFOR I = 1 TO 3\nX = X + I\nDELAY 0.04\nNEXT\nPRINT X\nMOVE P2\nY = 1 / (X - X)\n"
    session = session_of(tmp_path, text)
    executor, timeline = followed(session)
    states = []
    while stepped(session).state is State.PAUSED:
        states.append(state_of(session))
    assert executor.status.state is State.ALARM
    states.append(state_of(session))
    whole = states.copy()
    for steps in (1, 3, 1, 5, 2):
        mark = timeline.back(steps)
        del states[-steps:]
        assert state_of(session) == states[-1]
        assert mark.origin == executor.origin
        assert mark.time_us == executor.time_us
    while stepped(session).state is State.PAUSED:
        states.append(state_of(session))
    states.append(state_of(session))
    assert [state[1:] for state in states] == [state[1:] for state in whole]


def test_back_over_a_run_without_stops(tmp_path):
    """Blends too: in the middle of a chain the moves are kept, as they were."""
    text = "FOR I = 1 TO 4\nMOVE P1, ZONE 20\nMOVE P2, ZONE 20\nX = X0 + I\nNEXT\nMOVE P1\n".replace("X0", "1")
    session = session_of(tmp_path, text)
    executor, timeline = followed(session)
    whole = ended(session)
    for steps in (1, 2, 4, 7):
        timeline.back(steps)
        assert executor.status.state is State.PAUSED
        executor.resume()
        assert ended(session) == whole


@pytest.mark.parametrize("bounds", [(64, 5000, 600), (3, 20, 4), (2, 5, 2)])
def test_memory_is_bounded_and_old_places_are_reached_by_cycles_run_once_more(tmp_path, monkeypatch, bounds):
    for name, value in zip(("STRIDE", "MOST_PLACES", "MOST_SNAPSHOTS"), bounds, strict=True):
        monkeypatch.setattr(timelines, name, value)
    text = "FOR I = 1 TO 60\nX = I * 2\nIF I MOD 7 = 0 THEN DELAY 0.016\nPRINT X\nNEXT\nMOVE P1\n"
    session = session_of(tmp_path, text)
    timeline = Timeline(session.executor)
    states = []
    while stepped(session).state is State.PAUSED:
        states.append(state_of(session))
    assert min(len(states), bounds[1]) <= len(timeline) <= max(len(states), 2 * bounds[1] + bounds[0])
    assert sum(place.snapshot is not None for place in timeline._places) <= bounds[2] + 1
    assert timeline._snapshots == sum(place.snapshot is not None for place in timeline._places)
    chance, at = random.Random(1), len(states)
    while at > len(states) - min(len(timeline), bounds[1] - 1, 100):
        steps = chance.randrange(1, 9)
        if steps > len(timeline):
            break
        timeline.back(steps)
        at -= steps
        assert state_of(session) == states[at]
        assert timeline._last == max(k for k, place in enumerate(timeline._places) if place.snapshot is not None)


def test_what_is_done_from_outside_has_places_of_its_own(tmp_path):
    session = session_of(tmp_path, "X = 1\nDELAY 0.1\nPRINT X\nMOVE P1\nPRINT X\n")
    executor, timeline = followed(session)
    stops_at(session, 3)
    before = state_of(session)
    fed(session, "X = 5")
    changed = state_of(session)
    jogged(session)
    after = state_of(session)
    stepped(session)
    assert shown(session) == ["5"]
    for expected, label in ((after, ""), (changed, "jog J1 +1"), (before, "X = 5")):
        assert timeline.back().label == label
        assert state_of(session) == expected
    assert timeline.back().origin.line == 2
    session.executor.stops_before = None
    executor.resume()
    assert stands(session).state is State.DONE
    assert shown(session) == ["1", "1"]


def test_what_the_executor_does_not_see_is_marked(tmp_path):
    session = session_of(tmp_path, "X = 1\nPRINT OUT(3)\nPRINT OUT(3)\n".replace("OUT(3)", "X"))
    executor, timeline = followed(session)
    stops_at(session, 2)
    before = state_of(session)
    timeline.mark("out 3 on")
    executor.world.set_output(3, 1.0, None)
    after = state_of(session)
    stepped(session)
    timeline.back()
    assert state_of(session) == after
    assert timeline.back().label == "out 3 on"
    assert state_of(session) == before


def test_a_pause_within_a_move_and_a_stop_are_taken_back(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nMOVE P2\nPRINT 1\n")
    executor, timeline = followed(session)
    paused_after(session, 40)
    held = state_of(session)
    executor.stops_before = None
    executor.resume()
    executor.advance(10)
    executor.stop()
    assert stands(session).state is State.STOPPED
    timeline.back()
    assert state_of(session) == held
    executor.stop()
    stands(session)
    stopped = state_of(session)
    executor.acknowledge()
    fed(session, "MOVE P1")
    timeline.back()
    timeline.back()
    assert state_of(session) == stopped
    timeline.back()
    assert state_of(session) == held


def test_a_course_is_one(tmp_path):
    """After going back, the places that came later are given up."""
    session = session_of(tmp_path, "X = 1\nX = 2\nX = 3\nX = 4\n")
    executor, timeline = followed(session)
    stops_at(session, 4)
    assert len(timeline) == 3
    timeline.back(2)
    assert (len(timeline), executor.origin.line) == (1, 2)
    with pytest.raises(Fault) as refused:
        timeline.back(2)
    assert refused.value.code == "RBL545"
    stops_at(session, 3)
    assert (len(timeline), executor.origin.line) == (2, 3)
    for steps in (0, -1):
        with pytest.raises(Fault):
            timeline.back(steps)


COURSES = size(120, 5)
FED = (
    "X = X + 1",
    "MOVE P1 + (0, 0, 60)",
    "FOR J = 1 TO 3\nX = X + J\nDELAY 0.016\nNEXT",
    "CALL S(2)",
    "Y = 1 / (X - X)",
    "HAND ON",
    "SPEED 200",
    "WAIT TIMER > 1E6, TIMEOUT 0.05",
)
COURSE = """X = 1
FOR I = 1 TO 3
MOVE P1 + (0, 0, 80), ZONE 20
X = X + 1
MOVE P2 + (0, 0, 80), ZONE 20
CALL S(I)
NEXT
WAIT TIMER > 2, TIMEOUT 5
PRINT X
END
SUB S(K)
DELAY 0.05
HAND OFF
X = K
PRINT K; X
ENDSUB
"""


class Course:
    """Random things that are done to a session, each of which leaves it where it stands."""

    def __init__(self, session, chance):
        self.session, self.chance, self.executor = session, chance, session.executor

    def step(self):
        stepped(self.session)

    def go(self):
        """Go on for some cycles, and rest there."""
        self.executor.stops_before = None
        self.executor.resume()
        paused_after(self.session, self.chance.randrange(1, 150))

    def feed(self):
        self.executor.stops_before = None
        fed(self.session, self.chance.choice(FED))

    def jog(self):
        jogged(self.session, most=0.01, back=self.chance.random() < 0.5)

    def interrupted_feed(self):
        self.executor.feed(self.chance.choice(FED))
        paused_after(self.session, self.chance.randrange(1, 20))

    def stop(self):
        self.executor.stop()
        stands(self.session)

    def again(self):
        self.executor.acknowledge()
        self.executor.begin_again()

    def regain(self):
        self.executor.regain()
        stands(self.session)

    def any(self):
        """Do one thing that is possible now; what is refused changes nothing."""
        names = ("step", "go", "feed", "jog", "interrupted_feed", "stop", "again", "regain")
        name = self.chance.choices(names, (6, 3, 3, 2, 2, 1, 2, 2))[0]
        before = state_of(self.session)
        try:
            getattr(self, name)()
        except (Fault, RuntimeError):
            self.executor.stops_before = None
            assert name == "again" or state_of(self.session) == before, name


@pytest.mark.parametrize("number", range(COURSES))
def test_back_through_a_course_of_all_that_can_be_done(tmp_path, number):
    session, chance = session_of(tmp_path, COURSE), random.Random(number)
    executor, timeline = followed(session)
    course = Course(session, chance)
    stepped(session)
    stood = [(len(timeline), state_of(session))]
    for _ in range(25):
        course.any()
        if chance.random() < 0.2 and len(stood) > 1:
            at = chance.randrange(len(stood))
            places, state = stood[at]
            del stood[at + 1 :]
            if len(timeline) > places:
                timeline.back(len(timeline) - places)
                assert state_of(session) == state
        elif len(timeline) > stood[-1][0]:
            stood.append((len(timeline), state_of(session)))
    assert executor.status.time_us >= 0
