"""The words of one dialogue: places by name, words that a person defined, and `that place`."""

from __future__ import annotations

import re
from dataclasses import replace

from chatrobot.core.geometry import Pose
from chatrobot.language import forms
from chatrobot.language.compiled import Key
from chatrobot.language.context import Context, Place
from chatrobot.language.data_files import LANGUAGES, expand, load_table
from chatrobot.language.facts import unit_length_m
from chatrobot.language.lexicon import Meaning, cut, lexicon
from chatrobot.language.normalise import normalise

_NUMBER = r"([-+]?\d*\.?\d+) ?m?"
_POINT = re.compile(
    rf"[(（] ?{_NUMBER} ?[,，] ?{_NUMBER} ?[)）]"
    rf"|(?<![a-z])x ?= ?{_NUMBER}[ ,，]+(?:[a-z]{{1,3}} )?y ?= ?{_NUMBER}(?![\d.])",
    re.IGNORECASE,
)
_LETTERS = str.maketrans("0123456789.-+,e", "abcdefghijkmpqu", "() ")
_TWIST = re.compile(r"linear|angular|twist|\bz ?[=:]", re.IGNORECASE)

_LIGHT = frozenset({"conn", "flag", "glue", "filler", "number", "num", "dir", "rot"})


def with_points(text: str, context: Context) -> tuple[str, Context]:
    """`Go to (1, 1)`, `x=1 y=2`: each point, metres in the odom frame, is a place of this text alone, in one word."""
    places: dict[str, Place] = {}

    def word(found: re.Match[str]) -> str:
        x_m, y_m = (float(number) for number in found.groups() if number is not None)
        name = f"({x_m:g}, {y_m:g})"
        places[name] = Place(Pose(x_m, y_m, 0.0))
        return f" {word_of(name)} "

    said = text if _TWIST.search(text) else _POINT.sub(word, text)
    if not places:
        return text, context
    dialogue = replace(context.dialogue, places={**context.dialogue.places, **places})
    return said, replace(context, dialogue=dialogue)


def naming_points(said: str, context: Context) -> str:
    """What is told, with the points as they are written."""
    for name in context.dialogue.places:
        said = said.replace(word_of(name), name) if _POINT.fullmatch(name) else said
    return said


def word_of(name: str) -> str:
    """The name of a place as it is looked up in a text: that of a point is one word of letters."""
    return "xy" + name.translate(_LETTERS) if _POINT.fullmatch(name) else name


def without_light_words(names: dict[Key, Meaning]) -> dict[Key, Meaning]:
    """The names without the taught words that the language has for something else than a motion: who taught `next` says
    `next, turn left` in its usual sense, and the signal alone."""
    known = lexicon().words
    return {
        key: meaning
        for key, meaning in names.items()
        if meaning[0][0] != "defined" or not {kind for kind, _ in known.get(key, ())} & _LIGHT
    }


def names_in(context: Context) -> dict[Key, Meaning]:
    """What these words mean, looked up before all others."""
    dialogue = context.dialogue
    names: dict[Key, Meaning] = {}
    for name in (*context.world_places, *dialogue.places):
        if ("num", "article") not in lexicon().words.get(cut(name), ()):  # `half a metre` names no place
            names[cut(normalise(word_of(name)))] = (("place", name),)
        if len(name) == 1:  # A is also called `point A`, 去A点
            for language in LANGUAGES:
                for written in load_table(language, "dialogue_forms").get("letter_places", ()):
                    names[cut(written.format(letter=name))] = (("place", name),)
    for word, plan in dialogue.words.items():
        counter = ("counter", word) in lexicon().words.get(cut(word), ())
        if counter and unit_length_m(plan) is not None:
            continue  # a unit: it is counted
        names[cut(normalise(word))] = (("defined", word),)
        if word.isascii() and not word.endswith("s"):
            ending = "es" if word.endswith(("x", "z", "ch", "sh")) else "s"
            names[cut(normalise(f"{word}{ending}"))] = (("defined", word),)
    if forms.UNNAMED in dialogue.places:
        for language in LANGUAGES:
            for pattern in load_table(language, "dialogue_forms")["that_place"]:
                for written in expand(pattern):
                    names[cut(written)] = (("place", forms.UNNAMED),)
    return names
