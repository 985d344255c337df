"""Orders that tell no amount, beside something that was left out: `look to your left, that is our house`.

A drive or a turn that is as far as usual is what is done where nobody says how far. Where clauses were passed over as
talk, one of them may have told it, or the order may be meant for somebody else: then it is proposed, not done.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.language.acts import Read, order_log_odds
from chatrobot.language.lexicon import lexicon
from chatrobot.language.set_off import has_amount
from chatrobot.plan.steps import Drive, Plan, Turn, Wait

_SIZED = frozenset({"FRACTION", "MULTIPLE", "SCALE", "FULLTURN", "SHAPE", "FLAG", "PLACE"})
"""Labels of words that tell how much, or point at something that does."""
SURE_BARE = 3.5
"""Clauses with higher odds of an order are one, whatever stands beside them: `the sun is out. Go forward`."""
_ARTICLE = ("num", "article")
_USUAL = (
    *(Turn(math.pi / 2, left=left) for left in (True, False)),
    *(Drive(0.5, direction_rad=angle) for angle in (0.0, math.pi, math.pi / 2, -math.pi / 2)),
)


def is_bare_order(plan: Plan | None, kept: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether all that a plan does is as far as usual, and no clause that was read tells how far.

    What is surely ordered is none, unless an amount was left out: `v=0.4 m/s, t=5 s. Just drive it`.
    """
    steps = plan.steps if plan is not None else ()
    usual = bool(steps) and all(step in _USUAL or isinstance(step, Wait) for step in steps)
    is_sure = order_log_odds(kept) >= SURE_BARE and not any(has_amount(read.clause) for read in left_out)
    return usual and not is_sure and not any(map(_tells_size, kept))


def _tells_size(read: Read) -> bool:
    """Whether a clause tells how much, or points at something; `three times` does not."""
    signs = read.clause.signs
    meanings = {sign.text: lexicon().words.get((sign.text,), ()) for sign in signs}
    counts = any(kind == "unit_times" for said in meanings.values() for kind, _ in said)
    number = any(sign.label == "NUMBER" and _ARTICLE not in meanings[sign.text] for sign in signs)
    sized = any(sign.label in _SIZED for sign in signs)
    return sized or (not counts and (number or has_amount(read.clause)))
