"""So many times: what is repeated, from where to where, and how often."""

from __future__ import annotations

import math
from functools import cache

from chatrobot.language.actions import act
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.frames import TURN, Frame
from chatrobot.language.inverse import inverse
from chatrobot.language.joining import is_times_only
from chatrobot.language.script import Script, count_of, whole_count
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT, Drive, Repeat, Step, Turn, Wait

_MOVES = frozenset({"move", "step", "leg", "turn"})
"""What a count in all counts: each motion by itself."""


@cache
def _whole() -> frozenset[str]:
    return frozenset(word for code in LANGUAGES for word in load_table(code, "repeats").get("whole", ()))


def leading_count(frames: list[Frame]) -> tuple[int | None, list[Frame]]:
    """`Twice: …`, `the following three times: …`."""
    leads = len(frames) > 1 and is_times_only(frames[0])
    if leads and frames[1].joined in ("colon", "weak", "none", "strong"):
        return count_of(frames[0]), frames[1:]
    return None, frames


def loop_end(frames: list[Frame]) -> int:
    """Where the announced loop ends: `twice: A, B. Then C`, `twice (A, B), then C`, `…, and after all that C`."""
    ends = (k for k, f in enumerate(frames) if k and f.opens and f.joined == "then")
    return next(ends, len(frames))


def is_plain_again(frame: Frame) -> bool:
    """`again`: each one adds what was said before it once."""
    told = frame.moves or frame.has_extent or "other_way" in frame.flags
    return "again" in frame.flags and not told


def is_repetition(frame: Frame) -> bool:
    """`do all that twice`, `repeat all that`: said of what came before, and no measure of a shape."""
    told = frame.moves or frame.has_extent or frame.roles
    if "times" in frame.q:
        return not told and bool({"again", "all"} & frame.flags)
    # `The whole thing` alone repeats nothing.
    repeats = "again" in frame.flags and frame.text.startswith("repeat")
    return not told and repeats and repeats_all(frame) and not (frame.pace or frame.q)


def repeats_all(frame: Frame) -> bool:
    """`do all that twice`, not `do that twice`."""
    return "all" in frame.flags or any(word in _whole() for text in frame.texts for word in text.split())


def is_moves_only(script: Script, frame: Frame) -> bool:
    """这样来四下: so often, what was said before."""
    count = frame.q.get("count")
    told = frame.direction or frame.rot or frame.has_extent or frame.shape
    bare = not told and frame.verb in ("", "make")
    return count is not None and count.role == "move" and bare and bool(script.units)


def lists_lengths(frames: list[Frame], i: int) -> bool:
    """`Three legs: half a metre, one metre, 1.5 m`: the count only announces the list."""
    frame = frames[i]
    if "count" not in frame.q or frame.has_extent:
        return False
    count = int(min(frame.q["count"].number, len(frames)))
    listed = frames[i + 1 : i + 1 + count]
    return len(listed) == count and all("length" in f.q and not f.verb for f in listed)


def with_measure(trip: Frame, following: Frame) -> Frame | None:
    """`to and fro five times, half a metre each way`: the measure said after the trips."""
    bare = not following.verb and not following.shape and not following.place and not following.rot
    if not bare or trip.has_extent or following.joined == "then":
        return None
    both = trip.copy()
    both.flags |= following.flags
    both.q = {**following.q, **both.q}
    both.direction = both.direction or following.direction
    both.roles += following.roles
    return both


def round_trips(script: Script, frame: Frame) -> None:
    """`Three round trips of one metre`: there and back as often.

    Raises:
        Unclear: where nothing says how far a trip goes.
    """
    each = frame.copy()
    trips = 1
    for name in ("count", "times"):
        if name in each.q:
            trips = whole_count(each.q.pop(name))
    each.flags -= {"trip", "each"}
    if not each.has_extent:
        if not script.units:
            raise Unclear("how_long_a_step", frame.text)
        if len(script.units) > 1 and _is_there_and_back(script.steps()):
            script.units = repeated(script.units, trips)
            return
        out = script.units.pop()
    elif each.verb in TURN or each.rot:
        raise Unclear("unclear_motion", frame.text)
    else:
        each.roles.clear()
        out = act(each, script.state, script.pace)
    for _ in range(trips):
        script.units += [out, inverse(out)]


