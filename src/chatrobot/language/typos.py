"""Mends a mistyped Latin word.

One slip (two in long words) away from exactly one meaning, never across it.
"""

from __future__ import annotations

from functools import lru_cache

from chatrobot.language.lexicon import lexicon

_ANTONYMS = frozenset({"left", "right", "forward", "back", "backward", "clockwise", "anticlockwise"})


def correct(word: str) -> str:
    """The known word that `word` was meant to be, or `word` itself."""
    if not word[0].isalpha() or not word.isascii() or "'" in word:
        return word
    return _correct(word)


@lru_cache(maxsize=4096)
def _correct(word: str) -> str:
    words = lexicon()
    if len(word) < 3:
        return word
    transposed = [w for w in _transpositions(word) if w in words.core and len(w) >= 3]
    if transposed:
        return transposed[0]
    if len(word) < 4:
        return word
    allowed = 1 if len(word) < 8 else 2
    near: dict[str, int] = {}
    for known in words.core:
        if known[0] == word[0] and abs(len(known) - len(word)) <= allowed and len(known) >= 4:
            distance = edit_distance(word, known, allowed)
            if distance <= allowed:
                near[known] = distance
    if not near:
        return word
    least = min(near.values())
    closest = sorted(known for known, distance in near.items() if distance == least)
    if len(set(closest) & _ANTONYMS) > 1 or len({words.words.get((w,), w) for w in closest}) > 1:
        return word
    return closest[0]


def _transpositions(word: str) -> list[str]:
    return [
        word[:i] + word[i + 1] + word[i] + word[i + 2 :]
        for i in range(len(word) - 1)
        if word[i] != word[i + 1]
    ]


def edit_distance(a: str, b: str, limit: int) -> int:
    """Damerau-Levenshtein (adjacent transpositions count one); anything above `limit` is `limit + 1`."""
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, char in enumerate(a, 1):
        new = [i] + [0] * len(b)
        for j, other in enumerate(b, 1):
            new[j] = min(row[j] + 1, new[j - 1] + 1, row[j - 1] + (char != other))
            if i > 1 and j > 1 and char == b[j - 2] and a[i - 2] == other:
                new[j] = min(new[j], before[j - 2] + 1)
        if min(new) > limit:
            return limit + 1
        before, row = row, new
    return row[-1]
