"""Atoms → frames, one a motion: cut where a slot is filled twice, joined across commas by `joining`."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from chatrobot.language.frames import EXTENTS, SLOTTED, STILL, TURN, Frame
from chatrobot.language.joining import joined_frame
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_ALL_AGAIN = ("重复", "反复", "do that", "do this", "do it", "do so", "repeat")
_STRENGTH = {"start": 0, "and": 1, "weak": 2, "colon": 3, "strong": 4, "then": 5}


@dataclass
class Segment:
    """What stands between two separators."""

    joined: str
    frames: list[Frame]


def read_frames(atoms: Sequence[Atom]) -> list[Frame]:
    """The frames of an utterance, in order.

    Raises:
        Unclear: for a word that nothing accounts for.
    """
    frames: list[Frame] = []
    drawing = any(atom.kind == "shape" for atom in atoms)
    segments = _segments(atoms, drawing)
    each = any(atom.kind == "flag" and atom.value in ("each", "all") for atom in atoms) or _is_a_route(
        segments
    )
    after_then = {_motion(segment.frames[0]) for segment in segments if segment.joined == "then"}
    for segment in segments:
        first = segment.frames[0]
        if frames and _said_again(frames[-1], first) and (each or _motion(first) in after_then):
            frames.extend(segment.frames)  # 前进，前进，再前进，每次半米: they are counted, not urged
        else:
            _join(frames, segment)
    frames = _counted_pairs(_marked_ends(frames))
    loose = next((frame for frame in frames if _hangs_loose(frame)), None)
    if loose is not None and not drawing:
        raise Unclear("unclear_motion", loose.text)
    for still, after in itertools.pairwise(frames):
        held = still.verb in STILL and still.text == "hold" and not still.q
        if held and after.joined == "none" and after.direction:
            raise Unclear(
                "unclear_motion", f"{still.text} {after.text}"
            )  # `hold right`: to wait, or to turn?
    return frames


def _is_a_route(segments: Sequence[Segment]) -> bool:
    """`Left, left, right`: ways and nothing else, and not all the same."""
    bare = [s.frames[0] for s in segments if len(s.frames) == 1 and len(s.frames[0].texts) <= 1]
    ways = {frame.direction for frame in bare if frame.direction}
    return len(bare) == len(segments) > 2 and len(ways) > 1


def _motion(frame: Frame) -> tuple[str, str, str]:
    return frame.verb, frame.direction, frame.rot


def _said_again(last: Frame, first: Frame) -> bool:
    """The same motion in the same words, without an amount between them."""
    way = first.direction or first.rot
    return (
        bool(way) and _motion(last) == _motion(first) and not (last.has_extent or last.shape or first.shape)
    )


def _counted_pairs(frames: list[Frame]) -> list[Frame]:
    """`forward 1 m and back 1 m three times`, `… and turn left 90 degrees three times`: both are counted.

    Raises:
        Unclear: for a turn without an angle, which may be counted alone.
    """
    if len(frames) < 2 or "times" not in frames[1].q or "times" in frames[0].q:
        return frames
    first, second = frames[0], frames[1].copy()
    plain = not (first.shape or second.shape or first.place or second.place)
    if not plain or not first.has_extent or second.joined == "strong" or _is_counted_first(second):
        return frames
    side = second.verb == "turn" and second.sided and not second.flags and first.verb not in TURN
    if side and second.joined == "and" and not second.has_extent and "number" not in second.q:
        raise Unclear("unclear_motion", second.text)
    pause = second.verb == "wait" and "time" in second.q and not second.flags
    together = second.joined == "and" and (pause or (side and _is_corner(second)))
    if not (together or _is_way_and_back(first, second)):
        return frames
    count = Frame(joined="weak", q={"times": second.q.pop("times")})
    return [first, second, count, *frames[2:]]


def _is_counted_first(frame: Frame) -> bool:
    """`… and turn twice 90 degrees`: what is told before its amount counts that alone."""
    said = [frame.q[name].text for name in ("length", "angle", "time", "turns") if name in frame.q]
    texts, count = frame.texts, frame.q["times"].text
    return count in texts and any(text in texts[texts.index(count) :] for text in said)


def _is_corner(turn: Frame) -> bool:
    """Whether it turns, and not all the way round."""
    said = turn.q.get("angle") or turn.q.get("number")
    return said is not None and said.number not in (360.0, 720.0) and not _is_round(said.number)


def _is_round(angle_rad: float) -> bool:
    return abs(math.remainder(angle_rad, 2 * math.pi)) < 1e-6


def _is_way_and_back(out: Frame, back: Frame) -> bool:
    """Opposite ways; as far, too, after a comma or `then`: not `forward 1.5 m, then back 50 cm three times`."""
    ways = {out.direction, "back" if back.verb == "return" and not back.direction else back.direction}
    far = [{name: frame.q[name].number for name in EXTENTS if name in frame.q} for frame in (out, back)]
    opposite = ways in ({"forward", "back"}, {"left", "right"}) and all(far)
    return opposite and (back.joined in ("and", "none") or far[0] == far[1])


def _marked_ends(frames: list[Frame]) -> list[Frame]:
    """`finally`, `after all that`: what follows is outside of a loop that was announced before."""
    for frame in frames:
        if "finally" in frame.flags:
            frame.flags.discard("finally")
            frame.opens = True
    return [frame for frame in frames if not frame.is_empty or frame.words]


def _hangs_loose(frame: Frame) -> bool:
    """An amount that fitted nowhere: `bend right 30 degrees over a metre` is no bend and then a metre straight on."""
    return frame.joined == "none" and frame.has_extent and not (frame.moves or frame.words or frame.flags)


def _segments(atoms: Sequence[Atom], drawing: bool) -> list[Segment]:
    segments: list[Segment] = []
    joined, opens = "start", False
    pending: list[Atom] = []
    for atom in (*atoms, Atom("sep", "strong")):
        separator = _separator(atom)
        if separator is None:
            pending.append(atom)
            continue
        frames = _split(pending, drawing)
        ends = separator == "strong" or (bool(pending) and pending[-1].text == ")")
        if frames:
            frames[0].joined, frames[0].opens = joined, opens
            segments.append(Segment(joined, frames))
            joined, opens = separator, ends
        else:
            joined, opens = max(joined, separator, key=lambda s: _STRENGTH[s]), opens or ends
        pending = []
    return segments


def _separator(atom: Atom) -> str | None:
    if atom.kind == "conn":
        return atom.value
    if atom.kind == "sep":
        return None if atom.value == "paren" else atom.value
    return None


def _split(atoms: list[Atom], drawing: bool = False) -> list[Frame]:
    """The frames of a stretch without separators."""
    bearing = [a for a in atoms if a.kind == "flag" and a.value == "bearing"]
    atoms = [*bearing, *[a for a in atoms if a not in bearing]]
    curve = next((a for a in atoms if a.kind == "verb" and a.value == "curve"), None)
    if curve is not None and not any(a.kind == "shape" for a in atoms):
        atoms = [curve, *[a for a in atoms if a is not curve and a.value not in ("go", "shift")]]
    frames: list[Frame] = []
    current = Frame()
    for i, atom in enumerate(atoms):
        if atom.kind in ("filler", "glue", "sep", "reason"):
            continue
        if atom.kind not in SLOTTED:
            raise Unclear("unknown_part", _around(atoms, i))
        rest = atoms[i + 1 :]
        if (
            _repeats_all(atom, rest, current)
            or _counts_run(atom, rest, frames, current)
            or _pauses_between(atom, rest, current)
        ):
            frames.append(current)
            current = Frame(joined="weak")
        if not current.add(atom):
            if _is_bare_direction(current):
                raise Unclear("contradiction", f"{current.text} {atom.text}".strip())
            if (
                atom.kind == "q"
                and atom.value == "length"
                and current.verb in TURN
                and not current.has_extent
            ):
                raise Unclear("length_for_turn", f"{current.text} {atom.text}")
            repeated = atom.kind == "q" and atom.value in current.q and atom.value in EXTENTS
            if repeated and not (drawing or current.shape or current.roles):
                raise Unclear("contradiction", f"{current.text} {atom.text}")
            frames.append(current)
            current = Frame(joined="none")
            if not current.add(atom):
                raise Unclear("unknown_part", atom.text)
    if frames and "times" in current.q and "each" in current.flags and "each" not in frames[-1].flags:
        raise Unclear("unclear_motion", current.text)  # `spin left spin right 3 times each`
    if not current.is_empty:
        frames.append(current)
    return frames


def _repeats_all(atom: Atom, rest: list[Atom], current: Frame) -> bool:
    """`… turn left 90 repeat that 4 times`, …左转九十度重复四遍: all that was said before, not the last part alone."""
    again = atom.kind == "flag" and atom.value == "again" and atom.text.startswith(_ALL_AGAIN)
    counted = bool(rest) and rest[0].kind == "q" and rest[0].value == "times"
    return again and counted and len(rest) == 1 and current.moves and current.has_extent


def _counts_run(atom: Atom, rest: list[Atom], frames: list[Frame], current: Frame) -> bool:
    """`forward 1 m turn left 90 4x`: motions that nothing parts are counted together.

    Full turns may be counted alone: `forward 1 m spin 360 twice`.
    """
    counted = (atom.kind, atom.value) == ("q", "times") and all(a.kind in ("filler", "glue") for a in rest)
    run = [*frames, current]
    if not counted or not frames or any("times" in f.q or f.shape for f in run) or "turns" in current.q:
        return False
    return all(f.moves and (f.has_extent or "number" in f.q) for f in run) and (
        current.verb not in TURN or _is_corner(current)
    )


def _pauses_between(atom: Atom, rest: list[Atom], current: Frame) -> bool:
    """`… three times with a second in between`: the pause is no part of what is counted."""
    pauses = (atom.kind, atom.value) in (("verb", "wait"), ("q", "time"))
    between = any(a.kind == "flag" and a.value in ("between", "after_each") for a in rest)
    return pauses and between and "times" in current.q


def _is_bare_direction(frame: Frame) -> bool:
    """A direction and nothing else right before something that contradicts it: `forward backward 1 m`."""
    return (
        bool(frame.direction)
        and not frame.has_extent
        and frame.verb not in TURN
        and frame.verb != "slide"
        and not (frame.pace or frame.flags or frame.q)
    )


def _around(atoms: list[Atom], i: int) -> str:
    end = i
    while end + 1 < len(atoms) and atoms[end + 1].kind == "unknown":
        end += 1
    texts = [a.text for a in atoms[i : end + 1]]
    return ("" if texts and texts[0] and ord(texts[0][0]) > 0x2E7F else " ").join(texts)


def _join(frames: list[Frame], segment: Segment) -> None:
    first = segment.frames[0]
    last = frames[-1] if frames else None
    if last is not None:
        both = joined_frame(last, first, segment.joined)
        if both is not None:
            frames[-1] = both
            frames.extend(segment.frames[1:])
            return
    frames.extend(segment.frames)
