"""Requests that are no request of the page of this run, over a real socket: all of them are refused."""

import logging
import os
import re
import socket
import struct
from contextlib import closing
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from robolang.view import server as server_module
from robolang.view.exchange import Exchange
from robolang.view.guard import Asked
from robolang.view.server import MOST_CONNECTIONS, MOST_MISTAKES, LiveServer
from runtime.core.faults import Fault
from tests.campaign import size
from tests.robolang.view.live_server import PAGE, origin, page_of, raw, request, serving, status, upgrade
from tests.steps import HANG_S


@pytest.fixture(scope="module")
def live():
    with serving() as server:
        yield server


def good(server) -> str:
    return f"/?token={server.guard.token}"


def to_socket(server) -> str:
    return f"/live?token={server.guard.token}"


HOSTS = {
    "evil": "evil.com:{port}",
    "10.0.2.555": "10.0.2.555:{port}",
    "no port": "127.0.0.1",
    "another port": "127.0.0.1:1",
    "userinfo": "evil@127.0.0.1:{port}",
    "password": "a:b@127.0.0.1:{port}",
    "upper case": "LOCALHOST:{port}",
    "trailing dot": "localhost.:{port}",
    "dot after the address": "127.0.0.1.:{port}",
    "IPv6": "[::1]:{port}",
    "IPv4 in IPv6": "[::ffff:127.0.0.1]:{port}",
    "every address": "0.0.0.0:{port}",
    "another loopback": "127.0.0.2:{port}",
    "short loopback": "127.1:{port}",
    "decimal": "2130706433:{port}",
    "hexadecimal": "0x7f000001:{port}",
    "a name that leads here": "localtest.me:{port}",
    "a name that ends alike": "evil.localhost:{port}",
    "two in one": "127.0.0.1:{port}, evil.com",
    "a blank inside": "127.0.0.1 :{port}",
    "leading zero of the port": "127.0.0.1:0{port}",
    "none": "",
}


@pytest.mark.parametrize("path", ["/", "/live"])
@pytest.mark.parametrize("host", HOSTS.values(), ids=HOSTS)
def test_every_other_host_is_refused(live, host, path):
    asked = request(
        live, f"{path}?token={live.guard.token}", *upgrade(), origin(live), host=host.format(port=live.guard.port)
    )
    assert status(raw(live, asked)) == 403


def test_two_hosts_are_refused_in_either_order(live):
    here = f"127.0.0.1:{live.guard.port}"
    for hosts in (("evil.com", here), (here, "evil.com"), (here, here)):
        asked = request(live, good(live), *(f"Host: {each}" for each in hosts), host="")
        assert status(raw(live, asked)) == 403


ORIGINS = {
    "evil": ("Origin: http://evil.com",),
    "null": ("Origin: null",),
    "none": (),
    "https": ("Origin: https://127.0.0.1:{port}",),
    "another port": ("Origin: http://127.0.0.1:1",),
    "no port": ("Origin: http://127.0.0.1",),
    "with a path": ("Origin: http://127.0.0.1:{port}/",),
    "the other name of the host": ("Origin: http://localhost:{port}",),
    "upper case": ("Origin: HTTP://127.0.0.1:{port}",),
    "a file": ("Origin: file://",),
    "an extension": ("Origin: chrome-extension://abc",),
    "two, the first good": ("Origin: http://127.0.0.1:{port}", "Origin: http://evil.com"),
    "two, the last good": ("Origin: http://evil.com", "Origin: http://127.0.0.1:{port}"),
    "empty": ("Origin: ",),
}


@pytest.mark.parametrize("headers", ORIGINS.values(), ids=ORIGINS)
def test_a_socket_opens_for_its_own_page_only(live, headers):
    given = (each.format(port=live.guard.port) for each in headers)
    assert status(raw(live, request(live, to_socket(live), *upgrade(), *given))) == 403


@pytest.mark.parametrize("name", [each for each in ORIGINS if each != "none"])
def test_the_page_is_not_given_to_another_origin(live, name):
    given = (each.format(port=live.guard.port) for each in ORIGINS[name])
    assert status(raw(live, request(live, good(live), *given))) == 403


TOKENS = {
    "none": "",
    "empty": "?token=",
    "another case": "?token={swapped}",
    "a part of it": "?token={part}",
    "longer": "?token={token}A",
    "twice": "?token={token}&token={token}",
    "a wrong one first": "?token=x&token={token}",
    "a wrong one last": "?token={token}&token=x",
    "another key before": "?a=1&token={token}",
    "another key after": "?token={token}&a=1",
    "another spelling of the key": "?Token={token}",
    "escaped": "?token=%{code:02X}{rest}",
    "a blank after": "?token={token}%20",
    "a second question mark": "??token={token}",
    "of another run": "?token={other}",
}


