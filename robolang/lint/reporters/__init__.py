"""The forms in which findings are printed: one module each, a pure function from results to text.

``render`` finds the module by the name of its form. Ranges are 1-based lines and columns in characters; the end is
exclusive.
"""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from robolang.lint.engine import Checked

FORMS = ("full", "concise", "json", "json-lines", "github", "gitlab", "junit", "sarif")
FOR_PEOPLE = frozenset({"full", "concise"})
"""Forms that leave out faults of files: the command line prints those to stderr."""

_MODULES = {"json": "json_array"}


def render(form: str, results: Sequence[Checked], root: Path) -> str:
    """Return findings in one of ``FORMS``; ``root`` is the folder that forms for a repository name files from."""
    module = import_module(f"robolang.lint.reporters.{_MODULES.get(form, form.replace('-', '_'))}")
    text: str = module.render(results, root)
    return text
