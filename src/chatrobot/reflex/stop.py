"""Is this a stop? Whole words and phrases, never substrings; Chinese is cut by the longest phrase."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.reflex.mistyped import Mistyped
from chatrobot.reflex.phrases import Phrase, consists, matches, phrases, units_of
from chatrobot.reflex.words import ALL

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
    """Whether the whole utterance is a stop: stop phrases and fillers, nothing else. For a standing robot."""
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
    """Whether a stop leads, or ends, the utterance. For a moving robot: the rest does not matter."""
    if is_stop(text):
        return True
    units = units_of(text[:MAX_CHARACTERS])
    if _forbids_stopping(units):
        return False
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
    """Whether the text, or its first clauses, is a stop with a mistake in it and what is said beside one."""
    clauses = [units for part in _BREAK.split(text[:MAX_CHARACTERS]) if (units := units_of(part))]
    beginnings = [sum(clauses[: count + 1], ()) for count in range(len(clauses))]
    return any(_mistyped_stop().covers(units) and not consists(units, _STOP, _FILLER) for units in beginnings)


def is_pause(text: str) -> bool:
    """Whether a stop asks to keep what was under way: pause words and politeness, nothing else.

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


def _is_other_word(units: Phrase, begin: int) -> bool:
    """停车场 and 不停: a longer word than the stop in it."""
    return any(
        not any(len(stop) >= len(word) for stop in matches(units, begin, _STOP))
        for word in matches(units, begin, _OTHER_WORDS)
    )


def _is_no_stop(following: Phrase) -> bool:
    """`stop-sign shape` is a noun, and 停一秒 or `stop for two seconds` is a pause, by what follows the stop."""
    if not following:
        return False
    if following[0] in ALL.nouns_after or following[0] in ALL.times_after or following[0][0].isdigit():
        return True
    return following[0] in _DURATION_WORDS and following[1:2] not in ((), *_DURATION_BUT)


def is_emergency_stop(text: str) -> bool:
    """Whether the whole utterance is an emergency stop (which is a stop, too)."""
    if len(text) > MAX_CHARACTERS:
        return False
    units = units_of(text)
    if not units:
        return False
    has = any(matches(units, i, _EMERGENCY) for i in range(len(units)))
    return has and consists(units, _STOP, _FILLER)


def is_release(text: str) -> bool:
    """Whether the whole utterance asks to release the emergency stop. Here it is better to miss one."""
    units = units_of(text) if len(text) <= MAX_CHARACTERS else ()
    return bool(units) and consists(units, _RELEASE, _RELEASE_FILLER)