@pytest.mark.parametrize("path", ["/", "/live"])
@pytest.mark.parametrize("query", TOKENS.values(), ids=TOKENS)
def test_every_other_token_is_refused(live, query, path):
    token = live.guard.token
    with serving() as another:
        words = {"swapped": token.swapcase(), "part": token[:-1], "code": ord(token[0]), "rest": token[1:]}
        query = query.format(token=token, other=another.guard.token, **words)
    assert status(raw(live, request(live, path + query, *upgrade(), origin(live)))) == 401


@pytest.mark.parametrize("query", ["\ud800", "token=\udcff", "token=\u00e9", "\0", ""], ids=ascii)
def test_a_query_of_any_text_is_refused(live, query):
    asked = Asked(method="GET", target=f"/?{query}", hosts=(f"127.0.0.1:{live.guard.port}",), origins=())
    assert live.guard.judge(asked).status == 401


def test_a_token_in_a_header_or_a_cookie_is_none(live):
    token = live.guard.token
    headers = (f"Authorization: Bearer {token}", f"Cookie: token={token}", f"Referer: {live.url}")
    assert status(raw(live, request(live, "/", *headers))) == 401


@pytest.mark.parametrize(
    "path",
    [
        "/../../etc/passwd",
        "/..%2f..%2fetc/passwd",
        "//",
        "/live/",
        "/live/../live",
        "/LIVE",
        "/./",
        "/%2e",
        "/index.html",
        "/viewer.js",
        "\\",
        "http://127.0.0.1/",
        "*",
    ],
)
def test_there_are_two_paths_and_no_files(live, path):
    assert status(raw(live, request(live, f"{path}?token={live.guard.token}", *upgrade(), origin(live)))) == 404


@pytest.mark.parametrize("method", ["POST", "HEAD", "OPTIONS", "PUT", "DELETE", "TRACE", "CONNECT", "PATCH", "get"])
def test_nothing_but_get_is_answered(live, method):
    assert status(raw(live, request(live, good(live), method=method))) == 405
    assert status(raw(live, request(live, to_socket(live), *upgrade(), origin(live), method=method))) == 405


def test_no_other_site_is_allowed_to_read(live):
    asked = ("Access-Control-Request-Method: GET", "Access-Control-Request-Private-Network: true")
    for answer in (
        raw(live, request(live, good(live), "Origin: http://evil.com", *asked, method="OPTIONS")),
        raw(live, request(live, good(live))),
    ):
        assert b"access-control" not in answer.lower()


@pytest.mark.parametrize(
    ("sent", "expected"),
    [
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 hello over TLS\r\n\r\n", 0),
        (b"\x00" * 64 + b"\r\n\r\n", 0),
        (b"GET / HTTP/2.0\r\n\r\n", 0),
        (b"GET /\r\n\r\n", 0),
        (b"GET /?token=\xed\xa0\x80 HTTP/1.1\r\n\r\n", 0),
        (b"GET / HTTP/1.1\r\nHost 127.0.0.1\r\n\r\n", 0),
        (b"GET / HTTP/1.1\r\n" + b"A: 1\r\n" * 200 + b"\r\n", 431),
        (b"GET / HTTP/1.1\r\nA: " + b"a" * 20_000 + b"\r\n\r\n", 431),
        (b"GET /" + b"a" * 20_000 + b" HTTP/1.1\r\n\r\n", 414),
        (b"GET /" + b"a" * 600 + b" HTTP/1.1\r\n\r\n", 414),
    ],
    ids=[
        "TLS",
        "zeros",
        "HTTP/2",
        "HTTP/0.9",
        "no ASCII",
        "no colon",
        "many headers",
        "long header",
        "long line",
        "long path",
    ],
)
def test_what_is_no_request_is_refused(live, sent, expected):
    assert status(raw(live, sent)) == expected


def test_a_body_is_refused(live):
    for header in ("Content-Length: 5", "Transfer-Encoding: chunked"):
        assert status(raw(live, request(live, good(live), header) + b"hello")) in (0, 501)


def test_the_page_and_the_socket_of_this_run_are_answered(live):
    answer = raw(live, request(live, good(live)))
    assert status(answer) == 200
    assert answer.endswith(PAGE.html)
    assert status(raw(live, request(live, to_socket(live), *upgrade(), origin(live)))) == 101
    host = f"localhost:{live.guard.port}"
    opened = request(live, to_socket(live), *upgrade(), origin(live, "localhost"), host=host)
    assert status(raw(live, opened)) == 101


def test_every_reply_of_the_guard_keeps_the_page_to_itself(live):
    for answer in (raw(live, request(live, good(live))), raw(live, request(live, "/"))):
        head = {line.partition(":")[0]: line.partition(":")[2].strip() for line in answer.decode().split("\r\n")}
        assert head["Referrer-Policy"] == "no-referrer"
        assert head["X-Content-Type-Options"] == "nosniff"
        assert head["Cross-Origin-Resource-Policy"] == "same-origin"
        assert head["Cache-Control"] == "no-store"
        assert "Server" not in head
        policy = head["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert set(re.findall(r"connect-src ([^;]*);", policy)) <= {
            f"ws://127.0.0.1:{live.guard.port} ws://localhost:{live.guard.port}"
        }


