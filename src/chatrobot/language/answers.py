"""Answers to a question about the turn before that change what it said: `50 cm` to `forward 50`, `yes, but slowly`."""

from __future__ import annotations

import re
from dataclasses import replace

from chatrobot.language.command import read_command
from chatrobot.language.consent import after_consent
from chatrobot.language.frames import EXTENTS, GO, Frame
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.joining import MANNER
from chatrobot.language.manner import Pace
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import with_each
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, Step, Turn

_BESIDE = frozenset({"filler", "glue", "sep", "pace", "q", "dir", "rot"})
_MOTION = frozenset({"verb", "dir", "rot", "shape", "place", "defined", "number"})


def with_answered_amount(before: str, answer: str, reading: Reading) -> Interpretation | None:
    """`before` with the amount of `answer` instead of its bare number; None where it has none or no amount is answered.

    Raises:
        Unclear: where the amount fits no bare number: said beside it, it would be driven in addition.
    """
    atoms = reading.atoms(answer)
    told = [atom for atom in atoms if atom.kind != "role"]
    if not _is_amount(told, reading.atoms(before)):
        return None
    try:
        read_command(before, reading)
    except Unclear as problem:
        if problem.code == "which_size":
            return _sized(before, answer, reading)
        end = before.find(problem.part) + len(problem.part)
        if problem.code == "how_long_a_step" and end < len(before):
            return _plan_of(f"{before[:end]} {answer} {before[end:]}", reading)
        if problem.code != "no_unit" or not problem.part or told != atoms:
            return None
        for found in re.finditer(rf"(?<![\da-z.]){re.escape(problem.part)}(?![\da-z.])", before):
            amended = _plan_of(f"{before[: found.start()]} {answer} {before[found.end() :]}", reading)
            if amended is not None:
                return amended
        raise
    return None


def _sized(before: str, answer: str, reading: Reading) -> Interpretation | None:
    """A shape with the size of `answer`: `radius 1 m`, after `draw a 1 m circle`."""
    lengths = [atom.text for atom in reading.atoms(before) if (atom.kind, atom.value) == ("q", "length")]
    sizeless = before.replace(lengths[0], "", 1) if len(lengths) == 1 else before
    return _plan_of(f"{sizeless} {answer}", reading)


def _is_amount(atoms: list[Atom], before: list[Atom]) -> bool:
    """Whether they say one amount, and no way that was not said before."""
    ways = {atom.value for atom in before if atom.kind in ("dir", "rot")}
    sizes = [atom for atom in atoms if atom.kind == "q" and atom.value in EXTENTS]
    said = all(atom.kind in _BESIDE for atom in atoms)
    return said and len(sizes) == 1 and all(a.value in ways for a in atoms if a.kind in ("dir", "rot"))


def _plan_of(text: str, reading: Reading) -> Interpretation | None:
    try:
        found = read_command(" ".join(text.split()), reading)
    except Unclear:
        return None
    return found if found.outcome == "plan" else None


def changes_nothing_said(pending: str, reading: Reading) -> bool:
    """Whether it is a yes with a change (`sure, but slowly`): an answer itself, and no order to be completed."""
    if after_consent(pending) is None:
        return False
    atoms = reading.atoms(pending)
    return not any(a.kind in _MOTION or (a.kind == "q" and a.value not in MANNER) for a in atoms)


def with_manner(plan: Plan, said: str, reading: Reading) -> Plan | None:
    """The plan as fast or as slow as `said`; None where that says more than a manner, or fits no step.

    Raises:
        Unclear: where it is not understood.
    """
    frames = frames_of(reading.atoms(said))
    if len(frames) != 1 or not _is_manner(frames[0]):
        return None
    steps = tuple(with_each(step, lambda each: _paced(each, frames[0], reading.pace)) for step in plan.steps)
    return Plan(steps) if steps != plan.steps else None


def _is_manner(frame: Frame) -> bool:
    told = frame.direction or frame.rot or frame.shape or frame.place or frame.words or frame.roles
    plain = not told and frame.verb in ("", "make", *GO) and frame.flags <= {"bit", "speed_set", "more"}
    return plain and bool(frame.pace or frame.q) and frame.q.keys() <= MANNER


def _paced(step: Step, frame: Frame, pace: Pace) -> Step:
    """A relative pace is one of the speed that the step has."""
    if isinstance(step, (Drive, Arc, Go)) and "rate" not in frame.q:
        speed_mps = step.speed_mps or pace.speed_mps
        usual = replace(pace, speed_mps=speed_mps, before_mps=speed_mps)
        return replace(step, speed_mps=usual.speed(frame))
    if isinstance(step, (Turn, Face)) and "speed" not in frame.q:
        rate_radps = step.rate_radps or pace.rate_radps
        usual = replace(pace, rate_radps=rate_radps, before_radps=rate_radps)
        return replace(step, rate_radps=usual.rate(frame))
    return step
