"""Where before an arm a table can stand: places whose points the arm reaches with room to all its limits.

A job is a set of poses of the tool over a table. For tables of many heights and distances before the arm, and four
sides of it, inverse kinematics gives the joint angles of all poses in one arm configuration. A place is rated by the
worst of two numbers, each 1 where it is as good as needed:

- the smallest distance of a joint from the end of its range, as a share of the range, over ``ROOM``;
- the smallest singular value of the Jacobian at the tool point, lengths as shares of the reach, over ``STEADY``: it is
  0 in a singular posture (T. Yoshikawa, Manipulability of robotic mechanisms, Int. J. Robotics Research 4(2), 1985).

Nothing of the arm from its third axis on may be lower than ``ABOVE`` over the table.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from robolang.templates.placement import DECIMALS, Placement
from runtime.core.frames import Array, inverse, pose
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import BRANCHES

Position = tuple[float, float, float]

ROOM, STEADY, ABOVE = 0.04, 0.1, 0.05
"""Share of the range, share of the reach, m: see the module."""
LEAST = 0.25
"""A place that is rated less is none."""
HEADINGS, YAWS = (0, 90, -90, 180), (0, 180)
NEAREST, BEST_AHEAD, FURTHEST = 0.25, 0.5, 0.85
"""Distances of the middle of the table from the base, as shares of the reach."""
BELOW, LOWEST, HIGHEST = 0.1, -0.8, 0.4
"""The height that suits an arm, below its second axis, and heights of tables over that one, as shares of the reach."""
ABOUT_DOWN = 0.999
"""Cosine of the angle from straight down within which a tool points down."""
STEPS = 0.05, 0.03
"""Of distance and height, as shares of the reach."""
GRID_MM = 10.0
"""Tables stand at whole numbers of these."""
SLAB_MM = 50.0
"""Thickness of a table: none stands lower than on the floor."""
BASE_MM = 100.0
"""Radius of the base of an arm, which no table stands nearer to: files of robots do not have it."""
MOST_PLACES = 8
AT_ONCE = 64
"""Tables whose joint angles are computed together."""
MOST_SEARCHED = 60
"""Tables that are examined for an arm without a closed form, each in several searches, for one heading and yaw."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """The poses of the tool (N, 4, 4) over a table, in the frame of the middle of its top; the first one is HOME.

    ``from_mm`` is that middle in the template, ``depth_mm`` how deep the table is, ``X_flange_tool`` (4, 4) the tool.
    """

    X_table_tool: Array
    from_mm: Position
    depth_mm: float
    X_flange_tool: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    rating: float
    placement: Placement


def placements(kinematics: Kinematics, job: Job) -> Iterator[Placement]:
    """Yield places for a job before an arm, the best first, at most ``MOST_PLACES`` of each heading."""
    for heading in HEADINGS:
        found: list[_Place] = []
        for place in _examined(kinematics, job, heading):
            # in order of preference, so that one without a fault needs no comparison with those that follow
            if place.rating >= 1.0:
                yield place.placement
            else:
                found.append(place)
        found.sort(key=lambda each: -each.rating)
        yield from (each.placement for each in found[:MOST_PLACES])


def _examined(kinematics: Kinematics, job: Job, heading: int) -> Iterator[_Place]:
    reach = _reach(kinematics)
    height = _best_height(kinematics, job, reach)
    nearest_mm = 0.5 * job.depth_mm + BASE_MM
    tables = [table for table in _tables(reach, height) if table[0] >= nearest_mm]
    # a search by Newton's method takes a hundred times as long as the closed form
    if not kinematics.closed_form:
        tables = tables[:MOST_SEARCHED]
    for yaw in YAWS:
        for to_mm, postures in _reached(kinematics, job, tables, heading, yaw):
            ratings = np.array([0.0, *(_rating(kinematics, q, reach, to_mm[2], job) for q in postures)])
            best = int(np.argmax(ratings))
            if ratings[best] >= LEAST:
                # + 0.0: an angle of -0.0 is 0
                home = tuple(round(float(value), DECIMALS) + 0.0 for value in postures[best - 1][0] / kinematics.units)
                placement = Placement(
                    from_mm=job.from_mm,
                    to_mm=to_mm,
                    heading_deg=heading,
                    yaw_deg=yaw,
                    home=home,
                    slides=bool((kinematics.units != DEG).any()),
                )
                yield _Place(rating=float(ratings[best]), placement=placement)


def _reach(kinematics: Kinematics) -> float:
    """Return how far the flange of an arm is from its first axis at most, m."""
    # stretched, since the angles at which an arm reaches furthest are not known without its kinematics
    links = [axis.placement[:3, 3] for axis in kinematics.spec.axes[2:]] + [kinematics.spec.X_last_flange[:3, 3]]
    first = kinematics.spec.axes[1].placement[:2, 3]
    return float(np.linalg.norm(first) + sum(np.linalg.norm(link) for link in links))


def _best_height(kinematics: Kinematics, job: Job, reach: float) -> float:
    """Return how high a table suits an arm, m."""
    spec = kinematics.spec
    X = kinematics.forward(0.5 * (spec.lower + spec.upper))
    # a SCARA: its tool points down everywhere, and the middle of its stroke is the middle of the job
    if -X[2, 2] >= ABOUT_DOWN:
        heights = job.X_table_tool[:, 2, 3]
        return float(X[2, 3] - job.X_flange_tool[2, 3] - 0.5 * (heights.min() + heights.max()))
    second = spec.axes[0].placement[2, 3] + spec.axes[1].placement[2, 3]
    return float(second - BELOW * reach)


def _tables(reach: float, height: float) -> Iterator[Position]:
    """Yield where the middle of a table may be (3,), mm, what suits most arms first."""
    ahead = np.arange(NEAREST, FURTHEST, STEPS[0])
    above = np.arange(LOWEST, HIGHEST, STEPS[1])
    # the sum of both deviations: neither a table at the right height far away nor a near one overhead comes early
    by_fit = sorted(((x, z) for x in ahead for z in above), key=lambda site: abs(site[0] - BEST_AHEAD) + abs(site[1]))
    seen = set()
    for x, z in by_fit:
        table = (_on_grid(x * reach), 0.0, max(_on_grid(z * reach + height), SLAB_MM))
        if table not in seen:
            seen.add(table)
            yield table


def _on_grid(length: float) -> float:
    return GRID_MM * round(length / MM / GRID_MM)


def _reached(
    kinematics: Kinematics, job: Job, tables: Sequence[Position], heading: int, yaw: int
) -> Iterator[tuple[Position, Sequence[Array]]]:
    """Yield tables with the joint angles (N, n) that meet all poses over each, one for each arm configuration."""
    about_base, about_tool = (pose(rotation=_about_z(angle)) for angle in (heading, yaw))
    X_table_flange = job.X_table_tool @ about_tool @ inverse(job.X_flange_tool)
    for first in range(0, len(tables), AT_ONCE):
        some = tables[first : first + AT_ONCE]
        poses = np.stack([about_base @ pose(np.array(to_mm) * MM) @ X_table_flange for to_mm in some])
        yield from zip(some, _postures(kinematics, poses), strict=True)


def _about_z(angle_deg: float) -> Array:
    c, s = np.cos(angle_deg * DEG), np.sin(angle_deg * DEG)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _postures(kinematics: Kinematics, poses: Array) -> Iterator[Sequence[Array]]:
    """Yield the joint angles (N, n) that meet poses (N, 4, 4), for each (T, N, 4, 4)."""
    if kinematics.closed_form:
        q = np.stack([kinematics.inverse_branch(poses, branch) for branch in BRANCHES], axis=1)
        inside = kinematics.limit_margin(q).min(axis=-1) > 0.0
        # a pose that is not met has NaN, which is not inside
        yield from (list(rows[met]) for rows, met in zip(q, inside, strict=True))
        return
    for each in poses:
        # HOME alone is searched: the other poses are near to it, and are followed from there
        starts = [found for found in kinematics.solutions(each[0]) if found.limit_margin > 0.0]
        rows = [kinematics.inverse_branch(each, start.branch, start.q) for start in starts]
        yield [q for q in rows if np.isfinite(q).all()]


def _rating(kinematics: Kinematics, q: Array, reach: float, top_mm: float, job: Job) -> float:
    """Return the rating of joint angles (N, n); see the module."""
    spec = kinematics.spec
    room = (np.minimum(q - spec.lower, spec.upper - q) / (spec.upper - spec.lower)).min()
    # the first two axes are the column of the arm, which may stand on the floor beside the table
    heights = [X[..., 2, 3].min() for X in kinematics.chain.axis_frames(q)][2:]
    if not room > 0.0 or not np.min(heights, initial=np.inf) >= top_mm * MM + ABOVE:
        return 0.0
    J, R = kinematics.jacobian_and_rotation(q)
    # at the tool point: the velocity of the flange and what its turning adds
    arm = R @ job.X_flange_tool[:3, 3]
    J[:, :3] += np.cross(J[:, 3:].transpose(0, 2, 1), arm[:, None]).transpose(0, 2, 1)
    J[:, :3] /= reach
    steady = np.linalg.svd(J, compute_uv=False)[:, -1].min()
    return float(min(room / ROOM, steady / STEADY, 1.0))
