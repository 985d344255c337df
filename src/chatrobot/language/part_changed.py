"""A part of what was done, with something else about it: `the last leg again but twice as far`."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.language.context import Context
from chatrobot.language.dialogue import refer
from chatrobot.language.first_side import begun_on
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.reading import Reading, frames_of
from chatrobot.language.selections import chosen, pointed_at
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.plan.steps import Plan, Step

_CHANGING = frozenset({"q", "dir", "rot", "pace", "flag"})


def part_changed(plain: str, reading: Reading) -> list[Step] | None:
    """The steps of a part that a normalised text points at, as the rest of the text wants them now; all of them,
    begun on a side that it names.

    None where it points at no part, or says more of it than a change.

    Raises:
        Unclear: there is no such part, or the change fits it not.
    """
    dialogue = reading.context.dialogue
    begun = begun_on(plain, reading.language, dialogue)
    if begun is not None:
        return begun
    found = pointed_at(plain, reading.language) if dialogue.last_motion is not None else None
    if found is None:
        return None
    around = [*reading.atoms(plain[: found.start()]), *reading.atoms(plain[found.end() :])]
    said = [atom for atom in around if atom.kind not in SILENT]
    steps = chosen(found, plain, reading.language, dialogue)
    if not steps or not said or any(atom.kind not in _CHANGING for atom in said):
        return None
    frames = frames_of([Atom("flag", "again", found[0]), *said])
    return refer(frames, as_if_done(steps, "", reading.context), reading.pace)


def as_if_done(steps: list[Step], text: str, context: Context) -> Context:
    """The context in which these steps were the last motion, and `text` was said for it."""
    dialogue, pose = context.dialogue, context.state.pose
    done = TurnRecord(text, "completed", Plan(tuple(steps)), pose, pose)
    return replace(context, dialogue=replace(dialogue, turns=(*dialogue.turns, done), pending=""))