# --- connections that do no request ----------------------------------------------------------------------------------


def test_a_header_that_never_ends_is_cut_off(monkeypatch):
    monkeypatch.setattr(server_module, "OPEN_S", 0.2)
    with serving() as server:
        assert raw(server, b"GET / HTTP/1.1\r\nHost: 127") == b""
        assert status(raw(server, request(server, good(server)))) == 200


def test_idle_connections_are_bounded_and_those_who_come_after_them_are_served(monkeypatch):
    # so long that only the bound can close them
    monkeypatch.setattr(server_module, "OPEN_S", 10.0 * HANG_S)
    with serving() as server:
        idle = [socket.create_connection(("127.0.0.1", server.guard.port), timeout=HANG_S) for _ in range(200)]
        # all but the first of them are closed at once
        for peer in idle[MOST_CONNECTIONS:]:
            assert _is_closed(peer)
        for peer in idle:
            peer.close()
        assert status(_until_answered(server)) == 200


def _is_closed(peer) -> bool:
    try:
        return peer.recv(1) == b""
    except ConnectionResetError:
        return True


def _until_answered(server) -> bytes:
    """The answer to the page's request, once the connections that were closed are forgotten."""
    while True:
        try:
            answer = raw(server, request(server, good(server)))
        except (ConnectionResetError, BrokenPipeError):
            continue
        if answer:
            return answer


def test_thousands_of_connections_leave_nothing():
    def open_files():
        return len(os.listdir("/proc/self/fd"))

    with serving() as server:
        raw(server, request(server, good(server)))
        before = open_files()
        for at in range(size(3000, 200)):
            with closing(socket.create_connection(("127.0.0.1", server.guard.port), timeout=HANG_S)) as peer:
                if at % 2:
                    peer.sendall(b"GET / HTTP/1.1\r\n")
        assert status(_until_answered(server)) == 200
        assert open_files() <= before + MOST_CONNECTIONS


# --- frames that are no commands -------------------------------------------------------------------------------------


def test_a_message_that_is_too_long_ends_the_connection(live):
    with page_of(live) as page:
        page.send("x" * 4097)
        assert _closed_with(page) == 1009


def test_many_messages_that_are_no_commands_end_the_connection(live):
    with page_of(live) as page:
        for _ in range(MOST_MISTAKES):
            page.send(os.urandom(64))
        assert _closed_with(page) == 1008


def test_frames_that_break_the_protocol_end_the_connection(live):
    opened = request(live, to_socket(live), *upgrade(), origin(live))
    for frame in (
        b"\xff" * 200,
        struct.pack("!BBQ", 0x82, 0xFF, 2**62),
        b"\x81\x05hello",
        os.urandom(500) + b"\xff" * 9,
    ):
        with closing(socket.create_connection(("127.0.0.1", live.guard.port), timeout=HANG_S)) as peer:
            peer.sendall(opened + frame)
            while True:
                try:
                    if not peer.recv(65536):
                        break
                except ConnectionResetError:
                    break
    assert status(raw(live, request(live, good(live)))) == 200


def _closed_with(page) -> int:
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            page.recv(timeout=HANG_S)
    return closed.value.rcvd.code


# --- where it listens ------------------------------------------------------------------------------------------------


def test_nothing_listens_beyond_loopback(live):
    own = {_link(each) for each in Path("/proc/self/fd").iterdir()}
    listening = []
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for row in Path(table).read_text().splitlines()[1:]:
            columns = row.split()
            if columns[3] == "0A" and f"socket:[{columns[9]}]" in own:
                address, port = columns[1].split(":")
                listening.append((address, int(port, 16)))
    assert ("0100007F", live.guard.port) in listening
    assert {address for address, _ in listening} == {"0100007F"}


def _link(path: Path) -> str:
    try:
        return str(path.readlink())
    except OSError:
        return ""


def test_a_port_that_is_taken_has_a_code(live):
    with pytest.raises(Fault) as refused:
        LiveServer(Exchange(), PAGE, live.guard.port).start()
    assert refused.value.code == "RBL834"
    assert str(live.guard.port) in refused.value.message


@pytest.mark.parametrize("port", [-1, 65536])
def test_a_port_that_is_none_has_a_code(port):
    with pytest.raises(Fault) as refused:
        LiveServer(Exchange(), PAGE, port).start()
    assert refused.value.code == "RBL834"


def test_each_run_has_a_token_of_its_own():
    with serving() as first, serving() as second:
        assert first.guard.token != second.guard.token
        assert len(first.guard.token) >= 32


def test_nothing_is_logged_that_holds_the_token(caplog):
    with caplog.at_level(logging.DEBUG), serving() as server:
        raw(server, request(server, good(server)))
        raw(server, request(server, good(server), host="evil.com"))
        with page_of(server):
            pass
        token = server.guard.token
    # the client of this test is in the same process
    assert not [each for each in caplog.records if token in each.getMessage() and each.name != "websockets.client"]
