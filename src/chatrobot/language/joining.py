"""Frames across a comma, an `and`, a full stop: one motion or two."""

from __future__ import annotations

from chatrobot.language.frames import EXTENTS, GO, SIDES, STILL, TURN, Frame

MANNER = frozenset({"speed", "rate", "percent", "fold", "faster"})


def joined_frame(last: Frame, first: Frame, joined: str) -> Frame | None:
    """Both frames as one motion, or None where they are two; `joined` is the separator between them."""
    if _are_two(last, first, joined) or (joined == "colon" and _tells_pace(last)):
        return None
    if _is_told_in_degrees(last, first):
        return last
    if _have_amounts_apart(last, first):
        return None
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


def _are_two(last: Frame, first: Frame, joined: str) -> bool:
    """Whether the second is a motion of its own, by how it is joined and what it points at."""
    if "trip" in last.flags and "each" in first.flags and not first.verb:
        return True
    if last.verb == first.verb == "defined":
        return True  # `hop, hop`
    if last.place and (first.direction or first.place or first.verb == "return" or "to_start" in first.flags):
        return True  # `go to the kitchen and back`: to a place, then another way
    if _are_two_orders(last, first, joined):
        return True
    if joined == "and" and _says_the_same_turn(last, first):
        return True
    sized = first.direction or first.rot or {"length", "time"} & set(first.q)
    aside = first.verb in ("shift", "slide") and not sized
    if aside and joined == "and" and last.moves and last.direction not in SIDES and first.verb != last.verb:
        return True  # `drive forward and wiggle`: it lacks a side, and is not passed over
    if last.verb == "return" and joined == "and" and "length" in first.q and not first.verb:
        return True  # `come back, and a metre to the right`: another motion
    trip = "trip" in (*first.flags, *first.roles) and not first.has_extent
    if trip and (last.verb == "return" or (last.direction and last.has_extent)):
        return True
    if joined == "then" or {"between", "halfway", "at_point", "after_each", "all"} & first.flags:
        return True
    if _goes_on_straight(last, first):
        return True
    if "again" in first.flags or is_times_only(first) or is_times_only(last):
        return True
    again = "again" in last.flags and not last.has_extent and (first.moves or first.flags != {"same_amount"})
    return bool("all" in last.flags or again)


def _says_the_same_turn(last: Frame, first: Frame) -> bool:
    """`Turn left and turn left`: twice, and not the side told once more."""
    alike = (last.verb, last.direction, last.rot) == (first.verb, first.direction, first.rot)
    return bool(last.verb) and last.sided and alike and not (last.has_extent or first.q)


def _are_two_orders(last: Frame, first: Frame, joined: str) -> bool:
    """`Spin twice and draw a circle`, `curve left and drive 1 m`, `go home, spin around`: each with its own verb."""
    kinds = {_kind(last), _kind(first)}
    if joined not in ("and", "weak", "strong") or "" in kinds or len(kinds) == 1:
        return False
    if any(_is_by_the_way(frame) or (frame.roles and not frame.shape) for frame in (last, first)):
        return False
    if "shape" in kinds and (_is_laps(last) or _is_laps(first)):
        return False  # `a circle, go round twice`
    if joined != "weak":
        return True
    if _kind(first) == "turn" and set(first.q) <= {"times", "turns"}:
        return kinds == {"home", "turn"}  # `a square, turn left`, `a circle, twice round`: how it is drawn
    ahead = kinds == {"home", "go"}  # `drive on, drive to the start`: the same way
    return bool(last.verb and first.verb and kinds & {"shape", "home", "place"}) and not ahead


