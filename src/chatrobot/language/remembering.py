"""Clauses that name the place where the robot stands, before, after or between motions."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable

from chatrobot.language import forms, rules
from chatrobot.language.acts import MAYBE_ORDER, order_log_odds, read_acts
from chatrobot.language.command import steps_of
from chatrobot.language.interpretation import Interpretation, planned
from chatrobot.language.phrases import say
from chatrobot.language.reading import Reading
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Remember, Step

_CONNECTS = r"\b(?:and then|then|and)\b|然后|接着|再|并且|并|之后"
_BREAKS = re.compile(
    r"(?<!\d)[,.;!?](?!\d)|(?<=\d)[,.;!?](?=\s|$)|[,.;!?]\s|,|\n|"
    rf"{_CONNECTS}"
)

_OPENS = re.compile(rf"^(?:[,.;!?。 ]|{_CONNECTS})+")


def read_remembering(plain: str, reading: Reading) -> Interpretation | None:
    """What `plain` means if some clause of it names this place; else None.

    Raises:
        Unclear: where the rest of it is no command.
    """
    whole = forms.read_place_told(plain, reading.language)
    if whole:
        return _placed([Remember(whole)], reading)
    whole = forms.read_place(plain, reading.language)
    if whole and not _BREAKS.search(plain.strip(" ,.!;?")):
        return _placed([Remember(whole)], reading)
    clauses = _clauses(plain)
    names = [forms.read_place(clause, reading.language) for clause in clauses]
    if not any(names):
        return _placed([Remember(whole)], reading) if whole else None
    steps: list[Step] = []
    pending = ""
    for k, (clause, name) in enumerate(zip(clauses, names)):
        if name is None:
            pending += clause
            continue
        steps += steps_of(pending, reading)
        pending = ""
        following = names[k + 1] if k + 1 < len(names) else None
        if not (name == forms.UNNAMED and following):
            steps.append(Remember(name))
    return _placed([*steps, *steps_of(pending, reading)], reading)


def read_named_here(plain: str, reading: Reading, read: Callable[[str], list[Step]]) -> Interpretation | None:
    """What a normalised text means that names this place in one of its parts; None for any other text.

    What moves nothing beside it is passed over; the rest is what `read` makes of it.
    """
    taught = forms.read_definition(plain, reading.language)
    if taught is not None and any(act.clause.moves for act in read_acts(taught.body)):
        return None
    for pattern in rules.forms(reading.language, "naming", "here"):
        found = pattern.search(plain)
        name = forms.trimmed(found["name"], reading.language) if found else ""
        if not found or not name:
            continue
        try:
            before, after = (
                _moving_steps(part, read) for part in (plain[: found.start()], plain[found.end() :])
            )
        except Unclear:
            continue
        if found.groupdict().get("there") and not before:
            continue  # `the place there` is none, where no motion leads to it
        whole = plain[: found.start()].rstrip(" ,;") + plain[found.end() :]
        return _placed([*before, Remember(name), *_going_on(before, after, whole, read)], reading)
    return None


def _going_on(
    before: list[Step], after: list[Step], whole: str, read: Callable[[str], list[Step]]
) -> list[Step]:
    """What is done behind the naming, read with what stands before it: `go 2 m, …, then go back`."""
    if not before or not after:
        return after
    with contextlib.suppress(Unclear):
        together = read(whole)
        if together[: len(before)] == before and len(together) > len(before):
            return together[len(before) :]
    return after


def _moving_steps(part: str, read: Callable[[str], list[Step]]) -> list[Step]:
    reads = read_acts(part)
    bound = any(sign.label == "condition" for act in reads for sign in act.clause.signs)
    told = bound or any(act.clause.tells for act in reads)
    return read(_OPENS.sub("", part)) if told or order_log_odds(reads) >= MAYBE_ORDER else []


def _placed(steps: list[Step], reading: Reading) -> Interpretation:
    if len(steps) == 1 and isinstance(steps[0], Remember):
        reply = say(reading.language, "place_remembered", place=steps[0].place)
        return Interpretation("answered", reply, reading.language, remember_place=steps[0].place)
    return planned(steps, reading.language)


def _clauses(text: str) -> list[str]:
    """The text cut before and after each break, nothing lost."""
    parts, at = [], 0
    for found in _BREAKS.finditer(text):
        parts.append(text[at : found.start()])
        parts.append(found.group())
        at = found.end()
    parts.append(text[at:])
    merged: list[str] = []
    for part in parts:
        if merged and not part.strip():
            merged[-1] += part
        else:
            merged.append(part)
    return merged
