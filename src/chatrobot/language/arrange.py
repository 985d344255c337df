"""Frames put as they are meant: manners handed on to their motion, titles and announcements left out."""

from __future__ import annotations

from chatrobot.language.frames import EXTENTS, GO, PLACE_HEADING, SIDES, STILL, TURN, Frame
from chatrobot.language.joining import is_times_only
from chatrobot.language.spelt_out import without_titles
from chatrobot.language.unclear import Unclear

_MANNER = frozenset({"speed", "rate", "percent", "fold"})


def arranged(frames: list[Frame]) -> list[Frame]:
    """The frames that are motions of their own, in order."""
    frames = _distributed(_without_calls(_shared(_with_place_headings(frames))))
    frames = _without_announcements(without_titles(_with_manners(frames)))
    return _shape_first(_in_said_units(frames))


def _with_place_headings(frames: list[Frame]) -> list[Frame]:
    """`Go to the desk and face its heading`: how to stand there belongs to the way there."""
    out: list[Frame] = []
    for frame in frames:
        only = frame.flags == {PLACE_HEADING} and not (frame.moves or frame.q or frame.roles or frame.pace)
        if only and out and out[-1].place:
            out[-1].flags.add(PLACE_HEADING)
        else:
            out.append(frame)
    return out


def _in_said_units(frames: list[Frame]) -> list[Frame]:
    """`In centimetres: forward 50, …`: it holds for all of them."""
    said = {flag for frame in frames for flag in frame.flags & {"units_said", "units_cm"}}
    if "units_said" not in said:
        return frames
    frames = [frame for frame in frames if frame.moves or frame.has_extent]
    for frame in frames:
        frame.flags |= said
    return frames


def _distributed(frames: list[Frame]) -> list[Frame]:
    """先前进再后退，都是一米; 左移右移各二十厘米: an amount that all the motions before it share."""
    out: list[Frame] = []
    for frame in frames:
        shared = bool({"all", "each"} & frame.flags) and frame.has_extent and "times" not in frame.q
        if shared and out:
            takers = [f for f in out if f.moves and not (f.q or f.shape) and f.verb not in STILL]
            for name in ("length", "angle", "turns"):
                for taker in takers:
                    turning = taker.turning or taker.verb == "curve"
                    either = not taker.verb and taker.direction in SIDES  # `left, left, 30 degrees each`
                    fits = either or turning == (name != "length")
                    if name in frame.q and name not in taker.q and fits:
                        taker.q[name] = frame.q[name]
            radius = "radius" in frame.roles and "length" in frame.q and not frame.moves
            bends = [f for f in out if f.turning and not {"length"} & set(f.q)] if radius else []
            for bend in bends:
                bend.q["length"] = frame.q["length"]
                bend.roles.append("radius")
            if bends or (takers and not frame.moves):
                continue
        out.append(frame)
    return out


def _without_calls(frames: list[Frame]) -> list[Frame]:
    """让一让，往右平移…: a call to make way whose way follows; 往前，就一点点: a little, said after."""
    out: list[Frame] = []
    for k, frame in enumerate(frames):
        bare = not (frame.direction or frame.rot or frame.q or frame.shape or frame.place or frame.words)
        if bare and frame.verb == "shift" and any(f.direction for f in frames[k + 1 :]):
            continue
        signal = bare and frame.texts == ["go"] and not frame.flags and not frame.pace
        if signal and out and frame.joined == "strong" and k + 1 == len(frames):
            continue  # `…, no turning. Go.`
        if bare and not frame.verb and frame.flags == {"bit"} and out and not out[-1].has_extent:
            out[-1].flags.add("bit")
            continue
        out.append(frame)
    return out


def _is_manner(frame: Frame, *, heads: bool = False) -> bool:
    """走快点, 速度调到每秒两米: how to go, not where; `heads`: before a colon, as `at 0.1 m/s: …`."""
    bare = not (frame.direction or frame.rot or frame.shape or frame.place or frame.roles or frame.words)
    said = bool(frame.pace) or (bool(frame.q) and (heads or "speed_set" in frame.flags))
    return (
        bare and said and set(frame.q) <= _MANNER and frame.verb in ("", *GO, *TURN)
        and frame.flags <= {"bit", "speed_set"}
    )  # fmt: skip


def _with_manners(frames: list[Frame]) -> list[Frame]:
    out: list[Frame] = []
    pending: Frame | None = None
    for_all = False
    for k, frame in enumerate(frames):
        heads = k + 1 < len(frames) and frames[k + 1].joined == "colon"
        manner = _is_manner(frame, heads=heads) and len(frames) > 1
        if manner and k + 1 < len(frames) and (frames[k + 1].joined != "then" or "speed_set" in frame.flags):
            pending, for_all = frame, heads or "speed_set" in frame.flags
        elif manner and out and frame.verb in ("", out[-1].verb, "go") and frame.joined != "then":
            _hand_on(frame, out[-1])
        else:
            if pending is not None and (frame.moves or frame.has_extent):
                _hand_on(pending, frame)
                pending = pending if for_all else None
            out.append(frame)
    return out or frames


