"""Entry point of ``robolang`` and ``python -m robolang``.

``--version`` is answered here, before typer and rich are imported, and ``check`` and ``repl`` go without the
other commands.
``python -m`` puts the working folder before every other place that modules are imported from; it is taken out first, so
that a ``lark.py`` beside the programs stays a file like any other.
"""

import gc
import os
import sys


def _forget_working_folder() -> None:
    """Import nothing from the working folder, unless robolang itself was found there."""
    try:
        here = os.getcwd()  # noqa: PTH109 - pathlib is not imported yet
    except OSError:  # it is gone
        return
    home = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120
    if sys.path[:1] == [here] and here != home and not sys.flags.safe_path:
        del sys.path[0]


def _keep_others_from_it() -> None:
    """Let no process that is started from here import from the working folder either.

    ``compare`` starts some. MuJoCo's window library would start one at every import, to ask for its version; the
    command line opens no window, so it is left out.
    """
    os.environ["PYTHONSAFEPATH"] = "1"
    os.environ.setdefault("MUJOCO_GL", "disable")


def _take_colour() -> None:
    """Obey ``--color`` wherever it stands; leave with 2 for a value that is none."""
    # most command lines have none, and pay nothing
    if not any(word.startswith("--color") for word in sys.argv):
        return
    from robolang.cli.colour import CHOICES, OPTION, take_option

    wrong = take_option(sys.argv)
    if wrong is not None:
        from robolang.cli.usage import OptionValueError

        error = OptionValueError(OPTION, f"{wrong!r} is not one of {', '.join(CHOICES)}")
        sys.stderr.write(f"error {error}\n")
        sys.exit(2)


def main() -> None:
    """Run the command line."""
    _keep_others_from_it()
    if sys.argv[1:] == ["--version"]:
        from robolang import __version__

        sys.stdout.write(f"robolang {__version__}\n")
        return
    try:
        _take_colour()
        if sys.argv[1:2] in (["check"], ["repl"]):
            # What imports leave is never garbage, and looking through it again and again takes a tenth of a check.
            gc.disable()
            from robolang.cli import quick

            command = quick.COMMANDS[sys.argv[1]]()
            gc.freeze()
            gc.enable()
            quick.run_app(command)
        else:
            from robolang.cli.main import run_app

            run_app()
    except KeyboardInterrupt:
        sys.exit(130)
    except ModuleNotFoundError as error:
        # typer itself; what a command needs is answered within it
        from robolang.cli.errors import say
        from robolang.core.defects import internal

        sys.exit(say(internal(error)))


if __name__ == "__main__":
    _forget_working_folder()
    main()
