"""R10 on programs of 1 MB: no crash, 20 s, 300 MB. ``make large`` measures every kind of ``large``, this the worst."""

import pytest

from tests.fuzz import large

WORST = (("comments", "fmt"), ("assignments", "check"))
"""As many lines as there can be, each with a node."""


def test_every_kind_is_as_large_as_it_can_be():
    for kind in large.KINDS:
        found = large.text(kind)
        assert 0.8 * large.SIZE < len(found.encode()) <= large.SIZE, kind


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "command"), WORST)
def test_a_program_of_the_largest_size_stays_in_its_memory(kind, command, tmp_path):
    cost = large.measured(kind, command, tmp_path)
    assert cost.code in (0, 1, 2)
    assert 30.0 < cost.rss_mb <= large.MOST_MB
    assert cost.cpu_s <= large.MOST_S


def test_the_measure_sees_what_a_process_takes(tmp_path):
    small = large.measured("comments", "check", tmp_path, size=1000)
    assert small.code == 0
    assert small.rss_mb < 60.0
