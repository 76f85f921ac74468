"""What the run and the pages exchange: newest states for the pages, commands for the run. Neither ever waits.

The run's thread puts a frame and a status in place of the ones before it, adds what PRINT shows and replies to a ring,
and takes one command in each cycle. The server's thread sends what is new to every page at the page's own pace: a page
that does not read gets fewer frames, and the run does not know of it. Commands that nobody takes are bounded too.

Who has control is decided here: the first page that is there; every other one watches. Control is handed over by two
acts, one in each page (``give``, then ``take``), so it never changes under somebody's hand. Stop and pause need no
control, wait for nothing, and end what waits: what was ordered before a stop must not move the arm after it.
"""

import json
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.teaching.held_button import HeldButton, Press
from robolang.view.begun import Begun, Got
from robolang.view.messages import Command, Go, Held, Jog, Message
from runtime.control.clock import wall_s
from runtime.core.faults import Fault

MOST_WAITING = 16
"""Commands that wait for the run; a page sends one after another."""
HALTS = ("stop", "pause")
"""Commands that are taken before all others, from every page; the first of them first."""
MOST_SAID = 200
"""Lines and replies that are kept for a page that reads slowly."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """A command for the run: of which page, with its number there, and the press of a jog."""

    page: int
    id: int
    command: Command
    press: Press | None = None


@dataclass(slots=True, kw_only=True, eq=False)
class Page:
    """What one page has still to get; read and written in the server's thread, ``said`` by both."""

    number: int
    frame: int = 0
    begun: Got = field(default_factory=Got)
    hello: str = ""
    status: tuple[int, str] = (-1, "")
    notes: int = 0
    said: deque[str] = field(default_factory=lambda: deque(maxlen=MOST_SAID))


