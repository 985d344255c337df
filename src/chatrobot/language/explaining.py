"""Why a text was read as it was: its clauses, the rules that rewrote it, its words, and the reading that comes next.

It reads the text anew, in the context in which it was said; nothing of it is kept while texts are understood.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from chatrobot.language.acts import MAYBE_ORDER, ORDER, Read, read_acts, without
from chatrobot.language.context import Context
from chatrobot.language.glossed import in_known_words
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.lexicon import lexicon
from chatrobot.language.names import names_in
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import describe_steps, say
from chatrobot.language.points import naming_points, with_points
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rephrase import rephrased, rewritings
from chatrobot.language.tokens import SILENT, tokenise
from chatrobot.plan.steps import Step
from chatrobot.plan.text import parse_plan

_MOST_CLAUSES = 8
"""So many clauses are left out one by one, to find the reading that comes next."""
_SHOWN = 160


class _Next(NamedTuple):
    """A reading of the text without one of its clauses."""

    steps: list[Step]
    left_out: str
    log_odds: float


def explain(text: str, context: Context, interpreter: OfflineInterpreter) -> list[str]:
    """Lines, in the language of `text`, on how it is read in this context and what follows from that."""
    meant = interpreter.interpret(text, context)
    said, context = with_points(text, context)
    language, known = in_known_words(said, context)
    plain = normalise(known)
    reads = read_acts(plain, names_in(context))

    def told(code: str, **values: float | str) -> str:
        return say(meant.language, code, **values)

    lines = [told("why_text", text=text[:_SHOWN])]
    if known != said:
        lines.append(told("why_known", text=known[:_SHOWN]))
    for read in reads:
        act = _act(read)
        sure = _percent(-read.log_odds if act == "why_talk" else read.log_odds)
        limits = {"done": _percent(ORDER), "proposed": _percent(MAYBE_ORDER)} if act == "why_doubtful" else {}
        lines.append(told(act, part=_part(plain, read), sure=sure, words=_signs(read), **limits))
    lines += [
        told("why_rule", number=number, part=part.strip(), text=after[:_SHOWN])
        for number, part, after in rewritings(plain, language)
    ]
    words = _words(rephrased(plain, language), context)
    lines += [told("why_words", words=words)] if words else []
    lines.append(_decided(meant))
    lines.append(_second(plain, reads, meant, context, interpreter))
    return [naming_points(line, context) for line in lines]


def _act(read: Read) -> str:
    if read.log_odds >= ORDER:
        return "why_order"
    return "why_talk" if read.log_odds < MAYBE_ORDER else "why_doubtful"


def _percent(log_odds: float) -> str:
    return f"{min(99.0, 100 / (1 + math.exp(-log_odds))):.0f}"


def _part(plain: str, read: Read) -> str:
    return plain[read.clause.start : read.clause.stop].strip(" ,.;:!")


def _signs(read: Read) -> str:
    """What tells an order from talk in it: each word that is in a class, and the class."""
    known = [sign for sign in read.clause.signs if sign.label != sign.text]
    return (
        ", ".join(f"{sign.text.replace('_', ' ')} = {sign.label.lower().replace('_', ' ')}" for sign in known)
        or "–"
    )


def _words(rewritten: str, context: Context) -> str:
    """The words that say what to do, with the kind and the value that each has in the lexicon."""
    atoms = read_quantities(tokenise(rewritten, lexicon(), names_in(context)))
    told = [atom for atom in atoms if atom.kind not in SILENT]
    return ", ".join(
        f"{atom.text} = {atom.kind} {'' if str(atom.value) == atom.text else atom.value}".strip()
        for atom in told
    )


def _decided(meant: Interpretation) -> str:
    """What came of it, and why: it was driven, a plan was proposed, it was asked, refused, answered or a stop."""

    def told(code: str, **values: float | str) -> str:
        return say(meant.language, code, **values)

    steps = _steps(meant)
    if meant.plan is not None:
        return told("why_driven", plan=describe_steps(steps, meant.language))
    why = (
        told("why_unaccounted", part=meant.unaccounted) if meant.unaccounted else meant.code or meant.outcome
    )
    if steps:
        return told("why_proposed", plan=describe_steps(steps, meant.language), why=why)
    return told("why_nothing", why=why, reply=meant.reply)


def _steps(meant: Interpretation) -> list[Step]:
    """The steps of the plan, or of the one that is proposed."""
    if meant.plan is not None:
        return list(meant.plan.steps)
    return list(parse_plan(meant.proposal.plan_text).steps) if meant.proposal is not None else []


def _second(
    plain: str,
    reads: Sequence[Read],
    meant: Interpretation,
    context: Context,
    interpreter: OfflineInterpreter,
) -> str:
    """The reading that comes next: without the clause that is the least likely to order anything."""
    first, found = _steps(meant), list[_Next]()
    for read in reads[:_MOST_CLAUSES] if len(reads) > 1 else ():
        other = _steps(interpreter.interpret(without(plain, reads, [read]), context))
        if other and other != first:
            found.append(_Next(other, _part(plain, read), read.log_odds))
    if not found:
        return say(meant.language, "why_no_second")
    best = min(found, key=lambda one: one.log_odds)
    return say(
        meant.language, "why_second", plan=describe_steps(best.steps, meant.language), part=best.left_out
    )
