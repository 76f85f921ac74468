"""Lint rules, each file one check with its codes, its page and its function (``lint_rule``)."""

import pkgutil
from functools import cache
from importlib import import_module

from robolang.analysis.lint_rule import Check


@cache
def checks() -> tuple[Check, ...]:
    """Return the checks of all files of this folder, by name."""
    # sorted: findings of one place come in the order of the checks, the same on every file system
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return tuple(import_module(f"{__name__}.{name}").CHECK for name in names)
