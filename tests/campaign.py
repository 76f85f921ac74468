"""The size of the tests: a sample in ``make test``, the whole in ``make campaign``.

What costs much processor time and finds more the more of it there is, is a campaign; a test runs a sample of it.
``tests/processor_time.py`` shows what the tests cost.
"""

import os
from collections.abc import Sequence
from typing import Any

from hypothesis import settings

WHOLE = bool(os.environ.get("CAMPAIGN"))
"""Whether the tests run as the campaign that they are a sample of."""
SAMPLE = 5
"""So many times fewer examples are in a sample."""


def examples(whole: int, sample: int | None = None) -> settings:
    """Return how many examples Hypothesis makes; by default a fifth of them in a sample."""
    return settings(max_examples=whole if WHOLE else sample or whole // SAMPLE)


def some(cases: Sequence[Any], *chosen: int) -> Sequence[Any]:
    """Return all cases, or in a sample those at the chosen places."""
    return cases if WHOLE else [cases[at] for at in chosen]


def size(whole: int, sample: int) -> int:
    """Return the size of what is tested."""
    return whole if WHOLE else sample
