"""Titles: a name of what is driven, whose moves are then told one by one. `A zigzag: left 45, 1 m, right 90, 1 m`.

The moves are what is ordered. A name with a measure of its own, and one that is followed by `then`, is an order itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.language.frames import EXTENTS, SIDES, TURN, Frame

_LETTERS = frozenset({"letter_l", "letter_u", "letter_z"})
_OF_LINES = _LETTERS | {"square", "rectangle", "triangle", "polygon", "star", "rhombus", "zigzag", "stairs"}
_OF_BENDS = frozenset({"eight", "sbend", "zigzag"})
_BENDS = frozenset({"circle", "half_circle", "quarter_circle"})
_SETS_OFF = frozenset({"weak", "strong", "colon", "paren"})
"""The marks behind a name that is explained."""


def without_titles(frames: Sequence[Frame]) -> list[Frame]:
    """The frames without the names of what the frames behind them tell."""
    out: list[Frame] = []
    for k, frame in enumerate(frames):
        rest = frames[k + 1 :]
        if _is_headed_by(frame, rest) or _tells_all(frame, rest):
            continue
        named = frame.shape in _OF_LINES and _opens_its_moves(frame, rest)
        out += _moves_in(frame) if named else [frame]
    return out


def _is_headed_by(frame: Frame, rest: Sequence[Frame]) -> bool:
    """先转后走：…: a plan in short, before the colon."""
    if not rest or rest[0].joined != "colon" or frame.verb not in ("", "go", "turn", "make"):
        return False
    bare = not (frame.q or frame.roles or frame.direction or frame.rot or frame.shape or frame.place)
    return bare and sum(1 for each in rest if each.has_extent) >= 2


def _tells_all(frame: Frame, rest: Sequence[Frame]) -> bool:
    """Whether `rest` says how the figure or the turn of `frame` is driven."""
    if frame.shape in _LETTERS and not frame.q:
        return sum("length" in each.q for each in rest) >= 2 and any(_turns(each) for each in rest)
    if not rest or rest[0].joined not in _SETS_OFF or frame.sided or frame.roles or "times" in frame.q:
        return False
    if frame.shape and not frame.q:
        in_bends = frame.shape in _OF_BENDS and sum(_bends(each) for each in rest) >= 2
        return in_bends or (frame.shape in _OF_LINES and _draws_lines(rest))
    return not frame.shape and _is_whole_turn(frame) and _is_told_turn(frame, rest[0])


def _opens_its_moves(frame: Frame, rest: Sequence[Frame]) -> bool:
    """Whether the name and the first move behind it are one frame."""
    told, bare = set(frame.q), not (frame.roles or frame.flags)
    turns = bool(told & {"angle", "number"}) and told <= {"angle", "number", "length"} and bare
    return turns and frame.direction in SIDES and _draws_lines([frame, *rest])


def _moves_in(frame: Frame) -> list[Frame]:
    """`Zigzag: 45 left, 1 m`: the turn and the line behind the name, each by itself."""
    turn, line = frame.copy(), Frame(texts=frame.texts, joined="weak")
    turn.shape = ""
    if "length" in turn.q:
        line.q["length"] = turn.q.pop("length")
    return [turn, line] if line.q else [turn]


def _draws_lines(rest: Sequence[Frame]) -> bool:
    """At least two lines, and a turn: no figure of lines has fewer."""
    lines = sum("length" in each.q for each in rest)
    return lines >= 2 and any(_turns(each) for each in rest)


def _turns(frame: Frame) -> bool:
    told = frame.direction in SIDES and bool(set(frame.q) & {"angle", "number"})
    return frame.turning or frame.verb in TURN or told


def _bends(frame: Frame) -> bool:
    bends = frame.shape in _BENDS or (frame.is_arc and any(name in frame.q for name in EXTENTS))
    return bends and frame.sided


def _is_whole_turn(frame: Frame) -> bool:
    """`Do a twirl`, 掉个头: round once or half, and nobody said which way."""
    if frame.verb == "uturn":
        return not frame.q
    return (
        frame.verb in TURN and set(frame.q) == {"turns"} and math.isclose(frame.q["turns"].number, math.tau)
    )


def _is_told_turn(title: Frame, frame: Frame) -> bool:
    """`…, two full turns to the right`, …，向左转180度: as far as the title says, or whole turns, and which way."""
    said = [frame.q[name].number for name in ("turns", "angle") if name in frame.q]
    if not said or not frame.sided or "length" in frame.q or frame.shape:
        return False
    if title.verb == "uturn":
        return math.isclose(said[0], math.pi)
    return "turns" in frame.q and said[0] >= math.tau - 1e-9
