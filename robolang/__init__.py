"""robolang: an industrial robot controller in a package.

``robolang.run("prog.rbl")`` executes a program on the controller and the physics and returns its ``RunResult``; the
other names are those of ``robolang.api``.

Nothing is imported here, not even of the standard library: with ``python -m robolang`` this runs before ``__main__``
takes the working folder out of where modules are looked for.
"""

TYPE_CHECKING = False  # a type checker takes this name for True
__version__ = "0.1.0"

if TYPE_CHECKING:
    from robolang.api import *  # noqa: F403

# named here as well, since reading them from ``api`` would import it; tests/robolang/test_api.py compares the two
__all__ = [
    "__version__",
    *("Analysis", "Diagnostic", "Edit", "Line", "Source", "Span", "read_program"),
    *("Executor", "ExecutorSnapshot", "State", "Status", "Timeline", "ENDED", "Fault", "FileFault"),
    *("Observer", "ProgramError", "Project", "RunResult", "Session", "load_project", "run"),
    *("Log", "Excerpt", "read_log", "Report", "StatementReport"),
    *("Checked", "check", "check_text", "Plan", "plan", "JointSolution", "Pose", "forward", "inverse"),
    *("Comparison", "compare", "identify", "step", "weigh"),
]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def __getattr__(name: str) -> object:
    # parsing and checking must not pay for numpy, pinocchio and mujoco: the run is imported at its first use
    if name in __all__ and name != "__version__":
        from robolang import api

        return getattr(api, name)
    raise AttributeError(f"module 'robolang' has no attribute '{name}'")
