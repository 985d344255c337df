"""The features of a clause beside an order, by which `beside.py` tells an aside from what bears on the order.

Runs of labels, of words, and of both: in the last, words that many people use stand for themselves, and all others
for how they end. `so the ? can get by` is the same for a cart and a calf.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

from chatrobot.language.data_files import DATA
from chatrobot.language.signs import Clause, Sign, is_strong

COMMON_WORDS = DATA / "beside_words.txt"
"""Words that many of the writers use whose sentences the weights are fitted to, one a line."""
_ENDINGS = ("stqx", "tqx", "enqx", "qx", "ing", "ed", "ly", "er", "est", "s")
_LEAST_OF_WORD = 2


def features(clauses: Sequence[Clause], i: int, order: int) -> Iterator[str]:
    """The features of clause `i` beside clause `order`."""
    clause = clauses[i]
    signs = clause.signs
    labels = ["^", *(sign.known_label for sign in signs), "$"]
    texts = ["^", *(sign.text for sign in signs), "$"]
    side = "<" if i < order else ">"
    mark = "." if is_strong(clause.end) and clause.end != "?" else clause.end
    yield "bias"
    yield from _of_frame(clause, side, mark)
    yield f"m{side}{mark}"
    yield f"n{min(len(signs), 7)}"
    yield f"o{side}{labels[1]}"
    yield f"h{side}{texts[1]}"
    yield f"z{mark}{labels[-2]}"
    for at in range(1, len(labels)):
        yield f"1{labels[at]}"
        yield f"2{labels[at - 1]} {labels[at]}"
        yield f"b{texts[at - 1]} {texts[at]}"
        if at > 1:
            yield f"3{labels[at - 2]} {labels[at - 1]} {labels[at]}"
        if at < len(labels) - 1:
            yield f"w{texts[at]}"
            if labels[at] == "?" and texts[at].isascii():
                yield f"s{texts[at][-2:]}"
    for label in {label for label in labels[1:-1] if label != "?"}:
        yield f"l{side}{label}"


def _of_frame(clause: Clause, side: str, mark: str) -> Iterator[str]:
    """Runs of its common words and of what the others are like, with gaps, and how it begins and ends."""
    words = ["^", *map(frame_word, clause.signs), "$"]
    for at in range(len(words) - 1):
        yield f"F2{words[at]} {words[at + 1]}"
        yield f"F3{' '.join(words[at : at + 3])}"
        if at + 2 < len(words):
            yield f"H{words[at]} _ {words[at + 2]}"
        if at + 3 < len(words):
            yield f"G{words[at]} _ _ {words[at + 3]}"
    yield f"I{side}{' '.join(words[1:3])}"
    yield f"J{side}{' '.join(words[1:4])}"
    yield f"K{side}{' '.join(words[-3:-1])}{mark}"
    yield from (f"W{side}{word}" for word in words[1:-1])


def frame_word(sign: Sign) -> str:
    """The word if many people use it, else its class or how it ends."""
    if sign.text in common_words():
        return sign.text
    if sign.label != sign.text:
        return f"[{sign.label}]"
    for ending in _ENDINGS:
        if sign.text.endswith(ending) and len(sign.text) > len(ending) + _LEAST_OF_WORD:
            return f"?{ending}"
    return "?"


@lru_cache(maxsize=1)
def common_words() -> frozenset[str]:
    """The words that stand for themselves among the features."""
    return frozenset(COMMON_WORDS.read_text(encoding="utf-8").split())
