"""What a command means; else, what it sounds like. A command put as a question, and a question, are told apart."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import replace

from chatrobot import reflex
from chatrobot.language import questions
from chatrobot.language.asked import DOINGS, answered_question
from chatrobot.language.changes import takes_from_before
from chatrobot.language.corrections import CORRECTING
from chatrobot.language.edits import edited
from chatrobot.language.figures import figure_asked, with_another_size, with_side_and_size
from chatrobot.language.frames import STILL, Frame
from chatrobot.language.heeded import check_heeded
from chatrobot.language.interpretation import Interpretation, LanguageCode, planned, stopped
from chatrobot.language.meant import is_correction
from chatrobot.language.names import names_in
from chatrobot.language.part_changed import part_changed
from chatrobot.language.phrases import say
from chatrobot.language.place_questions import answer_about_places
from chatrobot.language.proposals import proposed
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.resizing import resized
from chatrobot.language.selections import (
    check_no_manner,
    check_spoken_of,
    is_change_alone,
    names_a_part,
    names_first_time,
    part_of_before,
    points_at_before,
)
from chatrobot.language.sounds import mended
from chatrobot.language.starting import check_start
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.unfinished import breaks_off, check_finished, is_choice
from chatrobot.language.until import UntilObstacle, read_until
from chatrobot.language.usual import from_now_on
from chatrobot.plan.steps import Drive, ObstacleWithin, Step, Wait

_MOVING = frozenset({"q", "dir", "rot", "shape", "place", "defined", "number", "pace", "condition"})
_SENTENCE_END = re.compile(r"(?<=[?!.,;。])\s|(?<=[?。;])")


def read_command(plain: str, reading: Reading) -> Interpretation:
    """What a normalised text means as it stands; else, what it sounds like.

    Raises:
        Unclear: where it is no command, or one that is refused.
    """
    try:
        return _understood(plain, reading)
    except Unclear as problem:
        heard = None if problem.refused or reading.by_ear else _heard(plain, reading)
        if heard is None:
            raise
        return heard


def steps_of(clause: str, reading: Reading) -> list[Step]:
    """The steps of one clause of many; none for a clause that says nothing.

    Raises:
        Unclear: where it is no command.
    """
    atoms = reading.atoms(clause)
    if all(a.kind in SILENT for a in atoms):
        return []
    inner = read_command(clause, reading)
    if inner.plan is None:
        refused = inner.outcome == "refused"
        raise Unclear(inner.code or "unknown_part", inner.unaccounted or clause.strip(), refused=refused)
    return list(inner.plan.steps)


def _heard(plain: str, reading: Reading) -> Interpretation | None:
    if reading.language != "zh":
        return None
    try:
        found = _understood(mended(plain, reading.language), replace(reading, by_ear=True))
    except Unclear:
        return None
    return found if found.outcome == "plan" else None


def _understood(plain: str, reading: Reading) -> Interpretation:
    language = reading.language
    atoms = reading.atoms(plain)
    command = questions.without_quiz(plain, language)
    if command and not questions.is_question(command, language):
        return _understood(command, reading)
    amounts = any(a.kind == "q" and a.value in ("length", "angle", "turns") for a in atoms)
    if amounts and is_choice(plain, language):  # left or right, ninety degrees: no question of ours to answer
        raise Unclear("contradiction", plain[:60])
    _check_no_question_beside(plain, reading)
    answered = _answered(plain, atoms, reading)
    if answered is not None:
        return answered
    if _is_stop(plain, reading):
        return stopped(language)
    asks = questions.is_question(plain, language)
    _check_whole(plain, atoms, reading, asks=asks)
    until = read_until(plain, language)
    if until is not None:
        return _until(until, reading)
    check_no_manner(atoms, language)
    if names_first_time(plain, language):
        raise Unclear(
            "unclear_motion", plain[:60]
        )  # `twice as far as the first time`: of the last it says nothing
    changed = of_before(plain, atoms, reading)
    asked = None if changed else figure_asked(atoms, reading.context.dialogue)
    changed = asked or changed
    if changed is not None:
        overshot = any(a.value == "overshot" for a in atoms)
        if asked or is_change_alone(plain, language):
            return proposed(planned(changed, language), language) or planned(changed, language)
        return replace(planned(changed, language, append=_appends(atoms)), corrects=overshot)
    rest = next((a for a in atoms if a.kind == "flag" and a.value == "complete"), None)
    if rest is not None:  # the rest of what was no shape, or is told beside a motion of its own
        raise Unclear("unclear_motion", rest.text)
    frames = frames_of(atoms)
    check_start(frames, reading.context.dialogue)
    default = from_now_on(frames, reading)
    if default is not None:
        return default
    walked = reading.walked(frames)
    corrects = any(CORRECTING & frame.flags for frame in frames)
    steps = reading.steps(frames)
    if not asks:
        follows = reading.context.dialogue.last_motion is not None
        check_heeded(atoms, steps, lambda changed: reading.steps(frames_of(changed)), follows=follows)
    plan = planned(steps, language, append=_appends(atoms), walk=walked.walk if walked else None)
    return replace(plan, corrects=corrects)


_MOST_SAID_OF_PART = 2
"""Words of motion and amounts beside a part that is named: `add 20 cm to the first step`. More are a new list."""


def of_before(plain: str, atoms: list[Atom], reading: Reading) -> list[Step] | None:
    """What takes its steps from turns before: a part of them, the whole changed, or the same after a motion of its own.

    Raises:
        Unclear: there is no such part, or two readings are as likely.
    """
    dialogue, language = reading.context.dialogue, reading.language
    check_spoken_of(plain, language, dialogue)
    part = part_of_before(plain, language, dialogue, reading.atoms) or part_changed(plain, reading)
    if part is not None and dialogue.refused is not None:
        raise Unclear(
            "unclear_motion", plain[:60]
        )  # `the second step`: of what was refused, or of what was done?
    if part is not None or dialogue.last_motion is None or dialogue.last_motion.plan is None:
        return part
    before = dialogue.last_motion.plan.steps
    is_changed = any((a.kind, a.value) == ("flag", "instead") for a in atoms) and len(before) > 1
    told = [a for a in atoms if a.value != "wait" or not any(isinstance(step, Wait) for step in before)]
    own_kind = any(a.kind in ("verb", "dir", "shape") or a.value == "again" for a in told)
    if is_changed and (not own_kind or names_a_part(plain, language)):
        raise Unclear("unclear_motion", plain[:60])  # 角度改成六十度: of what was done, or once more?
    both = with_side_and_size(atoms, dialogue)
    if both is not None:
        return both
    sized = _of_another_size(plain, atoms, before, language)
    if sized is not None:
        return sized
    if len(atoms) > 2 and atoms[-2].kind == "conn" and points_at_before(atoms[-1], language):
        own = frames_of(atoms[:-2])
        if any(frame.moves for frame in own):
            if is_correction(dialogue.last_motion) or len(own) > 1:
                raise Unclear("unclear_motion", atoms[-1].text)  # what was done, or what was meant?
            return [*reading.steps_of_their_own(own), *before]
    if (waited := _waited(atoms)) and not is_correction(dialogue.last_motion):
        return [*reading.steps_of_their_own(waited), *before]
    own = frames_of(_after_again(atoms))
    if any(f.moves for f in own) and not (
        any(map(takes_from_before, own)) or is_correction(dialogue.last_motion)
    ):
        return [*before, *reading.steps_of_their_own(own)]
    return _edited_whole(plain, atoms, before, reading)


def _of_another_size(
    plain: str, atoms: list[Atom], before: Sequence[Step], language: LanguageCode
) -> list[Step] | None:
    """The motion before in the size that is told; None where none is, or it says something else besides.

    Raises:
        Unclear: it has sides of two lengths.
    """
    size = with_another_size(plain, atoms, language)
    if size is None or (len(before) == 1 and size.roles == {"side"}):
        return None
    sized = resized(list(before), size)
    if sized is None and not any(a.value == "again" for a in atoms):
        raise Unclear("which_size", size.amounts[0].text)
    return sized


def _edited_whole(
    plain: str, atoms: list[Atom], before: Sequence[Step], reading: Reading
) -> list[Step] | None:
    """All of the motion before as it is wanted now; None where that is no edit of it.

    Raises:
        Unclear: it wants no more than a part that it names.
    """
    changed = edited(atoms, reading.context.dialogue)
    leaves_out = any(a.value in ("leave_out", "first", "swapped") for a in atoms)
    again = any(a.value == "again" for a in atoms)
    said = sum(a.kind in ("verb", "q", "shape", "dir", "rot") for a in atoms)
    undoes = any((a.kind, a.value) == ("verb", "undo") for a in atoms)
    points = again or (len(before) > 1 and said <= _MOST_SAID_OF_PART and not undoes)
    if points and not (changed is not None and leaves_out) and names_a_part(plain, reading.language):
        raise Unclear("unclear_motion", plain[:60])
    return changed


def _waited(atoms: list[Atom]) -> list[Frame]:
    """What is waited before the motion before is done once more: `wait 3 s and do it again`; nothing where none is."""
    at = next((i for i, atom in enumerate(atoms) if atom.value == "again"), 0)
    after = [atom for atom in atoms[at:] if atom.value not in ("again", "extra") and atom.kind not in SILENT]
    told = {atom.value for atom in atoms[:at] if atom.kind == "q" or atom.value == "bit"}
    if after or told not in ({"time"}, {"bit"}):
        return []
    own = frames_of(atoms[:at])
    return (
        own
        if all(frame.verb in STILL and {"time", "bit"} & {*frame.q, *frame.flags} for frame in own)
        else []
    )


def _after_again(atoms: list[Atom]) -> list[Atom]:
    """What is to be done after the motion before: `the same again, and then turn left`; nothing where none is told."""
    at = next((i for i, atom in enumerate(atoms) if atom.kind not in ("filler", "glue", "sep")), 0)
    after = next((i for i, atom in enumerate(atoms[at:], at) if atom.value != "again"), len(atoms))
    conn = next((i for i, atom in enumerate(atoms[after:], after) if atom.kind != "sep"), len(atoms))
    told = at < after and conn < len(atoms) and (atoms[conn].kind, atoms[conn].value) == ("conn", "then")
    return atoms[conn + 1 :] if told else []


def _answered(plain: str, atoms: list[Atom], reading: Reading) -> Interpretation | None:
    """The answer to a question, or what is refused; None for a command.

    Raises:
        Unclear: for a doubt, or for what this robot does not do.
    """
    language = reading.language
    ability = questions.asks_ability(plain, language)
    refusal = next((a for a in atoms if a.kind == "refuse"), None)
    doubt = next((a for a in atoms if a.kind == "doubt" and a.text != "来着"), None)
    if doubt is not None and not plain.endswith("?") and refusal is None:
        raise Unclear("unknown_part", doubt.text)
    asks = ability or questions.is_question(plain, language)
    if refusal is None or (asks and questions.topic_of(plain, language) == "contact"):
        return answered_question(plain, atoms, reading, ability=ability) if asks else None
    measured = any(a.kind == "q" and a.value in ("length", "angle", "turns") for a in atoms)
    if (
        ability and plain.endswith("?") and not measured
    ):  # else it is a request, refused for something beside it
        return Interpretation("answered", say(language, "answer_cannot"), language)
    raise Unclear(f"refuse_{refusal.value}", refusal.text, refused=True)


def _check_whole(plain: str, atoms: list[Atom], reading: Reading, *, asks: bool) -> None:
    """A command that breaks off or leaves a choice open is not acted on."""
    loose = "" if asks else breaks_off(plain, reading.language)
    if loose and not any(loose.split()[-1] in key for key in names_in(reading.context)):
        raise Unclear("unknown_part", f"{loose} …")
    if is_choice(plain, reading.language):
        raise Unclear("contradiction", plain[:60])
    for before, atom in itertools.pairwise(atoms):
        if before.kind == "per" and atom.kind == "q" and atom.value in ("length", "angle", "turns", "count"):
            raise Unclear("unclear_motion", f"{before.text} {atom.text}")  # 走六米，每两米左转一下
    check_finished(atoms)


def _until(until: UntilObstacle, reading: Reading) -> Interpretation:
    frames = frames_of(reading.atoms(until.before))
    steps = reading.steps_of_their_own(frames)
    last = steps[-1]
    if not isinstance(last, Drive):
        raise Unclear("condition", until.before)
    said = frames[-1].has_extent
    steps[-1] = replace(
        last,
        distance_m=last.distance_m if said else None,
        duration_s=last.duration_s if said else None,
        until=ObstacleWithin(until.distance_m),
    )
    plan = planned([*steps, *steps_of(until.after, reading)], reading.language)
    return plan if until.is_said else proposed(plan, reading.language) or plan


def _is_stop(plain: str, reading: Reading) -> bool:
    """Whether one clause is a stop and none of the others could move anything."""
    clauses = [part for part in re.split(r"[,.;!?…—\n]| - ", plain) if part.strip()]
    stops = [reflex.is_stop(clause) for clause in clauses]
    if len(clauses) < 2 or not any(stops):
        return False
    others = [a for clause, stop in zip(clauses, stops) if not stop for a in reading.atoms(clause)]
    return not any(
        a.kind in _MOVING
        or a.value in ("other_way", "mirrored")
        or (a.kind == "verb" and a.value not in (*STILL, "make"))
        for a in others
    )


def _check_no_question_beside(plain: str, reading: Reading) -> None:
    """`Where are you? Forward 1 m`: neither is passed over for the other.

    Raises:
        Unclear: naming the question.
    """
    lines = [line.strip() for line in plain.split("\n")]
    sentences = [part.strip() for line in lines for part in _SENTENCE_END.split(line) if part.strip()]
    if len(sentences) < 2:
        return
    marked = [sentence for sentence in sentences if sentence.endswith("?") or sentence in lines]
    asked = [sentence for sentence in marked if _is_only_asked(sentence, reading)]
    if not asked:
        return
    others = [a for sentence in sentences if sentence not in asked for a in reading.atoms(sentence)]
    if any(a.kind in _MOVING or (a.kind == "verb" and a.value in DOINGS) for a in others):
        raise Unclear("question_beside", asked[0])


def _is_only_asked(sentence: str, reading: Reading) -> bool:
    """Whether it is a question that a fact answers, and nothing to be done."""
    language = reading.language
    if answer_about_places(sentence, language, reading.context) is not None:
        return True
    if not questions.is_question(sentence, language) or not questions.is_plain_question(sentence, language):
        return False
    atoms = reading.atoms(sentence)
    if any(a.kind in ("q", "shape", "rot", "defined") for a in atoms):
        return False
    try:
        answered = _answered(sentence, atoms, reading)
    except Unclear:
        return False
    return answered is not None and answered.outcome == "answered"


def _appends(atoms: list[Atom]) -> bool:
    first = next((a for a in atoms if a.kind != "filler"), None)
    return first is not None and first.kind == "conn"
