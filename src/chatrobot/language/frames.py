"""A clause as a bag of slots: what to do, which way, how much, in what manner. Word order does not matter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from chatrobot.language.tokens import Atom

GO = frozenset({"go", "shift", "slide"})

TURN = frozenset({"turn", "spin"})

STILL = frozenset({"wait", "halt"})

PLACE_HEADING = "place_heading"
"""The flag of `facing its heading`: the one that a place was given."""

RETURNS = "returns"
"""The flag of `return to the start and face …`: it drives there before it turns."""

EXTENTS = ("length", "angle", "time", "turns", "clock")

SIDES = ("left", "right")

DIAGONALS = {
    ("forward", "left"): "forward_left", ("forward", "right"): "forward_right",
    ("back", "left"): "back_left", ("back", "right"): "back_right",
}  # fmt: skip

DIRECTIONS = {
    "forward": 0.0, "left": math.pi / 2, "back": math.pi, "right": -math.pi / 2,
    "forward_left": math.pi / 4, "forward_right": -math.pi / 4,
    "back_left": 3 * math.pi / 4, "back_right": -3 * math.pi / 4,
}  # fmt: skip
"""Where each lies from the robot's front, radians, counter-clockwise."""

_ROUND = ("circle", "half_circle", "quarter_circle")

_IMPLIED = {"redo": ("again",), "mirrored": ("other_way",)}
"""Flags that say another one as well."""

SLOTTED = frozenset({"verb", "dir", "rot", "q", "pace", "flag", "role", "shape", "place", "defined"})
"""Kinds of atoms that a frame has a slot for. Every other kind must have been dealt with before."""


