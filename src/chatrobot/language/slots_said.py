"""What a text says of what was done before, slot by slot: see of_before.py."""

from __future__ import annotations

from dataclasses import dataclass, field

from chatrobot.language.tokens import Atom

WAYS = ("back", "reverse", "forward", "left", "right")
HEADINGS = ("first_heading", "before_heading", "first_spot", "before_spot")
PLACES = ("at_front", "at_back", "at_left", "at_right")
SUMS = ("all", "both", "difference")


@dataclass
class Said:
    """The slots that are said, the amounts in them, and the factors of what was done."""

    slots: set[str] = field(default_factory=set)
    amounts: dict[str, list[Atom]] = field(default_factory=dict)
    factors: list[float] = field(default_factory=list)

    def has(self, *slots: str) -> bool:
        """Whether one of these slots is said."""
        return not self.slots.isdisjoint(slots)

    def within(self, *slots: str) -> bool:
        """Whether nothing is said in any other slot."""
        return self.slots <= set(slots)

    def only(self, *slots: str) -> bool:
        """Whether no amount stands in any other slot."""
        return self.amounts.keys() <= set(slots) and all(len(found) == 1 for found in self.amounts.values())

    def amount(self, *slots: str) -> Atom | None:
        """The amount in the first of these slots that has one."""
        return next((self.amounts[slot][0] for slot in slots if slot in self.amounts), None)
