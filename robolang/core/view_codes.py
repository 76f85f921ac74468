"""Codes of seeing a run: logs that are read, pages, pictures, films, the live view.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL820",
        name="log-lacks-this",
        meaning="A log of a run lacks what is needed: it was written by an older version of robolang.",
        remedy="Run the program again with --log; what the old log holds can still be read by robolang.read_log.",
    ),
    Code(
        code="RBL821",
        name="log-too-new",
        meaning="A log of a run was written by a newer version of robolang, whose layout this one does not know.",
        remedy="Install the version of robolang that wrote the log, or a later one.",
    ),
    Code(
        code="RBL822",
        name="log-not-kept",
        meaning="A run that was carried out without a log is to give its signals.",
        remedy="Run the program with --log, or in Python with Session(project), which keeps the log.",
    ),
    Code(
        code="RBL825",
        name="viewer-incomplete",
        meaning="The files that every page is made of are missing from the installation, or are not those of a page.",
        remedy="Install robolang again.",
    ),
    Code(
        code="RBL826",
        name="runs-of-two-robots",
        meaning="Two runs cannot be compared in one page: they are of different robots.",
        remedy="Write a page for each of them.",
    ),
    Code(
        code="RBL834",
        name="live-port-unusable",
        meaning="The live view cannot listen on this port: another program has it, or it needs more rights.",
        remedy="Give another --port from 1024 to 65535, or none: a free one is taken.",
    ),
    Code(
        code="RBL835",
        name="live-command-invalid",
        meaning="A message of the live page is no command, or a value in it has another type or is out of its range.",
        remedy="Reload the page by the address that the command has printed.",
    ),
    Code(
        code="RBL836",
        name="live-command-too-early",
        meaning="A command of the live page cannot be carried out in the present state of the program or the arm.",
        remedy="Pause the program, or wait until the arm rests, and send the command again.",
    ),
    Code(
        code="RBL837",
        name="live-without-control",
        meaning="A page that only watches has sent a command: one page at a time has control.",
        remedy="Give control back in the page that has it, or close that page; then take it in this one.",
    ),
)
register(
    Code(
        code="RBL838",
        name="signal-unknown",
        meaning="A log has no signal, or a signal no column, of this name.",
        remedy="Give one of those that are listed; 'robolang log show RUN' lists all of a log.",
    ),
    Code(
        code="RBL839",
        name="format-unavailable",
        meaning="A file format needs a library or a font that is not installed.",
        remedy="Install it, as the message says, or write another format.",
    ),
)
