"""Entry point of ``robolang`` and ``python -m robolang``.

``--version`` is answered here, before typer and rich are imported.
"""

import sys


def main() -> None:
    """Run the command line."""
    if sys.argv[1:] == ["--version"]:
        from robolang import __version__

        sys.stdout.write(f"robolang {__version__}\n")
        return
    try:
        from robolang.cli.main import run_app

        run_app()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
