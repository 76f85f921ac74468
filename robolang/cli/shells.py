"""The shells that complete commands, and how they ask for it. Data alone."""

SHELLS = ("bash", "zsh", "fish", "powershell", "pwsh")
VARIABLE = "_ROBOLANG_COMPLETE"
"""The variable of the environment by which a shell asks for completions."""
