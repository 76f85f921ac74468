"""What ``import robolang`` offers to Python: to analyse a program, to run it, and to carry it out step by step.

Everything else is internal and may change. ``robolang`` imports this module when a name of it is first used.
"""

from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import Diagnostic, Edit
from robolang.core.source import Source, Span, read_program
from robolang.execution.executor import Executor, ExecutorSnapshot
from robolang.execution.observer import Observer
from robolang.execution.result import RunResult
from robolang.execution.session import ProgramError, Session, run
from robolang.execution.status import ENDED, State, Status
from robolang.execution.timeline import Timeline
from robolang.logs.files import read_log
from robolang.logs.log import Log
from robolang.project.project import Project, load_project
from robolang.syntax.ast import Line
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault

# ``robolang/__init__`` has these names as well: to read them here it would import numpy and the run
__all__ = [
    "ENDED",
    "Analysis",
    "Diagnostic",
    "Edit",
    "Executor",
    "ExecutorSnapshot",
    "Fault",
    "FileFault",
    "Line",
    "Log",
    "Observer",
    "ProgramError",
    "Project",
    "RunResult",
    "Session",
    "Source",
    "Span",
    "State",
    "Status",
    "Timeline",
    "load_project",
    "read_log",
    "read_program",
    "run",
]
