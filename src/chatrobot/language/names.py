"""The words of one dialogue: places by name, words that a person defined, and `that place`."""

from __future__ import annotations

from chatrobot.language import forms
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.facts import unit_length_m
from chatrobot.language.lexicon import Key, Meaning, cut, lexicon
from chatrobot.language.normalise import normalise


def names_in(context: Context) -> dict[Key, Meaning]:
    """What these words mean, looked up before all others."""
    dialogue = context.dialogue
    names: dict[Key, Meaning] = {}
    for name in (*context.world_places, *dialogue.places):
        names[cut(normalise(name))] = (("place", name),)
    for word, plan in dialogue.words.items():
        counter = ("counter", word) in lexicon().words.get(cut(word), ())
        if counter and unit_length_m(plan) is not None:
            continue  # a unit: it is counted
        names[cut(normalise(word))] = (("defined", word),)
        if word.isascii() and not word.endswith("s"):
            names[cut(normalise(f"{word}s"))] = (("defined", word),)
    if forms.UNNAMED in dialogue.places:
        for language in LANGUAGES:
            for written in load_table(language, "dialogue_forms")["that_place"]:
                names[cut(written)] = (("place", forms.UNNAMED),)
    return names
