"""The motion budget: how far and how long one text or program may drive, all its repeats and parts together."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

MAX_DISTANCE_M = 100.0
MAX_TIME_S = 600.0
ENDLESS_PROGRAM_S = 60.0
"""How long a program runs whose rehearsal did not end, where nobody chose a time."""

MOST = 1e9
"""No number beyond it is a limit that anybody means."""

NONE = "none"
"""How no limit is written: on the command line, in profiles and in envelopes."""

OPEN_LOOP = "open_loop"
"""The code of the notice that a robot is driven open loop."""

EXCEEDED = frozenset({"over_max_distance", "over_max_time", "over_open_loop_time"})
"""The refusals of what is known to exceed its budget."""


@dataclass(frozen=True)
class MotionBudget:
    """What somebody chose. None: not chosen, so that the defaults above hold; infinite: no limit.

    `ceiling_s` bounds the time whatever is chosen: it is no choice, and `changed` keeps it.
    """

    max_distance_m: float | None = None
    max_time_s: float | None = None
    ceiling_s: float = field(default=math.inf, kw_only=True)

    @property
    def distance_m(self) -> float:
        """How far one text or program may drive."""
        return self.max_distance_m if self.max_distance_m is not None else MAX_DISTANCE_M

    @property
    def time_s(self) -> float:
        """How long one text or program may drive; while it waits it does not."""
        return min(self.max_time_s if self.max_time_s is not None else MAX_TIME_S, self.ceiling_s)

    @property
    def is_at_ceiling(self) -> bool:
        """No choice can make the time longer."""
        return self.time_s == self.ceiling_s

    @property
    def endless_program_s(self) -> float:
        """How long a program may run whose rehearsal did not end."""
        return min(self.max_time_s if self.max_time_s is not None else ENDLESS_PROGRAM_S, self.ceiling_s)

    def changed(self, choice: MotionBudget) -> MotionBudget:
        """With what `choice` chooses in place of this."""
        return MotionBudget(
            self.max_distance_m if choice.max_distance_m is None else choice.max_distance_m,
            self.max_time_s if choice.max_time_s is None else choice.max_time_s,
            ceiling_s=self.ceiling_s,
        )


NOT_CHOSEN = MotionBudget()


def read_limit(value: object) -> float:
    """The limit that a number above zero, or `none`, is.

    Raises:
        ValueError: it is neither.
    """
    if value == NONE:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 < value <= MOST:
        raise ValueError(f"{value!r} is neither a number above zero nor {NONE}")
    return float(value)


def limit_text(limit: float | None) -> str:
    """For another process: `read_limit_text` reads it. Empty: not chosen."""
    return "" if limit is None else NONE if math.isinf(limit) else repr(limit)


def read_limit_text(text: str) -> float | None:
    """The limit in `text`; None where it is empty.

    Raises:
        ValueError: it is neither a number above zero nor `none`.
    """
    if not text:
        return None
    return read_limit(text if text == NONE else float(text))
