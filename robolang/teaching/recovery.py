"""Unsaved changes in a file beside the program, for the next start after a lost terminal, a crash or a power failure.

``.NAME.rbl.recover``, and ``.NAME.rbl.2.recover`` and so on for further prompts on one program. The prompt that writes
one holds ``.NAME.rbl.lock`` meanwhile: a file whose prompt still runs is not offered to another one. The texts as they
were read are in it, too, so that what was changed on the disk since then is found when the recovered ones are saved.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NoReturn

import robolang.core.codes  # noqa: F401 - RBL719 must be registered
from robolang.core.claim import Claim, claim, is_claimed
from robolang.core.source import MAX_BYTES
from robolang.core.storage import remove, write_atomic
from robolang.project.discovery import Texts
from robolang.teaching.desk import Desk
from robolang.teaching.documents import UNNAMED, Documents
from robolang.teaching.saving import unified
from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.faults import Fault

SCHEMA = 1
MOST_PROMPTS = 9
"""So many prompts on one program have a recovery file; a further one has none."""
_MOST_BYTES = 40 * MAX_BYTES
"""Six texts, in which a character may be written with six."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pending:
    """Changes that were not saved: the recovery ``file``, ``when`` it was written (UTC), the documents, and the texts
    from which they were made."""

    file: Path
    when: datetime
    documents: Documents
    read: Texts

    @property
    def paths(self) -> tuple[Path, ...]:
        """The files with unsaved changes."""
        return Desk(self.documents, self.read).unsaved

    def diff(self) -> str:
        """Return the unsaved changes as a unified diff."""
        texts = self.documents.texts
        return "".join(unified(path, self.read.get(path), texts[path]) for path in self.paths)


class RecoveryFault(Fault):
    """A recovery file that cannot be used (RBL719); it stays until it is discarded."""

    def __init__(self, file: Path, why: str) -> None:
        super().__init__("RBL719", f"{file} cannot be used: {why}")
        self.file = file


class Recovery:
    """The recovery file of one prompt, written with every change and removed when nothing is unsaved."""

    def __init__(self, taken: Pending | None = None) -> None:
        """``taken``: changes that were recovered; their file is then the one of this prompt. ``Fault`` RBL706."""
        self._claim: Claim | None = None
        self._file: Path | None = None
        self._program: Path | None = None
        self._kept: Documents | None = None
        if taken is not None:
            self._open(taken.documents.path, taken.file)

    @property
    def file(self) -> Path | None:
        """The recovery file, None while there is none."""
        return self._file

    def keep(self, desk: Desk) -> None:
        """Write what is unsaved on a desk, or remove the file where nothing is; ``Fault`` RBL706.

        Only what changed since the last call is written.
        """
        if not desk.unsaved:
            self.close()
            return
        if desk.documents.path != self._program:
            self.close()
            self._open(desk.documents.path)
        if self._file is not None and desk.documents != self._kept:
            data = _encoded(desk)
            write_atomic(self._file, lambda stream: stream.write(data), private=True)
            self._kept = desk.documents

    def close(self) -> None:
        """Remove the recovery file and let others have its name: after a save, and when a prompt ends."""
        try:
            if self._file is not None:
                remove(self._file)
        finally:
            if self._claim is not None:
                self._claim.release()
            self._claim = self._file = self._program = self._kept = None

    def _open(self, program: Path, taken: Path | None = None) -> None:
        for file, lock in _slots(program):
            if taken not in (None, file):
                continue
            try:
                held = claim(lock)
            except OSError as error:
                raise Fault("RBL706", f"cannot write {lock}: {error.strerror}") from None
            # a file that is there and that nobody holds waits for a decision of the user
            if held is not None and (file == taken or not os.path.lexists(file)):
                self._claim, self._file = held, file
                break
            if held is not None:
                held.release()
        self._program = program


