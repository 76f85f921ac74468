"""Which requests the live view answers: a pure function of the request, the port and the token of this run.

A page of any web site can send requests to a port of this machine. What it cannot do is forge ``Host`` and ``Origin``,
and it does not know the token, so these three are compared exactly, before anything else is read:

==============================  ===  =====================================================================
method other than GET           405  commands come over the socket alone
target longer than 512 bytes    414
``Host``                        403  exactly one, 127.0.0.1:PORT or localhost:PORT, in these letters
``Origin``                      403  at most one, of the same host; the socket needs one
token                           401  exactly one, that of this run, as the whole query
path other than / and /live     404
==============================  ===  =====================================================================
"""

import hmac
from dataclasses import dataclass
from http import HTTPStatus

PAGE_PATH, SOCKET_PATH = "/", "/live"
HOSTS = ("127.0.0.1", "localhost")
"""Names of this machine that a browser may use; every other one may lead here by somebody else's name server."""
LONGEST_TARGET = 512
"""Longest path with its query, bytes."""

_QUERY = "token="
# the page takes the token out of the address bar, so a reload comes without it
_REMEDIES = {HTTPStatus.UNAUTHORIZED: "Open the address that the command has printed: it ends with ?token=...\n"}
_NOTHING = "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """A request: every ``Host`` and ``Origin`` that it has, in their order."""

    method: str
    target: str
    hosts: tuple[str, ...]
    origins: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """A reply that ends a request."""

    status: HTTPStatus
    headers: tuple[tuple[str, str], ...]
    body: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class LivePage:
    """The page as it is sent, and the hashes of its script and its style, ``'sha256-...'``."""

    html: bytes
    script: str
    style: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Guard:
    """Judges the requests of one run, on one port, with one token."""

    port: int
    token: str
    page: LivePage

    @property
    def url(self) -> str:
        """The address of the page, with its token."""
        return f"http://{HOSTS[0]}:{self.port}{PAGE_PATH}?{_QUERY}{self.token}"

    def judge(self, asked: Asked) -> Answer | None:
        """Return the reply to a request; None: it may open the socket."""
        refused = self._refused(asked)
        if refused is not None:
            text = f"{refused.value} {refused.phrase}\n{_REMEDIES.get(refused, '')}"
            return _answer(refused, text.encode(), "text/plain; charset=utf-8", _NOTHING)
        if _path(asked) == SOCKET_PATH:
            return None
        return _answer(HTTPStatus.OK, self.page.html, "text/html; charset=utf-8", self._policy)

    def _refused(self, asked: Asked) -> HTTPStatus | None:
        # the library answers a POST as a GET, so no method may be left to it
        if asked.method != "GET":
            return HTTPStatus.METHOD_NOT_ALLOWED
        if len(asked.target) > LONGEST_TARGET:
            return HTTPStatus.REQUEST_URI_TOO_LONG
        # before the token: who comes from elsewhere learns nothing about it
        if not self._is_here(asked):
            return HTTPStatus.FORBIDDEN
        if not self._has_token(asked):
            return HTTPStatus.UNAUTHORIZED
        return None if _path(asked) in (PAGE_PATH, SOCKET_PATH) else HTTPStatus.NOT_FOUND

    def _is_here(self, asked: Asked) -> bool:
        """Return whether the request names this port of this machine, and comes from a page of it or from none."""
        # exactly, and not by parsing: user names, dots and other spellings of an address have no place here
        if len(asked.hosts) != 1 or asked.hosts[0] not in {f"{name}:{self.port}" for name in HOSTS}:
            return False
        # a browser sends Origin with every socket: who leaves it out is no page of ours
        if not asked.origins:
            return _path(asked) != SOCKET_PATH
        # the name by which the page was opened, so that the two names of this machine are two sites
        return asked.origins == (f"http://{asked.hosts[0]}",)

    def _has_token(self, asked: Asked) -> bool:
        _, _, query = asked.target.partition("?")
        # compared as a whole: a second token, an escaped one or one in other letters is another query
        return hmac.compare_digest(query.encode("utf-8", "surrogatepass"), f"{_QUERY}{self.token}".encode())

    @property
    def _policy(self) -> str:
        """The content policy of the page: its own scripts and styles, and the socket of this run."""
        # both names: the page opens its socket on the host by which it was opened
        sockets = " ".join(f"ws://{name}:{self.port}" for name in HOSTS)
        return (
            f"default-src 'none'; script-src {self.page.script}; style-src {self.page.style}; img-src data: blob:; "
            f"connect-src {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )


def _path(asked: Asked) -> str:
    return asked.target.partition("?")[0]


def _answer(status: HTTPStatus, body: bytes, kind: str, policy: str) -> Answer:
    # no page may frame this one, read it, or keep it; and no link of it carries its address on
    headers = (
        ("Content-Type", kind),
        ("Content-Length", str(len(body))),
        ("Connection", "close"),
        ("Cache-Control", "no-store"),
        ("Content-Security-Policy", policy),
        ("Referrer-Policy", "no-referrer"),
        ("X-Content-Type-Options", "nosniff"),
        ("X-Frame-Options", "DENY"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        ("Cross-Origin-Opener-Policy", "same-origin"),
    )
    return Answer(status=status, headers=headers, body=body)
