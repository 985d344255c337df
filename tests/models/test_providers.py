"""Every provider behind one seam: the same question gets the same answer, counted, in one call."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from chatrobot.models import providers as table
from chatrobot.models.config import ModelConfig
from chatrobot.models.fake.server import FakeModel
from chatrobot.models.make import make_model
from chatrobot.models.providers import Provider, ollama_address, providers, register, split_name
from chatrobot.models.seam import CallLimits, Message, Model, ModelError
from tests.models.rig import ALL, KEY, WIRES, Got, model_at, serving

PLAN = "drive 1 m\nturn left 90 deg\n向前走\n"


@pytest.fixture(scope="module")
def fake() -> Iterator[FakeModel]:
    with serving(
        [{"match": "go (\\d+)", "text": "drive {1} m"}, {"match": "", "text": PLAN}], keys=[KEY]
    ) as fake:
        yield fake


@pytest.mark.parametrize("provider", ALL)
def test_every_provider_gives_the_text_to_the_letter_and_counts_it(provider: str, fake: FakeModel) -> None:
    before = len(fake.calls)
    got = Got(model_at(provider, fake.url), "hello", "hi", "draw a square", system="You drive a robot.")
    assert (got.text, got.code) == (PLAN, "")
    assert got.usage is not None
    assert got.usage.counted
    assert got.usage.reply_tokens > 3
    (call,) = fake.calls[before:]
    assert call.asked is not None
    roles = [role for role, _ in call.asked.turns]
    assert roles[0] in ("system", "developer")
    assert roles[1:] == ["user", "assistant", "user"]
    assert call.asked.turns[0][1] == "You drive a robot."
    assert call.asked.said == "draw a square"


@pytest.mark.parametrize("provider", WIRES)
def test_a_picture_goes_with_its_message(provider: str, fake: FakeModel) -> None:
    png = b"\x89PNG\r\n\x1a\n" + bytes(64)
    reply = model_at(provider, fake.url).ask([Message("user", "what is there?", png)], CallLimits())
    assert "".join(reply) == PLAN
    asked = fake.calls[-1].asked
    assert asked is not None
    assert (asked.said, asked.images) == ("what is there?", 1)


@pytest.mark.parametrize("provider", WIRES)
def test_the_reply_is_limited_at_the_provider_too(provider: str, fake: FakeModel) -> None:
    Got(model_at(provider, fake.url), "go 1", limits=CallLimits(reply_tokens=77))
    assert "77" in str(fake.calls[-1].body)


def test_old_servers_are_told_of_the_limit_in_the_old_way(fake: FakeModel) -> None:
    Got(model_at("llamacpp", fake.url), "go 1", limits=CallLimits(reply_tokens=77))
    assert fake.calls[-1].body["max_tokens"] == 77


def test_local_models_are_asked_not_to_think_aloud_for_minutes(fake: FakeModel) -> None:
    Got(model_at("ollama", fake.url), "go 1")
    assert fake.calls[-1].body["reasoning_effort"] == "none"
    Got(model_at("vllm", fake.url), "go 1")
    assert fake.calls[-1].body["chat_template_kwargs"] == {"enable_thinking": False}
    assert fake.calls[-1].body["temperature"] == 0


@pytest.mark.parametrize("text", ["gpt-5", "nobody:model", "openai:", ":x", ""])
def test_a_name_that_is_none_is_told_with_those_there_are(text: str) -> None:
    with pytest.raises(ModelError) as caught:
        make_model(text, ModelConfig(environ={}))
    assert caught.value.reason.code == "model_unknown"
    assert "ollama" in str(caught.value.reason.values["providers"])


def test_a_name_may_have_colons_in_it() -> None:
    assert split_name("ollama:qwen3:4b")[1] == "qwen3:4b"
    assert make_model("Ollama:qwen3:4b", ModelConfig(environ={})).name == "ollama:qwen3:4b"


@pytest.mark.parametrize(
    ("host", "address"),
    [
        ("127.0.0.1:11434", "http://127.0.0.1:11434/v1"),
        ("0.0.0.0", "http://127.0.0.1:11434/v1"),
        ("http://0.0.0.0:11435/", "http://127.0.0.1:11435/v1"),
        ("robot.local", "http://robot.local:11434/v1"),
        ("https://ollama.example/x", "https://ollama.example:443/x/v1"),
        ("http://10.0.0.2:8080/v1", "http://10.0.0.2:8080/v1"),
        ("[::1]:11434", "http://[::1]:11434/v1"),
    ],
)
def test_ollama_host_is_read_as_ollama_reads_it(host: str, address: str) -> None:
    assert ollama_address(host) == address


def test_a_third_party_adds_a_provider_in_one_place(monkeypatch: pytest.MonkeyPatch, fake: FakeModel) -> None:
    monkeypatch.setattr("chatrobot.models.providers._registered", {})
    register(Provider("mine", "my own", needs_key=False, key_variables=("MINE",), base_url=f"{fake.url}/v1"))
    got = Got(make_model("mine:fake", ModelConfig(environ={"MINE": KEY}, keyring=False)), "go 3")
    assert got.text == "drive 3 m"


def test_an_installed_package_adds_a_provider(monkeypatch: pytest.MonkeyPatch) -> None:
    class Entry:
        def load(self) -> Provider:
            return Provider("theirs", "a package of theirs", needs_key=False)

    monkeypatch.setattr(
        "importlib.metadata.entry_points", lambda group: [Entry()] if "chatrobot" in group else []
    )
    table._installed.cache_clear()
    try:
        assert split_name("theirs:x")[0].title == "a package of theirs"
    finally:
        monkeypatch.undo()
        table._installed.cache_clear()
    assert "theirs" not in providers()


def test_a_third_party_brings_a_model_of_its_own(monkeypatch: pytest.MonkeyPatch, fake: FakeModel) -> None:
    monkeypatch.setattr("chatrobot.models.providers._registered", {})

    def make(name: str, config: ModelConfig) -> Model:
        assert (name, config.environ) == ("x", {})
        return model_at("openai", fake.url)

    register(Provider("mine", "my own", make=make))
    assert "mine" in providers()
    assert Got(make_model("mine:x", ModelConfig(environ={})), "go 4").text == "drive 4 m"
