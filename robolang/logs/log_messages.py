"""Alarms, warnings and what PRINT showed, as lines of a log in viewers: ``foxglove.Log``."""

from collections.abc import Iterator, Mapping
from typing import Any

from robolang.logs.foxglove import ERROR, INFO, WARNING, message, plain
from robolang.logs.transforms import stamp

TOPIC = "/log"


def log_messages(meta: Mapping[str, Any]) -> Iterator[tuple[int, str, bytes]]:
    """Yield time ns, topic and data, in the order of time."""
    report, program = meta["report"], str(meta["program"]["name"])
    rows = [(each["time_s"], INFO, each["text"], 0) for each in report.get("printed", ())]
    for level, key in ((WARNING, "warnings"), (ERROR, "alarms")):
        rows += [
            (each["time_s"], level, f"{each['code']} {each['message']}", each["line"] or 0)
            for each in report.get(key, ())
        ]
    # of those of one time in the order of their levels, as the report has them
    for time_s, level, text, line in sorted(rows, key=lambda row: row[0]):
        time_ns = round(time_s * 1e9)
        made = message("Log")(level=level, message=plain(text), name="robolang", file=plain(program), line=line)
        stamp(made.timestamp, time_ns)
        yield time_ns, TOPIC, made.SerializeToString(deterministic=True)
