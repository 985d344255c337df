"""The steps that are told by what was done before: so much of it, as far as all of it, both of them once more.

Where they could be others, there are none: the rest of the package then reads the text, or asks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from chatrobot.language.context import Context, Dialogue
from chatrobot.language.frames import DIRECTIONS, SIDES
from chatrobot.language.inverse import inverse, is_sideways
from chatrobot.language.last_motion import in_unit_before, unit_driven_m
from chatrobot.language.meant import is_correction
from chatrobot.language.measures import whole_number
from chatrobot.language.pose_told import told_heading, told_place
from chatrobot.language.slots_said import HEADINGS, SUMS, WAYS, Said
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait

_NEAR = 1e-6
_MOST = 10.0
"""A number without a unit hardly means more times what was done."""

_FEWEST = 10.0
"""`The last two back`: motions, and no centimetres."""


@dataclass(frozen=True)
class _Before:
    """What was done and not undone since, turn by turn, without waits; all of the last turn; its unit."""

    done: Sequence[tuple[Step, ...]]
    whole: tuple[Step, ...]
    unit_m: float
    is_correction: bool

    @property
    def last(self) -> tuple[Step, ...]:
        return self.done[-1]


def ordered_by(said: Said, context: Context) -> list[Step] | None:
    """The steps that are ordered; None where the slots order nothing, or what was done leaves it open.

    Raises:
        Unclear: nothing was done that the words fit.
    """
    done, last = _done(context.dialogue), context.dialogue.last_motion
    if not done or last is None or last.walk is not None or last.outcome == "stopped":
        return None
    if any(turn.lost for turn in context.dialogue.turns):
        return None
    before = _Before(
        done, context.dialogue.ledger.done[-1].way or (), unit_driven_m(last) or 0.0, is_correction(last)
    )
    found = told_heading(said, context) or told_place(said, context, before.unit_m)
    return found or next(filter(None, (read(said, before) for read in _READERS)), None)


def _done(dialogue: Dialogue) -> Sequence[tuple[Step, ...]]:
    found: list[tuple[Step, ...]] = []
    for entry in dialogue.ledger.done:
        if entry.way is None:
            found.clear()
            continue
        moves = tuple(step for step in entry.way if not isinstance(step, Wait))
        found += [moves] if moves else []
    return found


def _missing(said: Said, before: _Before) -> list[Step] | None:
    """`It must be 2 m in total`, `I wanted 90, so complete what is missing`."""
    told = said.amount("amount")
    is_total = said.has("total", "rest") and said.has("want", "short", "rest")
    if (
        told is None
        or not is_total
        or not said.only("amount")
        or said.factors
        or said.has(*SUMS, *WAYS, *HEADINGS)
    ):
        return None
    run = _run(before, alike=True)
    size, amount = _sum(run), _in_unit(told, run, before)
    if size is None or amount is None or amount - size < _NEAR:
        return None
    return [_of_size(run[-1], amount - size)]


def _repeated(said: Said, before: _Before) -> list[Step] | None:
    """`Both of them once more`, `that whole there-and-back twice`."""
    if not said.has("again", "times") or said.factors or said.has(*WAYS, "last", "all", *HEADINGS):
        return None
    if not said.only("times") or said.has("sliding", "turning", "total", "want", "rest"):
        return None
    often, last = _count(said), before.last
    if said.has("trip"):
        pair = last if len(last) > 1 else _last_two(before)
        is_trip = len(pair) == 2 and inverse([pair[0]]) == [pair[1]]
        return [*pair] * often if is_trip else None
    if said.has("both"):
        return [*_last_two(before)] * often or None
    return [*before.whole] * often if said.has("whole") and len(last) > 1 else None


def _count(said: Said) -> int:
    times = said.amount("times")
    return whole_number(times.number, times.text) if times is not None else 1


def _last_two(before: _Before) -> tuple[Step, ...]:
    """The last two motions, where each was a turn of its own or there was but one turn of two."""
    if len(before.done) == 1:
        return before.done[0] if len(before.done[0]) == len(before.whole) == 2 else ()
    one, two = before.done[-2:]
    return (*one, *two) if len(one) == len(two) == 1 else ()


def _again(said: Said, before: _Before) -> list[Step] | None:
    """`Again, but backwards and 10 cm shorter`, `one more, the radius 10 cm larger`, `twice, to the left, sideways`."""
    if not said.has("again", "last") or said.factors or said.has(*SUMS, "weak", *HEADINGS, "oops", "want"):
        return None
    steps = before.last
    if before.is_correction or len(set(steps)) > 1 or not said.only("delta_more", "delta_less", "times"):
        return None
    delta = said.amount("delta_more", "delta_less")
    times = _count(said) if "times" in said.amounts else len(steps) if said.has("again") else 1
    if delta is None and not ("times" in said.amounts and said.has("sliding")):
        return None
    if said.has("radius") != isinstance(steps[0], Arc):
        return None
    size = _size(steps[0])
    new_size = _changed(said, size, steps, before) if size is not None else None
    if new_size is None:
        return None
    moved = _on_way(said, steps[:1], new_size)
    waits = {step for step in before.whole if isinstance(step, Wait)}
    if moved is None or len(waits) > 1:
        return None
    each = [moved, *waits] * times  # as it waited in between
    return each if isinstance(before.whole[-1], Wait) else each[: len(each) - len(waits)]


def _changed(said: Said, size: float, run: Sequence[Step], before: _Before) -> float | None:
    """The amount with what is to be added or taken away; None where nothing is left."""
    for slot, sign in (("delta_more", 1.0), ("delta_less", -1.0)):
        delta = said.amount(slot)
        if delta is not None:
            by = _in_unit(delta, run, before)
            if by is None:
                return None
            size += sign * by
    return size if size > _NEAR else None


def _share(said: Said, before: _Before) -> list[Step] | None:
    """`Half of what you've done in total, back`; `twice as far as both`; `as far again, but forwards`."""
    if len(said.factors) > 1 or not said.only("amount", "delta_more", "delta_less") or said.has(*HEADINGS):
        return None
    if said.has("rest", "want", "short", "trip", "whole", "times"):
        return None
    if said.has("undo") and not said.factors:
        return None  # of whole turns
    if said.has("back") and said.has("delta_more", "delta_less"):
        return None  # `back by the same plus 10 cm`
    way = said.has(*WAYS)
    grows = any(factor > 1.0 for factor in said.factors) and said.has("driving", "turning", "going")
    points = said.has("last", "as_far", "first_one") or (
        said.has("weak") and bool(said.factors or said.amounts.keys() - {"amount"})
    )
    if not said.has(*SUMS, "total") and not (points and (way or (grows and said.amounts))):
        return None
    run = _meant(said, before)
    size = _difference(run) if said.has("difference") else _sum(run)
    told = said.amount("amount")
    if size is None or (told is not None and abs((_in_unit(told, run, before) or 0.0) - size) > _NEAR):
        return None
    factor = said.factors[0] if said.factors else 1.0
    if (
        not way
        and not said.has("undo", "off")
        and (said.has("again") or factor < 1.0 or not said.has("driving", "turning", "going"))
    ):
        return None
    new_size = _changed(said, size * factor, run, before)
    moved = _on_way(said, run, new_size) if new_size is not None else None
    return [moved] if moved is not None else None


def _meant(said: Said, before: _Before) -> Sequence[Step]:
    """The motions that are spoken of, all turns or all drives; none where others could be meant."""
    if said.has("first_one"):
        return before.done[0] if len(before.done[0]) == 1 and not said.has(*SUMS, "last") else ()
    drives = said.has("driving", "sliding", "reverse", "forward")
    kind = Turn if said.has("turning") else Drive if drives else type(before.last[-1])
    if not drives and kind is Turn and not said.has("turning") and not said.has("both", "last", "as_far"):
        kinds = {type(step) for turn in before.done for step in turn}
        if len(kinds) > 1:
            return ()  # `go back as far as you've gone altogether`, after 1 m and a turn
    if said.has("both", "difference"):
        pair = _last_two(before)
        return pair if all(type(step) is kind for step in pair) else ()
    if said.has("all", "total"):
        run = _run(before)
        others = sum(type(step) is type(run[-1]) for turn in before.done for step in turn) > len(run)
        return run if type(run[-1]) is kind and not others else ()
    last = before.last
    return last if len(last) == 1 and type(last[0]) is kind and not before.is_correction else ()


def _run(before: _Before, *, alike: bool = False) -> Sequence[Step]:
    """The unbroken run of turns, or of drives, that the last motion belongs to; `alike`: all one way."""
    steps = [step for turn in before.done for step in turn]
    k = len(steps) - 1
    while (
        k
        and type(steps[k - 1]) is type(steps[-1])
        and not (alike and _sense(steps[k - 1]) != _sense(steps[-1]))
    ):
        k -= 1
    return steps[k:]


def _of_number(said: Said, before: _Before) -> list[Step] | None:
    """`The last 20 back again`, `turn the 60 from before back`."""
    last, named = said.amount("named_last"), said.amount("named")
    told = last or named
    if told is None or said.factors or not said.only("named_last", "named") or said.has("forward", *SIDES):
        return None
    if not said.has("back", "off", "reverse", "oops") or (told.value == "number" and told.number < _FEWEST):
        return None
    for step in reversed([step for turn in before.done for step in turn]):
        size, amount = _size(step), _in_unit(told, [step], before)
        if size is not None and amount is not None and (last or abs(size - amount) < _NEAR):
            if amount - size > _NEAR:
                break  # `the last 3 m back`, after 1 m
            return inverse([_of_size(step, amount)])
        if last:
            break
    raise Unclear("nothing_before", told.text)


def _taken_back(said: Said, before: _Before) -> list[Step] | None:
    """`Take that last bit back`."""
    plain = said.slots <= {
        "idle",
        "last",
        "back",
        "off",
        "oops",
        "driving",
        "turning",
        "going",
        "anew",
        "weak",
    }
    if not plain or said.factors or said.amounts or not said.has("last") or not said.has("back", "off"):
        return None
    last = before.last
    return inverse([*last]) if len(last) == 1 and _size(last[0]) is not None else None


def _on_way(said: Said, run: Sequence[Step], size: float) -> Step | None:
    """A motion like these of that size, the way that is said; None where that leaves several open."""
    ways, step = [way for way in WAYS if said.has(way)], run[-1]
    ways = [way for way in ways if way != "back" or len(ways) == 1 or said.has("turning")]
    alike = len({_sense(one) for one in run}) == 1
    new = _of_size(step, size)
    goes_back = said.has("back", "undo", "off", "oops")
    if isinstance(new, Turn):
        sides = [way for way in ways if way in SIDES]
        if said.has("sliding", "forward", "reverse") or len(sides) > 1 or not (sides or alike):
            return None
        return replace(new, left=sides == ["left"]) if sides else inverse([new])[0] if goes_back else new
    if isinstance(new, Arc):
        return new if not ways else None
    if said.has("turning") or len(ways) > 1 or not isinstance(new, Drive):
        return None
    if ways in ([], ["back"]):
        is_open = not alike or (bool(ways) and new.direction_rad == DIRECTIONS["back"])
        return None if is_open else inverse([new])[0] if goes_back else new
    goes_on = said.has("again") and new.direction_rad == DIRECTIONS["back"]
    if ways == ["reverse"] and new.direction_rad != DIRECTIONS["forward"] and not goes_on:
        return None  # backwards once more, or back to where it came from?
    way = "back" if ways == ["reverse"] else ways[0]
    if way in SIDES and not (said.has("sliding") or all(map(is_sideways, run))):
        return None
    return replace(new, direction_rad=DIRECTIONS[way])


def _in_unit(amount: Atom, run: Sequence[Step], before: _Before) -> float | None:
    """The amount as these motions count it; None where it is another kind of amount."""
    if not run:
        return None
    found = in_unit_before(amount, run[-1], before.unit_m)
    names = ("angle", "turns") if isinstance(run[-1], Turn) else ("length",)
    # `90 in total`, after 1 m
    is_far = found is not amount and found.number > _MOST * (_sum(run) or math.inf)
    return found.number if found.value in names and not is_far else None


def _size(step: Step) -> float | None:
    if isinstance(step, Drive):
        return step.distance_m
    return step.angle_rad if isinstance(step, Turn) else step.radius_m if isinstance(step, Arc) else None


def _of_size(step: Step, size: float) -> Step:
    if isinstance(step, Drive):
        return replace(step, distance_m=size)
    if isinstance(step, Turn):
        return replace(step, angle_rad=size)
    return replace(step, radius_m=size) if isinstance(step, Arc) else step


def _sense(step: Step) -> float | bool | None:
    return step.direction_rad if isinstance(step, Drive) else step.left if isinstance(step, Turn) else None


def _sum(run: Sequence[Step]) -> float | None:
    sizes = [_size(step) for step in run if not isinstance(step, Arc)]
    return sum(size for size in sizes if size) if sizes and all(sizes) else None


def _difference(run: Sequence[Step]) -> float | None:
    sizes = [_size(step) for step in run]
    return abs((sizes[0] or 0.0) - (sizes[1] or 0.0)) if len(sizes) == 2 and all(sizes) else None


_READERS: Sequence[Callable[[Said, _Before], list[Step] | None]] = (
    _missing, _repeated, _taken_back, _of_number, _again, _share,
)  # fmt: skip
