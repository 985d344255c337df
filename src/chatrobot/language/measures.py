"""What is said about a drawn shape: its lengths and what each of them measures, its side, how often."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from chatrobot.language.frames import DIAGONALS, SIDES, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT


@dataclass
class Measures:
    """What is said about a shape: lengths with the roles they were said with, in order.

    `text` is what was said of it, `default_m` the size it has where nothing is said; `some_sides` how many of its sides
    are to be driven, 0 for all; `area_m2` 0 where none is said.
    """

    shape: str = ""
    text: str = ""
    default_m: float = 0.0
    can_go_sideways: bool = False
    lengths: list[tuple[float, list[str]]] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    times: int = 1
    rounds: float = 1.0
    left: bool = True
    side_said: bool = False
    both_sides: bool = False
    back: bool = False
    sliding: bool = False
    angle_rad: float | None = None
    seconds: float | None = None
    speed: float | None = None
    some_sides: int = 0
    area_m2: float = 0.0

    def with_role(self, *roles: str) -> float | None:
        """The first length that was said with one of these roles."""
        return next((v for v, said in self.lengths if set(said) & set(roles)), None)

    def count(self, *names: str) -> int:
        """The first of these that was counted; 0 for none."""
        return next((self.counts[name] for name in names if name in self.counts), 0)

    def plain(self) -> list[float]:
        """The lengths in order, whatever their role."""
        return [value for value, _ in self.lengths]


def measured(parts: list[Frame], pace: Pace) -> Measures:
    """What the frames of one shape say about it; the first of them names it.

    Raises:
        Unclear: for a measure that cannot be, or that is only said to be the same.
    """
    head = parts[0]
    found = Measures(
        shape=head.shape,
        text=head.text,
        default_m=pace.profile.defaults.distance_m,
        can_go_sideways=pace.profile.can_go_sideways,
    )
    for part in parts:
        for name, amount in part.q.items():
            _take_amount(found, head, part, name, amount)
        if {"radius", "diameter"} & set(part.roles) and "again" in part.flags and "length" not in part.q:
            raise Unclear("which_size", part.text)  # `of the same radius`
        if "number" in part.q and "length" not in part.q and set(part.roles) & {"radius", "diameter"}:
            raise Unclear("no_unit", part.q["number"].text)  # `a circle, radius 40`: a size, and no count
        if head.shape == "circle" and part.shape in ("half_circle", "quarter_circle"):
            found.shape = part.shape  # 以左侧0.8米处为圆心走半圆
        if head.shape == "sbend" and part.shape == "half_circle":
            found.angle_rad = math.pi
        _take_side(found, head, part)
        found.back = found.back or part.direction.startswith("back")
        found.sliding = found.sliding or bool({"no_turn", "sideways"} & part.flags) or part.verb == "slide"
        found.speed = pace.speed(part) or found.speed
    return found


_SIDES = {"square": 4, "rectangle": 4, "triangle": 3, **{f"polygon_{count}": count for count in range(3, 13)}}


def _take_amount(found: Measures, head: Frame, part: Frame, name: str, amount: Atom) -> None:
    value = amount.number
    if name in ("length", "angle", "time") and not (math.isfinite(value) and 0 < value <= 1000):
        raise Unclear("bad_number", amount.text)
    if name == "length" and "area" in part.roles:
        found.area_m2 = value
    elif name == "length":
        roles = list(part.roles) + (["side"] if {"each", "all"} & part.flags else [])
        found.lengths.append((value, roles + (["circumference"] if "total" in part.flags else [])))
    elif name == "angle":
        found.angle_rad = value
    elif name == "time":
        found.seconds = value
    elif name == "count" and _is_its_parts(head, part, value):
        return
    elif name == "count":
        if amount.role == "side" and value > _SIDES.get(head.shape, value):
            raise Unclear("contradiction", part.text)  # `a square with 50 sides`
        found.counts[amount.role] = whole_number(value)
        if amount.role in ("lap", "loop"):
            found.times *= whole_number(value)
    elif name == "number" and _is_said_again(part, amount):
        return
    elif name == "number" and _is_its_size(head, part, amount):
        raise Unclear("no_unit", amount.text)  # `a circle of radius 60` is not sixty circles
    elif name == "number" and head.shape in ("eight", "racetrack", "sbend"):
        return  # "its two circles"
    elif name in ("times", "number") and not _is_its_parts(head, part, value):
        _multiply(found, part, name, value)


def _take_side(found: Measures, head: Frame, part: Frame) -> None:
    if {"left_right", "right_left"} & part.flags:
        found.left, found.side_said = "left_right" in part.flags, True
        found.both_sides = True
    side = part.rot or part.direction2 or (part.direction if part.direction in SIDES else "")
    if not side and part.direction in DIAGONALS.values():
        side = part.direction.split("_")[1]
    if side and not (head.shape == "sbend" and found.side_said):
        found.left, found.side_said = side == "left", True


def _is_its_parts(head: Frame, part: Frame, value: float) -> bool:
    """8字，两个圈的半径…: the two circles that an eight has anyway."""
    both = abs(value - 2) < 1e-9 or abs(value - 4 * math.pi) < 1e-6
    return head.shape in ("eight", "sbend") and both and bool({"radius", "diameter"} & set(part.roles))


def _is_its_size(head: Frame, part: Frame, amount: Atom) -> bool:
    """Whether a bare number is a size and no count: it stands with `radius` or `side`, or behind `three legs`."""
    if part.shape == "polygon" or _is_its_parts(head, part, amount.number):
        return False
    if "length" in part.q:
        return False
    return bool(part.roles) or "count" in part.q


def _is_said_again(part: Frame, amount: Atom) -> bool:
    """`A square with side 50, that is 50 cm`: the size without its unit, and no count."""
    length = part.q.get("length")
    if length is None or not length.role or not part.roles:
        return False
    return amount.number > 1 and math.isclose(amount.number * float(length.role), length.number)


def _multiply(found: Measures, part: Frame, name: str, value: float) -> None:
    if part.shape == "polygon" and name == "number":
        found.counts["side"] = whole_number(value)
    elif name == "number" and _counts_sides(part, part.q["number"].text):
        found.some_sides = whole_number(value)
    elif part.shape == "circle" or (name == "times" and part.q["times"].value == "turns"):
        rounds = value / (2 * math.pi) if part.q[name].value == "turns" else value
        if 0 < rounds < 1 or (rounds < 10 and rounds * 4 == int(rounds * 4)):
            found.rounds *= rounds
        else:
            found.times *= whole_number(rounds)
    else:
        found.times *= whole_number(value)


def _counts_sides(part: Frame, number: str) -> bool:
    """`Two sides of a square`, `a square, four sides of 1 m`: no two and no four squares."""
    at = part.texts.index(number) + 1 if number in part.texts else len(part.texts)
    of = part.texts[at].split()[-1:] if at < len(part.texts) else []
    return part.roles[:1] == ["side"] and of == ["of"]


def whole_number(value: float, said: str = "") -> int:
    """How often, as a whole number; `said` is how it was told.

    Raises:
        Unclear: where it is none, or more than a drawing can hold.
    """
    if not math.isfinite(value) or value != int(value) or not 1 <= value <= MAX_REPEAT / 10:
        raise Unclear("bad_count", said or f"{value:g}")
    return int(value)
