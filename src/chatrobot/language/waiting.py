"""What a text says of a plan that waits: for a `go`, or for the yes to “did you mean …?”."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from chatrobot.language.acts import Read, agreeing, read_acts
from chatrobot.language.answers import with_manner
from chatrobot.language.consent import after_consent, opens_with_but
from chatrobot.language.context import Context
from chatrobot.language.edits import mirrored
from chatrobot.language.forms import read_definition
from chatrobot.language.frames import SIDES
from chatrobot.language.held import (
    adds,
    answered,
    answered_late,
    changed,
    changed_by_motion,
    changed_in_part,
    is_no_order,
    is_taken_back,
    may_be_change,
)
from chatrobot.language.interpretation import Interpretation, LanguageCode, asked_back, planned, taught
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import say
from chatrobot.language.proposals import offer, proposed
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import rephrased
from chatrobot.language.rules import form
from chatrobot.language.tokens import SILENT
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Plan

Meant = Callable[[str, Context], Interpretation]

_MOTION = frozenset({"DIR", "ROT", "SHAPE", "FULLTURN"})
"""Labels of words that only an order of its own has: `undo` and `again` are verbs and flags."""
_SURELY_ORDERED = 2.5
"""Log odds from which a clause that nobody understood was an order, and no remark with a word of motion in it."""


def of_held(text: str, reading: Reading, meant: Meant, interpreted: Meant) -> Interpretation | None:
    """What a text says of the plan that waits, or beside it; None where it is a new order, or not understood.

    Args:
        meant: reads a text as the interpreter does.
        interpreted: reads it as an order, and raises `Unclear` where it is none.
    """
    language, context = reading.language, reading.context
    held = context.dialogue.held
    if held is None and not context.dialogue.pending:
        return None
    plain = rephrased(normalise(text), language)
    if held is None:
        return answered_late(plain, reading)
    if is_taken_back(plain, language):
        return Interpretation("answered", say(language, "offer_declined"), language)
    own = _without_waiting(context)
    try:
        told = answered(plain, held.steps, reading)
        steps = changed(plain, held, reading, lambda part: interpreted(part, own)) if told is None else None
    except Unclear as problem:
        return asked_back(problem, language)
    if steps is not None:
        return proposed(planned(steps, language), language, code="held")
    found = told or meant(text, own)
    if found.outcome == "answered":
        return replace(found, proposal=offer(held, language))
    is_guess = found.plan is not None and may_be_change(plain, language)
    if is_guess or (found.proposal is not None and not found.is_held):  # it takes no place of what waits
        return asked_back(Unclear("unknown_part", found.unaccounted or text[:60]), language)
    return found


def of_offered(text: str, reading: Reading, meant: Meant) -> Interpretation | None:
    """The plan that was asked about, with what a text changes of it; None where it changes nothing.

    It is done after a yes, after a `no` that says otherwise what was refused, and where the text that was asked about
    means the same with this one added; else it is asked about again.
    """
    language, context = reading.language, reading.context
    offered, agreed = context.dialogue.offered, after_consent(text)
    if offered is None:
        return None
    asked = proposed(planned([*offered.steps], language), language)
    try:
        told = answered(rephrased(normalise(text), language), offered.steps, reading)
    except Unclear as problem:  # `what was the second step?`, of a single one
        told = asked_back(problem, language)
    if told is not None:
        return replace(told, proposal=asked.proposal if asked is not None else None)
    try:
        found = amended(agreed or text, offered, reading, meant, is_agreed=agreed is not None)
    except Unclear as problem:
        if agreed is not None:
            return asked_back(problem, language)
        found = None
    side = _bare_side(text, reading) if found is None and agreed is None else ""
    told = meant(text, context) if side else None
    if (
        told is not None and told.plan == meant(text, _without_waiting(context)).plan
    ):  # else it answers a question
        return _on_that_side(offered, side, reading) or proposed(told, language)
    if found is None:
        may_agree = (text.strip(" .,!").casefold(),) in agreeing()  # `right!`
        return asked if may_agree else None
    done = planned(list(found.steps), language)
    was_clear = bool(context.dialogue.turns) and context.dialogue.turns[-1].outcome == "refused"
    if agreed is not None or (was_clear and _corrects(text, language)) or meant(text, context).plan == found:
        return done
    return proposed(done, language)


def _bare_side(text: str, reading: Reading) -> str:
    """The side that is all that a text says: `and clockwise`; else an empty string."""
    said = [
        atom
        for atom in reading.atoms(rephrased(normalise(text), reading.language))
        if atom.kind not in SILENT
    ]
    sides = {atom.value for atom in said if atom.kind in ("dir", "rot") and atom.value in SIDES}
    return sides.pop() if len(sides) == 1 and all(atom.kind in ("dir", "rot") for atom in said) else ""


def _on_that_side(offered: Plan, side: str, reading: Reading) -> Interpretation | None:
    """The plan that was asked about to that side, asked about again; None where it goes to none, or to both."""
    try:
        steps = mirrored([*offered.steps], side == "left")
    except Unclear:
        return None
    return proposed(planned(steps, reading.language), reading.language) if steps is not None else None


def of_taught(text: str, reading: Reading, meant: Meant) -> Interpretation | None:
    """The word taught in the turn before with what a text changes of it: `no wait, make it half a metre`; else None."""
    turns, language = reading.context.dialogue.turns, reading.language
    said = rephrased(normalise(turns[-1].text), language) if turns and turns[-1].plan is None else ""
    word = read_definition(said, language) if said else None
    plan = reading.context.dialogue.words.get(word.name) if word is not None else None
    if word is None or plan is None or not _corrects(text, language):
        return None
    try:
        found = amended(text, plan, reading, meant) or meant(text, reading.context).plan
    except Unclear as problem:
        return asked_back(problem, language)
    return taught(word.name, found, language) if found is not None else None


def _corrects(text: str, language: str) -> bool:
    return form(language, "held", "instead").search(rephrased(normalise(text), language)) is not None


def amended(said: str, plan: Plan, reading: Reading, meant: Meant, *, is_agreed: bool = True) -> Plan | None:
    """The plan with what is `said` of it; None where that changes nothing of it, or is an order of its own.

    Args:
        is_agreed: a yes goes before; then a `but` may change it by a motion, and an `and then` goes on from it.
            Without one of them `ok, turn right` is an order of its own.

    Raises:
        Unclear: the plan has no such part, or several that could be meant.
    """
    plain = rephrased(normalise(said), reading.language)
    by_motion = is_agreed and opens_with_but(said)
    if not (is_no_order(plain, reading) or by_motion or (is_agreed and adds(plain, reading))):
        return None
    # `that one again but to the right` is said of the plan, and of nothing that was done before it.
    own = _without_waiting(reading.context)
    asked = TurnRecord(reading.context.dialogue.pending, "completed", plan)
    own = replace(own, dialogue=replace(own.dialogue, turns=(*own.dialogue.turns, asked)))

    def read_anew(part: str) -> Interpretation:
        return meant(part, own)

    steps = changed_in_part(plain, plan, reading, read_anew)
    paced = with_manner(plan, plain, reading) if steps is None else None
    if paced is not None:
        return paced
    if steps is None and by_motion:
        steps = changed_by_motion(plain, plan, reading, read_anew)
    return Plan(tuple(steps)) if steps is not None else None


def refers_past_question(
    plan: Plan | None,
    text: str,
    language: LanguageCode,
    context: Context,
    meant: Callable[[str, LanguageCode, Context], Interpretation],
) -> bool:
    """Whether `text` is done with a motion from before an order that was asked back about: `again`, after “how far?”.

    It may as well be meant of that order, which was not done.
    """
    before = context.dialogue
    asked = read_acts(normalise(before.pending)) if before.pending else []
    is_asked = before.offered is not None or any(map(_is_motion, asked))
    was_unclear = bool(before.turns) and before.turns[-1].outcome == "unclear"
    if plan is None or not (is_asked and was_unclear) or before.last_motion is None:
        return False
    return meant(text, language, replace(context, dialogue=replace(before, turns=()))).plan != plan


def _is_motion(read: Read) -> bool:
    """Whether a clause surely ordered a motion of its own: no undo, and no remark."""
    return read.log_odds >= _SURELY_ORDERED and any(sign.label in _MOTION for sign in read.clause.signs)


def _without_waiting(context: Context) -> Context:
    return replace(context, dialogue=replace(context.dialogue, pending="", held=None, offered=None))
