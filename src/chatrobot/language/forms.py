"""Sentences with a free name in them: words that a person defines, places to remember."""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

from chatrobot.language.data_files import in_full, load_table
from chatrobot.language.rules import Form, forms_of
from chatrobot.reflex import is_stop

UNNAMED = "★"
"""The name of a place that was remembered without one: it is what `that place` means."""


_MARKS = " \"'“”「」『』.,!?。"


class Definition(NamedTuple):
    """A word and the text of what it means."""

    name: str
    body: str


@cache
def _patterns(language: str, name: str) -> tuple[Form, ...]:
    def sources() -> list[str]:
        return [_in_full(p, language) for p in load_table(language, "dialogue_forms").get(name, ())]

    return forms_of(f"dialogue_{language}_{name}", sources)


def _in_full(pattern: str, language: str) -> str:
    """A pattern with what a name may be, and what none is."""
    table = load_table(language, "dialogue_forms")
    pattern = in_full(pattern, table.get("parts", {}))
    return (
        pattern.replace("@no_place", table.get("no_place", ""))
        .replace("@name", table.get("name", ""))
        .replace("@cue", table.get("cue", ""))
    )


@cache
def _pattern(language: str, name: str) -> re.Pattern[str]:
    return re.compile(load_table(language, "dialogue_forms")[name])


def without_nod(text: str, language: str) -> str:
    """What is taught without the check at its end that it was taken in: `…, all right?`."""
    return _pattern(language, "nod").sub("", text.strip())


def read_definitions(text: str, language: str) -> list[Definition]:
    """The words that a text teaches, one or one after the other: 我说苹果就是左转，我说香蕉就是右转."""
    whole = read_definition(text, language)
    if whole is None or "define_next" not in load_table(language, "dialogue_forms"):
        return [whole] if whole else []
    parts = _pattern(language, "define_next").split(without_nod(text, language))
    found = [one for part in parts if (one := read_definition(part, language))]
    return found if len(found) == len(parts) else [whole]


def read_definition(text: str, language: str) -> Definition | None:
    """`When I say shuffle, you slide left 30 cm`."""
    if _pattern(language, "no_definition").search(text):
        return None
    text = without_nod(text, language)
    for pattern in _patterns(language, "define"):
        found = pattern.fullmatch(text)
        if found:
            name = found["name"].strip(" ,.:'\"")
            if name and not (is_stop(name) or _pattern(language, "name_stop").search(name)):
                return Definition(name, found["body"].strip(" \"'”」"))
    return None


def read_usual(text: str, language: str) -> tuple[str, str] | None:
    """What is to be usual (`distance` or `turn`) and how much: `if I don't say how far, go 25 cm`; else None."""
    for kind in ("distance", "turn"):
        for pattern in _patterns(language, f"usual_{kind}"):
            found = pattern.fullmatch(without_nod(text, language).strip(" .!。"))
            if found:
                return kind, found["amount"]
    return None


def read_limit(text: str, language: str) -> str | None:
    """The highest speed that a text sets, in its words: `never faster than 0.2 m/s`; else None."""
    found = _whole(text, language, "usual_limit")
    return found["amount"] if found else None


def ends_limit(text: str, language: str) -> bool:
    """Whether a text ends the speed limit that a person set."""
    return _whole(text, language, "no_limit") is not None


def _whole(text: str, language: str, name: str) -> re.Match[str] | None:
    plain = without_nod(text, language).strip(" .!。")
    return next((found for one in _patterns(language, name) if (found := one.fullmatch(plain))), None)


def read_place(clause: str, language: str) -> str | None:
    """The name a clause gives to where the robot stands; UNNAMED for none; None if it is no such clause."""
    plain = clause.strip(" ,.!;:。")
    lead = _pattern(language, "lead")
    while (shorter := lead.sub("", plain, count=1)) != plain:
        plain = shorter
    for pattern in _patterns(language, "remember_unnamed"):
        if pattern.fullmatch(plain):
            return UNNAMED
    for pattern in _patterns(language, "remember"):
        found = pattern.fullmatch(plain)
        name = trimmed(found["name"], language) if found else ""
        if name:
            return name
    return None


def read_place_told(text: str, language: str) -> str | None:
    """The name that a whole text gives to where the robot stands, over more than one clause; None if it gives none."""
    plain = text.strip(" ,.!;:。")
    for pattern in _patterns(language, "remember_told"):
        found = pattern.fullmatch(plain)
        name = trimmed(found["name"], language) if found else ""
        if name:
            return name
    return None


def trimmed(name: str, language: str) -> str:
    """The name of a place without what only stands around it; an empty string where it is none."""
    trim = _pattern(language, "name_trim")
    name = name.strip(_MARKS)
    while (shorter := trim.sub("", name).strip(_MARKS)) != name and shorter:
        name = shorter
    words = len(name.split()) if name.isascii() else len(name) / 3
    return (
        ""
        if words > 4 or any(mark in name for mark in ":。!?;") or _pattern(language, "name_stop").search(name)
        else name
    )