def _kind(frame: Frame) -> str:
    """Which kind of motion a frame orders by itself; "" where it may tell how another is done."""
    if frame.flags & {"each", "all", "after_each", "between", "again"}:
        return ""
    leads = "home" if "to_start" in frame.flags else "place" if frame.place else ""
    if frame.shape or leads:
        return "shape" if frame.shape else leads if frame.verb else ""
    if frame.verb in TURN:
        return "turn" if frame.sided or frame.has_extent or frame.q.keys() & {"times", "number"} else ""
    if frame.verb in ("curve", "uturn"):
        return frame.verb
    return (
        frame.verb
        if frame.verb in GO and (frame.direction or frame.has_extent or "number" in frame.q)
        else ""
    )


def _tells_pace(frame: Frame) -> bool:
    """`At 0.1 m/s: …`: how to go, of all that comes behind the colon."""
    return not frame.moves and not frame.flags and frame.q.keys() <= MANNER and bool(frame.q or frame.pace)


def _have_amounts_apart(last: Frame, first: Frame) -> bool:
    """Whether each has an amount of its own, so that they are two motions."""
    told = last.moves and last.has_extent
    if {"between", "after_each"} & last.flags and told and first.has_extent and not first.moves:
        return True
    if "number" in first.q and (last.has_extent or "number" in last.q) and not (last.shape or first.shape):
        return True
    if (
        set(last.q) == {"number"}
        and not (last.moves or last.flags)
        and first.moves
        and (first.has_extent or first.verb == "return")
    ):
        return True  # `1 m, 180, 1 m back`
    turns = "number" in last.q and last.direction in SIDES
    return turns and set(first.q) == {"length"} and not first.moves  # `left 45, 1 m`: a turn, then a drive


def _is_told_in_degrees(last: Frame, first: Frame) -> bool:
    """`A twirl to the left, 360 degrees`: the same amount once more."""
    bare = set(first.q) == {"angle"} and not (first.moves or first.flags or first.roles or first.pace)
    return bare and "turns" in last.q and abs(last.q["turns"].number - first.q["angle"].number) < 1e-3


def _goes_on_straight(last: Frame, first: Frame) -> bool:
    """`Arc left 90, radius 1 m, forward 50 cm`: what comes after a curve is no length of it."""
    straight = first.direction in ("forward", "back") and not first.rot
    return straight and "radius" in last.q and "length" in first.q


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
    bare = frame.verb in ("", "make", "go", "turn")
    way = frame.direction or frame.rot or frame.shape or frame.place or "trip" in (*frame.flags, *frame.roles)
    counted = "times" in frame.q or ("count" in frame.q and frame.q["count"].role == "move")
    return counted and bare and not way and not frame.has_extent


def _is_fragment(frame: Frame) -> bool:
    return not frame.verb and not frame.shape and not frame.place


def _completes(last: Frame, first: Frame) -> bool:
    """Across a full stop only what `last` lacks may be added: `turn right. ninety degrees.`"""
    if last.shape and not first.direction and not first.verb:
        return True
    if last.verb in TURN and last.has_extent and not last.sided and first.verb in TURN and not first.q:
        return first.sided  # 原地转五圈！往左边转！
    if not _is_fragment(first):
        return not last.moves and not last.has_extent
    if set(first.q) <= MANNER and not first.direction and not first.rot:
        return True
    lacks_way = not (last.direction or last.rot)
    return not (first.has_extent and last.has_extent) and (not (first.direction or first.rot) or lacks_way)


def _is_by_the_way(turn: Frame) -> bool:
    """`turning left, draw a triangle`."""
    return turn.text.split()[0].endswith("ing")


def _is_beside_shape(frame: Frame, shape: Frame) -> bool:
    """`… and turn around`, `… and wait`, `… and go 1 m`: a motion of its own, not how a shape is drawn."""
    told = frame.has_extent or (frame.sided and frame.joined == "and" and not _is_by_the_way(frame))
    leads = ("to_start" in frame.flags or frame.place) and not frame.rot  # `go home and draw a square`
    ways = leads or (shape.verb and frame.direction in ("forward", "back"))
    told = told or bool(ways and not _is_by_the_way(frame))
    if frame.is_bare_ahead and frame.joined in ("start", "weak"):
        return not shape.has_extent  # `forward, circle, forward`
    own = frame.verb in ("uturn", "return") or (frame.verb in (*GO, *TURN, *STILL) and told)
    return own and not frame.shape


