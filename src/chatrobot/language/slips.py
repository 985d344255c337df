"""`Go forward 2, no wait, 1 metre, just 1`: what was meant takes the place of the slip, before anything else is read.

The slip is the last piece of that kind in the clause before: an amount, or a way. What is said again of it goes.
What does not fit so is left as it stands, for the readers behind it to judge (`corrections.py`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from chatrobot.language.lexicon import UNIT, lexicon
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rules import Form, form
from chatrobot.language.tokens import tokenise
from chatrobot.language.typos import correct

_WAYS = frozenset({"side", "line"})
_MEASURES = frozenset({"length", "angle", "time"})
_WORD = re.compile("[a-z]{4,}")
_FRAGMENT = re.compile(r"\b[a-z]{2,4}(?:qx)?…$")
_MOST_SLIPS, _MOST_ECHOES = 6, 2
_FAR = 10.0
"""A bare number is no other amount in the unit of one that is so many times as large, or as small."""


class Piece(NamedTuple):
    """An amount or a way. `start` and `stop` are where it stands; `number` is that before its unit."""

    kind: str
    text: str
    start: int
    stop: int
    number: float = 0.0
    written: str = ""


def without_slips(text: str, language: str) -> str:
    """A normalised text as if it had been said right at once."""
    at = 0
    text = _without_insisted(text, language)
    for _ in range(_MOST_SLIPS):
        slip = _form(language, "slip").search(text, at)
        if slip is None:
            break
        mended = _mended(text, slip, language)
        at = slip.end() if mended is None else 0
        text = text if mended is None else mended
    return text


def _form(language: str, name: str) -> Form:
    return form(language, "slips", name)


def _mended(text: str, slip: re.Match[str], language: str) -> str | None:
    """The text with what was meant in the place of the slip, and no slip; None where that is not sure."""
    end = _form(language, "end").search(text, slip.end())
    stop = end.start() if end else len(text)
    tail = _form(language, "tail").search(text, slip.end())
    said = text[slip.end() : tail.start() if tail and tail.start() <= stop else stop]
    stop = tail.end() if tail and tail.start() <= stop else stop
    has_tail = bool(tail and tail.end() == stop)
    if not (_form(language, "takes").search(slip[0]) or has_tail) or text[stop : stop + 1] == "?":
        return None
    joints = [joint.end() for joint in _form(language, "joint").pattern.finditer(text[: slip.start()])]
    start = joints[-1] if joints else 0
    scope = _WORD.sub(lambda word: _mended_way(word[0], language), text[start : slip.start()])
    meant = pieces(said, language)
    scope = scope + "…" * slip[0].lstrip().startswith(("…", "-"))
    if not meant or _form(language, "unsolved").search(scope) or not _is_known(said, meant, scope, language):
        return None
    put = _put(scope, said, meant, language)
    if put is None:
        return None
    rest = text[stop:]
    whole = _spelt_out(scope, meant, rest, language)
    if whole:
        return text[:start] + " " + whole
    for _ in range(_MOST_ECHOES):
        rest = _without_echo(put, rest, language)
    return text[:start] + put + rest


def pieces(text: str, language: str) -> list[Piece]:
    """The amounts and ways of a text, in order."""
    found = []
    for match in _form(language, "piece").pattern.finditer(text):
        kind = (match.lastgroup or "").rstrip("_")
        number = _form(language, "number").search(match[0]) if kind not in _WAYS else None
        value = _value(number[0]) if number else 0.0
        found.append(Piece(kind, match[0], match.start(), match.end(), value, number[0] if number else ""))
    return found


def _value(written: str) -> float:
    atoms = read_quantities(tokenise(written, lexicon(), {}))
    return atoms[0].number if len(atoms) == 1 and atoms[0].kind == "q" else math.nan


def _mended_way(word: str, language: str) -> str:
    """A mistyped way, as it is written; any other word as it is."""
    ((kind, value), *_) = lexicon().words.get((word,), (("", ""),))
    mended = correct(word) if not kind else value if kind in ("dir", "rot") else word
    return mended if not pieces(word, language) and pieces(mended, language) else word


def _is_known(said: str, found: Sequence[Piece], scope: str, language: str) -> bool:
    """Whether all words beside the pieces are small ones, or were in the clause that they correct."""
    beside = "".join(_beside(said, found))
    known = {*UNIT.findall(scope)}
    return all(
        unit in known or not unit[0].isalnum() or _form(language, "light").fullmatch(unit)
        for unit in UNIT.findall(beside)
    )


def _beside(said: str, found: Sequence[Piece]) -> list[str]:
    begins = [0, *(piece.stop for piece in found)]
    return [said[begin:stop] for begin, stop in zip(begins, [*(p.start for p in found), len(said)])]


def _put(scope: str, said: str, meant: Sequence[Piece], language: str) -> str | None:
    """The clause with what was meant in the place of the slip; None where that is not sure."""
    told = [*pieces(scope, language), *_broken_off(scope, meant)]
    last = scope.rfind(",", 0, told[-1].start) + 1 if told else 0
    targets: list[tuple[Piece, Piece]] = []
    added, is_open = [], False
    for piece in meant:
        noun = _noun(said, piece, language)
        fitting = [each for each in told if _fits(each, piece) and noun in ("", _noun(scope, each, language))]
        is_open |= len(fitting) > 1
        if not fitting:
            added.append(piece)
        elif not _is_near(fitting[-1], piece):
            return None
        else:
            targets.append((fitting[-1], piece))
    if not targets or len({old.start for old, _ in targets}) < len(targets):
        return None
    if is_open and any(old.start < last for old, _ in targets):
        return None  # `20 cm left, 20 cm, no, 30 cm left`
    if added:
        ways = {"way" if piece.kind in _WAYS else piece.kind for piece in told}
        if len(targets) > 1 or any(("way" if p.kind in _WAYS else p.kind) in ways for p in added):
            return None
        old = targets[0][0]
        whole = scope[: old.start] + said[meant[0].start : meant[-1].stop]
        return whole if old is told[-1] else whole + scope[old.stop :]
    for old, new in sorted(targets, key=lambda pair: -pair[0].start):
        alone = new.kind == "number" and old.kind != "number"
        text = old.text.replace(old.written, new.text, 1) if alone else new.text
        scope = scope[: old.start] + text + scope[old.stop :]
    return scope


def _broken_off(scope: str, meant: Sequence[Piece]) -> list[Piece]:
    """`Turn le…, no, right`: the way that was not said to its end, as one of the kind that was meant."""
    cut = _FRAGMENT.search(scope)
    ways = [piece.kind for piece in meant if piece.kind in _WAYS]
    return [Piece(ways[0], cut[0], cut.start(), cut.end())] if cut and ways else []


def _fits(old: Piece, new: Piece) -> bool:
    """Whether one may be said in place of the other."""
    if old.kind == new.kind:
        return True
    return {old.kind, new.kind} in [{"number", kind} for kind in (*_MEASURES, "times")]


def _noun(text: str, piece: Piece, language: str) -> str:
    """What a number without a unit counts; an empty string where nothing stands right behind it."""
    after = UNIT.search(text, piece.stop) if piece.kind == "number" else None
    counts = after is not None and after[0].isalpha() and not _form(language, "light").fullmatch(after[0])
    return after[0] if after is not None and counts else ""


def _is_near(old: Piece, new: Piece) -> bool:
    """Whether a bare number may be in the unit of the slip: `half a metre, no, 75` is in none."""
    if new.kind != "number" or old.kind == "number":
        return True
    return old.number > 0 and 1 / _FAR < new.number / old.number < _FAR


def _spelt_out(scope: str, meant: Sequence[Piece], rest: str, language: str) -> str:
    """What says in full what was meant by a way alone: `right, no, left, so turn 90 left`; an empty string for none."""
    opening = _form(language, "spelt_out").search(rest)
    if opening is None or any(piece.kind not in _WAYS for piece in (*meant, *pieces(scope, language))):
        return ""
    whole = rest[opening.end() :]
    end = _form(language, "end").search(whole)
    told = pieces(whole[: end.start() if end else len(whole)], language)
    ways = [piece.text for piece in told if piece.kind in _WAYS]
    return whole if ways == [piece.text for piece in meant] and len(told) > len(ways) else ""


def _without_echo(put: str, rest: str, language: str) -> str:
    """What follows, without a clause that only says again what was meant: `just 1`, `ninety left`."""
    mark = _form(language, "mark").search(rest)
    if mark is None or _form(language, "next").search(rest):
        return rest
    end = _form(language, "end").search(rest, mark.end())
    stop = end.start() if end else len(rest)
    said = rest[mark.end() : stop]
    again, told = pieces(said, language), pieces(put, language)
    if not again or rest[stop : stop + 1] == "?" or not _is_known(said, again, put, language):
        return rest
    return rest[stop:] if all(any(_is_same(piece, old) for old in told) for piece in again) else rest


def _is_same(piece: Piece, old: Piece) -> bool:
    if piece.kind in _WAYS or (piece.kind == "times" and not piece.written):
        return piece.text == old.text
    return _fits(old, piece) and (piece.number == old.number or piece.written == old.written)


def _without_insisted(text: str, language: str) -> str:
    """`Forty centimetres, yes, forty, not fourteen`: the text without what only says again what was said."""
    found = _form(language, "insisted").search(text)
    if found is None:
        return text
    told = [piece for piece in pieces(text[: found.start()], language) if piece.kind not in _WAYS]
    again = pieces(found["said"], language)
    if not told or not again or not _is_same(again[0], told[-1]):
        return text
    return text[: found.start()] + text[found.end() :]
