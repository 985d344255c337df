"""What a text owes to the turns before it: the question it answers, and the unit it counts in."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from chatrobot.language.acts import MAYBE_ORDER, order_log_odds, read_acts, without
from chatrobot.language.answers import changes_nothing_said, with_answered_amount
from chatrobot.language.command import read_command
from chatrobot.language.facts import defined_unit
from chatrobot.language.frames import EXTENTS, SIDES
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.last_motion import CURVES
from chatrobot.language.names import names_in
from chatrobot.language.normalise import MAX_CHARACTERS, normalise
from chatrobot.language.proposals import proposed
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import rephrased, with_breaks
from chatrobot.language.rules import form
from chatrobot.language.selection_forms import same_speed
from chatrobot.language.set_off import set_off
from chatrobot.language.sides import with_side
from chatrobot.language.talk import not_ordered
from chatrobot.language.tidy import tidy
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear
from chatrobot.language.unfinished import check_consistent
from chatrobot.language.wishes import of_wish
from chatrobot.plan.steps import Arc, Drive, Plan, Turn

_OF_ITS_OWN = frozenset({"same_amount", "again", "more", "trip"})
"""Flags of what points at the motion before or is a motion itself, and answers no question."""

_UNANSWERED = frozenset(
    {"only_forbidden", "no_lasting_rule", "nothing_before", "nothing_to_undo", "nothing_undone", "condition"}
)
"""What was said of an order that no word of an answer could complete."""
_OF_ONE_MOTION = frozenset({"which_side", "which_way", "which_size", "how_long_a_step"})
"""What was asked of an order whose motion is known."""
_PACES = frozenset({"speed", "rate"})
_TELLING = frozenset({"q", "num", "dir", "rot", "pace"})
_MOTION = frozenset(
    {"verb", "dir", "rot", "q", "shape", "place", "number", "negation", "correction", "condition"}
)


def answer_to_question(plain: str, reading: Reading) -> Interpretation | None:
    """A fragment answers what was asked back about the turn before."""
    pending = reading.context.dialogue.pending
    if not pending or len(pending) + len(plain) > MAX_CHARACTERS:
        return None
    plain = _without_reason(plain, reading)
    if any(_tells_of_others({sign.label for sign in read.clause.signs}) for read in read_acts(plain)):
        return None  # `now you are 2 m away`
    wish = of_wish(normalise(pending), reading.language)
    pending = wish.text if wish is not None else pending  # `Leo says you should slide 50 cm`, then `left`
    if not _is_open(pending, reading):
        _check_no_side_of(pending, plain, reading)
        return None
    pending = _without_talk(pending, reading)
    before = rephrased(normalise(pending), reading.language).rstrip(" .!")
    if _lacks_nothing(before, reading):
        return None  # `don't turn left`, `undo that`: what is ordered instead has nothing of it
    atoms = tidy(reading.atoms(plain))
    if all(atom.kind in SILENT for atom in atoms):
        return None  # a remark completes nothing
    plain = _side_as_before(atoms, reading) or plain
    ways = [k for k, a in enumerate(atoms) if k and a.kind == "dir" and atoms[k - 1].text == a.text]
    verbs = [a for k, a in enumerate(atoms) if k + 1 not in ways and a.text not in ("say",)]
    if any(a.kind in ("verb", "shape", "place") or a.value in _OF_ITS_OWN for a in verbs):
        return _with_measure_told(before, plain, reading)
    if _is_whole(atoms) and (
        reading.context.dialogue.offered is not None or _goes_elsewhere(before, atoms, reading)
    ):
        return None  # `forward 1 m`, after `even slower`, which was asked about: no yes to that
    amended = with_answered_amount(before, plain, reading)
    if amended is not None:
        return amended
    joined = _joined(pending, before, plain, reading)
    if joined is not None:
        return _without_yes(joined, atoms, reading)
    _check_no_side_of(pending, plain, reading)
    _ask_again(before, plain, reading)
    return None


def _check_no_side_of(pending: str, plain: str, reading: Reading) -> None:
    """To turn is no answer where a side is said of a motion that was not understood: `Leo says slide 50 cm`, `left`.

    Raises:
        Unclear: it is.
    """
    kinds = {atom.kind for atom in reading.atoms(rephrased(normalise(pending), reading.language))}
    said = {atom.kind for atom in reading.atoms(plain)} - SILENT
    if said and said <= {"dir", "rot", "role"} and "verb" in kinds and kinds & {"q", "number"}:
        raise Unclear("no_unit", pending)


def _joined(pending: str, before: str, plain: str, reading: Reading) -> Interpretation | None:
    """The plan of what was asked about and the answer together; None where they are none."""
    sided = rephrased(with_side(normalise(pending), plain, reading.language), reading.language)
    for text in filter(None, (sided, f"{before} {plain}", f"{before}, {plain}")):
        with contextlib.suppress(Unclear):
            check_consistent(text, reading.language)
            found = read_command(text, reading)
            if found.outcome == "plan":
                return found
    return None


def _without_yes(found: Interpretation, atoms: Sequence[Atom], reading: Reading) -> Interpretation | None:
    """The plan that an answer completes, as far as the answer is no yes to what was offered."""
    offered = reading.context.dialogue.offered
    if found.plan is None or _goes_on(found.plan, offered):
        return None  # `forward 2 m, perfect`, which was asked about, then `turn left`: no yes to the first
    if found.plan == offered and not any(a.kind in _TELLING or a.kind.startswith("unit") for a in atoms):
        return None  # what tells nothing of it is no yes
    told = [atom for atom in atoms if atom.kind in _TELLING]
    is_pace = bool(told) and all(atom.kind == "pace" or atom.value in _PACES for atom in told)
    return proposed(found, reading.language) if offered and is_pace else found  # nor is how fast


def _ask_again(before: str, plain: str, reading: Reading) -> None:
    """`1 m`, after `draw half a circle`: it answers another question than was asked, and is no order of its own.

    Raises:
        Unclear: what was asked before, where nothing but an amount or a way was said to it.
    """
    if any(atom.kind not in SILENT | _TELLING | {"role", "glue"} for atom in reading.atoms(plain)):
        return
    dialogue = reading.context.dialogue
    then = replace(reading.context, dialogue=replace(dialogue, turns=dialogue.turns[:-1], pending=""))
    try:
        read_command(before, replace(reading, context=then))
    except Unclear as problem:
        if problem.code in _OF_ONE_MOTION:
            said = "" if problem.code == "which_size" else f", {plain}"
            raise Unclear(problem.code, problem.part, open_text=f"{dialogue.pending}{said}") from None


def _is_open(pending: str, reading: Reading) -> bool:
    """Whether what was asked back about orders something that an answer can complete."""
    plain, language = normalise(pending), reading.language
    if order_log_odds(read_acts(plain)) < MAYBE_ORDER:
        return False
    if form(language, "talk", "confirms").fullmatch(plain.strip()):
        return False  # it said yes to what was done
    is_asked = pending.rstrip().endswith("?")
    if not is_asked and not_ordered(plain, language, None, reading.context.dialogue):
        return False  # `home, sweet home`
    return not changes_nothing_said(
        plain, reading
    )  # it was to change a plan, and did not: nothing of it is to stay


def _goes_on(plan: Plan, offered: Plan | None) -> bool:
    """Whether a plan does what was offered, and more after it."""
    return offered is not None and plan != offered and plan.steps[: len(offered.steps)] == offered.steps


def _side_as_before(atoms: list[Atom], reading: Reading) -> str:
    """The side that `the same way`, or the other, means after a turn or an arc; empty for any other text."""
    said = {atom.value for atom in atoms if atom.kind not in SILENT}
    last = reading.context.dialogue.last_motion
    steps = last.plan.steps if last is not None and last.plan is not None else ()
    if len(said) != 1 or not said <= {"same_way", "other_way"} or not steps:
        return ""
    step = steps[-1]
    if not isinstance(step, (Turn, Arc)):
        return ""
    return SIDES[step.left == ("other_way" in said)]


def _goes_elsewhere(before: str, atoms: list[Atom], reading: Reading) -> bool:
    """Whether they name a way, and the order before another one: `two steps forward`, then `1 m to the left`.

    A step alone was asked for, and has no way of its own: `forward 20 cm` is another order.
    """
    said, told = ({a.value for a in of if a.kind in ("dir", "rot")} for of in (atoms, reading.atoms(before)))
    try:
        read_command(before, reading)
    except Unclear as problem:
        if problem.code == "how_long_a_step" and said and not any(a.value == "each" for a in atoms):
            return True
    return bool(told) and not said <= told


def _is_whole(atoms: list[Atom]) -> bool:
    """Whether they say a way and how far: an order of its own."""
    kinds = {atom.kind for atom in atoms if atom.kind != "q" or atom.value in EXTENTS}
    return "q" in kinds and bool(kinds & {"dir", "rot"})


def _tells_of_others(labels: set[str]) -> bool:
    """Whether a clause states where or how somebody is or was: `my mum is on the left` names no side to turn to."""
    return "verdict" in labels and bool(labels & {"other", "kin", "earlier", "away"})


def _with_measure_told(before: str, plain: str, reading: Reading) -> Interpretation | None:
    """`Left, a quarter circle`, after `an arc, radius 1 m`: the answer, with the measure that was told before."""
    told, said = reading.atoms(before), reading.atoms(plain)
    measure = [a for a in told if a.kind == "role" or (a.kind, a.value) == ("q", "length")]
    curved = all(any(a.value in CURVES for a in atoms) for atoms in (told, said))
    if not curved or [*sorted(a.kind for a in measure)] != ["q", "role"] or _says_length(said):
        return None
    try:
        return read_command(f"{plain}, {' '.join(atom.text for atom in measure)}", reading)
    except Unclear:
        return None


def _says_length(atoms: list[Atom]) -> bool:
    return any((atom.kind, atom.value) == ("q", "length") for atom in atoms)


def _without_reason(plain: str, reading: Reading) -> str:
    """A way, without what is told behind it: `to the right, there's more room`."""
    way, told = [*re.split(r"[,.;!] ?", plain, maxsplit=1), ""][:2]
    is_way = {a.kind for a in reading.atoms(way)} - SILENT == {"dir"}
    atoms = reading.atoms(told) if told and is_way else []
    return way if atoms and not any(a.kind in _MOTION for a in atoms) else plain


def _without_talk(pending: str, reading: Reading) -> str:
    """What was asked back about, without what is set off from the order: `slide 2 feet, so I can get by`."""
    plain, names = with_breaks(normalise(pending), reading.language), names_in(reading.context)
    reads = read_acts(plain, names)
    return without(plain, reads, set_off(plain, reads, reading.language, names)) or pending


def _lacks_nothing(before: str, reading: Reading) -> bool:
    try:
        read_command(before, reading)
    except Unclear as problem:
        return problem.code in _UNANSWERED
    return False


def with_earlier_unit(plain: str, reading: Reading) -> str:
    """一步是三十厘米, said in a turn before: it holds for the steps that are counted now."""
    for turn in reversed(reading.context.dialogue.turns):
        unit = _unit_defined_in(turn.text, reading.language)
        counted = unit and re.search(rf"(?:[零一二两三四五六七八九十百\d]|半) ?{unit[0]}", plain)
        if unit and counted:
            defined_here = re.search(rf"一 ?{unit[0]}[^,。;]*(?:是|算|等于|为|按)", plain)
            return plain if defined_here else f"{plain}, 一{unit[0]}是{unit[1]}"
    return plain


def with_earlier_speed(plain: str, reading: Reading) -> str:
    """`还是原来那么快`: the speed of the motion before, in figures; nothing where that had none of its own.

    Raises:
        Unclear: there was no motion before, or it had several speeds.
    """
    found = same_speed(plain, reading.language)
    if found is None:
        return plain
    own = {atom.number for atom in reading.atoms(plain[: found.start()]) if atom.value == "speed"}
    if own:  # `1 m at 0.2 m/s, then back at the same speed`: that of this text
        told = f", 每秒{own.pop():g}米的速度" if len(own) == 1 else found.group()
        return plain[: found.start()] + told + plain[found.end() :]
    turning = re.search("角|转", found.group()) is not None
    kinds = (Turn,) if turning else (Drive, Arc)
    done = [turn.plan.steps for turn in reversed(reading.context.dialogue.turns) if turn.plan is not None]
    alike = next(
        (steps for steps in done if any(isinstance(step, kinds) for step in steps)), done[0] if done else ()
    )
    rates = {(step.rate_radps, "角速度", "弧度每秒") for step in alike if isinstance(step, Turn)}
    speeds = {(step.speed_mps, "速度", "米每秒") for step in alike if isinstance(step, (Drive, Arc))}
    named = rates if turning else speeds or rates
    if len(named) != 1:
        raise Unclear("nothing_before", found.group().strip(" ,"))
    [(amount, name, unit)] = named
    told = f", {name}{amount:g}{unit}, " if amount else ", "
    return f"{plain[: found.start()]}{told}{plain[found.end() :]}".strip(" ,;")


@lru_cache(maxsize=128)
def _unit_defined_in(text: str, language: str) -> tuple[str, str] | None:
    """Asked of every earlier turn at each sentence: so each is read once."""
    return defined_unit(rephrased(normalise(text), language))
