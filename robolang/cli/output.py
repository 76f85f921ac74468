"""Printing on the standard output and the standard error, for every command. Imports the standard library only.

A reader may close its pipe (``| head``) while a command works. What is printed from then on is dropped: the command
does its work, writes its files and leaves with the exit code that it has without a pipe (docs/decisions/0005).
"""

import io
import os
import sys
from contextlib import suppress
from typing import TextIO

from robolang.cli.colour import colours, painted


def echo(text: str | bytes = "", *, nl: bool = True, err: bool = False) -> None:
    """Print a text, or the bytes of a file, and flush; a process without that stream prints nothing."""
    stream = sys.stderr if err else sys.stdout
    if stream is None:  # pythonw, or a service that was started with the stream closed
        return
    try:
        if isinstance(text, bytes):
            stream.flush()  # what was printed as text comes first
            stream.buffer.write(text)
            stream.buffer.flush()
        else:
            stream.write(f"{text}\n" if nl else text)
            stream.flush()
    except BrokenPipeError:
        drop(stream)


def show_finding(text: str, *, nl: bool = True, err: bool = True) -> None:
    """Print findings, in colours where the stream shows them."""
    stream = sys.stderr if err else sys.stdout
    if stream is not None and colours(stream):
        text = painted(text)
    echo(text, nl=nl, err=err)


def drop(stream: TextIO) -> None:
    """Lead a stream nowhere, so that the interpreter does not fail at exit on what is left in it."""
    # a stream may be None, closed, or no file at all, as in a test: then there is nothing to lead away
    with suppress(OSError, ValueError, AttributeError):
        # under the stream, not in its place: Python flushes the same object when it ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def escape_what_a_terminal_lacks() -> None:
    """Let stdout escape letters that its encoding lacks, as stderr does: excerpts of programs hold them."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
