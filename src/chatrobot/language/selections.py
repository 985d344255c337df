"""What points at a part of what was done, and wants it again: `repeat the last step`, `do the second leg again`.

The forms and their words are `data/<code>/selections.toml`. Where the last motion was one step, the turns are counted
instead. The same file has the words by which an amount or a shape takes the place of the one before.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.earlier_poses import names_earlier_pose, to_earlier_pose
from chatrobot.language.edit_words import Edit
from chatrobot.language.frames import DIRECTIONS, SIDES, TURN
from chatrobot.language.last_motion import atoms_said, laps, motion_meant, shapes_said
from chatrobot.language.measures import whole_number
from chatrobot.language.rephrase import plain_text
from chatrobot.language.resizing import resized
from chatrobot.language.selection_forms import forms, number_said
from chatrobot.language.step_kinds import is_of_kind, kind_named, places_of
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import once_of
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait

_WITHOUT = ("without", "without_nth", "without_only")


def selected(
    plain: str, language: str, dialogue: Dialogue, atoms_of: Callable[[str], list[Atom]]
) -> list[Step] | None:
    """The steps of earlier turns that a normalised text points at; None where it points at no part of them.

    Args:
        atoms_of: the atoms of a text; what stands around tells at most how often, and joins nothing on.

    Raises:
        Unclear: there is no such part.
    """
    found = pointed_at(plain, language) if dialogue.last_motion is not None else None
    if found is None:
        return None
    around = *atoms_of(plain[: found.start()]), *(after := atoms_of(plain[found.end() :]))
    counts = [a for a in around if (a.kind, a.value) == ("q", "times")]
    silent = sum(a.kind in SILENT for a in around) + len(counts) == len(around)
    if not silent or len(counts) > 1 or any(a.kind == "conn" for a in after):
        return None
    times = whole_number(counts[0].number, counts[0].text) if counts else 1
    return chosen(found, plain, language, dialogue) * times or None


def pointed_at(plain: str, language: str) -> re.Match[str] | None:
    """Where a normalised text points at a part of what was done, and wants it again."""
    return next(filter(None, (form.search(plain) for form in forms(language))), None)


def chosen(found: re.Match[str], plain: str, language: str, dialogue: Dialogue) -> list[Step]:
    """The steps that a match of `pointed_at` means; none where that is the whole of the last motion.

    Raises:
        Unclear: there is no such part.
    """
    table, said = load_table(language, "selections"), found.groupdict(default="")
    kind = kind_named(said.get("kind", ""), language)
    at, count = number_said(said, "nth", table), number_said(said, "count", table) or 1
    if at > 0:
        dialogue = _of_sequence(dialogue, language)
    units = _units(dialogue, kind, language, with_corners=kind == "leg" and count > 1)
    last = dialogue.last_motion
    if kind in ("step", "move") and last is not None and len(shapes_said(last.text)) > 1:
        raise Unclear("nothing_before", plain)  # `the second one`, of a square and a circle
    if (kind == "move" or not said.get("kind")) and (at, count) == (-1, 1):
        return []  # `the last move` is the whole of the last motion
    if at:
        first = at - 1 if at > 0 else len(units) + at - (count - 1 if at == -1 else 0)
        parts = units[first : first + count] if 0 <= first <= len(units) - count else []
    else:
        every = said.get("all") or (
            not said.get("count") and said.get("kind", "") in table.get("plurals", {})
        )
        parts = units if every or len(units) == count else []
    if not parts:
        raise Unclear("nothing_before", plain)
    steps = [step for unit in parts for step in unit]
    while kind == "leg" and not is_of_kind(steps[-1], kind):
        steps.pop()
    return steps


def _of_sequence(dialogue: Dialogue, language: str) -> Dialogue:
    """The dialogue up to a sequence of which only parts were done since: `do the third step again`, `now the first`."""
    turns = dialogue.turns
    while turns and (turns[-1].plan is None or _wants_parts(turns[-1].text, language)):
        turns = turns[:-1]
    is_sequence = bool(turns) and turns[-1].plan is not None and len(turns[-1].plan.steps) > 1
    return replace(dialogue, turns=turns) if is_sequence else dialogue


def _wants_parts(text: str, language: str) -> bool:
    """Whether a turn did parts of what was done before it once more."""
    plain = plain_text(text)
    return pointed_at(plain, language) is not None or any(
        form.fullmatch(plain) for form in forms(language, "listed")
    )


def part_of_before(
    plain: str, language: str, dialogue: Dialogue, atoms_of: Callable[[str], list[Atom]]
) -> list[Step] | None:
    """The steps of what was done that a normalised text wants again, by their parts; None where it names no part.

    Raises:
        Unclear: there is no such part.
    """
    return (
        everything(plain, language, dialogue)
        or to_earlier_pose(plain, language, dialogue)
        or left_out(plain, language, dialogue)
        or further(plain, language, dialogue)
        or with_part_resized(plain, language, dialogue, atoms_of)
        or listed(plain, language, dialogue)
        or selected(plain, language, dialogue, atoms_of)
    )


def wants_part(plain: str, language: str) -> bool:
    """Whether a normalised text is wholly one of these wishes, so that it orders something, whatever it leaves out."""
    names = ("everything", "forms", *_WITHOUT, "resized", "listed", "further")
    return names_earlier_pose(plain, language) or any(
        form.fullmatch(plain.strip(" .!")) for name in names for form in forms(language, name)
    )


def everything(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """`Repeat everything so far`: each motion that was not undone, in order; None where there are not several.

    Raises:
        Unclear: nobody can tell how one of them went.
    """
    done = dialogue.ledger.done
    if len(done) < 2 or not any(form.fullmatch(plain) for form in forms(language, "everything")):
        return None
    steps = [step for entry in done for step in entry.way or ()]
    if not all(entry.way for entry in done):
        raise Unclear("nothing_before", plain[:60])
    return steps


def left_out(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """The last motion without the part of it that is named: `everything but the wait`; None where none is left out.

    Raises:
        Unclear: there is no such part, there are several, or nothing would be left.
    """
    leaving = (form for name in _WITHOUT for form in forms(language, name))
    found = next(filter(None, (form.fullmatch(plain) for form in leaving)), None)
    last = motion_meant(dialogue) if found is not None else None
    if last is None or last.plan is None or found is None:
        return None
    table, said, steps = load_table(language, "selections"), found.groupdict(default=""), last.plan.steps
    named = said.get("kind", "")
    at = places_of(steps, named, language)
    nth = number_said(said, "nth", table)
    if nth:
        at = at[nth - 1 :][:1] if nth > 0 else at[nth:][:1]
    many = named in table["plurals"] and not nth
    rest = [step for i, step in enumerate(steps) if i not in at]
    if not at or (len(at) > 1 and not many) or all(isinstance(step, Wait) for step in rest):
        raise Unclear("unclear_motion", plain[:60])
    return rest


def with_part_resized(
    plain: str, language: str, dialogue: Dialogue, atoms_of: Callable[[str], list[Atom]]
) -> list[Step] | None:
    """The last motion with another size or side of one part: `the same, but the first leg 2 m`; else None.

    Raises:
        Unclear: there is no such part, or it takes no such size.
    """
    found = next(filter(None, (form.fullmatch(plain) for form in forms(language, "resized"))), None)
    last = motion_meant(dialogue) if found is not None else None
    if last is None or last.plan is None or found is None:
        return None
    atoms = [atom for atom in atoms_of(found["size"]) if atom.kind not in SILENT]
    table, said = load_table(language, "selections"), found.groupdict(default="")
    steps = list(last.plan.steps)
    sizes = [atom for atom in atoms if atom.kind == "q"]
    if len(sizes) > 1 or any(atom.kind not in ("q", "dir", "rot", "verb") for atom in atoms):
        return None
    at = places_of(steps, said["kind"], language)
    nth = number_said(said, "nth", table)
    at = (at[nth - 1 :] if nth > 0 else at[nth:])[:1] if nth else at if len(at) == 1 else []
    other = _on_the_way(steps[at[0]], [atom for atom in atoms if atom.kind != "q"]) if at else None
    changed = resized([other], Edit(amounts=sizes)) if other and sizes else [other] if other else None
    if changed is None:
        raise Unclear("unclear_motion", plain[:60])
    return [*steps[: at[0]], *changed, *steps[at[0] + 1 :]]


def _on_the_way(step: Step, said: Sequence[Atom]) -> Step | None:
    """The step as it goes the way that is said; None where that is no way for it."""
    ways = {atom.value for atom in said if atom.kind in ("dir", "rot")}
    turns = {atom.kind == "rot" or atom.value in TURN for atom in said if atom.kind in ("verb", "rot")}
    if turns - {isinstance(step, Turn)} or len(ways) > 1:
        return None
    if not ways:
        return step
    [way] = ways
    if isinstance(step, Turn):
        return replace(step, left=way == "left") if way in SIDES else None
    return replace(step, direction_rad=DIRECTIONS[way]) if isinstance(step, Drive) and turns else None


def is_change_alone(plain: str, language: str) -> bool:
    """第二步改成右转: whether one part is to be another, and nothing says that all is to be done again."""
    found = next(filter(None, (form.fullmatch(plain) for form in forms(language, "resized"))), None)
    return found is not None and "whole" in found.re.groupindex and not found["whole"]


def listed(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """`Only steps 2 and 3`: these parts of the last motion; None where none are listed.

    Raises:
        Unclear: there are no such parts.
    """
    last = dialogue.last_motion
    found = next(filter(None, (form.fullmatch(plain) for form in forms(language, "listed"))), None)
    if last is None or last.plan is None or found is None:
        return None
    table, said = load_table(language, "selections"), found.groupdict(default="")
    units = _units(dialogue, "step", language)
    at = [number_said({"nth": said[group]}, "nth", table) for group in ("nth", "then")]
    at = [n + len(units) + 1 if n < 0 else n for n in at]
    if not all(1 <= n <= len(units) for n in at) or len(units) < 2:
        raise Unclear("nothing_before", plain)
    return [step for n in at for step in units[n - 1]]


def _ends_with(plain: str, words: Sequence[str]) -> bool:
    """Whether one of the words ends it, whole: `undo that` is no `do that`."""
    ends = [word for word in words if plain.endswith(word)]
    return any(not word.isascii() or not plain.removesuffix(word)[-1:].isalpha() for word in ends)


def check_spoken_of(plain: str, language: str, dialogue: Dialogue) -> None:
    """`Do that` after a question: what was asked about, and not the motion before; 左转到九十度 after a turn.

    Raises:
        Unclear: nobody can tell what that is, or how much.
    """
    table = load_table(language, "selections")
    is_up_to = any(form.search(plain) for form in forms(language, "up_to"))
    if (dialogue.last_motion is not None and is_up_to) or plain.strip(" .!") in table.get("pointing", ()):
        raise Unclear("unclear_motion", plain[:60])
    moved = [turn.plan.steps for turn in dialogue.turns if turn.plan is not None]
    if len(moved) > 1 and len(moved[-1]) == 1 and plain.startswith(tuple(table.get("several", ()))):
        raise Unclear("nothing_before", plain[:60])  # `do them again`, after one motion: how many of them?
    last = dialogue.turns[-1] if dialogue.turns else None
    if last is not None and last.plan is None and _ends_with(plain.strip(" .!"), table.get("spoken_of", ())):
        raise Unclear("nothing_before", plain[:60])


_FEW = 5
"""So many more of what was done are counted without its name; more than that, or than were done, is an amount."""


def further(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """`One more step`, after three alike: so many more of them; None where the last motion was nothing so often.

    What is counted must be what was repeated.

    Raises:
        Unclear: it wants one more lap, and the last motion was none.
    """
    last = dialogue.last_motion
    found = next(filter(None, (form.fullmatch(plain) for form in forms(language, "further"))), None)
    if last is None or last.plan is None or found is None:
        return None
    steps, said = list(last.plan.steps), found.groupdict(default="")
    once = once_of(steps)
    count = number_said(said, "count", load_table(language, "selections")) or 1
    if said.get("lap"):
        is_eight = len(steps) > 1 and all(isinstance(step, Arc) for step in steps)
        more = steps * count if is_eight else laps(steps, count)
        if more is None:
            raise Unclear("which_size", plain[:60])
        return more
    if said.get("named") == "" and count > max(_FEW, len(steps) // max(once, 1)):
        return None  # `and 15 more`, after 40 cm: an amount
    if said.get("named") == "":
        whole = None if len(steps) == 1 and not isinstance(steps[0], Arc) else laps(steps, count)
        if whole is not None:
            return whole  # `two more`, after a square
        if len(steps) == 1 and any("step" in (atom.value, atom.role) for atom in atoms_said(last.text)):
            return steps * count
    return steps[:once] * count if once < len(steps) else None


def _units(dialogue: Dialogue, kind: str, language: str, *, with_corners: bool = False) -> list[list[Step]]:
    """What is counted: the steps of that kind of the last motion, or the turns that moved.

    `with_corners`: each with what comes behind it up to the next: between two sides the robot turns.

    Parts of a motion that were done once more since are not counted: `the second step again`, `now the first one`.
    """
    told = [turn for turn in dialogue.turns if turn.plan is not None and turn.walk is None]
    whole = next((i for i in reversed(range(len(told))) if not _wants_parts(told[i].text, language)), -1)
    picked_from = told[whole].plan if whole >= 0 else None
    if picked_from is not None and len(picked_from.steps) > 1 and kind != "said":
        told = told[: whole + 1]
    turns = [list(turn.plan.steps) for turn in told if turn.plan is not None] or [[]]
    if kind == "said" or len(turns[-1]) == 1:
        return [turn for turn in turns if kind == "said" or is_of_kind(turn[0], kind)]
    at = [i for i, step in enumerate(turns[-1]) if is_of_kind(step, kind)]
    return [turns[-1][i : j if with_corners else i + 1] for i, j in zip(at, [*at[1:], len(turns[-1])])]


def names_a_part(plain: str, language: str) -> bool:
    """Whether a text names a part of what was done, whatever else it says."""
    return any(form.search(plain) for form in forms(language, "mentions"))


def names_first_time(plain: str, language: str) -> bool:
    """Whether a text compares with the first time that something was done."""
    return any(form.search(plain) for form in forms(language, "first_time"))


def points_at_before(atom: Atom, language: str) -> bool:
    """Whether `again` points at the motion before, not at what is told beside it: `turn around and do the same`."""
    return atom.text in load_table(language, "selections").get("same", ())


def check_no_manner(atoms: Sequence[Atom], language: str) -> None:
    """Ask back where `again` says how a motion of its own is done: 再退一米，照旧慢慢的.

    Raises:
        Unclear: nobody can tell in what it is to be as before.
    """
    words = load_table(language, "selections").get("like_before", ())
    for i, atom in enumerate(atoms):
        ends = all(a.kind in (*SILENT, "pace") for a in atoms[i + 1 :])
        told = any(a.kind == "q" and a.value in ("length", "angle", "turns") for a in atoms[:i])
        if atom.value == "again" and atom.text in words and ends and told:
            raise Unclear("unclear_motion", atom.text)
