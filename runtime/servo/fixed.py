"""Inertia of gains that do not follow the posture, and the bounds of stability that follow from the inertia range.

The range of an axis is taken over its joint ranges, from the bare arm to the rated payload at the tool point. With
Dm' the inertia in the gains and D' the true one, both with the rotor (docs/servo.md):

    velocity loop, sampled with period Ts      Kv (Dm'/D') Ts < 2
    measured derivatives, (6) and (10)         (Ka + Kv Kp K2 D/Kc) Dm'/D' < 1

Both are necessary, not sufficient: the current loop and the estimates of speed and acceleration take their share.
With scheduled gains Dm' = D' and the second is the bound of the document's equations at the largest D.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array
from runtime.dynamics.equations import inertia_range
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.axes import bandwidths, rotors
from runtime.settings.profile import Profile, ServoOptions


@dataclass(frozen=True, slots=True, kw_only=True)
class Excess:
    """A bound that axis ``axis`` (0-based) breaks: ``key`` of the profile, the value it has and the bound, units."""

    key: str
    axis: int
    what: str
    value: float
    bound: float


def rated_range(spec: RobotSpec, X_flange_tool: Array) -> tuple[Array, Array]:
    """Return smallest and largest D (n,), kg m2, bare to rated payload at the tool point."""
    return inertia_range(spec, Payload(mass=spec.rated_payload, cog=np.array(X_flange_tool[:3, 3])))


def fixed_inertia(spec: RobotSpec, options: ServoOptions, X_flange_tool: Array) -> Array:
    """Return D (n,), kg m2, of gains that are held fixed at the smallest, middle or largest of each axis' range."""
    smallest, largest = rated_range(spec, X_flange_tool)
    return {"min": smallest, "mid": np.asarray(0.5 * (smallest + largest)), "max": largest}[options.fixed_at]


def excesses(spec: RobotSpec, profile: Profile, X_flange_tool: Array) -> Iterator[Excess]:
    """Yield the stability bounds that the gains break somewhere in the inertia range."""
    options = profile.servo
    Kp, Kv = bandwidths(spec, options)
    yield from _sampled("position_bandwidth_rad_s", Kp, np.ones(spec.n), profile.tick_s)
    yield from _sampled("velocity_bandwidth_rad_s", Kv, np.ones(spec.n), profile.tick_s)
    feeds_back = options.source == "measured" and options.spring_compensation + options.acceleration_feedforward > 0.0
    # with D' in the gains and nothing fed back the poles are the same in every posture: no range to check
    if options.mode == "scheduled" and not feeds_back:
        return
    rotor = rotors(spec, options)
    ends = rated_range(spec, X_flange_tool)
    held = fixed_inertia(spec, options, X_flange_tool) if options.mode == "fixed" else None
    # both shares rise or fall with D throughout: the ends of the range are the worst
    for D in ends:
        ratio = np.ones(spec.n) if held is None else (held + rotor) / (D + rotor)
        yield from _sampled("velocity_bandwidth_rad_s", Kv, ratio, profile.tick_s)
        if feeds_back:
            # 0 on a rigid gear, whose Kc is infinite
            spring = Kv * Kp * options.spring_compensation * D / spec.per_axis("motor", "stiffness")
            key = "acceleration_feedforward" if options.spring_compensation == 0.0 else "spring_compensation"
            share = (options.acceleration_feedforward + spring) * ratio
            for axis in np.flatnonzero(~(share < 1.0)):  # not ``>=``: NaN must be refused too
                yield Excess(
                    key=key,
                    axis=int(axis),
                    value=float(share[axis]),
                    bound=1.0,
                    what=f"(Ka + Kv Kp K2 D/Kc) Dm'/D' at D = {D[axis]:.4g} kg m2",
                )


def _sampled(key: str, bandwidth: Array, ratio: Array, tick_s: float) -> Iterator[Excess]:
    """Check the pole 1 - K r Ts of a sampled loop against -1, with r = Dm'/D'."""
    for axis in np.flatnonzero(~(bandwidth * ratio * tick_s < 2.0)):
        what = f"{key} at Dm'/D' = {ratio[axis]:.3g}" if ratio[axis] != 1.0 else key
        yield Excess(key=key, axis=int(axis), what=what, value=float(bandwidth[axis] * ratio[axis]), bound=2.0 / tick_s)
