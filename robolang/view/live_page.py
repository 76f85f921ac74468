"""The live page: the same page as that of a run, without a run in it; its script opens the socket."""

from robolang.view.guard import LivePage
from robolang.view.page import Bundle

_MARK = b'<script type="text/plain" data-source="socket"></script>\n'
"""What the script finds in place of a run."""


def live_page(bundle: Bundle) -> LivePage:
    """Return the live page of a bundle."""
    script, style = bundle.hashes
    # the whole policy is a header, which knows the port; both hold, so that of the file names nothing else
    html = b"".join(bundle.filled("base-uri 'none'; form-action 'none'", [_MARK]))
    return LivePage(html=html, script=script, style=style)
