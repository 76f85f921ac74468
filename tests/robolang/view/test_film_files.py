"""Pictures and films as files, judged by the readers of Pillow and PyAV."""

import io
import sys
from typing import Any

import av
import numpy as np
import pytest
from PIL import Image as Pillow

from robolang.view.film_files import FORMATS
from runtime.core.faults import Fault


def frames(count, height=48, width=64):
    """Pictures of one colour each, with a black square that moves."""
    for k in range(count):
        image = np.full((height, width, 3), (40 + 10 * k, 120, 200 - 10 * k), np.uint8)
        image[8:24, 4 + 3 * k : 20 + 3 * k] = 0
        yield image


def written(suffix, count=8, rate=15):
    stream = io.BytesIO()
    FORMATS[suffix].write(stream, frames(count), rate)
    stream.seek(0)
    return stream


def test_a_png_has_every_pixel_and_is_the_same_again():
    rng = np.random.default_rng(1)
    image = rng.integers(0, 256, (37, 53, 3), dtype=np.uint8)
    streams = [io.BytesIO(), io.BytesIO()]
    for stream in streams:
        FORMATS[".png"].write(stream, iter([image]), 15)
    assert streams[0].getvalue() == streams[1].getvalue()
    read = Pillow.open(streams[0])
    assert (read.format, read.mode, read.size) == ("PNG", "RGB", (53, 37))
    assert np.array_equal(np.asarray(read), image)


@pytest.mark.parametrize(("suffix", "rate"), [(".gif", 15), (".gif", 60), (".webp", 15), (".webp", 7)])
def test_an_animation_shows_every_picture_for_its_time(suffix, rate):
    film: Any = Pillow.open(written(suffix, rate=rate))
    times, colours = [], []
    for k in range(film.n_frames):
        film.seek(k)
        film.load()
        times.append(film.info["duration"])
        colours.append(film.convert("RGB").getpixel((60, 40)))
    assert (film.size, len(times), film.info.get("loop")) == ((64, 48), 8, 0)
    # whole hundredths or thousandths of a second, which do not drift
    assert sum(times) == pytest.approx(8000 / rate, abs=5.1)
    np.testing.assert_allclose(colours, [image[40, 60] for image in frames(8)], atol=14)


def test_an_mp4_has_every_picture_at_its_rate():
    with av.open(written(".mp4", rate=30)) as film:
        track = film.streams.video[0]
        images = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
        assert (track.codec.name, track.width, track.height) == ("h264", 64, 48)
        assert float(track.average_rate) == pytest.approx(30.0)
    assert len(images) == 8
    np.testing.assert_allclose([im[40, 60] for im in images], [im[40, 60] for im in frames(8)], atol=14)


@pytest.mark.parametrize(("suffix", "library"), [(".gif", "PIL"), (".webp", "PIL"), (".mp4", "av")])
def test_without_its_library_a_film_is_refused_and_the_extra_named(monkeypatch, suffix, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(Fault) as refused:
        FORMATS[suffix].check(suffix)
    assert refused.value.code == "RBL831"
    assert suffix in refused.value.message
    assert "robolang[video]" in refused.value.hint


def test_a_png_needs_no_library(monkeypatch):
    for library in ("PIL", "av"):
        monkeypatch.setitem(sys.modules, library, None)
    FORMATS[".png"].check(".png")
