"""A dialogue in a language that is put into English words to be read: what was said before, and what is answered."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from operator import is_

from chatrobot import reflex
from chatrobot.core.event import Proposal
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES
from chatrobot.language.detect import language_of, spoken
from chatrobot.language.gloss import MARK, Gloss, gloss
from chatrobot.language.interpretation import Interpretation, LanguageCode, stopped
from chatrobot.language.names import names_in
from chatrobot.language.of_before import told_by_before
from chatrobot.language.own_words import in_own_words
from chatrobot.language.proposals import proposed
from chatrobot.language.things import by_things
from chatrobot.plan.steps import Plan, Remember, Say, Step
from chatrobot.plan.text import format_plan, parse_plan

Reader = Callable[[str, LanguageCode, Context], Interpretation]

_QUOTES = '“„"«»‚‘'
_SHOWN = 60
"""So much of an earlier turn is quoted."""


def read_glossed(text: str, language: LanguageCode, context: Context, read: Reader) -> Interpretation:
    """What `text` means, where `read` reads only words that it knows."""
    put = by_things(text, language, context.world_places)
    if put is None:
        return _read_glossed(text, language, context, read)
    meant = in_own_words(_read_glossed(put.text, language, context, read), text)
    return meant if put.is_sure else proposed(meant, language) or meant


def _read_glossed(text: str, language: LanguageCode, context: Context, read: Reader) -> Interpretation:
    known = _context_in_known_words(context)
    told = told_by_before(text, language, known)
    if told is not None:
        return told
    if language in LANGUAGES:
        meant = read(text, language, known)
    elif reflex.is_stop(text):
        meant = stopped(language)
    else:
        said = gloss(text, language, names_in(known))
        meant = _as_said(read(said.text, language, known), said)
    return _as_said_before(in_own_words(meant, text), context, known)


def in_known_words(text: str, context: Context) -> tuple[LanguageCode, str]:
    """The language of `text`, and the text in words that the reader knows."""
    language = spoken(text, context)
    return language, text if language in LANGUAGES else _known(text, language)


def _context_in_known_words(context: Context) -> Context:
    """The context with what was said before in words that the reader knows."""
    dialogue, turns = context.dialogue, []
    language: LanguageCode = context.language or "en"
    for turn in dialogue.turns:
        language = language_of(turn.text, language)
        turns.append(turn if language in LANGUAGES else replace(turn, text=_known(turn.text, language)))
    pending = dialogue.pending
    pending_language = language_of(pending, language)
    if pending and pending_language not in LANGUAGES:
        pending = _known(pending, pending_language)
    if pending == dialogue.pending and all(map(is_, turns, dialogue.turns)):
        return context
    return replace(context, dialogue=replace(dialogue, turns=tuple(turns), pending=pending))


@lru_cache(maxsize=256)
def _known(text: str, language: LanguageCode) -> str:
    return gloss(text, language).text


def _as_said(meant: Interpretation, said: Gloss) -> Interpretation:
    """What a gloss means, with its words as the person wrote them."""
    reply, part = meant.reply, said.as_said(meant.unaccounted)
    put = {
        one.name: said.as_said(one.name)
        for one in meant.obstacles
        if one.at_m is not None or MARK in one.name
    }
    place = said.as_said(meant.remember_place).lower()
    taught = {name: said.as_said(name).lower() for name in meant.define}
    for read, written in (
        (meant.unaccounted, part),
        (meant.remember_place, place),
        *put.items(),
        *taught.items(),
    ):
        reply = _quoted(reply, read, written)
    offer = meant.proposal
    if offer is not None:
        offer = Proposal(format_plan(_as_written(parse_plan(offer.plan_text), said)), said.as_kept(offer.say))
    return replace(
        meant,
        reply=said.as_kept(reply),
        unaccounted=part,
        proposal=offer,
        plan=_as_written(meant.plan, said) if meant.plan is not None else None,
        define={taught[name]: plan for name, plan in meant.define.items()},
        remember_place=place,
        obstacles=tuple(replace(one, name=put.get(one.name, one.name)) for one in meant.obstacles),
        renamed={
            said.as_said(name).lower(): said.as_said(new).lower() for name, new in meant.renamed.items()
        },
    )


def _as_said_before(meant: Interpretation, said: Context, known: Context) -> Interpretation:
    """The reply with what it quotes of the turns before as the person said that."""
    if known is said or not meant.reply:
        return meant
    reply = meant.reply
    for was, now in zip(said.dialogue.turns, known.dialogue.turns):
        if was is not now:
            for quoted in (now.text[:_SHOWN], now.text[:_SHOWN].replace(MARK, "")):
                reply = _quoted(reply, quoted, was.text[:_SHOWN])
    waited, was_waited = known.dialogue.pending, said.dialogue.pending
    if waited != was_waited:
        reply = _quoted(reply, waited[:_SHOWN], was_waited[:_SHOWN])
    return replace(meant, reply=reply)


def _quoted(reply: str, read: str, written: str) -> str:
    """A reply that quotes what was written instead of what was read."""
    if not read:
        return reply
    return re.sub(rf"(?<=[{_QUOTES}]){re.escape(read)}(?!\w)", lambda _: written, reply, count=1)


def _as_written(plan: Plan, said: Gloss) -> Plan:
    """The plan with the names that it gives, and what it says, as they were written."""
    return Plan(tuple(_step(step, said) for step in plan.steps))


def _step(step: Step, said: Gloss) -> Step:
    if isinstance(step, Remember):
        return replace(step, place=said.as_said(step.place).lower())
    return replace(step, text=said.as_said(step.text)) if isinstance(step, Say) else step
