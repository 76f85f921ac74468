"""Bounds of rules that a shop may set: how near to a limit a motion may come before it is a finding.

``robolang.toml`` sets them in a table with the name of the rule. Reasons for the defaults: half a degree is more than a
taught point scatters; two degrees at the wrist let a joint turn about 30 times as fast as the tool (1 / sin 2 deg); the
shoulder's 20 mm do the same at a reach of 600 mm. ::

    [lint.near-joint-limit]
    margin_deg = 5
"""

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.core.faults import lookup


@dataclass(frozen=True, slots=True, kw_only=True)
class Bound:
    """A number of a rule: its key in the table of the rule, its unit, its range and its default."""

    code: str
    key: str
    unit: str
    default: float
    low: float
    high: float
    meaning: str

    @property
    def rule(self) -> str:
        """Name of the rule, which is that of its table."""
        return lookup(self.code).name


RANGE_MARGIN = Bound(
    code="RBL422",
    key="margin_deg",
    unit="deg",
    default=0.5,
    low=0.0,
    high=90.0,
    meaning="a joint nearer than this to the end of its range is reported",
)
WRIST = Bound(
    code="RBL427",
    key="wrist_deg",
    unit="deg",
    default=2.0,
    low=0.0,
    high=45.0,
    meaning="a wrist bent by less than this is reported",
)
ELBOW = Bound(
    code="RBL427",
    key="elbow_deg",
    unit="deg",
    default=2.0,
    low=0.0,
    high=45.0,
    meaning="an elbow nearer than this to stretched or folded is reported",
)
SHOULDER = Bound(
    code="RBL427",
    key="shoulder_mm",
    unit="mm",
    default=20.0,
    low=0.0,
    high=500.0,
    meaning="a wrist centre nearer than this to axis 1 is reported",
)
BOUNDS = (RANGE_MARGIN, WRIST, ELBOW, SHOULDER)


class Bounds:
    """The bounds in force: those that are set, and the defaults of the others."""

    __slots__ = ("_given",)

    def __init__(self, given: Mapping[Bound, float] | None = None) -> None:
        self._given = dict(given or {})

    def __getitem__(self, bound: Bound) -> float:
        """Return the value of a bound, in its unit."""
        return self._given.get(bound, bound.default)

    def __eq__(self, other: object) -> bool:
        # values in force: a bound that is set to its default is the same as one that is not set
        return isinstance(other, Bounds) and all(self[bound] == other[bound] for bound in BOUNDS)

    __hash__ = None  # type: ignore[assignment]


def of_rule(code: str) -> tuple[Bound, ...]:
    """Return the bounds of a rule."""
    return tuple(bound for bound in BOUNDS if bound.code == code)


def shown(bound: Bound) -> str:
    """Return a bound as ``key = default unit, low to high: meaning``."""
    return f"{bound.key} = {bound.default:g} {bound.unit}, from {bound.low:g} to {bound.high:g}: {bound.meaning}"
