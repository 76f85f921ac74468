"""What supervision finds: a value, before the controller latches it as an alarm or keeps it as a warning."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One violation: its code, what happened, the 0-based axis (None: no single one), and the servo tick."""

    code: str
    message: str
    tick: int
    axis: int | None = None
    warning: bool = False
