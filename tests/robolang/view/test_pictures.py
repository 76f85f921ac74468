"""What a picture or film of a run shows, and what is refused before anything is written."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow

from robolang.view import film_files
from robolang.view.pictures import Order, render
from runtime.core.faults import Fault
from runtime.plant import graphics
from tests.robolang.view.test_replay import SCENE, log
from tests.runtime.plant.drawing import need_graphics

pytestmark = pytest.mark.physics


def image(path):
    return np.asarray(Pillow.open(path).convert("RGB")).astype(int)


def drawn(tmp_path, name="x.png", recorded=None, **changes):
    need_graphics()
    order = Order(path=tmp_path / name, **{"size": (96, 64), **changes})
    order.check()
    render(recorded or log(), order)
    return order.path


def test_a_picture_is_of_its_time_and_its_view(tmp_path):
    pictures = [
        image(drawn(tmp_path, f"{k}.png", **changes))
        for k, changes in enumerate([{}, {"at": 0.399}, {"at": 0.05}, {"view": "side"}, {"view": "iso"}])
    ]
    end, at_end, early, side, iso = pictures
    assert end.shape == (64, 96, 3)
    assert np.array_equal(end, at_end) and np.array_equal(end, iso)
    assert not np.array_equal(end, early)
    assert not np.array_equal(end, side)


def test_a_cell_with_a_camera_is_seen_by_it(tmp_path):
    # straight down from high above: a picture of floor, with the cell in its middle
    camera = {"position": [0.0, 0.001, 60.0], "target": [0.0, 0.0, 0.0]}
    far = image(drawn(tmp_path, recorded=log(scene=SCENE | {"camera": camera})))
    assert np.abs(far[:20] - far[0, 0]).max() < 30
    near = image(drawn(tmp_path, recorded=log(scene=SCENE | {"camera": camera}), view="top"))
    assert np.abs(near[:20] - near[0, 0]).max() > 60


def test_a_film_is_of_the_whole_run_and_ends_with_its_end(tmp_path):
    film: Any = Pillow.open(drawn(tmp_path, "x.webp", rate=10))
    # 0.399 s: four tenths from 0 on, and the end
    film.seek(film.n_frames - 1)
    last = np.asarray(film.convert("RGB")).astype(int)
    assert film.n_frames == 5
    assert np.abs(last - image(drawn(tmp_path))).mean() < 6


def test_progress_names_the_library_and_counts(tmp_path):
    need_graphics()
    heard = []
    render(log(), Order(path=tmp_path / "x.gif", size=(32, 24), rate=10), lambda *words: heard.append(words))
    assert [(done, count) for done, count, _ in heard] == [(k, 5) for k in range(1, 6)]
    assert {library for _, _, library in heard} <= {"EGL", "OSMesa"}


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("x.jpg", {}),
        ("x", {}),
        ("x.mp4", {"size": (95, 64)}),
        ("x.png", {"size": (8, 64)}),
        ("x.png", {"size": (64, 5000)}),
        ("x.gif", {"at": 0.1}),
        ("x.gif", {"rate": 0}),
        ("x.gif", {"rate": 61}),
        ("x.png", {"at": 0.4}),
        ("x.png", {"at": -0.1}),
        ("x.png", {"at": float("nan")}),
    ],
)
def test_what_cannot_be_made_is_refused_and_nothing_is_written(tmp_path, name, changes):
    with pytest.raises(Fault) as refused:
        drawn(tmp_path, name, **changes)
    assert refused.value.code == "RBL832"
    assert os.listdir(tmp_path) == []


def test_too_many_pictures_are_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(film_files.FORMATS, ".gif", film_files.Format(write=film_files.write_gif, most=4))
    with pytest.raises(Fault) as refused:
        drawn(tmp_path, "x.gif", rate=10)
    assert (refused.value.code, refused.value.message.split()[0]) == ("RBL832", "5")


@pytest.mark.parametrize("name", ["x.gif", "x.webp"])
def test_pictures_that_do_not_fit_into_memory_are_refused(tmp_path, name):
    order = Order(path=tmp_path / name, size=(4096, 4096), rate=10)
    assert len(order.times(1.8)) == 20
    with pytest.raises(Fault) as refused:
        order.times(1.9)
    assert refused.value.code == "RBL832"
    assert "21" in refused.value.message
    # as many of the usual size as there may be
    order = Order(path=tmp_path / name, rate=10)
    assert len(order.times((order.format.most - 2) / 10)) == order.format.most


def test_without_graphics_nothing_is_written_and_an_old_file_stays(tmp_path, monkeypatch):
    (tmp_path / "x.png").write_bytes(b"old")
    monkeypatch.setattr(graphics, "EGL_LIBRARY", "libNone.so")
    monkeypatch.setattr(graphics, "OSMESA_LIBRARIES", ("libNone.so",))
    with pytest.raises(Fault) as refused:
        render(log(), Order(path=tmp_path / "x.png"))
    assert refused.value.code == "RBL830"
    assert (tmp_path / "x.png").read_bytes() == b"old"


def test_a_run_that_fails_in_the_middle_of_a_film_leaves_the_old_file(tmp_path):
    need_graphics()
    recorded = log(numbers=np.array([0.1, 0.2]))
    path = tmp_path / "x.gif"
    path.write_bytes(b"old")
    whole = recorded.span

    def torn(name, first, last):
        values = whole(name, first, last).copy()
        if name == "q_link" and 250 < first < 300:  # between two of the samples by which the view is framed
            values[:] = np.nan
        return values

    recorded.span = torn
    with pytest.raises(Fault) as refused:
        render(recorded, Order(path=path, size=(32, 24), rate=60, view="iso"))
    assert refused.value.code == "RBL832"
    assert (os.listdir(tmp_path), path.read_bytes()) == (["x.gif"], b"old")


def test_points_of_a_scene_have_names_of_any_kind(tmp_path):
    need_graphics()
    points = [
        {"name": name, "X": np.eye(4).tolist()} for name in ("P1", "x" * 200, "\0é\u202e<b>", *map(str, range(500)))
    ]
    assert image(drawn(tmp_path, recorded=log(scene=SCENE | {"points": points}))).std() > 0.0


def test_the_order_of_a_picture_has_a_usual_size():
    assert Order(path=Path("x.png")).pixels == Order(path=Path("x.MP4")).pixels == (1280, 720)
    assert Order(path=Path("x.gif")).pixels == (640, 360)
