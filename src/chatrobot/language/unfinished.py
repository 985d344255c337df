"""Sentences that break off, leave a choice open or contradict themselves: `drive forward a distance of`.

What was to come is not guessed.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from functools import cache

from chatrobot.language.compiled import Key
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.rules import Rules, form, rules
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_SHOWN = 60


_ASKED = {
    "contradicts": "contradiction",
    "sizeless": "which_size",
    "conditional": "condition",
    "unread": "unclear_motion",
    "untaught": "unclear_motion",
}
"""The code that is asked back with where a text matches a list of the table."""


def breaks_off(text: str, language: str) -> str:
    """The words with which a normalised text breaks off, or an empty string."""
    found = form(language, "unfinished", "end").search(text)
    if found is None or form(language, "unfinished", "complete").search(text):
        return ""
    return found.group().strip(" .…,!-")


def check_consistent(text: str, language: str, names: Collection[Key] = ()) -> None:
    """Ask back where a normalised text says two things at once, asks for a lap and not round what, or has
    a part that no rule reads and that changes what is meant, or tells only what may be possible.

    Args:
        names: the places and words that a person taught: what means nothing by itself (`untaught`) means one of them.

    Raises:
        Unclear: for such a text.
    """
    known = [sep.join(name) for name in names for sep in (" ", "")]  # the second: 圆圈 is two words
    for name in _ASKED:
        _check(text, language, name, known if name == "untaught" else ())
    _check_beside_places(text, language, known)


def check_unconditional(text: str, language: str) -> None:
    """Ask back where the whole of a normalised text is ordered on a condition that the robot cannot judge, or has a
    part that no rule reads: of its clauses alone, that one may look like an aside.

    Raises:
        Unclear: for such a text.
    """
    _check(text, language, "conditional")
    _check(text, language, "unread")


def _check(text: str, language: str, name: str, known: Collection[str] = ()) -> None:
    found = [
        part
        for rule in _rules(language, name).that_may_match(text)
        if (part := rule.search(text)) is not None
    ]
    named = [span.span() for word in known if found for span in re.finditer(re.escape(word), text)]
    if any(not any(start < part.end() and part.start() < end for start, end in named) for part in found):
        raise Unclear(_ASKED[name], text[:_SHOWN], is_final=name in ("unread", "untaught"))


def _check_beside_places(text: str, language: str, known: Sequence[str]) -> None:
    """Ask back where what stands beside the name of a taught place makes it no way to it: `return from base`."""
    for rule in _rules(language, "of_place") if known else ():
        found = rule.search(text)
        named = [name for name in known if re.search(rf"\b{re.escape(name)}\b", found[0])] if found else []
        if found and named and re.match(rf"{re.escape(max(named, key=len))}\b", found["place"]):
            raise Unclear("unclear_motion", text[:_SHOWN], is_final=True)


@cache
def _rules(language: str, name: str) -> Rules:
    listed = load_table(language, "unfinished").get(name, ())
    parts = load_table(language, "rephrase").get("parts", {})
    return rules(f"unfinished_{language}_{name}", [(rule, "") for rule in listed], parts)


@cache
def _clue(language: str, name: str) -> re.Pattern[str] | None:
    pattern = load_table(language, "asides").get("clues", {}).get(name)
    return re.compile(pattern) if pattern else None


@cache
def _unfinished() -> frozenset[str]:
    tables = [load_table(language, "asides").get("clues", {}) for language in LANGUAGES]
    return frozenset(word for table in tables for word in table.get("unfinished", ()))


@cache
def _lasting() -> tuple[str, ...]:
    tables = [load_table(language, "asides").get("clues", {}) for language in LANGUAGES]
    return tuple(word for table in tables for word in table.get("lasting", ()))


def lasts(said: str) -> bool:
    """Whether what is forbidden is meant to be so for good: `never drive backward`."""
    return any(
        f" {word} " in f" {said} " if word.isascii() else word in said.replace(" ", "") for word in _lasting()
    )


def is_choice(text: str, language: str) -> bool:
    """Whether `text` leaves a choice open: `left or right?`."""
    pattern = _clue(language, "choice")
    return pattern is not None and pattern.search(text) is not None


def check_finished(atoms: Sequence[Atom]) -> None:
    """A sentence that ends on a word which must be followed by something is not acted on.

    Raises:
        Unclear: for a sentence that breaks off.
    """
    left = [a for a in atoms if a.kind != "sep"]
    while left and left[-1].kind == "filler" and left[-1].text not in _unfinished():
        left.pop()
    if len(left) > 1 and left[-1].text in _unfinished():
        raise Unclear("unknown_part", f"{left[-1].text}…")
