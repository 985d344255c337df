"""A conversation that the server holds: it is told only what it does not know yet."""

from __future__ import annotations

from chatrobot.models.make import make_model
from chatrobot.models.seam import CallLimits, Message
from tests.models.rig import Got, config_for, model_at, serving

ECHO = [{"match": "^(.*)$", "text": "answer to {1}"}]


def test_the_second_turn_sends_its_own_words_alone() -> None:
    with serving(ECHO) as fake:
        model = model_at("openai-responses", fake.url)
        assert Got(model, "one", system="Drive.").text == "answer to one"
        assert Got(model, "one", "answer to one", "two", system="Drive.").text == "answer to two"
        first, second = fake.calls
        assert "previous_response_id" not in first.body
        assert str(second.body["previous_response_id"]).startswith("resp_")
        assert "one" not in str(second.body["input"])
        assert second.body["instructions"] == "Drive."
        assert second.asked is not None
        heard = [text for role, text in second.asked.turns if role != "system"]
        assert heard == ["one", "answer to one", "two"]


def test_a_new_conversation_begins_when_asked_to_forget() -> None:
    with serving(ECHO) as fake:
        model = model_at("openai-responses", fake.url)
        Got(model, "one")
        model.forget()
        Got(model, "two")
        assert "previous_response_id" not in fake.calls[1].body


def test_a_failed_turn_goes_on_from_the_last_good_one() -> None:
    with serving([{"match": "break", "text": "a b c d e f", "cut_off_after": 2}, *ECHO]) as fake:
        model = model_at("openai-responses", fake.url)
        Got(model, "one")
        assert Got(model, "break").code == "model_cut_off"
        Got(model, "one", "answer to one", "two")
        assert fake.calls[2].body["previous_response_id"] == fake.calls[1].body["previous_response_id"]


def test_an_answer_that_was_given_up_is_told_with_what_it_answered() -> None:
    """A plan that goes wrong in its second line is cancelled there; the server has kept nothing of it."""
    with serving([{"match": "^two$", "text": "bad plan\n" * 30, "tokens_per_s": 50}, *ECHO]) as fake:
        model = model_at("openai-responses", fake.url)
        Got(model, "one")
        reply = model.ask([Message("user", text) for text in ("one", "two")], CallLimits())
        assert next(iter(reply))
        reply.cancel()
        Got(model, "one", "answer to one", "two", "bad plan", "that is no plan")
        asked = fake.calls[-1].asked
        assert asked is not None
        assert [text for _, text in asked.turns] == [
            "one", "answer to one", "two", "bad plan", "that is no plan",
        ]  # fmt: skip


def test_where_it_cannot_be_told_what_the_server_knows_it_is_told_everything() -> None:
    with serving([{"match": "break", "text": "a b c d e f", "cut_off_after": 2}, *ECHO]) as fake:
        model = model_at("openai-responses", fake.url)
        Got(model, "one")
        Got(model, "break")
        Got(model, "one, in other words", "answer to one", "break", "a b", "go on")
        assert "previous_response_id" not in fake.calls[-1].body
        assert len(fake.calls[-1].body["input"]) == 5


def test_the_same_words_twice_are_said_twice() -> None:
    with serving(ECHO) as fake:
        model = model_at("openai-responses", fake.url)
        for _ in range(2):
            Got(model, "go")
        asked = fake.calls[-1].asked
        assert asked is not None
        assert [text for _, text in asked.turns] == ["go", "answer to go", "go"]


def test_what_the_server_has_forgotten_is_told_it_again() -> None:
    with serving(ECHO) as fake:
        model = model_at("openai-responses", fake.url)
        Got(model, "one")
        fake.conversations._turns.clear()  # as servers do after some weeks
        got = Got(model, "one", "answer to one", "two")
        assert got.text == "answer to two"
        asked = fake.calls[-1].asked
        assert asked is not None
        assert [text for _, text in asked.turns] == ["one", "answer to one", "two"]


def test_a_conversation_of_the_persons_own_goes_on() -> None:
    with serving(ECHO) as fake:
        conversation = fake.conversations.begin()
        config = config_for("openai-responses", fake.url)
        config = type(config)(
            environ={**config.environ, "CHATROBOT_CONVERSATION": conversation}, keyring=False
        )
        model = make_model("openai-responses:fake", config)
        Got(model, "one")
        Got(model, "two")
        assert [call.body["conversation"] for call in fake.calls] == [conversation] * 2
        asked = fake.calls[1].asked
        assert asked is not None
        assert [text for _, text in asked.turns] == ["one", "answer to one", "two"]


def test_the_token_goes_as_a_bearer_to_any_address() -> None:
    with serving(ECHO, keys=["eyJhbGciOi.access.token"]) as fake:
        model = model_at("openai-responses", fake.url, key="eyJhbGciOi.access.token")
        assert "".join(model.ask([Message("user", "hi")], CallLimits())) == "answer to hi"
        assert fake.calls[0].headers["authorization"] == "Bearer eyJhbGciOi.access.token"