@dataclass
class Frame:
    """The slots of one clause. `q` holds at most one quantity of a dimension (and role)."""

    verb: str = ""
    direction: str = ""
    direction2: str = ""
    rot: str = ""
    pace: str = ""
    shape: str = ""
    place: str = ""
    words: str = ""
    q: dict[str, Atom] = field(default_factory=dict)
    flags: set[str] = field(default_factory=set)
    roles: list[str] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    joined: str = "start"
    contradiction: bool = False
    negated: bool = False
    opens: bool = False
    """Whether it begins a new sentence, follows a closing bracket, or is said to come at the very end."""

    @property
    def text(self) -> str:
        return " ".join(self.texts)

    @property
    def has_extent(self) -> bool:
        return any(name in self.q for name in EXTENTS)

    @property
    def is_empty(self) -> bool:
        return not (
            self.verb or self.direction or self.rot or self.pace or self.shape or self.place or self.q
            or self.flags or self.roles
        )  # fmt: skip

    @property
    def moves(self) -> bool:
        """Whether it names a motion by itself: a verb, a direction, a rotation, a shape."""
        return bool(
            (self.verb and self.verb != "make") or self.direction or self.rot or self.shape or self.place
        )

    @property
    def is_arc(self) -> bool:
        """Whether it turns as it goes; what is said to go without turning does not."""
        if "no_turn" in self.flags and self.verb != "curve" and not {"radius", "rate"} & set(self.q):
            return False
        return (
            self.verb == "curve"
            or {"speed", "rate"} <= set(self.q)
            or "radius" in self.roles
            or "radius" in self.q
            or "diameter" in self.roles
            or "while" in self.flags
        )

    @property
    def turning(self) -> bool:
        return self.verb in TURN or (not self.verb and bool(self.rot)) or self.verb == "uturn"

    @property
    def sided(self) -> bool:
        """Whether it says left or right, or round which way."""
        return bool(self.rot) or self.direction in SIDES

    @property
    def is_bare_ahead(self) -> bool:
        """Whether it says `forward`, and nothing else."""
        said = self.verb or self.q or self.flags or self.roles or self.rot or self.pace or self.shape
        return self.direction == "forward" and not said

    def copy(self) -> Frame:
        """One that may be changed by itself; the atoms are shared, for nobody changes those."""
        return replace(
            self, q=dict(self.q), flags=set(self.flags), roles=list(self.roles), texts=list(self.texts)
        )

    def add(self, atom: Atom) -> bool:
        """Put `atom` in its slot. False, and nothing changed, where it contradicts what is there."""
        done = self._put(atom)
        if done and atom.kind != "glue":
            self.texts.append(atom.text)
        return done

    def _put(self, atom: Atom) -> bool:
        if atom.kind == "verb":
            return self.put_verb(atom.value)
        if atom.kind == "dir":
            return self.put_direction(atom.value)
        if atom.kind == "rot":
            return self.put_rotation(atom.value)
        if atom.kind == "q":
            return self.put_quantity(atom)
        if atom.kind == "pace":
            if self.pace and self.pace != atom.value and {self.pace, atom.value} == {"slow", "fast"}:
                return False
            self.pace = self.pace if self.pace in ("max", "half", "half_max") else atom.value
        elif atom.kind == "flag":
            self.flags |= {atom.value, *_IMPLIED.get(atom.value, ())}
        elif atom.kind == "role":
            self.roles.append(atom.value)
        elif atom.kind == "shape":
            if self.shape and self.shape != atom.value:
                return False
            self.shape = atom.value
        elif atom.kind == "place":
            if self.place and self.place != atom.value:
                return False
            self.place = atom.value
        elif atom.kind == "defined":
            if self.words or self.moves:
                return False
            self.words = atom.value
            self.verb = "defined"
        return True

    def put_verb(self, verb: str) -> bool:
        """What it does. False where that begins a motion of its own."""
        old = self.verb
        if self.place and verb in ("go", "return", "shift"):
            return verb != "return" or old not in (
                *GO,
                "",
            )  # `to the kitchen and back`: there, and another way
        if verb in STILL and old not in STILL and (old in GO or self.place or self._says_a_motion()):
            return False
        same = ("go", "turn", "shift", "slide", "wait", "halt", "face", "make", "curve")
        if old == verb and verb in same and not self.has_extent:
            return True
        bare_go = old in ("go", "shift") and not self.has_extent and not self.direction
        return (
            self._put_first_verb(verb) if not old or old == "make" or bare_go else self._put_next_verb(verb)
        )

    def _says_a_motion(self) -> bool:
        return bool(self.direction or self.rot or {"angle", "turns", "length"} & set(self.q))

    def _put_first_verb(self, verb: str) -> bool:
        """A verb where none that means anything by itself stands yet: it must fit the other slots."""
        arc, rotates = self.is_arc, "angle" in self.q or "turns" in self.q
        if verb in TURN and not arc and ("length" in self.q or self.direction in ("forward", "back")):
            return False
        if verb in GO and rotates and not arc and not self._heading():
            return False
        if verb in (*GO, *STILL, "return", "face", "uturn") and self.rot and not arc:
            return False
        if verb in ("wait", "return", "uturn") and ((self.direction and not self.verb) or "length" in self.q):
            return verb == "uturn" and self.direction in SIDES and self._set_verb(verb)
        return self._set_verb(verb if verb != "make" or not self.verb else self.verb)

    def _put_next_verb(self, verb: str) -> bool:
        """A verb beside another one: `go and face`, `turn in a curve`; else it begins a motion of its own."""
        old, extent = self.verb, self.has_extent
        if verb == "face" and old in ("return", "turn", "spin") and not extent:
            self.flags |= {RETURNS} if old == "return" and "to_start" in self.flags else set()
            return self._set_verb(verb)
        if verb == "make":
            return not extent
        if old in TURN and verb in ("curve", *TURN) and (not extent or set(self.q) == {"angle"}):
            return self._set_verb("curve" if verb == "curve" else old)
        if old == "curve" and (verb == "turn" or (verb == "go" and not {"angle", "length"} <= set(self.q))):
            return True
        if (self.is_arc or "while" in self.flags) and {old, verb} <= {*GO, *TURN}:
            return self._set_verb(
                "slide" if "slide" in (old, verb) else "curve"
            )  # a slide that turns is no curve
        if old in STILL and verb in STILL and not extent:
            return self._set_verb("wait")
        if {old, verb} <= GO and not extent:
            return self._set_verb(verb if old != "slide" else old)
        if old in GO and verb == "curve" and not extent:
            return self._set_verb("curve")
        if old in ("go", "turn") and verb == "face" and not extent and not self.direction:
            return self._set_verb("face")
        return old == "face" and verb == "turn" and self._set_verb("face")

    def _set_verb(self, verb: str) -> bool:
        self.verb = verb
        return True

    def _heading(self) -> bool:
        return self.direction in DIAGONALS.values() or bool({"diagonal", "bearing"} & self.flags)

    def put_direction(self, new: str) -> bool:
        """Which way it goes. False where it goes another way already."""
        old = self.direction
        if self.verb in ("wait", "halt", "return", "remember", "undo"):
            return False
        if not old:
            if self.verb in TURN and new not in SIDES and not self.is_arc:
                return False
            if self.rot and not self.is_arc:
                return False
            if ("angle" in self.q or "turns" in self.q) and new in ("forward", "back") and not self.is_arc:
                return "diagonal" in self.flags and self._set_direction(new)
            return self._set_direction(new)
        if old == new or (old in DIAGONALS.values() and new in old.split("_")):
            return True
        if self.is_arc or self.shape in _ROUND or "diagonal" in self.flags or "while" in self.flags:
            return self._combine(old, new)
        return False

    def _combine(self, old: str, new: str) -> bool:
        both = (old, new) if old in ("forward", "back") else (new, old)
        if both not in DIAGONALS:
            return False
        if self.is_arc or self.shape in _ROUND:
            if self.direction2 and self.direction2 != both[1]:
                return False
            self.direction, self.direction2 = both
            return True
        return self._set_direction(DIAGONALS[both])

    def _set_direction(self, new: str) -> bool:
        self.direction = new
        return True

    def put_rotation(self, rot: str) -> bool:
        """Which way round it turns. False where it does not turn."""
        if self.rot and self.rot != rot:
            return False
        if self.verb in (*STILL, "return") or ("length" in self.q and not self.shape and not self.is_arc):
            return False
        if self.verb in GO and not self.is_arc and self.direction and not self.shape:
            return False
        self.rot = rot
        return True

    def put_quantity(self, atom: Atom) -> bool:
        """An amount. False where one of its kind is there, or it does not fit what is done."""
        name = atom.value
        if name == "turns" and self.shape:
            name = "times"
        if name in self.q:
            return False
        rotating = name in ("angle", "turns")
        if self.verb in STILL and name in ("length", "angle", "turns", "speed", "rate", "clock"):
            return False
        if self.shape or self.is_arc:
            self.q[name] = atom
            return True
        if name == "length" and ("angle" in self.q or "turns" in self.q) and not self._heading():
            return False
        if name == "length" and (self.turning or ("rate" in self.q and not self.verb)):
            return False
        if rotating and "length" in self.q and not self._heading():
            return False
        if rotating and self.verb in GO and self.direction in ("forward", "back"):
            return False
        if rotating and self.direction in ("forward", "back") and not self.verb:
            return False
        self.q[name] = atom
        return True
