"""What nobody foresaw as a fault and never a traceback: a defect of robolang itself, or a library that is missing."""

import os

import robolang.core.codes  # noqa: F401 - the code raised here must be registered
from runtime.core.faults import Fault

_LIBRARIES = frozenset(
    (
        *("google", "lark", "mcap", "mcap_protobuf", "mujoco", "numpy", "pinocchio", "prompt_toolkit"),
        *("rich", "ruckig", "scipy", "tomlkit", "typer", "websockets"),
    )
)
"""What the dependencies of robolang are imported as; an install that checks text has one of them (docs/ci.md)."""


def internal(error: Exception) -> Fault:
    """Return the fault of a library that is not installed (RBL845), else that of a defect of robolang itself (RBL900).

    Raises the error under ``ROBOLANG_DEBUG``.
    """
    if os.environ.get("ROBOLANG_DEBUG"):
        raise error
    library = (error.name or "").partition(".")[0] if isinstance(error, ModuleNotFoundError) else ""
    if library in _LIBRARIES:
        return Fault("RBL845", f"this command needs {library}, which is not installed")
    kind = type(error).__name__
    hint = "this is a defect of robolang; ROBOLANG_DEBUG=1 shows where it happened"
    return Fault("RBL900", f"internal error: {kind}: {error}", hint)
