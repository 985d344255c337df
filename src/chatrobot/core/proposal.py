"""A plan that a question offers, so that every display can show it with a yes and a no."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Proposal:
    """`plan_text` runs if the very next text is a yes; `say` is the question, in the language of the person."""

    plan_text: str
    say: str

    def to_json(self) -> dict[str, Any]:
        return {"plan_text": self.plan_text, "say": self.say}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Proposal:
        return cls(str(data["plan_text"]), str(data["say"]))
