"""What the last motion leaves for the next turn: its steps, its direction, its amounts and their unit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from chatrobot.core.geometry import ORIGIN
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.ellipsis import State
from chatrobot.language.facts import chosen_unit_m
from chatrobot.language.frames import DIRECTIONS, EXTENTS, SIDES, Frame
from chatrobot.language.leading import pose_after
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rephrase import plain_text
from chatrobot.language.tokens import Atom, quantity, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait

CURVES = frozenset({"curve", "circle", "half_circle", "quarter_circle"})
"""What people call a curve by another name: `before the circle`, after a half circle."""
_LEAST_SIDES = 3
"""Fewer drives than that draw no shape."""
_NEAR = 0.01
"""Metres from where a closed way began, and parts of a round."""


def steps_of(record: TurnRecord | None) -> tuple[Step, ...]:
    """The steps of an earlier turn.

    Raises:
        Unclear: where there was none that moved.
    """
    if record is None or record.plan is None:
        raise Unclear("nothing_before")
    return record.plan.steps


def driven_steps(record: TurnRecord | None) -> tuple[Step, ...]:
    """What an earlier turn drove: its steps, and of those that were stopped as much as was measured; else nothing."""
    if record is None or record.plan is None:
        return ()
    return record.way or () if record.outcome == "stopped" else record.plan.steps


@lru_cache(maxsize=128)
def said_unit_m(text: str) -> float | None:
    """The last unit of length in what was said: `another 30` after `50 cm` are centimetres."""
    units = [float(atom.role) for atom in _atoms(text) if atom.value == "length" and atom.role]
    return units[-1] if units else None


_UNITS_M = (1.0, 0.01, 0.1, 0.001, 0.0254, 0.3048, 0.9144)


def unit_driven_m(record: TurnRecord) -> float | None:
    """The unit of length that the numbers of a turn of one drive had, said or not; None where nobody can tell."""
    step = record.plan.steps[0] if record.plan is not None and len(record.plan.steps) == 1 else None
    said = said_unit_m(record.text)
    if said or not isinstance(step, Drive) or not step.distance_m:
        return said
    numbers = [atom.number for atom in _atoms(record.text) if (atom.kind, atom.value) == ("q", "number")]
    driven = step.distance_m / numbers[0] if len(numbers) == 1 and numbers[0] > 0.0 else 0.0
    return next((unit for unit in _UNITS_M if math.isclose(unit, driven, rel_tol=1e-6)), None)


def motion_meant(dialogue: Dialogue) -> TurnRecord | None:
    """The last motion; after an undo the one that was undone: `undo that; now the same, but 50 cm`.

    Raises:
        Unclear: several turns were undone at once.
    """
    last = dialogue.last_motion
    if last is None or last.walk is None or last.walk.kind != "undo":
        return last
    done: list[TurnRecord] = []
    undone: list[TurnRecord] = []
    for turn in dialogue.turns:
        if turn.walk is not None and turn.walk.kind == "undo":
            undone = done[-turn.walk.count :]
            del done[-turn.walk.count :]
        elif turn.moved:
            done.append(turn)
    if len(undone) != 1 or undone[0].plan is None:
        raise Unclear("unclear_motion", last.text)
    return undone[0]


def turned_rad(dialogue: Dialogue, left: bool) -> float:
    """How far the unbroken run of turns on the spot has turned to that side, by their plans."""
    turned = 0.0
    for turn in reversed([turn for turn in dialogue.turns if turn.plan is not None]):
        steps = [step for step in steps_of(turn) if not isinstance(step, Wait)]
        if not all(isinstance(step, Turn) for step in steps):
            break
        turned += sum(step.angle_rad or 0.0 for step in steps if isinstance(step, Turn) and step.left == left)
        turned -= sum(step.angle_rad or 0.0 for step in steps if isinstance(step, Turn) and step.left != left)
    return turned


def speeds_said(dialogue: Dialogue) -> tuple[float | None, float | None]:
    """The speed, m/s, and the rate, rad/s, that were said of the last motion; None where it had the usual one."""
    last = dialogue.last_motion
    steps = last.plan.steps if last is not None and last.plan is not None else ()
    speeds = [step.speed_mps for step in steps if isinstance(step, (Drive, Arc)) and step.speed_mps]
    rates = [step.rate_radps for step in steps if isinstance(step, Turn) and step.rate_radps]
    return speeds[-1] if speeds else None, rates[-1] if rates else None


def _check_no_bare_repeat(frames: Sequence[Frame]) -> None:
    """`Sing`, refused, then `again`: the motion before that is not meant."""
    first = frames[0] if frames else Frame()
    if first.flags & {"again", "extra"} and not (first.moves or first.q):
        raise Unclear("unclear_motion", first.text)


def check_answers_nothing(frames: Sequence[Frame], dialogue: Dialogue) -> None:
    """A lone amount, or a lone side, goes on after a motion that said its own; else nobody can tell.

    Raises:
        Unclear: `again` after what was refused. `90 degrees` after `turn left`: so much more, or so much in all?
            `Clockwise` after `turn 180`?
    """
    refused = dialogue.turns and dialogue.turns[-1].outcome == "refused" and dialogue.turns[-1].plan is None
    if refused or dialogue.refused is not None:
        _check_no_bare_repeat(frames)
    last = _last_told(dialogue)
    if len(frames) != 1 or last is None or last.plan is None:
        return
    frame, step = frames[0], last.plan.steps[0]
    sizes = {"length", "angle", "turns"} & set(frame.q)
    if frame.verb or frame.flags or frame.roles or frame.place or frame.shape or len(frame.q) != len(sizes):
        return
    _check_no_size_of_shape(frame, sizes, last)
    if len(last.plan.steps) != 1:
        return
    way = frame.direction or frame.rot
    said = {atom.value if atom.kind == "q" else atom.kind for atom in _atoms(last.text)}
    fits = isinstance(step, Drive) if "length" in sizes else isinstance(step, Turn) and sizes
    size_open = fits and not way and not said & set(EXTENTS)
    side_open = isinstance(step, Turn) and way in SIDES and not sizes and not said & {"dir", "rot"}
    told_rad = step.angle_rad if isinstance(step, Turn) and said & {*EXTENTS, "number"} else None
    other_open = not sizes and way in SIDES and told_rad not in (None, math.pi / 2)
    if (size_open and "number" not in said) or (side_open and "uturn" not in said) or other_open:
        raise Unclear("unclear_motion", frame.text)


def _check_no_size_of_shape(frame: Frame, sizes: set[str], last: TurnRecord) -> None:
    """A lone length after `draw a square`, or 两圈 after a circle, may be its size, or its laps.

    Raises:
        Unclear: for such an amount.
    """
    said = {atom.value for atom in _atoms(last.text) if atom.kind == "q"}
    told = bool(said & set(EXTENTS)) and "turns" not in sizes
    if (
        shapes_said(last.text)
        and sizes & {"length", "turns"}
        and not told
        and not (frame.direction or frame.rot)
    ):
        raise Unclear("unclear_motion", frame.text)


def in_unit_before(amount: Atom, step: Step, unit_m: float) -> Atom:
    """`10 too many`: degrees after a turn, else the unit of the drive."""
    unit_m = unit_m if isinstance(step, Drive) else 0.0
    if amount.value == "number" and isinstance(step, (Drive, Turn, Wait)) and step.duration_s:
        return quantity("time", amount.number, amount.text)
    if amount.value != "number" or not (unit_m or isinstance(step, (Turn, Arc))):
        return amount
    name, factor = ("length", unit_m) if unit_m else ("angle", math.radians(1.0))
    return quantity(name, amount.number * factor, amount.text)


def within_unit_before(amount: Atom, step: Step, unit_m: float, most: float) -> Atom:
    """The same, where it comes to at most so many times what there was.

    Raises:
        Unclear: `too long by 50`, after 3 m.
    """
    meant = in_unit_before(amount, step, unit_m)
    if meant is not amount and meant.number > most * _extent(step):
        raise Unclear("no_unit", amount.text)
    return meant


def _extent(step: Step) -> float:
    """How far a step drives, how long it lasts, or how much it turns."""
    sizes = (getattr(step, name, None) for name in ("distance_m", "duration_s", "angle_rad"))
    return next((float(size) for size in sizes if size), math.inf)


@lru_cache(maxsize=128)
def shapes_said(text: str) -> frozenset[str]:
    """The shapes that a text names, as it stands or as it is rephrased."""
    return frozenset(atom.value for atom in (*atoms_said(text), *_atoms(text)) if atom.kind == "shape")


def atoms_said(text: str) -> list[Atom]:
    """What was said in an earlier turn, as words that mean something."""
    return _atoms(plain_text(text))


def _atoms(text: str) -> list[Atom]:
    return read_quantities(tokenise(normalise(text), lexicon(), {}))


def unit_after(context: Context) -> str:
    """The unit that a bare number most likely has after the last motion; an empty string where that tells none."""
    state, last = state_after(context), context.dialogue.last_motion
    if last is not None and last.plan is not None and getattr(last.plan.steps[-1], "duration_s", None):
        return "s"
    if state.last == "turn" and "side" not in state.sizes:
        return "deg"
    return {0.01: "cm", 0.0254: "in", 0.3048: "ft", 1.0: "m"}.get(state.unit_m or 0.0, "")


def _last_told(dialogue: Dialogue) -> TurnRecord | None:
    """The last motion; after `undo that` what was undone: `now 1.5 m` is to go its way, and not the way back."""
    last = dialogue.last_motion
    if last is None or last.walk is None or last.walk.kind != "undo":
        return last
    return next((turn for turn in reversed(dialogue.turns) if turn.plan and turn.walk is None), last)


def state_after(context: Context) -> State:
    """What the last motion leaves for an ellipsis like `thirty more`."""
    last = _last_told(context.dialogue)
    state = State(home=context.dialogue.start_pose if last is not None else None)
    chosen = (chosen_unit_m(turn.text) for turn in reversed(context.dialogue.turns))
    state.chosen_m = next((unit for unit in chosen if unit), None)
    if last is None or last.plan is None:
        return state
    sides = [step.distance_m for step in last.plan.steps if isinstance(step, Drive) and step.distance_m]
    radii = [step.radius_m for step in last.plan.steps if isinstance(step, Arc)]
    if len(sides) == len(last.plan.steps) > 1 and len(set(sides)) == 1:
        state.sizes["step"] = sides[0]
    drawn = ("side", sides, _LEAST_SIDES), ("radius", radii, 1)
    state.sizes |= {name: of[0] for name, of, least in drawn if len(set(of)) == 1 and len(of) >= least}
    for step in reversed(last.plan.steps):
        if isinstance(step, Drive):
            state.last = "drive"
            if step.distance_m:
                state.length = quantity("length", step.distance_m, f"{step.distance_m:g} m")
                said = (said_unit_m(turn.text) for turn in reversed(context.dialogue.turns))
                state.unit_m = next((unit for unit in said if unit), None)
            state.direction = _name_of(step.direction_rad)
            break
        if isinstance(step, Turn):
            state.last, state.left = "turn", step.left
            if step.angle_rad:
                state.angle = quantity("angle", step.angle_rad, f"{math.degrees(step.angle_rad):g}°")
            break
    state.of_before = _amounts_of_before(context.dialogue)
    return state


def _amounts_of_before(dialogue: Dialogue) -> dict[str, Atom]:
    """The distance of the last drive and the angle of the last turn: 左转75度, 前进半米, 往右转刚才转的角度."""
    found: dict[str, Atom] = {}
    plans = (turn.plan for turn in reversed(dialogue.turns) if turn.plan is not None and turn.walk is None)
    for step in (step for plan in plans for step in reversed(plan.steps)):
        if isinstance(step, Drive) and step.distance_m:
            found.setdefault("length", quantity("length", step.distance_m, f"{step.distance_m:g} m"))
        elif isinstance(step, Turn) and step.angle_rad:
            found.setdefault("angle", quantity("angle", step.angle_rad, f"{math.degrees(step.angle_rad):g}°"))
    return found


def _name_of(direction_rad: float) -> str:
    named = (n for n, a in DIRECTIONS.items() if abs(math.remainder(a - direction_rad, 2 * math.pi)) < 1e-6)
    return next(named, "forward")


def laps(steps: Sequence[Step], count: int) -> list[Step] | None:
    """So many more rounds of a circle, a full turn on the spot, a closed shape; None of any other way."""
    drives = [step for step in steps if isinstance(step, Drive)]
    turning = [step for step in steps if isinstance(step, (Arc, Turn))]
    if len(drives) + len(turning) != len(steps) or any(drive.distance_m is None for drive in drives):
        return None
    rounds = sum((step.angle_rad or 0.0) for step in turning) / (2 * math.pi)
    is_whole = rounds > _NEAR and abs(rounds - round(rounds)) < _NEAR
    if not is_whole or len({step.left for step in turning}) != 1:
        return None
    only = steps[0]
    if len(steps) == 1 and isinstance(only, (Arc, Turn)):
        return [replace(only, angle_rad=2 * math.pi * count)]
    end = pose_after(steps, ORIGIN)
    is_closed = (
        end is not None
        and end.distance_to(ORIGIN) < _NEAR
        and not any(isinstance(step, Arc) for step in steps)
    )
    return [*steps[: len(steps) // round(rounds)]] * count if is_closed else None
