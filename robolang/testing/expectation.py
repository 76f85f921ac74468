"""What a program is expected to do: the file ``NAME.test.toml`` beside it.

::

    schema = 1
    physics = true                       # false: on the ideal arm
    [expect]                             # every key is optional
    alarms = []                          # codes that the run must end with, in order; none: it ends well
    warnings = []                        # codes of the warnings it must give, and no others; []: it gives none
    cycle_s = [13.5, 14.5]               # least and most time of the whole run
    printed = ["2 parts"]                # the lines of PRINT
    path_error_mm = 0.5                  # most distance of the tool point from its paths, blends not counted
    tool_error_mm = 0.5                  # most distance of the tool from its command
    torque_pct = 80                      # most torque of any joint, of its limit
    end_pose = [480, 0, 840, 180, 0, 180]
    end_mm = 0.5                         # how far from it the tool may end, default 1
    end_deg = 0.5                        # how far the tool may be turned from it, default 1
    golden_deg = 0.01                    # most difference of a joint from NAME.golden.npz, cycle by cycle
    golden_mm = 0.01                     # that of a joint that slides; default: as many mm as golden_deg has deg
    [expect.parts]
    part_1 = [400, 150, 640]             # where a part lies in the end
    part_mm = 1.0                        # how far from there, default 1

``robolang.testing.verdict`` compares a run with it. A key that nothing would be compared by is refused.
"""

import difflib
from dataclasses import dataclass, field
from pathlib import Path

import robolang.core.codes  # noqa: F401 - all codes must be registered
from runtime.core.faults import all_codes
from runtime.core.toml_places import locate
from runtime.core.tomlfile import FileFault, FilePlace, Source, Table, load_table, read_source
from runtime.robot.model.axis_kind import AxisKind

SCHEMA = 1
ENDING = ".test.toml"


@dataclass(frozen=True, slots=True, kw_only=True)
class Expectation:
    """The contents of a test file; None: nothing is expected of it. Units as in the file."""

    source: Source
    physics: bool = True
    alarms: tuple[str, ...] = ()
    warnings: tuple[str, ...] | None = None
    cycle_s: tuple[float, float] | None = None
    printed: tuple[str, ...] | None = None
    path_error_mm: float | None = None
    tool_error_mm: float | None = None
    torque_pct: float | None = None
    end_pose: tuple[float, ...] | None = None
    end_mm: float = 1.0
    end_deg: float = 1.0
    golden_deg: float | None = None
    golden_mm: float | None = None
    parts: dict[str, tuple[float, ...]] = field(default_factory=dict)
    part_mm: float = 1.0

    @property
    def golden(self) -> Path:
        """The golden log beside the test file."""
        path = Path(self.source.path)
        return path.with_name(path.name.removesuffix(ENDING) + ".golden.npz")

    @property
    def golden_key(self) -> str | None:
        """The key that asks for the comparison with the golden log, None: nothing does."""
        return next((key for key in ("golden_deg", "golden_mm") if getattr(self, key) is not None), None)

    def golden_most(self, kind: AxisKind) -> float:
        """Return the largest difference of an axis of a kind from the golden log, in its unit."""
        # bounds of an arm are set once: where one unit is left out, its number is that of the other
        given = (self.golden_mm, self.golden_deg) if kind.slides else (self.golden_deg, self.golden_mm)
        return next((most for most in given if most is not None), 0.0)

    def place(self, *keys: str) -> tuple[int, int]:
        """Return line and column of a key of ``[expect]``, or of the table where the key is left out."""
        return locate(self.source.text, ("expect", *keys))

    def fault(self, code: str, message: str, hint: str, *keys: str) -> FileFault:
        """Return a fault at a key of ``[expect]``."""
        line, column = self.place(*keys)
        excerpt = self.source.text.split("\n")[line - 1].removesuffix("\r")
        return FileFault(code, message, hint, FilePlace(self.source.path, line, column, excerpt))


def load_expectation(path: Path) -> Expectation:
    """Read a test file; ``FileFault`` RBL6xx at the first line that is wrong, with all others."""
    return read_expectation(read_source(path))


