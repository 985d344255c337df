"""What needs no motion is told as that; a person who says goodbye leaves."""

from __future__ import annotations

import pytest
from tests.dialogue.scripted_model import ModelTalk, Options

from chatrobot.dialogue.replies import is_parting


@pytest.mark.parametrize(
    ("text", "again", "reply"),
    [
        ("go to the kitchen", "go to the kitchen", "I am at “kitchen” already."),
        ("go to the kitchen", "去厨房", "我已经在“厨房”了。"),
        ("forward 0.5 m", "forward 0.2 m, then come back here", None),
    ],
)
def test_a_place_where_it_stands_already_is_told_as_that(text: str, again: str, reply: str | None) -> None:
    talk = ModelTalk(world="home", model=None)
    assert talk.do(text).reply.startswith("Done: drove")
    result = talk.do(again)
    assert result.outcome == "completed"
    if reply is not None:
        assert result.reply == reply
        assert result.path_m == pytest.approx(0.0, abs=0.005)
    else:
        assert result.reply.startswith("Done: drove")


def test_the_start_is_there_already_and_has_no_name() -> None:
    talk = ModelTalk(world="empty", model=None)
    assert talk.do("go to 0 0").reply == "I am there already."


def test_a_wait_moves_nothing_and_is_done() -> None:
    assert ModelTalk(world="empty", model=None).do("wait 1 second").reply == "Done."


@pytest.mark.parametrize("text", ["bye", "Goodbye!", "see you later", "再见", "拜拜"])
@pytest.mark.parametrize("interpreter", ["auto", "model"])
def test_a_goodbye_is_told_to_the_faces_and_to_no_model(text: str, interpreter: str) -> None:
    talk = ModelTalk('say "stay"', options=Options(interpreter=interpreter))  # type: ignore[arg-type]
    result = talk.do(text)
    assert (result.outcome, is_parting(result)) == ("answered", True)
    assert not talk.model.asked


@pytest.mark.parametrize(
    "text", ["hello", "thanks", "say bye", "forward 0.1 m, bye", "bye, then turn left 90 degrees"]
)
def test_what_is_more_than_a_goodbye_leaves_nobody(text: str) -> None:
    talk = ModelTalk(model=None)
    assert not is_parting(talk.do(text))
