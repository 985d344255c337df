"""`Emma wants you to turn left 90 degrees`: what others who are present want, said by whoever types.

Beside a whole order such a clause only tells why, and is left out. Where it is the order itself what opens it is cut
off, and the rest is done if it tells way and amount. What somebody says (`Ben says again`) is only ever proposed.
"""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.language.rules import Form, form
from chatrobot.language.signs import Clause, clauses_of

_MARKS = " ,.;:!?…。—~"


@dataclass(frozen=True)
class Wish:
    """A text without what tells of a wish in it. `is_sure`: what is left may be done, not only proposed."""

    text: str
    is_sure: bool = True


def of_wish(text: str, language: str) -> Wish | None:
    """The normalised text without the wish of somebody else in it; None where none is told.

    One that is denied, put off or asked about stays in the text.
    """
    found = (_wish(text, clause, language) for clause in clauses_of(text))
    wish = next((wish for wish in found if wish is not None), None)
    denied = wish is not None and (
        _form(language, "bearing").search(text) or text.rstrip().endswith(("?", "？"))
    )
    return Wish(text, is_sure=False) if denied else wish


def _form(language: str, name: str) -> Form:
    return form(language, "wishes", name)


def _wish(text: str, clause: Clause, language: str) -> Wish | None:
    """What is left of the text where `clause` begins to tell a wish; else None."""
    told = _form(language, "tells").search(text[clause.start :])
    wish = _beside(text, clause.start, clause.start + told.end(), language) if told else None
    if wish is not None:
        return wish
    for name in ("asks", "names", "says"):
        found = _form(language, name).search(text[clause.start :])
        if found is None:
            continue
        begin = clause.start + found.end()
        end = _form(language, "end").search(text, begin)
        stop = end.start() if end else len(text)
        if not _form(language, "ordered").search(text[begin:stop]):
            wish = _beside(text, clause.start, stop, language)
            if wish is not None:
                return wish
        rest = text[: clause.start] + found["before"] + text[begin:]
        return Wish(rest, name != "says" and bool(_form(language, "ordered").search(rest)))
    return None


def _beside(text: str, start: int, stop: int, language: str) -> Wish | None:
    """What stands beside the part that tells the wish, if it is an order; else None.

    `Ben wants to see you drive an eight, each circle with 1 m radius`: that is no order of its own.
    """
    if _form(language, "detail").search(text[stop:]):
        return None
    beside = f"{text[:start].rstrip()} {text[stop:].lstrip(_MARKS)}".strip(" ,")
    return Wish(beside) if _form(language, "ordered").search(beside) else None
