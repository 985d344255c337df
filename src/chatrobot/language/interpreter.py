"""Free text → what is to happen, without a model."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from chatrobot import reflex
from chatrobot.language import questions
from chatrobot.language.acts import (
    MAYBE_ORDER,
    ORDER,
    Read,
    order_log_odds,
    read_acts,
    talk_in,
    tells_of_pace,
    without,
    without_requests,
)
from chatrobot.language.after_motion import as_meant_after
from chatrobot.language.bare_orders import is_doubted_beside
from chatrobot.language.beside import are_asides, odds_beside_asides, refers_alone
from chatrobot.language.compass import split_convention
from chatrobot.language.consent import after_consent
from chatrobot.language.context import Context
from chatrobot.language.detect import spoken, told_in
from chatrobot.language.facing import without_compass
from chatrobot.language.facts import with_known_counts
from chatrobot.language.forms import read_definition
from chatrobot.language.glossed import in_known_words, read_glossed
from chatrobot.language.interpretation import Interpretation, LanguageCode, asked_back, planned, stopped
from chatrobot.language.left_out import with_tails_parted
from chatrobot.language.likeliest import likeliest, remarked
from chatrobot.language.meant import says_meant
from chatrobot.language.misspelt import misspelt_place
from chatrobot.language.names import names_in
from chatrobot.language.normalise import MAX_CHARACTERS, normalise
from chatrobot.language.one_by_one import one_by_one
from chatrobot.language.passed_over import passed_over
from chatrobot.language.phrases import say
from chatrobot.language.place_questions import by_distance_to_place, with_spoken_place
from chatrobot.language.pointing import beside_reference
from chatrobot.language.points import naming_points, with_points
from chatrobot.language.program_request import read_program_request
from chatrobot.language.proposals import proposed
from chatrobot.language.read_apart import read_apart
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import in_full, in_full_after, rephrased, with_breaks
from chatrobot.language.resuming import of_rest
from chatrobot.language.selections import wants_part
from chatrobot.language.set_off import set_off
from chatrobot.language.slips import without_slips
from chatrobot.language.speed_limit import bounded, plan_within, within_limit, without_limit
from chatrobot.language.starting import (
    as_ordered,
    has_a_stop_line,
    with_told_apart,
    without_hold,
)
from chatrobot.language.talk import hardly_ordered, may_be_talk, not_ordered
from chatrobot.language.to_taught import to_taught
from chatrobot.language.told_twice import without_repetition
from chatrobot.language.tutorial_form import read_twists
from chatrobot.language.unclear import OF_AN_ORDER, Unclear
from chatrobot.language.unfinished import check_consistent, check_unconditional, is_choice
from chatrobot.language.waiting import amended, of_held, of_offered, of_taught, refers_past_question
from chatrobot.language.where_to import where_to
from chatrobot.language.wishes import of_wish
from chatrobot.plan.steps import Plan, Step, Wait
from chatrobot.robots.profile import RobotProfile


class OfflineInterpreter:
    """Understands English, Chinese and German by rules over data. Keeps no state: the dialogue is in the context."""

    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile

    def interpret(self, text: str, context: Context) -> Interpretation:
        """What `text` means in this context. Never raises, whatever the text."""
        language, limit_mps = spoken(text, context), context.dialogue.usual.limit_mps
        if limit_mps is not None:
            slow = OfflineInterpreter(bounded(self._profile, limit_mps))
            return within_limit(slow.interpret(text, without_limit(context)), limit_mps, self._profile)
        if len(text) > MAX_CHARACTERS:
            reply = say(language, "too_long", characters=len(text))
            return Interpretation("unclear", reply, language, code="too_long")
        try:
            rest = of_rest(text, language, context, self._with_points)
            return rest or self._with_points(text, language, context)
        except Unclear as problem:
            return asked_back(problem, language)

    def _with_points(self, text: str, language: LanguageCode, context: Context) -> Interpretation:
        said, context = with_points(text, context)
        meant = read_glossed(said, language, context, self._read)
        return replace(meant, reply=naming_points(meant.reply, context)) if said != text else meant

    def _read(self, text: str, language: LanguageCode, context: Context) -> Interpretation:
        whole, before = without_slips(in_full(normalise(text), language), language), context.dialogue
        wish = of_wish(whole, language)
        whole = wish.text if wish is not None else whole
        if before.last_motion is not None and not (before.pending or before.offered or before.held):
            whole = in_full_after(whole, language)
        try:
            whole = by_distance_to_place(whole, language, context)
            said, context = as_meant_after(with_told_apart(whole, language), language, context)
        except Unclear as problem:
            return self._remarked(whole, language, context) or asked_back(problem, language)
        said = to_taught(said, language, context)
        text = with_spoken_place(as_ordered(said, language, context.dialogue), language, context)
        waiting = self._of_waiting(text, language, context)
        meant = waiting or self._meant(text, language, context)
        offers = meant.plan is not None or (meant.proposal is not None and meant.code != "held")
        reason = not_ordered(text, language, meant.plan, context.dialogue)
        if reason and (offers or (reason == "taken_back" and meant.outcome == "unclear")):
            return asked_back(Unclear(reason, text), language)
        if passed := self._passed_over(text, meant.plan, language, context):
            return asked_back(Unclear("unclear_motion", passed), language)
        once = without_repetition(normalise(text), meant.plan) if meant.plan is not None else None
        if once is not None:
            return proposed(planned([*once.steps], language), language) or meant
        is_doubted = (wish is not None and not wish.is_sure) or hardly_ordered(said, language)
        skips = waiting is None and refers_past_question(meant.plan, text, language, context, self._meant)
        if is_doubted or skips or may_be_talk(meant, text, language, context):
            return proposed(meant, language) or meant
        return meant

    def _meant(self, text: str, language: LanguageCode, context: Context) -> Interpretation:
        try:
            return self._held(text, language, context) or self._ordered(text, language, context)
        except Unclear as problem:
            if problem.code == "condition":
                return asked_back(problem, language)
            parted = with_tails_parted(with_breaks(text, language), names_in(context))
            meant = None if parted == text or problem.is_final else self._meant(parted, language, context)
            if meant is not None and meant.plan is not None:
                return meant
            reading = Reading(language, context, self._profile)
            asked = (
                misspelt_place(problem, text, reading)
                or self._remarked(text, language, context)
                or (meant if meant is not None and meant.proposal is not None else None)
                or self._likeliest(problem, text, reading)
            )
            back = asked_back(problem, told_in(text, language, context), context.dialogue.last_text)
            return replace(asked or where_to(problem, text, reading) or back, corrects=says_meant(text))

    def _passed_over(self, text: str, plan: Plan | None, language: LanguageCode, context: Context) -> str:
        def read(rest: str) -> Plan | None:
            return self._meant(rest, language, context).plan

        turns = context.dialogue.turns
        return passed_over(normalise(text), language, plan, turns, read) if plan is not None else ""

    def _remarked(self, text: str, language: LanguageCode, context: Context) -> Interpretation | None:
        read = partial(self._interpreted, language=language, context=context)
        return remarked(text, Reading(language, context, self._profile), read)

    def amended(self, plan: Plan, said: str, context: Context) -> Plan | None:
        """The plan with what is `said` beside a yes (`sure, but slowly`); None for anything else. Never raises."""
        change = after_consent(said)
        limit_mps = context.dialogue.usual.limit_mps
        if limit_mps is not None:
            slow = OfflineInterpreter(bounded(self._profile, limit_mps))
            changed = slow.amended(plan, said, without_limit(context))
            return plan_within(changed, limit_mps, self._profile) if changed is not None else None
        if change is None:
            return None
        language, change = in_known_words(change, context)
        reading = Reading(language, context, self._profile)
        with contextlib.suppress(Unclear):
            return amended(change, plan, reading, lambda part, own: self._meant(part, language, own))
        return None

    def _likeliest(self, problem: Unclear, text: str, reading: Reading) -> Interpretation | None:
        def read(part: str, context: Context = reading.context) -> Interpretation:
            return self._interpreted(part, reading.language, context)

        def read_anew(part: str) -> Interpretation:
            dialogue = replace(reading.context.dialogue, turns=(), pending="")
            return read(part, replace(reading.context, dialogue=dialogue))

        plain = normalise(text)
        if is_choice(plain, reading.language):
            return None  # `left or right, 30 cm`: without that clause it would be another order
        reads = read_acts(plain, names_in(reading.context))
        if tells_of_pace(reads):
            return None
        pointed = beside_reference(plain, reads, read, read_anew)
        if pointed is not None:
            return pointed
        return likeliest(plain, problem, reading, read, lambda rest: self.read_order(rest, reading))

    def _held(self, text: str, language: LanguageCode, context: Context) -> Interpretation | None:
        """A plan that waits for a yes, because it is said to; None where nothing holds it back."""
        rest = without_hold(normalise(text), language)
        if not rest:
            return None
        meant = self._ordered(rest, language, context)
        return proposed(meant, language, code="held") or (meant if meant.define else None)

    def _of_waiting(self, text: str, language: LanguageCode, context: Context) -> Interpretation | None:
        """What a text says of a plan that waits for a `go` or a yes, or of a word just taught; else None."""

        def meant(part: str, own: Context) -> Interpretation:
            return self._meant(part, language, own)

        reading = Reading(language, context, self._profile)
        found = of_held(
            text, reading, meant, lambda part, own: self._interpreted(part, language, own)
        ) or of_offered(text, reading, meant)
        return found or of_taught(text, reading, meant)

    def _ordered(self, text: str, language: LanguageCode, context: Context) -> Interpretation:
        """What is ordered. A plan that no clause orders is not driven; talk beside an order is passed over.

        Raises:
            Unclear: where nothing is ordered, or what is ordered is not understood.
        """
        plain = normalise(text)
        told = read_apart(
            plain,
            Reading(language, context, self._profile),
            lambda said: self._meant(said, language, context),
            lambda part: self._steps(part, language, context),
        )
        if told is not None:
            return told
        check_unconditional(plain, language)
        names = names_in(context)
        reads = read_acts(plain, names)
        apart = set_off(plain, reads, language, names)
        talk = [] if is_choice(plain, language) else [r for r in reads if r in (*apart, *talk_in(reads))]
        if read_definition(plain, language) is not None:
            talk = []  # `our dance goes like this: …`
        rest, missing = without(plain, reads, talk), None
        if rest:
            try:
                meant = self._interpreted(rest, language, context)
                pace = Reading(language, context, self._profile).pace
                # What a request for a program tells in full is its own reader's.
                surely = talk if read_program_request(rest) else apart
                is_doubted = is_doubted_beside(meant.plan, reads, talk, surely, pace)
                return (proposed(meant, language) or meant) if is_doubted else meant
            except Unclear as problem:
                missing = problem if problem.code in OF_AN_ORDER and apart else None
        try:
            meant = self._interpreted(text, language, context)
        except Unclear as problem:
            if problem.refused and missing is not None:
                raise missing from None  # `slide over 2 feet, so I can get this ladder by`: to which side?
            asked = self._as_requested(rest or plain, problem, language, context)
            if asked is not None:
                return asked
            asks = problem.code in ("only_forbidden", "no_lasting_rule") and any(
                read.clause.asks for read in reads
            )
            if (asks or problem.code in OF_AN_ORDER) and order_log_odds(reads) < MAYBE_ORDER:
                raise Unclear("nothing_to_do") from None
            raise
        if meant.outcome != "plan" or read_twists(plain):
            return meant
        return self._surely_ordered(meant, plain, reads, language, context)

    def _as_requested(
        self, plain: str, problem: Unclear, language: LanguageCode, context: Context
    ) -> Interpretation | None:
        """What a text means without the words that request it; None where that is not read either."""
        if problem.refused or problem.code == "condition":  # `if you can turn left, …` is no request
            return None
        asked = without_requests(plain, names_in(context))
        with contextlib.suppress(Unclear):
            return self._interpreted(asked, language, context) if asked else None
        return None

    def read_order(self, text: str, reading: Reading) -> Interpretation:
        """What a normalised text orders by the rules alone: nothing is left out of it.

        Raises:
            Unclear: it is not understood.
        """
        return self._ordered(text, reading.language, reading.context)

    def _steps(self, text: str, language: LanguageCode, context: Context) -> list[Step]:
        meant = self._ordered(text, language, context)
        if meant.plan is None:
            raise Unclear(meant.code or "unclear_motion", meant.unaccounted or text[:60])
        return list(meant.plan.steps)

    def _surely_ordered(
        self,
        meant: Interpretation,
        plain: str,
        reads: Sequence[Read],
        language: LanguageCode,
        context: Context,
    ) -> Interpretation:
        """The plan that was read; proposed only, or read without doubtful talk, where its clauses hardly order it.

        Raises:
            Unclear: where no clause orders anything.
        """
        odds = odds_beside_asides(plain, reads, names_in(context))
        if refers_alone(reads) or wants_part(plain, language):
            odds = max(odds, ORDER)
        if meant.corrects and context.dialogue.turns and context.dialogue.turns[-1].moved:
            # `Oops, I meant left`: it is said of what was done, as is `too far by half a metre`, which only tells.
            return meant if odds >= ORDER or says_meant(plain) else proposed(meant, language) or meant
        if odds < MAYBE_ORDER or tells_of_pace(reads):
            raise Unclear("nothing_to_do")
        talk = talk_in(reads, doubtful=True)
        rest = without(plain, reads, talk)
        if rest:  # 左边太近了，往右平移: what tells of a side is hardly a turn
            with contextlib.suppress(Unclear):
                other = self._interpreted(rest, language, context)
                if other.plan is not None and _moves(other.plan) != _moves(meant.plan):
                    return other if are_asides(reads, talk) else proposed(other, language) or meant
        return meant if odds >= ORDER else proposed(meant, language) or meant

    def _interpreted(self, text: str, language: LanguageCode, context: Context) -> Interpretation:
        check_consistent(normalise(text), language, names_in(context))
        plain = with_known_counts(without_compass(rephrased(normalise(text), language), language))
        rest, facing_rad = split_convention(plain, language)
        plain = rest or plain
        if not plain:
            raise Unclear("empty")
        program = read_program_request(normalise(text))
        if program is not None:
            return planned(program, language)
        twists = read_twists(plain)
        if twists:
            return planned([*twists], language)
        if reflex.is_stop(text) or reflex.is_stop(plain):
            return stopped(language)
        if has_a_stop_line(text):
            return Interpretation("stop", say(language, "stop_among_lines"), language)
        courtesy = questions.courtesy_of(plain, language)
        if courtesy:
            return Interpretation("answered", say(language, f"answer_{courtesy}"), language, code=courtesy)
        reading = Reading(language, context, self._profile, facing_rad)
        read = partial(self._interpreted, language=language, context=context)
        return one_by_one(normalise(text), plain, reading, read)


def _moves(plan: Plan | None) -> list[Step]:
    return [step for step in (plan.steps if plan is not None else ()) if not isinstance(step, Wait)]
