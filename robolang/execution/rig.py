"""A rig: one robot in its cell with its controller and supervision, for a run, an experiment or a drive by tables.

The plant is MuJoCo or the ideal arm. A controller compensates for what its plant has: the ideal arm has no friction and
no gear springs, so ``fitted`` takes both out of the profile.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from robolang.execution.plan_memory import PlanMemory
from robolang.project.project import Project
from runtime.cell.cell import CellSpec
from runtime.control.clock import PacedClock, VirtualClock
from runtime.control.controller import Controller
from runtime.motion.motion_planner import MotionPlanner
from runtime.plant.plant import Plant
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

IdealArm = Callable[[RobotSpec, CellSpec, float], Plant]
"""Of a robot, its cell and the servo tick, s: an arm without a physics engine."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rig:
    """A controller over its plant."""

    controller: Controller

    @property
    def plant(self) -> Plant:
        """The robot."""
        return self.controller.plant

    @classmethod
    def of(
        cls, project: Project, physics: bool = True, *, realtime: bool = False, plans: PlanMemory | None = None
    ) -> "Rig":
        """Return the rig of a project, its arm at home; ``realtime`` keeps wall time.

        ``plans`` are those of a check before the run: what begins as it did there is not planned again.
        """
        cell, profile = project.cell, fitted(project.profile, physics)
        plant = plant_of(cell, profile.tick_s, physics)
        return cls.over(plant, cell, profile, realtime=realtime, planner=plans or PlanMemory(project))

    @classmethod
    def over(
        cls,
        plant: Plant,
        cell: CellSpec,
        profile: Profile,
        *,
        realtime: bool = False,
        planner: MotionPlanner | None = None,
    ) -> "Rig":
        """Return a rig over a plant, under a profile that is taken as it is.

        ``cell`` is the one that the controller knows; the plant may have been made of another one, with other masses.
        """
        clock = PacedClock(profile.period_us) if realtime else VirtualClock()
        controller = Controller(cell.robot, plant, profile, cell.hand.X_flange_tool, clock, planner)
        return cls(controller=controller)


def plant_of(cell: CellSpec, tick_s: float, physics: bool, ideal: IdealArm = RigidPlant) -> Plant:
    """Return the robot of a cell, at home with an open hand: MuJoCo, or without physics what ``ideal`` makes.

    ``FileFault`` RBL608 for physics with an arm whose drives no file states.
    """
    if not physics:
        return ideal(cell.robot, cell, tick_s)
    # here and not when the file is read: planning and the ideal arm do without drives
    if cell.robot.undriven is not None:
        raise cell.robot.undriven
    from runtime.plant.mujoco_plant import MujocoPlant  # only here: it takes longer to import than all the rest

    return MujocoPlant(cell.robot, cell, tick_s)


def fitted(profile: Profile, physics: bool) -> Profile:
    """Return a profile whose supervision and compensation fit the plant: MuJoCo or the ideal arm."""
    known = profile.supervision.friction
    # not given: the plant has all of the friction of the robot file, whatever the servo compensates
    friction = (1.0 if known is None else known) if physics else 0.0
    profile = replace(profile, supervision=replace(profile.supervision, friction=friction))
    if physics:
        return profile
    servo = replace(profile.servo, friction_compensation=0.0, spring_compensation=0.0, gravity_lead=0.0)
    return replace(profile, servo=servo)
