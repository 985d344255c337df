"""What is announced to be repeated is all that follows."""

from __future__ import annotations

import pytest

from chatrobot.plan.steps import Drive, Turn
from tests.language.dialogue_runner import Conversation, conversation


@pytest.mark.parametrize(
    ("said", "times"),
    [
        ("do this three times drive one meter turn left ninety", 3),
        ("do the following twice drive one meter turn left ninety", 2),
        ("do the following 3 times: drive one meter, turn left ninety", 3),
        ("repeat 3 times drive one meter turn left ninety", 3),
        ("please repeat this twice forward 50 cm right 90", 2),
        ("do these steps twice back 50 cm right 90", 2),
        ("重复三次前进一米左转90度", 3),
        ("重复三次，前进一米，左转90度", 3),
        ("做三遍前进一米右转90度", 3),
        ("以下动作重复三次 前进一米 左转90度", 3),
        ("重复两遍后退半米右转九十度", 2),
        ("循环三次前进一米左转90度", 3),
    ],
)
def test_all_that_follows_an_announced_count_is_repeated(said: str, times: int) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert [type(step) for step in plan.steps] == [Drive, Turn] * times


@pytest.mark.parametrize("turns", [("forward 1 m", "do this three times"), ("前进一米", "重复三次")])
def test_a_count_with_nothing_after_it_repeats_what_was_done_before(turns: tuple[str, str]) -> None:
    plan = conversation(turns[0]).say(turns[1]).plan
    assert plan is not None
    assert [type(step) for step in plan.steps] == [Drive] * 3
