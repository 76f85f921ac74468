"""Tests that draw need EGL or OSMesa: they are skipped without, and fail where ROBOLANG_GL is ``required``."""

import os

import pytest

from runtime.core.faults import Fault
from runtime.plant.graphics import open_graphics


def need_graphics() -> None:
    try:
        open_graphics().close()
    except Fault as fault:
        if os.environ.get("ROBOLANG_GL") == "required":
            raise
        pytest.skip(fault.message)
