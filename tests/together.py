"""Many small cases in one test, which reports every case that fails.

As tests of their own, thousands of cases that take a millisecond cost several times what they check. A case that needs
a set-up of its own is parametrised instead.
"""

import inspect
import traceback
from collections.abc import Callable, Iterable
from typing import Any

import pytest


def together(
    name: str, cases: Iterable[Any], ids: Callable[[Any], Any] = str
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Call a test with each case as its argument ``name``; its other arguments are fixtures, one for all cases."""
    every = list(cases)
    assert every, "no case, so nothing is tested"

    def one_test(check: Callable[..., None]) -> Callable[..., None]:
        def test(**fixtures: Any) -> None:
            failed = []
            for case in every:
                try:
                    check(**{name: case}, **fixtures)
                except (Exception, pytest.fail.Exception):
                    failed.append(f"--- {ids(case)}\n{traceback.format_exc(limit=-2)}")
            assert not failed, "\n".join([f"{len(failed)} of {len(every)} cases failed", *failed])

        signature = inspect.signature(check)
        others = [parameter for parameter in signature.parameters.values() if parameter.name != name]
        test.__signature__ = signature.replace(parameters=others)  # type: ignore[attr-defined]
        test.__name__, test.__doc__, test.__module__ = check.__name__, check.__doc__, check.__module__
        return test

    return one_test
