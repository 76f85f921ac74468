"""What ``import robolang`` offers to Python: to check, plan and run programs, step by step too, and the experiments.

Everything else is internal and may change. ``robolang`` imports this module when a name of it is first used.
"""

from robolang.analysis.analysis import Analysis
from robolang.api.checking import check, check_text
from robolang.api.experiments import Comparison, compare, identify, step, weigh
from robolang.api.kinematics import JointSolution, Pose, forward, inverse
from robolang.api.running import Plan, plan, run
from robolang.core.diagnostics import Diagnostic, Edit
from robolang.core.source import Source, Span, read_program
from robolang.execution.executor import Executor, ExecutorSnapshot
from robolang.execution.observer import Observer
from robolang.execution.result import RunResult
from robolang.execution.run_report import Report, StatementReport
from robolang.execution.session import ProgramError, Session
from robolang.execution.status import ENDED, State, Status
from robolang.execution.timeline import Timeline
from robolang.lint.engine import Checked
from robolang.logs.excerpt import Excerpt
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
    "Checked",
    "Comparison",
    "Diagnostic",
    "Edit",
    "Excerpt",
    "Executor",
    "ExecutorSnapshot",
    "Fault",
    "FileFault",
    "JointSolution",
    "Line",
    "Log",
    "Observer",
    "Plan",
    "Pose",
    "ProgramError",
    "Project",
    "Report",
    "RunResult",
    "Session",
    "Source",
    "Span",
    "State",
    "StatementReport",
    "Status",
    "Timeline",
    "check",
    "check_text",
    "compare",
    "forward",
    "identify",
    "inverse",
    "load_project",
    "plan",
    "read_log",
    "read_program",
    "run",
    "step",
    "weigh",
]
