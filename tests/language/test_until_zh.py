"""Until something is near, said in Chinese: as in English, a distance and something that a sensor sees."""

from __future__ import annotations

import pytest

from chatrobot.language.until import read_until


@pytest.mark.parametrize(
    ("said", "before", "distance_m"),
    [
        ("一直往前走,直到离障碍物50厘米", "一直往前走", 0.5),
        ("一直走到离墙半米", "一直走", 0.5),
        ("往前走,直到前方50厘米内有障碍物", "往前走", 0.5),
        ("前进,直到障碍物在半米以内", "前进", 0.5),
        ("慢慢往前开,到离桌子0.5米停下", "慢慢往前开", 0.5),
    ],
)
def test_a_condition_is_read_with_its_distance(said: str, before: str, distance_m: float) -> None:
    found = read_until(said, "zh")
    assert found is not None
    assert (found.before, found.distance_m) == (before, distance_m)


@pytest.mark.parametrize(
    "said", ["离墙还有50厘米吗", "前进50厘米到墙边", "如果离墙还有50厘米就停", "直到我说停", "到墙那里去"]
)
def test_what_only_speaks_of_a_distance_is_no_condition(said: str) -> None:
    assert read_until(said, "zh") is None
