"""Whatever goes wrong with a model is one clear reason, within its time, with the way out."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from chatrobot.language.phrases import render_reason
from chatrobot.models.fake.server import FakeModel
from chatrobot.models.seam import CallLimits
from tests.models.rig import KEY, WIRES, Got, model_at, serving

TEXT = "drive 1 m\nturn left\ndrive 2 m\nturn left\n"
REPLIES: list[dict[str, Any]] = [
    {
        "match": "not valid",
        "error": {"status": 400, "message": "API key not valid. Please pass a valid API key."},
    },
    {"match": "overloaded", "error": {"status": 529, "message": "Overloaded"}},
    {"match": "limit", "error": {"status": 429}},
    {
        "match": "forbidden",
        "error": {"status": 403, "body": "<html><h1>Forbidden</h1>You shall not pass</html>"},
    },
    {"match": "unauthorised", "error": {"status": 401, "body": ""}},
    {"match": "rate", "error": {"status": 429, "retry_after_s": 20, "message": "slow down"}},
    {
        "match": "credit",
        "error": {"status": 429, "code": "insufficient_quota", "message": "insufficient_quota: pay"},
    },
    {"match": "500", "error": {"status": 500}},
    {"match": "503", "error": {"status": 503, "body": "<html>down for maintenance</html>"}},
    {"match": "rejected", "error": {"status": 400, "message": "no such field"}},
    {"match": "error page", "error": {"status": 502, "body": "x" * 10_000_000}},
    {"match": "cut off", "text": TEXT, "cut_off_after": 5},
    {"match": "empty", "text": ""},
    {"match": "blank", "text": "  \n "},
    {"match": "refuse", "refusal": "I will not."},
    {"match": "huge", "huge_mb": 10},
    {"match": "one line", "raw": "data: " + "x" * 10_000_000 + "\n\n"},
    {"match": "too long", "text": TEXT, "finish": "length"},
    {"match": "no json", "raw": "data: {oops\n\n", "text": ""},
    {"match": "no stream", "raw": '{"hello": 1}', "content_type": "application/json"},
    {"match": "login page", "raw": "<html>please log in</html>", "content_type": "text/html"},
    {"match": "other json", "raw": 'data: {"hello": [1, {"x": null}]}\n\ndata: 7\n\ndata: []\n\n'},
    {"match": "^tools", "tool_calls": [{"name": "rm_rf", "arguments": "{}"}]},
    {"match": "text and tools", "text": TEXT, "tool_calls": [{"name": "rm_rf", "arguments": "{}"}]},
    {"match": "late", "first_piece_s": 30, "text": TEXT},
    {"match": "stall", "text": TEXT, "hang_after": 3},
    {"match": "slow", "text": TEXT, "tokens_per_s": 4},
    {"match": "fine", "text": TEXT},
]
CODES = {
    "rate": "model_rate_limit",
    "credit": "model_no_credit",
    "500": "model_server_error",
    "503": "model_server_error",
    "rejected": "model_rejected",
    "not valid": "model_wrong_key",
    "overloaded": "model_server_error",
    "error page": "model_server_error",
    "cut off": "model_cut_off",
    "empty": "model_empty",
    "blank": "model_empty",
    "refuse": "model_refused",
    "huge": "model_too_long",
    "one line": "model_too_long",
    "too long": "model_too_long",
    "no json": "model_broken_reply",
    "no stream": "model_broken_reply",
    "login page": "model_broken_reply",
    "other json": "model_broken_reply",
    "tools": "model_called_tool",
}


@pytest.fixture(scope="module")
def fake() -> Iterator[FakeModel]:
    with serving(REPLIES, keys=[KEY]) as fake:
        yield fake


@pytest.fixture(scope="module")
def models(fake: FakeModel) -> dict[str, Any]:
    return {provider: model_at(provider, fake.url) for provider in WIRES}


def assert_told(got: Got) -> None:
    """In words that name the way out, in both languages, without a hole in them."""
    assert got.error is not None
    for language in ("en", "zh"):
        told = render_reason(got.error.reason, language)
        assert "{" not in told
        assert KEY not in told
        assert len(told) < 600
    assert got.error.__cause__ is None
    assert got.error.__context__ is None or got.error.__suppress_context__


@pytest.mark.parametrize("provider", WIRES)
@pytest.mark.parametrize("said", list(CODES))
def test_a_bad_answer_is_told_as_what_it_is(
    provider: str, said: str, models: dict[str, Any], fake: FakeModel
) -> None:
    calls = len(fake.calls)
    got = Got(models[provider], said)
    assert got.code == CODES[said]
    assert len(fake.calls) == calls + 1, "a failed call is not repeated behind our back"
    assert len(got.text) <= CallLimits().reply_chars
    assert_told(got)
    assert Got(models[provider], "fine").text == TEXT, "and the next call is as good as ever"


@pytest.mark.parametrize("provider", WIRES)
def test_what_came_before_the_end_is_valid(provider: str, models: dict[str, Any]) -> None:
    for said in ("cut off", "stall"):
        got = Got(models[provider], said, limits=CallLimits(total_s=0.5, first_piece_s=0.4))
        assert TEXT.startswith(got.text)
        assert len(got.pieces) >= 3
        assert got.usage is not None
        assert not got.usage.counted or got.usage.reply_tokens


def test_a_stream_that_ends_in_good_order_but_without_its_end_was_cut_off() -> None:
    chunk = '{"id": "x", "object": "chat.completion.chunk", "created": 1, "model": "fake", "choices": [%s]}'
    piece = (
        chunk % '{"index": 0, "delta": {"role": "assistant", "content": "drive 1 m"}, "finish_reason": null}'
    )
    with serving([{"match": "", "raw": f"data: {piece}\n\n"}]) as fake:
        got = Got(model_at("openai", fake.url), "go")
    assert (got.text, got.code) == ("drive 1 m", "model_cut_off")


def test_a_tool_call_beside_a_text_is_an_error_after_the_text(models: dict[str, Any]) -> None:
    got = Got(models["openai"], "text and tools")
    assert (got.text, got.code) == (TEXT, "model_called_tool")
    assert got.values["tool"] == "rm_rf"


def test_a_rate_limit_says_for_how_long(models: dict[str, Any]) -> None:
    for provider in WIRES:
        got = Got(models[provider], "rate")
        assert got.values["retry_after_s"] == 20
        assert got.error is not None
        assert "20" in render_reason(got.error.reason, "en")


def test_a_rate_limit_without_a_time_suggests_one(models: dict[str, Any]) -> None:
    got = Got(models["openai"], "limit")
    assert got.values["retry_after_s"] == 30
    assert_told(got)


def test_an_error_page_is_quoted_without_its_tags(models: dict[str, Any]) -> None:
    got = Got(models["openai"], "forbidden")
    assert (got.code, got.values["said"]) == ("model_wrong_key", "Forbidden You shall not pass")
    assert Got(models["openai"], "unauthorised").values["said"]


@pytest.mark.parametrize("provider", WIRES)
def test_a_model_that_hangs_is_given_up_in_time(provider: str, models: dict[str, Any]) -> None:
    late = Got(models[provider], "late", limits=CallLimits(first_piece_s=0.2, total_s=5))
    assert (late.code, late.values["limit_s"]) == ("model_first_piece_timeout", 0.2)
    assert late.took_s < 0.6
    stalled = Got(models[provider], "stall", limits=CallLimits(first_piece_s=5, total_s=0.3))
    assert (stalled.code, stalled.values["limit_s"]) == ("model_timeout", 0.3)
    assert stalled.took_s < 0.7
    assert_told(late)
    assert_told(stalled)


def test_a_model_that_dawdles_is_given_up_in_all(models: dict[str, Any]) -> None:
    got = Got(models["openai"], "slow", limits=CallLimits(total_s=0.6))
    assert got.code == "model_timeout"
    assert got.pieces


@pytest.mark.parametrize("provider", WIRES)
def test_a_wrong_key_is_told_without_the_key(provider: str, fake: FakeModel) -> None:
    got = Got(model_at(provider, fake.url, key="sk-wrong-9876543210"), "fine")
    assert got.code == "model_wrong_key"
    assert "9876543210" not in str(got.error)
    assert_told(got)


@pytest.mark.parametrize("provider", WIRES)
def test_no_key_is_told_before_anything_is_sent(provider: str, fake: FakeModel) -> None:
    calls = len(fake.calls)
    got = Got(model_at(provider, fake.url, key=""), "fine")
    assert got.code == "model_no_key"
    assert str(got.values["variable"]).endswith("_API_KEY")
    assert len(fake.calls) == calls
    assert_told(got)


@pytest.mark.parametrize("provider", WIRES)
def test_a_model_that_is_not_there_is_told(provider: str, fake: FakeModel) -> None:
    got = Got(model_at(provider, fake.url, name="gone"), "fine")
    assert (got.code, got.values["model"]) == ("model_not_found", "gone")
    assert_told(got)


@pytest.mark.parametrize("provider", WIRES)
def test_no_network_is_told_at_once(provider: str) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))  # bound and not listening: refused
        port = taken.getsockname()[1]
        got = Got(model_at(provider, f"http://127.0.0.1:{port}"), "fine")
    assert got.code == "model_no_network"
    assert got.values["host"] == f"127.0.0.1:{port}"
    assert got.took_s < 2
    assert_told(got)


@pytest.mark.parametrize("provider", WIRES)
def test_a_server_that_says_nothing_and_hangs_up_is_told(provider: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=_hang_up, args=(server,), daemon=True)
        thread.start()
        got = Got(model_at(provider, f"http://127.0.0.1:{server.getsockname()[1]}"), "fine")
    assert got.code == "model_cut_off"
    assert_told(got)


def _hang_up(server: socket.socket) -> None:
    connection, _ = server.accept()
    connection.recv(65536)
    connection.close()


def test_without_an_address_it_says_which_variable() -> None:
    from chatrobot.models.config import ModelConfig
    from chatrobot.models.make import make_model

    got = Got(make_model("openai-compatible:x", ModelConfig(environ={}, keyring=False)), "fine")
    assert (got.code, got.values["variable"]) == ("model_no_address", "OPENAI_BASE_URL")
    assert_told(got)


def test_without_the_extra_it_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch, fake: FakeModel
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "pydantic_ai.models.openai", None)
    got = Got(model_at("openai", fake.url), "fine")
    assert got.code == "model_missing_extra"
    assert "pip install" in str(got.values["command"])
    assert_told(got)


def test_a_redirect_is_not_followed_with_the_key_in_hand() -> None:
    with serving([{"match": "", "text": "stolen"}]) as thief:
        # The script has no redirect: a small server of one's own.
        with socket.create_server(("127.0.0.1", 0)) as server:
            answer = (
                f"HTTP/1.1 307 See\r\nLocation: {thief.url}/v1/chat/completions\r\nContent-Length: 0\r\n\r\n"
            )

            def redirect() -> None:
                connection, _ = server.accept()
                connection.recv(65536)
                connection.sendall(answer.encode())
                connection.close()

            threading.Thread(target=redirect, daemon=True).start()
            got = Got(model_at("openai", f"http://127.0.0.1:{server.getsockname()[1]}"), "fine")
        assert got.code == "model_broken_reply"
        assert not thief.calls
