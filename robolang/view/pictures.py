"""Pictures and films of a run, drawn from its log by MuJoCo."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from robolang.core.storage import write_atomic
from robolang.logs.log import Log
from robolang.view.film_files import FORMATS, Format, Image
from robolang.view.replay import Replay
from runtime.appearance.scene import Scene, View
from runtime.appearance.stance import Stance
from runtime.appearance.views import named_view
from runtime.core.faults import Fault
from runtime.plant.camera import Camera
from runtime.plant.dressing import undrawable

SMALLEST, LARGEST = 16, 4096
"""Pixels of an edge of a picture."""
FASTEST = 60
"""Most pictures of a film in a second."""

Progress = Callable[[int, int, str], None]
"""Called after each picture: how many are drawn, of how many, by which library."""


class Postures(Protocol):
    """A scene over time: ``Replay`` of a log, ``TableReplay`` of exported pulse tables."""

    scene: Scene

    @property
    def end(self) -> float:
        """The last time, s."""

    def at(self, time: float) -> Stance:
        """Return the posture at a time, s."""

    def samples(self) -> list[Stance]:
        """Return postures by which a view is framed."""


USUAL_RATE = 15
"""Pictures of a film per second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """A picture or film that is to be made: its file, view (None: that of the cell, else ``iso``), the time ``at`` of a
    picture, s (None: the end), the size in pixels (None: the usual one), the ``rate`` of a film, 1/s,
    and whether points have ``labels``."""

    path: Path
    view: str | None = None
    at: float | None = None
    size: tuple[int, int] | None = None
    rate: int = USUAL_RATE
    labels: bool = True

    @property
    def format(self) -> Format:
        """The kind of the file; ``Fault`` RBL832 for an ending that is none."""
        found = FORMATS.get(self.path.suffix.lower())
        if found is None:
            raise Fault("RBL832", f"'{self.path}' must end in {', '.join(FORMATS)}")
        return found

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height."""
        return self.size or self.format.size

    def check(self) -> None:
        """Refuse what cannot be made, before a run that takes its time; ``Fault`` RBL831 or RBL832."""
        kind = self.format
        width, height = self.pixels
        if not all(SMALLEST <= edge <= LARGEST for edge in self.pixels):
            raise Fault("RBL832", f"{width}x{height} is no size: give {SMALLEST} to {LARGEST} pixels for each edge")
        if kind.even and (width % 2 or height % 2):
            raise Fault("RBL832", f"{width}x{height} has an odd edge, and an .mp4 needs even ones")
        if not 1 <= self.rate <= FASTEST:
            raise Fault("RBL832", f"{self.rate} pictures per second are not from 1 to {FASTEST}")
        if self.at is not None and kind.is_film:
            raise Fault("RBL832", f"a time is for a picture, and a {self.path.suffix} is a film of the whole run")
        kind.check(self.path.suffix)

    def times(self, end: float) -> list[float]:
        """Return the times, s, of the pictures of a run that ends at ``end``; ``Fault`` RBL832."""
        if not self.format.is_film:
            at = end if self.at is None else self.at
            if not 0.0 <= at <= end:
                raise Fault("RBL832", f"{at:g} s is outside of the run, which is from 0 to {end:.3f} s")
            return [at]
        # the last picture is the end itself: what the program came to
        found = [*(k / self.rate for k in range(int(end * self.rate) + 1)), end]
        if len(found) > self.format.most:
            raise Fault(
                "RBL832",
                f"{len(found)} pictures of {end:.1f} s are more than the {self.format.most} of a {self.path.suffix}",
                "give a smaller --fps, or write an .mp4",
            )
        width, height = self.pixels
        if not len(found) * width * height <= self.format.most_pixels:
            raise Fault(
                "RBL832",
                f"{len(found)} pictures of {width}x{height} have more than the {self.format.most_pixels / 1e6:g} "
                f"million pixels of a {self.path.suffix}, which is made in memory",
                "give a smaller --size or --fps, or write an .mp4",
            )
        return found


def render(
    subject: Log | Postures, order: Order, progress: Progress = lambda done, count, library: None
) -> tuple[str, ...]:
    """Draw a run, or anything that has postures, and write the file, whole or not; return notes on what is not in it.

    ``Fault`` RBL820 or RBL833 for a log without a scene, RBL830 where nothing can draw, RBL832 for an order that does
    not suit the run, RBL706 for a file that cannot be written.
    """
    replay = Replay(subject) if isinstance(subject, Log) else subject
    times = order.times(replay.end)
    width, height = order.pixels
    view = _view(replay, order)
    with Camera(replay.scene, width=width, height=height, labels=order.labels) as camera:

        def pictures() -> Iterator[Image]:
            for count, time in enumerate(times, start=1):
                image = camera.picture(replay.at(time), view)
                # before it is given away: a writer that has all it needs does not come back
                progress(count, len(times), camera.graphics)
                yield image

        write_atomic(order.path, lambda stream: order.format.write(stream, pictures(), order.rate))
    return tuple(f"the mesh {name!r} has no area and is left out" for name in undrawable(replay.scene))


def _view(replay: Postures, order: Order) -> View:
    if order.view is None and replay.scene.camera is not None:
        return replay.scene.camera
    width, height = order.pixels
    # of the whole run, not of one time: all pictures of a run are then taken from one place
    return named_view(order.view or "iso", replay.scene, replay.samples(), width / height)
