"""Gathering the facts of the bottom lines and of completion from a pendant: after each command, not while painting."""

from typing import TYPE_CHECKING

from robolang.analysis.analysis import Analysis
from robolang.pendant.known import Known
from robolang.pendant.standing import place
from robolang.pendant.status import ArmFacts, Facts

if TYPE_CHECKING:
    from robolang.execution.world import RobotWorld
    from robolang.pendant.live import Live
    from robolang.pendant.pendant import Pendant
    from robolang.teaching.felt_payload import PayloadSense


class Gathering:
    """Gathers the facts of one pendant."""

    def __init__(self, pendant: "Pendant") -> None:
        self._pendant = pendant
        self._sense: PayloadSense | None = None
        self._live: Live | None = None

    def facts(self, starting: str = "") -> Facts:
        """Return what is shown now; ``starting``: why the controller is not ready."""
        pendant = self._pendant
        live = pendant.built
        alarm = None if live is None else live.executor.status.alarm
        return Facts(
            mode=pendant.mode.value,
            armed=pendant.armed,
            program=pendant.desk.documents.path.name,
            unsaved=bool(pendant.desk.unsaved),
            # a program without a statement is not over: it has not been written
            place=place(live) if live is not None and pendant.desk.analysis.program.statements else "",
            alarm="" if alarm is None else alarm.code,
            starting="" if live is not None else starting,
            arm=None if live is None else self._arm(live),
        )

    def _arm(self, live: "Live") -> ArmFacts:
        # numerics: they are there as soon as a controller is
        from robolang.pendant.commands.showing import shown
        from robolang.teaching.posture import posture

        arm, controller = live.arm, live.controller
        near = posture(live.q, controller.kinematics)
        singular = near.singular
        return ArmFacts(
            frame=shown(arm.frame, "WORLD"),
            tool=shown(arm.tool, "hand"),
            declared_kg=controller.areas.sda.mass,
            felt_kg=self._felt_kg(live),
            joints=arm.joints,
            pose=arm.tool_in_frame,
            limit=f"J{near.limit.joint + 1} {near.limit.margin:.1f} deg",
            singular="" if singular is None else f"{singular.name} {singular.distance:.1f} {singular.unit}",
            holding=controller.drives.plant.hand().holding or "",
            seconds=live.seconds,
        )

    def _felt_kg(self, live: "Live") -> float | None:
        from robolang.teaching.felt_payload import PayloadSense

        # each start of the cell has a controller of its own
        if self._sense is None or self._live is not live:
            self._sense, self._live = PayloadSense(live.controller), live
        felt = self._sense.felt()
        return None if felt is None else felt.mass


def known(pendant: "Pendant") -> Known:
    """Return what completion knows now; before the cell is read, the program alone."""
    project, live = pendant.loaded, pendant.built
    if project is None:
        return Known(analysis=pendant.desk.analysis)
    found = Known(
        analysis=_of_desk(pendant, project.analysis),
        points=project.points.points,
        axes=project.cell.robot.n,
    )
    if live is None:
        return found
    from robolang.pendant.commands.showing import value_text

    executor = live.executor
    values = {key: value_text(value) for names in executor.variables for key, value in names.values.items()}
    world = executor.world
    inputs = {number: world.input(number) for number in project.cell.inputs}
    return found.replaced(values=values, inputs=inputs, outputs=_outputs(world))


def _of_desk(pendant: "Pendant", analysis: Analysis) -> Analysis:
    """Return the analysis of the text as it is edited, in the cell that was read last."""
    return pendant.desk.analysis.within(analysis.cell)


def _outputs(world: "RobotWorld") -> dict[int, float]:
    now_us = round(world.seconds() * 1e6)
    return {number: world.signals.output(number, now_us) for number in world.signals.snapshot().outputs}