def is_way_back(trip: Frame, back: Frame) -> bool:
    """每趟前进一米再后退一米, `to and fro: a metre ahead, a metre back`: the way back of each trip, told as well."""
    out, said = trip.q.get("length"), back.q.get("length")
    as_far = out is not None and said is not None and abs(out.number - said.number) < 1e-6
    number = back.q.get("number")  # `five metres up and reverse the five back`
    as_far |= out is not None and number is not None and out.text.startswith(f"{number.text} ")
    ways = {trip.direction or "forward", back.direction}
    return as_far and ways in ({"forward", "back"}, {"left", "right"})


def _is_there_and_back(steps: list[Step]) -> bool:
    """Whether drives, seen without turning, end where they began."""
    drives = [s for s in steps if isinstance(s, Drive) and s.distance_m]
    if len(drives) < len([s for s in steps if not isinstance(s, Wait)]):
        return False
    x = sum((s.distance_m or 0.0) * math.cos(s.direction_rad) for s in drives)
    y = sum((s.distance_m or 0.0) * math.sin(s.direction_rad) for s in drives)
    return math.hypot(x, y) < 1e-6


def is_heading_back(script: Script, frame: Frame) -> bool:
    """`… until you face the way you started`: as often as it takes to a full turn.

    Raises:
        Unclear: where no number of rounds comes to that.
    """
    if "until" not in frame.flags or "original_heading" not in frame.flags:
        return False
    once = period(script.units)
    turned = abs(_total_turn([s for unit in once for s in unit]))
    rounds = round(2 * math.pi / turned) if turned else 0
    if rounds < 1 or abs(rounds * turned - 2 * math.pi) > 1e-6:
        raise Unclear("condition", frame.text)
    script.units = _until_done(once, rounds)
    return True


def fill_up(script: Script, frame: Frame) -> None:
    """转一圈歇两秒，转满三圈为止: the units again until the whole amount is done.

    Raises:
        Unclear: where no number of rounds comes to that.
    """
    once = period(script.units)
    steps = [step for unit in once for step in unit]
    wanted = frame.q.get("angle") or frame.q.get("turns") or frame.q.get("length")
    if wanted is None:
        raise Unclear("condition", frame.text)
    if wanted.value == "length":
        done = sum(s.distance_m or 0.0 for s in steps if isinstance(s, Drive))
    else:
        done = abs(_total_turn(steps))
    rounds = wanted.number / done if done else 0.0
    if abs(rounds - round(rounds)) > 1e-6 or not 1 <= round(rounds) <= MAX_REPEAT:
        raise Unclear("condition", frame.text)
    script.units = _until_done(once, round(rounds))


def period(units: list[list[Step]]) -> list[list[Step]]:
    """The shortest beginning that, repeated, gives all units."""
    for length in range(1, len(units) + 1):
        if len(units) % length == 0 and units[:length] * (len(units) // length) == units:
            return units[:length]
    return units


def repeated(units: list[list[Step]], count: int) -> list[list[Step]]:
    """The units so often, a pause at their end, too: `30 cm, wait 1 s, six times` has six pauses."""
    if not units:
        raise Unclear("nothing_before")
    whole = [step for unit in units for step in unit]
    if count * len(whole) > 400:
        return [[Repeat(count, tuple(whole))]]
    return [list(unit) for unit in units * count]


def counts_moves(frame: Frame) -> bool:
    """`six moves in all`: of all the motions, and not of the times that they are done together."""
    count = frame.q.get("count")
    return count is not None and "total" in frame.flags and count.role in _MOVES and not frame.has_extent


def by_turns(units: list[list[Step]], count: int) -> list[list[Step]]:
    """One unit after the other, from the first again after the last, so many in all: left, right, left."""
    moves: list[list[Step]] = []
    for unit in units:  # a pause belongs to the motion before it
        if moves and all(isinstance(step, Wait) for step in unit):
            moves[-1] = [*moves[-1], *unit]
        else:
            moves.append(list(unit))
    if count < len(moves) or count > MAX_REPEAT:
        raise Unclear("bad_count")
    return [moves[k % len(moves)] for k in range(count)]


def _until_done(units: list[list[Step]], count: int) -> list[list[Step]]:
    """The units so often; what they are done for is reached before a pause at the very end."""
    out = repeated(units, count)
    return out[:-1] if count > 1 and all(isinstance(step, Wait) for step in out[-1]) else out


def _total_turn(steps: list[Step]) -> float:
    """Signed sum of the turns that have an angle, radians."""
    return sum((s.angle_rad or 0.0) * (1 if s.left else -1) for s in steps if isinstance(s, Turn))
