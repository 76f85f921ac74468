"""Codes, faults and alarms: how anything that goes wrong is named.

One registry serves diagnostics of a program, errors of robot and cell files, refusals of the planner and
alarms of the running controller, so that a code means one thing everywhere. Each layer registers the codes it
raises: the runtime its own below, the language front end its own in ``robolang.core.codes``.

A *fault* (``Fault``) is raised where a request cannot be carried out; the request itself has moved nothing. An
*alarm* (``Alarm``) is a latched event of the running robot, kept in the report. It carries the statement that ran,
as the front end gave it to the controller, so that its place in the program is never looked up a second time.
"""

from collections.abc import Sequence
from enum import Enum
from typing import TYPE_CHECKING

from runtime.core.record import Record

if TYPE_CHECKING:
    # for type checkers only: it is a data class, which a check would have to build at its start
    from runtime.core.program_line import ProgramLine


class Group(Enum):
    """What a code is about: the first digit of its number."""

    TEXT = "1"
    MEANING = "2"
    POINTS = "3"
    MOTION = "4"
    RUN = "5"
    FILES = "6"
    COMMAND = "7"
    PROMPT = "8"
    INTERNAL = "9"


class Stage(Enum):
    """The first step that can find a code: reading the text, checking it in its cell, planning the motion, the run."""

    TEXT = "text"
    CELL = "cell"
    MOTION = "motion"
    RUN = "run"


_STAGES = {Group.TEXT: Stage.TEXT, Group.MEANING: Stage.CELL, Group.POINTS: Stage.CELL, Group.RUN: Stage.RUN}
"""Stage of the codes of a group, where a code does not give its own."""


class Code(Record):
    """One thing that can go wrong: ``RBL412``, its kebab-case name, what it means and what to do.

    ``category`` is how an alarm of this code stops the arm: 1 on its path, then the brakes; 0 at once. ``found``: the
    stage that finds it, None for that of its group. ``computed``: it is about a value, and values that a run computes
    are checked in the run. ``endless``: a program with it is not started, since it would not end.
    """

    code: str
    name: str
    meaning: str
    remedy: str
    category: int = 1
    found: Stage | None = None
    computed: bool = False
    endless: bool = False

    @property
    def group(self) -> Group:
        """What the code is about."""
        return Group(self.code[3])

    @property
    def stage(self) -> Stage | None:
        """The first step that can find it; None: no check of a program finds it."""
        return self.found or _STAGES.get(self.group)

    @property
    def is_rule(self) -> bool:
        """Whether checking a program can find it, its motion included."""
        return self.stage in (Stage.TEXT, Stage.CELL, Stage.MOTION)

    @property
    def is_certain(self) -> bool:
        """Whether a check without motion finds it wherever it is; else its absence there says nothing."""
        return self.stage in (Stage.TEXT, Stage.CELL) and not self.computed

    @property
    def prevents_run(self) -> bool:
        """Whether a program whose rehearsal finds it is not started."""
        return self.endless or self.group in (Group.POINTS, Group.MOTION)


_registry: dict[str, Code] = {}


def register(*codes: Code) -> None:
    """Add codes to the registry; ``ValueError`` when a code or a name is taken."""
    for code in codes:
        taken = {c.name for c in _registry.values()}
        if code.code in _registry or code.name in taken:
            raise ValueError(f"{code.code} {code.name} is registered twice")
        _registry[code.code] = code


def lookup(code: str) -> Code:
    """Return the entry of a code such as ``RBL412``; ``KeyError`` when there is none."""
    return _registry[code]


def all_codes() -> list[Code]:
    """Return every registered code in numeric order."""
    return [_registry[key] for key in sorted(_registry)]


class Alarm(Record):
    """A latched event of the running controller.

    ``tick`` is the servo tick at which it was raised, ``axis`` is 0-based (None: no single axis), ``statement`` the
    one that ran (None: none did), ``calls`` those that led to it, the outermost first. ``category`` is the stop that
    answers it: 0 at once, 1 on the path.
    """

    code: str
    message: str
    tick: int
    axis: int | None = None
    statement: "ProgramLine | None" = None
    calls: "tuple[ProgramLine, ...]" = ()
    hint: str = ""
    category: int = 1


