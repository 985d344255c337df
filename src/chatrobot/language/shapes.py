"""A named shape and the measures said with it → steps."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.language.actions import act
from chatrobot.language.drawing import drawn
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import GO, SIDES, STILL, TURN, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.measures import Measures, measured, whole_number
from chatrobot.language.repeats import is_repetition
from chatrobot.language.shape_sides import tells_side
from chatrobot.plan.steps import Step

_TITLES = frozenset({"letter_l", "letter_u", "letter_z", "stairs", "plus", "zigzag", "square", "rectangle"})
"""Shapes whose moves may be spelt out after their name."""

_DRAWN_ON = frozenset({"letter_l", "letter_u", "letter_z", "stairs", "plus", "sbend"})
"""Shapes whose lines may be told one by one behind their name, with verbs."""
_DRAWN_ON = frozenset({"letter_l", "letter_u", "letter_z", "stairs", "plus", "sbend"})
"""Shapes whose lines may be told one by one behind their name, with verbs."""
_EACH = frozenset({"all", "each"})
_STRAIGHT = (
    "square",
    "triangle",
    "right_triangle",
    "polygon",
    "rectangle",
    "star",
    "rhombus",
    "zigzag",
    "stairs",
)
"""Shapes that have no circle for a part: one that is named beside them is a shape of its own."""


def draw(frames: list[Frame], i: int, pace: Pace) -> tuple[int, list[Step]]:
    """The steps of the shape named in `frames[i]`, and the index of the first frame that is no part of it.

    Raises:
        Unclear: where a measure is missing or the shape is none this module can draw.
    """
    end = i + 1
    while end < len(frames) and (tells_side(frames[i:end], frames[end:]) or _is_part(frames[i], frames[end])):
        end += 1
    parts = frames[i:end]
    spelt = _spelt_out(parts, pace) if parts[0].shape in _TITLES else None
    if spelt is not None:
        return end, spelt
    measures = measured(parts, pace)
    if measures.both_sides and _is_two_of_a_kind(measures):
        one = replace(measures, times=1, rounds=1.0)
        return end, [*drawn(one), *drawn(replace(one, left=not one.left))]
    if parts[0].shape != "circle":
        measures.times *= whole_number(measures.rounds)
    steps = drawn(measures)
    return end, steps * measures.times


def _is_two_of_a_kind(measures: Measures) -> bool:
    """`Two circles, first left then right`: one each."""
    return measures.times * measures.rounds == 2.0 and measures.shape.startswith(_ONE_SIDED)


_ONE_SIDED = (
    "circle",
    "square",
    "rectangle",
    "polygon",
    "triangle",
    "half_circle",
    "quarter_circle",
    "spiral",
)


def _is_part(head: Frame, frame: Frame) -> bool:
    if is_repetition(frame):
        return False
    if frame.joined == "then" and "length" in head.q and frame.moves and head.shape in ("square", "zigzag"):
        return (
            False  # `a square with 1 m sides, then forward 1 m`; of stairs and letters it tells the next line
        )
    if head.shape == "plus" and ("way" in [q.role for q in frame.q.values()] or frame.verb == "return"):
        return True
    if head.shape == "spiral" and "between" in frame.flags and "angle" in frame.q:
        return True
    if frame.flags & {"between", "after_each", "to_start", "original_heading"} or frame.verb in (
        *STILL,
        "return",
        "face",
        "uturn",
        "remember",
    ):
        return False
    ahead = frame.direction in ("forward", "back") and frame.verb in GO and not frame.has_extent
    by_the_way = frame.text.split()[0].endswith("ing")
    if frame.is_bare_ahead or (ahead and (head.verb or frame.joined == "and") and not by_the_way):
        return False  # `draw a circle and drive forward`
    goes_on = frame.direction in ("forward", "back") and set(frame.q) == {"length"} and not frame.roles
    if goes_on and head.shape in ("quarter_circle", "half_circle", "circle"):
        return False  # `a quarter circle of 1 m radius, 50 cm straight`
    if frame.shape and frame.sided and "length" in frame.q and "length" in head.q:
        return False  # `half circle left with a radius of 40 cm, half circle right with …`: each has its own
    is_straight = head.shape.startswith(_STRAIGHT)
    if frame.shape and (is_straight or frame.shape not in ("half_circle", "quarter_circle", "circle")):
        return False
    if _is_beside(head, frame) and (not by_the_way or (frame.joined == "then" and frame.verb == "slide")):
        return False
    if head.shape in _TITLES and frame.has_extent and (frame.direction or frame.verb in GO):
        return True
    lone_side = frame.direction in SIDES and not frame.q and frame.verb in ("", "curve", "turn")
    if head.shape == "sbend" and (frame.shape == "quarter_circle" or lone_side):
        return True
    if frame.joined == "then":
        return False
    if frame.verb in TURN:
        told_beside = by_the_way or _EACH & frame.flags or frame.roles
        return bool((lone_side or frame.rot) and not frame.has_extent and told_beside)
    return not (
        frame.verb in GO
        and frame.has_extent
        and not frame.roles
        and "each" not in frame.flags
        and "count" not in frame.q
    )


def _is_beside(head: Frame, frame: Frame) -> bool:
    """`Draw a square and drive 1 m`, `draw a circle, go to x 1 y 1`: whether it is a motion of its own by its verb."""
    if frame.joined in ("start", "none") or (frame.verb == "make" and not frame.shape):
        return False  # a measure that was said before the shape
    if head.shape in _DRAWN_ON or not frame.verb or _EACH & frame.flags or (frame.roles and not frame.shape):
        return False
    told = bool({"length", "angle", "time", "number"} & set(frame.q)) or frame.verb == "slide"
    if frame.joined in ("and", "then", "strong"):
        goes_round = frame.verb in GO and bool(frame.rot)  # `…, go anticlockwise`: how it is drawn
        sided = frame.sided and not goes_round
        told = told or sided or frame.verb == "curve" or "times" in frame.q or bool(frame.shape)
    return bool(frame.place or (told and (head.verb or frame.joined != "weak")))


def _spelt_out(parts: list[Frame], pace: Pace) -> list[Step] | None:
    """`a letter L: two metres forward, then one metre to the right`; stairs may say how often."""
    moves = [
        p
        for p in parts
        if p.direction and "length" in p.q and not (p.shape and p.shape != "letter_l" and p.roles)
    ]
    if len(moves) < 2 or any("count" in p.q and "length" in p.q for p in parts):
        return None
    if any(p.q and p not in moves and not {"count", "times"} & set(p.q) for p in parts):
        return None
    state = State()
    steps = []
    for move in moves:
        bare = move.copy()
        bare.shape, bare.verb, bare.roles = "", "" if bare.verb == "make" else bare.verb, []
        bare.q.pop("count", None)
        steps += act(bare, state, pace)
    rounds = [p.q[n].number for p in parts for n in ("count", "times") if n in p.q]
    return steps * whole_number(rounds[0]) if rounds else steps
