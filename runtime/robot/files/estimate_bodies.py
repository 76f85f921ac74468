"""Reach of an arm, and bodies for links whose file has none: cylinders from joint to joint that share a mass.

The mass of all that moves follows from the reach (``estimate_rules.moving_mass``), or from the links that are known.
Each link has the share (l + reach / 10)^1.5 of it, l the length of the chain from its joint to the flange. A link that
slides is as long as its travel, but for the first: its travel lies on the ground.
"""

from collections.abc import Sequence

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul, norm
from runtime.robot.files import estimate_rules as rules
from runtime.robot.files.body_plausibility import offsets
from runtime.robot.files.imported import rotation_z_to
from runtime.robot.kinematics.chain import Chain
from runtime.robot.model.spec import Body

_POSTURES, _STEPS, _SWEEPS, _SEED = 2000, 37, 3, 1981
_SHARE_FLOOR, _SHARE_POWER = 0.1, 1.5


def postures(lower: Array, upper: Array, count: int) -> Array:
    """Return random joint positions (count, n) rad or m inside the ranges, the same for every call."""
    return np.random.default_rng(_SEED).uniform(lower, upper, (count, len(lower)))


def reach_of(chain: Chain, lower: Array, upper: Array) -> float:
    """Return the largest distance of the flange from axis 1, m, within the ranges (n,) rad: as data sheets state it.

    Found by random postures and turns of single joints from the best one: within some mm.
    """
    origin, direction = chain.placements[0][:3, 3], chain.placements[0][:3, 2]

    def distance(q: Array) -> Array:
        return np.asarray(np.linalg.norm(np.cross(chain.flange(q)[..., :3, 3] - origin, direction), axis=-1))

    # random first: turning joints one by one from the zero pose would stay in the first dead end, the folded arm
    tried = postures(lower, upper, _POSTURES)
    best = tried[int(np.argmax(distance(tried)))]
    for axis in list(range(len(lower))) * _SWEEPS:
        turned = np.repeat(best[None], _STEPS, axis=0)
        turned[:, axis] = np.linspace(lower[axis], upper[axis], _STEPS)
        best = turned[int(np.argmax(distance(turned)))]
    return float(distance(best))


def link_radii(chain: Chain, reach: float) -> Array:
    """Return the radii of the capsules of all links (n,), m.

    The last link begins close to where the one three before it ends: radii that overlap there would touch in every
    posture and hide what really touches, so they leave a tenth of that distance free.
    """
    n = len(chain.placements)
    arm = np.arange(n) < rules.arm_axes(n)
    radii = np.where(arm, rules.ARM_RADIUS, rules.WRIST_RADIUS) * min(1.0, max(rules.SMALLEST_SCALE, reach))
    origins = [X[:3, 3] for X in chain.axis_frames(np.zeros(n))]
    gaps = [(norm(origins[k + 3] - origins[k + 1]), radii[k] + radii[k + 3]) for k in range(n - 3)]
    # joints in one point are no gap: such links are never checked against one another
    return np.asarray(
        radii * min([1.0, *(rules.GAP_SHARE * gap / both for gap, both in gaps if gap > rules.ONE_POINT)])
    )


def link_lengths(chain: Chain, lower: Array, upper: Array) -> Array:
    """Return the lengths (n,) m of all links, from each joint to the next, with the travel of those that slide."""
    lengths = np.asarray(np.linalg.norm(offsets(chain.placements, chain.X_last_flange), axis=1)[1:])
    for axis in chain.sliding - {0}:
        lengths[axis] += upper[axis] - lower[axis]
    return lengths


def masses(lengths: Array, reach: float, known: Sequence[Body | None]) -> Array:
    """Return the masses (n,) kg of all links: those that are known, and estimates from ``lengths`` (n,) m."""
    ahead = np.cumsum(lengths[::-1])[::-1]
    shares = (ahead + _SHARE_FLOOR * reach) ** _SHARE_POWER
    shares /= shares.sum()
    given = [body is not None for body in known]
    # links that are known say more of an arm than its reach: light and heavy arms of one size exist
    total = rules.moving_mass(reach)
    if any(given):
        total = sum(body.mass for body in known if body is not None) / float(shares[given].sum())
    return np.array([total * share if body is None else body.mass for share, body in zip(shares, known, strict=True)])


def cylinder(end: Array, mass: float, radius: float) -> Body:
    """Return a cylinder of ``mass`` kg and ``radius`` m from the origin to ``end`` (3,) m, as long as wide at least."""
    # a link whose two joints are in one point still has a size
    length = norm(end)
    along, across = 0.5 * mass * radius**2, mass * (3.0 * radius**2 + max(length, 2.0 * radius) ** 2) / 12.0
    R = rotation_z_to(end / length) if length > 1e-6 else np.eye(3)
    inertia = matmul(R, np.diag([across, across, along]), R.T)
    return Body(mass=mass, cog=frozen(0.5 * end), inertia=frozen(0.5 * (inertia + inertia.T)))
