"""A text that is neither numbers alone nor a stop: a definition, a place, an answer, a unit, else a command."""

from __future__ import annotations

import contextlib
from dataclasses import replace

from chatrobot.language import forms
from chatrobot.language.command import read_command
from chatrobot.language.earlier_turns import (
    answer_to_question,
    with_earlier_speed,
    with_earlier_unit,
)
from chatrobot.language.facts import told_of_units
from chatrobot.language.interpretation import Interpretation, Usual, taught
from chatrobot.language.lexicon import cut
from chatrobot.language.names import names_in
from chatrobot.language.phrases import say
from chatrobot.language.reading import Reading
from chatrobot.language.remembering import read_remembering
from chatrobot.language.selection_forms import speed_for_all
from chatrobot.language.things import MARK, check_counted
from chatrobot.language.tokens import SILENT
from chatrobot.language.unclear import Unclear
from chatrobot.language.usual import read_usual
from chatrobot.plan.steps import Arc, Drive, Plan


def read_in_words(plain: str, reading: Reading) -> Interpretation:
    """What is neither numbers alone nor a stop: a definition, a place, an answer, a unit, else a command.

    Raises:
        Unclear: where none of them is understood.
    """
    check_counted(plain, reading.language)
    words = forms.read_definitions(plain, reading.language)
    if words:
        return _all_defined([_defined(one, reading) for one in words])
    answered = (
        read_usual(plain, reading) or read_remembering(plain, reading) or answer_to_question(plain, reading)
    )
    if answered is not None:
        return answered
    told = told_of_units(forms.without_nod(plain, reading.language))
    if told is not None:
        return Interpretation("answered", say(reading.language, told[0], **told[1]), reading.language)
    plain = with_earlier_unit(with_earlier_speed(plain, reading), reading)
    try:
        return _at_one_speed(plain, reading) or read_command(plain, reading)
    except Unclear:
        meant = _set_and_done(plain, reading)
        if meant is None:
            raise
        return meant


def _set_and_done(plain: str, reading: Reading) -> Interpretation | None:
    """What is set from now on and what is done under it: `from now on at 0.2 m/s. Forward 1 m`; else None."""
    for mark in MARK.finditer(plain):
        with contextlib.suppress(Unclear):
            told = read_command(plain[: mark.start()], reading)
            if told.outcome != "answered" or told.usual == Usual():
                continue
            dialogue = reading.context.dialogue
            under_it = replace(dialogue, usual=dialogue.usual.changed(told.usual))
            own = replace(reading, context=replace(reading.context, dialogue=under_it))
            meant = read_command(plain[mark.end() :], own)
            return replace(meant, usual=told.usual) if meant.plan is not None else None
    return None


def _at_one_speed(plain: str, reading: Reading) -> Interpretation | None:
    """速度0.15，左平移一米，右平移一米: the speed holds for all of them; None where one drive is told, or no speed."""
    told = speed_for_all(plain, reading.language)
    if told is None:
        return None
    speeds = [atom for atom in reading.atoms(told[0]) if atom.kind not in SILENT]
    meant = read_command(told[1], reading)
    steps = meant.plan.steps if meant.plan is not None else ()
    drives = [step for step in steps if isinstance(step, (Drive, Arc))]
    if len(drives) < 2 or [atom.value for atom in speeds] != ["speed"]:
        return None
    if any(step.speed_mps for step in drives):
        raise Unclear("unclear_motion", told[0])
    at_speed = [replace(s, speed_mps=speeds[0].number) if s in drives else s for s in steps]
    return replace(meant, plan=Plan(tuple(at_speed)))


def _defined(definition: forms.Definition, reading: Reading) -> Interpretation:
    if names_in(reading.context).get(cut(definition.name), (("", ""),))[0][0] == "place":
        raise Unclear("word_is_place", definition.name, is_final=True)  # `kitchen means turn left`
    inner = read_command(definition.body, reading)
    if inner.plan is None:
        return inner
    return taught(definition.name, inner.plan, reading.language)


def _all_defined(words: list[Interpretation]) -> Interpretation:
    """All the words of one text, or the first that is not understood."""
    failed = next((one for one in words if not one.define), None)
    if failed is not None or len(words) == 1:
        return failed or words[0]
    defined = {name: plan for one in words for name, plan in one.define.items()}
    return replace(words[0], reply=" ".join(one.reply for one in words), define=defined)
