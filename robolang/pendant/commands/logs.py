"""Commands that write the log and the report of what was done since the start state, as ``run`` writes them."""

from pathlib import Path
from typing import TYPE_CHECKING

from robolang.core.storage import write_json
from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.outputs import refuse_open
from robolang.pendant.words import misused

if TYPE_CHECKING:
    from robolang.execution.result import RunResult
    from robolang.pendant.pendant import Pendant

_LOG, _REPORT = "log FILE", "report FILE"


def _log(pendant: "Pendant", rest: str) -> None:
    # late, as all that imports numerics
    from robolang.logs.files import SUFFIXES, write_log

    path = Path(rest)
    if path.suffix not in SUFFIXES:
        raise misused(_LOG, f"the name of a file that ends in {' or '.join(SUFFIXES)} is expected, found '{rest}'")
    refuse_open([path], pendant.desk.documents)
    result = _result(pendant)
    write_log(path, result.log)
    pendant.output.line(f"{path}: {len(result.log['t'])} ticks, {pendant.live.seconds:.3f} s")


def _report(pendant: "Pendant", rest: str) -> None:
    path = Path(rest)
    # a slip must not cost a program or a cell: these are there only once
    if not rest or path.suffix.lower() in (".rbl", ".toml"):
        raise misused(_REPORT, f"the name of a .json file is expected, found '{rest}'")
    refuse_open([path], pendant.desk.documents)
    result = _result(pendant)
    write_json(path, result.report)
    pendant.output.line(f"{path}: {len(result.report['statements'])} statements, {pendant.live.seconds:.3f} s")


def _result(pendant: "Pendant") -> "RunResult":
    return pendant.live.session.result(pendant.live.wall_s)


_SINCE = "It begins at the start state of the cell: after again and run it is that of robolang run."

COMMANDS = (
    Command(
        word="log",
        form=_LOG,
        help="Write all signals of what was done: .npz (numpy) or .mcap (log viewers).",
        group=Group.SESSION,
        do=_log,
        offers=(Offer.FILE,),
        more=_SINCE,
    ),
    Command(
        word="report",
        form=_REPORT,
        help="Write the report of what was done (JSON).",
        group=Group.SESSION,
        do=_report,
        offers=(Offer.FILE,),
        more=_SINCE,
    ),
)