def read_expectation(source: Source) -> Expectation:
    """Return the contents of a test file; faults as ``load_expectation``."""
    table = load_table(source, gather=True)
    table.attempt(lambda: _schema(table))
    expect = table.table("expect", required=False)
    parts = expect.table("parts", required=False)
    found = Expectation(
        source=source,
        physics=table.flag("physics", True),
        alarms=expect.attempt(lambda: _codes(expect, "alarms") or ()) or (),
        warnings=expect.attempt(lambda: _codes(expect, "warnings")),
        cycle_s=expect.attempt(lambda: _pair(expect, "cycle_s")),
        printed=expect.attempt(lambda: _texts(expect, "printed")),
        path_error_mm=_most(expect, "path_error_mm"),
        tool_error_mm=_most(expect, "tool_error_mm"),
        torque_pct=_most(expect, "torque_pct"),
        end_pose=expect.numbers("end_pose", 6) if "end_pose" in expect else None,
        end_mm=expect.number("end_mm", 1.0, positive=True),
        end_deg=expect.number("end_deg", 1.0, positive=True),
        golden_deg=_most(expect, "golden_deg"),
        golden_mm=_most(expect, "golden_mm"),
        part_mm=parts.number("part_mm", 1.0, positive=True),
        parts={
            name: parts.attempt(lambda name=name: _end_of_part(parts, name)) or ()  # type: ignore[misc]
            for name in parts.names()
            if name != "part_mm"
        },
    )
    for each in (parts, expect):
        each.done()
    for key in ("end_mm", "end_deg"):
        _without_effect(expect, key, "end_pose" in expect, "expect.end_pose")
    _without_effect(parts, "part_mm", bool(found.parts), "the place of a part in expect.parts")
    table.finish()
    return found


def _schema(table: Table) -> None:
    if table.integer("schema", low=0, high=10**6) != SCHEMA:
        table.fail("RBL605", f"'schema' must be {SCHEMA}", key="schema")


def _end_of_part(parts: Table, name: str) -> tuple[float, ...]:
    """Return where a part ends, mm; a lone number may be a misspelt ``part_mm``."""
    parts.ask(name)
    if not parts.holds(name, list):
        hint = "write the place of the part, [x, y, z] in mm"
        if "part_mm" not in parts:
            hint += "; did you mean 'part_mm'?"
        parts.fail("RBL613", f"'{parts.name(name)}' must be a list of 3 numbers", hint, key=name)
    return parts.numbers(name, 3)


def _without_effect(table: Table, key: str, used: bool, needs: str) -> None:
    """Refuse a tolerance of what is not expected: the file would seem to compare something."""
    if key in table and not used:
        message = f"'{table.name(key)}' is a tolerance of {needs}, which is missing"
        table.attempt(lambda: table.fail("RBL608", message, key=key))


def _texts(table: Table, key: str) -> tuple[str, ...] | None:
    if key not in table:
        return None
    found = table.raw_list(key)
    if not all(isinstance(item, str) for item in found):
        table.fail("RBL613", f"'{table.name(key)}' must be a list of texts", key=key)
    return tuple(found)


def _codes(table: Table, key: str) -> tuple[str, ...] | None:
    """Return a list of codes; a code that there is not would never come, and never be missed where it is forbidden."""
    found, known = _texts(table, key), [code.code for code in all_codes()]
    for code in found or ():
        if code not in known:
            near = difflib.get_close_matches(code.upper(), known, n=1)
            hint = f"did you mean '{near[0]}'?" if near else "robolang explain lists the codes"
            table.fail("RBL610", f"'{code}' in '{table.name(key)}' is not a code", hint, key=key)
    return found


def _pair(table: Table, key: str) -> tuple[float, float] | None:
    if key not in table:
        return None
    low, high = table.numbers(key, 2, low=0.0)
    if not low <= high:
        table.fail("RBL607", f"'{table.name(key)}' must be [least, most]", key=key)
    return low, high


def _most(table: Table, key: str) -> float | None:
    return table.number(key, low=0.0) if key in table else None
