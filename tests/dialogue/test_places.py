"""Named places on disk."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.dialogue.talk import Talk

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