def _hand_on(manner: Frame, frame: Frame) -> None:
    if "slow" in (manner.pace, frame.pace) and {"fast", "max"} & {manner.pace, frame.pace}:
        raise Unclear("contradiction", f"{frame.text} {manner.text}")
    if frame.pace or _MANNER & set(frame.q):
        return
    turning = frame.turning or "angle" in frame.q or "turns" in frame.q
    turning = turning or ("number" in frame.q and frame.direction in SIDES)  # `left 90`
    if ("rate" in manner.q and not turning) or ("speed" in manner.q and turning):
        return
    frame.pace = manner.pace
    frame.q.update(manner.q)


def _without_announcements(frames: list[Frame]) -> list[Frame]:
    """三圈，两圈顺时针，一圈逆时针: a sum whose parts follow is no motion of its own."""
    out: list[Frame] = []
    for k, frame in enumerate(frames):
        named = next((n for n in EXTENTS if n in frame.q), "")
        unsided = named and not frame.rot and frame.direction not in SIDES and not frame.shape
        if unsided and _is_sum(frame, frames[k + 1 :], named):
            for part in frames[k + 1 :]:
                part.verb = part.verb or frame.verb
                part.direction = part.direction or frame.direction
            continue
        out.append(frame)
    return out


def _is_sum(frame: Frame, rest: list[Frame], name: str) -> bool:
    if len(rest) < 2 or rest[0].joined == "then" or not _sums_up(frame, rest, name):
        return False
    if frame.direction and any(f.direction not in ("", frame.direction) for f in rest):
        return False  # `three feet forward, one back, two left`: a motion of its own
    return all(f.rot or f.direction or f.pace or _MANNER & set(f.q) for f in rest)


def _sums_up(frame: Frame, rest: list[Frame], name: str) -> bool:
    """Whether all of `rest` have that amount and make up the frame's; a long list is given up early."""
    left = frame.q[name].number
    for part in rest:
        if name not in part.q:
            return False
        left -= part.q[name].number
        if left < -1e-9:
            return False
    return left < 1e-9


def _shared(frames: list[Frame]) -> list[Frame]:
    """`…, both forward`, 都往左转: a clause that holds for all the others."""
    kept: list[Frame] = []
    for frame in frames:
        if (
            "all" not in frame.flags
            or frame.q
            or not (frame.direction or frame.rot or frame.pace)
            or frame.shape
        ):
            kept.append(frame)
            continue
        for other in kept:
            if other.verb in STILL or is_times_only(other) or other.flags & {"between", "after_each"}:
                continue
            if frame.verb in TURN and not other.shape and (other.verb in GO or "length" in other.q):
                continue  # 转90度再走50厘米，都往右转: of the turns
            if not (other.direction or other.rot):
                other.direction, other.rot = frame.direction, frame.rot
                if frame.verb and not other.verb:
                    other.verb = frame.verb
            other.pace = other.pace or frame.pace
    return kept


def _shape_first(frames: list[Frame]) -> list[Frame]:
    """`2 m by 1 m rectangle`: measures said before the name of the shape belong to it."""
    out: list[Frame] = []
    for frame in frames:
        at = len(out)
        while (
            frame.shape and frame.joined in ("none", "weak", "and") and at and _is_measure(out[at - 1], frame)
        ):
            if out[at - 1].verb == "go" and "length" in frame.q and frame.shape != "rectangle":
                break  # `go 1 m, drive a half circle with a radius of 50 cm`: it has its own measure
            at -= 1
        out[at:] = _in_said_order(frame, out[at:])
    return out


def _in_said_order(shape: Frame, before: list[Frame]) -> list[Frame]:
    """The shape, then its measures. 两米乘一米的矩形: the side that is said first is driven first."""
    frames = [shape, *before]
    if shape.shape not in ("rectangle", "square") or any("length" not in frame.q for frame in frames):
        return frames
    lengths = [frame.q["length"] for frame in (*before, shape)]
    frames = [frame.copy() for frame in frames]
    for frame, length in zip(frames, lengths):
        frame.q["length"] = length
    return frames


def _is_measure(frame: Frame, shape: Frame) -> bool:
    """`Drive 2 m by 1 m rectangle`; where both have a verb, `drive 1 m and draw a circle`, it is its own motion."""
    named = shape.joined == "none" or "length" in shape.q
    bare = not frame.moves or (
        frame.verb in (("go", "") if named and not shape.verb else ("",))
        and not (frame.direction or frame.shape or frame.place)
    )
    lone_rotation = bool(frame.rot) and not (frame.verb or frame.q or frame.direction or frame.shape)
    return (bare and "length" in frame.q and "time" not in frame.q) or lone_rotation
