"""``make wheel-test``: build sdist and wheel, install the wheel far from any checkout, and use it as a stranger does.

The wheel is built from the sdist, so both have all files. Every command of ``robolang`` shows its help, and the example
programs and a new project, which the wheel has to bring, are checked, run and tested.
"""

import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).parents[1]
LIST = """
import typer
from robolang.cli.main import app
def words(found, given=()):
    yield given
    for name in getattr(found, "commands", {}):
        yield from words(found.commands[name], (*given, name))
for each in words(typer.main.get_command(app)):
    print(*each)
"""
SESSION = (
    "examples",
    "examples get palletise -o copied",
    "check --strict --motion copied",
    "test copied",
    "new cell1",
    "check --strict --motion cell1",
    "fmt --check cell1",
    "run --strict cell1/cell1.rbl --log cell1.npz --html cell1.html",
    "test cell1",
    "init --template dispense --robot irb2400 --name bead",
    "test bead.rbl",
    "explain RBL843",
)
"""What is typed in an empty folder, in this order."""


def run(*words: object, cwd: Path) -> str:
    """Run a command outside of the checkout; an exit code other than 0 ends the test."""
    # a path of Python would let the checkout stand in for the wheel
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(list(map(str, words)), cwd=cwd, env=clean, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}\nexit code {done.returncode}")
    return done.stdout


def main() -> None:
    """Build, install, use."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        print("build sdist, and wheel from it", flush=True)
        run(sys.executable, "-m", "build", "--outdir", folder / "dist", ROOT, cwd=folder)
        (wheel,) = (folder / "dist").glob("*.whl")
        print(f"install {wheel.name}, {wheel.stat().st_size / 1e6:.1f} MB, in an environment of its own", flush=True)
        venv.create(folder / "venv", with_pip=True)
        python = folder / "venv" / "bin" / "python"
        run(python, "-m", "pip", "install", "--quiet", "-c", ROOT / "constraints.txt", wheel, cwd=folder)
        robolang, work = folder / "venv" / "bin" / "robolang", folder / "work"
        work.mkdir()
        commands = run(python, "-c", LIST, cwd=work).splitlines()
        print(f"help of {len(commands)} commands", flush=True)
        for command in commands:
            run(robolang, *command.split(), "--help", cwd=work)
        for typed in SESSION:
            print(f"robolang {typed}", flush=True)
            run(robolang, *typed.split(), cwd=work)
        print("all as it should be")


if __name__ == "__main__":
    main()
