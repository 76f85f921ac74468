"""R10 on large programs: no crash, bounded memory. ``make large`` has every kind, 1 MB of each, and times."""

import pytest

from tests.fuzz import large

WORST = (("comments", "fmt"), ("assignments", "check"))
"""As many lines as there can be, each with a node."""
TENTH_MB = 80.0
"""Memory for 0.1 MB of them; they take 52 and 65 MB."""


def test_every_kind_is_as_large_as_it_can_be():
    for kind in large.KINDS:
        found = large.text(kind)
        assert 0.8 * large.SIZE < len(found.encode()) <= large.SIZE, kind


@pytest.mark.parametrize(("kind", "command"), WORST)
def test_a_tenth_of_the_largest_program_stays_in_its_memory(kind, command, tmp_path):
    cost = large.measured(kind, command, tmp_path, large.SIZE // 10)
    assert cost.code in (0, 1, 2)
    assert 30.0 < cost.rss_mb <= TENTH_MB


def test_the_measure_sees_what_a_process_takes(tmp_path):
    small = large.measured("comments", "check", tmp_path, size=1000)
    assert small.code == 0
    assert small.rss_mb < 60.0
