"""The words of one dialogue: places by name, words that a person defined, and `that place`."""

from __future__ import annotations

from chatrobot.language import forms
from chatrobot.language.compiled import Key
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES, expand, load_table
from chatrobot.language.facts import unit_length_m
from chatrobot.language.lexicon import Meaning, cut, lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.points import word_of

_LIGHT = frozenset({"conn", "flag", "glue", "filler", "number", "num", "dir", "rot"})


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
        is_article = ("num", "article") in lexicon().words.get(cut(name), ())  # `half a metre` names no place
        if not is_article:
            names[cut(normalise(word_of(name)))] = (("place", name),)
        if len(name) == 1:  # A is also called `point A`, 去A点
            for language in LANGUAGES:
                table = load_table(language, "dialogue_forms")
                led_to = table.get("article_places", ()) if is_article else ()
                for written in (*table.get("letter_places", ()), *led_to):
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
