"""Disks that lose their power, and processes that are killed, while documents are saved.

``recorded`` notes the calls of the system that a save makes. ``states`` yields what the disk may have after a power
failure at any moment of them: contents are sure once the file is flushed, names once the folder is flushed; until then
any part of what was written, and any number of the renames in their order, may be there.
"""

import itertools
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from robolang.core import storage


@dataclass
class File:
    """Contents that the disk has for sure, and those that were written since."""

    sure: bytes = b""
    now: bytes = b""

    def may_have(self):
        return {self.sure, self.now[: len(self.now) // 2], self.now} if self.now != self.sure else {self.now}


@dataclass
class Disk:
    """Names that are sure, and the changes of names since the folder was flushed."""

    names: dict[str, File]
    changes: list[tuple[str, ...]] = field(default_factory=list)
    files: dict[str, File] = field(default_factory=dict)

    def __post_init__(self):
        self.files = dict(self.names)

    def do(self, call):
        kind, name, *rest = call
        if kind == "create":
            self.files[name] = File()
            self.changes.append(("link", name, self.files[name]))
        elif kind == "truncate":
            self.files[name].now = b""
        elif kind == "write":
            self.files[name].now += rest[0]
        elif kind == "flush":
            self.files[name].sure = self.files[name].now
        elif kind == "rename":
            self.files[rest[0]] = self.files.pop(name)
            self.changes.append(("link", rest[0], self.files[rest[0]]))
            self.changes.append(("unlink", name))
        elif kind == "remove":
            self.files.pop(name)
            self.changes.append(("unlink", name))
        elif kind == "flush folder":
            self.names, self.changes = dict(self.files), []

    def after_power_failure(self, wanted):
        """Yield the contents that the wanted names may have, None: not there."""
        for count in range(len(self.changes) + 1):
            names = dict(self.names)
            for kind, name, *rest in self.changes[:count]:
                if kind == "link":
                    names[name] = rest[0]
                else:
                    names.pop(name, None)
            found = [[None] if name not in names else sorted(names[name].may_have()) for name in wanted]
            yield from itertools.product(*found)


def states(before, calls, wanted):
    """Yield, after each call, the set of contents that the wanted names may have."""
    disk = Disk({name: File(data, data) for name, data in before.items()})
    for call in [("start", ""), *calls]:
        disk.do(call)
        yield set(disk.after_power_failure(wanted))


class _Calls:
    """Stands for ``os`` and ``tempfile`` in the storage module, and for naive writers: notes what reaches the disk."""

    def __init__(self, module, log, opened):
        self._module, self._log, self._opened = module, log, opened

    def __getattr__(self, name):
        return getattr(self._module, name)

    def mkstemp(self, **options):
        handle, name = self._module.mkstemp(**options)
        self._opened[handle] = Path(name).name
        self._log.append(("create", self._opened[handle]))
        return handle, name

    def open(self, path, flags, *mode):
        new = not os.path.lexists(path)
        handle = self._module.open(path, flags, *mode)
        name = self._opened[handle] = "" if flags & os.O_DIRECTORY else Path(path).name
        if flags & os.O_CREAT and new:
            self._log.append(("create", name))
        elif flags & os.O_TRUNC:
            self._log.append(("truncate", name))
        return handle

    def fdopen(self, handle, *args, **options):
        return _Stream(self._module.fdopen(handle, *args, **options), self._log, self._opened[handle])

    def fsync(self, handle):
        self._module.fsync(handle)
        name = self._opened[handle]
        self._log.append(("flush", name) if name else ("flush folder", ""))

    def replace(self, old, new):
        self._module.replace(old, new)
        self._log.append(("rename", Path(old).name, Path(new).name))

    def unlink(self, path, **options):
        self._module.unlink(path, **options)
        self._log.append(("remove", Path(path).name))


class _Stream:
    def __init__(self, stream, log, name):
        self._stream, self._log, self._name = stream, log, name

    def write(self, data):
        self._log.append(("write", self._name, bytes(data)))
        return self._stream.write(data)

    def __enter__(self):
        return self

    def __exit__(self, *problem):
        return self._stream.__exit__(*problem)


@contextmanager
def recorded() -> Iterator[list]:
    """Yield the list to which the calls of saves are added."""
    log, opened = [], {}
    with pytest.MonkeyPatch.context() as patch:
        for module in (os, tempfile):
            patch.setattr(storage, module.__name__, _Calls(module, log, opened))
        yield log


def _module(name):
    """The module that the storage module uses, which notes what is called."""
    return vars(storage)[name]


def in_place(path, write, **options):
    """A naive writer: the file is emptied and written again."""
    handle = _module("os").open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    with _module("os").fdopen(handle, "wb") as stream:
        write(stream)


def unflushed(path, write, **options):
    """A naive writer: a file beside takes the name, and is not flushed before."""
    handle, name = _module("tempfile").mkstemp(dir=path.parent)
    with _module("os").fdopen(handle, "wb") as stream:
        write(stream)
    _module("os").replace(name, path)


def flushed_alone(path, write, **options):
    """A naive writer: it does not flush the folder, so an old file may come back after the save."""
    handle, name = _module("tempfile").mkstemp(dir=path.parent)
    with _module("os").fdopen(handle, "wb", closefd=False) as stream:
        write(stream)
    _module("os").fsync(handle)
    _module("os").close(handle)
    _module("os").replace(name, path)


NAIVE = {"in_place": in_place, "unflushed": unflushed, "flushed_alone": flushed_alone}
