"""Mends a mistyped Latin word: one slip of the finger, or written as it sounds, away from exactly one meaning.

A slip is a swapped pair, a letter too many or too few, a neighbouring key, or one vowel for another. Ordinary
words are no typos (`real_words.toml`), and nothing is ever mended across opposites.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache

from chatrobot.language.lexicon import lexicon

_ANTONYMS = frozenset({"left", "right", "forward", "back", "backward", "clockwise", "anticlockwise"})
_OF_MOTION = frozenset({"dir", "rot", "verb", "num", "unit_length", "unit_angle", "unit_time"})
_TRIPLED = re.compile(r"([a-z])\1{2,}")
"""`gooo`, `leeeft`: no word has a letter three times running."""
_ROWS = ("qwertyuiop", "asdfghjkl", "zxcvbnm")
_VOWELS = frozenset("aeiouy")
_SOUNDS = (
    (re.compile(r"tion|sion"), "xn"), (re.compile(r"ph"), "f"), (re.compile(r"ght|gt"), "t"),
    (re.compile(r"c(?=[eiy])"), "s"), (re.compile(r"[ckq]+u?"), "k"), (re.compile(r"wr"), "r"),
    (re.compile(r"z"), "s"), (re.compile(r"(?<=.)[aeiouyhw]"), ""), (re.compile(r"(.)\1+"), r"\1"),
)  # fmt: skip


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
    drawn_out = [
        known for letters in (r"\1", r"\1\1") if (known := _TRIPLED.sub(letters, word)) in words.core
    ]
    if drawn_out and _TRIPLED.search(word):
        return drawn_out[0]
    transposed = [w for w in _transpositions(word) if w in words.core and len(w) >= 3]
    if transposed:
        return transposed[0]
    if len(word) < 4:
        return word
    slips = [known for known in _near_in_length(word) if is_slip(word, known)]
    if not slips and len(word) >= 5:
        slips = [known for known in _by_sound().get(sound(word), ()) if edit_distance(word, known, 2) <= 2]
    if not slips:
        return word
    least = min(edit_distance(word, known, 3) for known in slips)
    closest = sorted(known for known in slips if edit_distance(word, known, 3) == least)
    if len(set(closest) & _ANTONYMS) > 1 or len({words.words.get((w,), w) for w in closest}) > 1:
        return word
    return closest[0]


def neighbours_of(word: str) -> list[str]:
    """The words of motion that one typing error, whichever key it was, makes `word` of; none of a short word."""
    if len(word) < 4 or not word.isalpha() or not word.isascii():
        return []
    meanings = lexicon().words
    near = (known for known in _near_in_length(word) if edit_distance(word, known, 1) <= 1)
    return sorted(known for known in near if meanings.get((known,), (("", ""),))[0][0] in _OF_MOTION)


@lru_cache(maxsize=1)
def _by_start() -> Mapping[tuple[str, int], list[str]]:
    index: dict[tuple[str, int], list[str]] = {}
    for known in lexicon().core:
        if len(known) >= 4:
            index.setdefault((known[0], len(known)), []).append(known)
    return index


@lru_cache(maxsize=1)
def _by_sound() -> Mapping[str, list[str]]:
    index: dict[str, list[str]] = {}
    for known in lexicon().core:
        if len(known) >= 5:
            index.setdefault(sound(known), []).append(known)
    return index


def _near_in_length(word: str) -> list[str]:
    return [
        known
        for length in (len(word) - 1, len(word), len(word) + 1)
        for known in _by_start().get((word[0], length), ())
    ]


def sound(word: str) -> str:
    """The consonants one hears: `strafe` and `straif` are both `strf`."""
    for pattern, heard in _SOUNDS:
        word = pattern.sub(heard, word)
    return word


@lru_cache(maxsize=1)
def _neighbours() -> frozenset[tuple[str, str]]:
    pairs = set()
    for r, row in enumerate(_ROWS):
        for k, key in enumerate(row):
            near = row[max(k - 1, 0) : k + 2] + (_ROWS[r + 1][max(k - 1, 0) : k + 1] if r < 2 else "")
            pairs |= {pair for other in near for pair in ((key, other), (other, key))}
    return frozenset(pairs)


def is_slip(typed: str, meant: str) -> bool:
    """Whether one slip of the finger makes `meant` into `typed`."""
    if len(typed) != len(meant):
        short, long = sorted((typed, meant), key=len)
        return len(long) - len(short) == 1 and any(
            long[:i] + long[i + 1 :] == short for i in range(len(long))
        )
    off = [i for i in range(len(typed)) if typed[i] != meant[i]]
    if len(off) == 2 and off[1] == off[0] + 1:
        return typed[off[0]] == meant[off[1]] and typed[off[1]] == meant[off[0]]
    if len(off) != 1:
        return not off
    pair = (typed[off[0]], meant[off[0]])
    return pair in _neighbours() or set(pair) <= _VOWELS


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
