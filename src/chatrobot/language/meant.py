"""`No, I meant right`: the turn before is undone, and what was meant is done instead."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, lru_cache

from chatrobot.language.context import Context, Dialogue
from chatrobot.language.corrections import CORRECTING, MEANT, corrected
from chatrobot.language.data_files import expand, load_table
from chatrobot.language.frames import GO, SIDES, TURN, Frame
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.quantities import read_quantities
from chatrobot.language.resuming import saying
from chatrobot.language.rules import Rules, rules
from chatrobot.language.tokens import Atom, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import taken_back
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, Step, Turn
from chatrobot.robots.profile import RobotProfile


def instead(
    frames: list[Frame],
    context: Context,
    read: Callable[[list[Frame]], list[Step]],
    profile: RobotProfile,
) -> list[Step] | None:
    """The steps that put the turn before right; None where `frames` correct none that was done.

    Raises:
        Unclear: where it does not fit what was done.
    """
    if not any(MEANT in frame.flags for frame in frames):
        return None
    for frame in frames:
        frame.flags.discard(MEANT)
    if "undo" in (frames[0].verb, *frames[0].flags):
        return None  # `no, I mean, undo that and turn left`: that puts it right by itself
    if any("again" in frame.flags and not (frame.moves or frame.q) for frame in frames[1:]):
        raise Unclear(
            "unclear_motion", frames[0].text
        )  # `I meant right. Start over`: all of it, or that turn?
    last = context.dialogue.turns[-1] if context.dialogue.turns else None
    if last is None or last.plan is None or any("short_of" in frame.flags for frame in frames):
        return None  # a total is reached from where it is
    if not last.moved or (last.walk is not None and last.walk.kind == "undo"):
        return None  # after `undo that` nothing is left to be put right
    back = taken_back(context, profile, _corrected_turns(context)).steps
    done = list(last.plan.steps)
    if len(frames) == 1 and not frames[0].has_extent and not frames[0].shape and not frames[0].place:
        if (
            len(done) > 1
            and isinstance(done[-1], Turn)
            and frames[0].direction in SIDES
            and not frames[0].verb
        ):
            frames[0].verb = "turn"  # `I meant right`
        else:
            _point_back(frames[0], done)
    meant = read(frames)
    if len(done) > 1 and len(meant) == 1 and isinstance(meant[0], (Drive, Turn)):
        instead_of_turn = (
            _last_turn_instead(meant[0], done, frames[0]) if last.outcome == "completed" else None
        )
        if instead_of_turn is not None:
            return instead_of_turn
        raise Unclear("unclear_motion", frames[0].text)  # one of them was wrong: which?
    if meant == done:
        raise Unclear("unclear_motion", frames[0].text)  # `no, the other left`
    turned = all(isinstance(step, Turn) for step in done)
    absolute = isinstance(meant[0], Go) or (isinstance(meant[0], Face) and turned)
    return meant if absolute else _net(back, meant)


def _last_turn_instead(meant: Step, done: Sequence[Step], frame: Frame) -> list[Step] | None:
    """`I meant right`, after `forward 1 m, then turn left`: the one turn that was made, the last of what was done."""
    last, turns = done[-1], [step for step in done if isinstance(step, Turn)]
    if not isinstance(meant, Turn) or not isinstance(last, Turn) or len(turns) > 1 or not last.angle_rad:
        return None
    new = meant if frame.has_extent else replace(last, left=meant.left)
    return _net([replace(last, left=not last.left)], [new]) if new != last else None


def _corrected_turns(context: Context) -> int:
    """How many of the last turns are put right: the last one, and what it put right itself."""
    turns, count = context.dialogue.turns, 1
    while count < len(turns) and is_correction(turns[-count]):
        count += 1
    return count


def _point_back(frame: Frame, done: list[Step]) -> None:
    """A correction without amounts changes the motion that was done: that is how `again` reads it."""
    only = done[0] if len(done) == 1 else None
    fits = (isinstance(only, (Turn, Arc)) and frame.verb in ("", *TURN)) or (
        isinstance(only, Drive) and frame.verb in ("", *GO)
    )
    if not fits:
        if frame.verb in ("", "make"):
            raise Unclear("unclear_motion", frame.text)
        return
    across = isinstance(only, Drive) and (abs(math.sin(only.direction_rad)) > 0.5) != (
        frame.direction in SIDES
    )
    if across and frame.direction and frame.verb != "slide":
        raise Unclear("unclear_motion", frame.text)  # `left` after a drive ahead: a turn, or sideways?
    frame.verb = ""
    frame.flags.add("again")


def _net(back: Sequence[Step], meant: Sequence[Step]) -> list[Step]:
    """The way back and the way that was meant in one, where they lie on one line: 20 cm more, not 50 back and 70 on."""
    [*line] = *back, *meant
    while len(meant) == 1 and len(line) > 1:
        both = _in_one(line[0], line[1])
        if both is None:
            break
        line[:2] = [both]
    return line if len(line) == 1 else [*back, *meant]


def _in_one(first: Step, then: Step) -> Step | None:
    """Two turns, or two drives on one line, as one; None where they are others, or lead nowhere."""
    if isinstance(first, Turn) and isinstance(then, Turn) and first.angle_rad and then.angle_rad:
        net = sum(step.angle_rad * (1 if step.left else -1) for step in (first, then) if step.angle_rad)
        return replace(then, angle_rad=abs(net), left=net > 0) if abs(net) > 1e-6 else None
    if isinstance(first, Drive) and isinstance(then, Drive) and first.distance_m and then.distance_m:
        off = math.remainder(first.direction_rad - then.direction_rad, 2 * math.pi)
        net = then.distance_m + first.distance_m * math.cos(off)
        if then.until is None and abs(math.sin(off)) < 1e-6 and abs(net) > 1e-6:
            turned = math.remainder(then.direction_rad + math.pi, 2 * math.pi)
            return replace(then, distance_m=abs(net), direction_rad=then.direction_rad if net > 0 else turned)
    return None


def is_correction(record: TurnRecord | None) -> bool:
    """Whether a turn put the one before right: what it did is then not what was meant by it."""
    return record is not None and (record.corrects or says_meant(record.text))


def as_put_right(dialogue: Dialogue) -> Dialogue:
    """The last motion and what it put right as one motion: `turn left 45`, `I meant right`, `again`.

    The dialogue as it is where nothing was put right, or the two are no single motion.
    """
    moved = [turn for turn in dialogue.turns if turn.moved and turn.plan is not None]
    count = 0
    while count < len(moved) and is_correction(moved[-1 - count]):
        count += 1
    if not count or count == len(moved):
        return dialogue
    line = [step for turn in moved[-1 - count :] if turn.plan is not None for step in turn.plan.steps]
    while len(line) > 1 and (both := _in_one(line[0], line[1])) is not None:
        line[:2] = [both]
    if len(line) > 1:
        return dialogue
    whole = replace(moved[-1 - count], plan=Plan((line[0],)), executed=Plan((line[0],)))
    return replace(dialogue, turns=(*dialogue.turns, whole))


def asked_by_remark(text: str, language: str) -> str:
    """The order that a remark like `wrong way`, `it was 20 cm short` most likely asks for; empty for anything else."""
    fixed = next((order for order, says in _remarks(language) if says(text)), "")
    if fixed:
        return fixed
    plain = normalise(text)
    return next(
        (rule.applied(plain) for rule in _measured(language).that_may_match(plain) if rule.is_in(plain)), ""
    )


@cache
def _measured(language: str) -> Rules:
    parts = load_table(language, "rephrase").get("parts", {})
    return rules(f"remarks_{language}", load_table(language, "remarks").get("measured", ()), parts)


@cache
def _remarks(language: str) -> tuple[tuple[str, Callable[[str], bool]], ...]:
    table = load_table(language, "remarks")
    asks = table.get("asks", {})
    said = ((order, [form for word in words for form in expand(word)]) for order, words in asks.items())
    return tuple((order, saying(words, table["beside"], language)) for order, words in said)


@lru_cache(maxsize=128)
def says_meant(text: str) -> bool:
    """Whether `text` says what was meant instead, be it understood or not."""
    try:
        atoms: Sequence[Atom] = corrected(read_quantities(tokenise(normalise(text), lexicon(), {})))
    except Unclear:
        return False
    return any(atom.kind == "flag" and atom.value in CORRECTING for atom in atoms)