class Exchange:
    """Between the thread of a run and the thread of its server."""

    def __init__(self, *, watched_only: bool = False) -> None:
        """``watched_only``: no page may command, since something else drives the arm."""
        self._watched_only = watched_only
        self.hello = '{"kind":"hello"}'
        """What a page gets first, and once more when it has changed, as JSON."""
        self.button = HeldButton()
        self.frame: tuple[int, bytes] = (0, b"")
        """The newest frame, counted."""
        self.status: tuple[int, str] = (0, '{"state":"starting"}')
        """The newest status, counted, as JSON without what depends on the page."""
        self.notes: tuple[int, str] = (0, "")
        """The newest list of notes, counted, as a message."""
        self.begun = Begun()
        """The statements that have begun."""
        self.notify: Callable[[], None] = lambda: None
        """Wakes the server; it never waits."""
        self._pages: dict[int, Page] = {}
        self._control: int | None = None
        self._last = 0
        self._orders: deque[Order] = deque()
        self._halts: dict[str, Order] = {}
        self._wake = threading.Event()

    # --- the run's thread --------------------------------------------------------------------------------------------

    def greet(self, hello: Mapping[str, Any]) -> None:
        """Give this to each page that comes from now on first, and to those that have got another one."""
        self.hello = json.dumps({"kind": "hello", **hello}, separators=(",", ":"))
        self.notify()

    def show_frame(self, frame: bytes) -> None:
        """Put a frame in place of the one before it."""
        self.frame = self.frame[0] + 1, frame
        self.notify()

    def show_status(self, status: str) -> None:
        """Put a status, a JSON object, in place of the one before it, if it differs."""
        # it is made with every frame and changes rarely
        if status != self.status[1]:
            self.status = self.status[0] + 1, status
            self.notify()

    def show_notes(self, notes: Sequence[Mapping[str, Any]]) -> None:
        """Put all notes in place of those before."""
        self.notes = self.notes[0] + 1, json.dumps({"kind": "notes", "rows": notes}, separators=(",", ":"))
        self.notify()

    def begin(self, statement: Mapping[str, Any]) -> None:
        """Add a statement that begins to those that pages show."""
        self.begun.add(statement)
        self.notify()

    def say(self, text: str) -> None:
        """Send a line of PRINT to every page."""
        line = json.dumps({"kind": "printed", "text": text})
        # a copy: the server's thread adds and removes pages
        for page in list(self._pages.values()):
            page.said.append(line)
        self.notify()

    def reply(self, page: int, id: int, fault: Fault | None = None, notes: tuple[str, ...] = ()) -> None:
        """Answer a command of a page, which may have gone."""
        found = self._pages.get(page)
        # a page that has gone needs no answer
        if found is not None:
            found.said.append(_reply(id, fault, notes))
            self.notify()

    def take(self) -> Order | None:
        """Return the next command, if there is one: a stop, a pause, else the oldest."""
        for word in HALTS:
            halt = self._halts.pop(word, None)
            if halt is not None:
                return halt
        # a stop that comes now takes the last one away
        with suppress(IndexError):
            return self._orders.popleft()
        return None

    def wait(self, seconds: float) -> None:
        """Wait until a command comes, or something is over; at most so long."""
        if not (self._halts or self._orders) and self._wake.wait(seconds):
            self._wake.clear()

    def wake(self) -> None:
        """End a ``wait``; safe to call from a signal handler."""
        self._wake.set()

    @property
    def pages(self) -> tuple[int, ...]:
        """The numbers of the pages that are there."""
        return tuple(self._pages)

    # --- the server's thread -----------------------------------------------------------------------------------------

    def join(self) -> Page:
        """Let a page in. A jog stops: whoever holds its button may not know that somebody else looks on."""
        self.button.release()
        self._last += 1
        # counted, never used again: an old reply must not reach another page
        page = Page(number=self._last)
        # alone only: a page that is opened beside others must not take control unasked
        if not self._pages and not self._watched_only:
            self._control = page.number
        self._pages[page.number] = page
        self._wake.set()
        self.notify()
        return page

    def leave(self, page: Page) -> None:
        """Let a page go: its button is released, and its control is free."""
        self.button.release(page.number)
        del self._pages[page.number]
        if self._control == page.number:
            self._control = None
        self.notify()

    def control_for(self, page: Page) -> str:
        """Return who has control, as a page sees it: yours, free, other, or none where pages only watch."""
        if self._watched_only:
            return "none"
        if self._control is None:
            return "free"
        return "yours" if self._control == page.number else "other"

    def receive(self, page: Page, message: Message) -> None:
        """Hand a command over; what cannot be handed over is answered at once (RBL836, RBL837)."""
        try:
            self._receive(page, message)
        except Fault as fault:
            self.reply(page.number, message.id, fault)

    def _receive(self, page: Page, message: Message) -> None:
        if self._watched_only:
            raise Fault("RBL837", "pages only watch here: the prompt has control", "Type the command at the prompt.")
        match message.command:
            case Held(jog=jog, released=released):
                # a sign that comes after its release, or of a page without control, finds no button and is no error
                if released:
                    self.button.release(page.number, jog)
                    self._wake.set()
                else:
                    self.button.keep(page.number, jog, wall_s())
                return
            case Go(word="take" | "give" as word):
                self._hand_over(page, word)
                self.reply(page.number, message.id)
                return
            case Go(word=word) if word in HALTS:
                self._halt(word, Order(page=page.number, id=message.id, command=message.command))
                return
            case command:
                if self._control != page.number:
                    raise Fault("RBL837", "another page has control" if self._control else "no page has control")
        if len(self._orders) >= MOST_WAITING:
            raise Fault("RBL836", f"{MOST_WAITING} commands wait already")
        # held from here on, so that the time in which the run plans the jog counts too
        press = self.button.press(page.number, message.id, wall_s()) if isinstance(command, Jog) else None
        self._orders.append(Order(page=page.number, id=message.id, command=command, press=press))
        self._wake.set()

    def _halt(self, word: str, order: Order) -> None:
        """Put a stop or a pause before all that waits, which is not done any more (RBL836)."""
        # withdrawn first: the run must not find an older start after the halt
        self.button.release()
        with suppress(IndexError):
            while True:
                older = self._orders.popleft()
                self.reply(older.page, older.id, Fault("RBL836", f"a {word} came before its turn"))
        # one of each: a second one finds that the first is to be done
        if self._halts.setdefault(word, order) is not order:
            self.reply(order.page, order.id)
        self._wake.set()

    def _hand_over(self, page: Page, word: str) -> None:
        if word == "give":
            if self._control != page.number:
                raise Fault("RBL837", "this page has no control that it could give")
            self.button.release()
            self._control = None
        elif self._control not in (None, page.number):
            raise Fault("RBL837", "another page has control")
        else:
            self._control = page.number
        self.notify()


def _reply(id: int, fault: Fault | None, notes: tuple[str, ...]) -> str:
    if fault is None:
        return json.dumps({"kind": "reply", "id": id, "ok": True, "notes": notes})
    return json.dumps(
        {
            "kind": "reply",
            "id": id,
            "ok": False,
            "code": fault.code,
            "message": fault.message,
            "hint": fault.hint,
        }
    )
