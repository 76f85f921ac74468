"""A live server over an exchange without a run, and raw sockets to it: what no browser would send can be sent."""

import base64
import os
import socket
from contextlib import closing, contextmanager

from websockets.sync.client import connect
from websockets.typing import Origin

from robolang.view.exchange import Exchange
from robolang.view.guard import LivePage
from robolang.view.server import LiveServer
from tests.steps import HANG_S

PAGE = LivePage(html=b"<!doctype html><title>live</title>", script="'sha256-s'", style="'sha256-c'")


@contextmanager
def serving(exchange=None):
    server = LiveServer(exchange or Exchange(), PAGE)
    server.start()
    try:
        yield server
    finally:
        server.close()


def raw(server, sent: bytes) -> bytes:
    """All that the server answers to some bytes, until it closes or the socket is open for frames."""
    with closing(socket.create_connection(("127.0.0.1", server.guard.port), timeout=HANG_S)) as peer:
        peer.sendall(sent)
        answer = b""
        while not answer.startswith(b"HTTP/1.1 101 "):
            got = peer.recv(65536)
            if not got:
                break
            answer += got
        return answer


def request(server, target, *headers, method="GET", host=None) -> bytes:
    """A request as bytes; ``host`` None: the right one, "": none."""
    host = f"127.0.0.1:{server.guard.port}" if host is None else host
    lines = [f"{method} {target} HTTP/1.1", *([f"Host: {host}"] if host else []), *headers, "", ""]
    return "\r\n".join(lines).encode("latin-1")


def upgrade() -> tuple[str, ...]:
    key = base64.b64encode(os.urandom(16)).decode()
    return ("Upgrade: websocket", "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13")


def origin(server, name="127.0.0.1") -> str:
    return f"Origin: http://{name}:{server.guard.port}"


def status(answer: bytes) -> int:
    """The status code of an answer; 0: the connection was closed without one."""
    return int(answer.split(b" ", 2)[1]) if answer else 0


def page_of(server):
    """A page that is connected, as a browser would be."""
    guard = server.guard
    return connect(
        f"ws://127.0.0.1:{guard.port}/live?token={guard.token}",
        origin=Origin(f"http://127.0.0.1:{guard.port}"),
        compression=None,
        max_size=None,
        open_timeout=HANG_S,
    )
