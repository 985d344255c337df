"""A key goes into the header of its request, and nowhere else."""

from __future__ import annotations

import copy
import json
import logging
import pickle
import traceback
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.phrases import render_reason
from chatrobot.models.failures import Place, reason_of
from chatrobot.models.providers import split_name
from chatrobot.models.secret import HIDDEN, PieceScrubber, Secret, scrub
from tests.models.rig import KEY, WIRES, Got, model_at, serving

ECHO = [
    {"match": "bad", "error": {"status": 500, "message": f"your key {KEY} is fine, but we are not"}},
    {"match": "", "text": f"your key is {KEY}, is it not"},
]


def test_a_secret_does_not_show() -> None:
    secret = Secret(f" {KEY}\n")
    assert secret.reveal() == KEY
    for shown in (repr(secret), str(secret), f"{secret}", f"{secret!s:>40}", f"{secret:x}", "%s" % secret):  # noqa: UP031
        assert KEY not in shown
    assert KEY not in repr({"key": [secret]})
    for store in (pickle.dumps, copy.deepcopy, json.dumps):
        with pytest.raises(TypeError):
            store(secret)  # type: ignore[operator]
    assert not Secret("  ")


@pytest.mark.parametrize("provider", WIRES)
def test_a_key_that_the_provider_echoes_shows_nowhere(
    provider: str, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    caplog.set_level(logging.DEBUG)
    with serving(ECHO, keys=[KEY]) as fake:
        model = model_at(provider, fake.url, folder=tmp_path)
        good, bad = Got(model, "hello"), Got(model, "bad")
        wrong = Got(model_at(provider, fake.url, key=KEY + "x"), "hello")
    assert good.text == f"your key is {HIDDEN}, is it not"
    assert (bad.code, wrong.code) == ("model_server_error", "model_wrong_key")
    shown = [repr(model), repr(vars(model)), good.text, *good.pieces, *capfd.readouterr()]
    for error in (bad.error, wrong.error):
        assert error is not None
        shown += [str(error), repr(error), json.dumps(error.reason.to_json())]
        shown += traceback.format_exception(type(error), error, error.__traceback__)
        shown += [render_reason(error.reason, language) for language in ("en", "zh")]
    shown += [record.getMessage() for record in caplog.records]
    shown += [file.read_text(encoding="utf-8") for file in tmp_path.rglob("*")]
    assert any("usage" in file.name for file in tmp_path.rglob("*"))
    assert not [text for text in shown if KEY in text]


@given(st.text(alphabet="abk-sey 1", max_size=60), st.data())
def test_a_key_is_taken_out_however_a_text_is_cut(before: str, data: st.DataObject) -> None:
    text = f"{before}{KEY}{before}"
    scrubber, shown, rest = PieceScrubber(Secret(KEY)), "", text
    while rest:
        cut = data.draw(st.integers(1, len(rest)))
        shown += scrubber.feed(rest[:cut])
        rest = rest[cut:]
    assert shown + scrubber.rest() == text.replace(KEY, HIDDEN)


@given(st.text(max_size=80))
def test_ordinary_text_passes_at_once(text: str) -> None:
    scrubber = PieceScrubber(Secret("zzzz-not-in-it-zzzz"))
    shown = "".join(scrubber.feed(letter) for letter in text)
    assert shown + scrubber.rest() == text
    assert len(text) - len(shown) < 10


@pytest.mark.parametrize(
    "quoted", ["sk-abcdefgh1234", "sk-abc*****7890", "Bearer abcdefghijkl", "AIzaSyA-1234567890"]
)
def test_what_looks_like_a_key_is_hidden_even_if_it_is_not_ours(quoted: str) -> None:
    assert scrub(f"Incorrect API key provided: {quoted}.", Secret(KEY)).startswith(
        "Incorrect API key provided: "
    )
    assert quoted not in scrub(f"Incorrect API key provided: {quoted}.", None)


def test_what_a_provider_says_is_one_short_line() -> None:
    provider, model = split_name("openai:x")
    reason = reason_of(ValueError("a\nb\t" + "c" * 5000), Place(provider, model, "https://x", Secret(KEY)))
    assert str(reason.values["said"]).startswith("a b c")
    assert len(str(reason.values["said"])) <= 200
