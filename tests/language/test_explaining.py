"""`/why`: the lines tell what the reader really did with the text."""

from __future__ import annotations

from chatrobot.language.context import Context
from chatrobot.language.explaining import explain
from chatrobot.language.interpreter import OfflineInterpreter
from tests.language.profiles import MECANUM


def why(text: str) -> str:
    return "\n".join(explain(text, Context(), OfflineInterpreter(MECANUM)))


def test_it_names_the_rule_the_words_and_the_reading_that_comes_next() -> None:
    told = why("could you take us home, at half a knot")
    assert "could you = request" in told
    assert "“take us home”: could you go home, at half a knot" in told  # the rule, and what it made of it
    assert "half a knot = q speed" in told
    assert "So it is done: go to where this began" not in told.split("Next likeliest")[1]
    assert "without “at half a knot”: go to (0, 0)" in told


def test_it_says_why_it_asked_and_why_it_did_nothing() -> None:
    assert "a yes does: drive forward 1 m (I found no meaning for “zorblaxing”)" in why(
        "forward 1 m zorblaxing"
    )
    assert "“you were too quick” orders nothing" in why("you were too quick")
    assert "So I did not move (nothing_to_do)" in why("you were too quick")


def test_a_text_that_is_put_into_known_words_is_shown_in_them() -> None:
    told = why("Fahr einen Meter und ein Viertel vor")
    assert "In den Wörtern, die ich lese: drive a metre and a quarter of a metre forward" in told
    assert "Deshalb wird es getan: 1,25 m vorwärts fahren" in told


def test_a_point_is_one_word_and_shown_as_it_was_written() -> None:
    told = why("go to (1, 1), then turn left")
    assert "(1, 1) = place (1, 1)" in told
    assert "without “then turn left”: go to (1, 1)" in told
