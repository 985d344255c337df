"""Atoms → frames, one a motion.

Cut where a slot is filled twice, joined across commas where nothing contradicts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from chatrobot.language.frames import EXTENTS, GO, SIDES, SLOTTED, STILL, TURN, Frame, merged
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_STRENGTH = {"start": 0, "and": 1, "weak": 2, "colon": 3, "strong": 4, "then": 5}
MANNER = frozenset({"speed", "rate", "percent", "fold", "faster"})


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
    for segment in _segments(atoms, drawing):
        _join(frames, segment)
    frames = _marked_ends(frames)
    loose = next((frame for frame in frames if _hangs_loose(frame)), None)
    if loose is not None and not drawing:
        raise Unclear("unclear_motion", loose.text)
    return frames


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
        atoms = [curve, *[a for a in atoms if a is not curve and a.value != "go"]]
    frames: list[Frame] = []
    current = Frame()
    for i, atom in enumerate(atoms):
        if atom.kind in ("filler", "glue", "sep", "reason"):
            continue
        if atom.kind not in SLOTTED:
            raise Unclear("unknown_part", _around(atoms, i))
        if _repeats_all(atom, atoms[i + 1 :], current):
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
    if not current.is_empty:
        frames.append(current)
    return frames


def _repeats_all(atom: Atom, rest: list[Atom], current: Frame) -> bool:
    """…左转九十度重复四遍: all that was said before, not the last part alone."""
    again = atom.kind == "flag" and atom.value == "again" and atom.text.startswith(("重复", "反复"))
    counted = bool(rest) and rest[0].kind == "q" and rest[0].value == "times"
    return again and counted and len(rest) == 1 and current.moves and current.has_extent


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
        both = _joined(last, first, segment.joined)
        if both is not None:
            frames[-1] = both
            frames.extend(segment.frames[1:])
            return
    frames.extend(segment.frames)


def _joined(last: Frame, first: Frame, joined: str) -> Frame | None:
    if "trip" in last.flags and "each" in first.flags and not first.verb:
        return None
    if last.verb == "return" and joined == "and" and "length" in first.q and not first.verb:
        return None  # `come back, and a metre to the right`: another motion
    trip = "trip" in (*first.flags, *first.roles) and not first.has_extent
    if trip and (last.verb == "return" or (last.direction and last.has_extent)):
        return None
    if joined == "then" or {"between", "halfway", "at_point", "after_each", "all"} & first.flags:
        return None
    if "again" in first.flags or is_times_only(first) or is_times_only(last):
        return None
    if "all" in last.flags or ("again" in last.flags and not last.has_extent):
        return None
    if (
        {"between", "after_each"} & last.flags
        and not first.moves
        and first.has_extent
        and last.moves
        and last.has_extent
    ):
        return None
    if "number" in first.q and (last.has_extent or "number" in last.q) and not (last.shape or first.shape):
        return None
    if "number" in last.q and last.direction in SIDES and set(first.q) == {"length"} and not first.moves:
        return None  # `left 45, 1 m`: a turn, then a drive
    if "while" in first.flags and last.verb in GO and first.verb in TURN and not last.has_extent:
        last = last.copy()
        last.flags.add("while")
    together = "speed" in last.q and "rate" in first.q and not last.has_extent
    if together and joined in ("and", "weak") and last.verb in (*GO, "") and first.verb in (*TURN, ""):
        last = last.copy()
        last.flags.add("while")
    if _says_how(last, first):
        how = last.copy()
        how.flags |= first.flags | {"sideways"}
        how.texts += first.texts
        return how
    if _names_the_side(last, first):
        first = first.copy()
        first.verb = last.verb
    both = merged(last, first)
    if both is None:
        return None
    if joined in ("strong", "colon"):
        return both if _completes(last, first) else None
    return both if _belongs(last, first) else None


def _names_the_side(last: Frame, first: Frame) -> bool:
    """打转两圈，往左转: the side of the turn before, which has none."""
    turns = last.verb in TURN and first.verb in TURN and last.has_extent and not first.q
    return turns and first.sided and not last.sided and not first.flags


def _says_how(last: Frame, first: Frame) -> bool:
    """`half a metre to the right, sliding`: the manner of what stands before it."""
    bare = not (first.q or first.direction or first.rot or first.shape or first.place)
    sideways = last.direction not in ("", "forward", "back") and "length" in last.q
    return bare and first.verb == "slide" and first.text.endswith("ing") and sideways


def is_times_only(frame: Frame) -> bool:
    """`four times`, and nothing that moves."""
    bare = frame.verb in ("", "make", "go", "turn", "shift", "slide")
    way = frame.direction or frame.rot or frame.shape or frame.place or "trip" in (*frame.flags, *frame.roles)
    counted = "times" in frame.q or ("count" in frame.q and frame.q["count"].role == "move")
    return counted and bare and not way and not frame.has_extent


def _is_fragment(frame: Frame) -> bool:
    return not frame.verb and not frame.shape and not frame.place


def _completes(last: Frame, first: Frame) -> bool:
    """Across a full stop only what `last` lacks may be added: `turn right. ninety degrees.`"""
    if last.shape and not first.direction and not first.verb:
        return True
    if not _is_fragment(first):
        return not last.moves and not last.has_extent
    if set(first.q) <= MANNER and not first.direction and not first.rot:
        return True
    lacks_way = not (last.direction or last.rot)
    return not (first.has_extent and last.has_extent) and (not (first.direction or first.rot) or lacks_way)


def _belongs(last: Frame, first: Frame) -> bool:
    """Across a comma or an `and`."""
    if "count" in last.q and "length" in first.q and "each" not in first.flags and not last.shape:
        return False
    if last.shape and _is_laps(first):
        return True
    if last.shape or first.shape:
        return not (last.shape and first.verb in (*GO, *TURN, *STILL, "return") and first.has_extent)
    if first.joined == "and" and last.verb in STILL and first.moves:
        return False
    if last.verb in STILL and last.has_extent and not (set(first.q) <= MANNER and not first.moves):
        return False
    if last.is_arc and first.verb == "turn" and "angle" not in last.q and not (first.direction or first.rot):
        return True
    if last.is_arc or first.is_arc:
        return not (
            last.has_extent and first.verb and "until" not in first.flags and first.has_extent and last.verb
        )
    if not first.moves:
        return not (set(first.q) & set(EXTENTS) and last.has_extent and not _adds_time(last, first))
    if not last.moves:
        return True
    if first.verb == last.verb and first.q and set(first.q) <= MANNER and not (first.direction or first.rot):
        return True
    if first.verb and last.q and set(last.q) <= MANNER and not (last.direction or last.rot):
        return True
    if _names_the_side(last, first):
        return True
    if first.verb and last.verb:
        return (
            not last.has_extent
            and (not first.direction or first.direction == last.direction)
            and (last.verb != "turn" or first.verb == "turn")
        )
    if (first.direction or first.rot) and not first.has_extent and not first.verb:
        return _direction_follows(last, first)
    if first.direction and first.has_extent:
        return not last.has_extent and last.direction in ("", first.direction)
    return True


def _is_laps(frame: Frame) -> bool:
    """…的圆，走两圈: how often the shape is gone round."""
    bare = not (frame.direction or frame.rot or frame.shape) and frame.verb in ("", "make", *GO)
    return set(frame.q) == {"turns"} and bare


def _adds_time(last: Frame, first: Frame) -> bool:
    return set(first.q) & set(EXTENTS) == {"time"} and "time" not in last.q


def _direction_follows(last: Frame, first: Frame) -> bool:
    """A direction after a comma belongs to what stands before it, if that has none.

    `rotate 90 degrees, left`.
    """
    if last.direction or last.rot:
        return first.direction == last.direction or "diagonal" in first.flags
    if last.verb in GO and first.direction in SIDES and "length" in last.q and first.joined == "weak":
        return len(first.text.split()) > 1 or bool(first.flags) or last.verb != "go"
    return True
