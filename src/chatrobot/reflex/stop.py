"""Is this a stop? Whole words and phrases, never substrings; Chinese is cut by the longest phrase.

A text is cut into units: Latin words and single Chinese characters. Where it is no stop as it stands, it may be one
with a mistake in it: one edit in letters, the same pinyin in Chinese. A word of the dictionary is no mistake.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, lru_cache

from chatrobot.reflex import words
from chatrobot.reflex.words import ALL

_WORD = re.compile(r"[a-zß-öø-ÿ0-9]+(?:['’][a-zß-öø-ÿ]+)*|[\u3400-\u9fff]")
_STRETCHED, _DOUBLED = re.compile(r"(.)\1{2,}"), re.compile(r"(.)\1+")
_WIDE = {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)}
_FOLD = str.maketrans(words.ALL.fold)

Phrase = tuple[str, ...]
Table = dict[str, set[Phrase]]
"""Phrases by their first unit."""


@lru_cache(maxsize=32)
def units_of(text: str) -> Phrase:
    """Several questions are asked about one text: it is cut once."""
    lowered = text.translate(_WIDE).lower().replace("’", "'").replace("-", " ").translate(_FOLD)
    return tuple(_unstretched(word) if _DOUBLED.search(word) else word for word in _WORD.findall(lowered))


def _unstretched(word: str) -> str:
    """`stoooop` → `stop`, `haaalt` → `halt`; other words stay, and so does `stoop`, which is one."""
    short = _STRETCHED.sub(r"\1", word)
    single = _DOUBLED.sub(r"\1", short)
    return single if single in words.ALL.stretched and word not in words.ALL.not_stretched else short


def phrases(*groups: tuple[str, ...]) -> Table:
    """By their first unit."""
    found: Table = {}
    for group in groups:
        for phrase in group:
            units = units_of(phrase)
            found.setdefault(units[0], set()).add(units)
    return found


def matches(units: Phrase, i: int, table: Table) -> list[Phrase]:
    """The phrases that begin there."""
    return [p for p in table.get(units[i], ()) if units[i : i + len(p)] == p]


def consists(units: Phrase, table: Table, fillers: Table) -> bool:
    """Tell whether phrases of `table` (at least one) and fillers cover all of `units`."""
    reached = {0: False}
    for i in range(len(units)):
        if i not in reached:
            continue
        for phrase in matches(units, i, table):
            reached[i + len(phrase)] = True
        for phrase in matches(units, i, fillers):
            reached[i + len(phrase)] = reached.get(i + len(phrase), False) or reached[i]
    return reached.get(len(units), False)


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
        """Tell whether stops (at least one) and what may stand beside them make up all of `units`."""
        if len(units) > MOST_UNITS:
            return False
        reached = {0: False}
        for begin in range(len(units)):
            if begin in reached:
                for end, is_stop in self._found(units, begin):
                    reached[end] = reached.get(end, False) or reached[begin] or is_stop
        return reached.get(len(units), False)

    def _found(self, units: Phrase, begin_index: int) -> Iterator[tuple[int, bool]]:
        """Return where the phrases end that begin there, and whether each is a stop."""
        for phrase in matches(units, begin_index, self._stops):
            yield begin_index + len(phrase), True
        for phrase in matches(units, begin_index, self._fillers):
            yield begin_index + len(phrase), False
        for end in range(begin_index + 1, min(begin_index + self._most_units, len(units)) + 1):
            window = units[begin_index:end]
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
    """Tell whether a letter too many, too few or another, or two letters swapped, make one of the other."""
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


MAX_CHARACTERS = 300
"""A longer utterance is no stop as a whole; its beginning is still looked at."""

_BREAK = re.compile(r"[.,;!?…。，；！？\n—]+|\s-+\s|\.\.+")

_STOP = phrases(ALL.stop, ALL.pause, ALL.emergency)
_EMERGENCY = phrases(ALL.emergency)
_RELEASE = phrases(ALL.release)
_RELEASE_FILLER = phrases(ALL.release_filler)
_FILLER = phrases(ALL.filler)
_PAUSE = phrases(ALL.pause)
_PAUSE_FILLER = phrases(ALL.pause_filler)
_CANCELLED = phrases(ALL.cancelled, ALL.taken_back)
_TAKEN_BACK = phrases(ALL.taken_back)
_OTHER_WORDS = phrases(ALL.other_words)
_FORBIDS = phrases(ALL.forbids)
_NOT_LEADING = {units_of(phrase) for phrase in ALL.not_leading}
_DURATION_BUT = {units_of(word) for word in ALL.duration_but}
_DURATION_WORDS = {units_of(word)[0] for word in ALL.duration_words}


def _forbids_stopping(units: Phrase) -> bool:
    """别停, 不要停下, `don't stop`: the opposite of a stop."""
    return any(
        units[i + len(phrase)].startswith(ALL.forbidden)
        for i in range(len(units))
        for phrase in matches(units, i, _FORBIDS)
        if i + len(phrase) < len(units)
    )


def is_stop(text: str) -> bool:
    """Tell whether the whole utterance is a stop: stop phrases and fillers, nothing else. For a standing robot."""
    if len(text) > MAX_CHARACTERS:
        return False
    units = units_of(text)
    if not units or _forbids_stopping(units) or units in _OTHER_WORDS.get(units[0], ()):
        return False
    return consists(units, _STOP, _FILLER) or _takes_back(text)


def _takes_back(text: str) -> bool:
    """`往前……算了算了，别走了`: a command that breaks off, then taken back to the end."""
    parts = [part for part in _BREAK.split(text) if units_of(part)]
    if len(parts) < 2 or not consists(units_of(parts[-1]), _CANCELLED, _FILLER):
        return False
    broken = re.search(r"…|\.\.|—|--|\s-\s", text) is not None
    if not broken and not consists(units_of(parts[-1]), _TAKEN_BACK, _FILLER):
        return False
    tail = len(parts) - 1
    while tail > 0 and consists(units_of(parts[tail - 1]), _CANCELLED | _STOP, _FILLER):
        tail -= 1
    return tail <= 1 or broken


def leads_with_stop(text: str) -> bool:
    """Tell whether a stop leads, or ends, the utterance. For a moving robot: the rest does not matter."""
    if is_stop(text):
        return True
    units = units_of(text[:MAX_CHARACTERS])
    if _forbids_stopping(units):
        return False
    first = next((part for part in _BREAK.split(text[:MAX_CHARACTERS]) if units_of(part)), "")
    if is_stop(first) and units_of(first) not in _NOT_LEADING:
        return True  # `halt, nicht nach links`: no `halt nicht`
    i = 0
    while i < len(units) and not _is_other_word(units, i):
        found = [p for p in matches(units, i, _STOP) if p not in _NOT_LEADING]
        if found and not _is_no_stop(units[i + max(len(p) for p in found) :]):
            return True
        fillers = matches(units, i, _FILLER)
        if not fillers:
            break
        i += max(len(p) for p in fillers)
    if _leads_mistyped(text):
        return True
    parts = [part for part in _BREAK.split(text[-MAX_CHARACTERS:]) if units_of(part)]
    return len(parts) > 1 and consists(units_of(parts[-1]), _CANCELLED, _FILLER)


def _leads_mistyped(text: str) -> bool:
    """Tell whether the text, or its first clauses, is a stop with a mistake in it and what is said beside one."""
    clauses = [units for part in _BREAK.split(text[:MAX_CHARACTERS]) if (units := units_of(part))]
    beginnings = [sum(clauses[: count + 1], ()) for count in range(len(clauses))]
    return any(_mistyped_stop().covers(units) and not consists(units, _STOP, _FILLER) for units in beginnings)


def is_pause(text: str) -> bool:
    """Tell whether a stop asks to keep what was under way: pause words and politeness, nothing else.

    Where it is not sure, it is a stop like any other.
    """
    units = units_of(text) if len(text) <= MAX_CHARACTERS else ()
    if not units or consists(units, _PAUSE, _PAUSE_FILLER):
        return bool(units)
    # A plain stop never waits until the table of mistyped pauses has been made: that takes 30 ms, once.
    return not consists(units, _STOP, _FILLER) and _mistyped_pause().covers(units)


@cache
def _mistyped_stop() -> Mistyped:
    return Mistyped(_STOP, _FILLER, _CANCELLED)


@cache
def _mistyped_pause() -> Mistyped:
    return Mistyped(
        _PAUSE, _PAUSE_FILLER, phrases(ALL.stop, ALL.pause, ALL.filler, ALL.cancelled, ALL.taken_back)
    )


def _is_other_word(units: Phrase, begin_index: int) -> bool:
    """停车场 and 不停: a longer word than the stop in it."""
    return any(
        not any(len(stop) >= len(word) for stop in matches(units, begin_index, _STOP))
        for word in matches(units, begin_index, _OTHER_WORDS)
    )


def _is_no_stop(following: Phrase) -> bool:
    """`stop-sign shape` is a noun, and 停一秒 or `stop for two seconds` is a pause, by what follows the stop."""
    if not following:
        return False
    if following[0] in ALL.nouns_after or following[0] in ALL.times_after or following[0][0].isdigit():
        return True
    return following[0] in _DURATION_WORDS and following[1:2] not in ((), *_DURATION_BUT)


def is_emergency_stop(text: str) -> bool:
    """Tell whether the whole utterance is an emergency stop (which is a stop, too)."""
    if len(text) > MAX_CHARACTERS:
        return False
    units = units_of(text)
    if not units:
        return False
    has = any(matches(units, i, _EMERGENCY) for i in range(len(units)))
    return has and consists(units, _STOP, _FILLER)


def is_release(text: str) -> bool:
    """Tell whether the whole utterance asks to release the emergency stop. Here it is better to miss one."""
    units = units_of(text) if len(text) <= MAX_CHARACTERS else ()
    return bool(units) and consists(units, _RELEASE, _RELEASE_FILLER)
