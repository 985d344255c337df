"""What has a reader of its own, before any word is looked up: places asked about and named, what is put somewhere,
a limit, what was refused, the rest of a shape."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.language.interpretation import Interpretation, asked_back, planned
from chatrobot.language.naming import read_naming, told_what_it_would_do
from chatrobot.language.place_questions import answer_about_places
from chatrobot.language.putting import read_putting
from chatrobot.language.reading import Reading
from chatrobot.language.remembering import read_named_here
from chatrobot.language.shape_parts import part_of_shape
from chatrobot.language.starting import tries_again
from chatrobot.language.unclear import Unclear
from chatrobot.language.usual import read_limit
from chatrobot.plan.steps import Step


def read_apart(
    plain: str,
    reading: Reading,
    meant: Callable[[str], Interpretation],
    steps: Callable[[str], list[Step]],
) -> Interpretation | None:
    """What a normalised text answers, remembers, puts somewhere or goes on with; None where none of them reads it."""
    language, context = reading.language, reading.context
    told = (
        answer_about_places(plain, language, context)
        or read_limit(plain, reading)
        or read_naming(plain, language, context)
        or read_putting(plain, language, context)
        or read_named_here(plain, reading, steps)
        or told_what_it_would_do(plain, language, meant)
    )
    if told is not None:
        return told
    refused, turns = context.dialogue.refused, context.dialogue.turns
    if turns and tries_again(plain, language):
        if refused is not None and refused.wanted is not None:
            return planned([*refused.wanted.steps], language)
        if turns[-1].outcome == "unclear":
            return asked_back(Unclear("unclear_motion", plain), language)
    part = part_of_shape(plain, language, context.dialogue, steps)
    return planned(part, language) if part is not None else None
