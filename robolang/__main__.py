"""Entry point of ``robolang`` and ``python -m robolang``.

``--version`` is answered here, before typer and rich are imported, and ``check`` goes without the other commands.
"""

import sys


def main() -> None:
    """Run the command line."""
    if sys.argv[1:] == ["--version"]:
        from robolang import __version__

        sys.stdout.write(f"robolang {__version__}\n")
        return
    try:
        if sys.argv[1:2] == ["check"]:
            from robolang.cli.quick import run_app
        else:
            from robolang.cli.main import run_app

        run_app()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
