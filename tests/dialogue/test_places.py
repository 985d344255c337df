"""Named places on disk."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.dialogue.talk import Talk

import chatrobot
from chatrobot.core.events import Notice
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.places import Places
from chatrobot.language.phrases import render_reason


def test_a_place_comes_back_and_knows_whether_its_coordinates_still_mean_anything(tmp_path: Path) -> None:
    Places(tmp_path, "robot", "monday").add("dock", Pose(1.0, 2.0, 0.5))
    same = Places(tmp_path, "robot", "monday").all()["dock"]
    later = Places(tmp_path, "robot", "tuesday").all()["dock"]
    assert (same.pose, same.usable, later.usable) == (Pose(1.0, 2.0, 0.5), True, False)


EARLIER = {
    "go to depot": "“depot” was remembered in an earlier session, and I cannot know whether odometry has started anew",
    "where is depot?": "“depot” was remembered in an earlier session",
    "fahr zum depot": "„depot“ wurde in einer früheren Sitzung gemerkt",
    "wo ist depot?": "„depot“ wurde in einer früheren Sitzung gemerkt",
    "去depot": "“depot”是在以前的会话里记住的",
    "depot在哪里？": "“depot”是在以前的会话里记住的",
}


@pytest.fixture
def later(tmp_path: Path) -> Talk:
    """A session after the one that remembered a place, as on a real robot."""
    earlier = Talk(folder=tmp_path)
    assert earlier.do("remember this place as depot").outcome == "answered"
    assert earlier.do("forward 50 cm, then go to depot").outcome == "completed"
    file = tmp_path / "places.json"
    file.write_text(file.read_text().replace("simulated ", "a real robot, not "))
    return Talk(folder=tmp_path)


@pytest.mark.parametrize("said", EARLIER)
def test_a_place_of_an_earlier_session_is_told_as_such_and_not_driven_to(later: Talk, said: str) -> None:
    told = later.do(said)
    assert EARLIER[said] in told.reply
    assert told.path_m == 0.0
    way_out = re.search(
        "[“„](remember this place as depot|merk dir .* depot|记住这里叫depot)[”“]", told.reply
    )
    assert way_out is not None
    assert later.do(way_out[1]).outcome == "answered"
    assert later.do("forward 50 cm, then go to depot").outcome == "completed"


@pytest.mark.parametrize(
    ("said", "known", "earlier"),
    [
        ("which places do you know?", "Places I know: none yet.", "in an earlier session"),
        ("where is the shed?", "I know no place called “shed”. Places I know: none yet.", "in an earlier session"),
        ("welche Orte kennst du?", "Orte, die ich kenne: noch keinen.", "In einer früheren Sitzung gemerkt"),
        ("你知道哪些地方？", "我知道的地方：还没有。", "以前的会话里记住的"),
    ],
)  # fmt: skip
def test_places_of_an_earlier_session_are_told_apart(
    later: Talk, said: str, known: str, earlier: str
) -> None:
    reply = later.do(said).reply
    assert reply.startswith(known)
    assert earlier in reply.removeprefix(known)
    assert "depot" in reply.removeprefix(known)


@pytest.mark.parametrize(("world", "outcome"), [("empty", "completed"), ("home", "unclear")])
def test_a_place_of_a_simulated_world_holds_in_later_sessions_of_that_world_alone(
    tmp_path: Path, world: str, outcome: str
) -> None:
    with chatrobot.connect(fast=True, world="empty", config_dir=tmp_path) as robot:
        robot.do("forward 50 cm, then turn left")
        robot.do("remember this place as depot")
    with chatrobot.connect(fast=True, world=world, config_dir=tmp_path) as robot:
        assert robot.do("go to depot").outcome == outcome
        pose = robot.pose
    assert pose is not None
    assert pose.distance_to(Pose(0.5 if outcome == "completed" else 0.0)) < 0.02


def test_robots_do_not_share_places(tmp_path: Path) -> None:
    Places(tmp_path, "one", "e").add("dock", Pose())
    Places(tmp_path, "two", "e").add("door", Pose())
    assert set(Places(tmp_path, "one", "e").all()) == {"dock"}


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"robot": {"dock": {}}}', '{"robot": 1}', '{"robot": {"dock": 7}}']
)
def test_a_broken_file_keeps_nobody_from_driving_is_named_and_stays_as_it_is(
    tmp_path: Path, text: str
) -> None:
    file = tmp_path / "places.json"
    file.write_text(text)
    places = Places(tmp_path, "robot", "e")
    for _ in range(2):
        unkept = places.take_unkept()
        assert unkept is not None
        assert "places.json holds cannot be read" in render_reason(unkept, "en")
        places.add("dock", Pose())
    assert (set(places.all()), file.read_text()) == ({"dock"}, text)


def test_a_file_that_breaks_meanwhile_keeps_no_place_and_ends_no_conversation(tmp_path: Path) -> None:
    talk = Talk(folder=tmp_path)
    (tmp_path / "places.json").write_text("{broken")
    assert talk.do("remember this place as dock").outcome == "answered"
    assert [e.reason.code for e in talk.events if isinstance(e, Notice)] == ["places_unreadable"]
    assert talk.do("forward 0.2 m, then go to the dock").outcome == "completed"
    assert (tmp_path / "places.json").read_text() == "{broken"


@pytest.mark.parametrize(
    "text",
    ["remember this place as dock", "rename the dock to bay", "forget the dock", "call this place bay"],
)
def test_a_rehearsal_keeps_no_place_and_takes_none_away(tmp_path: Path, text: str) -> None:
    Talk(folder=tmp_path).do("remember this place as dock")
    before = (tmp_path / "places.json").read_text()
    talk = Talk(folder=tmp_path, options=Options(rehearse_only=True))
    assert talk.do(text).reply == "That would work. Nothing has moved."
    assert (tmp_path / "places.json").read_text() == before


def test_without_a_folder_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Places(None, "robot", "e").add("dock", Pose())
    assert list(tmp_path.iterdir()) == []
