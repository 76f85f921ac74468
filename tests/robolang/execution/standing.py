"""Sessions that are held, for the tests of what is done where a program stands."""

from dataclasses import fields, is_dataclass

import numpy as np

from robolang.core.source import Source, Span
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.interpreter.arrays import Array
from robolang.interpreter.effects import Origin
from robolang.project.project import load_project
from runtime.motion.speeds import Speeds
from tests.runtime.recorded import rows_of


def session_of(tmp_path, text, physics=False, observer=None):
    (tmp_path / "p.rbl").write_text(text)
    return Session(load_project(tmp_path / "p.rbl"), physics=physics, observer=observer)


def stands(session, most=400):
    """The status where the program stands next: paused, or over."""
    while session.executor.advance(50).state not in (*ENDED, State.PAUSED):
        most -= 1
        assert most, "it does not come to a stand"
    return session.executor.status


def paused_after(session, cycles):
    session.executor.advance(cycles)
    session.executor.pause()
    return stands(session)


def stops_at(session, *lines):
    """Let a session stop before these lines, and return the line where it stands next."""
    session.executor.stops_before = lambda begun: begun.line in lines
    session.executor.resume()
    return stands(session)


def log_of(session):
    """All that is recorded so far, as bytes."""
    return rows_of(session.controller.recorder)


def ended(session):
    """The log and the report of a session that comes to its end."""
    assert stands(session).state in ENDED
    return log_of(session), session.result(0.0).report


def by_hand(text):
    """The origin of a motion of a prompt."""
    return Origin(line=0, span=Span(0, len(text)), source=Source("prompt", text))


def there_and_back(session, axis=0, most=0.05, cycles=60, back=True):
    """Set-points that turn one axis and, with ``back``, return."""
    x = np.linspace(0.0, 1.0, cycles + 1)[1:]
    share = np.sin(np.pi * x) ** 4 if back else x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    rows = np.repeat(session.controller.areas.ina[None], cycles, axis=0)
    rows[:, axis] += most * share
    return rows


def jogged(session, **how):
    text = "jog J1 +1"
    session.executor.play(there_and_back(session, **how), by_hand(text), text)
    return stands(session)


def fed(session, text):
    session.executor.feed(text)
    return stands(session)


def shown(session):
    return [text for _, text in session.record.shown]


def dump(thing):
    """All that a snapshot holds, as values that can be compared."""
    if isinstance(thing, np.ndarray):
        return thing.shape, thing.tobytes()
    if isinstance(thing, Speeds):
        return hash(thing)  # of a chain: what has been judged of it so far is no state
    if is_dataclass(thing) and not isinstance(thing, type):
        if type(thing).__name__ in ("Project", "Program", "MovePlan", "Block"):
            return id(thing) if type(thing).__name__ != "Block" else None
        return type(thing).__name__, {each.name: dump(getattr(thing, each.name)) for each in fields(thing)}
    if isinstance(thing, dict):
        return {key: dump(value) for key, value in thing.items()}
    if isinstance(thing, list | tuple | Array):
        return [dump(value) for value in thing]
    if isinstance(thing, set | frozenset):
        return set(thing)
    if hasattr(thing, "__dict__") and type(thing).__module__.startswith(("robolang", "runtime")):
        return type(thing).__name__, {key: dump(value) for key, value in vars(thing).items()}
    return thing