class Fault(Exception):  # noqa: N818 - the field calls it a fault
    """A request that cannot be carried out; it has changed nothing.

    ``code`` is registered, ``message`` states what is wrong, with numbers and units, ``hint`` what helps. ``others``:
    what else is wrong, where a reader of files looks for everything at once.
    """

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(f"{code}: {message}")
        self.code = lookup(code).code
        self.message = message
        self.hint = hint or lookup(code).remedy
        self.others: tuple[Fault, ...] = ()
        self.add_note(f"help: {self.hint}")  # what Python prints below an exception that nobody catches

    @property
    def all(self) -> tuple["Fault", ...]:
        """This fault and the others, in order."""
        return (self, *self.others)


def raise_all(faults: Sequence[Fault]) -> None:
    """Raise the first of some faults with all others; nothing when there are none."""
    if faults:
        first, *others = faults
        first.others = tuple(others)
        raise first


register(
    Code(
        code="RBL401",
        name="payload-not-a-mass",
        meaning="The payload given to LOAD is negative or not a finite number.",
        remedy="Give the mass of everything beyond the flange in kg, 0 or more.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL402",
        name="payload-over-rated",
        meaning="The declared payload is heavier than the rated payload of the robot.",
        remedy="Check the unit (kg, not g); use a lighter hand or a larger robot.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL403",
        name="payload-not-physical",
        meaning="The centre of gravity or the inertia of the payload is not physically possible on this arm.",
        remedy="Give the centre of gravity in mm in the flange frame; no principal moment of an inertia may exceed the "
        "sum of the other two.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL404",
        name="speed-out-of-range",
        meaning="A speed, acceleration, distance or duration is outside its range.",
        remedy="Give SPEED in mm/s; SPEED of MOVEJ, SPEEDJ, ACCEL and OVERRIDE in %, above 0 to 100, or ACCEL MAX; "
        "TIME in s, above 0 to 600; the distance of APPROACH and DEPART in mm, 0 to 100000.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL405",
        name="dwell-out-of-range",
        meaning="A waiting time is negative, not finite or too long.",
        remedy="Give the time in s: 0 to 600 for HAND, 0 to 86400 for DELAY, PULSE and TIMEOUT.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL410",
        name="out-of-reach",
        meaning="No joint angles of this robot bring the tool to the pose.",
        remedy="Move the point closer to the robot, or check the tool and the frame with which it was taught.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL411",
        name="joint-limit",
        meaning="A joint would leave its range on the move.",
        remedy="Teach a via point, choose another arm configuration, or move the work piece.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL412",
        name="wrist-singularity",
        meaning="A straight move passes a singularity, where joints would have to turn infinitely fast, or its end "
        "needs another arm or wrist configuration.",
        remedy="Teach a via point away from J5 = 0, teach the end in the wrist configuration of the start, or allow "
        "the wrist to change with WRIST AUTO.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL509",
        name="run-too-long",
        meaning="The run has reached the longest simulated time that is recorded, or a loop repeats itself for ever.",
        remedy="Let each loop end and give each WAIT a TIMEOUT, or divide the program; log and report are complete up "
        "to here.",
        endless=True,
    ),
    Code(
        code="RBL510",
        name="non-finite-state",
        meaning="A position, speed or torque has become NaN or infinite, so the simulation is no longer valid.",
        remedy="Check masses, contacts and gains near this moment; the log ends with the last finite state.",
        category=0,
    ),
    Code(
        code="RBL511",
        name="following-error",
        meaning="An axis is farther from its command than the limit for its speed.",
        remedy="Check for a blocked axis, a drive without torque or a wrong LOAD; the limits are in "
        "[controller.supervision].",
    ),
    Code(
        code="RBL512",
        name="torque-saturation",
        meaning="A drive needs more torque than it can give, for longer than allowed.",
        remedy="Move slower or with less ACCEL, carry less, or check the declared payload.",
    ),
    Code(
        code="RBL513",
        name="speed-excursion",
        meaning="An axis turns faster than its speed limit and the margin allow.",
        remedy="Check gains, payload and encoder: a control loop may be unstable.",
    ),
    Code(
        code="RBL514",
        name="position-excursion",
        meaning="An axis is outside its range by more than the margin.",
        remedy="Check the payload, the drive and the encoder: something has moved the arm beyond its command.",
    ),
    Code(
        code="RBL515",
        name="encoder-fault",
        meaning="The readings of an encoder are impossible for an axis that follows its command: they jump, have gaps "
        "or do not change.",
        remedy="Check the encoder, its cable and the brake of the axis. The arm stops at once, because its angles are "
        "not reliable.",
        category=0,
    ),
    Code(
        code="RBL516",
        name="collision",
        meaning="An axis needs a torque that neither the model of the arm nor a payload explains: the arm touches "
        "something, or a drive does not give its torque.",
        remedy="Check for an obstacle, then the drive and the brake of the axis.",
    ),
    Code(
        code="RBL517",
        name="payload-mismatch",
        meaning="The torques show that the arm carries another mass than LOAD declares.",
        remedy="Write the right LOAD after each HAND ON and HAND OFF; payload_mismatch in [controller.supervision] can "
        "be stop, warn or off.",
    ),
    Code(
        code="RBL518",
        name="stop-failed",
        meaning="The arm did not follow the controlled stop after an alarm, and was stopped at once.",
        remedy="See the alarm before this one.",
        category=0,
    ),
    Code(
        code="RBL520",
        name="tick-overrun",
        meaning="The work of an interpolation cycle took longer than the cycle.",
        remedy="Lower the declared costs in the controller profile: interpolation_cost_ms and "
        "dynamics_cost_per_axis_ms.",
    ),
    Code(
        code="RBL521",
        name="stale-dynamics",
        meaning="The inertia and the gravity torque in use are too old, or belong to the payload before the last LOAD, "
        "while the arm moves.",
        remedy="Lower the declared costs in the controller profile, so that the dynamics task gets idle time.",
    ),
    Code(
        code="RBL523",
        name="not-in-position",
        meaning="The arm did not come into position at the end of a move within the allowed time.",
        remedy="Compare the declared payload with the real one, and check the torque limits in the report.",
    ),
    Code(
        code="RBL524",
        name="seam-too-far",
        meaning="A seam sensor measures the seam farther from its taught place than its limits allow.",
        remedy="Check the work piece and the sensor, or raise most_mm and most_deg of the sensor in the cell file.",
    ),
    Code(
        code="RBL525",
        name="seam-lost",
        meaning="A seam sensor has given no reading for too long.",
        remedy="Check the sensor, or raise lost_ms of the sensor in the cell file.",
    ),
    Code(
        code="RBL526",
        name="seam-not-followed",
        meaning="The joints cannot follow the seam that the sensor measures: out of reach, out of range or too fast.",
        remedy="Move slower, teach the seam closer to its real place, or lower most_mm of the sensor in the cell file.",
    ),
    Code(
        code="RBL530",
        name="stopped-by-user",
        meaning="The run was stopped from outside (Ctrl-C or SIGTERM).",
        remedy="Nothing is to be corrected. Where the program can go on, acknowledge the stop (Reset), then go on "
        "(Start) or begin anew (Restart); of a run, log and report are complete up to the stop.",
    ),
    Code(
        code="RBL535",
        name="part-pushed",
        meaning="The arm, the hand or a held part has touched another part, and has moved it by more than 0.5 mm or "
        "was stopped by it.",
        remedy="Keep clear of the part: move from another side, open the hand where there is space, or grip the held "
        "part at another place.",
    ),
    Code(
        code="RBL536",
        name="part-lost",
        meaning="A part that HAND ON has gripped is no longer held, although no HAND OFF has released it.",
        remedy="Move with less ACCEL, grip closer to the centre of gravity, or give the hand more grip_force_n or "
        "larger pads (pad_mm) in the cell file, a suction cup more holding_force_n.",
    ),
    Code(
        code="RBL537",
        name="obstacle-touched",
        meaning="The arm or the hand has touched an obstacle of the cell, the floor or a link of the arm, or a held "
        "part has slid along an obstacle.",
        remedy="Lift the part before it is moved, move over a via point, or correct the obstacle in the cell file.",
    ),
)
