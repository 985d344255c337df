"""What an edit of the last motion says, word by word: `once more`, `with 90 instead of 45`, `the second step`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from chatrobot.language.arithmetic import is_another, sign_of
from chatrobot.language.frames import GO, SIDES, TURN
from chatrobot.language.measures import whole_number
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn, Wait

_IDLE = frozenset({"filler", "glue", "sep", "reason"})
_POINTING = frozenset({"again", "same_amount", "more", "both", "do_this", "each"})
_CHANGING = frozenset(
    {
        "other_way",
        "leave_out",
        "swapped",
        "complete",
        "amounts",
        "overshot",
        "instead",
        "all",
        "first",
        "reversed",
        "same_unit",
    }
) | {"until", "original_heading"}
ROUND = frozenset({"until", "original_heading"})
"""`Until the circle is closed`: said of a curve before, it asks for the rest of the circle."""
_KINDS: dict[str, type[Step]] = {
    **dict.fromkeys(GO, Drive),
    "slide": Drive,
    **dict.fromkeys(TURN, Turn),
    "curve": Arc,
    "wait": Wait,
    "halt": Wait,
}
SCALES, _SIZES = ("scale", "fold"), ("length", "angle", "turns", "time", "speed", "rate")


@dataclass
class Edit:
    """What is said of the motion before. `instead` is what stood in place of the amount before it; with `sign` below
    zero the amount is so much less. `goes_on`: an `and` joins it to what was done. `returns`: back to the side `way`.
    """

    flags: set[str] = field(default_factory=set)
    kinds: list[type[Step]] = field(default_factory=list)
    amounts: list[Atom] = field(default_factory=list)
    instead: Atom | None = None
    roles: set[str] = field(default_factory=set)
    way: str = ""
    goes_on: bool = False
    nth: int = 0
    slides: bool = False
    is_named: bool = False
    times: int = 1
    sign: float = 1.0
    returns: bool = False

    def amount(self, *names: str) -> Atom | None:
        return next((atom for atom in self.amounts if atom.value in names), None)


def read_edit(atoms: Sequence[Atom]) -> Edit | None:
    opens = next((i for i, atom in enumerate(atoms) if atom.kind not in _IDLE), 0)
    edit, denied = Edit(goes_on=bool(atoms) and atoms[opens].kind == "conn"), False
    said = {atom.value for atom in atoms if atom.kind == "flag"}
    for i, atom in enumerate(_in_edit(atom, said) for atom in atoms):
        sign = sign_of(atom)
        if "again" in said and sign:
            edit.flags.add("more")
            edit.sign = sign
        elif atom.kind == "q" and atom.number < 0.0:  # `again minus 20 cm`
            edit.flags.add("more")
            edit.sign = -1.0
            edit.amounts.append(quantity(atom.value, -atom.number, atom.text, atom.role))
        elif (atom.kind, atom.value) == ("q", "times") and {"again", "instead"} <= said:
            edit.times = whole_number(atom.number, atom.text)
        elif (atom.kind, atom.value) == ("flag", "extra") and "instead" in said:
            edit.flags.add("again")
        elif atom.kind in _IDLE or (atom.kind == "pace" and any(a.value == "speed" for a in atoms)):
            continue
        elif atom.kind == "negation" and edit.amounts and edit.instead is None:
            denied = True
        elif is_another(atom):
            return None  # `again, another 20 cm`: so much more, or a motion of its own?
        elif atom.kind == "flag" and atom.value in _POINTING | _CHANGING:
            edit.flags.add(atom.value)
        elif atom.kind == "q" and denied:
            edit.instead, denied = atom, False
        elif atom.kind == "q" and (
            atom.value in (*SCALES, *_SIZES) or (atom.value == "number" and _is_told(atoms))
        ):
            edit.amounts.append(atom)
        elif atom.kind == "verb" and atom.value in _KINDS:
            edit.kinds.append(_KINDS[atom.value])
            edit.slides |= atom.value == "slide"
        elif atom.kind in ("dir", "rot") and edit.way in ("", atom.value) and not _is_apart(atoms, i):
            edit.way = atom.value
        elif atom.kind == "dir" and edit.way == "back" and atom.value in SIDES:
            edit.way, edit.returns = atom.value, True
        elif (atom.kind, atom.value) == ("role", "apart"):
            raise Unclear("unclear_motion", atom.text)  # of rows; `again apart from the last metre` has none
        elif atom.kind == "role" or (atom.kind == "counter" and atom.value == "side"):
            edit.roles.add(atom.value)
        elif atom.kind == "nth":
            edit.nth = int(atom.value)
        elif atom.value == "make" or _is_one(atom):
            edit.is_named = True
        elif not (atom.kind == "conn" and (i == opens or "first" in edit.flags or {"again", "more"} <= said)):
            return None
    return None if denied else edit


def _in_edit(atom: Atom, said: set[str]) -> Atom:
    """The atom as it is meant of the motion before: `back the same amount` is a way, `in reverse order` changes it."""
    if (atom.kind, atom.value) == ("order", "reverse"):
        return Atom("flag", "reversed", atom.text)
    if (atom.kind, atom.value) == ("q", "fold") and "速" in atom.text:
        return quantity("faster", atom.number, atom.text)  # 速度翻倍 is no distance
    goes_back = (atom.kind, atom.value) == ("verb", "return") and "same_amount" in said
    return Atom("dir", "back", atom.text) if goes_back else atom


def _is_apart(atoms: Sequence[Atom], i: int) -> bool:
    """`Right. Do that one again.`: a sentence of its own, which may only agree."""
    return i + 2 < len(atoms) and (atoms[i + 1].kind, atoms[i + 1].value) == ("sep", "strong")


def _is_one(atom: Atom) -> bool:
    """`One to the right`: written out, it is a figure and no metre."""
    number = (atom.kind, atom.value, atom.number) == ("q", "number", 1.0)
    return number and not any(map(str.isdecimal, atom.text))


def _is_told(atoms: Sequence[Atom]) -> bool:
    """Whether a bare number may be the one that is to stand for another, or belong to `the two distances`."""
    return any(
        atom.kind == "negation" or atom.value in ("amounts", "overshot", "same_unit") for atom in atoms
    )
