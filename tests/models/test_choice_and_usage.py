"""Which model is meant, what servers this machine has, and what calls have used."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from chatrobot.core.errors import InputError
from chatrobot.models.config import FILE, ModelConfig, resolve, store_choice
from chatrobot.models.discovery import find_local, listed_models
from chatrobot.models.make import problem_with
from chatrobot.models.providers import providers
from chatrobot.models.seam import CallLimits, Usage
from chatrobot.models.secret import Secret
from chatrobot.models.usage import check_prices, lines, priced, totals
from tests.models.rig import KEY, Got, model_at, serving


def test_the_option_outranks_the_environment_and_that_the_stored_choice(tmp_path: Path) -> None:
    bare, set_up = ModelConfig(tmp_path, {}), ModelConfig(tmp_path, {"CHATROBOT_MODEL": "openai:env"})
    assert resolve("", bare) is None
    store_choice("ollama:stored", tmp_path)
    names = [
        choice.name
        for choice in (resolve("", bare), resolve("", set_up), resolve("openai:x", set_up))
        if choice
    ]
    assert names == ["ollama:stored", "openai:env", "openai:x"]
    store_choice("", tmp_path)
    assert resolve("", bare) is None
    assert resolve("", ModelConfig(None, {})) is None


@pytest.mark.parametrize("name", ['a:"quoted"', "a:back\\slash", "a:模型"])
def test_a_stored_name_comes_back_to_the_letter(name: str, tmp_path: Path) -> None:
    store_choice(name, tmp_path / "new")
    choice = resolve("", ModelConfig(tmp_path / "new", {}))
    assert choice is not None
    assert choice.name == name


def test_a_broken_choice_is_told_with_its_file(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("model = openai", encoding="utf-8")
    with pytest.raises(InputError, match=FILE):
        resolve("", ModelConfig(tmp_path, {}))


def test_local_servers_are_found_by_themselves() -> None:
    with serving([], models=["qwen3:4b", "llama"]) as fake:
        environ = {
            "OLLAMA_HOST": fake.url, "LLAMACPP_BASE_URL": "http://127.0.0.1:1/v1",
            "VLLM_BASE_URL": "http://192.0.2.1/v1", "LMSTUDIO_BASE_URL": "http://127.0.0.1:1/v1",
        }  # fmt: skip
        found = find_local(ModelConfig(environ=environ))
        assert [(server.provider, server.models) for server in found] == [("ollama", ("qwen3:4b", "llama"))]


@pytest.mark.parametrize("provider", ["openai", "anthropic", "google", "ollama"])
def test_a_provider_lists_its_models(provider: str) -> None:
    with serving([], models=["a", "b"]) as fake:
        row = providers()[provider]
        root = fake.url if provider in ("anthropic", "google", "ollama") else f"{fake.url}/v1"
        config = ModelConfig(environ={row.base_url_variables[-1]: root})
        assert listed_models(row, config, Secret(KEY)) == ("a", "b")
    assert listed_models(row, config, None) is None


def test_what_stands_in_the_way_is_known_without_asking() -> None:
    bare = ModelConfig(environ={}, keyring=False)
    codes = [
        reason.code if (reason := problem_with(name, bare)) else ""
        for name in ("openai:x", "nobody:x", "openai-compatible:x", "ollama:x")
    ]
    assert codes == ["model_no_key", "model_unknown", "model_no_address", ""]
    assert problem_with("openai:x", ModelConfig(environ={"OPENAI_API_KEY": KEY})) is None


def test_a_call_is_recorded_with_counts_and_without_words(tmp_path: Path) -> None:
    with serving(
        [
            {"match": "rate", "error": {"status": 429}},
            {"match": "", "text": "drive 1 m", "prompt_tokens": 300},
        ]
    ) as fake:
        for provider, session in (("ollama", "one"), ("openai", "two"), ("ollama", "two")):
            model = model_at(provider, fake.url, folder=tmp_path, session=session)
            Got(model, "secret words")
            Got(model, "rate limited")
    text = (tmp_path / "usage.jsonl").read_text(encoding="utf-8")
    assert "words" not in text
    assert len(text.splitlines()) == 3, "a call that was turned away has used nothing"
    by_session = totals(tmp_path, "session")
    assert [total.calls for total in by_session.values()] == [1, 2]
    assert by_session["two"].prompt_tokens == 600
    assert by_session["two"].unpriced == 1
    assert list(totals(tmp_path, "model")) == ["ollama:fake", "openai:fake"]
    assert len(totals(tmp_path, "day")) == 1


def test_a_call_that_was_given_up_is_recorded_as_an_estimate(tmp_path: Path) -> None:
    with serving([{"match": "", "text": "drive 1 m\n" * 20, "hang_after": 4}]) as fake:
        Got(model_at("ollama", fake.url, folder=tmp_path), "go", limits=CallLimits(total_s=0.3))
        import time

        ends_s = time.monotonic() + 5
        while not list(lines(tmp_path)) and time.monotonic() < ends_s:
            time.sleep(0.005)
    assert [line["counted"] for line in lines(tmp_path)] == [False]


def test_a_folder_that_cannot_be_written_costs_the_record_alone(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("", encoding="utf-8")
    with serving([{"match": "", "text": "fine"}]) as fake:
        assert Got(model_at("ollama", fake.url, folder=file), "go").text == "fine"
    assert not list(lines(file))


def test_a_line_that_was_cut_off_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "usage.jsonl").write_text('{"model": "a:b"}\n{"model": "c\n7\n', encoding="utf-8")
    assert [line["model"] for line in lines(tmp_path)] == ["a:b"]


def cost_usd(provider: str, model: str, folder: Path | None = None) -> float | None:
    usage = Usage(prompt_tokens=10_000, cached_tokens=4_000, reply_tokens=1_000)
    return priced(usage, provider, model, folder).cost_usd


def test_a_call_costs_what_the_price_list_says(tmp_path: Path) -> None:
    pytest.importorskip("genai_prices")
    # OpenAI, gpt-5-mini: $ 0.25, 0.025 and 2.00 for a million tokens in, in from the cache, and out
    usual = pytest.approx((6_000 * 0.25 + 4_000 * 0.025 + 1_000 * 2.00) / 1e6)
    assert cost_usd("openai", "gpt-5-mini", tmp_path) == usual
    assert cost_usd("openai", "gpt-5-mini-2025-08-07") == usual
    assert cost_usd("openai-responses", "gpt-5-mini") == usual
    # Anthropic, claude-haiku-4-5: $ 1.00, 0.10 and 5.00
    assert cost_usd("anthropic", "claude-haiku-4-5") == pytest.approx((6_000 + 400 + 5_000) / 1e6)
    assert cost_usd("google", "gemini-2.5-flash-lite") != cost_usd("google", "gemini-2.5-flash")


def test_what_runs_here_costs_nothing_and_what_nobody_knows_is_unknown() -> None:
    assert cost_usd("ollama", "anything") == cost_usd("llamacpp", "default") == 0.0
    assert cost_usd("openai", "gpt-99") is None
    assert cost_usd("openai-compatible", "gpt-5-mini") is None, "it may be anybody's server"


def test_ones_own_prices_come_first_and_the_longest_name_that_fits_counts(tmp_path: Path) -> None:
    rows = '"gpt-99" = { prompt = 1.0, reply = 10.0 }\n"gpt-99-nano" = { prompt = 0.0, reply = 1.0 }\n'
    (tmp_path / "prices.toml").write_text(f"[openai]\n{rows}", encoding="utf-8")
    assert cost_usd("openai", "gpt-99-big", tmp_path) == pytest.approx(0.02)
    assert cost_usd("openai-responses", "gpt-99-nano-1", tmp_path) == pytest.approx(0.001)
    assert cost_usd("openai", "gpt-98", tmp_path) is None


def test_a_broken_price_list_is_told_and_stops_no_call(tmp_path: Path) -> None:
    check_prices(tmp_path)
    for number, text in enumerate(
        ("[openai", '[openai]\n"gpt-5-mini" = 1.0', "[openai]\nx = { reply = 1.0 }")
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "prices.toml").write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=r"prices\.toml"):
            check_prices(folder)
        assert cost_usd("openai", "gpt-5-mini", folder) is None


def test_the_record_is_json_lines(tmp_path: Path) -> None:
    with serving([{"match": "", "text": "fine"}]) as fake:
        Got(model_at("ollama", fake.url, folder=tmp_path, session="s"), "go")
    (line,) = (tmp_path / "usage.jsonl").read_text(encoding="utf-8").splitlines()
    assert set(json.loads(line)) == {
        "at", "session", "model", "prompt_tokens", "cached_tokens", "reply_tokens", "cost_usd", "counted",
    }  # fmt: skip
