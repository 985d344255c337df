"""The highest speed that a person sets binds a model's plan and one that is typed, as it is driven."""

from __future__ import annotations

import math

from tests.dialogue.scripted_model import ModelTalk

from chatrobot.core.events import TruePose


def _top_speed_mps(talk: ModelTalk) -> float:
    return max(math.hypot(e.vx_mps, e.vy_mps) for e in talk.events if isinstance(e, TruePose))


def test_a_model_keeps_to_it() -> None:
    talk = ModelTalk("drive 0.5 m at 0.6 m/s\n")
    talk.do("never go faster than 0.2 m/s")
    assert talk.do("please do something nice").outcome == "completed"
    assert 0.15 < _top_speed_mps(talk) < 0.22


def test_an_order_beyond_it_is_refused_and_asks_no_model() -> None:
    talk = ModelTalk("drive 0.5 m\n")
    talk.do("never go faster than 0.2 m/s")
    assert talk.do("forward 1 m at 0.5 m/s").outcome == "refused"
    assert talk.model.asked == []
    assert talk.do("yes").outcome == "completed"
    assert 0.15 < _top_speed_mps(talk) < 0.22


def test_a_plan_that_waits_for_a_go_is_told_and_driven_within_it() -> None:
    talk = ModelTalk("drive 0.5 m\n")
    talk.do("max speed 0.2")
    assert "0.2 m/s" in talk.do("when I say go, drive 1 m").reply
    reply = talk.do("at 0.5 m/s").reply
    assert "0.2 m/s" in reply
    assert "0.5" not in reply
    assert talk.do("go").outcome == "completed"
    assert 0.15 < _top_speed_mps(talk) < 0.22
