"""Small sums in words: `if two plus two is four … otherwise …`, which side of a condition holds."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.numbers import read_number
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_CONTENT = ("verb", "dir", "rot", "q", "shape", "place")


@lru_cache(maxsize=1)
def _words() -> dict[str, str]:
    return {
        word: name
        for lang in LANGUAGES
        for name, listed in load_table(lang, "sums").items()
        for word in listed
    }


def is_condition(problem: Unclear) -> bool:
    """Whether a condition is what was not understood: `if something is ahead, turn around`."""
    words, said = lexicon().words, cut(problem.part) if problem.code == "unknown_part" else ()
    meaning = words.get(said) or words.get(said[:1]) or (("", ""),)
    return meaning[0][0] == "condition"


def settle_condition(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms of the branch that holds; unchanged where the condition is no sum."""
    at = next((i for i, a in enumerate(atoms) if a.kind == "condition" and a.value == "if"), None)
    if at is None:
        return list(atoms)
    left = _sum(atoms, at + 1)
    if left is None or left[1] >= len(atoms):
        return list(atoms)
    relation = _words().get(atoms[left[1]].text, "")
    end = left[1] + 1
    while (
        end < len(atoms) and relation and atoms[end].kind in ("glue",) and not _words().get(atoms[end].text)
    ):
        end += 1
    if relation in ("greater", "less", "equal", "unequal"):
        while end < len(atoms) and _words().get(atoms[end].text) in (
            "equal",
            "than",
            "greater",
            "less",
            "unequal",
        ):
            relation = _words()[atoms[end].text] if _words()[atoms[end].text] != "than" else relation
            end += 1
    right = _sum(atoms, end) if relation else None
    if right is None:
        return list(atoms)
    holds = {
        "equal": math.isclose(left[0], right[0]),
        "unequal": not math.isclose(left[0], right[0]),
        "greater": left[0] > right[0],
        "less": left[0] < right[0],
    }.get(relation)
    if holds is None:
        return list(atoms)
    otherwise = next(
        (i for i in range(right[1], len(atoms)) if atoms[i].kind == "condition" and atoms[i].value == "else"),
        None,
    )
    head, yes = list(atoms[:at]), list(atoms[right[1] : otherwise])
    no = [] if otherwise is None else list(atoms[otherwise + 1 :])
    if not any(a.kind in _CONTENT for a in yes):
        head, yes = _said_before(head)
        if holds and any(a.kind == "q" for a in no) and not any(a.kind == "q" for a in yes):
            raise Unclear("condition", " ".join(a.text for a in atoms[at : right[1]]))  # for both branches?
    return [*head, *(yes if holds else no)]


def _said_before(head: list[Atom]) -> tuple[list[Atom], list[Atom]]:
    """`turn right if …, else …`: what comes before the sentence of the condition, and the branch before it."""
    breaks = [i for i, a in enumerate(head) if a.value in ("strong", "then") and a.kind in ("sep", "conn")]
    start = breaks[-1] + 1 if breaks else 0
    return head[:start], head[start:]


def _sum(atoms: Sequence[Atom], i: int) -> tuple[float, int] | None:
    """The value of `three times four plus one` and the index after it."""
    while i < len(atoms) and atoms[i].kind in ("glue", "filler", "sep"):
        i += 1
    first = _number(atoms, i)
    if first is None:
        return None
    value, i = first
    while i < len(atoms):
        operator = _words().get(atoms[i].text, "")
        second = _number(atoms, i + 1) if operator in ("plus", "minus", "times", "over") else None
        if second is None:
            return value, i
        amount, i = second
        if operator == "over" and amount == 0:
            return None
        value = {
            "plus": value + amount, "minus": value - amount, "times": value * amount,
            "over": value / amount if amount else value,
        }[operator]  # fmt: skip
    return value, i


def _number(atoms: Sequence[Atom], i: int) -> tuple[float, int] | None:
    if i < len(atoms) and atoms[i].kind == "q" and atoms[i].value == "number":
        return atoms[i].number, i + 1
    if (
        i < len(atoms)
        and atoms[i].kind == "q"
        and atoms[i].value == "times"
        and re.match(r"[\w ]+ (times|x)$", atoms[i].text)
    ):
        after = _number(atoms, i + 1)
        return (atoms[i].number * after[0], after[1]) if after else None
    number = read_number(atoms, i)
    return (number.value, number.end) if number else None
