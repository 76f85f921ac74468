"""Every command of ``robolang``: its name, what ``--help`` says of it in a line, and where it is.

Data alone, so that the list of commands imports none of them. tests/robolang/cli/test_help.py compares each line with
the help of its command.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

# an amount such as -10 is no option
_AMOUNTS = MappingProxyType({"ignore_unknown_options": True})


class Entry(NamedTuple):
    """A command, or with ``group`` several below a name; ``panel`` is its heading in ``--help``.

    ``settings`` are those of the parser of its words.
    """

    name: str
    panel: str
    help: str
    group: bool = False
    settings: Mapping[str, Any] | None = None

    @property
    def module(self) -> str:
        """The module of the command, which has its name."""
        return f"robolang.cli.commands.{self.word}"

    @property
    def word(self) -> str:
        """The name as a name of Python."""
        return self.name.replace("-", "_")


_PROGRAMS = "Programs"
_SEEING = "Seeing a run"
_ROBOTS = "Robots and points"
_EXPERIMENTS = "Experiments"
_OTHER = "Other controllers"
_HELP = "Help and settings"

# in the order of `--help`
TABLE = (
    Entry(
        "new",
        _PROGRAMS,
        "Make a folder with a job that runs: program, points, cell, test, CI workflow, editor settings.",
    ),
    Entry(
        "init",
        _PROGRAMS,
        "Put a job that runs into an existing folder, as 'robolang new' does, and overwrite nothing.",
    ),
    Entry("examples", _PROGRAMS, "List the example programs, and copy one with its files.", group=True),
    Entry("run", _PROGRAMS, "Run a program on the controller and the simulated arm."),
    Entry(
        "check", _PROGRAMS, "Find errors in programs without running them, and correct those that have one correction."
    ),
    Entry("test", _PROGRAMS, "Run programs and compare them with their test files (NAME.test.toml)."),
    Entry("fmt", _PROGRAMS, "Format programs: keywords in capitals, blocks indented, comments aligned."),
    Entry("renumber", _PROGRAMS, "Number the lines of a program, and change the targets of its jumps."),
    Entry("repl", _PROGRAMS, "Jog the arm, teach points, and step through a program, forward and backward."),
    Entry("view", _SEEING, "Show a program live in a browser, paused at its start, with the buttons of a pendant."),
    Entry(
        "report",
        _SEEING,
        "Write a page of a run that a browser shows without a network: robot, program, charts, notes.",
    ),
    Entry(
        "render",
        _SEEING,
        "Draw a run: a .png at one time, a .gif, .webp or .mp4 of all of it. Films need the extra [video].",
    ),
    Entry("plot", _SEEING, "Draw signals of a log: a panel for each, one time axis, the running statements marked."),
    Entry("log", _SEEING, "Show what the log of a run holds, and export it.", group=True),
    Entry("robot", _ROBOTS, "List and show robots, import robot models.", group=True),
    Entry("kin", _ROBOTS, "Forward and inverse kinematics of a robot (mm, deg).", group=True),
    Entry(
        "jog",
        _ROBOTS,
        "Jog the arm from the start state of a cell, and print where it stands after each jog.",
        settings=_AMOUNTS,
    ),
    Entry("teach", _ROBOTS, "Teach one point: write it into the points file of a program, and print what changes."),
    Entry(
        "compare",
        _EXPERIMENTS,
        "Run a program with scheduled and fixed gains, right and wrong LOADs, and compare the errors.",
    ),
    Entry("step", _EXPERIMENTS, "Measure the step response of one axis: overshoot, settling, rise, droop."),
    Entry(
        "inertia",
        _EXPERIMENTS,
        "Print the inertia of every axis at the joint and at the motor, and its gravity torque.",
    ),
    Entry(
        "identify",
        _EXPERIMENTS,
        "Move each axis and identify its inertia at the motor and its weight; compare with the model.",
    ),
    Entry(
        "weigh", _EXPERIMENTS, "Move the arm and weigh what it carries: mass, centre of gravity, and the LOAD to write."
    ),
    Entry(
        "wrist-demo",
        _EXPERIMENTS,
        "Calculate the figures of CN103429397A: straight moves through a change of the wrist.",
    ),
    Entry("export", _OTHER, "Write a program in the form of other controllers.", group=True),
    Entry(
        "replay-pulses",
        _OTHER,
        "Replay exported pulse tables: frequencies, path error, with --physics also the simulated arm.",
    ),
    Entry("help", _HELP, "Show the help of a command, or explain a code or a word."),
    Entry("explain", _HELP, "Explain a code and what to do, or a word of this language or another one."),
    Entry("rules", _HELP, "List the rules of robolang check; robolang explain CODE explains one of them."),
    Entry("config", _HELP, "Show the settings of the controller.", group=True),
    Entry(
        "completion",
        _HELP,
        "Print the script that completes commands and options in a shell; the shell reads it when it starts.",
    ),
)
