"""What a planned jog has to say: how far it goes, what ends it, and where and why it is slow."""

import math

from robolang.execution.regain import Displaced
from robolang.teaching.jogging import JogRequest, is_linear
from runtime.motion.jog import JogPlan


def remarks(request: JogRequest, plan: JogPlan) -> tuple[str, ...]:
    """Return a line for each thing that a programmer has not typed: the end of a jog as far as it goes, slow places."""
    return tuple(line for line in (_end(request, plan), _slow(request, plan)) if line)


def cut_short(request: JogRequest, moved: Displaced, *, late: bool) -> str | None:
    """Return what is to be known of a jog that was stopped after it has ``moved``; None: it ended as it was meant to.

    ``late``: its page has not shown in time that the button is held. Without that a jog as far as it goes ends by its
    release, while one by an amount goes to its end.
    """
    endless = math.isinf(request.amount)
    if endless and not late:
        return None
    # of a joint that slides it is mm: ``Displaced`` counts them as deg
    turned = moved.joint_deg if request.axis.startswith("J") else moved.angle_deg
    goes = moved.distance_mm if is_linear(request.axis) else turned
    of = "" if endless else f" of {abs(request.amount):g}"
    reason = ": the page was too slow" if late else ""
    return f"the jog was stopped after {goes:.1f}{of} {request.unit}{reason}"


def _end(request: JogRequest, plan: JogPlan) -> str:
    goes = f"{request.axis} goes {_amount(request, plan.goes)} at most"
    end = plan.end
    if end.kind == "limit":
        return f"{goes}: {plan.limited}"
    if end.kind == "reach":
        return f"{goes}: there the reach of the arm ends"
    if end.kind == "singularity":
        return f"{goes}: there is a singularity; jog a joint to pass it"
    # what is typed ends where it shall, and a whole turn or a long time needs no reason
    return ""


def _slow(request: JogRequest, plan: JogPlan) -> str:
    slow = plan.slow
    if slow is None or slow.axis is None:
        return ""
    share = f"{100.0 * slow.share:.0f} %" if slow.share >= 0.01 else "under 1 %"
    return (
        f"slow, {share} of the jog speed at {_amount(request, slow.at)}: J{slow.axis + 1} turns far near a singularity"
    )


def _amount(request: JogRequest, value: float) -> str:
    return f"{value / request.size:.1f} {request.unit}"
