"""The files of a template with its table at another place: every number moves with it, and comments stay."""

import tomllib

import pytest

from robolang.templates.placement import Placement
from robolang.templates.template import NAMES, template

PLACED = Placement(
    from_mm=(480.0, 0.0, 600.0), to_mm=(700.0, 0.0, 400.0), heading_deg=90, yaw_deg=180, home=(1.5, -0.25)
)


def moved(kind):
    texts = template(kind).texts
    return texts, PLACED.files(texts, "arms/mine.toml", "mine")


@pytest.mark.parametrize(
    ("pose", "found"),
    [
        ([480, 0, 600, 0, 0, 0], [0, 700, 400, 0, 0, 90]),
        ([500, 10, 625.5, 180, 0, 180], [-10, 720, 425.5, 180, 0, -90]),
    ],
)
def test_a_pose_moves_with_the_table_and_turns_about_the_base(pose, found):
    assert PLACED.pose(pose) == found
    assert [type(value) for value in PLACED.pose(pose)] == [type(value) for value in found]


@pytest.mark.parametrize("kind", NAMES)
def test_a_cell_has_its_robot_its_home_and_all_things_where_they_are_now(kind):
    texts, files = moved(kind)
    old, new = (tomllib.loads(each[".cell.toml"]) for each in (texts, files))
    assert (new["robot"], new["home"]["joints_deg"]) == ("arms/mine.toml", [1.5, -0.25])
    things = [(*cell.get("parts", []), *cell["obstacles"], *cell["frames"].values()) for cell in (old, new)]
    assert [PLACED.pose(each["pose_mm_deg"]) for each in things[0]] == [each["pose_mm_deg"] for each in things[1]]
    assert [old[key] for key in ("hand", "loads", "tools")] == [new[key] for key in ("hand", "loads", "tools")]
    comments = [[line for line in each[".cell.toml"].splitlines() if line.startswith("#")] for each in (texts, files)]
    assert comments[0] == comments[1]
    assert comments[0]


@pytest.mark.parametrize("kind", NAMES)
def test_points_stay_in_their_frames_and_turn_with_the_tool(kind):
    texts, files = moved(kind)
    old, new = (tomllib.loads(each[".points.toml"]) for each in (texts, files))
    assert new["robot"] == "mine"
    for name, point in old["points"].items():
        assert [*point["pose"][:5], 0] == new["points"][name]["pose"]
        assert point["pose"][5] == 180


@pytest.mark.parametrize("kind", NAMES)
def test_a_test_expects_the_parts_where_they_are_put_now(kind):
    texts, files = moved(kind)
    old, new = (tomllib.loads(each[".test.toml"])["expect"] for each in (texts, files))
    assert new["printed"] == old["printed"]
    for name, place in old.get("parts", {}).items():
        assert new["parts"][name] == (place if name == "part_mm" else PLACED.position(place))
    assert texts[".rbl"] == files[".rbl"]
