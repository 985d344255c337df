"""Which earlier motion a text refers to: `half as far as the first time`, `turn right as much as you turned left`.

What names it is `data/<code>/antecedents.toml`; the text is read on without those words, as if it followed that motion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.last_motion import atoms_said, laps, shapes_said
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.rules import Rules, rules
from chatrobot.language.selections import chosen
from chatrobot.language.step_kinds import is_of_kind
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import once_of
from chatrobot.plan.steps import Drive, Plan, Step, Turn

_SHOWN = 60


def with_antecedent(plain: str, language: str, context: Context) -> tuple[str, Context]:
    """A normalised text without what names an earlier motion, and the context up to that motion.

    Raises:
        Unclear: no motion is named so, or several may be.
    """
    for which, named in _forms(language):
        for rule in named.that_may_match(plain):
            if rule.is_in(plain):
                found = rule.search(plain) if which == "nth" else None
                dialogue = (
                    _after_part(found, plain, language, context.dialogue)
                    if found is not None
                    else _up_to(which, plain, context.dialogue)
                )
                return rule.applied(plain).strip(" ,"), replace(context, dialogue=dialogue)
    return plain, context


def _after_part(found: re.Match[str], plain: str, language: str, dialogue: Dialogue) -> Dialogue:
    """The dialogue as if the part that is pointed at had been the last motion.

    Raises:
        Unclear: there is no such part.
    """
    last = dialogue.last_motion
    if last is None:
        raise Unclear("nothing_before", plain[:_SHOWN])
    part = Plan(tuple(chosen(found, plain, language, dialogue)))
    turns = (
        (*dialogue.turns, replace(last, text="", plan=part, executed=part)) if part.steps else dialogue.turns
    )
    return replace(dialogue, turns=turns, pending="")


def _up_to(which: str, plain: str, dialogue: Dialogue) -> Dialogue:
    """The dialogue up to the motion that is meant, of which nothing but the steps of a named kind is left.

    Raises:
        Unclear: there is none, or there are several.
    """
    moved = [turn for turn in dialogue.turns if turn.plan is not None and turn.walk is None]
    if (which == "unit" and not _is_repeated(dialogue)) or (
        which in _AMOUNTS and not _is_of_other(which, moved)
    ):
        return dialogue
    found = _NTH[which](moved) if which in _NTH else _last_of_kind(_AMOUNTS.get(which, which), moved)
    if found is None:
        raise Unclear("nothing_before", plain[:_SHOWN])
    at, turn = found
    place = dialogue.turns.index(moved[at])
    return replace(dialogue, turns=(*dialogue.turns[:place], turn), pending="")


def _first(moved: Sequence[TurnRecord]) -> tuple[int, TurnRecord] | None:
    """The first of a run of motions alike that the last one ends; None where one alike lies before the run."""
    alike = [at for at, turn in enumerate(moved) if _kinds(turn) == _kinds(moved[-1])]
    is_run = alike == [*range(len(moved) - len(alike), len(moved))]
    return (alike[0], moved[alike[0]]) if is_run and len(alike) > 1 else None


def _start(moved: Sequence[TurnRecord]) -> tuple[int, TurnRecord] | None:
    return (0, moved[0]) if moved else None


def _is_of_other(amount: str, moved: Sequence[TurnRecord]) -> bool:
    """Whether the last motion has no such amount, and one before it has: `twice the distance`, after a turn."""
    has = [any(is_of_kind(step, _AMOUNTS[amount]) for step in turn.plan.steps) for turn in moved if turn.plan]
    return any(has) and not has[-1]


def _is_repeated(dialogue: Dialogue) -> bool:
    """Whether the last motion was told to be done so many times."""
    last = dialogue.last_motion
    if last is None or last.plan is None or not any(a.value == "times" for a in atoms_said(last.text)):
        return False
    return once_of([*last.plan.steps]) < len(last.plan.steps)


def _unit(moved: Sequence[TurnRecord]) -> tuple[int, TurnRecord] | None:
    """What was repeated, once: `again, but only twice`, after three times."""
    last = moved[-1] if moved else None
    if last is None or last.plan is None:
        return None
    steps = [*last.plan.steps]
    lap = laps(steps, 1) if shapes_said(last.text) else None
    once = Plan(tuple(lap or steps[: once_of(steps)]))
    return len(moved) - 1, replace(last, text="", plan=once, executed=once)


def _last_step(moved: Sequence[TurnRecord]) -> tuple[int, TurnRecord] | None:
    """The drive or turn that ended the last motion, from where it began."""
    last = moved[-1] if moved else None
    step = last.plan.steps[-1] if last is not None and last.plan is not None else None
    if last is None or last.outcome != "completed":
        return None
    if isinstance(step, Turn) and step.angle_rad:
        back = Pose(0.0, 0.0, -step.angle_rad if step.left else step.angle_rad)
    elif isinstance(step, Drive) and step.distance_m:
        x_m, y_m = math.cos(step.direction_rad), math.sin(step.direction_rad)
        back = Pose(-x_m * step.distance_m, -y_m * step.distance_m, 0.0)
    else:
        return None
    part = Plan((step,))
    return len(moved) - 1, replace(last, plan=part, executed=part, start_pose=last.end_pose.compose(back))


def _last_of_kind(kind: str, moved: Sequence[TurnRecord]) -> tuple[int, TurnRecord] | None:
    for at in reversed(range(len(moved))):
        plan = moved[at].plan
        steps = plan.steps if plan is not None else ()
        found = tuple(step for step in steps if _is_of(step, kind))
        if len(found) > 1 and len(set(found)) > 1:
            return None
        if found:
            if len(steps) == 1:
                return at, moved[at]
            part = Plan(found[:1])
            return at, replace(moved[at], plan=part, executed=part, text="")
    return None


def _is_of(step: Step, kind: str) -> bool:
    """Whether it is of a kind of `step_kinds.py`; of both in `turn_left`, of either in `ahead-back`."""
    return any(all(is_of_kind(step, part) for part in one.split("_")) for one in kind.split("-"))


def _kinds(turn: TurnRecord) -> set[tuple[str, float]]:
    """Its steps by their kinds, and of the drives which way they went."""
    steps = turn.plan.steps if turn.plan is not None else ()
    return {(step.kind, step.direction_rad if isinstance(step, Drive) else 0.0) for step in steps}


_AMOUNTS = {"distance": "leg", "angle": "turn"}
"""What has an amount that may be named without its motion, by `step_kinds.py`."""
_NTH = {"first": _first, "start": _start, "unit": _unit, "last_step": _last_step}


@cache
def _forms(language: str) -> tuple[tuple[str, Rules], ...]:
    return tuple(_listed(language))


def _listed(language: str) -> Iterator[tuple[str, Rules]]:
    table = load_table(language, "antecedents")
    parts = load_table(language, "rephrase").get("parts", {}) | table.get("parts", {})
    for which, listed in table.items():
        if which != "parts":
            pairs = [(one[0], one[1]) for one in listed]
            yield which, rules(f"antecedents_{language}_{which}", pairs, parts)
