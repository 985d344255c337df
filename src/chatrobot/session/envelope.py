"""The one envelope of the joint: what Understanding's half says to Motion's half, whatever carries it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Word = Literal[
    "hello",  # opens the lease: {"term_s": …}
    "beat",  # keeps it; any word that names its term opens it for a Motion that came after the hello
    "plan",  # {"plan_text", "mode": queue|replace|append, "approve": bool, "rehearse_only": bool, "longest_s": …}
    "approve",  # {"yes": bool} answers a Rehearsed event that needs approval
    "stop",  # {"why": …}; makes void what belongs to this turn and those before
    "emergency_stop",
    "release",
    "goodbye",  # an orderly end: what is queued is still done, then the lease ends
]
WORDS = ("hello", "beat", "plan", "approve", "stop", "emergency_stop", "release", "goodbye")


@dataclass(frozen=True)
class Envelope:
    """`sequence` grows with every envelope of a source; an old one is dropped. `lease` is the source's lease id."""

    word: Word
    source: str
    lease: str
    sequence: int
    turn: int = 0
    payload: dict[str, Any] = field(default_factory=dict)

    def to_bytes(self) -> bytes:
        return json.dumps(asdict(self), separators=(",", ":")).encode()

    @classmethod
    def from_bytes(cls, packet: bytes) -> Envelope | None:
        """The envelope in `packet`, None where it is not one: Motion never dies of what it is sent."""
        try:
            data = json.loads(packet)
            envelope = cls(**data)
        except (ValueError, TypeError, RecursionError):
            return None
        well_formed = (
            envelope.word in WORDS
            and isinstance(envelope.source, str)
            and isinstance(envelope.lease, str)
            and isinstance(envelope.sequence, int)
            and isinstance(envelope.turn, int)
            and isinstance(envelope.payload, dict)
        )
        return envelope if well_formed else None


_LONGEST_S = 1e6


def seconds(value: object, otherwise: float) -> float:
    """A payload's duration; `otherwise` where it is none."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and 0.0 <= value <= _LONGEST_S else otherwise  # type: ignore[arg-type,operator]


READY = b"ready"
"""What Motion's process says once, when it has its robot and its guard."""
