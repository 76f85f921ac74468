"""Pictures and films as files. A ``.png`` is written here; films need the libraries of the extra ``[video]``."""

import importlib
import math
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault

Image = NDArray[np.uint8]
"""Height, width, red green blue."""
Writer = Callable[[IO[bytes], Iterator[Image], int], None]
"""Writes pictures, one after another, at a rate in 1/s."""

CODEC, QUALITY = "libx264", {"crf": "20", "preset": "medium"}
"""Of an ``.mp4``: the codec that every player has, and how much it may lose."""
PALETTE = 8
"""Pictures of a ``.gif`` from which its colours are taken."""
MOST_KEPT = 350_000_000
"""Most pixels of all pictures of a ``.gif`` or ``.webp``, which Pillow keeps until the file is written: 1.4 GB."""
LOSS = 75
"""Quality of a ``.webp``, from 0 to 100."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A kind of file: its writer, the libraries it needs, how many pictures and pixels of all of them it can
    hold, and whether sizes must be even. ``size`` is the usual one, pixels."""

    write: Writer
    libraries: tuple[str, ...] = ()
    most: int = 1
    most_pixels: float = math.inf
    even: bool = False
    size: tuple[int, int] = (1280, 720)

    @property
    def is_film(self) -> bool:
        """Whether it holds more than one picture."""
        return self.most > 1

    def check(self, suffix: str) -> None:
        """Refuse where a library is missing; ``Fault`` RBL831."""
        for name in self.libraries:
            try:
                importlib.import_module(name)
            except ImportError:
                raise Fault("RBL831", f"a {suffix} needs the library {name}") from None


def write_png(stream: IO[bytes], pictures: Iterator[Image], rate: int) -> None:
    """Write the first picture as PNG: eight bits, lines predicted from the line above."""
    image = next(pictures)
    height, width, _ = image.shape
    # the difference from the line above: flat areas become zeros, of which little is left
    above = np.concatenate([np.zeros_like(image[:1]), image[:-1]])
    lines = np.concatenate([np.full((height, 1), 2, np.uint8), (image - above).reshape(height, -1)], axis=1)
    stream.write(b"\x89PNG\r\n\x1a\n")
    for kind, data in (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(lines.tobytes(), 9)),
        (b"IEND", b""),
    ):
        stream.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def write_gif(stream: IO[bytes], pictures: Iterator[Image], rate: int) -> None:
    """Write an animation of one palette, in which flat areas do not flicker."""
    from PIL import Image as Pillow

    # kept packed until all are there: the palette is made of pictures from the whole film
    packed, shape = [], (0, 0, 0)
    for image in pictures:
        packed.append(zlib.compress(image.tobytes(), 1))
        shape = image.shape

    def picture(k: int) -> Image:
        return np.frombuffer(zlib.decompress(packed[k]), np.uint8).reshape(shape)

    chosen = sorted({round(k) for k in np.linspace(0, len(packed) - 1, PALETTE)})
    mosaic = Pillow.fromarray(np.concatenate([picture(k) for k in chosen]))
    palette = mosaic.quantize(256, method=Pillow.Quantize.MEDIANCUT)
    first, *others = range(len(packed))

    def made(k: int) -> Pillow.Image:
        return Pillow.fromarray(picture(k)).quantize(palette=palette, dither=Pillow.Dither.NONE)

    # a GIF counts in hundredths of a second
    shown = [10 * each for each in _steps(len(packed), 100, rate)]
    rest = map(made, others)
    made(first).save(stream, "GIF", save_all=True, append_images=rest, duration=shown, loop=0, optimize=False)


def write_webp(stream: IO[bytes], pictures: Iterator[Image], rate: int) -> None:
    """Write an animation with all colours."""
    from PIL import Image as Pillow

    first, *rest = (Pillow.fromarray(each) for each in pictures)
    shown = _steps(len(rest) + 1, 1000, rate)
    first.save(stream, "WEBP", save_all=True, append_images=rest, duration=shown, loop=0, quality=LOSS, method=4)


def write_mp4(stream: IO[bytes], pictures: Iterator[Image], rate: int) -> None:
    """Write a film; its height and width are even."""
    import av

    with av.open(stream, "w", format="mp4") as file:
        track: Any = file.add_stream(CODEC, rate=Fraction(rate))
        track.pix_fmt, track.options = "yuv420p", QUALITY
        first = next(pictures)
        track.height, track.width = first.shape[:2]
        for image in _again(first, pictures):
            file.mux(track.encode(av.VideoFrame.from_ndarray(image, format="rgb24")))
        file.mux(track.encode(None))


FORMATS = {
    ".png": Format(write=write_png),
    ".gif": Format(write=write_gif, libraries=("PIL",), most=600, most_pixels=MOST_KEPT, size=(640, 360)),
    ".webp": Format(write=write_webp, libraries=("PIL",), most=1500, most_pixels=MOST_KEPT, size=(640, 360)),
    ".mp4": Format(write=write_mp4, libraries=("av",), most=60_000, even=True),
}
"""What can be written, by the ending of the file."""


def _steps(count: int, units: int, rate: int) -> list[int]:
    """Return how long each of some pictures is shown, in parts of a second: whole numbers whose sum does not drift."""
    ends = [round(k * units / rate) for k in range(count + 1)]
    return [after - before for before, after in pairwise(ends)]


def _again(first: Image, rest: Iterator[Image]) -> Iterator[Image]:
    yield first
    yield from rest
