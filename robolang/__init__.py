"""robolang: an industrial robot controller in a package.

``robolang.run("prog.rbl")`` executes a program on the controller and the physics and returns its ``RunResult``.

Nothing is imported here, not even of the standard library: with ``python -m robolang`` this runs before ``__main__``
takes the working folder out of where modules are looked for.
"""

TYPE_CHECKING = False  # a type checker takes this name for True
__version__ = "0.1.0"

if TYPE_CHECKING:
    from robolang.execution.session import ProgramError, RunResult, run

__all__ = ["ProgramError", "RunResult", "__version__", "run"]


def __getattr__(name: str) -> object:
    # parsing and checking must not pay for numpy, pinocchio and mujoco: the run is imported when it is asked for
    if name in ("run", "RunResult", "ProgramError"):
        from robolang.execution import session

        return getattr(session, name)
    raise AttributeError(f"module 'robolang' has no attribute '{name}'")
