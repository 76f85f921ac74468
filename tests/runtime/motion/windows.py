"""A chain of moves that is planned a few moves ahead while it runs, as one plan."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan
from tests.runtime.motion.motions import TOOL, Bench


@dataclass(frozen=True, slots=True, kw_only=True)
class Windowed:
    """The whole ``plan`` of moves, of which the motion could not go on ``stops`` times; ``lengths`` of its plans."""

    plan: ChainPlan
    stops: int
    lengths: tuple[int, ...]


def windowed(robot: Bench, start: Array, commands: Sequence[Command], first: int, step: int) -> Windowed:
    """Return moves that are planned ``first`` at a time, then ``step``, while those before run."""
    planner = robot.planner
    plan = planner.chain(start, commands[:first], TOOL, more=True)
    rows, numbers, over, stops, lengths = [plan.setpoints[:0]], [plan.command[:0]], 0, 0, [len(plan.parts)]
    for at in range(first, len(commands), step):
        more = commands[at : at + step]
        kept, left_out = len(plan.q) - 1, len(plan.parts)
        try:
            if plan.tail is None or plan.tail.more_at is None:
                raise Fault("RBL404", "a stop")
            grown, left_out = planner.extend(plan, plan.tail.more_at, more, TOOL)
            kept = plan.parts[left_out].first if left_out else 0
        except Fault:
            stops += 1
            grown = planner.chain(plan.q[-1], more, TOOL, more=True)
        rows.append(plan.setpoints[:kept])
        numbers.append(plan.command[:kept] + over)
        over, plan = over + left_out, grown
        lengths.append(len(plan.parts))
    command = np.concatenate([*numbers, plan.command + over])
    whole = replace(plan, setpoints=np.concatenate([*rows, plan.setpoints]), command=command)
    return Windowed(plan=whole, stops=stops, lengths=tuple(lengths))
