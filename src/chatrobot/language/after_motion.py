"""What a text means by what was done before: `draw it again` after a turn, `keep going left` after a slide.

The forms are `data/<code>/after_motion.toml`: `after` has what is read otherwise, or is asked about, after such
a motion; `means` what is said of one kind of motion, so that it is read as if nothing else had been done since.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache

from chatrobot.core.geometry import wrap_angle
from chatrobot.language.antecedents import with_antecedent
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.forms import read_definition
from chatrobot.language.inverse import is_sideways
from chatrobot.language.last_motion import atoms_said, laps, shapes_said
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.meant import as_put_right
from chatrobot.language.normalise import normalise
from chatrobot.language.questions import is_question
from chatrobot.language.rephrase import in_full
from chatrobot.language.rules import Rules, rules
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import FAR_RAD
from chatrobot.plan.steps import Arc, Drive, Go, Plan, Step, Turn, Wait

_SHOWN = 60
_OTHERS = "{others}"
"""Stands in a reading for how many steps were done beside one."""
_FIGURES = ("speed_mps", "radius_m", "distance_m", "duration_s")
"""Stand in a reading, in braces: the speed of the last motion, and the other figures of the last that has one."""
_SIDE = "{side}"
"""Stands in a reading for the side to which the last turn or curve went."""
_PACES = frozenset({"speed", "time", "rate"})
_SIZES = frozenset({"length", "angle", "turns", "number", "time", "count", "speed"})


def as_meant_after(plain: str, language: str, context: Context) -> tuple[str, Context]:
    """A normalised text in words that say what it means after what was done, and the turns that it speaks of.

    Raises:
        Unclear: it may mean several things after that.
    """
    dialogue = context.dialogue
    if dialogue.pending and _was_asked(dialogue, language):
        context = replace(context, dialogue=(dialogue := replace(dialogue, pending="")))
    if dialogue.held is not None or dialogue.offered is not None or not dialogue.turns:
        return plain, context
    plain, context = with_antecedent(plain, language, context)
    dialogue = context.dialogue
    for name, is_so in _AFTER.items():
        for rule in _rules(language, "after", name).that_may_match(plain):
            if rule.is_in(plain) and is_so(dialogue):
                if not rule.said:
                    raise Unclear("unclear_motion", plain[:_SHOWN], is_final=True)
                plain = _filled(rule.applied(plain), dialogue)
    plain = _of_total(plain, language, dialogue)
    if _rules(language, "means", "again").any_in(plain):
        return plain, replace(context, dialogue=as_put_right(dialogue))
    for kind in _MEANT:
        if _rules(language, "means", kind).any_in(plain):
            return plain, replace(context, dialogue=_of_kind(kind, plain, dialogue))
    return plain, context


def _filled(said: str, dialogue: Dialogue) -> str:
    """What a rule says, with the figures of what was done in it.

    Raises:
        Unclear: nothing was done that has such a figure.
    """
    for name in _FIGURES:
        if f"{{{name}}}" in said:
            turns = [dialogue.last_motion] if name == "speed_mps" else reversed(dialogue.turns)
            said = said.replace(f"{{{name}}}", f"{_last(turns, name, said):g}")
    if _SIDE in said:
        said = said.replace(_SIDE, "left" if _last(reversed(dialogue.turns), "left", said) else "right")
    return said.replace(_OTHERS, str(sum(len(entry.way or ()) for entry in dialogue.ledger.done) - 1))


def _last(turns: Iterable[TurnRecord | None], name: str, said: str) -> float:
    """The value of that field in the last step that has one.

    Raises:
        Unclear: no step has one.
    """
    found = (getattr(step, name, None) for turn in turns for step in reversed(_steps(turn)))
    value = next((value for value in found if value is not None), None)
    if value is None:
        raise Unclear("nothing_before", said[:_SHOWN])
    return float(value)


def _of_total(plain: str, language: str, dialogue: Dialogue) -> str:
    """`Now the rest`, of a total that was announced, as that total: `3 m in total, do 1 for now`; else as it is."""
    if not _rules(language, "total", "rest").any_in(plain):
        return plain
    for turn in reversed(dialogue.turns):
        said = normalise(turn.text)
        for code in LANGUAGES:
            total = _announced(code).applied(said)
            if total != said:
                return _rules(language, "total", "put").applied(total)
    return plain


def _was_asked(dialogue: Dialogue, language: str) -> bool:
    """Whether what is open was asked about here: it lacks nothing that an answer could add."""
    before = replace(dialogue, turns=dialogue.turns[:-1], pending="")
    try:
        as_meant_after(in_full(normalise(dialogue.pending), language), language, Context(before))
    except Unclear:
        return True
    return False


def _of_kind(kind: str, plain: str, dialogue: Dialogue) -> Dialogue:
    """The dialogue up to the last motion of that kind, and of that nothing but what is of it.

    Raises:
        Unclear: there is none before the last motion, or it was one of several, or something was undone since.
    """
    last = dialogue.last_motion
    if last is None or last.plan is None or (last.walk is not None and _MEANT[kind](last, plain)):
        return dialogue
    for at in reversed(range(len(dialogue.turns))):
        turn = dialogue.turns[at]
        steps = turn.plan.steps if turn.plan is not None else ()
        found = _MEANT[kind](turn, plain)
        if not found:
            continue
        if turn is last and len(found) > 1:
            return dialogue
        if turn.walk is not None or (len(found) > 1 and len(found) < len(steps)):
            break
        part = turn if len(found) == len(steps) else replace(turn, plan=Plan(found), executed=Plan(found))
        return dialogue if part is last else replace(dialogue, turns=(*dialogue.turns[:at], part), pending="")
    if kind == "far" and not any(_drives(turn, plain) for turn in dialogue.turns):
        return dialogue
    raise Unclear("nothing_before", plain[:_SHOWN])


def _drives(turn: TurnRecord, _plain: str) -> tuple[Step, ...]:
    return tuple(step for step in _steps(turn) if isinstance(step, Drive))


def _to_a_side(turn: TurnRecord, _plain: str) -> tuple[Step, ...]:
    return tuple(step for step in _steps(turn) if isinstance(step, (Turn, Arc)) or is_sideways(step))


def _figure(turn: TurnRecord, plain: str) -> tuple[Step, ...]:
    """The whole of what drew a figure: that one, where the text names one."""
    named, drawn = shapes_said(plain), shapes_said(turn.text)
    fits = drawn & named if named else drawn or laps(_steps(turn), 1) is not None
    return _steps(turn) if fits else ()


_MEANT: Mapping[str, Callable[[TurnRecord, str], tuple[Step, ...]]] = {
    "drive": _drives,
    "far": _drives,
    "side": _to_a_side,
    "figure": _figure,
}


def _steps(turn: TurnRecord | None) -> tuple[Step, ...]:
    return turn.plan.steps if turn is not None and turn.plan is not None else ()


def _only(kind: type[Step] | tuple[type[Step], ...]) -> Callable[[Dialogue], bool]:
    def is_so(dialogue: Dialogue) -> bool:
        steps = [step for step in _steps(dialogue.last_motion) if not isinstance(step, Wait)]
        return bool(steps) and all(isinstance(step, kind) for step in steps)

    return is_so


def _is_about(dialogue: Dialogue) -> bool:
    """Whether it turned about after a drive, so that what it drove lies ahead now."""
    done = [step for turn in dialogue.turns for step in _steps(turn) if not isinstance(step, Wait)]
    drive, turn = done[-2:] if len(done) > 1 else (None, None)
    about = isinstance(turn, Turn) and abs((turn.angle_rad or 0.0) - math.pi) < 1e-3
    return about and isinstance(drive, Drive)


def _is_slide(dialogue: Dialogue) -> bool:
    return [*map(is_sideways, _steps(dialogue.last_motion))] == [True]


def _is_straight(dialogue: Dialogue) -> bool:
    """Whether its last motion was one drive ahead or back."""
    steps = _steps(dialogue.last_motion)
    [step] = steps if len(steps) == 1 else [None]
    return isinstance(step, Drive) and abs(_parts(step)[1]) < 1e-6


def _ends_askew(dialogue: Dialogue) -> bool:
    """Whether its last motion ended with a drive that was not straight ahead."""
    moves = [step for step in _steps(dialogue.last_motion) if not isinstance(step, Wait)]
    return bool(moves) and isinstance(moves[-1], Drive) and moves[-1].direction_rad != 0.0


def _is_aslant(dialogue: Dialogue) -> bool:
    steps = _steps(dialogue.last_motion)
    [step] = steps if len(steps) == 1 else [None]
    return isinstance(step, Drive) and min(map(abs, _parts(step))) > 1e-6


def _parts(step: Drive) -> tuple[float, float]:
    return math.cos(step.direction_rad), math.sin(step.direction_rad)


def _turns_last(dialogue: Dialogue) -> bool:
    return isinstance(next(iter(reversed(_steps(dialogue.last_motion))), None), (Turn, Arc))


def _draws(dialogue: Dialogue) -> bool:
    last = dialogue.last_motion
    return last is not None and bool(shapes_said(last.text) or laps(_steps(last), 1))


def _said(kinds: frozenset[str]) -> Callable[[Dialogue], bool]:
    """Whether the last motion drove, and was told with one of these amounts."""

    def is_so(dialogue: Dialogue) -> bool:
        last = dialogue.last_motion
        return last is not None and any(atom.value in kinds for atom in atoms_said(last.text))

    return is_so


def _is_told_since(dialogue: Dialogue) -> bool:
    """Whether an amount was told or asked for since the last motion: `half of that` may be half of it."""
    last = dialogue.turns[-1]
    amounts = any(atom.kind == "q" and atom.value in _SIZES for atom in atoms_said(last.text))
    return last.plan is None and (amounts or is_question(normalise(last.text), "en"))


def _is_taught(dialogue: Dialogue) -> bool:
    return (
        dialogue.turns[-1].plan is None
        and read_definition(normalise(dialogue.turns[-1].text), "en") is not None
    )


def _is_several(dialogue: Dialogue) -> bool:
    return sum(turn.plan is not None for turn in dialogue.turns) > 1


def _has_moved(dialogue: Dialogue) -> bool:
    return dialogue.last_motion is not None


def _has_been(kind: type[Step]) -> Callable[[Dialogue], bool]:
    """Whether any turn had a motion of that kind."""

    def is_so(dialogue: Dialogue) -> bool:
        return any(isinstance(step, kind) for turn in dialogue.turns for step in _steps(turn))

    return is_so


def _was_stopped(dialogue: Dialogue) -> bool:
    """Whether the last motion came to no end: its parts may be those that were told, or those that were driven."""
    last = dialogue.last_motion
    return last is not None and last.outcome == "stopped"


def _was_ordered(dialogue: Dialogue) -> bool:
    """Whether the last motion was an order of its own, and no undo of another."""
    last = dialogue.last_motion
    return last is not None and last.walk is None


def _looks_aside(dialogue: Dialogue) -> bool:
    """Whether it looks another way than in the beginning."""
    last = dialogue.last_motion
    off_rad = wrap_angle(last.end_pose.yaw_rad - dialogue.start_pose.yaw_rad) if last is not None else 0.0
    return abs(off_rad) > FAR_RAD / 4


def _has_turned(dialogue: Dialogue) -> bool:
    """Whether a turn was part of the last motion, and no place its goal, or it was a slide."""
    steps = _steps(dialogue.last_motion)
    turned = any(isinstance(step, Turn) for step in steps) and not any(isinstance(step, Go) for step in steps)
    return turned or _is_slide(dialogue)


def _not_straight(dialogue: Dialogue) -> bool:
    """Whether the last motion was more, or something else, than one drive."""
    steps = _steps(dialogue.last_motion)
    return bool(steps) and (len(steps) > 1 or not isinstance(steps[0], Drive))


_AFTER: Mapping[str, Callable[[Dialogue], bool]] = {
    "about": _is_about,
    "drive": _only(Drive),
    "straight": _is_straight,
    "backed": lambda dialogue: _is_straight(dialogue) and _ends_askew(dialogue),
    "place": _only(Go),
    "turn": _only(Turn),
    "curve": _only(Arc),
    "turning": _turns_last,
    "slide": _is_slide,
    "aslant": _is_aslant,
    "askew": _ends_askew,
    "figure": _draws,
    "clock": _said(frozenset({"clock"})),
    "paced": lambda dialogue: _only((Drive, Arc))(dialogue) and _said(_PACES)(dialogue),
    "told": _is_told_since,
    "taught": _is_taught,
    "several": lambda dialogue: _is_several(dialogue) and not _not_straight(dialogue),
    "not_straight": _not_straight,
    "off_line": lambda dialogue: _not_straight(dialogue) or _is_slide(dialogue),
    "turned": _has_turned,
    "eight": lambda dialogue: len(_steps(dialogue.last_motion)) > 1 and _only(Arc)(dialogue),
    "pair": lambda dialogue: len(_steps(dialogue.last_motion)) == 2,
    "sequence": lambda dialogue: len(_steps(dialogue.last_motion)) > 1,
    "aside": _looks_aside,
    "just": lambda dialogue: dialogue.turns[-1].plan is not None,
    "turns": lambda dialogue: len(dialogue.ledger.done) > 1,
    "own": _was_ordered,
    "moved": _has_moved,
    "curved": _has_been(Arc),
    "driven": _has_been(Drive),
    "stopped": _was_stopped,
}


@cache
def _announced(language: str) -> Rules:
    return rules(f"announced_{language}", load_table(language, "totals").get("announced", ()), {})


@cache
def _rules(language: str, table: str, name: str) -> Rules:
    listed = load_table(language, "after_motion").get(table, {}).get(name, ())
    pairs: Iterator[tuple[str, str]] = (
        (one, "") if isinstance(one, str) else (one[0], one[1]) for one in listed
    )
    parts = load_table(language, "rephrase").get("parts", {}) | load_table(language, "after_motion").get(
        "parts", {}
    )
    return rules(f"after_motion_{language}_{table}_{name}", list(pairs), parts)
