"""Holds the terms of a turn that a model plans: how the model may be used, what it has spent, how the turn ended."""

from __future__ import annotations

import time
from dataclasses import dataclass

from chatrobot.core.events import Finished, ModelCalled, Outcome
from chatrobot.core.reason import Reason
from chatrobot.plan.base import Step


@dataclass(frozen=True)
class ModelOptions:
    """Use of a model. `rounds` bounds the calls of one turn that are no corrections, `budget_tokens` what all of
    its calls may use, `budget_s` how long it may take in all. `streams`: steps run as they come."""

    streams: bool = True
    rounds: int = 6
    budget_tokens: int = 20_000
    budget_s: float = 600.0


@dataclass(frozen=True)
class Ended:
    """End of a turn. `finished` sums up its runs; None where nothing ran. `steps` are those that were done,
    `answer` all that the model wrote, `said` what of it is for the person."""

    outcome: Outcome
    reason: Reason | None
    finished: Finished | None
    steps: tuple[Step, ...]
    answer: str
    said: str


class Spending:
    """Counts from the turn's beginning. A retry is a round that corrects the one before it, and is counted apart."""

    def __init__(self, options: ModelOptions) -> None:
        self._options = options
        self._tokens = 0
        self.began_s = time.monotonic()
        self.calls = 0
        self.retries = 0

    @property
    def rounds(self) -> int:
        """Calls that were no corrections."""
        return self.calls - self.retries

    def note(self, call: ModelCalled) -> None:
        """Count what a call has used."""
        self._tokens += call.prompt_tokens + call.reply_tokens

    def used_up(self) -> Reason | None:
        """Return why no model may be asked any more."""
        options = self._options
        if self._tokens >= options.budget_tokens:
            return Reason("model_tokens_used", {"tokens": self._tokens, "budget": options.budget_tokens})
        if time.monotonic() - self.began_s >= options.budget_s:
            return Reason("model_time_used", {"budget_s": options.budget_s})
        return None

    def rounds_used_up(self) -> Reason | None:
        """Return why there is no further round."""
        if self.rounds >= self._options.rounds:
            return Reason("model_rounds_used", {"rounds": self._options.rounds})
        return None
