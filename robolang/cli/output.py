"""Printing on the standard output and the standard error, for every command. Imports the standard library only."""

import sys


def echo(text: str | bytes = "", *, nl: bool = True, err: bool = False) -> None:
    """Print a text, or the bytes of a file, and flush; a process without that stream prints nothing."""
    stream = sys.stderr if err else sys.stdout
    if stream is None:  # pythonw, or a service that was started with the stream closed
        return
    if isinstance(text, bytes):
        stream.flush()  # what was printed as text comes first
        stream.buffer.write(text)
        stream.buffer.flush()
        return
    stream.write(f"{text}\n" if nl else text)
    stream.flush()