def _belongs(last: Frame, first: Frame) -> bool:
    """Across a comma or an `and`."""
    if "count" in last.q and "length" in first.q and "each" not in first.flags and not last.shape:
        return False
    if last.shape and _is_laps(first):
        return True
    if first.shape and first.verb and last.verb == "turn" and last.sided and not _is_by_the_way(last):
        return False  # `turn left and draw a triangle`
    if last.shape or first.shape:
        return not (_is_beside_shape(last, first) or _is_beside_shape(first, last))
    if first.joined == "and" and last.verb in STILL and first.moves:
        return False
    if last.verb in STILL and last.has_extent and not (set(first.q) <= MANNER and not first.moves):
        return False
    if last.is_arc and first.verb == "turn" and "angle" not in last.q and not (first.direction or first.rot):
        return True
    if (
        last.is_arc
        and first.verb == "turn"
        and first.sided
        and not last.sided
        and _is_round_only(last, first)
    ):
        return True
    if last.is_arc or first.is_arc:
        return not (
            last.has_extent and first.verb and "until" not in first.flags and first.has_extent and last.verb
        )
    if not first.moves:
        adds = _adds_time(last, first) or _adds_length(last, first)
        return not (set(first.q) & set(EXTENTS) and last.has_extent and not adds)
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


def _is_round_only(last: Frame, first: Frame) -> bool:
    """走一段一米的弧线，右转60度: how far round, and to which side."""
    return set(first.q) == {"angle"} and "angle" not in last.q and "length" in last.q


def _is_laps(frame: Frame) -> bool:
    """…的圆，走两圈: how often the shape is gone round."""
    bare = not (frame.direction or frame.rot or frame.shape) and frame.verb in ("", "make", *GO)
    return set(frame.q) == {"turns"} and bare


def _adds_time(last: Frame, first: Frame) -> bool:
    return set(first.q) & set(EXTENTS) == {"time"} and "time" not in last.q


def _adds_length(last: Frame, first: Frame) -> bool:
    """`45 degrees to the right of straight ahead, 1 m`: how far to go on a bearing."""
    return "bearing" in last.flags and "length" not in last.q and set(first.q) == {"length"}


def _direction_follows(last: Frame, first: Frame) -> bool:
    """A direction after a comma belongs to what stands before it, if that has none.

    `rotate 90 degrees, left`.
    """
    if last.direction or last.rot:
        return first.direction == last.direction or "diagonal" in first.flags
    if last.verb in GO and first.direction in SIDES and "length" in last.q and first.joined == "weak":
        return len(first.text.split()) > 1 or bool(first.flags) or last.verb != "go"
    return True


def merged(first: Frame, second: Frame) -> Frame | None:
    """Both frames in one, or None where a slot of `second` contradicts `first`."""
    both = first.copy()
    both.flags |= second.flags
    both.roles += second.roles
    arc = both.is_arc and second.verb == "turn" and not both.verb
    if second.verb and second.verb != both.verb and not arc and not both.put_verb(second.verb):
        return None
    for quantity in second.q.values():
        if not both.put_quantity(quantity):
            return None
    for direction in (second.direction, second.direction2):
        if direction and not both.put_direction(direction):
            return None
    if second.rot and not both.put_rotation(second.rot):
        return None
    if second.shape and both.shape and both.shape != second.shape:
        return None
    if {both.pace, second.pace} == {"fast", "max"}:
        both.pace = second.pace = "max"  # 快跑一米，用全速
    if second.pace and both.pace and second.pace != both.pace:
        return None
    both.shape = both.shape or second.shape
    both.place = both.place or second.place
    both.words = both.words or second.words
    both.pace = both.pace or second.pace
    both.texts += second.texts
    return both
