"""``make figures``: takes the pictures of README and docs into docs/pictures/, from runs made on the spot.

Every picture comes from a command that a reader has too; pages are opened in a browser without a network.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image

from robolang.__main__ import main
from tests.bench.corner_picture import corners
from tests.pages import assert_carried_out, blocks_of
from tests.robolang.view.browser import Tab, chromium

FOLDER = Path(__file__).parents[2] / "docs" / "pictures"
INSPECT = "programs/shop/inspect.rbl"
DEMO = "programs/pick_and_place.rbl"
LINES = "programs/universal/lines.rbl"
ROBOTS = {
    "puma560": DEMO,
    "manutec_r3": "programs/manutec_pick_and_place.rbl",
    "irb2400": "programs/wrist/e1.rbl",
    "ur5e": LINES,
    "ur10e": LINES,
    "cobra600": "programs/scara/pick.rbl",
}
IN_A_ROW = 3
WIDE = (1600, 960)
PLANNED = """LOAD (0, 0, 60), 0.8
HAND OFF
SPEED 900
MOVE P4
MOVE P1
MOVE P2
MOVE P5
MOVE P3 + (0, 0, -20)
"""


def robolang(*words: object, ok: tuple[int, ...] = (0,)) -> None:
    """Run a command line; an exit code that is not ``ok`` ends the script."""
    sys.argv = ["robolang", *map(str, words)]
    try:
        main()
    except SystemExit as end:
        if (end.code or 0) not in ok:
            raise


def shoot(page: Path, name: str, prepare: str, *, scheme: str = "light") -> None:
    """Take a picture of a page after a script has prepared it."""
    with chromium() as browser:
        tab = Tab(browser, *WIDE, color_scheme=scheme)
        shown = tab.open(page, mark="")
        shown.evaluate(prepare)
        shown.wait_for_timeout(2000)  # labels and charts that come into view are drawn in the frames after
        shown.screenshot(path=str(FOLDER / name))
        assert not tab.complaints, tab.complaints


def page_of_a_run(work: Path) -> None:
    """The demo in its page."""
    robolang("run", DEMO, "--quiet", "--log", work / "run.npz", "--html", work / "run.html")
    shoot(work / "run.html", "page.png", "robolang.seek(2.0)")


def two_runs(work: Path) -> None:
    """The demo, and the same without the LOAD that declares the part."""
    for beside in Path(DEMO).parent.glob(f"{Path(DEMO).stem}*"):
        shutil.copy(beside, work)
    text = Path(DEMO).read_text("utf-8")
    without, count = re.subn(r"^50 .*\n", "", text, flags=re.M)
    assert count == 1
    # the controller would stop the second run: it notices that the hand carries more than was declared
    warn = ("--quiet", "--set", "supervision.payload_mismatch=warn", "--log")
    robolang("run", DEMO, *warn, work / "declared.npz")
    (work / Path(DEMO).name).write_text(without, "utf-8")
    robolang("run", work / Path(DEMO).name, *warn, work / "forgotten.npz")
    labels = ("--label", "LOAD declared", "--label", "LOAD forgotten")
    robolang("report", work / "declared.npz", work / "forgotten.npz", *labels, "-o", work / "two.html")
    shoot(work / "two.html", "two_runs.png", "robolang.seek(2.0)", scheme="dark")


def live(work: Path) -> None:
    """The live page while the demo runs."""
    words = [sys.executable, "-m", "robolang", "view", DEMO, "--no-browser"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as view:
        assert view.stderr is not None
        address = re.search(r"http://\S+", view.stderr.readline())
        assert address is not None
        try:
            with chromium() as browser:
                page = browser.new_context(viewport={"width": WIDE[0], "height": WIDE[1]}).new_page()
                page.goto(address[0])
                page.wait_for_selector("body[data-state=ready]")
                page.get_by_text("Start", exact=True).click()
                page.wait_for_timeout(4000)
                page.screenshot(path=str(FOLDER / "live.png"))
        finally:
            view.terminate()


def plan(work: Path) -> None:
    """The planned motion of a program that does not keep its speed, with what check finds in it."""
    for beside in Path(DEMO).parent.glob(f"{Path(DEMO).stem}*"):
        shutil.copy(beside, work)
    program = work / Path(DEMO).name
    program.write_text(PLANNED, "utf-8")
    robolang("check", "--motion", "--html", work / "plan.html", program, ok=(0, 1, 3))
    shoot(work / "plan.html", "plan.png", "robolang.seek(1.2)")


def robots(work: Path) -> None:
    """The built-in arms, in rows."""
    side = 640
    grid = Image.new("RGB", (IN_A_ROW * side, -(-len(ROBOTS) // IN_A_ROW) * side))
    for index, (name, program) in enumerate(ROBOTS.items()):
        where = ("-o", work / f"{name}.png", "--at", "2", "--size", f"{side}x{side}")
        robolang("render", program, "--robot", name, *where)
        row, column = divmod(index, IN_A_ROW)
        grid.paste(Image.open(work / f"{name}.png").convert("RGB"), (column * side, row * side))
    grid.save(FOLDER / "robots.png")


def plot(work: Path) -> None:
    """The error of the tool and the inertia of the waist."""
    robolang("run", DEMO, "--quiet", "--log", work / "run.npz")
    robolang("plot", work / "run.npz", "tool_error", "D:1", "-o", FOLDER / "plot.svg")


def speed(work: Path) -> None:
    """The speed of the tool along its path, beside the programmed one, where corners slow it."""
    robolang("run", INSPECT, "--no-physics", "--quiet", "--log", work / "run.npz")
    robolang("plot", work / "run.npz", "--along-path", "-o", FOLDER / "speed.svg")


def corner(work: Path) -> None:
    """A corner, and the corners of a curve of chords, as they are planned."""
    (FOLDER / "corner.svg").write_text(corners(), "utf-8")


def tutorial(work: Path) -> None:
    """The job of the tutorial after its last step, by the commands of the page itself."""
    assert_carried_out("".join(blocks_of("tutorial")), work)
    shutil.copy(work / "out" / "tutorial" / "post.png", FOLDER / "tutorial.png")


PICTURES: tuple[Callable[[Path], None], ...] = (
    page_of_a_run,
    two_runs,
    plan,
    live,
    robots,
    plot,
    speed,
    corner,
    tutorial,
)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for draw in PICTURES:
        print(f"{draw.__name__} ...", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            draw(Path(folder))
