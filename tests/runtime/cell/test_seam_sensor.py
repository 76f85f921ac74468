"""Simulated seam sensors: kinds, frames, noise, loss, and what a cell file may not say."""

import numpy as np
import pytest

from runtime.cell.seam_sensor import SeamSensor, SensorSpec
from runtime.cell.sensor_file import read_sensor_file
from runtime.core.tomlfile import FileFault, Source, load_table
from runtime.core.units import DEG, MM

RAMP = 'kind = "ramp"\ndeviation_mm_deg = [0, 5, -3, 0, 0, 2]\nover_mm = 100\n'
X = np.array([1.0, 0.0, 0.0])


def sensor(text, folder=None):
    return SeamSensor(SensorSpec.of(read_sensor_file(load_table(Source("cell.toml", text)), folder)))


def test_a_ramp_rises_over_its_way_and_stays():
    found = sensor(RAMP)
    for way, share in ((0.0, 0.0), (0.05, 0.5), (0.1, 1.0), (5.0, 1.0)):
        np.testing.assert_allclose(found.read(way, X), share * np.array([0, 5 * MM, -3 * MM, 0, 0, 2 * DEG]))


def test_a_sine_has_its_wavelength():
    found = sensor('kind = "sine"\ndeviation_mm_deg = [0, 0, 4, 0, 0, 0]\nover_mm = 100\n')
    assert found.read(0.025, X)[2] == pytest.approx(4 * MM)
    assert found.read(0.05, X)[2] == pytest.approx(0.0, abs=1e-12)
    assert found.read(0.075, X)[2] == pytest.approx(-4 * MM)


def test_a_table_is_straight_between_its_rows_and_flat_outside(tmp_path):
    (tmp_path / "seam.csv").write_text("way_mm,x,y,z\n0,0,0,0\n100,0,2,0\n\n200,0,2,-4\n")
    found = sensor('kind = "table"\nfile = "seam.csv"\n', tmp_path)
    np.testing.assert_allclose(found.read(0.05, X)[:3], [0, 1 * MM, 0])
    np.testing.assert_allclose(found.read(0.15, X)[:3], [0, 2 * MM, -2 * MM])
    np.testing.assert_allclose(found.read(0.9, X)[:3], [0, 2 * MM, -4 * MM])
    (tmp_path / "turn.csv").write_text("0,0,0,0,0,0,1\n10,0,0,0,0,0,3\n")
    assert sensor('kind = "table"\nfile = "turn.csv"\n', tmp_path).read(0.005, X)[5] == pytest.approx(2 * DEG)


def test_the_line_frame_turns_with_the_travel():
    found = sensor('kind = "ramp"\ndeviation_mm_deg = [0, 5, 0, 0, 0, 2]\nover_mm = 1\nframe = "line"\n')
    np.testing.assert_allclose(found.read(1.0, X), [0, 5 * MM, 0, 0, 0, 2 * DEG], atol=1e-12)
    np.testing.assert_allclose(found.read(1.0, np.array([0.0, 2.0, 0.0])), [-5 * MM, 0, 0, 0, 0, 2 * DEG], atol=1e-12)


def test_noise_and_loss_have_their_size_and_repeat():
    text = RAMP + "noise_mm_deg = [0.1, 0, 0, 0, 0, 0]\nlost = 0.2\nseed = 7\n"
    first, again = ([found.read(0.0, X) for _ in range(4000)] for found in (sensor(text), sensor(text)))
    assert [each is None for each in first] == [each is None for each in again]
    kept = np.array([each for each in first if each is not None])
    np.testing.assert_array_equal(kept, [each for each in again if each is not None])
    assert len(kept) / 4000 == pytest.approx(0.8, abs=0.03)
    assert kept[:, 0].std() == pytest.approx(0.1 * MM, rel=0.05)
    assert not kept[:, 1:].any()


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('kind = "wave"\n', "RBL610"),
        (RAMP.replace("over_mm = 100", "over_mm = 0"), "RBL605"),
        (RAMP.replace("-3", "nan"), "RBL604"),
        (RAMP.replace("over_mm = 100\n", ""), "RBL608"),
        (RAMP + "lost = 1.5\n", "RBL605"),
        (RAMP + "lots = 0.5\n", "RBL609"),
        (RAMP + 'frame = "tool"\n', "RBL610"),
        ('kind = "table"\n', "RBL608"),
        ('kind = "table"\nfile = "../seam.csv"\n', "RBL602"),
        ('kind = "table"\nfile = "/etc/passwd"\n', "RBL602"),
        ('kind = "table"\nfile = "none.csv"\n', "RBL600"),
        ('kind = "table"\nfile = "bad.csv"\n', "RBL604"),
        ('kind = "table"\nfile = "nan.csv"\n', "RBL604"),
        ('kind = "table"\nfile = "back.csv"\n', "RBL605"),
        ('kind = "table"\nfile = "empty.csv"\n', "RBL605"),
        ('kind = "table"\nfile = "link.csv"\n', "RBL602"),
    ],
)
def test_what_a_cell_may_not_say(tmp_path, text, code):
    folder = tmp_path / "cell"
    folder.mkdir()
    for name, content in (
        ("bad", "0,0,0,0\n1,2,3\n"),
        ("nan", "0,0,0,0\n1,nan,0,0\n"),
        ("back", "5,0,0,0\n1,0,0,0\n"),
        ("empty", ""),
    ):
        (folder / f"{name}.csv").write_text(content)
    (tmp_path / "seam.csv").write_text("0,0,0,0\n")
    (folder / "link.csv").symlink_to(tmp_path / "seam.csv")
    with pytest.raises(FileFault) as caught:
        sensor(text, folder)
    assert caught.value.code == code
    assert caught.value.line >= 1


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ("0,0,0,0\n" + "1" * 140_000 + ",0,0,0\n", "RBL604"),
        ('0,0,0,0\n"1,0,0,0\n', "RBL604"),
        ("0,nan,0,0\n1,0,0,0\n", "RBL604"),
        ("0,0,0\n1,0,0,0\n", "RBL604"),
    ],
)
def test_a_damaged_table_is_located_and_no_first_line_is_dropped_unseen(tmp_path, content, code):
    (tmp_path / "seam.csv").write_text(content)
    with pytest.raises(FileFault) as caught:
        sensor('kind = "table"\nfile = "seam.csv"\n', tmp_path)
    assert caught.value.code == code


def test_a_name_with_a_null_and_a_link_to_itself_are_refused(tmp_path):
    (tmp_path / "ring.csv").symlink_to(tmp_path / "ring.csv")
    for text in ('kind = "table"\nfile = "a\\u0000b.csv"\n', 'kind = "table"\nfile = "ring.csv"\n'):
        with pytest.raises(FileFault, match=r"RBL60[02]"):
            sensor(text, tmp_path)


def test_a_move_that_only_turns_keeps_the_line_frame_of_the_one_before():
    found = sensor('kind = "ramp"\ndeviation_mm_deg = [0, 5, 0, 0, 0, 0]\nover_mm = 1\nframe = "line"\n')
    np.testing.assert_allclose(found.read(1.0, np.zeros(3)), [0, 5 * MM, 0, 0, 0, 0], atol=1e-12)
    found.read(1.0, np.array([0.0, 1.0, 0.0]))
    np.testing.assert_allclose(found.read(1.0, np.zeros(3)), [-5 * MM, 0, 0, 0, 0, 0], atol=1e-12)
