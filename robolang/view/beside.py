"""A live picture beside something else that drives the arm, such as the prompt: pages watch, and command nothing."""

from contextlib import ExitStack

from robolang.execution.observer import Observers
from robolang.execution.session import Session
from robolang.view.guard import LivePage
from robolang.view.live import Live, open_page


class LiveBeside:
    """Pages that watch one session after another."""

    def __init__(self, page: LivePage) -> None:
        self._live = Live(page, watched_only=True)
        self._serving = ExitStack()
        self._url = ""

    def follow(self, session: Session, observers: Observers) -> None:
        """Show this session from now on; the first one begins to serve the page. ``Fault`` RBL834."""
        if self._url:
            self._live.follow(session)
        else:
            self._url = self._serving.enter_context(self._live.serve(session))
        observers.add(self._live.frames)

    def open(self) -> str:
        """Open the page in a browser, if there is one, and return its address."""
        open_page(self._url)
        return self._url

    def show(self) -> None:
        """Show where the session stands now."""
        self._live.show()

    def close(self) -> None:
        """Tell the pages that nothing more comes, and stop serving them."""
        self._live.frames.stop()
        self._serving.close()
