"""The server of the live view: one loopback port, the page over HTTP and everything else over one socket.

It runs in a thread of its own and sends when something is new, at most thirty times a second; the run never waits for
it. It listens on 127.0.0.1 only and answers what ``guard`` lets through. What a page sends is handed to ``exchange``.
Connections that do not become a page within ``OPEN_S`` are ended, and so many at a time are accepted.
"""

import asyncio
import contextlib
import errno
import json
import logging
import secrets
import socket
import threading
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.view.exchange import Exchange, Page
from robolang.view.guard import HOSTS, Asked, Guard, LivePage
from robolang.view.messages import LARGEST, read_message
from runtime.core.faults import Fault

FRAME_S = 1.0 / 30.0
"""Least time between two frames to a page, s."""
OPEN_S = 5.0
"""Longest time in which a connection has to send its request, s."""
PING_S = 5.0
"""A page that does not answer a ping within this is gone, s."""
END_S = 2.0
"""How long the end of the run waits for a page that does not read, s."""
MOST_CONNECTIONS = 32
"""Connections at a time, those that have not sent a request included."""
MOST_PORT = 65_535
MOST_MISTAKES = 20
"""Messages of a page that are no commands before it is sent away."""

TOKEN_BYTES = 24

# its reports hold paths, and with them the token
_SILENT = logging.getLogger("robolang.view.silent")
_SILENT.addHandler(logging.NullHandler())
_SILENT.propagate = False
_SILENT.setLevel(logging.CRITICAL + 1)


