"""Finds and starts the browser of the tests; where there is none, a test is skipped, in CI it fails."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

BROWSERS = (Path("/usr/bin/chromium-headless-shell"), Path("/usr/bin/chromium"))
"""The first that is there is taken: without windows, which nobody sees, a page costs a third."""
QUIET = [
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
WITHOUT_GL = ["--disable-gpu", "--disable-3d-apis"]
PATIENCE_MS = 60_000


def require() -> Path:
    """Return the browser."""
    if found := next((path for path in BROWSERS if path.exists()), None):
        return found
    reason = f"no browser: {' and '.join(map(str, BROWSERS))} are not there"
    if os.environ.get("ROBOLANG_BROWSER") == "required":
        pytest.fail(reason)
    pytest.skip(reason)


@contextmanager
def browsers(*kinds: list[str]) -> Iterator[list[Browser]]:
    """Start a browser of each kind; together, since Playwright runs one loop a thread."""
    path = str(require())
    with sync_playwright() as playwright:
        started = [playwright.chromium.launch(executable_path=path, args=QUIET + gl) for gl in kinds]
        try:
            yield started
        finally:
            for browser in started:
                browser.close()


@contextmanager
def chromium(gl: list[str] = SOFTWARE_GL) -> Iterator[Browser]:
    with browsers(gl) as (browser,):
        yield browser


class Tab:
    """One page without network: it collects what the page asks for and what it complains about."""

    def __init__(self, browser: Browser, width: int = 1280, height: int = 800, **context: object) -> None:
        self.context = browser.new_context(viewport={"width": width, "height": height}, offline=True, **context)
        self.page: Page = self.context.new_page()
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))

    def open(self, path: Path, mark: str = "#plain") -> Page:
        """Open a file and wait until the page says how it came out."""
        self.page.goto(path.as_uri() + mark)
        self.page.wait_for_selector("body:not([data-state=loading])", timeout=PATIENCE_MS)
        return self.page

    def close(self) -> None:
        self.context.close()
