"""How a text begins and ends: what opens it, a bare `go`, what is told after an order, held or taken back."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from chatrobot import reflex
from chatrobot.language.consent import after_consent
from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.frames import GO, Frame
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.rephrase import is_item
from chatrobot.language.resuming import wants_to_resume
from chatrobot.language.rules import NEVER, form
from chatrobot.language.signs import Clause, Sign, clauses_of
from chatrobot.language.tokens import tokenise
from chatrobot.language.typos import correct
from chatrobot.language.unclear import Unclear

_ALONE = ((("flag", "again"),), (("verb", "undo"),))
"""What a single word asks for, though it is mistyped."""
_BEFORE_NAME = frozenset({"opening", "social", "please", "praise", "joint"})
_LONGEST_NAME = 3
"""Of so many characters."""


def check_start(frames: Sequence[Frame], dialogue: Dialogue) -> None:
    """Ask back where nothing but `go` is said, and the turn it means was not understood or not done; or where it is to
    go on, and has not moved.

    Raises:
        Unclear: naming what was said in that turn; answers in between are passed over.
    """
    goes_on = any(_is_bare(frame) and wants_to_resume(" ".join(frame.texts)) for frame in frames[:1])
    if goes_on and not any(turn.moved for turn in dialogue.turns):
        raise Unclear("nothing_before")
    last = next((turn for turn in reversed(dialogue.turns) if turn.outcome != "answered"), None)
    not_done = last is not None and last.outcome in ("unclear", "refused")
    is_start = any(frame.verb for frame in frames) and all(_is_bare(frame) for frame in frames)
    if last is not None and not_done and is_start:
        raise Unclear("not_done_before", last.text[:60])


def without_hold(plain: str, language: str) -> str:
    """A normalised text without what holds it back; an empty string where nothing does."""
    rest = form(language, "starting", "held").sub("", plain)
    rest = form(language, "starting", "held_opening").sub("", rest)
    return form(language, "starting", "held_heading").sub("", rest).strip(" ,.;:!") if rest != plain else ""


def as_ordered(plain: str, language: str, dialogue: Dialogue) -> str:
    """A normalised text without its call sign, and without a slip in the one word that it is.

    A yes to what was asked is no call: `yes, and back`.
    """
    answers = dialogue.offered is not None and after_consent(plain) is not None
    return mended_alone(plain if answers else without_call_sign(plain, language))


def without_call_sign(plain: str, language: str) -> str:
    """A normalised text without what it calls the robot by: a number at its start (`unit four, go`), or a name that
    runs on into an order with an amount (豆豆你往后退半米).
    """
    rest = form(language, "starting", "call_sign").sub("", plain, count=1)
    if form(language, "starting", "name") is NEVER:
        return rest
    parts, start = [], 0
    for clause in clauses_of(rest):
        called = _called(clause, language) if clause.measures else ()
        if called:
            parts.append(rest[start : called[0].start])
            start = called[-1].start + len(called[-1].text)
    return "".join((*parts, rest[start:]))


def _called(clause: Clause, language: str) -> Sequence[Sign]:
    """The words that nobody knows at the start of a clause, where who is meant to do the rest is called so."""
    opened = len(list(itertools.takewhile(lambda sign: sign.label in _BEFORE_NAME, clause.signs)))
    run = list(itertools.takewhile(lambda sign: sign.label == sign.text, clause.signs[opened:]))
    after = clause.signs[opened + len(run) :][:1]
    if not after or not run or len(run) > _LONGEST_NAME:
        return ()
    pronoun = len(run) > 1 and after[0].text[0] in load_table(language, "talk")["pronouns"]
    called = "".join(sign.text for sign in run)
    if form(language, "starting", "kin").fullmatch(called):
        return ()
    name = form(language, "starting", "name").fullmatch(called)
    return run if pronoun or (name and after[0].moves) else ()


def with_told_apart(plain: str, language: str) -> str:
    """A normalised text with a mark before what it tells after an order: `back half a metre | you're on the cable`."""
    return form(language, "starting", "told_after").sub(lambda order: f"{order[0].rstrip()}, ", plain)


def mended_alone(text: str) -> str:
    """`Agian`: a text of one mistyped word that asks for the motion before once more, or takes it back."""
    if not text.isalpha() or (text,) in lexicon().words:
        return text
    word = correct(text)
    return word if lexicon().words.get((word,)) in _ALONE else text


def _is_bare(frame: Frame) -> bool:
    """Neither a direction nor an amount: `go`, `drive slowly`."""
    flags = frame.flags - {"more"}  # 继续走
    told = frame.direction or frame.rot or frame.q or frame.shape or frame.place or frame.words or flags
    return not told and frame.verb in ("", "make", *GO)


def has_a_stop_line(text: str) -> bool:
    """Whether one of several lines is a stop: lines are said one by one, and a stop counts as soon as it is there.

    A point of a list is none, nor is `then stop`: those come after what stands before them.
    """
    lines = [line for line in normalise(text).split("\n") if line.strip()]
    stops = [line for line in lines if reflex.is_stop(line) and not is_item(line)] if len(lines) > 1 else []
    return any(not _goes_on(line) for line in stops)


def _goes_on(line: str) -> bool:
    """`then stop`, 然后停."""
    beginnings = (tokenise(said, lexicon(), {}) for said in (line, line.split()[0]))
    return any(atoms[0].kind == "conn" or atoms[0].value == "finally" for atoms in beginnings if atoms)


def tries_again(plain: str, language: str) -> bool:
    """Whether a normalised text only wants what was refused to be tried once more."""
    return form(language, "starting", "retried").fullmatch(plain.strip(" .!")) is not None
