"""Named places on disk."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.core.errors import InputError
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.places import Places


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
def test_a_broken_file_is_named_with_the_way_out(tmp_path: Path, text: str) -> None:
    (tmp_path / "places.json").write_text(text)
    with pytest.raises(InputError, match=r"places\.json.*remove the file"):
        Places(tmp_path, "robot", "e")


def test_without_a_folder_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Places(None, "robot", "e").add("dock", Pose())
    assert list(tmp_path.iterdir()) == []
