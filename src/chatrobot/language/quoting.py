"""Words beside an order that quote it, bound it or take it back: a clause with them is no aside to it.

`beside.py` weighs words; these say by where they stand that what is ordered is only told of: `turn left, was his
answer`, `in the film he tells his dragon: …`, `forward 1 m. Actually, leave it`. They are in `beside.toml`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, expand, load_table
from chatrobot.language.signs import Clause, Sign, is_strong

_SKIPPED = frozenset(
    {"oh", "and", "but", "so", "well", "ok", "okay", "please", "ha", "haha", "now", "um", "uh", "just", "hey"}
)
"""Words that only open what is said."""
_TOLD = frozenset({"verdict", "does", "did", "kin", "mine", "condition", "social"})
"""Labels of words of what somebody says, where it is told of: `mum says she is tired`."""
_FEW = 4
"""A clause that only names a measure has so many words at most."""
_THEN = frozenset({"then", "and_then"})


def sentences_of(clauses: Sequence[Clause]) -> list[range]:
    """Where each sentence begins and ends among the clauses."""
    ends = [i + 1 for i, clause in enumerate(clauses) if is_strong(clause.end) or i + 1 == len(clauses)]
    return [range(begin, end) for begin, end in zip([0, *ends], ends)]


def quotes_behind(clause: Clause, *, begins: bool) -> bool:
    """Whether a clause behind the order tells of it as something said or done, or takes it back.

    `begins`: it begins a sentence.
    """
    names = ("points_back", "bounds", "takes_back" if begins else "tells_of_order")
    first, last = (clause.signs[at].text.replace("_", " ") for at in (0, -1))
    speech = _phrases()["speech"]
    if first in speech or (last in speech and clause.signs[0].label != "mine"):  # `as my mum always says`
        return True
    return any(_begins_with(clause, name) for name in names) or any(
        sign.label == "correction" for sign in clause.signs
    )


def quotes_ahead(clause: Clause, order: Clause) -> bool:
    """Whether the clause before the order tells that somebody says it, when it is to be, or points at it."""
    words = [sign.text.replace("_", " ") for sign in clause.signs]
    spoken = [
        at for at, word in enumerate(words) if at and word in _phrases()["speech"] and words[at - 1] != "to"
    ]
    if spoken and not any(sign.label in _TOLD for sign in clause.signs[spoken[-1] + 1 :]):
        return True
    if order.signs[0].text in _THEN:  # `he comes at four. Then go forward`
        return True
    if words[-1] in _phrases()["points_ahead"] or _begins_with(clause, "bounds"):
        return True
    before = words[-2] if is_strong(clause.end) and words[-1] == "this" and len(words) > 1 else ""
    if before and before not in _phrases()["not_pointing"]:
        return True
    return any(a == "this" and b in _phrases()["after_this"] for a, b in itertools.pairwise(words[1:]))


def holds_back(clauses: Sequence[Clause]) -> bool:
    """Whether the last sentence takes back or quotes what was ordered: `forward 1 m. Oh, hang on, Tom is there`.

    It has no word of motion but what holds back.
    """
    sentences = sentences_of(clauses)
    if len(sentences) < 2 or any(_is_motion(sign) for i in sentences[-1] for sign in clauses[i].signs):
        return False
    last = [clauses[i] for i in sentences[-1]]
    held = len(last) > 1 and any(_begins_with(clause, "takes_back") for clause in last)
    return held or _begins_with(last[0], "points_back")


def names_measure(clause: Clause) -> bool:
    """`Identical distance`, 距离不变: whether all it does is name what an order has an amount of."""
    words = [sign.text for sign in clause.signs]
    if len(words) > _FEW or any(sign.label in {*_TOLD, "not"} for sign in clause.signs):
        return False
    if any(word.isascii() for word in words):
        return any(word in _phrases()["measures"] for word in words)
    return any(name in "".join(words).replace("_", "") for name in _phrases()["measures"])


def _is_motion(sign: Sign) -> bool:
    return sign.moves and sign.label.isupper() and sign.text.replace("_", " ") not in _phrases()["takes_back"]


def _begins_with(clause: Clause, name: str) -> bool:
    """Whether it begins with one of those phrases, after words that only open it."""
    words = [sign.text.replace("_", " ") for sign in clause.signs]
    while len(words) > 1 and words[0] in _SKIPPED:
        words.pop(0)
    return any(" ".join(words[:length]) in _phrases()[name] for length in range(1, 4))


@lru_cache(maxsize=1)
def _phrases() -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for code in LANGUAGES:
        for name, patterns in load_table(code, "beside").items():
            found.setdefault(name, set()).update(
                written for pattern in patterns for written in expand(pattern)
            )
    return {name: frozenset(written) for name, written in found.items()}
