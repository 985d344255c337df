"""What denies, bounds or leaves out part of an order, or tells what nobody knows, is asked about and moves nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    "said",
    [
        "come here",
        "get out",
        "from now on when I say left I mean slide left",
        "forward 1 m and slide left 1 m, without the slide",
        "forward 1 m then left, actually skip the left",
        "go 50 cm towards A",
        "过来",
        "出去",
        "go 1 m forward in four equal steps with 1 second pause",
        "左移一米不是左转",
        "左转四十五不是九十",
        "左转你就左转",
        "每两秒左转三十度转三次",
        "到头左转",
        "可以走直线吗",
        "这里叫啥",
        "yes, but only 60 cm",
        "go the rest of the way",
    ],
)
def test_what_it_cannot_know_or_leave_out_moves_nothing(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    ("said", "outcome"),
    [
        (
            "five metres up, do a one-eighty, and roll the same five metres down to where you started",
            "unclear",
        ),
        ("zurück nach A", "unclear"),
        ("could you please pirouettify us five metres, slowly at 0.2 m/s?", "unclear"),
    ],
)
def test_what_is_not_accounted_for_is_asked_about(said: str, outcome: str) -> None:
    assert Conversation().say(said).outcome == outcome
