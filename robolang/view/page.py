"""One HTML file with everything in it: skeleton, style, script and the runs that it shows.

The browser loads nothing else, and the policy in the file forbids it to: of scripts and styles only those whose hash it
names, no connection, no frame, no form. What a user has written is never in the HTML: it is in the runs, in base64,
and the script puts it into the page as text.
"""

import base64
import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import IO

from robolang.core.storage import write_atomic
from runtime.core.faults import Fault

_MARK = re.compile(r"\{\{(CSP|CSS|RUNS|JS)\}\}")
_MARKS = ["CSP", "CSS", "RUNS", "JS"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Bundle:
    """What all pages have: the ``skeleton`` with its four marks in this order, the ``script`` and the ``style``."""

    skeleton: str
    script: str
    style: str

    def __post_init__(self) -> None:
        if _MARK.findall(self.skeleton) != _MARKS:
            raise _incomplete("page.html has other marks than {{CSP}}, {{CSS}}, {{RUNS}} and {{JS}}, once each")

    @staticmethod
    def installed() -> "Bundle":
        """Return that of this installation; ``Fault`` RBL825 where it is not the one that was built."""
        folder = resources.files("robolang.view") / "static"
        try:
            sums = dict(line.split()[::-1] for line in (folder / "SHA256SUMS").read_text("ascii").splitlines())
            files = {name: (folder / name).read_bytes() for name in ("page.html", "viewer.js", "viewer.css")}
        except (OSError, ValueError) as error:
            raise _incomplete(str(error)) from None
        for name, data in files.items():
            # a script that could end its own element is kept out when it is built; a changed one is not that script
            if hashlib.sha256(data).hexdigest() != sums.get(name):
                raise _incomplete(f"{name} is not the file that was installed")
        skeleton, script, style = (data.decode("utf-8") for data in files.values())
        return Bundle(skeleton=skeleton, script=script, style=style)

    @property
    def policy(self) -> str:
        """The content security policy of a page that is opened from a disk."""
        script, style = self.hashes
        return (
            f"default-src 'none'; script-src {script}; style-src {style}; "
            "img-src data: blob:; base-uri 'none'; form-action 'none'"
        )

    @property
    def hashes(self) -> tuple[str, str]:
        """Hash of the script and of the style, as a policy names them."""
        return _hash(self.script), _hash(self.style)

    def filled(self, policy: str, runs: Iterable[bytes]) -> Iterator[bytes]:
        """Yield the page in pieces; ``runs``: the elements that stand before the script."""
        for k, piece in enumerate(_MARK.split(self.skeleton)):
            if k % 2 == 0:
                yield piece.encode()
            elif piece == "RUNS":
                yield from runs
            else:
                yield {"CSP": policy, "CSS": self.style, "JS": self.script}[piece].encode()


def write_page(path: Path, runs: Sequence[bytes], bundle: Bundle) -> None:
    """Write a page that shows packed runs (``packing.pack``); ``Fault`` RBL706, with the old file untouched."""
    write_atomic(path, lambda stream: _write(stream, runs, bundle))


def _write(stream: IO[bytes], runs: Sequence[bytes], bundle: Bundle) -> None:
    for piece in bundle.filled(bundle.policy, _elements(runs)):
        stream.write(piece)


def _elements(runs: Sequence[bytes]) -> Iterator[bytes]:
    for number, run in enumerate(runs):
        yield b'<script type="text/plain" data-run="%d">' % number
        yield base64.b64encode(run)
        yield b"</script>\n"


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _incomplete(what: str) -> Fault:
    return Fault("RBL825", f"the files of the page are not whole: {what}", "Install robolang again.")
