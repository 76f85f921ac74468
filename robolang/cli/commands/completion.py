"""``robolang completion SHELL``: the script that completes commands and options in a shell."""

import os
from typing import Annotated

from robolang.cli.errors import reported
from robolang.cli.options import Argument
from robolang.cli.shells import SHELLS, VARIABLE
from robolang.cli.usage import OptionValueError

_Shell = Annotated[str, Argument("SHELL", f"One of {', '.join(SHELLS)}.", lambda: SHELLS)]


def completion(shell: _Shell) -> None:
    """Print the script that completes commands and options in a shell; the shell reads it when it starts.

    bash: eval "$(robolang completion bash)" in .bashrc. zsh: the same with zsh in .zshrc, after compinit. fish: in
    config.fish, robolang completion fish | source. PowerShell: in the profile, robolang completion powershell |
    Out-String | Invoke-Expression.

    Example: robolang completion bash

    Exit codes: 0 done; 2 there is no such shell.
    """
    with reported():
        if shell not in SHELLS:
            raise OptionValueError("SHELL", f"'{shell}' is not one of {', '.join(SHELLS)}")
        import typer

        # typer answers by its own command line alone, and the script does not depend on what the command has
        empty = typer.Typer(add_completion=True)
        empty.command()(lambda: None)
        os.environ[VARIABLE] = f"source_{shell}"
        empty(prog_name="robolang")
