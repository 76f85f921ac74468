"""The commands of a page of docs/, carried out as a reader types them."""

import os
import re
import subprocess
import sys
from pathlib import Path

_DOCS = Path(__file__).parents[1] / "docs"


def blocks_of(page: str) -> list[str]:
    """The commands that a page shows, block by block."""
    return re.findall(r"^```sh\n(.*?)^```", (_DOCS / f"{page}.md").read_text("utf-8"), re.M | re.S)


def assert_carried_out(commands: str, folder: Path) -> None:
    """Carry commands out in a folder, one after another; one that fails is an error."""
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    subprocess.run(["bash", "-eu", "-c", commands], cwd=folder, env={**os.environ, "PATH": path}, check=True)
