"""`Undo that`, `undo the last two`, the same way back: earlier turns, undone."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.context import Context, TurnRecord
from chatrobot.language.frames import Frame
from chatrobot.language.inverse import inverse
from chatrobot.language.lexicon import lexicon
from chatrobot.language.numbers import is_chinese
from chatrobot.language.rephrase import plain_text
from chatrobot.language.tokens import tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step, Turn


def undone(whole: Frame, context: Context, *, turning: bool) -> list[Step]:
    """`undo that`; `undo both`, `undo the last three`: so many turns that moved, the last one first.

    `turning`: it is said to have been a turn.

    Raises:
        Unclear: where so many did not move, or were no turns.
    """
    counts = [whole.q[name] for name in ("number", "count", "times") if name in whole.q]
    both = any(text.split()[-1] in ("both", "two") for text in whole.texts)
    count = counts[0].number if counts else 2.0 if both else 1.0
    moved = _not_undone(context)
    if count != int(count) or count < 1 or set(whole.q) - {"number", "count", "times", "speed"}:
        raise Unclear("unclear_motion", whole.text)
    if counts and counts[0].role == "step" and is_chinese(counts[0].text):
        return inverse(_steps_counted(moved, int(count), whole.text))
    if len(moved) < count:
        raise Unclear("nothing_before", whole.text)
    steps = [step for turn in moved[-int(count) :] if turn.plan for step in turn.plan.steps]
    if turning and not all(isinstance(step, Turn) for step in steps):
        raise Unclear("unclear_motion", whole.text)
    return inverse(steps)


def last_two(context: Context, said: str, *, steps: bool) -> list[Step]:
    """The last two turns; with `steps`, the last two steps, if these are the same or there is but one turn.

    Raises:
        Unclear: where there were not as many, or it could mean either.
    """
    plans = [turn.plan for turn in context.dialogue.turns if turn.plan is not None]
    turns = [step for plan in plans[-2:] for step in plan.steps]
    if steps and (len(plans) < 2 or len(turns) > 2) and plans and len(plans[-1].steps) == 2:
        if len(plans) > 1:
            raise Unclear("unclear_motion", said)
        return turns
    if len(plans) < 2:
        raise Unclear("nothing_before", said)
    return turns


def _steps_counted(moved: Sequence[TurnRecord], count: int, said: str) -> list[Step]:
    """刚才两步: the last steps, where turns of one step, or a single turn, leave no doubt which.

    Raises:
        Unclear: where as many turns would be something else.
    """
    done = [step for turn in moved if turn.plan for step in turn.plan.steps]
    turns = [step for turn in moved[-count:] if turn.plan for step in turn.plan.steps]
    if len(done) < count:
        raise Unclear("nothing_before", said)
    if len(moved) >= count and turns != done[-count:]:
        raise Unclear("unclear_motion", said)
    return done[-count:]


def _not_undone(context: Context) -> list[TurnRecord]:
    """The turns that moved and still count: `undo` twice takes back two of them."""
    moved: list[TurnRecord] = []
    for turn in context.dialogue.turns:
        if turn.plan is None:
            continue
        said = tokenise(plain_text(turn.text), lexicon(), {})
        undoes = any((atom.kind, atom.value) == ("verb", "undo") for atom in said)
        before = [step for record in moved[-1:] if record.plan for step in record.plan.steps]
        if undoes and before and list(turn.plan.steps) == inverse(before):
            moved.pop()
        else:
            moved.append(turn)
    return moved


def same_way_back(context: Context) -> list[Step]:
    """All that was done in this dialogue, undone.

    Raises:
        Unclear: where nothing was done.
    """
    plans = [
        turn.plan for turn in context.dialogue.turns if turn.plan is not None and turn.outcome == "completed"
    ]
    steps = [step for plan in plans for step in plan.steps]
    if not steps:
        raise Unclear("nothing_before")
    return inverse(steps)
