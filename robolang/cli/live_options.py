"""Options of the live view, and how its address is given to people."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.options import Group, Option
from robolang.cli.output import echo
from robolang.cli.signals import handled
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.execution.session import RunResult, Session
    from robolang.view.live import Live


class PageOptions(Group):
    """Where the live page is served, and whether a browser opens it."""

    PANEL: ClassVar[str] = "Live view"
    port: Annotated[
        int | None,
        Option("--port", metavar="N", low=0, high=65535, help="Port on 127.0.0.1; default: 0, any that is free."),
    ] = None
    no_browser: Annotated[bool, Option("--no-browser", help="Open no browser: the address is printed only.")] = False


class FollowOptions(PageOptions):
    """Whether a run is followed by a live page."""

    view: Annotated[bool, Option("--view", help="Follow the run in a browser.")] = False


def check_follow(options: FollowOptions) -> None:
    """Raise ``OptionValueError`` for an option of a page that no page would follow."""
    for name, given in {"--port": options.port is not None, "--no-browser": options.no_browser}.items():
        if given and not options.view:
            raise OptionValueError(name, "is for a page that follows the run; add --view")


def announce(url: str, options: PageOptions) -> None:
    """Print the address of the live page to stderr, and open it in a browser if there is one."""
    from robolang.view.live import open_page

    # the only place where the token is shown
    echo(f"live view: {url}", err=True)
    if not options.no_browser:
        open_page(url)


def pages_of(options: FollowOptions) -> "Live | None":
    """Return the live view that a run is followed by, None without ``--view``."""
    if not options.view:
        return None
    from robolang.view.live import Live
    from robolang.view.live_page import live_page
    from robolang.view.page import Bundle

    return Live(live_page(Bundle.installed()), options.port or 0)


@contextmanager
def followed(session: "Session", pages: "Live | None", options: FollowOptions) -> "Iterator[Callable[[], RunResult]]":
    """Yield what runs a session, by itself or followed by pages, which are served meanwhile."""
    if pages is None:
        yield session.run
        return
    from robolang.view.driver import Driver

    driver = Driver(session, pages.exchange, pages.frames)
    with pages.serve(session) as url:
        announce(url, options)
        _await(pages)
        yield lambda: session.run(driver.run_through)


def remain(pages: "Live") -> None:
    """Let the pages that are there show the end of their run until they are closed, or a signal ends that."""
    from robolang.view.live import LAST_PAGE_S

    if not pages.exchange.pages:
        return
    echo(
        f"live view: the run is over; it ends with its pages, with Ctrl-C, or in {LAST_PAGE_S / 60:.0f} minutes",
        err=True,
    )
    # the files are written and the result stands: a signal is no failure of the run
    with handled(lambda number, frame: pages.leave()):
        pages.remain()


def _await(pages: "Live") -> None:
    """Let a run begin when its first page is there, or when none comes."""
    from robolang.view.live import FIRST_PAGE_S

    echo(f"live view: the run begins with its first page, or without one in {FIRST_PAGE_S:.0f} s", err=True)
    if not pages.wait_for_page():
        echo("live view: no page has come, the run begins", err=True)
