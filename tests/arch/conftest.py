"""The trees of all sources are kept while tests of the architecture run, and no longer."""

import pytest

from tests.arch.parsed import nodes_of


@pytest.fixture(scope="package", autouse=True)
def trees():
    yield
    nodes_of.cache_clear()
