"""Orders that tell no amount, beside something that was left out: `look to your left, that is our house`.

A drive or a turn that is as far as usual is what is done where nobody says how far. Where clauses were passed over as
talk, one of them may have told it, or the order may be meant for somebody else: then it is proposed, not done.
"""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.acts import Read, order_log_odds
from chatrobot.language.beside import any_may_bear
from chatrobot.language.lexicon import lexicon
from chatrobot.language.manner import Pace
from chatrobot.language.set_off import has_amount
from chatrobot.plan.steps import Drive, Plan, Step, Turn, Wait

_SIZED = frozenset({"FRACTION", "MULTIPLE", "SCALE", "FULLTURN", "SHAPE", "FLAG", "PLACE"})
"""Labels of words that tell how much, or point at something that does."""
SURE_BARE = 3.5
"""Clauses with higher odds of an order are one, whatever stands beside them: `the sun is out. Go forward`."""
_PRAISE = frozenset({"praise", "opening", "social", "robot"})
"""Labels of words that tell nothing and call nobody else: `well done, turn right`."""
_ARTICLE = ("num", "article")


def is_bare_order(plan: Plan | None, kept: Sequence[Read], left_out: Sequence[Read], pace: Pace) -> bool:
    """Whether all that a plan does is as far as usual by `pace`, and no clause that was read tells how far.

    What is surely ordered is none, unless an amount was left out: `v=0.4 m/s, t=5 s. Just drive it`.
    """
    if left_out and all(sign.label in _PRAISE for read in left_out for sign in read.clause.signs):
        return False
    steps = plan.steps if plan is not None else ()
    usual = bool(steps) and all(_is_usual(step, pace) for step in steps)
    is_sure = order_log_odds(kept) >= SURE_BARE and not any(has_amount(read.clause) for read in left_out)
    return usual and not is_sure and not any(map(_tells_size, kept))


def is_doubted_beside(
    plan: Plan | None, reads: Sequence[Read], talk: Sequence[Read], apart: Sequence[Read], pace: Pace
) -> bool:
    """Whether a clause that was passed over as talk may bear on the order; those `apart` surely do not."""
    kept = [read for read in reads if read not in talk]
    bears = any_may_bear(reads, [read for read in talk if read not in apart])
    return bears or is_bare_order(plan, kept, talk, pace)


def _is_usual(step: Step, pace: Pace) -> bool:
    if isinstance(step, Drive):
        return step.until is None and step.distance_m == pace.distance_m
    return isinstance(step, Wait) or (isinstance(step, Turn) and step.angle_rad == pace.turn_rad)


def _tells_size(read: Read) -> bool:
    """Whether a clause tells how much, or points at something; `three times` does not."""
    signs = read.clause.signs
    meanings = {sign.text: lexicon().words.get((sign.text,), ()) for sign in signs}
    counts = any(kind == "unit_times" for said in meanings.values() for kind, _ in said)
    number = any(sign.label == "NUMBER" and _ARTICLE not in meanings[sign.text] for sign in signs)
    sized = any(sign.label in _SIZED for sign in signs)
    return sized or (not counts and (number or has_amount(read.clause)))
