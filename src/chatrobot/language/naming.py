"""What is done with names and words that a person taught: they are forgotten, called otherwise, asked about."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.language.context import Context
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import describe_plan, say
from chatrobot.language.rules import forms
from chatrobot.language.unclear import Unclear

_QUOTES = " \"'“”„‚‘’「」『』.,!?。"


def read_naming(plain: str, language: LanguageCode, context: Context) -> Interpretation | None:
    """What a normalised text does with a name that a person taught; None for any other text.

    Raises:
        Unclear: where the name is the map's, or the new one is taken.
    """
    said = plain.strip(_QUOTES)
    for kind in ("forget", "rename"):
        for pattern in forms(language, "naming", kind):
            found = pattern.fullmatch(said)
            name = _known(found["name"], context) if found else ""
            if found and name:
                return _renamed(name, found.groupdict().get("new") or "", language, context)
    for pattern in forms(language, "naming", "moved"):
        found = pattern.fullmatch(said)
        name = _known(found["name"], context) if found else ""
        if found and name and _is_own(name, context):
            reply = say(language, "place_remembered", place=name)
            return Interpretation("answered", reply, language, remember_place=name)
    return None


def _renamed(name: str, new: str, language: LanguageCode, context: Context) -> Interpretation:
    new = new.strip(_QUOTES)
    if not _is_own(name, context):
        raise Unclear("name_of_map", name)
    if new and _known(new, context):
        raise Unclear("name_taken", new)
    reply = (
        say(language, "name_changed", name=name, new=new)
        if new
        else say(language, "name_forgotten", name=name)
    )
    return Interpretation("answered", reply, language, renamed={name: new})


def _is_own(name: str, context: Context) -> bool:
    return name in context.dialogue.places or name in context.dialogue.words


def _known(said: str, context: Context) -> str:
    """The name as it was taught, or as the map has it; an empty string where nobody knows it."""
    plain = normalise(said.strip(_QUOTES)).casefold()
    names = (*context.dialogue.places, *context.dialogue.words, *context.world_places)
    return next((name for name in names if normalise(name).casefold() == plain), "")


def told_what_it_would_do(
    plain: str, language: LanguageCode, read: Callable[[str], Interpretation]
) -> Interpretation | None:
    """The answer to `what would “go home” do?`: the plan, which is not driven; None for any other text.

    Raises:
        Unclear: where what is asked about is not understood.
    """
    for pattern in forms(language, "naming", "would"):
        found = pattern.fullmatch(plain.strip(" .!?。"))
        if found:
            meant = read(found["said"].strip(_QUOTES))
            if meant.plan is None:
                return Interpretation("answered", meant.reply, language)
            told = say(language, "would_do", text=describe_plan(meant.plan, language))
            return Interpretation("answered", told, language)
    return None
