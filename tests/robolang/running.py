"""Running a program without a robot: the test turns inputs and clock."""

import pytest

from robolang.evaluation.evaluator import Nowhere
from robolang.interpreter.effects import Pass, Show
from robolang.interpreter.events import Done, Failed, FedEnded, LineBegun
from robolang.interpreter.machine import Machine
from robolang.interpreter.program_fault import ProgramFault
from runtime.core.faults import Fault
from tests.robolang.helpers import parsed

POINTS = ("P1", "P2", "P3", "P4", "P5", "A", "B")


class World(Nowhere):
    """Inputs and a clock that the test turns; where the robot is follows nothing."""

    def __init__(self):
        self.inputs, self.time = {1: 0.0}, 0.0

    def input(self, number):
        if number not in self.inputs:
            raise Fault("RBL534", f"no input {number}")
        return self.inputs[number]

    def seconds(self):
        return self.time

    def here(self):
        return 1.0, 2.0, 3.0, 4.0, 5.0, 6.0

    def components(self, place, frame):
        return place.pose or (10.0, 20.0, 30.0, 0.0, 0.0, 0.0)


def execute(program, world=None, points=(), decisions=None):
    """Yield the effects of a program to its end; a ``Fault`` that is thrown in refuses the effect."""
    return effects_of(Machine(program, world or Nowhere(), points, decisions))


def effects_of(machine):
    """Yield the effects of a machine to its end, then raise what no ON ERROR caught."""
    while not isinstance(event := machine.step(), Done):
        if isinstance(event, Failed):
            raise ProgramFault(Fault(event.code, event.message, event.hint), event.origin, event.calls)
        if isinstance(event, LineBegun | FedEnded):
            continue
        try:
            yield event
        except Fault as fault:
            machine.refuse(fault)


def ran(text, world=None):
    """All effects of a program; time passes as it asks for, a WAIT in steps of 8 ms."""
    world = world or World()
    found = []
    for effect in execute(parsed(text), world, POINTS):
        found.append(effect)
        if isinstance(effect, Pass):
            world.time += effect.seconds or 0.008
    return found


def shows(text, world=None):
    """What a program prints."""
    return [effect.text for effect in ran(text, world) if isinstance(effect, Show)]


def fault(text, world=None):
    with pytest.raises(ProgramFault) as caught:
        ran(text, world)
    return caught.value
