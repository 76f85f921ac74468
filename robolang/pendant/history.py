"""The lines that were typed, kept from session to session in the state folder of the user (XDG).

One line of JSON for each entry, at most ``MOST`` of them. Two prompts share the file: each adds to what is there. Where
it cannot be read or written the history lasts as long as the prompt; a failure here must not stop anybody's work.
"""

import json
import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from prompt_toolkit.history import History

from robolang.core.storage import write_atomic
from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.faults import Fault

MOST = 1000
"""So many entries are kept."""
_LONGEST = 4000
"""A longer entry, as of a pasted program, is not kept."""
_MOST_BYTES = 4 * MOST * _LONGEST


def history_file() -> Path | None:
    """Return where the history is kept; None for a user without a folder."""
    state = os.environ.get("XDG_STATE_HOME", "")
    try:
        # a relative path is to be ignored by the specification
        folder = Path(state) if state.startswith("/") else Path.home() / ".local" / "state"
    except RuntimeError:
        return None
    return folder / "robolang" / "history.jsonl"


class KeptHistory(History):
    """A history in a file; ``path`` None: in memory only."""

    def __init__(self, path: Path | None) -> None:
        super().__init__()
        self._path = path

    def load_history_strings(self) -> Iterable[str]:
        """Return the entries of the file, the newest first."""
        return reversed(self._read())

    def store_string(self, string: str) -> None:
        """Add an entry to the file."""
        if self._path is None or len(string) > _LONGEST:
            return
        entries = [*self._read(), string][-MOST:]
        text = "".join(f"{json.dumps(entry)}\n" for entry in entries)
        with suppress(OSError, Fault):
            self._path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_atomic(self._path, lambda stream: stream.write(text.encode()))

    def _read(self) -> list[str]:
        if self._path is None:
            return []
        try:
            text = read_bounded(os.fspath(self._path), _MOST_BYTES).decode("utf-8", "replace")
        except RefusedError:
            return []
        entries = []
        for line in text.split("\n"):
            # a line that another program has spoilt costs only itself
            with suppress(ValueError):
                entry = json.loads(line)
                if isinstance(entry, str):
                    entries.append(entry)
        return entries[-MOST:]
