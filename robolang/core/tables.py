"""Data frames of pandas and polars, where they are installed; neither is a dependency."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any


def to_pandas(columns: Mapping[str, Any]) -> Any:
    """Return a ``pandas.DataFrame`` of columns of one length; ``ImportError`` without pandas."""
    return _library("pandas").DataFrame(dict(columns))


def to_polars(columns: Mapping[str, Any]) -> Any:
    """Return a ``polars.DataFrame`` of columns of one length; ``ImportError`` without polars."""
    return _library("polars").DataFrame(dict(columns))


def _library(name: str) -> Any:
    # imported by name: no type checker asks for a library that is no dependency
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(f"{name} is not installed: pip install {name}", name=name) from error
