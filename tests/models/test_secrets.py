"""A key goes into the header of its request, and nowhere else."""

from __future__ import annotations

import copy
import io
import json
import logging
import pickle
import traceback
from pathlib import Path
from urllib.parse import quote

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.cli.entry import main
from chatrobot.language.phrases import render_reason
from chatrobot.models.failures import MOST_CHARS, Place, reason_of
from chatrobot.models.providers import split_name
from chatrobot.models.secret import HIDDEN, PieceScrubber, Secret, scrub
from tests.models.rig import KEY, WIRES, Got, model_at, serving
from tests.models.test_keys import Backend, install

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


FLAWED = [
    "sk-tést-0123456789", "sk-test-01\u200b23456789", "密钥0123456789", "sk-test\udce90123456789",
    "sk-test 0123456789", "sk-test\n0123456789", "sk-test\x7f0123456789",
]  # fmt: skip


@pytest.mark.parametrize("flawed", FLAWED)
@pytest.mark.parametrize("provider", WIRES)
def test_what_can_be_no_key_is_not_sent_and_no_character_of_it_is_shown(provider: str, flawed: str) -> None:
    with serving(ECHO) as fake:
        got = Got(model_at(provider, fake.url, key=flawed), "hello")
        assert not fake.calls
    assert got.error is not None
    assert got.code == (
        "model_key_space" if any(sign.isspace() for sign in flawed) else "model_key_not_ascii"
    )
    shown = [str(got.error), json.dumps(got.error.reason.to_json(), ensure_ascii=False)]
    shown += traceback.format_exception(type(got.error), got.error, got.error.__traceback__)
    shown += [render_reason(got.error.reason, "en")]
    strange = [sign for sign in flawed if not "!" <= sign <= "~" and not sign.isspace()]
    assert not [text for text in shown for sign in (*strange, "0123456789") if sign in text]
    assert not [text for text in shown for sign in strange if repr(sign)[1:-1] in text]


@pytest.mark.parametrize(
    "pasted", [f"{KEY}\n", f" {KEY}\r\n", f'"{KEY}"', f"'{KEY}'\n", f"“{KEY}”", f"`{KEY}`"]
)
def test_what_was_pasted_around_a_key_is_no_part_of_it(pasted: str) -> None:
    assert Secret(pasted).reveal() == KEY
    assert Secret(pasted).flaw is None


def test_a_header_that_the_library_shows_shows_no_key() -> None:
    provider, model = split_name("openai:x")
    key = "ab'c\\d\"e-0123456789"
    place = Place(provider, model, "https://x", Secret(key))
    for text in (
        f"Illegal header value {f'Bearer {key}'.encode()!r}",
        repr({"Authorization": f"Bearer {key}"}),
        json.dumps({"x-api-key": key}),
        f"https://host/v1/models?key={quote(key)}",
        "<p>" + "x" * (MOST_CHARS - 13) + key,
        "x" * (MOST_CHARS - 5) + key,
    ):
        assert "0123" not in place.quote(text)
        assert "ab'c" not in place.quote(text)
        assert not place.quote("<style>" + "y" * (MOST_CHARS - 30) + "</style> " + key).endswith(key[:5])


def test_the_end_of_a_key_behind_asterisks_is_not_shown() -> None:
    assert scrub("Your api key: ****cdef is invalid", None) == f"Your api key: {HIDDEN} is invalid"


@pytest.mark.parametrize(
    "arguments",
    [
        ["model", "key", KEY], ["model", "key", "openai", KEY], ["model", "list", KEY], ["model", "use", KEY],
        ["model", KEY], ["model", "test", KEY], ["do", "hi", "--fast", "--interpreter", "model", "--model", KEY],
    ],
)  # fmt: skip
def test_a_key_in_the_wrong_place_is_not_repeated(
    arguments: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) != 0
    assert not [text for text in capfd.readouterr() if "0123456789" in text]


@pytest.mark.parametrize(
    "given", ["sk-tést-0123".encode(), "sk-tést-0123".encode("latin-1"), b"sk-test 0123"]
)
def test_a_key_that_can_be_none_is_not_kept_and_not_shown(
    given: bytes, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    backend = Backend()
    install(monkeypatch, backend)
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(given + b"\n"), encoding="utf-8"))
    assert main(["model", "key", "openai"]) == 2
    said = capfd.readouterr().err
    assert "the key of openai has a" in said
    assert "é" not in said
    assert "xe9" not in said
    assert not backend.kept


def test_a_password_in_an_address_is_not_shown(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("OPENAI_BASE_URL", "http://me:hidden-word@127.0.0.1:9/v1")
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    assert main(["model", "list", "openai"]) == 1
    assert main(["model", "test", "openai:x"]) == 1
    assert not [text for text in capfd.readouterr() if "hidden-word" in text or KEY in text]