class LiveServer:
    """Serves a page and an exchange until ``close``. ``start`` raises ``Fault`` RBL834 for a port that is taken."""

    def __init__(self, exchange: Exchange, page: LivePage, port: int = 0) -> None:
        """``port`` 0: any that is free."""
        self._exchange, self._page, self._port = exchange, page, port
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready = threading.Event()
        self._changed: set[asyncio.Event] = set()
        self._ended: asyncio.Event | None = None
        self._open = 0
        self.guard: Guard

    @property
    def url(self) -> str:
        """The address of the page, with the token of this run."""
        return self.guard.url

    def start(self) -> None:
        """Listen, in a thread of its own; ``Fault`` RBL834."""
        # here and not in the thread: what is wrong with the port is an error of the command
        listener = _listener(self._port)
        port = int(listener.getsockname()[1])
        self.guard = Guard(port=port, token=secrets.token_urlsafe(TOKEN_BYTES), page=self._page)
        # a daemon: a command that ends by an exception is not kept alive by its pages
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._serve(listener)), name="live view", daemon=True
        )
        self._thread.start()
        self._ready.wait()
        self._exchange.notify = self._notify

    def close(self) -> None:
        """Send every page what is new, tell it that the run is over, and stop listening; nothing when it has not
        started."""
        self._exchange.notify = lambda: None
        if self._thread is not None and self._loop is not None and self._ended is not None:
            self._loop.call_soon_threadsafe(self._ended.set)
            self._thread.join()
            self._thread = None

    def _notify(self) -> None:
        """Wake the tasks of all pages, from any thread."""
        loop = self._loop
        # closed between the two lines: there is nobody left to wake
        with contextlib.suppress(RuntimeError):
            if loop is not None:
                loop.call_soon_threadsafe(self._wake)

    def _wake(self) -> None:
        for event in self._changed:
            event.set()

    # --- in the thread of the server ---------------------------------------------------------------------------------

    async def _serve(self, listener: socket.socket) -> None:
        self._loop, self._ended = asyncio.get_running_loop(), asyncio.Event()
        serving = serve(
            self._page_task,
            sock=listener,
            process_request=self._judge,
            create_connection=self._connection(),
            max_size=LARGEST,
            compression=None,
            server_header=None,
            open_timeout=OPEN_S,
            ping_interval=PING_S,
            ping_timeout=PING_S,
            close_timeout=1.0,
            logger=_SILENT,
        )
        # leaving this block ends the connections that are left
        async with serving as server:
            self._ready.set()
            await self._ended.wait()
            self._wake()
            await _sent(server)

    def _connection(self) -> type[ServerConnection]:
        """Return a connection that is counted, and ended at once where there are too many."""
        outer = self

        class Counted(ServerConnection):
            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                outer._open += 1
                super().connection_made(transport)
                # aborted and not answered: an answer would cost what the bound is there to save
                if outer._open > MOST_CONNECTIONS:
                    self.transport.abort()

            def connection_lost(self, exc: Exception | None) -> None:
                outer._open -= 1
                super().connection_lost(exc)

        return Counted

    def _judge(self, _connection: ServerConnection, request: Request) -> Response | None:
        asked = Asked(
            method=request.method,
            target=request.path,
            # get_all: a second header must not hide the first
            hosts=tuple(request.headers.get_all("Host")),
            origins=tuple(request.headers.get_all("Origin")),
        )
        answer = self.guard.judge(asked)
        if answer is None:
            return None
        return Response(answer.status.value, answer.status.phrase, Headers(answer.headers), answer.body)

    async def _page_task(self, connection: ServerConnection) -> None:
        """Serve one page until it goes, or the run is over."""
        changed, page = asyncio.Event(), self._exchange.join()
        self._changed.add(changed)
        sending = asyncio.create_task(self._send(connection, page, changed))
        receiving = asyncio.create_task(self._receive(connection, page))
        try:
            changed.set()
            # whichever ends first: the run, or the page
            await asyncio.wait((sending, receiving), return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._changed.discard(changed)
            self._exchange.leave(page)
            for task in (sending, receiving):
                task.cancel()
            await asyncio.gather(sending, receiving, return_exceptions=True)

    async def _send(self, connection: ServerConnection, page: Page, changed: asyncio.Event) -> None:
        """Send what is new, at the pace at which the page reads; return when the run is over and all is sent."""
        assert self._ended is not None
        with contextlib.suppress(ConnectionClosed):
            loop, due_s = asyncio.get_running_loop(), float("-inf")
            while True:
                await changed.wait()
                changed.clear()
                over = self._ended.is_set()
                for message in _news(self._exchange, page):
                    await connection.send(message)
                # read before the news: what came last is sent before the end
                if over:
                    await connection.send('{"kind":"over"}')
                    return
                # what comes meanwhile is sent together, the newest frame alone
                due_s = max(due_s + FRAME_S, loop.time())
                await asyncio.sleep(due_s - loop.time())

    async def _receive(self, connection: ServerConnection, page: Page) -> None:
        mistakes = 0
        async for text in connection:
            try:
                message = read_message(text)
            except Fault as fault:
                mistakes += 1
                page.said.append(json.dumps({"kind": "refused", "code": fault.code, "message": fault.message}))
                self._wake()
                if mistakes >= MOST_MISTAKES:
                    await connection.close(1008, "no commands")
                    return
            else:
                self._exchange.receive(page, message)


def _listener(port: int) -> socket.socket:
    """Return a socket that listens on this machine only; ``Fault`` RBL834."""
    if not 0 <= port <= MOST_PORT:
        raise Fault("RBL834", f"{port} is no port: these are 1 to {MOST_PORT}, and 0 for any that is free")
    try:
        return socket.create_server((HOSTS[0], port))
    except OSError as error:
        why = "another program has it" if error.errno == errno.EADDRINUSE else error.strerror
        raise Fault("RBL834", f"port {port} cannot be used: {why}") from None


def _news(exchange: Exchange, page: Page) -> list[str | bytes]:
    """Return what a page has not got yet: what the run is, lines and replies, the newest status, the
    newest frame."""
    found: list[str | bytes] = []
    # before the hello: a frame of another layout must not come after the one that it does not fit
    newest, frame = exchange.frame
    hello = exchange.hello
    if page.hello != hello:
        page.hello = hello
        found.append(hello)
    while page.said:
        found.append(page.said.popleft())
    statements = exchange.begun.news(page.begun)
    if statements is not None:
        found.append(statements)
    count, notes = exchange.notes
    if page.notes != count:
        page.notes = count
        found.append(notes)
    number, status = exchange.status
    control = exchange.control_for(page)
    # control differs from page to page, and is no part of what the run knows
    mark = (number, control)
    if page.status != mark:
        page.status = mark
        found.append(f'{{"kind":"status","control":"{control}",{status[1:]}')
    if page.frame != newest:
        page.frame = newest
        found.append(frame)
    return found


async def _sent(server: Server) -> None:
    """Wait until every page has got the end of the run, or has not read it in time."""
    pages: Any = [connection.wait_closed() for connection in server.connections]
    if pages:
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(asyncio.gather(*pages, return_exceptions=True), END_S)