def pending_recovery(program: Path | None = None) -> Pending | None:
    """Return the newest unsaved changes of a program (None: of the one without a name) that no running prompt holds.

    ``RecoveryFault`` RBL719 where there is nothing but a file that is damaged.
    """
    path = program or Path(UNNAMED)
    found, faults = [], []
    for file in recovery_files(path):
        try:
            found.append(_decoded(file, path))
        except RecoveryFault as fault:
            faults.append(fault)
    if faults and not found:
        raise faults[0]
    return max(found, key=lambda pending: pending.when, default=None)


def recover(pending: Pending) -> Desk:
    """Return a desk with the unsaved changes on it; the recovery file stays until they are saved or discarded."""
    return Desk(pending.documents, pending.read)


def discard(file: Path) -> None:
    """Remove a recovery file; ``Fault`` RBL706."""
    remove(file)


def recovery_files(program: Path | None = None) -> tuple[Path, ...]:
    """Return the recovery files of a program that no running prompt holds, damaged ones among them."""
    slots = _slots(program or Path(UNNAMED))
    return tuple(file for file, lock in slots if os.path.lexists(file) and not is_claimed(lock))


def _slots(program: Path) -> Iterator[tuple[Path, Path]]:
    """Yield the names of recovery files and of their locks."""
    for number in range(1, MOST_PROMPTS + 1):
        name = f".{program.name}" if number == 1 else f".{program.name}.{number}"
        yield program.with_name(f"{name}.recover"), program.with_name(f"{name}.lock")


# --- the file --------------------------------------------------------------------------------------------------------


def _encoded(desk: Desk) -> bytes:
    documents = desk.documents
    names = {"points": documents.points_path, "cell": documents.cell_path, "program": documents.path}
    content = {
        # the next prompt may start in another folder
        "cell_path": os.path.relpath(documents.cell_path, documents.path.parent),
        "named": documents.named,
        "robot": documents.robot,
        "when": datetime.now(UTC).isoformat(timespec="seconds"),
        "texts": {key: documents.texts[path] for key, path in names.items()},
        "read": {key: desk.read.get(path) for key, path in names.items()},
    }
    # ASCII: half a character that was typed is kept as an escape
    body = json.dumps(content)
    return f'{{"schema": {SCHEMA}, "sha256": "{_sum(body)}", "content": {body}}}\n'.encode("ascii")


def _sum(body: str) -> str:
    return hashlib.sha256(body.encode("ascii")).hexdigest()


def _decoded(file: Path, program: Path) -> Pending:
    whole = _read(file)
    if not isinstance(whole, dict):
        _damaged(file, "it is not a recovery file")
    if isinstance(whole.get("schema"), int) and whole["schema"] > SCHEMA:
        _damaged(file, f"it has schema {whole['schema']}; this version reads {SCHEMA}")
    content = whole.get("content", ())
    if whole.get("sha256") != _sum(json.dumps(content)):
        _damaged(file, "its content does not match its checksum")
    try:
        return _pending(file, program, dict(content))
    except (KeyError, TypeError, ValueError):  # written by another program, with a checksum
        _damaged(file, "its content is not that of a recovery file")


def _read(file: Path) -> Any:
    try:
        return json.loads(read_bounded(file, _MOST_BYTES, links=False))
    except RefusedError as refused:
        _damaged(file, refused.reason if refused.error else "it is not a regular file of a size that can be read")
    except (ValueError, RecursionError):
        _damaged(file, "it is cut off or changed")


def _pending(file: Path, program: Path, content: dict[str, Any]) -> Pending:
    texts, read = content["texts"], content["read"]
    documents = Documents(
        path=program,
        program=_text(texts["program"]) or "",
        points=_text(texts["points"]),
        cell=_text(texts["cell"]),
        cell_path=program.parent / content["cell_path"],
        named=content["named"] is True,
        robot=_text(content["robot"]) or "",
    )
    paths = {"points": documents.points_path, "cell": documents.cell_path, "program": documents.path}
    known = {path: text for key, path in paths.items() if (text := _text(read[key])) is not None}
    return Pending(file=file, when=datetime.fromisoformat(content["when"]), documents=documents, read=known)


def _text(value: object) -> str | None:
    if not isinstance(value, str | None):
        raise TypeError
    return value


def _damaged(file: Path, why: str) -> NoReturn:
    raise RecoveryFault(file, why)
