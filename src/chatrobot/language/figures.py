"""What changes the circle or the shape before: `with 50 cm sides`, `with a radius of 1 m`, `clockwise`."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.edit_words import Edit
from chatrobot.language.frames import SIDES
from chatrobot.language.inverse import flipped
from chatrobot.language.resizing import resized
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_SIZED = ("side", "radius", "diameter")
_SIZES = ("length", "angle", "turns")
_MIRRORING = ("other_way", "mirrored")
_ROUND_RAD = 6.0
"""What turns by less in all is no closed figure."""


def with_another_size(plain: str, atoms: Sequence[Atom], language: str) -> Edit | None:
    """`Now with 50 cm`, `the same with 50 cm`, `with a radius of 1 m`: the size of the one before; else None."""
    size = _size(atoms)
    if size is None:
        return None
    with_ = tuple(load_table(language, "selections").get("with", ()))
    again = any(atom.value == "again" for atom in atoms)
    before = atoms[list(atoms).index(size.amounts[0]) - 1].text if again else ""
    return size if plain.startswith(with_) or f"{before} " in with_ else None


def _size(atoms: Sequence[Atom]) -> Edit | None:
    """One length, and nothing but what of a figure it is the length of."""
    sized = [atom for atom in atoms if atom.kind == "q"]
    roles = {atom.value for atom in atoms if atom.kind in ("role", "counter") and atom.value in _SIZED}
    beside = ("q", "filler", "glue", "sep")
    others = [a for a in atoms if a.kind not in beside and a.value not in ("again", *_SIZED)]
    if others or len(sized) != 1 or sized[0].value != "length" or sized[0].number <= 0.0 or len(roles) > 1:
        return None  # less than none: `minus 10 cm`
    return Edit(amounts=sized, roles=roles or {"side"})


def with_side_and_size(atoms: Sequence[Atom], dialogue: Dialogue) -> list[Step] | None:
    """`The same but counterclockwise and with 40 cm sides`: what turned, to that side and of that size; else None."""
    said, last = [atom for atom in atoms if atom.kind not in SILENT], dialogue.last_motion
    if last is None or last.plan is None or not any(atom.value == "again" for atom in said):
        return None
    sides = {atom.value for atom in said if atom.kind in ("rot", "dir") or atom.value in _MIRRORING}
    sizes = [atom for atom in said if atom.kind == "q"]
    others = [a for a in said if a not in sizes and a.value not in {"again", "turn", "make", *_SIZED, *sides}]
    turning = {step.left for step in last.plan.steps if isinstance(step, (Turn, Arc))}
    if others or len(sides) != 1 or len(sizes) != 1 or len(turning) != 1 or sizes[0].value not in _SIZES:
        return None
    side = sides.pop()
    if side not in (*SIDES, *_MIRRORING):
        return None
    stays = turning == {side == "left"} and side in SIDES
    steps = list(last.plan.steps) if stays else [flipped(step) for step in last.plan.steps]
    roles = {atom.value for atom in said if atom.value in _SIZED}
    is_side = sizes[0].value == "length" and _is_figure(steps)
    return resized(steps, Edit(amounts=sizes, roles=roles or ({"side"} if is_side else set())))


def figure_asked(atoms: Sequence[Atom], dialogue: Dialogue) -> list[Step] | None:
    """What `clockwise` or `radius 1 m`, said alone after a figure, may mean: to be asked about; else None."""
    said, last = [atom for atom in atoms if atom.kind not in SILENT], dialogue.last_motion
    if last is None or last.plan is None or not _is_figure(last.plan.steps):
        return None
    steps = list(last.plan.steps)
    if [atom.kind for atom in said] == ["rot"]:
        is_left = said[0].value == "left"
        return steps if is_left == (_turned_rad(steps) > 0.0) else [flipped(step) for step in steps]
    size = _size(atoms)
    named = any(atom.kind in ("role", "counter") for atom in said)
    return resized(steps, size) if size is not None and named else None


def _is_figure(steps: Sequence[Step]) -> bool:
    drives = any(isinstance(step, (Arc, Drive)) for step in steps)
    return drives and abs(_turned_rad(steps)) > _ROUND_RAD


def _turned_rad(steps: Sequence[Step]) -> float:
    turning = [step for step in steps if isinstance(step, (Turn, Arc))]
    return sum((step.angle_rad or 0.0) * (1 if step.left else -1) for step in turning)
