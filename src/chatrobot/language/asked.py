"""A question that is answered, and an order that is put as one: `can you drive?`, `could you go 2 m?`."""

from __future__ import annotations

from chatrobot.language import questions
from chatrobot.language.acts import orders as is_ordered
from chatrobot.language.frames import GO, TURN, Frame
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.place_questions import place_here
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.unfinished import check_finished, is_choice

DOINGS = frozenset({*GO, *TURN, "curve", "make", "uturn", "return"})
"""Verbs of what can be done."""


def answered_question(
    plain: str, atoms: list[Atom], reading: Reading, *, ability: bool
) -> Interpretation | None:
    """The answer, unless it is a command put as a question. `ability`: it asks whether it can.

    Raises:
        Unclear: it is to be done, and is not understood.
    """
    language = reading.language
    try:
        frames = frames_of(atoms)
        check_finished(atoms)
        steps = reading.steps(frames)
        steps = [] if is_choice(plain, language) or questions.asks_what_it_can(plain, language) else steps
        plain_question = questions.is_plain_question(plain, language)
        told = any(f.has_extent or "times" in f.q for f in frames)
        if steps and (told or any(f.moves and not plain_question and not _is_bare(f) for f in frames)):
            return None
    except Unclear:
        if _requests(plain, atoms, language, ability=ability):
            raise  # could you …: it is to be done, and no fact answers it
    if questions.orders(plain, language):
        return None
    topic = questions.topic_of(plain, language)
    if not topic and ability:
        topic = "ability"
    if not topic:
        return None
    reply = questions.answer(topic, language, reading.context, reading.profile)
    here = place_here(language, reading.context) if topic == "position" else ""
    return Interpretation("answered", f"{here} {reply}".lstrip(), language)


def _requests(plain: str, atoms: list[Atom], language: str, *, ability: bool) -> bool:
    """Whether a question that is not understood as a motion tells one all the same: `could you go 2 m zorb?`."""
    sizes = {atom.value for atom in atoms if atom.kind == "q"}
    kinds = {atom.kind for atom in atoms}
    ways = bool(kinds & {"dir", "rot", "shape"})
    doing = ways or any(a.kind == "verb" and a.value in DOINGS for a in atoms)
    amount = bool(sizes & {"length", "angle", "turns", "time", "speed"})
    if ways and "unit_length" in kinds and questions.topic_of(plain, language) in ("", "ability"):
        return True  # as many metres as …
    favour = questions.asks_a_favour(plain, language)
    is_told = is_ordered(plain) or (
        ability and not plain.endswith("?")
    )  # `can you roll 1 m, the jack needs through`
    return (doing and amount and is_told) or ((doing or amount or "times" in sizes) and favour)


def _is_bare(frame: Frame) -> bool:
    """`Can you drive?`: a verb alone asks whether it can."""
    told = frame.direction or frame.rot or frame.shape or frame.place or frame.words or frame.flags
    return not told and frame.verb in (*GO, *TURN, "curve")
