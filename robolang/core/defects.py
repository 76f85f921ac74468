"""A defect of robolang itself as a fault: RBL900, and never a traceback."""

import os

import robolang.core.codes  # noqa: F401 - the code raised here must be registered
from runtime.core.faults import Fault


def internal(error: Exception) -> Fault:
    """Return the fault that stands for a defect of robolang itself; raises the error under ``ROBOLANG_DEBUG``."""
    if os.environ.get("ROBOLANG_DEBUG"):
        raise error
    kind = type(error).__name__
    hint = "this is a defect of robolang; ROBOLANG_DEBUG=1 shows where it happened"
    return Fault("RBL900", f"internal error: {kind}: {error}", hint)
