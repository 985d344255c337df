"""The scripted server: what its script says is what a client gets, in each provider's form."""

from __future__ import annotations

import json
import time
import urllib.error
import urllib.request
from typing import Any

import pytest

from chatrobot.models.fake.script import Script, ScriptError, read_script
from chatrobot.models.fake.server import FakeModel
from tests.models.rig import serving

CHAT = {"model": "fake", "messages": [{"role": "user", "content": "go 7"}]}
BODIES: dict[str, dict[str, Any]] = {
    "/v1/chat/completions": CHAT,
    "/v1/responses": {"model": "fake", "input": "go 7"},
    "/v1/messages": {**CHAT, "max_tokens": 9},
    "/v1beta/models/fake:generateContent": {"contents": [{"role": "user", "parts": [{"text": "go 7"}]}]},
}


def fetch(url: str, body: dict[str, Any] | None = None, **headers: str) -> tuple[int, dict[str, Any]]:
    data = json.dumps(body).encode() if body is not None else None
    request = urllib.request.Request(url, data, {"Content-Type": "application/json", **headers})
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, json.load(answer)
    except urllib.error.HTTPError as error:
        return error.code, json.load(error)


@pytest.mark.parametrize("path", list(BODIES))
def test_a_reply_comes_whole_where_no_stream_is_asked_for(path: str) -> None:
    with serving([{"match": "go (\\d)", "text": "drive {1} m", "tool_calls": [{"name": "x"}]}]) as fake:
        status, body = fetch(fake.url + path, BODIES[path])
    assert status == 200
    assert "drive 7 m" in json.dumps(body)
    assert '"name": "x"' in json.dumps(body)


@pytest.mark.parametrize("path", list(BODIES))
def test_errors_come_in_the_providers_form(path: str) -> None:
    with serving([{"error": {"status": 429, "message": "slow down"}}]) as fake:
        status, body = fetch(fake.url + path, BODIES[path])
    assert (status, body["error"]["message"]) == (429, "slow down")


def test_it_lists_its_models_as_openai_and_ollama_do() -> None:
    with serving([], models=["a", "b"]) as fake:
        assert [row["id"] for row in fetch(f"{fake.url}/v1/models")[1]["data"]] == ["a", "b"]
        assert [row["name"] for row in fetch(f"{fake.url}/api/tags")[1]["models"]] == ["a", "b"]
        assert fetch(f"{fake.url}/api/version")[0] == 200
        assert fetch(f"{fake.url}/nowhere")[0] == 404
        assert fetch(f"{fake.url}/nowhere", {})[0] == 404


@pytest.mark.parametrize(
    "headers", [{}, {"Authorization": "Bearer no"}, {"x-api-key": "no"}, {"x-goog-api-key": "kéy"}]
)
def test_without_the_right_key_nothing_is_answered(headers: dict[str, str]) -> None:
    with serving([{"match": "", "text": "x"}], keys=["right"]) as fake:
        assert fetch(f"{fake.url}/v1/chat/completions", CHAT, **headers)[0] == 401
        assert fetch(f"{fake.url}/v1/chat/completions", CHAT, Authorization="Bearer right")[0] == 200
        assert fetch(f"{fake.url}/v1/chat/completions", CHAT, **{"x-api-key": "right"})[0] == 200
        assert len(fake.calls) == 2


def test_answers_are_served_in_order_and_matches_as_often_as_they_fit() -> None:
    script = read_script(
        [
            {"match": "^stop", "text": "m"},
            "first",
            {"text": "second", "times": 2},
            {"match": "late", "text": "l", "times": 1},
        ]
    )
    said = ["a", "stop", "late", "b", "stop it", "c late", "d"]
    assert [script.answer(text).text for text in said] == ["first", "m", "second", "second", "m", "l", ""]
    assert script.answer("e").error is not None


def test_tokens_are_paced_and_joined_they_are_the_text() -> None:
    answer = read_script(["drive 1 m\n  turn left 90 deg\n\n向前走一米 \n"]).answers[0]
    assert "".join(answer.tokens("")) == answer.text
    assert max(len(token.strip()) for token in answer.tokens("")) <= 4


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("text", "replies"),
        ({"answers": []}, "answers"),
        ({"replies": "x"}, "no list"),
        ([{"txt": "x"}], "reply 1"),
        (["fine", {"match": "("}], "reply 2"),
        ([{"error": {"state": 4}}], "state"),
        ([{"error": 500}], "error"),
        ([{"tokens_per_s": "fast"}], "fast"),
        ([[1]], "mapping"),
        ([{"tool_calls": [{"nom": "x"}]}], "nom"),
        ([{"error": {"status": "nope"}}], "nope"),
        ([{"error": {"status": 42}}], "100 to 599"),
        ([{"times": -1}], "times"),
        ([{"hang_after": "abc"}], "hang_after"),
        ({"tokens_per_s": -3, "replies": ["x"]}, "tokens_per_s"),
        ({"model": [1]}, "model"),
        ({"keys": "abc"}, "keys"),
    ],
)
def test_a_wrong_script_says_where_it_is_wrong(script: Any, said: str) -> None:
    with pytest.raises(ScriptError, match=said):
        read_script(script)


def test_it_ends_at_once_with_calls_under_way() -> None:
    script = Script((read_script([{"match": "", "first_piece_s": 60}]).answers[0],))
    with FakeModel(script) as fake:
        import threading

        thread = threading.Thread(target=lambda: _ignore_errors(fake.url), daemon=True)
        thread.start()
        while not fake.calls:
            time.sleep(0.005)
        began_s = time.monotonic()
    thread.join(5)
    assert not thread.is_alive()
    assert time.monotonic() - began_s < 2


def _ignore_errors(url: str) -> None:
    import contextlib
    import http.client

    with contextlib.suppress(OSError, http.client.HTTPException):
        fetch(f"{url}/v1/chat/completions", CHAT)
