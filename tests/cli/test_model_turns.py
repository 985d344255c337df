"""A language model behind the command line: over real HTTP, as a person and as a program use it."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest

from chatrobot.models.fake.script import read_script
from chatrobot.models.fake.server import FakeModel
from tests.cli.running import Command
from tests.models.rig import KEY, serving

FORM = "linear.x = {},linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = {}"
CONNECT = (
    "Your output is connected to a robot from now on. Such as: when I say “onward”, you answer: "
    "“linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0”."
)
REPLIES = [
    {"match": "nice", "text": "drive 0.3 m\nturn left 90 deg\n"},
    {"match": "chair", "text": "look scan pose", "times": 1},
    {"match": "free way", "text": 'say "It is free ahead."'},
    {"match": "^forward$", "text": FORM.format(0.2, 0)},
    {"match": "^left$", "text": FORM.format(0, 0.5)},
    {"match": "onward", "text": "I see. I shall answer in that form."},
]


@pytest.fixture(scope="module")
def fake() -> Iterator[FakeModel]:
    with serving(REPLIES) as served:
        yield served


@pytest.fixture
def asking(fake: FakeModel, chatrobot: Command, monkeypatch: pytest.MonkeyPatch) -> Command:
    fake.script = read_script({"models": ["fake"], "replies": REPLIES})
    fake.calls.clear()
    monkeypatch.setenv("OPENAI_BASE_URL", f"{fake.url}/v1")
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    monkeypatch.setenv("PYTHON_KEYRING_BACKEND", "keyring.backends.fail.Keyring")
    return chatrobot


def test_one_instruction_that_only_a_model_understands(asking: Command, fake: FakeModel) -> None:
    done = asking(
        "do", "do something nice", "forward 0.2 m", "tell me about the chair here", "--model", "openai:fake",
        "--fast", "--json", "--world", "empty",
    )  # fmt: skip
    assert done.code == 0
    interpreted = [(event["turn"], event["by"], event["plan_text"]) for event in done.named("interpreted")]
    assert interpreted == [
        (1, "model", "drive 0.3 m\nturn left 90 deg"),
        (2, "offline", "drive 0.2 m"),
        (3, "model", ""),
        (3, "model", 'say "It is free ahead."'),
    ]
    results = done.named("result")
    assert [result["outcome"] for result in results] == ["completed", "completed", "answered"]
    assert results[2]["reply"] == "It is free ahead."
    assert [event["round"] for event in done.named("model_called")] == [1, 1, 2]
    assert [notice["reason"]["code"] for notice in done.named("notice")] == [
        "asks_model",
        "asks_model",
        "model_looks",
    ]
    assert KEY not in done.out + done.err
    system = fake.calls[0].body["messages"][0]
    assert system["role"] == "system"
    assert all(call.body["messages"][0] == system for call in fake.calls)


def test_the_tutorials_instructions_through_a_server_held_conversation(
    asking: Command, fake: FakeModel
) -> None:
    done = asking(
        "do", CONNECT, "forward", "left", "--model", "openai:fake", "--fast", "--json", "--world", "empty",
        "--ros-args", "-p", "revChatGPT:=True",
    )  # fmt: skip
    assert "openai-responses:fake" in done.err
    results = done.named("result")
    assert [result["outcome"] for result in results] == ["answered", "completed", "completed"]
    assert results[0]["reply"] == "I see. I shall answer in that form."
    assert results[0]["path_m"] == 0.0
    assert results[1]["pose"]["x_m"] == pytest.approx(0.2, abs=0.02)
    assert results[2]["turned_rad"] == pytest.approx(0.5, abs=0.03)
    assert [call.path.endswith("/responses") for call in fake.calls] == [True] * 3
    heard = [json.dumps(call.body["input"], ensure_ascii=False) for call in fake.calls]
    assert "onward" in heard[0]
    assert not any("onward" in later for later in heard[1:])
    assert "previous_response_id" in fake.calls[2].body
