"""A reply streams, can be cancelled from anywhere, and costs little of our own."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import pytest

from chatrobot.models.make import make_model, warm
from chatrobot.models.seam import CallLimits, Message
from tests.models.rig import WIRES, Got, config_for, model_at, serving

TEXT = "drive 1 m\n" * 40


def until(true: Callable[[], bool], within_s: float = 5.0) -> bool:
    ends_s = time.monotonic() + within_s
    while not true():
        if time.monotonic() > ends_s:
            return False
        time.sleep(0.001)
    return True


@pytest.mark.realtime
@pytest.mark.parametrize("provider", WIRES)
def test_a_cancelled_reply_ends_at_once_and_hangs_up(provider: str) -> None:
    with serving([{"match": "", "text": TEXT, "tokens_per_s": 50}]) as fake:
        model = model_at(provider, fake.url)
        Got(model, "warm up", limits=CallLimits(total_s=0.3))
        reply = model.ask([Message("user", "go")], CallLimits())
        pieces = iter(reply)
        assert next(pieces)
        threading.Timer(0.05, reply.cancel).start()
        rest = list(pieces)
        assert len(rest) < 10, "the rest of 79 pieces is not waited for"
        call = fake.calls[-1]
        assert until(lambda: call.gone_s is not None), "the provider is told, and bills no more"
        assert reply.usage is not None
        assert not reply.usage.counted


@pytest.mark.realtime
def test_a_hanging_call_can_be_cancelled_before_its_first_piece() -> None:
    with serving([{"match": "", "first_piece_s": 30}]) as fake:
        model = model_at("openai", fake.url)
        reply = model.ask([Message("user", "go")], CallLimits())
        until(lambda: len(fake.calls) == 1)
        threading.Timer(0.05, reply.cancel).start()
        began_s = time.monotonic()
        assert list(reply) == []
        assert time.monotonic() - began_s < 15, "its first piece comes after 30 s"
        reply.cancel()
        assert until(lambda: fake.calls[0].gone_s is not None)


def test_cancelling_before_iterating_gives_nothing() -> None:
    with serving([{"match": "", "text": TEXT}]) as fake:
        reply = model_at("openai", fake.url).ask([Message("user", "go")], CallLimits())
        reply.cancel()
        assert list(reply) == []


def test_leaving_the_loop_hangs_up() -> None:
    with serving([{"match": "", "text": TEXT, "tokens_per_s": 50}]) as fake:
        reply = model_at("openai", fake.url).ask([Message("user", "go")], CallLimits())
        for _ in reply:
            break
        assert until(lambda: fake.calls[-1].gone_s is not None)


def test_calls_go_on_side_by_side() -> None:
    with serving([{"match": "hang", "first_piece_s": 30}, {"match": "", "text": "fine"}]) as fake:
        model = model_at("openai", fake.url)
        hanging = model.ask([Message("user", "hang")], CallLimits())
        assert Got(model, "go").text == "fine"
        hanging.cancel()


@pytest.mark.realtime
def test_pieces_are_handed_on_as_they_come() -> None:
    with serving([{"match": "", "text": "one two three four five\n" * 4, "tokens_per_s": 20}]) as fake:
        model = model_at("openai", fake.url)
        Got(model, "warm up")
        got_s = []
        for _ in model.ask([Message("user", "go")], CallLimits()):
            got_s.append(time.monotonic())
        sent_s = fake.calls[-1].sent_s
        assert len(got_s) == len(sent_s)
        before_the_next = [got < following for got, following in zip(got_s, sent_s[1:])]
        assert sum(before_the_next) > len(before_the_next) / 2, "a busy machine may hold some of them up"


@pytest.mark.realtime
def test_asking_and_making_return_at_once() -> None:
    with serving([{"match": "", "first_piece_s": 30}]) as fake:
        began_s = time.monotonic()
        model = make_model("openai:fake", config_for("openai", fake.url))
        warm(model)
        reply = model.ask([Message("user", "go")], CallLimits())
        assert time.monotonic() - began_s < 15, "its first piece comes after 30 s"
        reply.cancel()


def test_a_reply_is_cut_at_the_characters_allowed() -> None:
    with serving([{"match": "", "text": TEXT}]) as fake:
        got = Got(model_at("openai", fake.url), "go", limits=CallLimits(reply_chars=25))
    assert (got.text, got.code, got.values["limit_chars"]) == (TEXT[:25], "model_too_long", 25)


def test_usage_is_estimated_and_says_so_where_nobody_counts() -> None:
    with serving([{"match": "", "text": "x" * 40, "uncounted": True}]) as fake:
        got = Got(model_at("openai", fake.url), "y" * 80)
    assert got.usage is not None
    assert (got.usage.prompt_tokens, got.usage.reply_tokens, got.usage.counted) == (20, 10, False)
