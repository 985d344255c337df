"""Finds a stop phrase with a mistake in it: one edit where it is written in letters, the same pinyin where in Chinese.

A word of the dictionary is no mistake. Each phrase and each polite word beside it may have an edit of its own.
"""

from __future__ import annotations

from collections.abc import Iterator

from chatrobot.reflex.phrases import Phrase, Table, matches
from chatrobot.reflex.words import ALL

LEAST_LETTERS = 4
"""A shorter phrase is too near to too many others."""

MOST_UNITS = 24
"""A longer text is no stop with a mistake in it."""


class Mistyped:
    """Stop phrases, and what may stand beside them, as they may be mistyped.

    Args:
        known: whose words are no mistakes either.
    """

    def __init__(self, stops: Table, fillers: Table, known: Table) -> None:
        self._stops = stops
        self._fillers = fillers
        self._known = {*ALL.real_words, *(word for found in known.values() for p in found for word in p)}
        self._by_length: dict[int, list[tuple[str, bool]]] = {}
        self._sounds: set[Phrase] = set()
        self._most_units = 2
        for table, is_stop in ((stops, True), (fillers, False)):
            for phrase in (phrase for found in table.values() for phrase in found):
                self._learn(phrase, is_stop=is_stop)

    def _learn(self, phrase: Phrase, *, is_stop: bool) -> None:
        self._known.update(phrase)
        written = " ".join(phrase)
        if written.isascii():
            if sum(letter.isalpha() for letter in written) >= LEAST_LETTERS:
                self._by_length.setdefault(len(written), []).append((written, is_stop))
                self._most_units = max(self._most_units, len(phrase) + 1)
        elif is_stop and len(phrase) > 1:
            self._sounds.add(_sound(phrase))

    def covers(self, units: Phrase) -> bool:
        """Whether stops (at least one) and what may stand beside them make up all of `units`."""
        if len(units) > MOST_UNITS:
            return False
        reached = {0: False}
        for begin in range(len(units)):
            if begin in reached:
                for end, is_stop in self._found(units, begin):
                    reached[end] = reached.get(end, False) or reached[begin] or is_stop
        return reached.get(len(units), False)

    def _found(self, units: Phrase, begin: int) -> Iterator[tuple[int, bool]]:
        """Where the phrases end that begin there, and whether each is a stop."""
        for phrase in matches(units, begin, self._stops):
            yield begin + len(phrase), True
        for phrase in matches(units, begin, self._fillers):
            yield begin + len(phrase), False
        for end in range(begin + 1, min(begin + self._most_units, len(units)) + 1):
            window = units[begin:end]
            if not all(unit.isascii() for unit in window):
                if self._sounds_like_a_stop(window):
                    yield end, True
            elif not self._known.issuperset(window):  # one of its words is none: a mistake
                yield from ((end, is_stop) for is_stop in self._one_edit_from(window))

    def _one_edit_from(self, window: Phrase) -> Iterator[bool]:
        """For each phrase that this may have been meant as: whether it is a stop."""
        typed = " ".join(window)
        for length in (len(typed) - 1, len(typed), len(typed) + 1):
            for written, is_stop in self._by_length.get(length, ()):
                if is_one_edit(typed, written):
                    yield is_stop

    def _sounds_like_a_stop(self, window: Phrase) -> bool:
        return _sound(window) in self._sounds and "".join(window) not in self._known


def _sound(units: Phrase) -> Phrase:
    return tuple(ALL.sounds.get(unit, unit) for unit in units)


def is_one_edit(a: str, b: str) -> bool:
    """Whether a letter too many, too few or another, or two letters swapped, make one of the other."""
    if a == b:
        return False
    i = 0
    while i < len(a) and i < len(b) and a[i] == b[i]:
        i += 1
    if len(a) > len(b):
        return a[i + 1 :] == b[i:]
    if len(a) < len(b):
        return a[i:] == b[i + 1 :]
    is_swapped = a[i : i + 2] == b[i : i + 2][::-1] and a[i + 2 :] == b[i + 2 :]
    return is_swapped or a[i + 1 :] == b[i + 1 :]
